/* schur.h: Hessenberg and Schur forms of real matrices in numbers of twice the digits
 *
 * Matrices are stored row by row. Rounding errors are some 1e-31 of the largest entry, so balance
 * the matrix first. */
#ifndef COTREE_ALGEBRA_SCHUR_H
#define COTREE_ALGEBRA_SCHUR_H

#include "algebra/double_double.h"

/* Scale states by powers of 2 so that columns are as large as rows, in the sum of sizes off the
 * diagonal: scale[i] a[i][j]/scale[j] is balanced (Parlett and Reinsch 1969). `size`: n x n. */
void matrix_balance(const double *size, int n, double *scale);

/* (I - v v^T beta) at, for entries from..n-1 of it, with that stride: a reflection if beta is
 * 2/v^T v */
void dd_reflect(DoubleDouble *at, int n, int stride, int from, const DoubleDouble *v,
                DoubleDouble beta);

/* Turn a into Q^T a Q, 0 below the first subdiagonal, by reflections; q (NULL: not wanted) becomes
 * Q. Of 10/3 n^3 products. */
void matrix_hessenberg(DoubleDouble *a, int n, DoubleDouble *q);

/* t = Z^H a Z, upper triangular, and z = Z (NULL: not wanted). False when the iteration doesn't
 * converge. By the QR method with single shifts (Francis 1961, Kublanovskaya 1961). */
bool schur(const DoubleDouble *a, int n, DoubleDoubleComplex *t, DoubleDoubleComplex *z);

/* Right eigenvectors of a as columns of `right`, and the inverse, whose rows are the left ones:
 * from its Schur form. Equal eigenvalues are treated as if they differed by rounding. O(n^3). */
void schur_vectors(const DoubleDoubleComplex *t, const DoubleDoubleComplex *z, int n,
                   DoubleDoubleComplex *right, DoubleDoubleComplex *left);

#endif
