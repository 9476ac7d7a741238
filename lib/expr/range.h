/* range.h: bounds of expressions of one symbol over an interval of it
 *
 * By interval arithmetic: the bounds enclose the true range, and approach it as the interval
 * shrinks. Functions without a rule (tables) are sampled at some points. */
#ifndef COTREE_EXPR_RANGE_H
#define COTREE_EXPR_RANGE_H

#include "expr/expr.h"

typedef struct Range {
    double low, high;
} Range;

typedef struct Ranges Ranges;

/* New, of expressions in `symbol` and others that have values; ranges_free(). Copies: the arena may
 * die. O(nodes). */
Ranges *ranges_new(const Expr *roots, int count, Expr symbol, SymbolValue value, void *context);
void ranges_free(Ranges *ranges); /* NULL is fine */
/* of each root, while the symbol is in `over`; borrowed, until the next call. Bounds that aren't
 * known are infinite. O(nodes). */
const Range *ranges_over(Ranges *ranges, Range over);
/* of one root. O(nodes of the root). */
Range ranges_root_over(Ranges *ranges, int root, Range over);
/* Number of node ranges computed so far: one for each node and interval, however many nodes and
 * calls use it. NULL: 0. */
int64_t ranges_visits(const Ranges *ranges);

#endif
