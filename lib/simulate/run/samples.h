/* samples.h: states that are held, and replaced at each instant of their own period: sampled
 * control
 *
 * Instants are whole multiples of the period, 0 among them. Values at an instant are those just
 * before it, of all that is sampled there together. Inputs are set by the host of the run; what it
 * set before is taken again. */
#ifndef COTREE_SIMULATE_RUN_SAMPLES_H
#define COTREE_SIMULATE_RUN_SAMPLES_H

#include "simulate/equations/compiled_equations.h"

typedef struct Samples Samples;

/* New, or NULL where nothing is sampled; samples_free(). Borrows all. Fails with E_VALUE for a
 * period that is no time, and as system_resolve() does. */
MUST_USE Status samples_new(const VariableIndex *layout, Parameters *parameters, Motion *motion,
                            Host *host, Samples **out, Diag *diag);
void samples_free(Samples *samples); /* NULL is fine, here and below */
/* Refuse a run of that duration in which something would be sampled more often than anybody waits
 * for: E_VALUE. */
MUST_USE Status samples_check(const Samples *samples, double duration, Diag *diag);
/* the first instant behind t, of all of them; INFINITY: there is none */
double samples_next(const Samples *samples, double t);
/* Replace what is due at t in y = (q, u, x, ..). *due: something was. E_SOLVER where the equations
 * have no solution, E_STOPPED where the host asks for it. */
MUST_USE Status samples_read(Samples *samples, double t, double *y, bool *due, Diag *diag);

#endif
