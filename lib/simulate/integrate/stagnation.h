/* stagnation.h: whether steps get anywhere, or are as short as rounding makes them
 *
 * Where a tolerance is below what rounding leaves of the rates, estimates of errors shrink like the
 * step and no longer like its power: steps become so short that a run has no end. It is told from
 * one that is long for good reasons by how rough rates are on the way ahead: that, times the step,
 * is the error then. */
#ifndef COTREE_SIMULATE_INTEGRATE_STAGNATION_H
#define COTREE_SIMULATE_INTEGRATE_STAGNATION_H

#include "simulate/integrate/ode.h"

typedef struct StagnationMonitor {
    int64_t steps; /* when it was last looked at */
    double t;      /* s */
} StagnationMonitor;

/* To be called after each step, with the number of steps of the whole run; a look costs a few
 * evaluations in some thousand steps, and only where the run would take a million. E_SOLVER;
 * *is_rounding: for rounding. */
MUST_USE Status stagnation_check(StagnationMonitor *stagnation, Stepper *stepper, int64_t steps,
                                 bool *is_rounding, Diag *diag);
/* Whether rounding leaves more of the rates than the tolerance allows a step of h, where steps have
 * failed: then the diag says so, with a way out. A few evaluations. */
bool stagnation_is_rounding(Stepper *stepper, double h, Diag *diag);

#endif
