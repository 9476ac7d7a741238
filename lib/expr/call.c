/* call.c: functions: their values and exact simplifications
 *
 * v_name computes the function of a row of ops.def; its exact values at certain arguments are
 * listed in `exact`. */
#include "expr/expr_impl.h"

#include "algebra/elementary.h"

#include <math.h>
#include <string.h>

#define UNILATERAL_CLOSED 1e-9 /* m or rad: further beyond a bound no force holds */

/* --- values --- */

/* clang-format off */
static double v_sin(const double *x)   { return elementary_sin(x[0]); }
static double v_cos(const double *x)   { return elementary_cos(x[0]); }
static double v_tan(const double *x)   { return tan(x[0]); }
static double v_asin(const double *x)  { return asin(x[0]); }
static double v_acos(const double *x)  { return acos(x[0]); }
static double v_atan(const double *x)  { return atan(x[0]); }
static double v_atan2(const double *x) { return atan2(x[0], x[1]); }
static double v_unwrap(const double *x)
{
    const double turn = 6.283185307179586;
    double angle = atan2(x[0], x[1]);

    return angle + turn * rint((x[2] - angle) / turn);
}
static double v_sinh(const double *x)  { return sinh(x[0]); }
static double v_cosh(const double *x)  { return cosh(x[0]); }
static double v_tanh(const double *x)  { return tanh(x[0]); }
static double v_exp(const double *x)   { return elementary_exp(x[0]); }
static double v_log(const double *x)   { return elementary_log(x[0]); }
static double v_sqrt(const double *x)  { return sqrt(x[0]); }
static double v_abs(const double *x)   { return fabs(x[0]); }
static double v_sign(const double *x)  { return (x[0] > 0) - (x[0] < 0); }
/* beyond 0, by more than rounding, it has no value */
static double v_hypot(const double *x) { return hypot(x[0], x[1]); }
static double v_direction(const double *x) { return x[1] > 0 ? x[0] / x[1] : 0; }
static double v_coulomb(const double *x) { return x[1] != 0 ? x[2] * x[0] / fabs(x[1]) : 0; }
static double v_unilateral(const double *x) { return x[0] > UNILATERAL_CLOSED ? (double)NAN : 0; }
static double v_min(const double *x)   { return x[1] < x[0] ? x[1] : x[0]; }
static double v_max(const double *x)   { return x[1] > x[0] ? x[1] : x[0]; }
static double v_step(const double *x)  { return x[0] >= 0; }
static double v_ramp(const double *x)  { return x[0] > 0 ? x[0] : 0; }
static double v_floor(const double *x) { return floor(x[0]); }
static double v_lt(const double *x)    { return x[0] < x[1]; }
static double v_le(const double *x)    { return x[0] <= x[1]; }
static double v_eq(const double *x)    { return x[0] == x[1]; }
static double v_ne(const double *x)    { return x[0] != x[1]; }
static double v_and(const double *x)   { return x[0] != 0 && x[1] != 0; }
static double v_or(const double *x)    { return x[0] != 0 || x[1] != 0; }
static double v_not(const double *x)   { return x[0] == 0; }
static double v_if(const double *x)    { return x[0] != 0 ? x[1] : x[2]; }
static double v_named_temporary(const double *x)  { return x[0]; }
/* needs its data: expr_evaluate() and programs compute it */
static double v_table(const double *x) { return x[0] * (double)NAN; }
/* clang-format on */

/* --- the table --- */

typedef struct OpRow {
    const char *name;
    int args;
    double (*value)(const double *args);
} OpRow;

static const OpRow rows[] = {
#define OP(id, name, args, derivative, c, latex, value, dimension) {name, args, value},
#include "expr/ops.def"
#undef OP
};

const char *op_name(Op op)
{
    return rows[op].name;
}

int op_args(Op op)
{
    return rows[op].args;
}

double op_value(Op op, const double *args)
{
    return rows[op].value(args);
}

/* --- exact simplifications --- */

typedef enum Parity { NEITHER, ODD, EVEN } Parity;

/* What is known of a function without rounding. */
typedef struct Exact {
    Parity parity;
    bool known; /* f(at) is `gives` */
    int at;
    int gives;
    bool undoes; /* f(inverse(x)) is x */
    Op inverse;
    bool commutes;
    bool picks;                                   /* compares or chooses: exact for any numbers */
    Expr (*rule)(Arena *arena, const Expr *args); /* other rules; returns NULL if none applies */
} Exact;

static Expr exact_sqrt(Arena *arena, const Expr *args)
{
    Number root;

    if (!is_number(args[0]) || !number_root(number_of(args[0]), 2, &root))
        return NULL;
    return number_node(arena, root);
}

/* sin(n*pi/12) where it is half a root of a whole number; else NULL */
static Expr sine_of_twelfths(Arena *arena, int64_t n)
{
    static const int squares[] = {0, -1, 1, 2, 3, -1, 4};
    Number half = {1, 2, {0}};
    Expr root;

    n = (n % 24 + 24) % 24;
    root = expr_int(arena, squares[n % 12 <= 6 ? n % 12 : 12 - n % 12]);
    if (is_negative(root))
        return NULL;
    root = expr_sqrt(arena, root);
    half = n < 12 ? half : number_neg(half);
    return is_number(root) ? number_node(arena, number_mul(number_of(root), half))
                           : term_scale(arena, root, half);
}

/* Whether `e` is a whole multiple of pi/parts, and which. */
static bool parts_of_pi(Expr e, int parts, int64_t *multiple)
{
    Number angle = is_number(e) ? number_of(e) : number_int(1);

    if (angle.den == 0 || angle.pi != 1 || parts % angle.den != 0)
        return false;
    *multiple = angle.num % (2 * parts) * (parts / angle.den);
    return true;
}

/* sin(x + n*pi/2); a cosine is a sine of one quarter more */
static Expr turned_sine(Arena *arena, Expr angle, int more)
{
    Expr last = angle->kind == EXPR_SUM ? node_args(angle)[angle->count - 1] : angle;
    int64_t n;
    Expr value;

    if (parts_of_pi(angle, 12, &n))
        return sine_of_twelfths(arena, n + 6 * more);
    if (angle->kind != EXPR_SUM || !parts_of_pi(last, 2, &n))
        return NULL;
    n = ((n + more) % 4 + 4) % 4;
    value = expr_call1(arena, n % 2 != 0 ? OP_COS : OP_SIN, expr_sub(arena, angle, last));
    return n < 2 ? value : expr_neg(arena, value);
}

static Expr exact_sin(Arena *arena, const Expr *args)
{
    return turned_sine(arena, args[0], 0);
}

static Expr exact_cos(Arena *arena, const Expr *args)
{
    return turned_sine(arena, args[0], 1);
}

static Expr exact_abs(Arena *arena, const Expr *args)
{
    (void)arena;
    return is_call(args[0], OP_ABS) || is_call(args[0], OP_SQRT) ? args[0] : NULL;
}

/* min and max of one thing twice */
static Expr exact_pick(Arena *arena, const Expr *args)
{
    (void)arena;
    return args[0] == args[1] ? args[0] : NULL;
}

/* a relation between a thing and itself */
static Expr exact_false(Arena *arena, const Expr *args)
{
    return args[0] == args[1] ? arena_zero(arena) : NULL;
}

static Expr exact_true(Arena *arena, const Expr *args)
{
    return args[0] == args[1] ? arena_one(arena) : NULL;
}

/* whether `e` is 0 or 1 by its kind */
static bool is_condition(Expr e)
{
    return e->kind == EXPR_CALL && e->op >= OP_LT && e->op <= OP_NOT;
}

static Expr exact_and(Arena *arena, const Expr *args)
{
    for (int i = 0; i < 2; i++) {
        if (expr_is_zero(args[i]))
            return arena_zero(arena);
        if (is_number(args[i]) && is_condition(args[1 - i]))
            return args[1 - i];
    }
    return args[0] == args[1] && is_condition(args[0]) ? args[0] : NULL;
}

static Expr exact_or(Arena *arena, const Expr *args)
{
    for (int i = 0; i < 2; i++) {
        if (is_number(args[i]) && !expr_is_zero(args[i]))
            return arena_one(arena);
        if (expr_is_zero(args[i]) && is_condition(args[1 - i]))
            return args[1 - i];
    }
    return args[0] == args[1] && is_condition(args[0]) ? args[0] : NULL;
}

static Expr exact_not(Arena *arena, const Expr *args)
{
    (void)arena;
    return is_call(args[0], OP_NOT) && is_condition(node_args(args[0])[0]) ? node_args(args[0])[0]
                                                                           : NULL;
}

static Expr exact_if(Arena *arena, const Expr *args)
{
    (void)arena;
    if (is_number(args[0]))
        return expr_is_zero(args[0]) ? args[2] : args[1];
    return args[1] == args[2] ? args[1] : NULL;
}

/* x holds its sign where it isn't 0, and then there is nothing to stick to */
static Expr exact_stick(Arena *arena, const Expr *args)
{
    if (is_number(args[1]) && expr_value(args[1]) == 1)
        return expr_call1(arena, OP_SIGN, args[0]);
    return is_number(args[0])
               ? expr_int(arena, (expr_value(args[0]) > 0) - (expr_value(args[0]) < 0))
               : NULL;
}

static Expr exact_coulomb(Arena *arena, const Expr *args)
{
    return expr_is_zero(args[2]) || expr_is_zero(args[0]) ? expr_int(arena, 0) : NULL;
}

static Expr exact_unilateral(Arena *arena, const Expr *args)
{
    return is_number(args[0]) && expr_value(args[0]) < 0 ? expr_int(arena, 0) : NULL;
}

static Expr exact_named_temporary(Arena *arena, const Expr *args)
{
    (void)arena;
    return is_number(args[0]) || args[0]->kind == EXPR_SYMBOL || is_call(args[0], OP_HOLD) ? args[0]
                                                                                           : NULL;
}

#define KNOWN(x, y) .known = true, .at = (x), .gives = (y)
#define UNDOES(op)  .undoes = true, .inverse = (op)
static const Exact exact[OP_COUNT] = {
    [OP_SIN] = {.parity = ODD, KNOWN(0, 0), UNDOES(OP_ASIN), .rule = exact_sin},
    [OP_COS] = {.parity = EVEN, KNOWN(0, 1), UNDOES(OP_ACOS), .rule = exact_cos},
    [OP_TAN] = {.parity = ODD, KNOWN(0, 0), UNDOES(OP_ATAN)},
    [OP_ASIN] = {.parity = ODD, KNOWN(0, 0)},
    [OP_ACOS] = {KNOWN(1, 0)},
    [OP_ATAN] = {.parity = ODD, KNOWN(0, 0)},
    [OP_SINH] = {.parity = ODD, KNOWN(0, 0)},
    [OP_COSH] = {.parity = EVEN, KNOWN(0, 1)},
    [OP_TANH] = {.parity = ODD, KNOWN(0, 0)},
    [OP_EXP] = {KNOWN(0, 1), UNDOES(OP_LOG)},
    [OP_LOG] = {KNOWN(1, 0), UNDOES(OP_EXP)},
    [OP_SQRT] = {KNOWN(0, 0), .rule = exact_sqrt},
    [OP_ABS] = {.parity = EVEN, .picks = true, .rule = exact_abs},
    [OP_SIGN] = {.parity = ODD, .picks = true},
    [OP_STICK] = {.rule = exact_stick},
    [OP_COULOMB] = {.rule = exact_coulomb},
    [OP_UNILATERAL] = {.rule = exact_unilateral},
    [OP_MIN] = {.commutes = true, .picks = true, .rule = exact_pick},
    [OP_MAX] = {.commutes = true, .picks = true, .rule = exact_pick},
    [OP_STEP] = {.picks = true},
    [OP_RAMP] = {.picks = true},
    [OP_FLOOR] = {.picks = true},
    [OP_LT] = {.picks = true, .rule = exact_false},
    [OP_LE] = {.picks = true, .rule = exact_true},
    [OP_EQ] = {.commutes = true, .picks = true, .rule = exact_true},
    [OP_NE] = {.commutes = true, .picks = true, .rule = exact_false},
    [OP_AND] = {.picks = true, .rule = exact_and},
    [OP_OR] = {.picks = true, .rule = exact_or},
    [OP_NOT] = {.picks = true, .rule = exact_not},
    [OP_IF] = {.rule = exact_if},
    [OP_HOLD] = {.parity = ODD, .rule = exact_named_temporary},
};

/* A function that only compares and chooses, of numbers. */
static Expr pick_exactly(Arena *arena, Op op, const Expr *args)
{
    double values[2] = {expr_value(args[0]), 0};

    switch (op) {
    case OP_MIN:
    case OP_MAX:
        return args[(op == OP_MIN) == (number_compare(number_of(args[0]), number_of(args[1])) > 0)];
    case OP_FLOOR:
        if (args[0]->kind == EXPR_RATIONAL) {
            const Ratio *ratio = node_ratio(args[0]);

            return expr_int(arena, ratio->num / ratio->den - (ratio->num % ratio->den < 0));
        }
        break;
    case OP_ABS:
        return is_negative(args[0]) ? expr_neg(arena, args[0]) : args[0];
    case OP_RAMP:
        return is_negative(args[0]) ? arena_zero(arena) : args[0];
    case OP_LT:
    case OP_LE:
    case OP_EQ:
    case OP_NE:
        /* as their order relates to 0, so do the numbers to each other */
        values[0] = number_compare(number_of(args[0]), number_of(args[1]));
        break;
    default:
        values[1] = op_args(op) == 2 ? expr_value(args[1]) : 0;
    }
    return expr_real(arena, op_value(op, values));
}

/* The value of a function of numbers, or NULL where the call remains. */
static Expr fold_numbers(Arena *arena, Op op, const Expr *args)
{
    double values[3] = {0};
    double value;
    bool real = true;

    for (int i = 0; i < op_args(op) && i < COUNT(values); i++) {
        if (!is_number(args[i]))
            return NULL;
        real = real && args[i]->kind == EXPR_REAL;
        values[i] = expr_value(args[i]);
    }
    if (exact[op].picks)
        return pick_exactly(arena, op, args);
    if (!real)
        return NULL;
    value = op_value(op, values);
    return isfinite(value) ? expr_real(arena, value) : NULL;
}

Expr expr_call(Arena *arena, Op op, const Expr *args)
{
    const Exact *row = &exact[op];
    Expr sorted[2];
    Expr simple = row->rule != NULL ? row->rule(arena, args) : NULL;

    if (simple == NULL && row->known && expr_is(args[0], row->at))
        simple = expr_int(arena, row->gives);
    if (simple == NULL && row->undoes && is_call(args[0], row->inverse))
        simple = node_args(args[0])[0];
    if (simple == NULL)
        simple = fold_numbers(arena, op, args);
    if (simple != NULL)
        return simple;
    if (row->parity != NEITHER && is_negative(args[0])) {
        simple = expr_call1(arena, op, expr_neg(arena, args[0]));
        return row->parity == ODD ? expr_neg(arena, simple) : simple;
    }
    if (row->commutes && expr_compare(args[0], args[1]) > 0) {
        sorted[0] = args[1];
        sorted[1] = args[0];
        args = sorted;
    }
    return node_intern(arena, EXPR_CALL, op, args, op_args(op));
}

Expr expr_call1(Arena *arena, Op op, Expr a)
{
    return expr_call(arena, op, &a);
}

Expr expr_call2(Arena *arena, Op op, Expr a, Expr b)
{
    return expr_call(arena, op, (Expr[]){a, b});
}

Expr expr_sin(Arena *arena, Expr a)
{
    return expr_call1(arena, OP_SIN, a);
}

Expr expr_cos(Arena *arena, Expr a)
{
    return expr_call1(arena, OP_COS, a);
}

Expr expr_sqrt(Arena *arena, Expr a)
{
    return expr_call1(arena, OP_SQRT, a);
}

Expr expr_if(Arena *arena, Expr condition, Expr yes, Expr no)
{
    return expr_call(arena, OP_IF, (Expr[]){condition, yes, no});
}

Expr expr_table(Arena *arena, Expr data, Expr x, int order)
{
    return expr_call(arena, OP_TABLE, (Expr[]){data, x, expr_int(arena, order)});
}

Expr expr_name_temporary(Arena *arena, Expr e)
{
    return expr_call1(arena, OP_HOLD, e);
}
