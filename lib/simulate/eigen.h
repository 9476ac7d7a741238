/* eigen.h: eigenvalues of real matrices, with what is 0 as 0
 *
 * Matrices stand row by row. */
#ifndef COTREE_SIMULATE_EIGEN_H
#define COTREE_SIMULATE_EIGEN_H

#include "simulate/linearize.h"

#include <gsl/gsl_vector.h>

typedef struct Root {
    double real, imaginary;
} Root;

/* All n of them; of a conjugate pair both, the one above the real axis first. Parts of the matrix
 * that don't act back on one another are solved one by one, so that what they have in common comes
 * out the same. False where the method doesn't converge. O(n^3). */
MUST_USE bool eigen_values(const double *a, int n, Root *out);

/* Eigenvalues 0, where nothing pushes back: as many as the rank of A lacks, and up to as many again
 * where what drifts drifts on. Of such pairs rounding makes roots of itself. */
void eigen_set_zeros(const double *a, int n, gsl_vector_complex *values);

/* A, and a column of B or a row of C, with what is rounding among entries of a kind (speeds by
 * positions, say) as 0 */
void linear_clean(const Linear *linear, double *a);
void linear_clean_vector(const Linear *linear, const double *from, int stride, double *out);

#endif
