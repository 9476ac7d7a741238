/* sweep_table.c: the table of many runs, and its statistics */
#include "simulate/sweep/sweep_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

SweepTable *sweep_table_new(int planned)
{
    SweepTable *table = NEW(SweepTable);

    table->planned = planned;
    return table;
}

static void free_later(void *object)
{
    sweep_table_free(object);
}

void sweep_table_free(SweepTable *table)
{
    if (table == NULL || mem_frees_later(table, free_later))
        return;
    for (int i = 0; i < table->columns.count; i++)
        MEM_FREE(table->columns.at[i].name, table->columns.at[i].unit);
    for (int i = 0; table->reasons != NULL && i < table->planned; i++)
        mem_free(table->reasons[i]);
    LIST_FREE(table->columns);
    MEM_FREE(table->values, table->reasons, table);
}

void sweep_table_column(SweepTable *table, const char *name, const char *unit)
{
    const SweepColumn column = {mem_text(name, strlen(name)), mem_text(unit, strlen(unit))};

    LIST_PUSH(table->columns, column);
}

void sweep_table_open(SweepTable *table, int parameters)
{
    const size_t size = (size_t)table->planned * (size_t)table->columns.count;

    table->parameter_count = parameters;
    table->values = mem_array(size, sizeof *table->values);
    table->reasons = NEW_ARRAY(char *, table->planned);
    for (size_t i = 0; i < size; i++)
        table->values[i] = NAN;
}

int sweep_table_find(const SweepTable *table, const char *name)
{
    for (int i = 0; i < table->columns.count; i++)
        if (strcmp(table->columns.at[i].name, name) == 0)
            return i;
    return -1;
}

/* mean and sum of squares by updates, which keep their digits (Welford 1962) */
SweepStatistics sweep_statistics(const SweepTable *table, int column)
{
    SweepStatistics out = {0, NAN, NAN, INFINITY, -INFINITY};
    double mean = 0, squares = 0;

    for (int r = 0; r < table->rows; r++) {
        const double value = sweep_table_row(table, r)[column], from = value - mean;

        if (!isfinite(value))
            continue;
        out.count++;
        mean += from / out.count;
        squares += from * (value - mean);
        out.least = fmin(out.least, value);
        out.most = fmax(out.most, value);
    }
    if (out.count == 0)
        out.least = out.most = NAN;
    if (out.count > 0)
        out.mean = mean;
    if (out.count > 1)
        out.deviation = sqrt(squares / (out.count - 1));
    return out;
}

static int compare_values(const void *a, const void *b)
{
    const double one = *(const double *)a, other = *(const double *)b;

    return (one > other) - (one < other);
}

void sweep_quantiles(const SweepTable *table, int column, const double *shares, int count,
                     double *out)
{
    double *sorted = NEW_ARRAY(double, table->rows);
    int finite = 0;

    for (int r = 0; r < table->rows; r++) {
        const double value = sweep_table_row(table, r)[column];

        if (isfinite(value))
            sorted[finite++] = value;
    }
    qsort(sorted, (size_t)finite, sizeof *sorted, compare_values);
    for (int i = 0; i < count; i++) {
        const double place = shares[i] * (finite - 1);
        const int below = (int)place;

        out[i] = finite == 0 ? (double)NAN
                 : below >= finite - 1
                     ? sorted[finite - 1]
                     : sorted[below] + (place - below) * (sorted[below + 1] - sorted[below]);
    }
    mem_free(sorted);
}
