/* test_expr.h: what tests of expressions share: symbols, random expressions, values
 *
 * A random expression comes with its value, computed beside it without the builders. */
#ifndef COTREE_TESTS_TEST_EXPR_H
#define COTREE_TESTS_TEST_EXPR_H

#include "base/memory.h"
#include "expr/expr.h"
#include "test.h"

enum { TEST_SYMBOLS = 6 };

typedef struct World {
    Arena *arena;
    Expr symbols[TEST_SYMBOLS];
    double values[TEST_SYMBOLS];
    uint64_t random;
    bool with_pi; /* numbers may be multiples of pi; with others they add up to doubles */
} World;

__attribute__((unused)) static World world_new(uint64_t seed)
{
    static const char *const names[TEST_SYMBOLS] = {"a", "b", "c", "x", "y", "z"};
    World world = {.arena = arena_new(), .random = seed};

    for (int i = 0; i < TEST_SYMBOLS; i++) {
        world.symbols[i] =
            expr_symbol(world.arena, names[i], i < 3 ? SYMBOL_PARAMETER : SYMBOL_COORDINATE);
        world.values[i] = test_uniform(&world.random, 0.3, 1.7);
    }
    return world;
}

/* of every other seed with multiples of pi */
__attribute__((unused)) static World world_with_pi(uint64_t seed)
{
    World world = world_new(seed);

    world.with_pi = seed % 2 == 0;
    return world;
}

__attribute__((unused)) static double world_value(void *context, Expr symbol)
{
    const World *world = context;

    return world->values[expr_symbol_number(symbol)];
}

__attribute__((unused)) static double value_in(World *world, Expr e)
{
    return expr_evaluate(e, world_value, world);
}

static int pick(World *world, int count)
{
    return (int)(test_random(&world->random) % (uint64_t)count);
}

/* An expression of about that depth; functions stay where they are smooth and defined. */
__attribute__((unused)) static Expr random_expr(World *world, int depth, double *value)
{
    Arena *arena = world->arena;
    double u = 0;
    double v = 0;
    Expr a;
    Expr b;
    int i = pick(world, TEST_SYMBOLS);
    int k = 1 + pick(world, 3);

    if (depth == 0 && pick(world, 4) == 0) {
        int den = 1 + pick(world, 6);

        i = pick(world, 19) - 9;
        k = world->with_pi ? k - 2 : 0; /* 1/pi, 1 or pi */
        *value = (double)i / den * pow(M_PI, k);
        return expr_mul(arena, expr_rational(arena, i, den), expr_pi(arena, k));
    }
    if (depth == 0) {
        *value = world->values[i];
        return world->symbols[i];
    }
    a = random_expr(world, depth - 1, &u);
    switch (pick(world, 12)) {
    case 0:
    case 1:
    case 2:
        b = random_expr(world, depth - 1, &v);
        *value = u + v;
        return expr_add(arena, a, b);
    case 3:
    case 4:
        b = random_expr(world, depth - 1, &v);
        *value = u - v;
        return expr_sub(arena, a, b);
    case 5:
    case 6:
    case 7:
        b = random_expr(world, depth - 1, &v);
        *value = u * v;
        return expr_mul(arena, a, b);
    case 8:
        *value = pow(u, k);
        return expr_pow(arena, a, expr_int(arena, k));
    case 9:
        *value = sin(u);
        return expr_sin(arena, a);
    case 10:
        *value = cos(u);
        return expr_cos(arena, a);
    default: /* 1/sqrt(2 + u^2) */
        *value = 1 / sqrt(2 + u * u);
        return expr_pow(arena, expr_add(arena, expr_int(arena, 2), expr_square(arena, a)),
                        expr_rational(arena, -1, 2));
    }
}

__attribute__((unused)) static double size_of(double value)
{
    return fabs(value) > 1 ? fabs(value) : 1;
}

/* EXPECT_TEXT on the text of an expression */
#define EXPECT_EXPR(e, wanted)                                                                     \
    do {                                                                                           \
        char *text_ = expr_text(e);                                                                \
        EXPECT_TEXT(text_, wanted);                                                                \
        mem_free(text_);                                                                           \
    } while (0)

#endif
