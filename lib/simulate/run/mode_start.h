/* mode_start.h: the mode that a run of a model with ideal switches starts in */
#ifndef COTREE_SIMULATE_RUN_MODE_START_H
#define COTREE_SIMULATE_RUN_MODE_START_H

#include "simulate/run/active_run.h"

/* The phase that a run starts in, and `begin`, from the start of its result, which is of the whole.
 * Fails where the ideal switches have no mode at the start, and where the network has no solution.
 */
MUST_USE Status mode_start(ActiveRun *run, const SimulationInput *setting, Diag *diag);

#endif
