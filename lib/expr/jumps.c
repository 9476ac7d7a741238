/* jumps.c: where functions switch, and whether they jump there
 *
 * A value is found at which the condition changes sign, and the function looked at just below and
 * above: ramp(t)^2 has step(t) in its derivative, and bends there all the same. */
#include "expr/jumps.h"

#include "base/memory.h"

#include <math.h>

#define NARROW 1e-14 /* of a value: the least difference that numbers resolve */
#define WIDER  8
#define CHANGE 1e-10 /* of a value: more than rounding */

typedef struct SymbolPoint { /* a symbol has a value, all others one of no meaning */
    Expr moved;
    double at;
} SymbolPoint;

static double value_at(void *context, Expr symbol)
{
    const SymbolPoint *at = context;

    return symbol == at->moved ? at->at : 0.7 + 0.1 * (expr_symbol_number(symbol) % 7);
}

Expr switch_condition(Arena *arena, Expr e)
{
    if (expr_kind(e) != EXPR_CALL)
        return NULL;
    switch (expr_op(e)) {
    case OP_LT:
    case OP_LE:
    case OP_MIN:
    case OP_MAX:
        return expr_sub(arena, expr_arg(e, 0), expr_arg(e, 1));
    case OP_STEP:
    case OP_RAMP:
    case OP_SIGN:
    case OP_STICK:
    case OP_UNILATERAL:
    case OP_ABS:
        return expr_arg(e, 0);
    case OP_DIRECTION:
    case OP_COULOMB:
        return expr_arg(e, 1);
    case OP_FLOOR: /* at whole numbers */
        return expr_sin(arena, expr_mul(arena, expr_pi(arena, 1), expr_arg(e, 0)));
    default:
        return NULL;
    }
}

/* what is 0 where a function switches, with a single root; NULL: it doesn't */
static Expr switch_of(Arena *arena, Expr e)
{
    if (expr_kind(e) == EXPR_CALL && expr_op(e) == OP_FLOOR) /* at 1, as at any whole number */
        return expr_sub(arena, expr_arg(e, 0), expr_int(arena, 1));
    return switch_condition(arena, e);
}

/* Newton's method from 0; false where it leads nowhere */
static bool root_of(Arena *arena, Expr condition, SymbolPoint *at)
{
    Expr slope = expr_diff(arena, condition, at->moved);
    double move = INFINITY;

    at->at = 0;
    for (int i = 0; i < 50 && fabs(move) > 1e-14 * fabs(at->at); i++) {
        move = expr_evaluate(condition, value_at, at) / expr_evaluate(slope, value_at, at);
        if (!isfinite(move))
            return false;
        at->at -= move;
    }
    return fabs(move) <= 1e-12 * fabs(at->at) + 1e-300;
}

static double change_about(Expr e, SymbolPoint at, double step, double *size)
{
    SymbolPoint before = {at.moved, at.at - step};
    SymbolPoint after = {at.moved, at.at + step};
    double first = expr_evaluate(e, value_at, &before), last = expr_evaluate(e, value_at, &after);

    *size = fabs(first) + fabs(last);
    return fabs(last - first);
}

/* A jump doesn't grow with the width that it is seen over, a ramp does, however short it is. */
static bool jumps_at(Expr e, SymbolPoint at)
{
    double step = NARROW * fabs(at.at) + NARROW * NARROW;
    double size;
    double narrow = change_about(e, at, step, &size);

    return narrow > CHANGE * size && !(change_about(e, at, WIDER * step, &size) > 2 * narrow);
}

/* the first symbol of these kinds; NULL: none */
static Expr symbol_of(Expr e, unsigned kinds)
{
    Expr *symbols = NULL, found = NULL;
    const int count = expr_symbols(&e, 1, &symbols);

    for (int i = 0; i < count && found == NULL; i++)
        if ((kinds & 1U << expr_symbol_kind(symbols[i])) != 0)
            found = symbols[i];
    mem_free(symbols);
    return found;
}

static bool jumps_by(Arena *arena, Expr e, Expr condition, unsigned kinds)
{
    SymbolPoint at = {NULL, 0};

    if (condition == NULL || (expr_kinds(condition) & ~(kinds | 1U << SYMBOL_PARAMETER)) != 0)
        return false;
    at.moved = symbol_of(condition, kinds);
    return at.moved != NULL && root_of(arena, condition, &at) && jumps_at(e, at);
}

bool expr_jumps(Arena *arena, Expr e, unsigned kinds)
{
    LIST(Expr) stack = {0};
    LIST(bool) seen = {0};
    bool found = false;

    LIST_PUSH(stack, e);
    while (stack.count > 0 && !found) {
        Expr part = stack.at[--stack.count];

        while ((uint32_t)seen.count <= expr_number(part))
            LIST_PUSH(seen, false);
        if (seen.at[expr_number(part)])
            continue;
        seen.at[expr_number(part)] = true;
        found = jumps_by(arena, e, switch_of(arena, part), kinds);
        for (int i = 0; i < expr_arg_count(part); i++)
            LIST_PUSH(stack, expr_arg(part, i));
    }
    LIST_FREE(stack);
    LIST_FREE(seen);
    return found;
}
