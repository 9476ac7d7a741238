/* sweep_table.h: what many runs left: a row for each, with its parameters and its figures
 *
 * A run that failed is a row, too: its figures are NAN, and it has a reason. Statistics leave out
 * what isn't a number. */
#ifndef COTREE_SIMULATE_SWEEP_SWEEP_TABLE_H
#define COTREE_SIMULATE_SWEEP_SWEEP_TABLE_H

#include "base/memory.h"

#include <stdbool.h>

typedef struct SweepColumn {
    char *name; /* of a parameter, or a figure as written: "max(h1)" */
    char *unit; /* that values are in; "" where it isn't known, or for a number */
} SweepColumn;

typedef struct SweepTable {
    LIST(SweepColumn) columns; /* parameters before figures */
    int parameter_count;
    int planned;    /* runs */
    int rows;       /* those that were made: fewer after a stop */
    double *values; /* planned x columns, row by row */
    char **reasons; /* planned: NULL where a run succeeded */
    int failures;
    bool is_random; /* a Monte Carlo */
    double wall;    /* s */
} SweepTable;

SweepTable *sweep_table_new(int planned); /* new, without columns */
void sweep_table_free(SweepTable *table); /* NULL is fine */
/* a column, before there are values */
void sweep_table_column(SweepTable *table, const char *name, const char *unit);
/* memory for the rows, all NAN; `parameters` of the columns are parameters */
void sweep_table_open(SweepTable *table, int parameters);
static inline double *sweep_table_row(const SweepTable *table, int row)
{
    return table->values + (ptrdiff_t)row * table->columns.count;
}
/* the column with that name; -1: there is none */
int sweep_table_find(const SweepTable *table, const char *name);

/* of the finite values of a column; NAN where there are too few */
typedef struct SweepStatistics {
    int count;
    double mean, deviation; /* with count - 1 */
    double least, most;
} SweepStatistics;
SweepStatistics sweep_statistics(const SweepTable *table, int column);
/* Quantiles at shares of [0, 1], linear between the sorted values (Hyndman and Fan 1996, type 7).
 */
void sweep_quantiles(const SweepTable *table, int column, const double *shares, int count,
                     double *out);

#endif
