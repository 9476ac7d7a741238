/* global_error.h: how far off a run is, by runs that are finer
 *
 * A second run at a hundredth of the tolerance is taken for the motion: the difference is the error
 * of the first. It takes the same method, or the default one in the place of one with a history or
 * of fixed steps. Where the two are far apart the finer one may be as wrong, and where they are
 * nearer than its own error it may be worse: then a third run, and at most a fourth, are finer
 * again. */
#ifndef COTREE_SIMULATE_RUN_GLOBAL_ERROR_H
#define COTREE_SIMULATE_RUN_GLOBAL_ERROR_H

#include "simulate/run/active_run.h"
#include "simulate/run/run.h"

/* the events of the finer runs, as they are where the run begins; {0} is none */
typedef struct ErrorEvents {
    Events *at[3];
} ErrorEvents;

MUST_USE Status global_error_events(ActiveRun *run, const SimulationInput *setting,
                                    ErrorEvents *out, Diag *diag);
void global_error_events_free(ErrorEvents *events);

/* Put into the report of a run, which has come to its end, how far off its rows from `first` on are
 * (largest over coordinates, speeds and states, in m, rad, A ... alike), or that it isn't resolved.
 * method: the one that was asked for, NULL: none. Fails where it is stopped. Up to three runs'
 * time. */
MUST_USE Status global_error_estimate(ActiveRun *run, const SimulationInput *setting,
                                      const RunOptions *options, const Method *method,
                                      ErrorEvents *events, int first, Diag *diag);

#endif
