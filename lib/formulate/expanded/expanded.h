/* expanded.h: entries of the equations, written as by hand */
#ifndef COTREE_FORMULATE_EXPANDED_EXPANDED_H
#define COTREE_FORMULATE_EXPANDED_EXPANDED_H

#include "formulate/system/system.h"

/* false: entries of M and F would be too long to be written out: a guess */
bool expanded_fits(const System *system);
/* an entry of what is shown, whole turns with it */
MUST_USE Status show_entry(System *system, Block block, int row, int column, Expr *out, Diag *diag);

#endif
