/* modal.h: coordinates in which M s'' + K s nearly decouples, with bounds of what is left
 *
 * Eigenvalue problem K x = lambda M x. M and K are n x n, stored row by row, every entry with an
 * error bound. The vectors x_k, the columns of X, are those of the symmetric parts: X^T M X is
 * about 1 and X^T K X about diagonal. Errors of the entries then enter as |x|^T |dM| |x| relative
 * to x^T M x, so that slow modes of long chains keep their digits, which they lose in M^-1 K
 * (Parlett 1998, 15.4). */
#ifndef COTREE_ALGEBRA_MODAL_H
#define COTREE_ALGEBRA_MODAL_H

#include <stdbool.h>

/* a matrix and how far its entries may be off, row by row */
typedef struct BoundedMatrix {
    const double *at, *error;
} BoundedMatrix;

typedef struct Modal {
    int n;
    double *vector; /* X, n x n */
    /* X^-1 M^-1 K X = diag(square) + off, each entry known to `error`; where a coordinate meets no
     * stiffness at all its column is 0 and certain. Units of K over M. */
    double *square; /* n */
    double *off;    /* n x n, 0 on the diagonal */
    double *error;
    bool *is_still; /* such columns */
    double *skew;   /* n x n: X^T M X is within that of 1, */
    double skewed;  /* its largest row sum, below 1 */
} Modal;

/* New; free with modal_free(). Coordinates that no entry of the three matrices couples are solved
 * separately; `damping` has no other use here (NULL: none). NULL unless M is proved to be positive
 * definite. O(n^3). */
Modal *modal_new(BoundedMatrix mass, BoundedMatrix stiffness, const BoundedMatrix *damping, int n);
void modal_free(Modal *modal); /* NULL is fine */

/* X^-1 M^-1 b and how far it may be off, b: n x columns; out as b. O(n^2 columns). */
void modal_transform(const Modal *modal, BoundedMatrix b, int columns, double *out,
                     double *out_error);

/* b X, b: rows x n; out as b */
void modal_move(const Modal *modal, BoundedMatrix b, int rows, double *out, double *out_error);

/* The n eigenvalues of M^-1 K in rising order, in groups that are proved to be disjoint. group[k]
 * is the first index of k's group, mean[k] the group's mean, and all its eigenvalues lie within
 * error[k] of it; those of rigid modes are 0. By discs (Gershgorin 1931), weighted so that slow and
 * fast modes don't disturb each other. False where one isn't finite. O(n^2). */
bool modal_groups(const Modal *modal, int *group, double *mean, double *error);

#endif
