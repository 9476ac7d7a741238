/* test_expr_laws.c: laws of every function of the table, of derivatives and substitution */
#include "test_expr.h"

/* A call of op with arguments that move with x, where it is smooth: the argument ranges
 * of each function meet in (0.3, 0.9). */
/* a table takes data: test_table.c; beyond a limit there is no value: test_stops.c */
static bool has_own_test(Op op)
{
    return op == OP_TABLE || op == OP_UNILATERAL;
}

static Expr sample_call(World *w, Op op)
{
    Arena *arena = w->arena;
    Expr x = w->symbols[3];
    Expr args[3] = {
        expr_add(arena, expr_mul(arena, expr_rational(arena, 1, 3), expr_sin(arena, x)),
                 expr_rational(arena, 1, 2)),
        expr_add(arena, expr_square(arena, x), w->symbols[0]),
        expr_mul(arena, x, w->symbols[1]),
    };

    return expr_call(arena, op, args);
}

static void every_function_agrees_with_its_difference_quotient(void)
{
    for (int op = 0; op < OP_COUNT; op++) {
        if (has_own_test((Op)op))
            continue;

        World w = world_new(11 + (uint64_t)op);
        double h = 1e-6;
        Expr e = sample_call(&w, (Op)op);
        Expr rate = expr_diff(w.arena, e, w.symbols[3]);
        double x = w.values[3] = 0.7;
        double low;
        double high;

        w.values[3] = x - h;
        low = value_in(&w, e);
        w.values[3] = x + h;
        high = value_in(&w, e);
        w.values[3] = x;
        EXPECT_NEAR(value_in(&w, rate), (high - low) / (2 * h), 1e-8);
        EXPECT(isfinite(value_in(&w, rate)));
        arena_free(w.arena);
    }
}

static void every_function_has_one_to_three_arguments(void)
{
    for (int op = 0; op < OP_COUNT; op++)
        EXPECT(op_args((Op)op) >= 1 && op_args((Op)op) <= 3);
}

static void every_function_computes_what_it_folds_to(void)
{
    for (int op = 0; op < OP_COUNT; op++) {
        if (has_own_test((Op)op))
            continue;

        World w = world_new(5);
        double values[3] = {0.3141592653589793, 0.7320508075688772, 0.236067977499789};
        Expr args[3];
        Expr e;

        for (int i = 0; i < 3; i++)
            args[i] = expr_real(w.arena, values[i]);
        e = expr_call(w.arena, (Op)op, args);
        EXPECT(expr_is_number(e));
        EXPECT_NEAR(expr_value(e), op_value((Op)op, values), 0);
        arena_free(w.arena);
    }
}

static void every_function_substitutes_into_its_value(void)
{
    for (int op = 0; op < OP_COUNT; op++) {
        if (has_own_test((Op)op))
            continue;

        World w = world_new(5);
        Expr e = sample_call(&w, (Op)op);
        Expr reals[TEST_SYMBOLS];
        Expr folded;

        for (int i = 0; i < TEST_SYMBOLS; i++)
            reals[i] = expr_real(w.arena, w.values[i] /= 2);
        folded = expr_substitute(w.arena, e, w.symbols, reals, TEST_SYMBOLS);
        EXPECT_NEAR(value_in(&w, folded), value_in(&w, e), 1e-14);
        arena_free(w.arena);
    }
}

static void derivatives_agree_with_difference_quotients(void)
{
    for (uint64_t seed = 1; seed <= 400; seed++) {
        World w = world_with_pi(seed);
        double value;
        double h = 1e-5;
        Expr e = random_expr(&w, 4, &value);
        Expr rate = expr_diff(w.arena, e, w.symbols[4]);
        double y = w.values[4];
        double at[4];
        double quotient;

        for (int i = 0; i < 4; i++) {
            static const double steps[] = {-2, -1, 1, 2};

            w.values[4] = y + steps[i] * h;
            at[i] = value_in(&w, e);
        }
        w.values[4] = y;
        /* five points, error of fourth order */
        quotient = (at[0] - 8 * at[1] + 8 * at[2] - at[3]) / (12 * h);
        EXPECT_NEAR(value_in(&w, rate), quotient, 1e-6 * size_of(quotient) + 1e-9 * size_of(value));
        arena_free(w.arena);
    }
}

static void total_derivative_is_the_sum_of_partial_ones(void)
{
    for (uint64_t seed = 1; seed <= 200; seed++) {
        World w = world_with_pi(seed);
        Expr e;
        Expr sum = expr_int(w.arena, 0);
        Expr along;
        double value;

        e = random_expr(&w, 4, &value);
        /* x' = y, y' = a, z' = x*z */
        Expr rates[3] = {w.symbols[4], w.symbols[0], expr_mul(w.arena, w.symbols[3], w.symbols[5])};

        along = expr_diff_along(w.arena, e, w.symbols + 3, rates, 3);
        for (int i = 0; i < 3; i++) {
            Expr partial = expr_diff(w.arena, e, w.symbols[3 + i]);

            sum = expr_add(w.arena, sum, expr_mul(w.arena, partial, rates[i]));
        }
        value = value_in(&w, sum);
        EXPECT_NEAR(value_in(&w, along), value, 1e-10 * size_of(value));
        arena_free(w.arena);
    }
}

static void derivatives_obey_leibniz(void)
{
    for (uint64_t seed = 1; seed <= 200; seed++) {
        World w = world_with_pi(seed);
        double value;
        Expr x = w.symbols[3];
        Expr p = random_expr(&w, 3, &value);
        Expr q = random_expr(&w, 3, &value);
        Expr left = expr_diff(w.arena, expr_mul(w.arena, p, q), x);
        Expr right = expr_add(w.arena, expr_mul(w.arena, expr_diff(w.arena, p, x), q),
                              expr_mul(w.arena, p, expr_diff(w.arena, q, x)));

        value = value_in(&w, right);
        EXPECT_NEAR(value_in(&w, left), value, 1e-10 * size_of(value));
        EXPECT(expr_diff(w.arena, p, x) == expr_diff(w.arena, p, x));
        arena_free(w.arena);
    }
}

/* (e with x = p)' by y is e_x * p' + e_y, both with x = p */
static void substitution_and_derivative_commute(void)
{
    for (uint64_t seed = 1; seed <= 200; seed++) {
        World w = world_with_pi(seed);
        double value;
        Expr x = w.symbols[3];
        Expr y = w.symbols[4];
        Expr e = random_expr(&w, 3, &value);
        Expr p = random_expr(&w, 2, &value);
        Expr left = expr_diff(w.arena, expr_substitute(w.arena, e, &x, &p, 1), y);
        Expr by_x = expr_substitute(w.arena, expr_diff(w.arena, e, x), &x, &p, 1);
        Expr by_y = expr_substitute(w.arena, expr_diff(w.arena, e, y), &x, &p, 1);
        Expr right = expr_add(w.arena, expr_mul(w.arena, by_x, expr_diff(w.arena, p, y)), by_y);

        value = value_in(&w, right);
        EXPECT_NEAR(value_in(&w, left), value, 1e-9 * size_of(value));
        arena_free(w.arena);
    }
}

static void substitution_is_simultaneous(void)
{
    World w = world_new(1);
    Expr xy[2] = {w.symbols[3], w.symbols[4]};
    Expr yx[2] = {w.symbols[4], w.symbols[3]};
    Expr e = expr_add(w.arena, xy[0], expr_mul(w.arena, expr_int(w.arena, 2), xy[1]));

    EXPECT_EXPR(expr_substitute(w.arena, e, xy, yx, 2), "2*x + y");
    EXPECT(expr_substitute(w.arena, e, &w.symbols[0], xy, 1) == e);
    arena_free(w.arena);
}

/* Other names in any order, some of which stand there already, and a symbol that becomes a sum. */
/* symbols as they are, and those that take their places, made in another order */
static void name_symbols(World *w, const char *const own[], const char *const others[], Expr *to)
{
    const int first = pick(w, TEST_SYMBOLS);

    for (int i = 0; i < TEST_SYMBOLS; i++) {
        const int k = (first + 5 * i) % TEST_SYMBOLS;

        to[k] = expr_symbol(w->arena, others[k],
                            k < 3 || k == 4 ? SYMBOL_PARAMETER : SYMBOL_COORDINATE);
    }
    for (int i = 0; i < TEST_SYMBOLS; i++)
        w->symbols[i] =
            expr_symbol(w->arena, own[i], i < 3 || i == 4 ? SYMBOL_PARAMETER : SYMBOL_COORDINATE);
}

/* two renamings of one original in turn, and each asked first now and then */
static void renaming_is_substitution(void)
{
    static const char *const own[TEST_SYMBOLS] = {"p.a", "p.b", "#p.c", "p.x", "q.b", "z"};
    static const char *const others[2][TEST_SYMBOLS] = {{"q.a", "q.b", "#q.c", "q.x", "q.b", "z"},
                                                        {"r.a", "r.b", "#r.c", "r.x", "q.b", "z"}};

    for (uint64_t seed = 1; seed <= 300; seed++) {
        World w = world_new(seed);
        Original *original = original_new(w.arena, "p.");
        Renaming *renamings[2] = {renaming_new(original, "q."), renaming_new(original, "r.")};
        Expr values[2][TEST_SYMBOLS];

        for (int k = 0; k < 2; k++)
            name_symbols(&w, own, others[k], values[k]);
        if (seed % 3 == 0) {
            values[1][5] = expr_sub(w.arena, values[1][0], w.symbols[4]);
            EXPECT(renaming_pair(renamings[1], w.symbols[5], values[1][5]));
            EXPECT(!renaming_pair(renamings[1], w.symbols[5], w.symbols[4]));
        }
        for (int i = 0; i < 8; i++) {
            const Expr e = random_expr(&w, 1 + i / 2, &(double){0});
            const int which = pick(&w, 2);

            for (int k = 0; k < 2; k++) {
                Renaming *renaming = renamings[(which + k) % 2];

                EXPECT(renaming_of(renaming, e) == expr_substitute(w.arena, e, w.symbols,
                                                                   values[(which + k) % 2],
                                                                   TEST_SYMBOLS));
                EXPECT(renaming_of(renaming, e) == renaming_of(renaming, e));
            }
        }
        renaming_free(renamings[0]);
        renaming_free(renamings[1]);
        original_free(original);
        arena_free(w.arena);
    }
}

static void symbols_are_listed_in_their_order(void)
{
    World w = world_new(1);
    Expr e = expr_add(w.arena, w.symbols[5], expr_sin(w.arena, w.symbols[1]));
    Expr *symbols;

    EXPECT(expr_symbols(&e, 1, &symbols) == 2);
    EXPECT(symbols[0] == w.symbols[1] && symbols[1] == w.symbols[5]);
    mem_free(symbols);
    EXPECT(expr_depends(e, w.symbols[5]) && !expr_depends(e, w.symbols[4]));
    EXPECT(expr_kinds(e) == (1U << SYMBOL_PARAMETER | 1U << SYMBOL_COORDINATE));
    arena_free(w.arena);
}

/* a chain of 1e5 levels that doubles as written: e -> sin(e)*e + a */
static void deep_expressions_need_no_stack(void)
{
    World w = world_new(1);
    Expr x = w.symbols[3];
    Expr e = x;
    Expr other;
    OpCount count;

    for (int i = 0; i < 100000; i++)
        e = expr_add(w.arena, expr_mul(w.arena, e, expr_sin(w.arena, e)), w.symbols[0]);
    other = expr_diff(w.arena, e, x);
    EXPECT(expr_depends(other, x));
    count = expr_count(&e, 1);
    EXPECT(count.add == (int64_t)1 << 62 && op_count_total(count) == (int64_t)1 << 62);
    count = expr_count_shared(&e, 1);
    EXPECT(count.add == 100000 && count.mul == 100000 && count.fun == 100000);
    EXPECT(isfinite(value_in(&w, e)));
    other = expr_substitute(w.arena, e, &x, &w.symbols[4], 1);
    EXPECT(other != e);
    EXPECT(expr_open(w.arena, e) == e);
    arena_free(w.arena);
}

static void count_rule(const char *what, Expr e, int add, int mul, int fun)
{
    OpCount count = expr_count(&e, 1);

    EXPECT(count.add == add && count.mul == mul && count.fun == fun);
    if (count.add != add || count.mul != mul || count.fun != fun)
        printf("    %s: %d %d %d\n", what, (int)count.add, (int)count.mul, (int)count.fun);
}

static void counting_follows_the_rule(void)
{
    World w = world_new(1);
    Arena *arena = w.arena;
    Expr a = w.symbols[0];
    Expr b = w.symbols[1];
    Expr x = w.symbols[3];
    Expr minus = expr_neg(arena, x);

    count_rule("a + b + x", expr_sum(arena, (Expr[]){a, b, x}, 3), 2, 0, 0);
    count_rule("a*b*x", expr_product(arena, (Expr[]){a, b, x}, 3), 0, 2, 0);
    count_rule("x^4", expr_pow(arena, x, expr_int(arena, 4)), 0, 3, 0);
    count_rule("-x", minus, 0, 0, 0);
    count_rule("a - x", expr_add(arena, a, minus), 1, 0, 0);
    count_rule("2*x", expr_mul(arena, expr_int(arena, 2), x), 0, 1, 0);
    count_rule("a*sin(x)^2", expr_mul(arena, a, expr_square(arena, expr_sin(arena, x))), 0, 2, 1);
    count_rule("1/x", expr_div(arena, expr_int(arena, 1), x), 0, 1, 0);
    count_rule("a/x", expr_div(arena, a, x), 0, 1, 0);
    count_rule("a/(b*x^2)", expr_div(arena, a, expr_mul(arena, b, expr_square(arena, x))), 0, 3, 0);
    count_rule("1/(a*x)", expr_div(arena, expr_int(arena, 1), expr_mul(arena, a, x)), 0, 2, 0);
    count_rule("-1/x + a", expr_sub(arena, a, expr_div(arena, expr_int(arena, 1), x)), 1, 1, 0);
    count_rule("x^a", expr_pow(arena, x, a), 0, 0, 1);
    count_rule("sin(a*x + b)", expr_sin(arena, expr_add(arena, expr_mul(arena, a, x), b)), 1, 1, 1);
    count_rule("hold(a + b)*x",
               expr_mul(arena, expr_name_temporary(arena, expr_add(arena, a, b)), x), 1, 1, 0);
    arena_free(arena);
}

static void shared_work_counts_once(void)
{
    World w = world_new(1);
    Arena *arena = w.arena;
    Expr p = expr_mul(arena, w.symbols[0], expr_sin(arena, w.symbols[3]));
    Expr inverse = expr_div(arena, expr_int(arena, 1), w.symbols[1]);
    Expr roots[2] = {
        expr_add(arena, expr_neg(arena, p), inverse),
        expr_add(arena, expr_mul(arena, expr_int(arena, 2), p), expr_sin(arena, inverse))};
    OpCount count = expr_count_shared(roots, 2);

    /* -a*sin(x), which is a*sin(x), 2*a*sin(x), 1/b; two sums; two sines */
    EXPECT(count.add == 2 && count.mul == 4 && count.fun == 2);
    arena_free(arena);
}

int main(void)
{
    RUN(every_function_agrees_with_its_difference_quotient);
    RUN(every_function_has_one_to_three_arguments);
    RUN(every_function_computes_what_it_folds_to);
    RUN(every_function_substitutes_into_its_value);
    RUN(derivatives_agree_with_difference_quotients);
    RUN(total_derivative_is_the_sum_of_partial_ones);
    RUN(derivatives_obey_leibniz);
    RUN(substitution_and_derivative_commute);
    RUN(substitution_is_simultaneous);
    RUN(renaming_is_substitution);
    RUN(symbols_are_listed_in_their_order);
    RUN(deep_expressions_need_no_stack);
    RUN(counting_follows_the_rule);
    RUN(shared_work_counts_once);
    return test_end();
}
