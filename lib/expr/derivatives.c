/* derivatives.c: derivatives of functions
 *
 * d_name is the derivative of a call e of a row of ops.def, given those of its arguments. */
#include "expr/expr_impl.h"

static Expr arg(Expr e, int i)
{
    return node_args(e)[i];
}

/* 1 + sign*x^2 */
static Expr one_and_square(Arena *arena, int sign, Expr x)
{
    return expr_add(arena, arena_one(arena),
                    expr_mul(arena, expr_int(arena, sign), expr_square(arena, x)));
}

static Expr d_zero(Arena *arena, Expr e, const Expr *rates)
{
    (void)e;
    (void)rates;
    return arena_zero(arena);
}

static Expr d_sin(Arena *arena, Expr e, const Expr *rates)
{
    return expr_mul(arena, rates[0], expr_cos(arena, arg(e, 0)));
}

static Expr d_cos(Arena *arena, Expr e, const Expr *rates)
{
    return expr_neg(arena, expr_mul(arena, rates[0], expr_sin(arena, arg(e, 0))));
}

static Expr d_tan(Arena *arena, Expr e, const Expr *rates)
{
    return expr_mul(arena, rates[0], one_and_square(arena, 1, e));
}

static Expr d_asin(Arena *arena, Expr e, const Expr *rates)
{
    return expr_div(arena, rates[0], expr_sqrt(arena, one_and_square(arena, -1, arg(e, 0))));
}

static Expr d_acos(Arena *arena, Expr e, const Expr *rates)
{
    return expr_neg(arena, d_asin(arena, e, rates));
}

static Expr d_atan(Arena *arena, Expr e, const Expr *rates)
{
    return expr_div(arena, rates[0], one_and_square(arena, 1, arg(e, 0)));
}

/* (x*y' - y*x')/(x^2 + y^2), in every turn */
static Expr d_atan2(Arena *arena, Expr e, const Expr *rates)
{
    Expr y = arg(e, 0);
    Expr x = arg(e, 1);

    return expr_div(arena,
                    expr_sub(arena, expr_mul(arena, x, rates[0]), expr_mul(arena, y, rates[1])),
                    expr_add(arena, expr_square(arena, x), expr_square(arena, y)));
}

static Expr d_sinh(Arena *arena, Expr e, const Expr *rates)
{
    return expr_mul(arena, rates[0], expr_call1(arena, OP_COSH, arg(e, 0)));
}

static Expr d_cosh(Arena *arena, Expr e, const Expr *rates)
{
    return expr_mul(arena, rates[0], expr_call1(arena, OP_SINH, arg(e, 0)));
}

static Expr d_tanh(Arena *arena, Expr e, const Expr *rates)
{
    return expr_mul(arena, rates[0], one_and_square(arena, -1, e));
}

static Expr d_exp(Arena *arena, Expr e, const Expr *rates)
{
    return expr_mul(arena, rates[0], e);
}

static Expr d_log(Arena *arena, Expr e, const Expr *rates)
{
    return expr_div(arena, rates[0], arg(e, 0));
}

static Expr d_sqrt(Arena *arena, Expr e, const Expr *rates)
{
    return expr_div(arena, rates[0], expr_mul(arena, expr_int(arena, 2), e));
}

static Expr d_abs(Arena *arena, Expr e, const Expr *rates)
{
    return expr_mul(arena, rates[0], expr_call1(arena, OP_SIGN, arg(e, 0)));
}

static Expr d_min(Arena *arena, Expr e, const Expr *rates)
{
    return expr_if(arena, expr_call2(arena, OP_LT, arg(e, 1), arg(e, 0)), rates[1], rates[0]);
}

static Expr d_max(Arena *arena, Expr e, const Expr *rates)
{
    return expr_if(arena, expr_call2(arena, OP_LT, arg(e, 0), arg(e, 1)), rates[1], rates[0]);
}

static Expr d_ramp(Arena *arena, Expr e, const Expr *rates)
{
    return expr_mul(arena, rates[0], expr_call1(arena, OP_STEP, arg(e, 0)));
}

static Expr d_if(Arena *arena, Expr e, const Expr *rates)
{
    return expr_if(arena, arg(e, 0), rates[1], rates[2]);
}

static Expr d_hold(Arena *arena, Expr e, const Expr *rates)
{
    (void)e;
    return expr_hold(arena, rates[0]);
}

/* the same data, one order higher */
static Expr d_table(Arena *arena, Expr e, const Expr *rates)
{
    const Expr order = arg(e, 2);

    if (!is_number(order) || expr_value(order) + 1 >= CURVE_ORDERS)
        return arena_zero(arena);
    return expr_mul(arena, rates[1],
                    expr_table(arena, arg(e, 0), arg(e, 1), (int)expr_value(order) + 1));
}

Expr op_derivative(Arena *arena, Expr e, const Expr *rates)
{
    static Expr (*const rules[])(Arena *, Expr, const Expr *) = {
#define OP(id, name, args, derivative, ...) derivative,
#include "expr/ops.def"
#undef OP
    };

    return rules[e->op](arena, e, rates);
}
