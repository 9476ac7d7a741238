/* spectrum.h: eigenvalues of real matrices, with what they are known to
 *
 * Matrices stand row by row. Every entry comes with how far it may be off; the errors of
 * eigenvalues follow from that and don't depend on how the states are scaled. */
#ifndef COTREE_ALGEBRA_SPECTRUM_H
#define COTREE_ALGEBRA_SPECTRUM_H

#include "algebra/wide.h"
#include "base/diag.h"

#include <stdbool.h>

/* an eigenvalue, a pole or a zero, 1/s */
typedef struct Root {
    double real, imaginary;
    double error;    /* the true one lies within */
    bool is_on_axis; /* the real part is 0 whatever the errors: nothing damps */
} Root;

/* the sign of the real part can't be told, which is 0 then; so is a root that may be 0 altogether
 */
bool root_is_doubtful(const Root *root);

typedef struct Spectrum Spectrum;

/* New; free with spectrum_free(). NULL where the eigenvalues can't be found. An entry that is 0 and
 * has the error 0 isn't there: of what doesn't act back, eigenvalues are those of the parts.
 * Eigenvalues that can't be told apart are one, several times: their mean, which is known far
 * better. O(n^3). */
Spectrum *spectrum_new(const double *a, const double *error, int n);
void spectrum_free(Spectrum *spectrum); /* NULL is fine */
/* all n of them; of a conjugate pair both, the one above the real axis first */
const Root *spectrum_roots(const Spectrum *spectrum);
/* What moves with root k: an eigenvector (n), the largest entry about 1; where there is none, what
 * grows in its place. */
void spectrum_vector(const Spectrum *spectrum, int k, double complex *out);

/* --- parts that serve elsewhere --- */

/* Mean of those that can't be told apart: count roots with their errors, of which `value` holds all
 * conjugate ones. `error_of` tells the error of some of them together. */
typedef double GroupError(void *context, const int *members, int count, double complex mean);
void roots_join(const double complex *value, const double *error, int count, GroupError *error_of,
                void *context, Root *out);

/* A root that errors of the data move by `error`, found with a method whose rounding is `noise`:
 * their sum. A root other than 0 moves with the data in proportion; one that doesn't move and is
 * rounding of the method itself is 0 by where the entries stand, without error. */
double complex root_with_noise(double complex value, double noise, double *error);

/* a number in (-1, 1) that is always the same at a place, for disturbances */
double disturbance(int i, int j);

#endif
