/* test_expr_share.c: what a run shares: parts of sums and products, sines of sums of angles */
#include "test_expr.h"

static OpCount cost_of(const Expr *roots, int count)
{
    return expr_count_shared(roots, count);
}

static bool costs(const Expr *roots, int count, int add, int mul, int fun)
{
    OpCount cost = cost_of(roots, count);

    if (cost.add == add && cost.mul == mul && cost.fun == fun)
        return true;
    printf("    %d %d %d\n", (int)cost.add, (int)cost.mul, (int)cost.fun);
    return false;
}

/* a + b, a + b + x, y - a - b */
static void a_sum_is_found_in_longer_sums(void)
{
    World w = world_new(1);
    const Expr *s = w.symbols;
    Expr part = expr_add(w.arena, s[0], s[1]);
    Expr roots[] = {part, expr_add(w.arena, part, s[3]), expr_sub(w.arena, s[4], part)};

    EXPECT(costs(roots, 3, 5, 0, 0));
    expr_share(w.arena, roots, 3);
    EXPECT(costs(roots, 3, 3, 0, 0));
    EXPECT_NEAR(value_in(&w, roots[2]), w.values[4] - w.values[0] - w.values[1], 1e-15);
    arena_free(w.arena);
}

/* a*b*x and a*b*y^2, and what is in neither by itself: (x - y) in a + x - y and b - x + y */
static void parts_that_stand_nowhere_alone_are_found(void)
{
    World w = world_new(1);
    Arena *arena = w.arena;
    const Expr *s = w.symbols;
    Expr roots[] = {
        expr_product(arena, (Expr[]){s[0], s[1], s[3]}, 3),
        expr_product(arena, (Expr[]){s[0], s[1], expr_square(arena, s[4])}, 3),
        expr_sum(arena, (Expr[]){s[0], s[3], expr_neg(arena, s[4])}, 3),
        expr_sum(arena, (Expr[]){s[1], expr_neg(arena, s[3]), s[4]}, 3),
    };

    EXPECT(costs(roots, 4, 4, 5, 0));
    expr_share(arena, roots, 4);
    EXPECT(costs(roots, 4, 3, 4, 0));
    arena_free(arena);
}

/* x^4 is the square of a square, x^2*y^2 that of a product; 2*a*x and 3*a*x have a*x in common */
static void powers_and_multiples_are_taken_apart(void)
{
    World w = world_new(1);
    Arena *arena = w.arena;
    const Expr *s = w.symbols;
    Expr fourth = expr_pow(arena, s[3], expr_int(arena, 4));
    Expr squares = expr_mul(arena, expr_square(arena, s[3]), expr_square(arena, s[4]));
    Expr multiples[] = {expr_product(arena, (Expr[]){expr_int(arena, 2), s[0], s[3]}, 3),
                        expr_product(arena, (Expr[]){expr_int(arena, -3), s[0], s[3]}, 3)};

    expr_share(arena, &fourth, 1);
    EXPECT(costs(&fourth, 1, 0, 2, 0));
    expr_share(arena, &squares, 1);
    EXPECT(costs(&squares, 1, 0, 2, 0));
    expr_share(arena, multiples, 2);
    EXPECT(costs(multiples, 2, 0, 3, 0));
    EXPECT_NEAR(value_in(&w, fourth), pow(w.values[3], 4), 1e-14);
    EXPECT_NEAR(value_in(&w, squares), pow(w.values[3] * w.values[4], 2), 1e-14);
    EXPECT_NEAR(value_in(&w, multiples[1]), -3 * w.values[0] * w.values[3], 1e-14);
    arena_free(arena);
}

static void nothing_in_common_stays_as_it_is(void)
{
    World w = world_new(1);
    const Expr *s = w.symbols;
    Expr root = expr_div(w.arena, expr_add(w.arena, s[0], s[1]), expr_mul(w.arena, s[3], s[4]));
    Expr before = root;

    expr_share(w.arena, &root, 1);
    EXPECT(root == before);
    expr_share(w.arena, &root, 0);
    arena_free(w.arena);
}

/* what sharing may save is open; what it computes isn't, nor that it costs no more */
static void sharing_keeps_values_and_saves_work(void)
{
    for (uint64_t seed = 1; seed <= 400; seed++) {
        World w = world_new(seed);
        Expr roots[4];
        double values[4];
        int64_t before;

        for (int i = 0; i < 4; i++)
            roots[i] = random_expr(&w, 5, &values[i]);
        before = op_count_total(cost_of(roots, 4));
        expr_share(w.arena, roots, 4);
        EXPECT(op_count_total(cost_of(roots, 4)) <= before);
        for (int i = 0; i < 4; i++)
            EXPECT_NEAR(value_in(&w, roots[i]), values[i], 1e-10 * size_of(values[i]));
        EXPECT(arena_status(w.arena) == OK);
        arena_free(w.arena);
    }
}

/* two sums of 20000 terms with every second one in common, and a product below 1e5 levels */
static void long_and_deep_expressions_are_shared_in_time(void)
{
    enum { MANY = 20000 };
    World w = world_new(1);
    Expr *terms[2] = {NEW_ARRAY(Expr, MANY), NEW_ARRAY(Expr, MANY)};
    Expr roots[3];
    int64_t before;

    for (int i = 0; i < MANY; i++) {
        char name[24];

        (void)snprintf(name, sizeof name, "p%d", i);
        terms[0][i] = expr_symbol(w.arena, name, SYMBOL_PARAMETER);
        terms[1][i] = i % 2 == 0 ? terms[0][i] : expr_sin(w.arena, terms[0][i]);
    }
    roots[0] = expr_sum(w.arena, terms[0], MANY);
    roots[1] = expr_sum(w.arena, terms[1], MANY);
    roots[2] = w.symbols[3];
    for (int i = 0; i < 100000; i++)
        roots[2] = expr_add(w.arena, expr_mul(w.arena, roots[2], w.symbols[0]), w.symbols[1]);
    before = cost_of(roots, 3).add;
    expr_share(w.arena, roots, 3);
    EXPECT(cost_of(roots, 3).add < before - MANY / 3);
    mem_free(terms[0]);
    mem_free(terms[1]);
    arena_free(w.arena);
}

/* --- angles --- */

/* sin(2x + y) and cos(2x + y) beside those of x and y */
static void sums_of_angles_take_no_function(void)
{
    World w = world_new(3);
    Arena *arena = w.arena;
    Expr x = w.symbols[3];
    Expr y = w.symbols[4];
    Expr sum = expr_add(arena, expr_mul(arena, expr_int(arena, 2), x), y);
    Expr roots[] = {expr_sin(arena, sum),
                    expr_cos(arena, sum),
                    expr_sin(arena, expr_sub(arena, y, x)),
                    expr_cos(arena, expr_add(arena, x, y)),
                    expr_sin(arena, expr_add(arena, x, y)),
                    expr_sin(arena, x),
                    expr_cos(arena, x),
                    expr_sin(arena, y),
                    expr_cos(arena, y)};
    double a = 2 * w.values[3] + w.values[4];
    int count = COUNT(roots);

    EXPECT(cost_of(roots, count).fun == 9);
    expr_part_angles(arena, roots, &count, 1);
    EXPECT(cost_of(roots, count).fun == 4);
    EXPECT_NEAR(value_in(&w, roots[0]), sin(a), 1e-15);
    EXPECT_NEAR(value_in(&w, roots[1]), cos(a), 1e-15);
    EXPECT_NEAR(value_in(&w, roots[2]), sin(w.values[4] - w.values[3]), 1e-15);
    arena_free(arena);
}

static void parted_angles_keep_values_and_save_functions(void)
{
    for (uint64_t seed = 1; seed <= 200; seed++) {
        World w = world_new(seed);
        Expr roots[12];
        double values[12];
        int halves[2] = {6, 6};
        int64_t before[2];

        for (int i = 0; i < 12; i++) {
            double angle = 0;
            Expr sum = expr_int(w.arena, 0);

            for (int k = 0; k < 2; k++) {
                int c = (int)(test_random(&w.random) % 5) - 2;

                sum = expr_add(w.arena, sum, expr_mul(w.arena, expr_int(w.arena, c), w.symbols[k]));
                angle += c * w.values[k];
            }
            roots[i] = i % 2 == 0 ? expr_sin(w.arena, sum) : expr_cos(w.arena, sum);
            values[i] = i % 2 == 0 ? sin(angle) : cos(angle);
        }
        for (int h = 0; h < 2; h++)
            before[h] = cost_of(roots + 6 * h, 6).fun;
        expr_part_angles(w.arena, roots, halves, 2);
        for (int h = 0; h < 2; h++)
            EXPECT(cost_of(roots + 6 * h, 6).fun <= before[h]);
        for (int i = 0; i < 12; i++)
            EXPECT_NEAR(value_in(&w, roots[i]), values[i], 1e-14);
        arena_free(w.arena);
    }
}

static void a_function_stays_where_its_parts_are_not_all_there(void)
{
    World w = world_new(3);
    Arena *arena = w.arena;
    Expr x = w.symbols[3];
    Expr y = w.symbols[4];
    Expr sum = expr_sin(arena, expr_add(arena, x, y));
    Expr roots[] = {sum, expr_sin(arena, x), expr_cos(arena, x), expr_sin(arena, y),
                    expr_cos(arena, y)};
    int without_cosine = 4;
    int apart[] = {1, 4};
    int together[] = {5};

    expr_part_angles(arena, roots, &without_cosine, 1);
    EXPECT(roots[0] == sum);
    /* the first group is one root alone: four functions for one were a loss */
    expr_part_angles(arena, roots, apart, 2);
    EXPECT(roots[0] == sum);
    expr_part_angles(arena, roots, together, 1);
    EXPECT(roots[0] != sum);
    arena_free(arena);
}

/* who is asked whether to stop: from question `from` on the answer is yes */
typedef struct Asked {
    int questions, from;
} Asked;

static bool says_stop(void *context)
{
    Asked *asked = context;

    return ++asked->questions >= asked->from;
}

/* a hundred thousand nodes: a search that only looks whether to stop between two counts would be
 * deaf all the while */
static void a_long_count_can_be_stopped_anywhere(void)
{
    World w = world_new(1);
    Expr e = w.symbols[0];
    OpCount count = {.add = -1};
    int all;

    for (int i = 0; i < 50000; i++)
        e = expr_add(w.arena, expr_mul(w.arena, e, w.symbols[1]), w.symbols[2]);
    {
        Asked asked = {.from = 1 << 30};
        const CallMonitor watch = {.context = &asked, .stop = says_stop};

        EXPECT(expr_count_watched(&e, 1, &watch, &count) == OK);
        EXPECT(count.add == 50000 && count.mul == 50000);
        all = asked.questions;
        EXPECT(all >= 20);
    }
    for (int from = 1; from <= all; from++) {
        Asked asked = {.from = from};
        const CallMonitor watch = {.context = &asked, .stop = says_stop};

        count.add = -1;
        EXPECT(expr_count_watched(&e, 1, &watch, &count) == E_STOPPED);
        EXPECT(asked.questions == from); /* and nobody is asked again */
        EXPECT(count.add == -1);
    }
    arena_free(w.arena);
}

int main(void)
{
    RUN(a_long_count_can_be_stopped_anywhere);
    RUN(a_sum_is_found_in_longer_sums);
    RUN(parts_that_stand_nowhere_alone_are_found);
    RUN(powers_and_multiples_are_taken_apart);
    RUN(nothing_in_common_stays_as_it_is);
    RUN(sharing_keeps_values_and_saves_work);
    RUN(long_and_deep_expressions_are_shared_in_time);
    RUN(sums_of_angles_take_no_function);
    RUN(parted_angles_keep_values_and_save_functions);
    RUN(a_function_stays_where_its_parts_are_not_all_there);
    return test_end();
}
