/* transfer.h: transfer functions of linear equations, and their frequency response
 *
 *     H(s) = D + C (s - A)^-1 B = gain prod(s - zero_k) / prod(s - pole_k)
 *
 * of one output for one input, without states that the input doesn't reach or that don't affect the
 * output, and without equal poles and zeros. */
#ifndef COTREE_SIMULATE_ANALYSE_TRANSFER_H
#define COTREE_SIMULATE_ANALYSE_TRANSFER_H

#include "algebra/spectrum.h"
#include "simulate/analyse/linear_equations.h"

typedef struct Transfer {
    double gain;   /* 0: the input doesn't affect the output */
    double within; /* where the gain is 0 within rounding error: a bound of the response near the
                      poles */
    int zeros, poles;
    Root *zero, *pole;               /* 1/s; ascending size; both of a conjugate pair */
    double *numerator, *denominator; /* descending powers of s; zeros + 1, poles + 1; the first of
                                        the denominator is 1 */
    int idle;                        /* states left out since input and output don't meet in them */
    int cancelled; /* poles cancelled against zeros that are equal within rounding error */
} Transfer;

/* New; free with transfer_free(). E_SOLVER where poles or zeros can't be found. O(n^3). */
MUST_USE Status transfer_new(const Linear *linear, int output, int input, Transfer **out,
                             Diag *diag);
void transfer_free(Transfer *transfer); /* NULL is fine */

/* dB and degrees at `count` angular frequencies above 0, rad/s. The phase is continuous beyond half
 * a turn; a root on the imaginary axis counts as one just left of it. Exactly at a pole the gain is
 * INFINITY, at a zero -INFINITY. O(n^3 + count n^2). */
void transfer_response(const Linear *linear, int output, int input, const Transfer *transfer,
                       const double *omega, int count, double *gain, double *phase);

#endif
