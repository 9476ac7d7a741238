/* stagnation.h: whether steps make progress, or are as short as rounding error makes them
 *
 * Where a tolerance is below the rounding error of the rates, error estimates are proportional to
 * the step and no longer to its power: steps become so short that a run doesn't end. The roughness
 * of the rates at points ahead distinguishes such a run from one that is long for good reasons:
 * roughness times step is the error then. */
#ifndef COTREE_SIMULATE_INTEGRATE_STAGNATION_H
#define COTREE_SIMULATE_INTEGRATE_STAGNATION_H

#include "simulate/integrate/ode.h"

typedef struct StagnationMonitor {
    int64_t steps; /* at the last check */
    double t;      /* s */
} StagnationMonitor;

/* Call after each step, with the number of steps of the whole run. A check costs a few evaluations
 * in some thousand steps, and only where the run would take a million. E_SOLVER where there is no
 * progress; *is_rounding: because of rounding error. */
MUST_USE Status stagnation_check(StagnationMonitor *stagnation, Stepper *stepper, int64_t steps,
                                 bool *is_rounding, Diag *diag);
/* Whether the rounding error of the rates exceeds the tolerance in a step h, where steps have
 * failed: then the diag reports it, with a remedy. A few evaluations. */
bool stagnation_is_rounding(Stepper *stepper, double h, Diag *diag);

#endif
