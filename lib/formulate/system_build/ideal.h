/* ideal.h: how many switches are ideal, and modes that keep the states */
#ifndef COTREE_FORMULATE_SYSTEM_BUILD_IDEAL_H
#define COTREE_FORMULATE_SYSTEM_BUILD_IDEAL_H

#include "formulate/system/network.h"

/* how many switches are without resistance on one side or on both */
int system_truly_ideal_count(const System *system);
/* Whether the network with its ideal switches on these sides keeps the states of the whole, for all
 * that its graph tells: then a number for each side makes that mode of any other such one. */
bool ideal_keeps_states(const System *system, const bool *closed);

#endif
