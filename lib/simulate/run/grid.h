/* grid.h: rows of a run, (t, y) one after another
 *
 * Rows of different phases may have y of different length: each row has the number of its phase. */
#ifndef COTREE_SIMULATE_RUN_GRID_H
#define COTREE_SIMULATE_RUN_GRID_H

#include <stddef.h>

typedef struct Grid {
    int count, room;
    double *times;
    int *phase;         /* number of each row's phase among those of the run */
    int *steps;         /* of the integrator up to each row; 0 where nobody sets it */
    ptrdiff_t *first;   /* index of each row in `states` */
    double *states;     /* one block that grows */
    ptrdiff_t used;     /* entries in use */
    ptrdiff_t capacity; /* entries allocated */
} Grid;

/* add a row after the last one; y is copied */
void grid_add(Grid *grid, double t, int phase, const double *y, int length);
/* add all rows of another one, with the same phases */
void grid_append(Grid *grid, const Grid *more);
double *grid_row(const Grid *grid, int row); /* y; borrowed, until a row is added */
int grid_length(const Grid *grid, int row);  /* of y */
void grid_free(Grid *grid);                  /* frees its contents; it is empty afterwards */

/* Output times: the number of those after `from` up to `to`; `grid_time(k)` is the k-th for k =
 * 1... They are products, so that rounding errors don't accumulate. */
int grid_rows(double from, double to, double every);
double grid_time(double from, double to, double every, int rows, int k);

#endif
