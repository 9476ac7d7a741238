/* cutset_equations.h: cutsets projected on motion spaces: M and F */
#ifndef COTREE_FORMULATE_DYNAMICS_CUTSET_EQUATIONS_H
#define COTREE_FORMULATE_DYNAMICS_CUTSET_EQUATIONS_H

#include "formulate/system/dynamics.h"

MUST_USE Status dynamics_build(System *system, Diag *diag);
/* the part of F that is due neither to inertia nor to gravity */
MUST_USE Status system_pushes(System *view, Expr *out, Diag *diag);

/* M u' - F for given u', by one pass outward and one inward: nu x 1. False: a part is flexible. */
bool dynamics_lack(System *view, const Expr *acceleration, Expr *out);

#endif
