/* zero_pencil.h: the error of a zero, from the matrix that is singular there
 *
 *     [A - z  b] [x]
 *     [  c    d] [u] = 0
 *
 * H(z) is no guide to a zero that nearly equals a pole: H is 0 closer to it than double precision
 * resolves, and u is 0 within rounding. The null vectors of this matrix determine such a zero as
 * well as any other. */
#ifndef COTREE_SIMULATE_ANALYSE_ZERO_PENCIL_H
#define COTREE_SIMULATE_ANALYSE_ZERO_PENCIL_H

#include "simulate/analyse/siso.h"

#include <complex.h>

/* A first-order bound of the distance of the zero from z, from the errors of the entries, their
 * last places, and the residual where z is no zero; INFINITY where several zeros are there.
 * O(n^3) */
double zero_pencil_error(const Siso *single, double complex z);

#endif
