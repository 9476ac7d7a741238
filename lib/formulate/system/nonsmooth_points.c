/* nonsmooth_points.c: functions that jump or have a kink, and where */
#include "formulate/system/surfaces.h"

#include "base/memory.h"

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

Expr surface_ratio(Expr call)
{
    return expr_op(call) == OP_STICK ? expr_arg(call, 1) : NULL;
}

bool switch_jumps(Expr e)
{
    return expr_kind(e) == EXPR_CALL &&
           (expr_op(e) == OP_LT || expr_op(e) == OP_LE || expr_op(e) == OP_STEP ||
            expr_op(e) == OP_SIGN || expr_op(e) == OP_STICK || expr_op(e) == OP_FLOOR);
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
