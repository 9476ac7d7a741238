/* sampling.h: points of the unit cube, a row for each run */
#ifndef COTREE_SIMULATE_SWEEP_SAMPLING_H
#define COTREE_SIMULATE_SWEEP_SAMPLING_H

#include "base/diag.h"

#include <stdint.h>

typedef enum Sampling {
    SAMPLING_RANDOM, /* independent */
    SAMPLING_LATIN,  /* Latin hypercube: in each column one point in each of `runs` intervals */
    SAMPLING_SOBOL,  /* Sobol' points: the same for every seed */
    SAMPLINGS
} Sampling;

const char *sampling_name(Sampling sampling); /* "random" ... */
/* Fill runs x columns numbers of (0, 1), row by row. Row k of random and Sobol' points doesn't
 * depend on `runs`. E_VALUE: Sobol' points have no so many columns. No place. O(runs columns). */
MUST_USE Status sampling_fill(Sampling sampling, uint64_t seed, int runs, int columns, double *out,
                              Diag *diag);

#endif
