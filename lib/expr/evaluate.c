/* evaluate.c: the value of an expression, node by node */
#include "expr/expr_impl.h"

static double value_of(const Walk *walk, const double *values, Expr e)
{
    return values[walk_find(walk, e)];
}

static double node_value(const Walk *walk, const double *values, Expr e)
{
    const Expr *args = node_args(e);
    double inside[3] = {0};
    double value;

    switch (e->kind) {
    case EXPR_SUM:
        value = value_of(walk, values, args[0]); /* not 0: that would lose the sign of -0 */
        for (int i = 1; i < e->count; i++)
            value += value_of(walk, values, args[i]);
        return value;
    case EXPR_PRODUCT:
        value = 1;
        for (int i = 0; i < e->count; i++)
            value *= value_of(walk, values, args[i]);
        return value;
    case EXPR_POWER:
        return power_value(value_of(walk, values, args[0]), args[1],
                           value_of(walk, values, args[1]));
    case EXPR_CALL:
        for (int i = 0; i < e->count; i++)
            inside[i] = value_of(walk, values, args[i]);
        if (e->op == OP_TABLE && expr_data(args[0]) != NULL)
            return curve_value(expr_data(args[0]), inside[1], (int)inside[2]);
        return op_value((Op)e->op, inside);
    default:
        return expr_value(e);
    }
}

double expr_evaluate(Expr e, SymbolValue value, void *context)
{
    Walk walk = {0};
    double *values;
    double result;

    if (expr_is_number(e))
        return expr_value(e);
    if (e->kind == EXPR_SYMBOL && expr_data(e) == NULL)
        return value(context, e);
    walk_below(&walk, e, 0, NULL, NULL);
    values = NEW_ARRAY(double, walk.count);
    for (int i = 0; i < walk.count; i++) {
        Expr node = walk.nodes[i];

        if (expr_data(node) != NULL)
            values[i] = 0; /* its table is asked instead */
        else
            values[i] =
                node->kind == EXPR_SYMBOL ? value(context, node) : node_value(&walk, values, node);
    }
    result = values[walk.count - 1];
    mem_free(values);
    walk_free(&walk);
    return result;
}
