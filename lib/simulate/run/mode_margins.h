/* mode_margins.h: whether ideal switches may be in their mode at an instant */
#ifndef COTREE_SIMULATE_RUN_MODE_MARGINS_H
#define COTREE_SIMULATE_RUN_MODE_MARGINS_H

#include "simulate/run/phase.h"

#define MARGIN_ROUNDING 1e-13 /* of the largest margin: what rounding does to any */

/* How far off the margins of a phase are that begins at (t, y), in tolerances of the control: what
 * the states move by until all of them have risen above 0. 0 where they are, INFINITY where one
 * doesn't rise. `behind`: the time that rates see; `step`: short against all that happens, s. */
double mode_margins_off(Phase *phase, double t, double behind, double step, const double *y,
                        const Control *control);

/* By how many tolerances the first `count` of y move in so long a time, s, at these rates. */
double mode_margins_moves(double time, const double *y, const double *rate, int count,
                          const Control *control);
/* Up to where a margin tells no sign, where the largest of them is that large. */
double mode_margins_noise(double largest, const Control *control);

#endif
