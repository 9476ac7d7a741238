/* evaluate.c: the value of an expression, node by node */
#include "expr/expr_impl.h"

#include <string.h>

enum { NODE_WORK = 32 }; /* of a node, for transaction_worked() */

/* value of a node that is no symbol, from the values of its arguments */
static double node_value(Expr e, const double *args)
{
    double value;

    switch (e->kind) {
    case EXPR_SUM:
        value = args[0]; /* not 0: that would lose the sign of -0 */
        for (int i = 1; i < e->count; i++)
            value += args[i];
        return value;
    case EXPR_PRODUCT:
        value = 1;
        for (int i = 0; i < e->count; i++)
            value *= args[i];
        return value;
    case EXPR_POWER:
        return power_value(args[0], node_args(e)[1], args[1]);
    case EXPR_CALL:
        if (e->op == OP_TABLE && expr_data(node_args(e)[0]) != NULL)
            return curve_value(expr_data(node_args(e)[0]), args[1], (int)args[2]);
        return op_value((Op)e->op, args);
    default:
        return expr_value(e);
    }
}

/* the data table is evaluated in place of its symbol */
static double symbol_value(Expr symbol, SymbolValue value, void *context)
{
    return expr_data(symbol) != NULL ? 0 : value(context, symbol);
}

double expr_evaluate(Expr e, SymbolValue value, void *context)
{
    Walk walk = {0};
    LIST(double) args = {0};
    double *values;
    double result;

    if (expr_is_number(e))
        return expr_value(e);
    if (e->kind == EXPR_SYMBOL && expr_data(e) == NULL)
        return value(context, e);
    walk_below(&walk, e, 0, NULL, NULL);
    values = NEW_ARRAY(double, walk.count);
    for (int i = 0; i < walk.count; i++) {
        const Expr node = walk.nodes[i];

        args.count = 0;
        for (int k = 0; k < node->count; k++)
            LIST_PUSH(args, values[walk_find(&walk, node_args(node)[k])]);
        values[i] = node->kind == EXPR_SYMBOL ? symbol_value(node, value, context)
                                              : node_value(node, args.at);
    }
    result = values[walk.count - 1];
    mem_free(values);
    LIST_FREE(args);
    walk_free(&walk);
    return result;
}

/* --- of many expressions at one place --- */

/* what is known by numbers of nodes */
struct Evaluation {
    SymbolValue value;
    void *context;
    double *at;
    bool *is_known;
    uint32_t room;
    LIST(Expr) waiting; /* for their arguments */
    LIST(double) args;
};

Evaluation *evaluation_new(SymbolValue value, void *context)
{
    Evaluation *evaluation = NEW(Evaluation);

    evaluation->value = value;
    evaluation->context = context;
    return evaluation;
}

void evaluation_free(Evaluation *evaluation)
{
    if (evaluation == NULL)
        return;
    MEM_FREE(evaluation->at, evaluation->is_known);
    LIST_FREE(evaluation->waiting);
    LIST_FREE(evaluation->args);
    mem_free(evaluation);
}

/* nothing below a node is younger than it */
static void make_room(Evaluation *evaluation, Expr e)
{
    uint32_t room = 2 * evaluation->room;
    bool *is_known;

    if (e->number < evaluation->room)
        return;
    room = room > e->number ? room : e->number + 1;
    is_known = NEW_ARRAY(bool, room);
    if (evaluation->room > 0)
        memcpy(is_known, evaluation->is_known, evaluation->room * sizeof *is_known);
    mem_free(evaluation->is_known);
    evaluation->is_known = is_known;
    evaluation->at = mem_grow(evaluation->at, room, sizeof *evaluation->at);
    evaluation->room = room;
}

static bool wait_for_args(Evaluation *evaluation, Expr e)
{
    const int before = evaluation->waiting.count;

    for (int i = 0; i < e->count; i++)
        if (!evaluation->is_known[node_args(e)[i]->number])
            LIST_PUSH(evaluation->waiting, node_args(e)[i]);
    return evaluation->waiting.count > before;
}

static double value_given_args(Evaluation *evaluation, Expr e)
{
    if (e->kind == EXPR_SYMBOL)
        return symbol_value(e, evaluation->value, evaluation->context);
    evaluation->args.count = 0;
    for (int i = 0; i < e->count; i++)
        LIST_PUSH(evaluation->args, evaluation->at[node_args(e)[i]->number]);
    return node_value(e, evaluation->args.at);
}

double evaluation_of(Evaluation *evaluation, Expr e)
{
    if (expr_is_number(e))
        return expr_value(e);
    make_room(evaluation, e);
    if (!evaluation->is_known[e->number])
        LIST_PUSH(evaluation->waiting, e);
    while (evaluation->waiting.count > 0) {
        const Expr next = evaluation->waiting.at[evaluation->waiting.count - 1];

        transaction_worked(NODE_WORK);
        if (!evaluation->is_known[next->number] && wait_for_args(evaluation, next))
            continue;
        evaluation->waiting.count--;
        if (evaluation->is_known[next->number])
            continue; /* two waited for it */
        evaluation->at[next->number] = value_given_args(evaluation, next);
        evaluation->is_known[next->number] = true;
    }
    return evaluation->at[e->number];
}
