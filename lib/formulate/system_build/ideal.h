/* ideal.h: number of ideal switches, and modes with unchanged states */
#ifndef COTREE_FORMULATE_SYSTEM_BUILD_IDEAL_H
#define COTREE_FORMULATE_SYSTEM_BUILD_IDEAL_H

#include "formulate/system/network.h"

/* number of switches without resistance on one side or on both */
int system_truly_ideal_count(const System *system);
/* Whether the network with its ideal switches on these sides has the states of the hybrid system,
 * as far as its graph determines them: then a number for each side makes that mode of any other
 * such one. */
bool ideal_keeps_states(const System *system, const bool *closed);

#endif
