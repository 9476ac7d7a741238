/* forward.h: a forward run from phase to phase, from a given initial state */
#ifndef COTREE_SIMULATE_RUN_FORWARD_H
#define COTREE_SIMULATE_RUN_FORWARD_H

#include "simulate/run/active_run.h"
#include "simulate/run/integration.h"
#include "simulate/run/run.h"

/* From the start of the run, by a method (NULL: one that suits the equations); the caller sets
 * start and end time, s. All is borrowed. */
IntegrationPlan forward_plan(const ActiveRun *run, const SimulationInput *setting,
                             const RunOptions *options, const Method *method, Events *events);
/* From `begin` to the end of the plan; fails as integrate() does, and fills the same data. Where
 * ideal switches change the equations, `corners` gets the rows at these changes (NULL: not
 * wanted). */
MUST_USE Status forward_integrate(ActiveRun *run, const SimulationInput *setting,
                                  const IntegrationPlan *plan, Grid *grid, Grid *corners,
                                  IntegrationReport *out, Diag *diag);
/* Make the expressions that a host receives at the rows of a phase, once. */
MUST_USE Status forward_probe_seen(ActiveRun *run, Phase *phase, const Host *host, Diag *diag);
/* the `see` of a plan whose rows a host receives */
bool forward_show_row(void *context, int phase_number, double t, const double *y);

#endif
