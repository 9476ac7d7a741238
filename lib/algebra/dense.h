/* dense.h: matrices, vectors and permutations for GSL in memory of ours
 *
 * GSL's own ends the program where there is no memory. Each is new and zeroed, one piece, to be
 * freed with mem_free(). */
#ifndef COTREE_ALGEBRA_DENSE_H
#define COTREE_ALGEBRA_DENSE_H

#include <gsl/gsl_matrix.h>
#include <gsl/gsl_permutation.h>
#include <gsl/gsl_vector.h>

gsl_matrix *dense_matrix(size_t rows, size_t columns);
gsl_vector *dense_vector(size_t count);
gsl_permutation *dense_permutation(size_t count);

/* Switch off GSL's error handler, which ends the program, once for the whole process. The codes
 * that GSL's functions return report the same errors. Each function above does so. A session does
 * so when it is created, so that an embedding program knows when. */
void dense_quiet(void);

#endif
