/* grid.h: rows of a run, (t, y) one behind another
 *
 * Rows of different phases may have y of different length: a row says which phase it is of. */
#ifndef COTREE_SIMULATE_RUN_GRID_H
#define COTREE_SIMULATE_RUN_GRID_H

#include <stddef.h>

typedef struct Grid {
    int count, room;
    double *times;
    int *phase;         /* of a run's phases, the one that a row is of */
    ptrdiff_t *first;   /* place of a row in `states` */
    double *states;     /* one growing block */
    ptrdiff_t used;     /* of it */
    ptrdiff_t capacity; /* of it */
} Grid;

/* a row behind the last one; y is copied */
void grid_add(Grid *grid, double t, int phase, const double *y, int length);
/* all rows of another one, of the same phases */
void grid_append(Grid *grid, const Grid *more);
double *grid_row(const Grid *grid, int row); /* y; borrowed, until a row is added */
int grid_length(const Grid *grid, int row);  /* of y */
void grid_free(Grid *grid);                  /* what it holds; it is empty again */

/* Output times: number of them behind `from` up to `to`, `rows`; grid_time(k) for k = 1.. is the
 * k-th of them. They are products, so that they don't gather rounding. */
int grid_rows(double from, double to, double every);
double grid_time(double from, double to, double every, int rows, int k);

#endif
