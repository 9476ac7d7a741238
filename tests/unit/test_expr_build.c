/* test_expr_build.c: numbers, builders, the arena */
#include "test_expr.h"

#define ADD(x, y) expr_add(w.arena, x, y)
#define SUB(x, y) expr_sub(w.arena, x, y)
#define MUL(x, y) expr_mul(w.arena, x, y)
#define DIV(x, y) expr_div(w.arena, x, y)
#define POW(x, k) expr_pow(w.arena, x, expr_int(w.arena, k))
#define INT(k)    expr_int(w.arena, k)

/* the world `w` and its symbols a, b, c; x */
#define BEGIN                                                                                      \
    World w = world_new(1);                                                                        \
    Expr a = w.symbols[0];                                                                         \
    Expr b = w.symbols[1];                                                                         \
    Expr x = w.symbols[3];                                                                         \
    (void)a, (void)b, (void)x
#define END arena_free(w.arena)

static __int128 gcd_wide(__int128 a, __int128 b)
{
    while (b != 0) {
        __int128 rest = a % b;

        a = b;
        b = rest;
    }
    return a < 0 ? -a : a;
}

/* e is num/den: exactly where that fits, else to rounding */
static void expect_ratio(Expr e, __int128 num, __int128 den)
{
    __int128 common = gcd_wide(num, den);
    double value = (double)num / (double)den;
    int64_t n;
    int64_t d;

    num /= common;
    den /= common;
    if (num <= INT64_MAX && num >= -INT64_MAX && den <= INT64_MAX)
        EXPECT(expr_rational_parts(e, &n, &d) && n == num && d == den);
    else
        EXPECT_NEAR(expr_value(e), value, 1e-15 * fabs(value));
}

static void rationals_are_exact_until_they_overflow(void)
{
    Arena *arena = arena_new();
    uint64_t random = 7;

    for (int i = 0; i < 4000; i++) {
        int bits = 1 + i % 62;
        int64_t p = (int64_t)(test_random(&random) >> (63 - bits)) - ((int64_t)1 << (bits - 1));
        int64_t q = (int64_t)(test_random(&random) >> (64 - bits / 2 - 1)) + 1;
        int64_t r = (int64_t)(test_random(&random) >> (63 - bits)) - ((int64_t)1 << (bits - 1));
        int64_t s = (int64_t)(test_random(&random) >> (64 - bits / 2 - 1)) + 1;
        Expr u = expr_rational(arena, p, q);
        Expr v = expr_rational(arena, r, s);

        expect_ratio(expr_add(arena, u, v), (__int128)p * s + (__int128)r * q, (__int128)q * s);
        expect_ratio(expr_mul(arena, u, v), (__int128)p * r, (__int128)q * s);
    }
    EXPECT(arena_status(arena) == OK);
    arena_free(arena);
}

/* num/den*pi^power as a builder of rationals and powers makes it */
static Expr of_pi(Arena *arena, int64_t num, int64_t den, int power)
{
    return expr_mul(arena, expr_rational(arena, num, den), expr_pi(arena, power));
}

/* products, quotients and powers of multiples of pi, and sums of the same power, as integers and
 * sums of exponents have them */
static void multiples_of_pi_are_exact(void)
{
    Arena *arena = arena_new();
    uint64_t random = 11;

    for (int i = 0; i < 3000; i++) {
        int64_t n[2], d[2];
        int p[2];
        Expr u[2];

        for (int k = 0; k < 2; k++) {
            n[k] = (int64_t)(test_random(&random) % 2001) - 1000;
            n[k] += n[k] == 0;
            d[k] = 1 + (int64_t)(test_random(&random) % 1000);
            p[k] = (int)(test_random(&random) % 9) - 4;
            u[k] = of_pi(arena, n[k], d[k], p[k]);
        }
        EXPECT(expr_mul(arena, u[0], u[1]) == of_pi(arena, n[0] * n[1], d[0] * d[1], p[0] + p[1]));
        EXPECT(expr_div(arena, u[0], u[1]) == of_pi(arena, n[0] * d[1], d[0] * n[1], p[0] - p[1]));
        EXPECT(expr_pow(arena, u[0], expr_int(arena, -3)) ==
               of_pi(arena, d[0] * d[0] * d[0], n[0] * n[0] * n[0], -3 * p[0]));
        EXPECT(expr_add(arena, u[0], of_pi(arena, n[1], d[1], p[0])) ==
               of_pi(arena, n[0] * d[1] + n[1] * d[0], d[0] * d[1], p[0]));
        EXPECT_NEAR(expr_value(expr_add(arena, u[0], u[1])),
                    (double)((long double)n[0] / d[0] * powl(M_PIl, p[0]) +
                             (long double)n[1] / d[1] * powl(M_PIl, p[1])),
                    1e-15 * (fabs(expr_value(u[0])) + fabs(expr_value(u[1]))));
        EXPECT(expr_sub(arena, u[0], u[0]) == expr_int(arena, 0));
        EXPECT(expr_sqrt(arena, expr_square(arena, of_pi(arena, llabs(n[0]), d[0], p[0]))) ==
               of_pi(arena, llabs(n[0]), d[0], p[0]));
    }
    EXPECT(expr_value(expr_pi(arena, 1)) == M_PI);
    EXPECT(expr_pi(arena, 0) == expr_int(arena, 1));
    EXPECT_NEAR(expr_value(expr_pow(arena, expr_pi(arena, 90), expr_int(arena, 2))), pow(M_PI, 180),
                1e-12 * pow(M_PI, 180));
    arena_free(arena);
}

static bool is_double(Expr e, void *context)
{
    (void)context;
    return expr_kind(e) == EXPR_REAL;
}

/* multiples of pi/6 and pi/4: without a double, of the right value, and on the unit circle */
static void sines_of_turns_are_exact(void)
{
    static const int parts[] = {1, 2, 3, 4, 6};
    Arena *arena = arena_new();

    for (int k = 0; k < COUNT(parts); k++)
        for (int n = -50; n <= 50; n++) {
            Expr angle = of_pi(arena, n, parts[k], 1);
            Expr both[2] = {expr_sin(arena, angle), expr_cos(arena, angle)};
            const long double at = (long double)n / parts[k] * M_PIl;
            Expr *doubles = NULL;

            EXPECT(expr_find(both, 2, is_double, NULL, &doubles) == 0);
            EXPECT_NEAR(expr_evaluate(both[0], NULL, NULL), (double)sinl(at), 1e-15);
            EXPECT_NEAR(expr_evaluate(both[1], NULL, NULL), (double)cosl(at), 1e-15);
            EXPECT(expr_add(arena, expr_square(arena, both[0]), expr_square(arena, both[1])) ==
                   expr_int(arena, 1));
            mem_free(doubles);
        }
    EXPECT_EXPR(expr_cos(arena, of_pi(arena, 1, 2, 1)), "0");
    EXPECT_EXPR(expr_sin(arena, of_pi(arena, -3, 4, 1)), "-0.5*sqrt(2)");
    EXPECT_NEAR(expr_value(expr_sin(arena, of_pi(arena, 1, 5, 1))), sin(M_PI / 5), 1e-16);
    EXPECT_NEAR(expr_value(expr_cos(arena, expr_pi(arena, 2))), cos(M_PI * M_PI), 1e-15);
    arena_free(arena);
}

static void quarter_turns_leave_the_argument(void)
{
    BEGIN;
    for (int n = -9; n <= 9; n++) {
        Expr turned = ADD(x, of_pi(w.arena, n, 2, 1));
        const double at = w.values[3] + n * M_PI_2;

        EXPECT_NEAR(value_in(&w, expr_sin(w.arena, turned)), sin(at), 1e-14);
        EXPECT_NEAR(value_in(&w, expr_cos(w.arena, turned)), cos(at), 1e-14);
    }
    EXPECT(expr_sin(w.arena, ADD(x, of_pi(w.arena, 1, 2, 1))) == expr_cos(w.arena, x));
    EXPECT(expr_cos(w.arena, SUB(expr_pi(w.arena, 1), x)) ==
           expr_neg(w.arena, expr_cos(w.arena, x)));
    EXPECT_EXPR(expr_sin(w.arena, ADD(x, of_pi(w.arena, 1, 3, 1))), "sin(x + pi/3)");
    END;
}

static void small_decimals_are_exact(void)
{
    Arena *arena = arena_new();

    EXPECT(expr_decimal(arena, "0.25") == expr_rational(arena, 1, 4));
    EXPECT(expr_decimal(arena, "2.194e-6") == expr_rational(arena, 1097, 500000000));
    EXPECT(expr_decimal(arena, "1e3") == expr_int(arena, 1000));
    EXPECT(expr_decimal(arena, ".5") == expr_rational(arena, 1, 2));
    EXPECT(expr_decimal(arena, "0.000") == expr_int(arena, 0));
    EXPECT(expr_decimal(arena, "9223372036854775807") == expr_int(arena, INT64_MAX));
    EXPECT(expr_kind(expr_decimal(arena, "6.02214076e23")) == EXPR_REAL);
    EXPECT(expr_kind(expr_decimal(arena, "1e-30")) == EXPR_REAL);
    EXPECT(expr_value(expr_decimal(arena, "1e-30")) == 1e-30);
    EXPECT(expr_kind(expr_decimal(arena, "0.1234567890123456")) == EXPR_REAL);
    EXPECT(expr_real(arena, 3.0) == expr_int(arena, 3));
    EXPECT(expr_real(arena, -0.0) == expr_int(arena, 0));
    EXPECT(expr_kind(expr_real(arena, 0.1)) == EXPR_REAL);
    arena_free(arena);
}

static void sums_collect_like_terms(void)
{
    BEGIN;

    EXPECT(ADD(a, a) == MUL(INT(2), a));
    EXPECT(expr_is_zero(SUB(ADD(a, b), ADD(b, a))));
    EXPECT(ADD(ADD(a, b), x) == ADD(a, ADD(b, x)));
    EXPECT(SUB(ADD(a, INT(3)), INT(3)) == a);
    EXPECT(ADD(MUL(a, b), MUL(b, a)) == MUL(INT(2), MUL(a, b)));
    EXPECT(expr_neg(w.arena, SUB(a, b)) == SUB(b, a));
    EXPECT(MUL(INT(-1), SUB(a, b)) == SUB(b, a));
    EXPECT_EXPR(MUL(INT(2), ADD(a, b)), "2*(a + b)");
    EXPECT(ADD(DIV(ADD(a, b), INT(2)), DIV(ADD(a, b), INT(2))) == ADD(a, b));
    EXPECT(expr_is_zero(ADD(MUL(x, SUB(a, b)), MUL(x, SUB(b, a)))));
    END;
}

static void products_collect_powers(void)
{
    BEGIN;

    EXPECT(MUL(x, x) == POW(x, 2));
    EXPECT(expr_is(MUL(x, POW(x, -1)), 1));
    EXPECT(MUL(MUL(a, b), x) == MUL(x, MUL(b, a)));
    EXPECT(POW(MUL(a, b), 3) == MUL(POW(a, 3), POW(b, 3)));
    EXPECT(POW(POW(a, 2), 3) == POW(a, 6));
    EXPECT(expr_is_zero(MUL(INT(0), x)));
    EXPECT(MUL(x, INT(1)) == x);
    EXPECT(POW(SUB(a, b), 2) == POW(SUB(b, a), 2));
    EXPECT(POW(SUB(a, b), 3) == expr_neg(w.arena, POW(SUB(b, a), 3)));
    EXPECT(expr_mul(w.arena, expr_pow(w.arena, a, b), expr_pow(w.arena, a, x)) ==
           expr_pow(w.arena, a, ADD(b, x)));
    EXPECT(expr_is(POW(x, 0), 1));
    END;
}

static void roots_are_half_powers(void)
{
    BEGIN;
    Expr root = expr_sqrt(w.arena, x);

    EXPECT(POW(root, 2) == x);
    EXPECT(MUL(root, root) == x);
    EXPECT(DIV(x, root) == root);
    EXPECT(POW(root, 3) == MUL(x, root));
    EXPECT(expr_pow(w.arena, x, expr_rational(w.arena, 1, 2)) == root);
    EXPECT(expr_sqrt(w.arena, expr_rational(w.arena, 9, 4)) == expr_rational(w.arena, 3, 2));
    EXPECT_EXPR(expr_sqrt(w.arena, INT(2)), "sqrt(2)");
    EXPECT_EXPR(DIV(INT(1), expr_sqrt(w.arena, INT(2))), "0.5*sqrt(2)");
    EXPECT(expr_pow(w.arena, INT(8), expr_rational(w.arena, 2, 3)) == INT(4));
    /* not x: that would be wrong for negative x */
    EXPECT_EXPR(expr_sqrt(w.arena, POW(x, 2)), "sqrt(x^2)");
    EXPECT(MUL(expr_sqrt(w.arena, MUL(a, b)), expr_sqrt(w.arena, MUL(a, b))) == MUL(a, b));
    EXPECT(MUL(expr_sqrt(w.arena, SUB(b, a)), expr_sqrt(w.arena, SUB(b, a))) == SUB(b, a));
    END;
}

static void functions_know_their_parity(void)
{
    BEGIN;

    EXPECT(expr_sin(w.arena, SUB(b, a)) == expr_neg(w.arena, expr_sin(w.arena, SUB(a, b))));
    EXPECT(expr_cos(w.arena, SUB(b, a)) == expr_cos(w.arena, SUB(a, b)));
    EXPECT(expr_cos(w.arena, MUL(INT(-2), a)) == expr_cos(w.arena, MUL(INT(2), a)));
    EXPECT(expr_is_zero(expr_sin(w.arena, INT(0))));
    EXPECT(expr_is(expr_cos(w.arena, INT(0)), 1));
    EXPECT_EXPR(expr_sin(w.arena, INT(1)), "sin(1)");
    EXPECT(expr_kind(expr_sin(w.arena, expr_real(w.arena, 0.1))) == EXPR_REAL);
    END;
}

static void conditions_fold(void)
{
    BEGIN;
    Expr less = expr_call2(w.arena, OP_LT, a, b);

    EXPECT(expr_if(w.arena, INT(1), a, b) == a);
    EXPECT(expr_if(w.arena, INT(0), a, b) == b);
    EXPECT(expr_if(w.arena, less, a, a) == a);
    EXPECT(expr_is_zero(expr_call2(w.arena, OP_LT, a, a)));
    EXPECT(expr_is(expr_call2(w.arena, OP_LE, a, a), 1));
    EXPECT(expr_is(expr_call2(w.arena, OP_LT, expr_rational(w.arena, 1, 3), INT(1)), 1));
    EXPECT(expr_call2(w.arena, OP_AND, less, INT(1)) == less);
    EXPECT(expr_is_zero(expr_call2(w.arena, OP_AND, less, INT(0))));
    EXPECT(expr_call2(w.arena, OP_OR, INT(0), less) == less);
    EXPECT(expr_is(expr_call2(w.arena, OP_OR, INT(2), less), 1));
    EXPECT(expr_call1(w.arena, OP_NOT, expr_call1(w.arena, OP_NOT, less)) == less);
    EXPECT(expr_call2(w.arena, OP_MIN, a, b) == expr_call2(w.arena, OP_MIN, b, a));
    EXPECT(expr_is(expr_call2(w.arena, OP_MIN, INT(2), INT(3)), 2));
    EXPECT(expr_is(expr_call2(w.arena, OP_MAX, INT(2), INT(3)), 3));
    EXPECT(expr_is(expr_call1(w.arena, OP_FLOOR, expr_rational(w.arena, -7, 2)), -4));
    EXPECT(expr_is(expr_call1(w.arena, OP_STEP, INT(0)), 1));
    EXPECT(expr_is(expr_call1(w.arena, OP_RAMP, INT(-3)), 0));
    EXPECT(expr_is(expr_call1(w.arena, OP_ABS, INT(-3)), 3));
    EXPECT(expr_is(expr_call1(w.arena, OP_SIGN, expr_rational(w.arena, -1, 3)), -1));
    END;
}

static void holds_are_opaque(void)
{
    BEGIN;
    Expr hold = expr_name_temporary(w.arena, ADD(a, b));

    EXPECT(expr_name_temporary(w.arena, x) == x);
    EXPECT(expr_name_temporary(w.arena, expr_neg(w.arena, x)) == expr_neg(w.arena, x));
    EXPECT(expr_name_temporary(w.arena, hold) == hold);
    EXPECT(expr_name_temporary(w.arena, SUB(a, b)) ==
           expr_neg(w.arena, expr_name_temporary(w.arena, SUB(b, a))));
    EXPECT(expr_arg_count(ADD(hold, x)) == 2);
    EXPECT(expr_open(w.arena, ADD(hold, x)) == ADD(ADD(a, b), x));
    EXPECT(expr_is_zero(expr_open(w.arena, SUB(hold, ADD(a, b)))));
    EXPECT(expr_op(expr_diff(w.arena, expr_name_temporary(w.arena, POW(ADD(a, x), 2)), x)) ==
               OP_HOLD ||
           expr_kind(expr_diff(w.arena, expr_name_temporary(w.arena, POW(ADD(a, x), 2)), x)) ==
               EXPR_PRODUCT);
    END;
}

static void commuting_gives_the_same_pointer(void)
{
    for (uint64_t seed = 1; seed <= 300; seed++) {
        World w = world_new(seed);
        double v;
        Expr p = random_expr(&w, 3, &v);
        Expr q = random_expr(&w, 3, &v);
        Expr r = random_expr(&w, 3, &v);

        EXPECT(ADD(p, q) == ADD(q, p));
        EXPECT(MUL(p, q) == MUL(q, p));
        EXPECT(ADD(ADD(p, q), r) == ADD(p, ADD(q, r)));
        EXPECT(MUL(MUL(p, q), r) == MUL(p, MUL(q, r)));
        EXPECT(expr_is_zero(SUB(p, p)));
        EXPECT(SUB(ADD(p, q), q) == p);
        EXPECT(expr_compare(p, q) == -expr_compare(q, p));
        EXPECT(arena_status(w.arena) == OK);
        arena_free(w.arena);
    }
}

static void builders_keep_the_value(void)
{
    for (uint64_t seed = 1; seed <= 1000; seed++) {
        World w = world_with_pi(seed);
        double direct;
        Expr e = random_expr(&w, 5, &direct);

        EXPECT_NEAR(value_in(&w, e), direct, 1e-9 * size_of(direct));
        arena_free(w.arena);
    }
}

static void order_is_total_and_repeats(void)
{
    World w = world_new(3);
    World v = world_new(3);
    Expr es[60];
    Expr again;
    double value;

    for (int i = 0; i < 60; i++) {
        char *text;

        es[i] = random_expr(&w, 4, &value);
        again = random_expr(&v, 4, &value);
        text = expr_text(again);
        EXPECT_EXPR(es[i], text);
        mem_free(text);
    }
    for (int i = 0; i < 60; i++) {
        for (int j = 0; j < 60; j++) {
            EXPECT((expr_compare(es[i], es[j]) == 0) == (es[i] == es[j]));
            for (int k = 0; k < 60; k++)
                EXPECT(!(expr_compare(es[i], es[j]) < 0 && expr_compare(es[j], es[k]) < 0) ||
                       expr_compare(es[i], es[k]) < 0);
        }
    }
    arena_free(w.arena);
    arena_free(v.arena);
}

/* the same expressions print alike whatever was built before them */
static void order_forgets_history(void)
{
    World w = world_new(3);
    World v = world_new(3);
    uint64_t start = v.random;
    double value;

    for (int i = 0; i < 500; i++)
        (void)random_expr(&v, 4, &value);
    v.random = start;
    for (int i = 0; i < 100; i++) {
        char *text = expr_text(random_expr(&v, 5, &value));

        EXPECT_EXPR(random_expr(&w, 5, &value), text);
        mem_free(text);
    }
    arena_free(w.arena);
    arena_free(v.arena);
}

static void release_leaves_no_ghosts(void)
{
    BEGIN;
    Expr kept = MUL(a, b);
    int64_t nodes = arena_nodes(w.arena);
    double value;

    for (int round = 0; round < 20; round++) {
        ArenaMark *mark = arena_mark(w.arena);
        Expr scratch = expr_symbol(w.arena, "scratch", SYMBOL_PARAMETER);

        for (int i = 0; i < 200; i++) {
            Expr e = random_expr(&w, 4, &value);

            expr_diff(w.arena, MUL(e, scratch), x);
        }
        EXPECT(arena_nodes(w.arena) > nodes);
        arena_release(w.arena, mark);
        EXPECT(arena_nodes(w.arena) == nodes);
        EXPECT(MUL(b, a) == kept);
        EXPECT_EXPR(kept, "a*b");
    }
    arena_retain(w.arena, arena_mark(w.arena));
    EXPECT(expr_symbol_number(expr_symbol(w.arena, "next", SYMBOL_TIME)) == TEST_SYMBOLS);
    END;
}

static void tuples_recall_what_follows_until_released(void)
{
    BEGIN;
    const Expr tuple = expr_tuple(w.arena, (Expr[]){a, b, a}, 3);
    const Expr values[2] = {ADD(a, b), x};
    Expr found[2] = {NULL};

    /* a tuple is no sum, product or call, and its order counts */
    EXPECT(expr_tuple(w.arena, (Expr[]){a, b, a}, 3) == tuple);
    EXPECT(expr_tuple(w.arena, (Expr[]){a, a, b}, 3) != tuple);
    EXPECT(!expr_recall(w.arena, tuple, 0, found, sizeof found));
    for (int round = 0; round < 3; round++) {
        ArenaMark *mark = arena_mark(w.arena);
        Expr other = NULL;

        expr_remember(w.arena, tuple, 0, values, sizeof values);
        expr_remember(w.arena, tuple, 1, &tuple, sizeof tuple);
        EXPECT(expr_recall(w.arena, tuple, 0, found, sizeof found));
        EXPECT(found[0] == values[0] && found[1] == values[1]);
        EXPECT(expr_recall(w.arena, tuple, 1, &other, sizeof other) && other == tuple);
        arena_release(w.arena, mark);
        EXPECT(!expr_recall(w.arena, tuple, 0, found, sizeof found));
        EXPECT(!expr_recall(w.arena, tuple, 1, &other, sizeof other));
    }
    END;
}

static void division_by_zero_is_remembered_once(void)
{
    BEGIN;

    DIV(x, SUB(a, a));
    EXPECT(arena_status(w.arena) == E_DOMAIN);
    EXPECT_TEXT(arena_failure(w.arena), "division by zero");
    expr_real(w.arena, INFINITY);
    EXPECT_TEXT(arena_failure(w.arena), "division by zero");
    arena_reset(w.arena);
    EXPECT(arena_status(w.arena) == OK);
    expr_real(w.arena, INFINITY);
    EXPECT_TEXT(arena_failure(w.arena), "a number beyond what can be held");
    arena_reset(w.arena);
    expr_rational(w.arena, 1, 0);
    EXPECT(arena_status(w.arena) == E_DOMAIN);
    END;
}

static void growth_has_a_limit(void)
{
    BEGIN;
    Expr e = x;

    (void)arena_limit(w.arena, 1000);
    for (int i = 0; i < 5000; i++)
        e = expr_sin(w.arena, ADD(e, a));
    EXPECT(arena_status(w.arena) == E_MEMORY);
    EXPECT_TEXT(arena_failure(w.arena), "the expressions grow beyond all bounds");
    EXPECT(arena_nodes(w.arena) < 1100);
    END;
}

/* n terms take about n log n steps: ten times the terms, far from a hundred times the work */
static void long_sums_are_built_at_once(void)
{
    Arena *arena = arena_new();
    enum { MANY = 20000 };
    Expr *terms = NEW_ARRAY(Expr, MANY);
    Expr sum;

    for (int i = 0; i < MANY; i++) {
        char name[24];

        snprintf(name, sizeof name, "p%d", (i * 7919) % MANY);
        terms[i] = expr_symbol(arena, name, SYMBOL_PARAMETER);
    }
    sum = expr_sum(arena, terms, MANY);
    EXPECT(expr_arg_count(sum) == MANY);
    EXPECT(expr_is_zero(expr_sub(arena, sum, sum)));
    mem_free(terms);
    arena_free(arena);
}

/* A sum of doubles that is rounding of their sizes is 0; what a user gives is exact, and what is
 * small beside nothing that cancels stays. */
static void rounding_of_nothing_vanishes(void)
{
    BEGIN;
    const Expr third = expr_real(w.arena, 0.1 + 0.2), minus = expr_real(w.arena, -0.3);
    const Expr tiny = expr_decimal(w.arena, "1e-17"), small = expr_real(w.arena, 1e-15 / 3);

    EXPECT(0.1 + 0.2 - 0.3 != 0);
    EXPECT(expr_is_zero(ADD(third, minus)));
    EXPECT(ADD(MUL(third, x), MUL(minus, x)) == INT(0));
    EXPECT(expr_sum(w.arena, (Expr[]){MUL(third, x), a, MUL(minus, x)}, 3) == a);
    EXPECT(ADD(MUL(third, x), MUL(tiny, a)) != MUL(third, x));
    EXPECT(expr_value(expr_sum(w.arena, (Expr[]){INT(1), tiny, INT(-1)}, 3)) == 1e-17);
    EXPECT(expr_value(expr_sum(w.arena, (Expr[]){INT(1), INT(-1), small}, 3)) == 1e-15 / 3);
    EXPECT(expr_value(ADD(ADD(third, minus), small)) == 1e-15 / 3);
    EXPECT(expr_value(ADD(INT(1), expr_real(w.arena, -1 + 1e-14))) != 0);
    EXPECT(expr_value(ADD(small, small)) == 2 * (1e-15 / 3));
    END;
}

int main(void)
{
    RUN(rounding_of_nothing_vanishes);
    RUN(rationals_are_exact_until_they_overflow);
    RUN(multiples_of_pi_are_exact);
    RUN(sines_of_turns_are_exact);
    RUN(quarter_turns_leave_the_argument);
    RUN(small_decimals_are_exact);
    RUN(sums_collect_like_terms);
    RUN(products_collect_powers);
    RUN(roots_are_half_powers);
    RUN(functions_know_their_parity);
    RUN(conditions_fold);
    RUN(holds_are_opaque);
    RUN(commuting_gives_the_same_pointer);
    RUN(builders_keep_the_value);
    RUN(order_is_total_and_repeats);
    RUN(order_forgets_history);
    RUN(release_leaves_no_ghosts);
    RUN(tuples_recall_what_follows_until_released);
    RUN(division_by_zero_is_remembered_once);
    RUN(growth_has_a_limit);
    RUN(long_sums_are_built_at_once);
    return test_end();
}
