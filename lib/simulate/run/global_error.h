/* global_error.h: the global error of a run, from finer runs
 *
 * A second run at a hundredth of the tolerance is the reference: the difference is the error of the
 * first. It uses the same method, or the default one in place of a multistep method or of fixed
 * steps. Where the two are far apart the finer one may be as wrong, and where their difference is
 * below its own error it may be worse. Then a third run, and at most a fourth, are finer again. */
#ifndef COTREE_SIMULATE_RUN_GLOBAL_ERROR_H
#define COTREE_SIMULATE_RUN_GLOBAL_ERROR_H

#include "simulate/run/active_run.h"
#include "simulate/run/run.h"

/* the events of the finer runs, in their states at the start of the run; {0} is none */
typedef struct ErrorEvents {
    Events *at[3];
} ErrorEvents;

MUST_USE Status global_error_events(ActiveRun *run, const SimulationInput *setting,
                                    ErrorEvents *out, Diag *diag);
void global_error_events_free(ErrorEvents *events);

/* Store in the report of a finished run the global error of its rows from `first` on (largest over
 * coordinates, speeds and states, in m, rad, A ... without distinction), or that the motion isn't
 * resolved. method: the one that the user requested, NULL: none. Fails where it is stopped. Takes
 * the time of up to three runs. */
MUST_USE Status global_error_estimate(ActiveRun *run, const SimulationInput *setting,
                                      const RunOptions *options, const Method *method,
                                      ErrorEvents *events, int first, Diag *diag);

#endif
