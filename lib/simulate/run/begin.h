/* begin.h: how a run begins: what integrates it, with its phases, its start, its events */
#ifndef COTREE_SIMULATE_RUN_BEGIN_H
#define COTREE_SIMULATE_RUN_BEGIN_H

#include "simulate/run/active_run.h"

/* New, of no rows: programs compiled, start found, motion ready; active_run_free(). Fails as
 * initial_find() does, with E_SINGULAR where a forward run has no accelerations at its start. */
MUST_USE Status run_open(RunKind kind, System *system, const SimulationInput *setting,
                         ActiveRun **out, Diag *diag);
/* The same with the rows of a result, to go on where that ended. */
MUST_USE Status run_reopen(const Result *old, const SimulationInput *setting, ActiveRun **out,
                           Diag *diag);
/* The phase that it starts in and `begin`, from the start of its result. */
MUST_USE Status run_begin(ActiveRun *run, const SimulationInput *setting, Diag *diag);

#endif
