/* gain.h: the first of the Markov parameters d, c b, c A b ... that isn't 0 */
#ifndef COTREE_SIMULATE_ANALYSE_GAIN_H
#define COTREE_SIMULATE_ANALYSE_GAIN_H

#include "base/diag.h"
#include "simulate/analyse/siso.h"

typedef struct Gain {
    int degree;   /* 0: d, 1: c b, 2: c A b ...; n + 1 where all are 0 within their errors */
    double value; /* INFINITY where it overflows; 0 where there is none */
    bool is_open; /* there is none, but within the errors of the entries there may be */
} Gain;

/* False where rounding error prevents a decision. O(n^3). */
MUST_USE bool gain_find(const Siso *single, Gain *out);

#endif
