/* zero_pencil.h: how far a zero is off, by the matrix that is singular there
 *
 *     [A - z  b] [x]
 *     [  c    d] [u] = 0
 *
 * H(z) tells nothing about a zero that a pole all but equals: H is 0 nearer to it than numbers
 * hold, and u is 0 but for rounding. The null vectors of this matrix tell such a zero as any other.
 */
#ifndef COTREE_SIMULATE_ANALYSE_ZERO_PENCIL_H
#define COTREE_SIMULATE_ANALYSE_ZERO_PENCIL_H

#include "simulate/analyse/siso.h"

#include <complex.h>

/* A bound, to first order, of how far the zero is from z, by the errors of the entries, their last
 * places, and what is left where z is no zero; INFINITY where several lie there. O(n^3) */
double zero_pencil_error(const Siso *single, double complex z);

#endif
