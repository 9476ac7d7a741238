/* samples.h: states that are held, and replaced at each instant of their own period: sampled
 * control
 *
 * Sampling instants are whole multiples of the period, 0 included. The new values at an instant
 * follow from the values just before it, for all states that are sampled there. The host of the run
 * sets inputs; when a part of the run is repeated the recorded values are used. */
#ifndef COTREE_SIMULATE_RUN_SAMPLES_H
#define COTREE_SIMULATE_RUN_SAMPLES_H

#include "simulate/equations/compiled_equations.h"

typedef struct Samples Samples;

/* New, or NULL where nothing is sampled; samples_free(). Borrows all. Fails with E_VALUE for a
 * period that isn't a valid time, and as system_resolve() does. */
MUST_USE Status samples_new(const VariableIndex *layout, Parameters *parameters, Motion *motion,
                            Host *host, Samples **out, Diag *diag);
void samples_free(Samples *samples); /* NULL is fine, here and below */
/* Refuse a run of that duration with too many sampling instants: E_VALUE. */
MUST_USE Status samples_check(const Samples *samples, double duration, Diag *diag);
/* the first sampling instant after t; INFINITY: there is none */
double samples_next(const Samples *samples, double t);
/* Replace states that are due at t in y = (q, u, x, ..). *due: there were some. E_SOLVER where the
 * equations have no solution, E_STOPPED where the host requests it. */
MUST_USE Status samples_read(Samples *samples, double t, double *y, bool *due, Diag *diag);

#endif
