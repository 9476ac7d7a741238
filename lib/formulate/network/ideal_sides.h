/* ideal_sides.h: relations of ideal switches in the equations of a network, by switch state
 * (side) */
#ifndef COTREE_FORMULATE_NETWORK_IDEAL_SIDES_H
#define COTREE_FORMULATE_NETWORK_IDEAL_SIDES_H

#include "formulate/system/network.h"

/* sets the relation of a switch: of its side, or of both sides */
void ideal_set_side(System *system, Branchlike *branch);
/* The shares of closed switches in a circuit of closed switches alone, or of open ones in such a
 * cutset: currents as by equal resistances, voltages likewise. *shared: it is so, and *out = 0 */
MUST_USE Status ideal_share(System *system, const Branchlike *branch, bool *shared, Expr *out,
                            Diag *diag);

#endif
