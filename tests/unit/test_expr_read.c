/* test_expr_read.c: what is printed as text reads back as the same pointer */
#include "test_expr.h"
#include "test_model.h"

/* the model's arena, and its parameters for symbols */
static World world_of(Model *model, uint64_t seed)
{
    static const char *const names[TEST_SYMBOLS] = {"a", "b", "c", "x", "y", "z"};
    World world = {.arena = model_arena(model), .random = seed, .with_pi = seed % 2 == 0};

    for (int i = 0; i < TEST_SYMBOLS; i++) {
        world.symbols[i] = expr_symbol(world.arena, names[i], SYMBOL_PARAMETER);
        world.values[i] = 1;
    }
    return world;
}

static Expr read_back(const Model *model, const char *text)
{
    Pool *pool = pool_new(0);
    Syntax *syntax = NULL;
    Expr e = NULL;
    Diag diag = {0};

    if (syntax_parse_expression(text, pool, &syntax, &diag) != OK ||
        model_expression(model, syntax, &e, &diag) != OK)
        printf("%s\n    %s\n", text, diag.message);
    pool_free(pool);
    return e;
}

static void expect_same(const Model *model, Expr e)
{
    char *text = expr_text(e);

    EXPECT(read_back(model, text) == e);
    if (read_back(model, text) != e)
        printf("    %s\n", text);
    mem_free(text);
}

/* Some function or power of random expressions, of which most notations have their own form. */
static Expr random_form(World *w, int depth)
{
    double value;
    Expr args[3];

    for (int i = 0; i < 3; i++)
        args[i] = depth > 0 ? random_form(w, depth - 1) : random_expr(w, 1 + i, &value);
    switch (pick(w, 6)) {
    case 0:
        return expr_pow(w->arena, args[0], expr_rational(w->arena, pick(w, 9) - 4, 1 + pick(w, 4)));
    case 1:
        return expr_pow(w->arena, args[0], args[1]);
    case 2:
        return expr_product(w->arena, args, 3);
    case 3:
        return expr_sum(w->arena, args, 3);
    default:
        /* all but hold, which printing looks through */
        return expr_call(w->arena, (Op)pick(w, OP_HOLD), args);
    }
}

static void printed_text_reads_back_as_the_same_pointer(void)
{
    Model *model = model_of("a = 1; b = 1; c = 1; x = 1; y = 1; z = 1");

    for (uint64_t seed = 1; seed <= 500; seed++) {
        World w = world_of(model, seed);
        Expr e = random_form(&w, (int)(seed % 3));

        /* 1/0 and the like have no form */
        if (arena_status(w.arena) == OK)
            expect_same(model, e);
        arena_reset(w.arena);
    }
    model_free(model);
}

static void numbers_read_back_as_the_same_pointer(void)
{
    Model *model = model_of("a = 1");
    Arena *arena = model_arena(model);
    uint64_t random = 3;

    for (int i = 0; i < 1000; i++) {
        double value = test_uniform(&random, -1, 1) * pow(10, (double)(i % 30) - 15);
        int64_t num = (int64_t)(test_random(&random) >> (2 + i % 61));
        int64_t den = 1 + (int64_t)(test_random(&random) >> (2 + i % 59));

        expect_same(model, expr_real(arena, value));
        expect_same(model, expr_mul(arena, expr_rational(arena, num, den),
                                    expr_pi(arena, (int)(test_random(&random) % 9) - 4)));
        expect_same(model, expr_mul(arena, expr_rational(arena, num, den),
                                    expr_symbol(arena, "a", SYMBOL_PARAMETER)));
    }
    model_free(model);
}

int main(void)
{
    RUN(printed_text_reads_back_as_the_same_pointer);
    RUN(numbers_read_back_as_the_same_pointer);
    return test_end();
}
