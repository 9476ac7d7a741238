/* continuity.c: where a function jumps and what holds it doesn't
 *
 * Found in numbers: at a point where the condition is 0, other symbols at values of no meaning. */
#include "formulate/whole/continuity.h"

#include "base/memory.h"
#include "formulate/system/surfaces.h"

#include <math.h>

#define AWAY   1.0 /* of the point: how large what is 0 there is elsewhere */
#define CLOSED 1e-9

typedef struct Spot { /* a point at which symbols have values, one of them chosen */
    Expr moved;
    double at;
} Spot;

/* no two symbols have the same value */
static double value_on(void *context, Expr symbol)
{
    const Spot *spot = context;

    return symbol == spot->moved ? spot->at
                                 : 0.7 + fmod(0.618033988749895 * expr_symbol_number(symbol), 1);
}

/* Newton's method along a symbol of the condition; false: no zero was found */
static bool find_spot(Arena *arena, Expr condition, Spot *spot)
{
    Expr *symbols;
    int count = expr_symbols(&condition, 1, &symbols);
    double move = INFINITY;
    Expr slope;

    spot->moved = NULL;
    for (int i = 0; i < count; i++)
        if (expr_symbol_kind(symbols[i]) != SYMBOL_PARAMETER)
            spot->moved = symbols[i];
    mem_free(symbols);
    if (spot->moved == NULL)
        return false;
    slope = expr_diff(arena, condition, spot->moved);
    spot->at = 1;
    for (int i = 0; i < 50 && fabs(move) > 1e-14; i++) {
        move = expr_evaluate(condition, value_on, spot) / expr_evaluate(slope, value_on, spot);
        if (!isfinite(move))
            return false;
        spot->at -= move;
    }
    return fabs(move) <= 1e-12;
}

/* what an if chooses from is the same where its condition changes */
static bool choice_meets(Arena *arena, Expr choice)
{
    Expr condition = switch_condition(arena, expr_arg(choice, 0));
    Spot spot;
    double yes, no;

    if (condition == NULL || !find_spot(arena, condition, &spot))
        return false;
    yes = expr_evaluate(expr_arg(choice, 1), value_on, &spot);
    no = expr_evaluate(expr_arg(choice, 2), value_on, &spot);
    return fabs(yes - no) <= CLOSED * (fabs(yes) + fabs(no));
}

/* What kinks on a surface, as it is there. Rounding leaves a condition beside 0, which roots make
 * large. */
static Expr put_kink(Arena *arena, Expr e, void *context)
{
    Expr condition = switch_condition(arena, e);
    int way;

    if (condition == NULL || switch_jumps(e) || expr_is_number(condition) ||
        surface_of(arena, condition, &way) != context)
        return e;
    return expr_op(e) == OP_MIN || expr_op(e) == OP_MAX ? expr_arg(e, 0) : expr_int(arena, 0);
}

/* Whether the network is solved for what a condition asks of. A surface in the state alone is
 * followed as one even where nothing jumps there, as a tank is found empty in finite time. */
static bool is_solved_for(Expr condition)
{
    return (expr_kinds(condition) & (1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE)) != 0;
}

/* the other factors of a product are 0 where the k-th jumps */
static bool factors_vanish(Arena *arena, Expr product, int k)
{
    const int count = expr_arg_count(product);
    Expr condition = switch_condition(arena, expr_arg(product, k));
    Expr *others;
    Expr rest, there;
    double size;
    Spot spot;
    int way;

    if (condition == NULL || !is_solved_for(condition) || !find_spot(arena, condition, &spot))
        return false;
    others = NEW_ARRAY(Expr, count);
    for (int i = 0, n = 0; i < count; i++)
        if (i != k)
            others[n++] = expr_arg(product, i);
    rest = expr_product(arena, others, count - 1);
    mem_free(others);
    there = expr_change(arena, rest, put_kink, (void *)surface_of(arena, condition, &way));
    size = fabs(expr_evaluate(there, value_on, &spot));
    spot.at += AWAY;
    return size <= CLOSED * fabs(expr_evaluate(rest, value_on, &spot));
}

bool jump_only_bends(Arena *arena, Expr e, int k)
{
    if (expr_kind(e) == EXPR_PRODUCT)
        return factors_vanish(arena, e, k);
    return expr_kind(e) == EXPR_CALL && expr_op(e) == OP_IF && k == 0 && choice_meets(arena, e);
}
