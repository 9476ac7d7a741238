/* edge_power.h: through times across variables of mechanical edges */
#ifndef COTREE_FORMULATE_DYNAMICS_EDGE_POWER_H
#define COTREE_FORMULATE_DYNAMICS_EDGE_POWER_H

#include "formulate/system/system.h"

/* whether a member is a power of the part's mechanical edge: "power" where it has no other,
 * "power.translation", "power.rotation", "power.deformation" */
bool edge_power_is_named(const Instance *part, const char *member);
/* That power, W, in (q, u, u', x, z, lambda, t): what the edge gives to its frames. Fails with
 * E_MISSING where accelerations or a law can't be determined. O(nodes), after the reactions. */
MUST_USE Status edge_power(System *system, const Instance *part, const char *member, Expr *out,
                           Diag *diag);

#endif
