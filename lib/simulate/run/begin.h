/* begin.h: start of a run: its solvers, its phases, its initial state, its events */
#ifndef COTREE_SIMULATE_RUN_BEGIN_H
#define COTREE_SIMULATE_RUN_BEGIN_H

#include "simulate/run/active_run.h"

/* New, without rows: programs are compiled, the initial state is found, and the motion is ready;
 * active_run_free(). Fails as initial_find() does, and with E_SINGULAR where a forward run has no
 * accelerations at its start. */
MUST_USE Status run_open(RunKind kind, System *system, const SimulationInput *setting,
                         ActiveRun **out, Diag *diag);
/* The same with the rows of a result, to continue from its end. */
MUST_USE Status run_reopen(const Result *old, const SimulationInput *setting, ActiveRun **out,
                           Diag *diag);
/* Set the phase of the start and `begin`, from the start of its result. */
MUST_USE Status run_begin(ActiveRun *run, const SimulationInput *setting, Diag *diag);

#endif
