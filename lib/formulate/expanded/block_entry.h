/* block_entry.h: an entry of any block of the equations, expanded or projected */
#ifndef COTREE_FORMULATE_EXPANDED_BLOCK_ENTRY_H
#define COTREE_FORMULATE_EXPANDED_BLOCK_ENTRY_H

#include "formulate/system/system.h"

/* An entry as shown: formed at the first request and cached in the view. Whole turns of multi-turn
 * angles are still symbols; system_show() replaces them. */
MUST_USE Status show_entry(System *system, Block block, int row, int column, Expr *out, Diag *diag);

#endif
