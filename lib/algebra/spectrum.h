/* spectrum.h: eigenvalues of real matrices, with error bounds
 *
 * Matrices are stored row by row. Every entry has an error bound. The error bounds of eigenvalues
 * follow from these and don't depend on the scaling of the states. */
#ifndef COTREE_ALGEBRA_SPECTRUM_H
#define COTREE_ALGEBRA_SPECTRUM_H

#include "algebra/roots.h"
#include "base/diag.h"

typedef struct Spectrum Spectrum;

/* New; free with spectrum_free(). NULL where the eigenvalues can't be found. An entry that is 0
 * with error 0 is structurally 0: eigenvalues of a block triangular matrix are those of its blocks.
 * Eigenvalues that can't be distinguished are returned as their mean, repeated, which has a far
 * smaller error. O(n^3). */
Spectrum *spectrum_new(const double *a, const double *error, int n);
void spectrum_free(Spectrum *spectrum); /* NULL is fine */
/* all n of them; of a conjugate pair both, the one above the real axis first */
const Root *spectrum_roots(const Spectrum *spectrum);
/* The mode shape of root k: an eigenvector (n), the largest entry about 1; if there is none, the
 * direction of growth in its place. */
void spectrum_vector(const Spectrum *spectrum, int k, double complex *out);

#endif
