/* zeros.h: zeros of a transfer function, with bounds of their errors */
#ifndef COTREE_SIMULATE_ANALYSE_ZEROS_H
#define COTREE_SIMULATE_ANALYSE_ZEROS_H

#include "algebra/spectrum.h"
#include "simulate/analyse/gain.h"

/* From gain and poles (n), write the zeros of d + c (s - A)^-1 b (room for n). False where they
 * can't be found. O(n^3). */
MUST_USE bool zeros_find(const Siso *single, const Gain *gain, const Root *pole, Root *zero,
                         int *count);

/* all results together, borrowed */
typedef struct Answer {
    const Gain *gain;
    const Root *pole, *zero; /* n, zeros */
    int zeros;
} Answer;

/* Whether the response at some points agrees with these, within the errors of entries and roots and
 * the rounding error of both; values with large errors are not checked. *largest: a bound of the
 * response there. O(n^3). */
bool zeros_agree(const Siso *single, const Answer *answer, double *largest);

#endif
