/* spectrum.h: eigenvalues of real matrices, with error bounds
 *
 * Matrices are stored row by row. Every entry has an error bound. The error bounds of eigenvalues
 * follow from these and don't depend on the scaling of the states. */
#ifndef COTREE_ALGEBRA_SPECTRUM_H
#define COTREE_ALGEBRA_SPECTRUM_H

#include "algebra/roots.h"
#include "base/diag.h"

typedef struct Spectrum Spectrum;

/* New; free with spectrum_free(). NULL where the eigenvalues can't be found. An entry that is 0 and
 * has the error 0 isn't there: of what doesn't act back, eigenvalues are those of the parts.
 * Eigenvalues that can't be distinguished are one, several times: their mean, which is known far
 * better. O(n^3). */
Spectrum *spectrum_new(const double *a, const double *error, int n);
void spectrum_free(Spectrum *spectrum); /* NULL is fine */
/* all n of them; of a conjugate pair both, the one above the real axis first */
const Root *spectrum_roots(const Spectrum *spectrum);
/* What moves with root k: an eigenvector (n), the largest entry about 1; where there is none, what
 * grows in its place. */
void spectrum_vector(const Spectrum *spectrum, int k, double complex *out);

#endif
