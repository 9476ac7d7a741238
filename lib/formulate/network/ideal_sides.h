/* ideal_sides.h: ideal switches in the equations of a network: the sides that they are on */
#ifndef COTREE_FORMULATE_NETWORK_IDEAL_SIDES_H
#define COTREE_FORMULATE_NETWORK_IDEAL_SIDES_H

#include "formulate/system/network.h"

/* the relation of a switch, on its side or of both */
void ideal_set_side(System *system, Branchlike *branch);
/* What closed switches alone in a circuit share, or open ones alone in a cutset: currents as if by
 * equal resistances, voltages likewise. *shared: it is so, and *out = 0 */
MUST_USE Status ideal_share(System *system, const Branchlike *branch, bool *shared, Expr *out,
                            Diag *diag);

#endif
