/* inverse.h: the efforts that a prescribed motion takes
 *
 * A driver's own effort is minus its multiplier. Where another coordinate supplies it (by=joint),
 * the driver's multiplier is 0 and an effort stands in F instead. Where a source supplies it
 * (by=V1), the currents that the mechanical equations ask for are network states, their rates
 * follow from these equations differentiated along the motion, and the network's equations give the
 * source. */
#ifndef COTREE_SIMULATE_RUN_INVERSE_H
#define COTREE_SIMULATE_RUN_INVERSE_H

#include "base/call_monitor.h"
#include "simulate/assemble/initial.h"
#include "simulate/run/phases.h"

/* whether network states follow from the motion, instead of being integrated */
bool inverse_finds_states(const System *system);
/* Fill a block for each of some rows, and the network states found into them. Fails with E_SINGULAR
 * where no effort produces the motion, E_MODEL where it isn't told by the motion alone; where it is
 * stopped the rows done are all that are left. */
MUST_USE Status inverse_solve(Phases *phases, const Assembled *start, Grid *rows,
                              const CallMonitor *watch, Driven *out, Diag *diag);

#endif
