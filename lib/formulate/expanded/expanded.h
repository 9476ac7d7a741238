/* expanded.h: entries of the equations in expanded form */
#ifndef COTREE_FORMULATE_EXPANDED_EXPANDED_H
#define COTREE_FORMULATE_EXPANDED_EXPANDED_H

#include "formulate/system/system.h"

/* false: by an estimate, entries of M and F would be too long to be expanded */
bool expanded_fits(const System *system);
/* an entry as shown, with symbols for full turns */
MUST_USE Status show_entry(System *system, Block block, int row, int column, Expr *out, Diag *diag);

#endif
