/* operation_cost.h: what expressions cost in a run */
#ifndef COTREE_FORMULATE_REDUCED_OPERATION_COST_H
#define COTREE_FORMULATE_REDUCED_OPERATION_COST_H

#include "expr/expr.h"

/* in additions, of what parameters alone don't tell; what they share counts once */
static inline int64_t operation_cost(const Expr *roots, int count)
{
    enum { FUNCTION_PRICE = 20 }; /* a sine costs about as much as so many additions */
    const OpCount ops = expr_count_beside(roots, count, 1U << SYMBOL_PARAMETER);

    return ops.add + ops.mul + FUNCTION_PRICE * ops.fun;
}

#endif
