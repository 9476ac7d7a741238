/* block_entry.h: an entry of any block of the equations, expanded or projected */
#ifndef COTREE_FORMULATE_EXPANDED_BLOCK_ENTRY_H
#define COTREE_FORMULATE_EXPANDED_BLOCK_ENTRY_H

#include "formulate/system/system.h"

/* an entry as shown, with symbols for full turns */
MUST_USE Status show_entry(System *system, Block block, int row, int column, Expr *out, Diag *diag);

#endif
