/* cutset_equations.h: cutsets projected on motion spaces: M and F */
#ifndef COTREE_FORMULATE_DYNAMICS_CUTSET_EQUATIONS_H
#define COTREE_FORMULATE_DYNAMICS_CUTSET_EQUATIONS_H

#include "formulate/system/dynamics.h"

MUST_USE Status dynamics_build(System *system, Diag *diag);
/* the part of F that neither inertia nor gravity makes */
MUST_USE Status system_pushes(System *view, Expr *out, Diag *diag);

/* M u' - F for u' that are given, by one pass outward and one inward: nu. False: something deforms.
 */
bool dynamics_lack(System *view, const Expr *acceleration, Expr *out);

#endif
