/* resolve.h: from a user's expressions to the system's own, and their rates */
#ifndef COTREE_FORMULATE_SYSTEM_RESOLVE_H
#define COTREE_FORMULATE_SYSTEM_RESOLVE_H

#include "formulate/system/system.h"

/* E_MISSING while reactions, multipliers and entries of M can't be determined yet */
MUST_USE Status system_wait_for_motion(System *system, Diag *diag);
/* e over user's variables to e over the system's */
MUST_USE Status variables_resolve(System *system, Expr user, Expr *out, Diag *diag);
/* derivative along the motion: q -> q', u -> u', x -> x', t -> 1 */
MUST_USE Status system_rate_of(System *system, Expr e, Expr *out, Diag *diag);

#endif
