/* smooth.c: whether an expression has a derivative in time where the equations need one
 *
 * step and sign jump; a choice in time jumps where its two values differ at the switch. Other
 * choices are taken for bends, as in the derivative rules. */
#include "formulate/system_impl.h"

#include <math.h>
#include <string.h>

typedef struct AtTime {
    Expr time;
    double t;
} AtTime;

static double value_at(void *context, Expr symbol)
{
    const AtTime *at = context;

    return symbol == at->time ? at->t : 0.7 + 0.1 * (expr_symbol_number(symbol) % 7);
}

/* if(t < number, a, b) with a != b there */
static bool choice_jumps(Arena *arena, Expr choice)
{
    Expr condition = expr_arg(choice, 0);
    AtTime at = {expr_symbol(arena, "t", SYMBOL_TIME), 0};
    Expr difference;
    double rate;

    if (expr_kind(condition) != EXPR_CALL ||
        (expr_op(condition) != OP_LT && expr_op(condition) != OP_LE))
        return false;
    difference = expr_sub(arena, expr_arg(condition, 0), expr_arg(condition, 1));
    if ((expr_kinds(difference) & ~(1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER)) != 0)
        return false;
    rate = expr_evaluate(expr_diff(arena, difference, at.time), value_at, &at);
    if (rate == 0)
        return false;
    at.t = -expr_evaluate(difference, value_at, &at) / rate;
    difference = expr_sub(arena, expr_arg(choice, 1), expr_arg(choice, 2));
    return !(fabs(expr_evaluate(difference, value_at, &at)) < 1e-9);
}

static bool jumps(Arena *arena, Expr e)
{
    LIST(Expr) stack = {0};
    LIST(bool) seen = {0};
    bool found = false;

    LIST_PUSH(stack, e);
    while (stack.count > 0 && !found) {
        Expr at = stack.at[--stack.count];
        uint32_t number = expr_number(at);

        while ((uint32_t)seen.count <= number)
            LIST_PUSH(seen, false);
        if (seen.at[number])
            continue;
        seen.at[number] = true;
        if (expr_kind(at) == EXPR_CALL)
            found = expr_op(at) == OP_STEP || expr_op(at) == OP_SIGN ||
                    (expr_op(at) == OP_IF && choice_jumps(arena, at));
        for (int i = 0; i < expr_arg_count(at); i++)
            LIST_PUSH(stack, expr_arg(at, i));
    }
    LIST_FREE(stack);
    LIST_FREE(seen);
    return found;
}

Status need_smooth(System *system, const char *who, Expr e, Diag *diag)
{
    const unsigned plain = 1U << SYMBOL_PARAMETER | 1U << SYMBOL_STATE | 1U << SYMBOL_ALGEBRAIC;

    if ((expr_kinds(e) & ~plain) == 0 || !jumps(system->arena, e))
        return OK;
    if (system->network_form == NETWORK_TREE) {
        (void)diag_set(diag, E_MODEL, "in this tree %s needs the derivative of a source that jumps",
                       who);
        diag_hint(diag, "take capacitors into the tree and inductors out of it, or set network "
                        "state");
    } else {
        (void)diag_set(diag, E_MODEL, "a source that jumps would drive an impulse through %s", who);
        diag_hint(diag, "put a resistance into the circuit, or give the source a rise time");
    }
    return E_MODEL;
}
