/* enclosure.h: simple eigenvalues of real matrices in doubles, with proved error bounds
 *
 * Works for well separated eigenvalues. Returns false for others, which need numbers of twice the
 * digits (schur.h). */
#ifndef COTREE_ALGEBRA_ENCLOSURE_H
#define COTREE_ALGEBRA_ENCLOSURE_H

#include "algebra/double_double.h"

#include <stdbool.h>

/* of an n x n matrix, n eigenvalues */
typedef struct Enclosure {
    int n;
    double complex *value; /* conjugate ones exactly, the one above the real axis first */
    double complex *right; /* vectors as columns, of length 1 */
    double complex *left;  /* as rows: the inverse of `right`, nearly */
    double *error;         /* each disc of this radius about a value contains one eigenvalue */
    /* true vectors are X (1 + W) and (1 + Z) Y, |W| and |Z| being these at most */
    double *turn_right, *turn_left; /* n x n */
} Enclosure;

/* The matrix is stored row by row and balanced. False where the discs can't be proved to be
 * disjoint. Free with enclosure_free() in either case. O(n^3). */
bool enclosure_find(const DoubleDouble *a, int n, Enclosure *out);
void enclosure_free(Enclosure *enclosure);

#endif
