/* series.h: flights between impacts or events that become ever shorter */
#ifndef COTREE_SIMULATE_RUN_SERIES_H
#define COTREE_SIMULATE_RUN_SERIES_H

#include <math.h>

/* s: how long flights take together, of which the next one takes `next` and each of the others
 * `ratio` times as long as the one before */
static inline double series_left(double next, double ratio)
{
    return ratio < 1 ? next / (1 - ratio) : INFINITY;
}

#endif
