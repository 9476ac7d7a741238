/* modal.h: coordinates in which M s'' + K s nearly decouples, with bounds of what is left
 *
 * M and K stand row by row, n x n, every entry with how far it may be off. Vectors x_k, the columns
 * of X, are found for their symmetric parts, X^T M X being about 1 and X^T K X about diagonal. What
 * the entries leave open then counts in sizes |x|^T |dM| |x| beside x^T M x, so that slow modes of
 * long chains keep their digits, which they lose in M^-1 K (Parlett 1998, 15.4). */
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

/* New; free with modal_free(). What no entry of the three couples stays apart; `damping` has no
 * other use here (NULL: none). NULL where M isn't positive definite for certain. O(n^3). */
Modal *modal_new(BoundedMatrix mass, BoundedMatrix stiffness, const BoundedMatrix *damping, int n);
void modal_free(Modal *modal); /* NULL is fine */

/* X^-1 M^-1 b and how far it may be off, b: n x columns; out as b. O(n^2 columns). */
void modal_transform(const Modal *modal, BoundedMatrix b, int columns, double *out,
                     double *out_error);

/* b X, b: rows x n; out as b */
void modal_move(const Modal *modal, BoundedMatrix b, int rows, double *out, double *out_error);

/* The n eigenvalues of M^-1 K as groups that are apart for certain, rising: group[k] is the first
 * of k's, mean[k] their mean, within error[k] of which they all lie; those of still ones are 0. By
 * discs (Gershgorin 1931), weighted so that slow and fast ones don't disturb each other. False
 * where one isn't finite. O(n^2). */
bool modal_groups(const Modal *modal, int *group, double *mean, double *error);

#endif
