/* test_expr_fold.c: folding, collecting, multiplying out: the same values, never more work */
#include "test_expr.h"

#define ADD(p, q)    expr_add(w.arena, p, q)
#define SUB(p, q)    expr_sub(w.arena, p, q)
#define MUL(p, q)    expr_mul(w.arena, p, q)
#define SQUARE(p)    expr_square(w.arena, p)
#define SIN(p)       expr_sin(w.arena, p)
#define COS(p)       expr_cos(w.arena, p)
#define INT(k)       expr_int(w.arena, k)
#define PRODUCT(...) product(&w, (Expr[]){__VA_ARGS__, NULL})
#define SUM(...)     sum(&w, (Expr[]){__VA_ARGS__, NULL})

#define BEGIN                                                                                      \
    World w = world_new(1);                                                                        \
    Expr a = w.symbols[0];                                                                         \
    Expr b = w.symbols[1];                                                                         \
    Expr c = w.symbols[2];                                                                         \
    Expr x = w.symbols[3];                                                                         \
    Expr y = w.symbols[4];                                                                         \
    Expr z = w.symbols[5];                                                                         \
    (void)a, (void)b, (void)c, (void)x, (void)y, (void)z
#define END arena_free(w.arena)

static Expr product(World *w, Expr *factors)
{
    int count = 0;

    while (factors[count] != NULL)
        count++;
    return expr_product(w->arena, factors, count);
}

static Expr sum(World *w, Expr *terms)
{
    int count = 0;

    while (terms[count] != NULL)
        count++;
    return expr_sum(w->arena, terms, count);
}

static int64_t work(Expr e)
{
    return op_count_total(expr_count(&e, 1));
}

static void squares_of_sine_and_cosine_are_one(void)
{
    BEGIN;
    Expr s2 = SQUARE(SIN(x));
    Expr c2 = SQUARE(COS(x));

    EXPECT(expr_is(expr_fold(w.arena, ADD(s2, c2)), 1));
    EXPECT(expr_fold(w.arena, SUM(PRODUCT(a, b, s2), y, PRODUCT(a, b, c2))) == ADD(MUL(a, b), y));
    EXPECT(expr_fold(w.arena, SUB(INT(1), s2)) == c2);
    EXPECT(expr_fold(w.arena, SUB(MUL(INT(3), c2), INT(3))) == MUL(INT(-3), s2));
    EXPECT(expr_fold(w.arena, SUB(c2, s2)) == COS(MUL(INT(2), x)));
    EXPECT(expr_fold(w.arena, SUM(MUL(a, s2), MUL(b, c2))) == SUM(MUL(a, s2), MUL(b, c2)));
    /* unlike coefficients leave one square: 3 s2 + 5 c2 = 3 + 2 c2 */
    EXPECT(expr_fold(w.arena, ADD(MUL(INT(3), s2), MUL(INT(5), c2))) ==
           ADD(INT(3), MUL(INT(2), c2)));
    /* the sum is an argument of a sine */
    EXPECT(expr_fold(w.arena, SIN(SUM(MUL(y, s2), MUL(y, c2)))) == SIN(y));
    END;
}

static void products_of_sines_and_cosines_turn_into_one(void)
{
    BEGIN;
    Expr cc = MUL(COS(x), COS(y));
    Expr ss = MUL(SIN(x), SIN(y));
    Expr sc = MUL(SIN(x), COS(y));
    Expr cs = MUL(COS(x), SIN(y));

    EXPECT(expr_fold(w.arena, ADD(cc, ss)) == COS(SUB(x, y)));
    EXPECT(expr_fold(w.arena, SUB(cc, ss)) == COS(ADD(x, y)));
    EXPECT(expr_fold(w.arena, SUB(ss, cc)) == expr_neg(w.arena, COS(ADD(x, y))));
    EXPECT(expr_fold(w.arena, ADD(sc, cs)) == SIN(ADD(x, y)));
    EXPECT(expr_fold(w.arena, SUB(sc, cs)) == SIN(SUB(x, y)));
    EXPECT(expr_fold(w.arena, SUB(cs, sc)) == SIN(SUB(y, x)));
    EXPECT(expr_fold(w.arena, SUM(PRODUCT(a, b, cc), c, PRODUCT(a, b, ss))) ==
           ADD(PRODUCT(a, b, COS(SUB(x, y))), c));
    END;
}

/* (cos x cos y - sin x sin y) cos z - (sin x cos y + cos x sin y) sin z, multiplied out */
static void three_angles_fold_to_one(void)
{
    BEGIN;
    Expr e =
        SUM(PRODUCT(COS(x), COS(y), COS(z)), PRODUCT(INT(-1), SIN(x), SIN(y), COS(z)),
            PRODUCT(INT(-1), SIN(x), COS(y), SIN(z)), PRODUCT(INT(-1), COS(x), SIN(y), SIN(z)));

    EXPECT(expr_fold(w.arena, e) == COS(SUM(x, y, z)));
    END;
}

static void common_factors_are_taken_out(void)
{
    BEGIN;
    Expr z2 = SQUARE(z);

    EXPECT(expr_collect(w.arena, ADD(MUL(a, z2), MUL(b, z2))) == MUL(ADD(a, b), z2));
    EXPECT(expr_collect(w.arena, SUM(PRODUCT(a, b, x), PRODUCT(a, b, y), c)) ==
           ADD(PRODUCT(a, b, ADD(x, y)), c));
    EXPECT(expr_collect(w.arena, SUM(MUL(a, x), MUL(a, y), MUL(b, x), MUL(b, y))) ==
           MUL(ADD(a, b), ADD(x, y)));
    EXPECT(expr_collect(w.arena, SUB(MUL(INT(2), MUL(a, x)), MUL(INT(2), MUL(a, y)))) ==
           PRODUCT(INT(2), a, SUB(x, y)));
    EXPECT(expr_collect(w.arena, SUM(x, y, MUL(a, b))) == SUM(x, y, MUL(a, b)));
    EXPECT(expr_collect(w.arena, SIN(ADD(MUL(a, x), MUL(a, y)))) == SIN(MUL(a, ADD(x, y))));
    END;
}

static void sums_multiply_out_up_to_the_limit(void)
{
    BEGIN;
    Expr e = PRODUCT(ADD(a, b), ADD(x, y));

    EXPECT(expr_expand(w.arena, e, 4) == SUM(MUL(a, x), MUL(a, y), MUL(b, x), MUL(b, y)));
    EXPECT(expr_expand(w.arena, e, 3) == e);
    EXPECT(expr_expand(w.arena, SQUARE(ADD(a, b)), 10) ==
           SUM(SQUARE(a), PRODUCT(INT(2), a, b), SQUARE(b)));
    EXPECT(expr_is_zero(
        expr_expand(w.arena, SUB(PRODUCT(ADD(a, b), SUB(a, b)), SUB(SQUARE(a), SQUARE(b))), 10)));
    EXPECT(expr_expand(w.arena, MUL(INT(2), ADD(a, b)), 10) == ADD(MUL(INT(2), a), MUL(INT(2), b)));
    EXPECT_EXPR(expr_expand(w.arena, expr_div(w.arena, ADD(a, b), ADD(x, y)), 10),
                "a/(x + y) + b/(x + y)");
    END;
}

static void polynomials_of_an_argument_have_coefficients(void)
{
    BEGIN;
    Expr s = expr_symbol(w.arena, "s", SYMBOL_ARGUMENT), out[4];

    EXPECT(expr_powers(w.arena, a, s, out, 4) == 1 && out[0] == a);
    EXPECT(expr_powers(w.arena, MUL(a, SQUARE(ADD(b, MUL(c, s)))), s, out, 4) == 3);
    EXPECT(out[0] == MUL(a, SQUARE(b)) && out[1] == PRODUCT(INT(2), a, b, c));
    EXPECT(out[2] == MUL(a, SQUARE(c)));
    EXPECT(expr_powers(w.arena, SUB(SQUARE(ADD(s, a)), SQUARE(s)), s, out, 4) == 2);
    EXPECT(expr_powers(w.arena, SQUARE(SQUARE(s)), s, out, 4) == 0);
    EXPECT(expr_powers(w.arena, SIN(s), s, out, 4) == 0);
    EXPECT(expr_powers(w.arena, expr_div(w.arena, a, s), s, out, 4) == 0);
    EXPECT(expr_powers(w.arena, SQUARE(SIN(ADD(s, b))), s, out, 4) == 0);
    END;
}

/* Products of sums of sines and cosines: what folds and collects, but multiplied out. */
static Expr random_trig(World *world, double *value)
{
    World w = *world;
    Expr e = INT(0);

    for (int i = 0; i < 4; i++) {
        Expr p = w.symbols[3 + test_random(&w.random) % 3];
        Expr q = w.symbols[3 + test_random(&w.random) % 3];
        Expr r = w.symbols[test_random(&w.random) % 6];
        Expr angle = test_random(&w.random) % 2 ? ADD(p, q) : SUB(p, q);

        /* written in p and q: cos(p +- q) or sin(p +- q) without folding */
        if (test_random(&w.random) % 2)
            angle = expr_add(w.arena, MUL(COS(p), COS(q)),
                             MUL(INT(angle == ADD(p, q) ? -1 : 1), MUL(SIN(p), SIN(q))));
        else
            angle = SUB(MUL(SIN(p), COS(q)), MUL(COS(p), SIN(q)));
        e = ADD(e, PRODUCT(r, angle, ADD(r, expr_rational(w.arena, i, 3))));
    }
    e = expr_expand(w.arena, MUL(e, e), 10000);
    *world = w;
    *value = value_in(&w, e);
    return e;
}

static void rewriting_keeps_values_and_saves_work(void)
{
    for (uint64_t seed = 1; seed <= 300; seed++) {
        World w = world_with_pi(seed);
        double value;
        Expr e = seed % 2 ? random_trig(&w, &value) : random_expr(&w, 5, &value);
        Expr folded = expr_fold(w.arena, e);
        Expr collected = expr_collect(w.arena, e);
        Expr both = expr_collect(w.arena, folded);
        Expr expanded = expr_expand(w.arena, e, 1000);

        value = value_in(&w, e);
        EXPECT_NEAR(value_in(&w, folded), value, 1e-11 * size_of(value));
        EXPECT_NEAR(value_in(&w, collected), value, 1e-11 * size_of(value));
        EXPECT_NEAR(value_in(&w, both), value, 1e-11 * size_of(value));
        EXPECT_NEAR(value_in(&w, expanded), value, 1e-8 * size_of(value));
        EXPECT(work(folded) <= work(e));
        EXPECT(work(collected) <= work(e));
        EXPECT(work(both) <= work(folded));
        EXPECT(seed % 2 == 0 || work(collected) < work(e));
        EXPECT(arena_status(w.arena) == OK);
        arena_free(w.arena);
    }
}

/* sum over i of p_i (cos x_i cos y_i + sin x_i sin y_i) */
static void many_terms_find_their_partners(void)
{
    World w = world_new(1);
    enum { MANY = 3000 };
    Expr *terms = NEW_ARRAY(Expr, 2 * MANY);
    Expr folded;

    for (int i = 0; i < MANY; i++) {
        char name[24];
        Expr p;

        snprintf(name, sizeof name, "p%d", i);
        p = expr_symbol(w.arena, name, SYMBOL_PARAMETER);
        terms[i] = PRODUCT(p, COS(w.symbols[3 + i % 2]), COS(w.symbols[5]));
        terms[MANY + i] = PRODUCT(p, SIN(w.symbols[3 + i % 2]), SIN(w.symbols[5]));
    }
    folded = expr_fold(w.arena, expr_sum(w.arena, terms, 2 * MANY));
    EXPECT(expr_arg_count(folded) == MANY);
    folded = expr_collect(w.arena, folded);
    EXPECT(expr_arg_count(folded) == 2);
    mem_free(terms);
    arena_free(w.arena);
}

int main(void)
{
    RUN(squares_of_sine_and_cosine_are_one);
    RUN(products_of_sines_and_cosines_turn_into_one);
    RUN(three_angles_fold_to_one);
    RUN(common_factors_are_taken_out);
    RUN(sums_multiply_out_up_to_the_limit);
    RUN(polynomials_of_an_argument_have_coefficients);
    RUN(rewriting_keeps_values_and_saves_work);
    RUN(many_terms_find_their_partners);
    return test_end();
}
