/* embedded.h: the embedded form: equations without multipliers */
#ifndef COTREE_FORMULATE_EXPANDED_EMBEDDED_H
#define COTREE_FORMULATE_EXPANDED_EMBEDDED_H

#include "formulate/system/constraints.h"

MUST_USE Status embedded_mass(System *system, int row, int column, Expr *out, Diag *diag);
MUST_USE Status embedded_force(System *system, int row, int column, Expr *out, Diag *diag);
MUST_USE Status embedded_dependent_rate(System *system, int row, int column, Expr *out, Diag *diag);
MUST_USE Status embedded_complement(System *system, int row, int column, Expr *out, Diag *diag);
/* the effort of the only driver of a system with one freedom, in q, u and u' */
MUST_USE Status embedded_effort(System *system, const Row *driver, Expr *out, Diag *diag);

#endif
