/* nonsmooth_points.c: functions that jump or have a kink, and where */
#include "formulate/system/surfaces.h"

#include "base/memory.h"
#include "base/random.h"

#include <math.h>

#define POINTS 4     /* at which two conditions are compared */
#define SAME   1e-13 /* of their quotient: rounding, and less than any offset of use */

/* the first number among the factors of the first term */
static Expr leading(Arena *arena, Expr e)
{
    if (expr_kind(e) == EXPR_SUM)
        e = expr_is_number(expr_arg(e, 0)) ? expr_arg(e, 1) : expr_arg(e, 0);
    return expr_kind(e) == EXPR_PRODUCT && expr_is_number(expr_arg(e, 0)) ? expr_arg(e, 0)
                                                                          : expr_int(arena, 1);
}

Expr surface_of(Arena *arena, Expr condition, int *way)
{
    Expr open = expr_open(arena, condition);
    Expr scale = leading(arena, open);
    LIST(Expr) terms = {0};
    Expr sum;

    *way = expr_value(scale) < 0 ? -1 : 1;
    if (expr_kind(open) != EXPR_SUM)
        return expr_div(arena, open, scale);
    for (int i = 0; i < expr_arg_count(open); i++)
        LIST_PUSH(terms, expr_div(arena, expr_arg(open, i), scale));
    sum = expr_sum(arena, terms.at, terms.count);
    LIST_FREE(terms);
    return sum;
}

/* a number in (0.5, 1.5) of a symbol, another one at each point; of either sign but for parameters
 */
static double value_at_point(void *context, Expr symbol)
{
    uint64_t state = (uint64_t)expr_symbol_number(symbol) * 0x9e3779b97f4a7c15U + *(int *)context;
    const double size = 1 + random_unit(&state) / 2;

    return expr_symbol_kind(symbol) != SYMBOL_PARAMETER && random_unit(&state) < 0 ? -size : size;
}

bool surface_is_same(Expr surface, Expr condition, int *way)
{
    double first = NAN;

    for (int k = 0; k < POINTS; k++) {
        const double quotient = expr_evaluate(condition, value_at_point, &k) /
                                expr_evaluate(surface, value_at_point, &k);

        if (k == 0)
            first = quotient;
        if (!(fabs(quotient - first) <= SAME * fabs(first)) || first == 0)
            return false;
    }
    *way = first < 0 ? -1 : 1;
    return true;
}

/* whether a condition is n == 0 */
static bool is_rest_of(Expr condition, Expr n)
{
    int way;

    if (expr_kind(condition) != EXPR_CALL || expr_op(condition) != OP_EQ)
        return false;
    for (int i = 0; i < 2; i++)
        if (expr_is_zero(expr_arg(condition, i)) &&
            (expr_arg(condition, 1 - i) == n ||
             surface_is_same(n, expr_arg(condition, 1 - i), &way)))
            return true;
    return false;
}

/* b of coulomb(v, n, b), and where that is if(n == 0, x, y) one of the two */
static Expr bound_of_call(Arena *arena, Expr call, bool at_rest)
{
    const Expr bound = expr_open(arena, expr_arg(call, 2));
    const Expr n = expr_open(arena, expr_arg(call, 1));
    const bool is_if = expr_kind(bound) == EXPR_CALL && expr_op(bound) == OP_IF;

    return is_if && is_rest_of(expr_arg(bound, 0), n) ? expr_arg(bound, at_rest ? 1 : 2) : bound;
}

SurfaceLaw surface_law(Arena *arena, Expr call)
{
    switch (expr_op(call)) {
    case OP_DIRECTION:
        return (SurfaceLaw){.ratio = expr_arg(call, 2), .is_norm = true};
    case OP_COULOMB:
        return (SurfaceLaw){.bound = bound_of_call(arena, call, false),
                            .hold = bound_of_call(arena, call, true),
                            .is_norm = expr_arg(call, 0) != expr_arg(call, 1)};
    case OP_STICK:
        return (SurfaceLaw){.ratio = expr_arg(call, 1)};
    case OP_UNILATERAL:
        return (SurfaceLaw){.ratio = expr_arg(call, 1), .is_unilateral = true};
    default:
        return (SurfaceLaw){0};
    }
}

bool surface_law_is(const SurfaceLaw *law, const SurfaceLaw *other)
{
    return law->ratio == other->ratio && law->bound == other->bound && law->hold == other->hold &&
           law->is_unilateral == other->is_unilateral && law->is_norm == other->is_norm;
}

Expr surface_part(Expr call)
{
    return expr_op(call) == OP_DIRECTION || expr_op(call) == OP_COULOMB ? expr_arg(call, 0) : NULL;
}

bool surface_rests(Expr ratio)
{
    return ratio != NULL && expr_is_number(ratio) && expr_value(ratio) < 0;
}

Expr surface_of_call(Arena *arena, Expr call, int *way)
{
    const Expr condition = switch_condition(arena, call);
    SurfaceLaw law;
    Expr surface;

    if (condition == NULL || expr_is_number(condition))
        return NULL;
    *way = 1;
    law = surface_law(arena, call);
    if (law.is_norm)
        return condition;
    surface = surface_of(arena, condition, way);
    if (!law.is_unilateral || *way > 0)
        return surface;
    *way = 1;
    return expr_neg(arena, surface);
}

bool switch_jumps(Expr e)
{
    return expr_kind(e) == EXPR_CALL &&
           (expr_op(e) == OP_LT || expr_op(e) == OP_LE || expr_op(e) == OP_STEP ||
            expr_op(e) == OP_SIGN || expr_op(e) == OP_STICK || expr_op(e) == OP_UNILATERAL ||
            expr_op(e) == OP_DIRECTION || expr_op(e) == OP_COULOMB || expr_op(e) == OP_FLOOR);
}

typedef struct Over {
    unsigned kinds;
    bool jumps;
} Over;

static Expr note_jump(Arena *arena, Expr e, void *context)
{
    Over *over = context;

    (void)arena;
    over->jumps = over->jumps || (switch_jumps(e) && (expr_kinds(e) & over->kinds) != 0);
    return e;
}

bool switch_jumps_over(Arena *arena, Expr e, unsigned kinds)
{
    Over over = {.kinds = kinds};

    if ((expr_kinds(e) & kinds) != 0)
        (void)expr_change(arena, e, note_jump, &over);
    return over.jumps;
}
