/* ideal.h: ideal switches in the equations of a network */
#ifndef COTREE_FORMULATE_IDEAL_H
#define COTREE_FORMULATE_IDEAL_H

#include "formulate/network.h"

/* how many switches are without resistance on one side or on both (ideal.c) */
int system_truly_ideal_count(const System *system);
/* the relation of a switch, on its side or of both (ideal.c) */
void ideal_take_side(System *system, Branchlike *branch);
/* Whether the network with its ideal switches on these sides keeps the states of the whole, for all
 * that its graph tells: then a number for each side makes that mode of any other such one. */
bool ideal_keeps_states(const System *system, const bool *closed);
/* What closed switches alone in a circuit share, or open ones alone in a cutset: currents as if by
 * equal resistances, voltages likewise. *shared: it is so, and *out = 0 */
MUST_USE Status ideal_share(System *system, const Branchlike *branch, bool *shared, Expr *out,
                            Diag *diag);

#endif
