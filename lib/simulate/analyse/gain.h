/* gain.h: the first of d, c b, c A b ... that isn't 0 */
#ifndef COTREE_SIMULATE_ANALYSE_GAIN_H
#define COTREE_SIMULATE_ANALYSE_GAIN_H

#include "base/diag.h"
#include "simulate/analyse/siso.h"

typedef struct Gain {
    int degree;   /* 0: d, 1: c b, 2: c A b ...; n + 1 where none can be told from 0 */
    double value; /* INFINITY where no number holds it; 0 where there is none */
    bool is_open; /* there is none, but within what entries may be off by there may be */
} Gain;

/* False where rounding leaves open what the entries decide. O(n^3). */
MUST_USE bool gain_find(const Siso *single, Gain *out);

#endif
