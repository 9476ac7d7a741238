/* block_triangular.h: block triangular form of square matrices
 *
 * A pattern marks the entries of an n x n matrix, row by row, that may differ from 0. */
#ifndef COTREE_ALGEBRA_BLOCK_TRIANGULAR_H
#define COTREE_ALGEBRA_BLOCK_TRIANGULAR_H

#include <stdbool.h>

/* blocks of states, each before all that it acts on: block b is order[start[b]] up to
 * order[start[b + 1]], rising within a block */
typedef struct BlockTriangular {
    int count;
    int *start; /* count + 1 */
    int *order; /* n */
} BlockTriangular;

/* States that act on each other both ways, entry (i, j) being how j acts on i: strongly connected
 * components (Tarjan 1972). New; free with block_triangular_free(). O(n^2). */
BlockTriangular block_triangular_find(const bool *pattern, int n);
void block_triangular_free(BlockTriangular *blocks);

/* A row for each column, such that no entry column[r] of row r is 0 (Duff 1981): column[r], or
 * false where there is no such choice, and every matrix of the pattern is singular. O(n^3), mostly
 * far less. */
bool block_triangular_match(const bool *pattern, int n, int *column);

/* Whether the states split into two kinds, each of which acts on the other kind only. The
 * eigenvalues are then symmetric about the imaginary axis. O(n^2). */
bool block_triangular_alternate(const bool *pattern, int n);

#endif
