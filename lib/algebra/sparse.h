/* sparse.h: one square sparse matrix and its factors: small ones dense, large ones by KLU
 *
 * The pattern is set once; values any number of times, in the order of the pattern. */
#ifndef COTREE_ALGEBRA_SPARSE_H
#define COTREE_ALGEBRA_SPARSE_H

#include <stdbool.h>

typedef struct Sparse Sparse;

/* New; free with sparse_free(). Entry k is at row[k], column[k]; each position at most once. */
Sparse *sparse_new(int n, int entries, const int *row, const int *column);
void sparse_free(Sparse *sparse); /* NULL is fine */
/* Factor for these values (one an entry). False when singular or not finite. The work of ordering
 * is done at the first call. */
bool sparse_factor(Sparse *sparse, const double *values);
/* least over largest pivot in size, of the last sparse_factor() that succeeded */
double sparse_condition(Sparse *sparse);
void sparse_solve(Sparse *sparse, double *b); /* b becomes the solution */
/* after a failed sparse_factor(): a column that the others span; -1: not known */
int sparse_singular(const Sparse *sparse);

#endif
