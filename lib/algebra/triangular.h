/* triangular.h: sparse rows in a block triangular form of small blocks
 *
 * Each group consists of a few rows and columns of its own, in which no later group has entries. In
 * absolute coordinates these are the rows of a joint and the speeds of its outboard body, from the
 * tips of a tree to its root. As long as each group is independent in its own columns, so are all
 * rows, however many they are. */
#ifndef COTREE_ALGEBRA_TRIANGULAR_H
#define COTREE_ALGEBRA_TRIANGULAR_H

#include "algebra/pattern.h"

typedef struct Triangular Triangular;

/* Of these m columns of the pattern, which are the rows; borrows the pattern and the rows. New;
 * triangular_free(). NULL: there is no such form. O(entries of the pattern). */
Triangular *triangular_new(const Pattern *pattern, const int *rows, int m);
void triangular_free(Triangular *triangular); /* NULL is fine */
int triangular_groups(const Triangular *triangular);
int triangular_group_of(const Triangular *triangular, int k); /* of the k-th row */
/* The least remainder of a group's rows, in the group's own columns, after elimination of the rows
 * before: its square over norm[] (by columns of the pattern). Entries are divided by the roots of
 * square[] (by rows of the pattern); `values` are by its places. NaN counts as 0. */
double triangular_rest(const Triangular *triangular, int group, const double *values,
                       const double *square, const double *norm);

#endif
