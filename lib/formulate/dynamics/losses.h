/* losses.h: bounds of dry friction, and the power that it takes from the motion */
#ifndef COTREE_FORMULATE_DYNAMICS_LOSSES_H
#define COTREE_FORMULATE_DYNAMICS_LOSSES_H

#include "formulate/system/system.h"

/* Variables that parts with dry friction have wherever they act: "bound" while it slips at the
 * present rate, "hold" at rest, "loss", the power that is lost, W. *found: `member` is one of
 * these. Fails as the laws of the part do, and with E_MISSING for "lost". */
MUST_USE Status loss_variable(System *system, const Instance *part, const char *member, bool *found,
                              Expr *out, Diag *diag);
/* E_MISSING: the energy lost is an integral over a run */
MUST_USE Status loss_refuse_formula(const char *name, Diag *diag);

#endif
