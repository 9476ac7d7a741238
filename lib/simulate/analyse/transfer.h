/* transfer.h: transfer functions of linear equations, and their frequency response
 *
 *     H(s) = D + C (s - A)^-1 B = gain prod(s - zero_k) / prod(s - pole_k)
 *
 * of one output against one input, without states that the input doesn't move or the output
 * doesn't see, and without equal poles and zeros. */
#ifndef COTREE_SIMULATE_ANALYSE_TRANSFER_H
#define COTREE_SIMULATE_ANALYSE_TRANSFER_H

#include "algebra/spectrum.h"
#include "simulate/analyse/linear_equations.h"

typedef struct Transfer {
    double gain;   /* 0: the input doesn't reach the output */
    double within; /* where the gain is 0, though rounding leaves that open: what the response may
                      be about the poles */
    int zeros, poles;
    Root *zero, *pole;               /* 1/s; by size; of a conjugate pair both */
    double *numerator, *denominator; /* falling powers of s; zeros + 1, poles + 1; the first of the
                                        denominator is 1 */
    int idle;                        /* states left out since input and output don't meet in them */
    int cancelled; /* poles left out against zeros that rounding can't tell apart */
} Transfer;

/* New; free with transfer_free(). E_SOLVER where poles or zeros can't be found. O(n^3). */
MUST_USE Status transfer_new(const Linear *linear, int output, int input, Transfer **out,
                             Diag *diag);
void transfer_free(Transfer *transfer); /* NULL is fine */

/* dB and degrees at `count` angular frequencies above 0, rad/s. The phase goes on where it passes
 * half a turn; a root on the imaginary axis counts as one just left of it. A pole met exactly has
 * the gain INFINITY, a zero -INFINITY. O(n^3 + count n^2). */
void transfer_response(const Linear *linear, int output, int input, const Transfer *transfer,
                       const double *omega, int count, double *gain, double *phase);

#endif
