/* factors.h: steps from a square Jacobian that may be singular
 *
 * Solves A d = b, A n x n. Sparse LU where A is well conditioned. Where A is small or nearly
 * singular, full factors of as many columns as are independent (rows_solve()). The pattern is given
 * once, by columns. */
#ifndef COTREE_SIMULATE_EQUATIONS_FACTORS_H
#define COTREE_SIMULATE_EQUATIONS_FACTORS_H

#include <stdbool.h>

typedef struct Factors Factors;

/* New; free with factors_free(). Borrows the pattern: the row indices of column c are row[start[c]]
 * up to before row[start[c + 1]], each once. `full`: whether a full matrix may be made. */
Factors *factors_new(int n, const int *start, const int *row, bool full);
void factors_free(Factors *factors); /* NULL is fine */
/* Factor for these values (one per entry), which are copied. False: not finite, or singular where
 * no full matrix may be made. */
bool factors_make(Factors *factors, const double *values);
/* The step for a right-hand side (n each). Returns the rank. Where that is less than n, the step
 * has few nonzero entries and minimises the residual. -1 where a number isn't finite. */
int factors_solve(Factors *factors, const double *right, double *step);
/* a column of the last values that the others span, according to sparse factors; -1: none found */
int factors_singular(Factors *factors, const double *values);
bool factors_may_be_full(const Factors *factors);

#endif
