/* test_lowered.c: programs of expressions most of which were compiled before, held against values
 * of the expressions themselves, to the last bit */
#include "compile/residual.h"

#include "base/memory.h"

#include "test.h"

enum { SYMBOLS = 12, PARAMETERS = 6, NODES = 4000, ROOTS = 400, ROUNDS = 12 };

typedef struct Draw {
    Arena *arena;
    Expr inputs[SYMBOLS]; /* in an order of each round's own */
    Expr parameters[PARAMETERS];
    double values[SYMBOLS], given[PARAMETERS];
    LIST(Expr) nodes;
} Draw;

/* stays between -2 and 2 */
static Expr bounded(Arena *arena, Expr a, Expr b, int what)
{
    const Expr one = expr_int(arena, 1);

    switch (what) {
    case 0:
        return expr_call1(arena, OP_SIN, expr_add(arena, a, b));
    case 1:
        return expr_mul(arena, expr_cos(arena, a), expr_call1(arena, OP_SIN, b));
    case 2:
        return expr_call1(arena, OP_ATAN, expr_sub(arena, a, expr_mul(arena, b, b)));
    case 3:
        return expr_cos(arena, expr_sub(arena, expr_mul(arena, a, b), a));
    default:
        return expr_div(arena, expr_neg(arena, b),
                        expr_add(arena, one, expr_pow(arena, a, expr_int(arena, 2))));
    }
}

static void draw_open(Draw *d, uint64_t *seed)
{
    char name[16];

    *d = (Draw){.arena = arena_new()};
    for (int i = 0; i < SYMBOLS; i++) {
        (void)snprintf(name, sizeof name, "w%d", i);
        d->inputs[i] = expr_symbol(d->arena, name, i % 2 == 0 ? SYMBOL_COORDINATE : SYMBOL_SPEED);
        d->values[i] = test_uniform(seed, -1, 1);
        LIST_PUSH(d->nodes, d->inputs[i]);
    }
    for (int i = 0; i < PARAMETERS; i++) {
        (void)snprintf(name, sizeof name, "p%d", i);
        d->parameters[i] = expr_symbol(d->arena, name, SYMBOL_PARAMETER);
        d->given[i] = test_uniform(seed, -1, 1);
        LIST_PUSH(d->nodes, d->parameters[i]);
    }
}

static void draw_nodes(Draw *d, int count, uint64_t *seed)
{
    for (int i = 0; i < count; i++) {
        const uint64_t there = (uint64_t)d->nodes.count;
        const Expr a = d->nodes.at[test_random(seed) % there];
        const Expr b = d->nodes.at[test_random(seed) % there];

        LIST_PUSH(d->nodes, bounded(d->arena, a, b, (int)(test_random(seed) % 5)));
    }
}

static void shuffle(Draw *d, uint64_t *seed)
{
    for (int i = SYMBOLS - 1; i > 0; i--) {
        const int k = (int)(test_random(seed) % (uint64_t)(i + 1));
        const Expr symbol = d->inputs[i];
        const double value = d->values[i];

        d->inputs[i] = d->inputs[k];
        d->values[i] = d->values[k];
        d->inputs[k] = symbol;
        d->values[k] = value;
    }
}

static double value_in(void *context, Expr symbol)
{
    const Draw *d = context;

    for (int i = 0; i < SYMBOLS; i++)
        if (d->inputs[i] == symbol)
            return d->values[i];
    for (int i = 0; i < PARAMETERS; i++)
        if (d->parameters[i] == symbol)
            return d->given[i];
    return NAN;
}

/* of the last nodes most, of others some; operations */
static int compile_and_compare(Draw *d, uint64_t *seed)
{
    Expr roots[ROOTS];
    const ResidualOrder order = {.arena = d->arena,
                                 .roots = roots,
                                 .root_count = ROOTS,
                                 .inputs = d->inputs,
                                 .input_count = SYMBOLS};
    Residual *r = NULL;
    Program *alone = NULL;
    Workspace *workspace;
    Expr inputs[SYMBOLS + PARAMETERS];
    int count, operations = 0;
    const Expr *own;

    for (int i = 0; i < ROOTS; i++)
        roots[i] =
            d->nodes.at[d->nodes.count - 1 -
                        (int)(test_random(seed) % (uint64_t)(i % 4 == 0 ? d->nodes.count : ROOTS))];
    EXPECT(residual_new(&order, &r, NULL) == OK);
    own = residual_parameters(r, &count);
    workspace = workspace_new(residual_program(r));
    memcpy(workspace_inputs(workspace), d->values, sizeof d->values);
    memcpy(inputs, d->inputs, sizeof d->inputs);
    for (int i = 0; i < count; i++) {
        workspace_inputs(workspace)[SYMBOLS + i] = value_in(d, own[i]);
        inputs[SYMBOLS + i] = own[i];
        EXPECT(i == 0 || expr_symbol_number(own[i - 1]) < expr_symbol_number(own[i]));
    }
    workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
    for (int i = 0; i < ROOTS; i++)
        EXPECT(workspace_roots(workspace)[i] == expr_evaluate(roots[i], value_in, d));

    /* no operation more than those of its own */
    EXPECT(program_new(roots, ROOTS, inputs, SYMBOLS + count, &alone, NULL) == OK);
    for (Stage stage = 0; stage < STAGE_COUNT; stage++) {
        EXPECT(program_operations(residual_program(r), stage) == program_operations(alone, stage));
        operations += program_operations(alone, stage);
    }
    program_free(alone);
    workspace_free(workspace);
    residual_free(r);
    return operations;
}

static void what_was_lowered_before_computes_the_same_bits(void)
{
    uint64_t seed = 11;
    Draw d;

    draw_open(&d, &seed);
    draw_nodes(&d, NODES, &seed);
    for (int k = 0; k < ROUNDS; k++) {
        EXPECT(compile_and_compare(&d, &seed) > 2000);
        draw_nodes(&d, 40, &seed);
        shuffle(&d, &seed);
    }
    LIST_FREE(d.nodes);
    arena_free(d.arena);
}

/* other expressions have the creation numbers of those that are gone */
static void what_is_released_is_lowered_anew(void)
{
    uint64_t seed = 12;
    Draw d;

    draw_open(&d, &seed);
    draw_nodes(&d, NODES, &seed);
    for (int k = 0; k < ROUNDS; k++) {
        const int kept = d.nodes.count;
        ArenaMark *mark = arena_mark(d.arena);

        draw_nodes(&d, ROOTS + 20 * k, &seed);
        EXPECT(compile_and_compare(&d, &seed) > 2000);
        d.nodes.count = kept;
        arena_release(d.arena, mark);
        if (k % 3 == 0)
            (void)compile_and_compare(&d, &seed);
    }
    LIST_FREE(d.nodes);
    arena_free(d.arena);
}

static void a_symbol_without_a_value_is_named_by_those_that_need_it(void)
{
    uint64_t seed = 13;
    Draw d;
    Residual *r = NULL;
    Expr *roots;
    Diag diag = {0};

    draw_open(&d, &seed);
    draw_nodes(&d, NODES, &seed);
    roots = d.nodes.at + SYMBOLS + PARAMETERS;

    ResidualOrder order = {.arena = d.arena,
                           .roots = roots,
                           .root_count = NODES,
                           .inputs = d.inputs,
                           .input_count = SYMBOLS};

    EXPECT(residual_new(&order, &r, NULL) == OK);
    residual_free(r);
    /* what is kept knows the last symbol; what follows needs it or doesn't */
    order.input_count = SYMBOLS - 1;
    EXPECT(residual_new(&order, &r, &diag) == E_NAME);
    EXPECT_TEXT(diag.message, "w11 has no value here");
    for (int i = 0; i < NODES; i++)
        roots[i] = expr_add(d.arena, d.inputs[i % (SYMBOLS - 1)], expr_int(d.arena, i));
    EXPECT(residual_new(&order, &r, NULL) == OK);
    residual_free(r);
    LIST_FREE(d.nodes);
    arena_free(d.arena);
}

int main(void)
{
    RUN(what_was_lowered_before_computes_the_same_bits);
    RUN(what_is_released_is_lowered_anew);
    RUN(a_symbol_without_a_value_is_named_by_those_that_need_it);
    return test_end();
}
