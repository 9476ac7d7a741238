/* inverse.h: the efforts that a prescribed motion requires
 *
 * A driver's own effort is minus its multiplier. Where another coordinate supplies it (by=joint),
 * the driver's multiplier is 0 and F contains an unknown effort instead. Where a source supplies it
 * (by=V1), the currents that the mechanical equations require are network states. The derivatives
 * of these equations along the motion determine their rates, and the network's equations determine
 * the source. */
#ifndef COTREE_SIMULATE_RUN_INVERSE_H
#define COTREE_SIMULATE_RUN_INVERSE_H

#include "base/call_monitor.h"
#include "simulate/assemble/initial.h"
#include "simulate/run/phases.h"

/* whether network states are computed from the motion, instead of being integrated */
bool inverse_finds_states(const System *system);
/* Compute a block for each of some rows, and store the network states in them. Fails with
 * E_SINGULAR where no effort produces the motion, E_MODEL where the motion alone doesn't determine
 * it. Where it is stopped, only the finished rows are left. */
MUST_USE Status inverse_solve(Phases *phases, const Assembled *start, Grid *rows,
                              const CallMonitor *watch, Driven *out, Diag *diag);

#endif
