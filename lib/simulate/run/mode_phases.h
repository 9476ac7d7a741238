/* mode_phases.h: phases of a run, made where they are met first; the run owns them */
#ifndef COTREE_SIMULATE_RUN_MODE_PHASES_H
#define COTREE_SIMULATE_RUN_MODE_PHASES_H

#include "simulate/run/active_run.h"

/* The phase of this mode, a side an ideal switch. Fails with E_MODEL where the network has no
 * equations in it. */
MUST_USE Status mode_phases_get(ActiveRun *run, const SimulationInput *setting, const bool *closed,
                                Phase **out, Diag *diag);

/* The phase of a system in this mode of its switches (NULL: in none), that stays on sides of
 * surfaces. */
MUST_USE Status mode_phases_get_on(ActiveRun *run, const SimulationInput *setting, System *system,
                                   const bool *closed, const OnSurface *on, int count, Phase **out,
                                   Diag *diag);
/* `events`, which go on in another phase; NULL: there are none */
MUST_USE Status mode_phases_events(ActiveRun *run, const Phase *now, const Phase *next,
                                   const SimulationInput *setting, Events **events, Diag *diag);

#endif
