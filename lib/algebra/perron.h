/* perron.h: bounds of the spectral radius of matrices whose entries are >= 0 (Collatz 1942) */
#ifndef COTREE_ALGEBRA_PERRON_H
#define COTREE_ALGEBRA_PERRON_H

/* The matrix A >= 0 (n x n) is defined by a function that returns A v for a vector v > 0 (n x 1).
 * O(12 calls). */
typedef void PerronApply(const void *context, const double *v, double *out);
double perron_bound(PerronApply *apply, const void *context, int n);

#endif
