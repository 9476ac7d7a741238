/* continuity.h: where a function jumps and what holds it doesn't */
#ifndef COTREE_FORMULATE_SYSTEM_BUILD_CONTINUITY_H
#define COTREE_FORMULATE_SYSTEM_BUILD_CONTINUITY_H

#include "expr/expr.h"

/* Argument k of e jumps; whether e is all the same continuous there, as far as that argument goes:
 * an if whose two values meet, or a product whose other factors are 0 there, as
 * sign(x)*log(1 + abs(x)). O(nodes). */
bool jump_only_bends(Arena *arena, Expr e, int k);

#endif
