/* range.h: between which numbers expressions of one symbol stay while it goes through an interval
 *
 * By interval arithmetic: the true range lies within, and comes close to it as the interval gets
 * short. Of functions that have no rule (tables) some points tell. */
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
/* How many ranges of nodes have been found so far: each node has one an interval, however many
 * others and calls ask for it. NULL: 0. */
int64_t ranges_visits(const Ranges *ranges);

#endif
