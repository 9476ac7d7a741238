/* factors.h: steps from a square Jacobian that may be singular
 *
 * Sparse factors where they do; where the matrix is small or nearly singular full ones of as many
 * columns as are independent (rows_solve()). The pattern is given once, by columns. */
#ifndef COTREE_SIMULATE_EQUATIONS_FACTORS_H
#define COTREE_SIMULATE_EQUATIONS_FACTORS_H

#include <stdbool.h>

typedef struct Factors Factors;

/* New; free with factors_free(). Borrows the pattern: the rows of column c stand from start[c] up
 * to start[c + 1], each place once. `full`: whether a full matrix may be made. */
Factors *factors_new(int n, const int *start, const int *row, bool full);
void factors_free(Factors *factors); /* NULL is fine */
/* Factor for these values (one an entry), which are copied. False: not finite, or singular where no
 * full matrix may be made. */
bool factors_make(Factors *factors, const double *values);
/* The step for a right-hand side (n each). Where the rank, which comes back, is less than n one of
 * few entries that brings it nearest; -1 where a number isn't finite. */
int factors_solve(Factors *factors, const double *right, double *step);
/* a column of the last values that the others span, as sparse factors find it; -1: none found */
int factors_singular(Factors *factors, const double *values);
bool factors_may_be_full(const Factors *factors);

#endif
