/* correlation.h: correlated points of the unit cube (a Gaussian copula) */
#ifndef COTREE_SIMULATE_SWEEP_CORRELATION_H
#define COTREE_SIMULATE_SWEEP_CORRELATION_H

#include "base/diag.h"

/* Replace the lower triangle of a matrix (n x n, row by row) by that of its Cholesky factor L, L
 * L^T = C. E_VALUE if it isn't symmetric, has a diagonal other than 1, or isn't positive definite.
 * No place. O(n^3). */
MUST_USE Status correlation_factor(double *matrix, int n, Diag *diag);
/* Correlate a point u in (0, 1)^n: the normal deviates of its coordinates get the correlation of L.
 * The distribution of each coordinate remains uniform. Exact for normal values; values of other
 * distributions have that rank correlation. */
void correlation_apply(const double *factor, int n, double *point);

#endif
