/* operation_cost.h: operation cost of expressions in a run */
#ifndef COTREE_FORMULATE_REDUCED_OPERATION_COST_H
#define COTREE_FORMULATE_REDUCED_OPERATION_COST_H

#include "expr/expr.h"

/* in additions, without what depends on parameters alone; shared subexpressions count once */
static inline int64_t operation_cost(const Expr *roots, int count)
{
    enum { FUNCTION_PRICE = 20 }; /* cost of a function such as a sine, in additions */
    const OpCount ops = expr_count_without(roots, count, 1U << SYMBOL_PARAMETER);

    return ops.add + ops.mul + FUNCTION_PRICE * ops.fun;
}

#endif
