/* linear.h: small dense linear algebra without allocation in its use
 *
 * Own code, because matrices of bodies and their constraints are small or mostly 0: GSL's LU takes
 * two to three times as long there, its Cholesky two to ten times (make bench: algebra.lu_*,
 * algebra.cholesky_*). Neither can be stopped or reports its pivots. Matrices are stored row by
 * row. An Lu stores one square matrix A (n x n) and its factors P A = L U; fill lu_matrix(),
 * factor, then solve for any number of right sides. */
#ifndef COTREE_ALGEBRA_LINEAR_H
#define COTREE_ALGEBRA_LINEAR_H

#include "base/call_monitor.h"

#include <stdbool.h>

typedef struct Lu Lu;

Lu *lu_new(int n);             /* new, all 0; free with lu_free() */
void lu_free(Lu *lu);          /* NULL is fine */
void lu_resize(Lu *lu, int n); /* to n x n, at most as in lu_new(); what it stores is undefined */
double *lu_matrix(Lu *lu);     /* n x n; overwritten by lu_factor() */
/* Factor in place with row exchanges (Gauss). False when a pivot is 0 or not finite. O(n^3). */
bool lu_factor(Lu *lu);
/* the same; false also when the watch requests a stop */
bool lu_factor_watched(Lu *lu, const CallMonitor *watch);
/* least over largest pivot in size, of the last lu_factor(); 0 when singular */
double lu_pivot_ratio(const Lu *lu);
void lu_solve(const Lu *lu, double *b); /* b becomes the solution; O(n^2) */

/* Replace the lower half of an n x n matrix A by its Cholesky factor L, A = L L^T. Returns the
 * least pivot; the factorisation ends at one that isn't positive. Entries of a row before its first
 * one other than 0 remain 0 and are skipped. O(n^3). */
double cholesky_factor(double *matrix, int n);
void cholesky_forward(const double *l, int n, double *b);  /* b becomes L^-1 b; zeros passed over */
void cholesky_backward(const double *l, int n, double *b); /* b becomes L^-T b */

/* out = matrix * v, rows x columns */
void matrix_times(const double *matrix, int rows, int columns, const double *v, double *out);
/* out = a b, n x n each; rows of a that are mostly 0 are passed over quickly */
void matrices_times(const double *a, const double *b, int n, double *out);
/* out (rows x rows, its lower half) = matrix * matrix^T, of rows that may be mostly 0 */
void matrix_gram(const double *matrix, int rows, int columns, double *out);
double vector_largest(const double *v, int n); /* max |v_i|; NAN when one is */
bool vector_is_finite(const double *v, int n);

#endif
