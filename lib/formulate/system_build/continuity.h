/* continuity.h: calls that jump inside an expression that is continuous */
#ifndef COTREE_FORMULATE_SYSTEM_BUILD_CONTINUITY_H
#define COTREE_FORMULATE_SYSTEM_BUILD_CONTINUITY_H

#include "expr/expr.h"

/* Argument k of e jumps: whether e is still continuous there, as far as that argument goes: an if
 * whose two values are equal, or a product whose other factors are 0 there, as sign(x)*log(1 +
 * abs(x)). O(nodes). */
bool jump_only_bends(Arena *arena, Expr e, int k);

#endif
