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

/* a, e, d: arena, call and rates */
/* clang-format off */
static Expr d_zero(Arena *a, Expr e, const Expr *d) { (void)e; (void)d; return arena_zero(a); }
static Expr d_sin(Arena *a, Expr e, const Expr *d)  { return expr_mul(a, d[0], expr_cos(a, arg(e, 0))); }
static Expr d_cos(Arena *a, Expr e, const Expr *d)  { return expr_neg(a, expr_mul(a, d[0], expr_sin(a, arg(e, 0)))); }
static Expr d_tan(Arena *a, Expr e, const Expr *d)  { return expr_mul(a, d[0], one_and_square(a, 1, e)); }
static Expr d_asin(Arena *a, Expr e, const Expr *d) { return expr_div(a, d[0], expr_sqrt(a, one_and_square(a, -1, arg(e, 0)))); }
static Expr d_acos(Arena *a, Expr e, const Expr *d) { return expr_neg(a, d_asin(a, e, d)); }
static Expr d_atan(Arena *a, Expr e, const Expr *d) { return expr_div(a, d[0], one_and_square(a, 1, arg(e, 0))); }
static Expr d_sinh(Arena *a, Expr e, const Expr *d) { return expr_mul(a, d[0], expr_call1(a, OP_COSH, arg(e, 0))); }
static Expr d_cosh(Arena *a, Expr e, const Expr *d) { return expr_mul(a, d[0], expr_call1(a, OP_SINH, arg(e, 0))); }
static Expr d_tanh(Arena *a, Expr e, const Expr *d) { return expr_mul(a, d[0], one_and_square(a, -1, e)); }
static Expr d_exp(Arena *a, Expr e, const Expr *d)  { return expr_mul(a, d[0], e); }
static Expr d_log(Arena *a, Expr e, const Expr *d)  { return expr_div(a, d[0], arg(e, 0)); }
static Expr d_sqrt(Arena *a, Expr e, const Expr *d) { return expr_div(a, d[0], expr_mul(a, expr_int(a, 2), e)); }
static Expr d_abs(Arena *a, Expr e, const Expr *d)  { return expr_mul(a, d[0], expr_call1(a, OP_SIGN, arg(e, 0))); }
static Expr d_min(Arena *a, Expr e, const Expr *d)  { return expr_if(a, expr_call2(a, OP_LT, arg(e, 1), arg(e, 0)), d[1], d[0]); }
static Expr d_max(Arena *a, Expr e, const Expr *d)  { return expr_if(a, expr_call2(a, OP_LT, arg(e, 0), arg(e, 1)), d[1], d[0]); }
static Expr d_ramp(Arena *a, Expr e, const Expr *d) { return expr_mul(a, d[0], expr_call1(a, OP_STEP, arg(e, 0))); }
static Expr d_if(Arena *a, Expr e, const Expr *d)   { return expr_if(a, arg(e, 0), d[1], d[2]); }
static Expr d_named_temporary(Arena *a, Expr e, const Expr *d) { (void)e; return expr_name_temporary(a, d[0]); }
/* clang-format on */

/* (x*y' - y*x')/(x^2 + y^2), in every turn */
static Expr d_atan2(Arena *arena, Expr e, const Expr *rates)
{
    Expr y = arg(e, 0);
    Expr x = arg(e, 1);

    return expr_div(arena,
                    expr_sub(arena, expr_mul(arena, x, rates[0]), expr_mul(arena, y, rates[1])),
                    expr_add(arena, expr_square(arena, x), expr_square(arena, y)));
}

/* (x x' + y y')/hypot(x, y) */
static Expr d_hypot(Arena *arena, Expr e, const Expr *rates)
{
    return expr_div(
        arena,
        expr_add(arena, expr_mul(arena, arg(e, 0), rates[0]), expr_mul(arena, arg(e, 1), rates[1])),
        e);
}

/* (v' - v/n n')/n */
static Expr d_direction(Arena *arena, Expr e, const Expr *rates)
{
    return expr_div(arena, expr_sub(arena, rates[0], expr_mul(arena, e, rates[1])), arg(e, 1));
}

/* b v/|n|: b' v/|n| + b (v' - v n'/n)/|n|, whose second term is 0 where n is v, and at n = 0 */
static Expr d_coulomb(Arena *arena, Expr e, const Expr *rates)
{
    const Expr v = arg(e, 0), n = arg(e, 1);
    const Expr along = expr_call(arena, OP_COULOMB, (Expr[]){v, n, expr_int(arena, 1)});
    const Expr by_bound = expr_mul(arena, along, rates[2]);
    Expr turn;

    if (v == n)
        return by_bound;
    turn = expr_sub(arena, rates[0], expr_div(arena, expr_mul(arena, v, rates[1]), n));
    turn = expr_div(arena, expr_mul(arena, arg(e, 2), turn), expr_call1(arena, OP_ABS, n));
    return expr_add(
        arena, by_bound,
        expr_if(arena, expr_call2(arena, OP_EQ, n, expr_int(arena, 0)), expr_int(arena, 0), turn));
}

/* the same data, one order higher */
static Expr d_table(Arena *arena, Expr e, const Expr *rates)
{
    const Expr order = arg(e, 2);

    const Curve *curve = expr_data(arg(e, 0));

    if (!is_number(order) ||
        ((curve == NULL || !curve_is_law(curve)) && expr_value(order) + 1 >= CURVE_ORDERS))
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
