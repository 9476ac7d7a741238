/* test_program.c: programs give the bits that expr_evaluate() gives, stage by stage */
#include "compile/program.h"

#include "base/memory.h"

#include "test.h"

enum { SYMBOLS = 10, NODES = 250, ROOTS = 30, DAGS = 300 };

static const SymbolKind input_kinds[SYMBOLS] = {
    SYMBOL_PARAMETER, SYMBOL_PARAMETER, SYMBOL_TIME,      SYMBOL_COORDINATE,   SYMBOL_COORDINATE,
    SYMBOL_SPEED,     SYMBOL_STATE,     SYMBOL_ALGEBRAIC, SYMBOL_ACCELERATION, SYMBOL_MULTIPLIER};

static const int op_counts[] = {
#define OP(id, name, args, ...) args,
#include "expr/ops.def"
#undef OP
};

/* --- random expressions over all of the table --- */

typedef struct Dag {
    Arena *arena;
    Expr inputs[SYMBOLS];
    Expr roots[ROOTS];
    double values[SYMBOLS];
} Dag;

static Expr pick(const Expr *nodes, int count, uint64_t *seed)
{
    /* rather recent ones, so that it gets deep */
    int back = (int)(test_random(seed) % (uint64_t)(test_random(seed) % 2 == 0 ? 12 : count));

    return nodes[back < count ? count - 1 - back : 0];
}

static Expr make_node(Arena *arena, const Expr *nodes, int count, uint64_t *seed)
{
    int what = (int)(test_random(seed) % (7 + OP_COUNT));
    Expr args[4];

    for (int i = 0; i < 4; i++)
        args[i] = pick(nodes, count, seed);
    switch (what) {
    case 0:
    case 1:
        return expr_sum(arena, args, 2 + (int)(test_random(seed) % 3));
    case 2:
    case 3:
        return expr_product(arena, args, 2 + (int)(test_random(seed) % 3));
    case 4:
        return expr_sub(arena, args[0], expr_mul(arena, args[1], args[2]));
    case 5:
        return expr_pow(arena, args[0], expr_int(arena, (int)(test_random(seed) % 9) - 4));
    case 6:
        return expr_pow(arena, expr_call1(arena, OP_ABS, args[0]),
                        expr_real(arena, test_uniform(seed, -2, 2)));
    default:
        return expr_call(arena, what - 7 == OP_TABLE ? OP_SIN : (Op)(what - 7), args);
    }
}

static void make_dag(Dag *dag, uint64_t *seed)
{
    Expr nodes[SYMBOLS + NODES];
    int count = 0;
    char name[16];

    dag->arena = arena_new();
    for (int i = 0; i < SYMBOLS; i++) {
        (void)snprintf(name, sizeof name, "s%d", i);
        dag->inputs[i] = nodes[count++] = expr_symbol(dag->arena, name, input_kinds[i]);
        dag->values[i] = test_uniform(seed, -2, 2);
    }
    nodes[count++] = expr_int(dag->arena, -3);
    nodes[count++] = expr_rational(dag->arena, 2, 7);
    while (count < SYMBOLS + NODES) {
        Expr node = make_node(dag->arena, nodes, count, seed);

        /* a division by zero leaves a harmless node */
        arena_reset(dag->arena);
        nodes[count++] = node;
    }
    for (int i = 0; i < ROOTS; i++)
        dag->roots[i] = nodes[i < ROOTS / 2 ? count - 1 - i : (int)(test_random(seed) % NODES)];
}

static double value_in(void *context, Expr symbol)
{
    const Dag *dag = context;

    for (int i = 0; i < SYMBOLS; i++) {
        if (dag->inputs[i] == symbol)
            return dag->values[i];
    }
    return NAN;
}

/* the same bits; any NaN is as good as another */
static bool is_same(double a, double b)
{
    uint64_t bits_a;
    uint64_t bits_b;

    memcpy(&bits_a, &a, sizeof a);
    memcpy(&bits_b, &b, sizeof b);
    return bits_a == bits_b || (isnan(a) && isnan(b));
}

static Program *compile(const Expr *roots, int root_count, const Expr *inputs, int input_count)
{
    Program *program = NULL;
    Diag diag = {0};

    EXPECT(program_new(roots, root_count, inputs, input_count, &program, &diag) == OK);
    EXPECT_TEXT(diag.message, "");
    return program;
}

/* --- claims --- */

static void results_have_the_bits_of_each_node_alone(void)
{
    uint64_t seed = 71;
    int finite = 0;

    for (int d = 0; d < DAGS; d++) {
        Dag dag;

        make_dag(&dag, &seed);
        Program *program = compile(dag.roots, ROOTS, dag.inputs, SYMBOLS);
        Workspace *workspace = workspace_new(program);

        for (int point = 0; point < 3; point++) {
            for (int i = 0; i < SYMBOLS; i++)
                workspace_inputs(workspace)[i] = dag.values[i] = test_uniform(&seed, -2, 2);
            workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
            for (int i = 0; i < ROOTS; i++) {
                double wanted = expr_evaluate(dag.roots[i], value_in, &dag);

                EXPECT(is_same(workspace_roots(workspace)[i], wanted));
                finite += isfinite(wanted) != 0;
            }
        }
        workspace_free(workspace);
        program_free(program);
        arena_free(dag.arena);
    }
    /* most of what was compared is a number */
    EXPECT(finite > DAGS * 3 * ROOTS / 2);
}

static void later_stages_are_enough_when_earlier_inputs_stay(void)
{
    uint64_t seed = 72;

    for (int d = 0; d < DAGS; d++) {
        Dag dag;

        make_dag(&dag, &seed);
        Program *program = compile(dag.roots, ROOTS, dag.inputs, SYMBOLS);
        Workspace *workspace = workspace_new(program);
        Workspace *whole = workspace_new(program);

        memcpy(workspace_inputs(workspace), dag.values, sizeof dag.values);
        workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
        for (int i = 0; i < SYMBOLS; i++) {
            dag.values[i] += 0.25;
            workspace_inputs(workspace)[i] = dag.values[i];
            workspace_run(workspace, stage_of_symbol(input_kinds[i]), STAGE_ACCELERATION);
            memcpy(workspace_inputs(whole), dag.values, sizeof dag.values);
            workspace_run(whole, STAGE_PARAMETER, STAGE_ACCELERATION);
            for (int k = 0; k < ROOTS; k++)
                EXPECT(is_same(workspace_roots(workspace)[k], workspace_roots(whole)[k]));
        }
        workspace_free(workspace);
        workspace_free(whole);
        program_free(program);
        arena_free(dag.arena);
    }
}

static void a_root_is_current_after_its_own_stage(void)
{
    Arena *arena = arena_new();
    Expr q = expr_symbol(arena, "q", SYMBOL_COORDINATE);
    Expr u = expr_symbol(arena, "u", SYMBOL_SPEED);
    Expr inputs[] = {u, q};
    Expr roots[] = {expr_mul(arena, u, expr_sin(arena, q)), expr_square(arena, q)};
    Program *program = compile(roots, 2, inputs, 2);
    Workspace *workspace = workspace_new(program);

    EXPECT(stage_of(roots[0]) == STAGE_VELOCITY && stage_of(roots[1]) == STAGE_POSITION);
    workspace_inputs(workspace)[0] = 5;
    workspace_inputs(workspace)[1] = 3;
    workspace_run(workspace, STAGE_PARAMETER, STAGE_POSITION);
    EXPECT(workspace_roots(workspace)[0] == 0);
    EXPECT(workspace_roots(workspace)[1] == 9);
    workspace_run(workspace, STAGE_VELOCITY, STAGE_VELOCITY);
    EXPECT_NEAR(workspace_roots(workspace)[0], 5 * sin(3), 0);
    workspace_free(workspace);
    program_free(program);
    arena_free(arena);
}

static void stages_hold_what_depends_on_their_inputs_and_no_more(void)
{
    Arena *arena = arena_new();
    Expr p = expr_symbol(arena, "p", SYMBOL_PARAMETER);
    Expr t = expr_symbol(arena, "t", SYMBOL_TIME);
    Expr q = expr_symbol(arena, "q", SYMBOL_COORDINATE);
    Expr inputs[] = {p, t, q};
    /* sqrt(p)*sin(t)*q: one function for the parameter, one and a product for the time */
    Expr product = expr_mul(arena, expr_mul(arena, expr_sqrt(arena, p), expr_sin(arena, t)),
                            expr_square(arena, q));
    Program *program = compile(&product, 1, inputs, 3);

    EXPECT(stage_of(expr_int(arena, 3)) == STAGE_PARAMETER);
    EXPECT(stage_of(product) == STAGE_POSITION);
    EXPECT(program_operations(program, STAGE_PARAMETER) == 1);
    EXPECT(program_operations(program, STAGE_TIME) >= 1);
    EXPECT(program_operations(program, STAGE_POSITION) >= 1);
    EXPECT(program_operations(program, STAGE_VELOCITY) == 0);
    EXPECT(program_operations(program, STAGE_NETWORK) == 0);
    EXPECT(program_operations(program, STAGE_ACCELERATION) == 0);
    program_free(program);

    /* what no root needs isn't there */
    program = compile(&t, 1, inputs, 3);
    for (int stage = 0; stage < STAGE_COUNT; stage++)
        EXPECT(program_operations(program, (Stage)stage) == 0);
    program_free(program);
    arena_free(arena);
}

static void roots_may_be_inputs_constants_and_the_same(void)
{
    Arena *arena = arena_new();
    Expr q = expr_symbol(arena, "q", SYMBOL_COORDINATE);
    Expr u = expr_symbol(arena, "u", SYMBOL_SPEED);
    Expr inputs[] = {q, u};
    Expr roots[] = {u,
                    expr_rational(arena, -1, 4),
                    q,
                    u,
                    expr_neg(arena, q),
                    expr_int(arena, 0),
                    expr_name_temporary(arena, expr_add(arena, q, u))};
    static const double wanted[] = {7, -0.25, 2, 7, -2, 0, 9};
    Program *program = compile(roots, COUNT(roots), inputs, 2);
    Workspace *workspace = workspace_new(program);

    EXPECT(program_root_count(program) == COUNT(roots));
    EXPECT(program_input_count(program) == 2);
    workspace_inputs(workspace)[0] = 2;
    workspace_inputs(workspace)[1] = 7;
    workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
    for (int i = 0; i < COUNT(roots); i++)
        EXPECT(workspace_roots(workspace)[i] == wanted[i]);
    workspace_free(workspace);
    program_free(program);

    program = compile(NULL, 0, NULL, 0);
    workspace = workspace_new(program);
    workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
    workspace_free(workspace);
    program_free(program);
    arena_free(arena);
}

static void symbol_without_a_value_is_named(void)
{
    Arena *arena = arena_new();
    Expr q = expr_symbol(arena, "q", SYMBOL_COORDINATE);
    Expr mass = expr_symbol(arena, "mass", SYMBOL_PARAMETER);
    Expr root = expr_sin(arena, expr_mul(arena, mass, q));
    Program *program = NULL;
    Diag diag = {0};

    EXPECT(program_new(&root, 1, &q, 1, &program, &diag) == E_NAME);
    EXPECT(program == NULL);
    EXPECT(diag.status == E_NAME);
    EXPECT_TEXT(diag.message, "mass has no value here");
    EXPECT_TEXT(diag.hint, "it is needed and is none of the inputs");
    EXPECT(program_new(&root, 1, &q, 1, &program, NULL) == E_NAME);
    arena_free(arena);
}

/* NaN of the side that isn't taken stays there */
static void choice_keeps_the_other_side_out(void)
{
    Arena *arena = arena_new();
    Expr x = expr_symbol(arena, "x", SYMBOL_STATE);
    Expr zero = expr_int(arena, 0);
    Expr root = expr_if(arena, expr_call2(arena, OP_LT, x, zero), expr_square(arena, x),
                        expr_add(arena, expr_sqrt(arena, x), expr_call1(arena, OP_LOG, x)));
    Program *program = compile(&root, 1, &x, 1);
    Workspace *workspace = workspace_new(program);

    workspace_inputs(workspace)[0] = -3;
    workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
    EXPECT(workspace_roots(workspace)[0] == 9);
    workspace_inputs(workspace)[0] = 1;
    workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
    EXPECT(workspace_roots(workspace)[0] == 1);
    /* and NaN travels */
    workspace_inputs(workspace)[0] = NAN;
    workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
    EXPECT(isnan(workspace_roots(workspace)[0]));
    workspace_free(workspace);
    program_free(program);
    arena_free(arena);
}

static void two_workspaces_of_a_program_do_not_meet(void)
{
    Arena *arena = arena_new();
    Expr x = expr_symbol(arena, "x", SYMBOL_STATE);
    Expr root = expr_square(arena, x);
    Program *program = compile(&root, 1, &x, 1);

    arena_free(arena);
    Workspace *one = workspace_new(program);
    Workspace *two = workspace_new(program);
    workspace_inputs(one)[0] = 2;
    workspace_inputs(two)[0] = 3;
    workspace_run(one, STAGE_PARAMETER, STAGE_ACCELERATION);
    workspace_run(two, STAGE_PARAMETER, STAGE_ACCELERATION);
    EXPECT(workspace_roots(one)[0] == 4);
    EXPECT(workspace_roots(two)[0] == 9);
    workspace_free(one);
    workspace_free(two);
    program_free(program);
}

/* x(k+1) = sin(x(k)) + a, a hundred thousand times */
static void deep_expressions_need_no_deep_stack(void)
{
    enum { DEPTH = 100000 };
    Arena *arena = arena_new();
    Expr a = expr_symbol(arena, "a", SYMBOL_PARAMETER);
    Expr x = a;
    double wanted = 0.5;

    for (int i = 0; i < DEPTH; i++) {
        x = expr_add(arena, expr_sin(arena, x), a);
        wanted = sin(wanted) + 0.5;
    }
    Program *program = compile(&x, 1, &a, 1);
    Workspace *workspace = workspace_new(program);

    workspace_inputs(workspace)[0] = 0.5;
    workspace_run(workspace, STAGE_PARAMETER, STAGE_PARAMETER);
    EXPECT_NEAR(workspace_roots(workspace)[0], wanted, 1e-12);
    EXPECT(program_operations(program, STAGE_PARAMETER) == 2 * DEPTH);
    workspace_free(workspace);
    program_free(program);
    arena_free(arena);
}

static bool counts(const Expr *roots, int count, const Expr *inputs, int input_count,
                   OpCount wanted)
{
    Program *program = compile(roots, count, inputs, input_count);
    OpCount got = program_count(program);

    program_free(program);
    return got.add == wanted.add && got.mul == wanted.mul && got.fun == wanted.fun;
}

static void operations_count_by_the_rule(void)
{
    Arena *arena = arena_new();
    Expr x = expr_symbol(arena, "x", SYMBOL_COORDINATE);
    Expr y = expr_symbol(arena, "y", SYMBOL_COORDINATE);
    Expr inputs[] = {x, y};
    Expr two = expr_int(arena, 2);
    Expr a = expr_sub(arena, expr_mul(arena, x, y), expr_mul(arena, two, y)); /* x*y - 2*y */
    Expr b = expr_pow(arena, x, expr_int(arena, 4));
    Expr c = expr_neg(arena, expr_mul(arena, x, y));
    Expr d = expr_div(arena, expr_int(arena, 1), x);
    Expr pair[] = {expr_sin(arena, x), expr_cos(arena, x)};
    Expr e = expr_if(arena, expr_call2(arena, OP_LT, x, y), x, y);

    EXPECT(counts(&a, 1, inputs, 2, (OpCount){1, 2, 0}));
    EXPECT(counts(&b, 1, inputs, 2, (OpCount){0, 3, 0}));
    EXPECT(counts(&c, 1, inputs, 2, (OpCount){0, 1, 0}));
    EXPECT(counts(&d, 1, inputs, 2, (OpCount){0, 1, 0}));
    EXPECT(counts(pair, 2, inputs, 2, (OpCount){0, 0, 2}));
    EXPECT(counts(&e, 1, inputs, 2, (OpCount){0, 0, 2}));
    arena_free(arena);
}

static void sine_and_cosine_are_one_instruction(void)
{
    Arena *arena = arena_new();
    Expr x = expr_symbol(arena, "x", SYMBOL_COORDINATE);
    Expr y = expr_symbol(arena, "y", SYMBOL_COORDINATE);
    Expr inputs[] = {x, y};
    Expr roots[] = {expr_cos(arena, x), expr_cos(arena, y), expr_sin(arena, x)};
    Program *program = compile(roots, 3, inputs, 2);

    EXPECT(program_operations(program, STAGE_POSITION) == 2);
    program_free(program);
    arena_free(arena);
}

static void printing_names_operands(void)
{
    Arena *arena = arena_new();
    Expr x = expr_symbol(arena, "x", SYMBOL_COORDINATE);
    Expr y = expr_symbol(arena, "y", SYMBOL_COORDINATE);
    Expr inputs[] = {x, y};
    Expr root = expr_sub(arena, expr_call2(arena, OP_ATAN2, y, x),
                         expr_mul(arena, expr_real(arena, 0.1), x));
    Program *program = compile(&root, 1, inputs, 2);
    Text text = {0};

    program_print(&text, program);
    EXPECT_TEXT(text.at, "v0 = atan2(y, x)\nv1 = v0 - x * 0.1\n");
    text_free(&text);
    program_free(program);

    Expr pair[] = {expr_sin(arena, y), expr_cos(arena, y)};
    program = compile(pair, 2, inputs, 2);
    program_print(&text, program);
    EXPECT_TEXT(text.at, "v0, v1 = sincos(y)\n");
    text_free(&text);
    program_free(program);
    arena_free(arena);
}

/* every row of the table, alone, where it is defined and where it isn't */
static void each_function_gives_its_value(void)
{
    static const double points[] = {-2.5, -1, -0.25, 0, 0.25, 1, 3};

    for (int op = 0; op < OP_COUNT; op++) {
        if (op == OP_TABLE) /* takes data: test_table.c */
            continue;

        Dag dag = {.arena = arena_new()};

        for (int i = 0; i < 3; i++) {
            char name[] = {(char)('a' + i), '\0'};

            dag.inputs[i] = expr_symbol(dag.arena, name, SYMBOL_STATE);
        }
        dag.roots[0] = expr_call(dag.arena, (Op)op, dag.inputs);
        Program *program = compile(dag.roots, 1, dag.inputs, 3);
        Workspace *workspace = workspace_new(program);

        EXPECT(expr_arg_count(dag.roots[0]) == (op == OP_HOLD ? 0 : op_counts[op]));
        for (int k = 0; k < COUNT(points) * COUNT(points); k++) {
            dag.values[0] = points[k % COUNT(points)];
            dag.values[1] = points[k / COUNT(points)];
            dag.values[2] = 0.5;
            memcpy(workspace_inputs(workspace), dag.values, 3 * sizeof(double));
            workspace_run(workspace, STAGE_VELOCITY, STAGE_VELOCITY);
            EXPECT(is_same(workspace_roots(workspace)[0],
                           expr_evaluate(dag.roots[0], value_in, &dag)));
        }
        workspace_free(workspace);
        program_free(program);
        arena_free(dag.arena);
    }
}

static void freeing_nothing_is_fine(void)
{
    program_free(NULL);
    workspace_free(NULL);
}

int main(void)
{
    RUN(results_have_the_bits_of_each_node_alone);
    RUN(later_stages_are_enough_when_earlier_inputs_stay);
    RUN(a_root_is_current_after_its_own_stage);
    RUN(stages_hold_what_depends_on_their_inputs_and_no_more);
    RUN(roots_may_be_inputs_constants_and_the_same);
    RUN(symbol_without_a_value_is_named);
    RUN(choice_keeps_the_other_side_out);
    RUN(two_workspaces_of_a_program_do_not_meet);
    RUN(deep_expressions_need_no_deep_stack);
    RUN(operations_count_by_the_rule);
    RUN(sine_and_cosine_are_one_instruction);
    RUN(printing_names_operands);
    RUN(each_function_gives_its_value);
    RUN(freeing_nothing_is_fine);
    return test_end();
}
