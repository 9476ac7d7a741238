/* continuity.c: calls that jump inside an expression that is continuous
 *
 * Tested numerically, at points where the condition is 0 and other symbols have arbitrary values.
 * Variables have either sign there, as values that meet at y may not meet at -y. Parameters are
 * above 0, as limits and sizes are, and so is t. */
#include "formulate/system_build/continuity.h"

#include "base/memory.h"
#include "formulate/formulate_limits.h"
#include "formulate/system/surfaces.h"

#include <math.h>

enum { SPOTS = 6 };

typedef struct ContinuitySpot { /* a point at which symbols have values, one of them chosen */
    int which; /* index in SPOTS: all are above 0 at the first, below 0 at the second */
    Expr moved;
    double at;
} ContinuitySpot;

typedef enum { HOLDS, FAILS, NO_VALUE } Finding; /* at a point where the condition is 0 */
typedef Finding (*Look)(Arena *arena, Expr e, int k, ContinuitySpot *spot);

static double sign_on(const ContinuitySpot *spot, Expr symbol)
{
    const uint32_t mixed = (uint32_t)expr_symbol_number(symbol) * 2654435761U;

    if (expr_symbol_kind(symbol) == SYMBOL_PARAMETER || expr_symbol_kind(symbol) == SYMBOL_TIME)
        return 1;
    if (spot->which < 2)
        return spot->which == 0 ? 1 : -1;
    return (mixed >> (15 + spot->which) & 1) != 0 ? 1 : -1;
}

/* A value for each symbol at a point of the test: signs are those of the point, and sizes differ
 * from symbol to symbol, so that terms don't cancel by chance. */
static double value_on(void *context, Expr symbol)
{
    const ContinuitySpot *spot = context;
    const double size = 0.7 + fmod(0.618033988749895 * expr_symbol_number(symbol), 1);

    return symbol == spot->moved ? spot->at : sign_on(spot, symbol) * size;
}

/* Newton's method along a symbol of the condition; false: no zero was found */
static bool find_spot(Arena *arena, Expr condition, ContinuitySpot *spot)
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
    spot->at = sign_on(spot, spot->moved);
    for (int i = 0; i < 50 && fabs(move) > 1e-14; i++) {
        move = expr_evaluate(condition, value_on, spot) / expr_evaluate(slope, value_on, spot);
        if (!isfinite(move))
            return false;
        spot->at -= move;
    }
    return fabs(move) <= 1e-12;
}

/* at all points that have values, and at least at one */
static bool holds_at_spots(Arena *arena, Expr condition, Look look, Expr e, int k)
{
    bool found = false;

    for (int i = 0; i < SPOTS; i++) {
        ContinuitySpot spot = {.which = i};
        const Finding here =
            find_spot(arena, condition, &spot) ? look(arena, e, k, &spot) : NO_VALUE;

        if (here == FAILS)
            return false;
        found = found || here == HOLDS;
    }
    return found;
}

/* |yes - no| with the chosen symbol at `at` */
static double gap_at(Expr choice, ContinuitySpot spot, double at)
{
    spot.at = at;
    return fabs(expr_evaluate(expr_arg(choice, 1), value_on, &spot) -
                expr_evaluate(expr_arg(choice, 2), value_on, &spot));
}

/* Whether the two values of an if are the same there. At the end of a domain, as of (h - 2)^1.5,
 * the numeric zero of the condition may have no value. Then a neighbour has one, and the difference
 * is small compared to that further inside: the root of 1e-14 is 1e-7. */
static Finding choice_meets(Arena *arena, Expr choice, int k, ContinuitySpot *spot)
{
    const double yes = expr_evaluate(expr_arg(choice, 1), value_on, spot);
    const double no = expr_evaluate(expr_arg(choice, 2), value_on, spot);
    const double size = fmax(1, fabs(spot->at));
    bool found = false;

    (void)arena;
    (void)k;
    if (isfinite(yes) && isfinite(no) &&
        fabs(yes - no) <= CONTINUITY_CLOSED * (fabs(yes) + fabs(no)))
        return HOLDS;
    for (int way = -1; way <= 1; way += 2) {
        const double next = gap_at(choice, *spot, spot->at + way * CONTINUITY_NEXT * size);
        const double away = gap_at(choice, *spot, spot->at + way * CONTINUITY_AWAY * size);

        if (!isfinite(next) || !isfinite(away))
            continue;
        if (!(next <= CONTINUITY_JUMP * away))
            return FAILS;
        found = true;
    }
    if (!found && isfinite(yes) && isfinite(no))
        return FAILS;
    return found ? HOLDS : NO_VALUE;
}

/* Value of an expression with a kink on a surface. Rounding leaves a condition slightly off 0,
 * which
 * roots amplify. */
static Expr write_nonsmooth_point(Arena *arena, Expr e, void *context)
{
    Expr condition = switch_condition(arena, e);
    int way;

    if (condition == NULL || switch_jumps(e) || expr_is_number(condition) ||
        surface_of(arena, condition, &way) != context)
        return e;
    return expr_op(e) == OP_MIN || expr_op(e) == OP_MAX ? expr_arg(e, 0) : expr_int(arena, 0);
}

/* Whether the network is solved for variables of the condition. A surface in the state alone is
 * followed even where nothing jumps there, since a tank, for example, becomes empty in finite
 * time. */
static bool is_solved_for(Expr condition)
{
    return (expr_kinds(condition) & (1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE)) != 0;
}

/* whether the other factors of a product are 0 where the k-th jumps */
static Finding factors_vanish(Arena *arena, Expr product, int k, ContinuitySpot *spot)
{
    const int count = expr_arg_count(product);
    Expr condition = switch_condition(arena, expr_arg(product, k));
    Expr *others = NEW_ARRAY(Expr, count);
    double size, away;
    Expr rest, there;
    int way;

    for (int i = 0, n = 0; i < count; i++)
        if (i != k)
            others[n++] = expr_arg(product, i);
    rest = expr_product(arena, others, count - 1);
    mem_free(others);
    there =
        expr_change(arena, rest, write_nonsmooth_point, (void *)surface_of(arena, condition, &way));
    size = fabs(expr_evaluate(there, value_on, spot));
    spot->at += CONTINUITY_AWAY;
    away = fabs(expr_evaluate(rest, value_on, spot));
    if (!isfinite(size) || !isfinite(away))
        return NO_VALUE;
    return size <= CONTINUITY_CLOSED * away ? HOLDS : FAILS;
}

bool jump_only_bends(Arena *arena, Expr e, int k)
{
    const bool is_product = expr_kind(e) == EXPR_PRODUCT;
    Expr condition;

    if (!is_product && !(expr_kind(e) == EXPR_CALL && expr_op(e) == OP_IF && k == 0))
        return false;
    condition = switch_condition(arena, expr_arg(e, k));
    if (condition == NULL || (is_product && !is_solved_for(condition)))
        return false;
    return holds_at_spots(arena, condition, is_product ? factors_vanish : choice_meets, e, k);
}
