/* jumps.h: where functions switch, and whether they jump there */
#ifndef COTREE_EXPR_JUMPS_H
#define COTREE_EXPR_JUMPS_H

#include "expr/expr.h"

/* what changes sign where a function jumps or kinks; NULL: it does neither */
Expr switch_condition(Arena *arena, Expr e);
/* Whether e jumps as a symbol of these kinds (bits as of expr_kinds()) changes. Only conditions of
 * such symbols and parameters are looked at. Found in numbers; false where no root of a condition
 * is found. O(conditions times nodes). */
bool expr_jumps(Arena *arena, Expr e, unsigned kinds);

#endif
