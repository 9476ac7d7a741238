/* bench_program.c: one evaluation of the accelerations of planar chains
 *
 * N links of lengths L, masses m at the tips, absolute angles th with rates w, gravity g:
 *
 *   M(i,j) = mu(max(i,j)) L(i) L(j) cos(th(i) - th(j)),   mu(k) = m(k) + .. + m(N)
 *   f(i)   = -sum_j mu(max(i,j)) L(i) L(j) sin(th(i) - th(j)) w(j)^2 - mu(i) g L(i) cos(th(i))
 *
 * then M = R R^T and two solutions, all by recurrences over held definitions, as a
 * formulation would emit them. The baseline evaluates the same nodes by a switch each. Native rows
 * are of what moves, as eval_moving, and a chain where several are evaluated at once. */
#include "compile/native.h"
#include "compile/program_impl.h"

#include "base/memory.h"

#include "bench.h"

#include <math.h>

enum { MOST_LINKS = 40 };

typedef struct OrientationClass {
    Arena *arena;
    int links;
    Expr inputs[4 * MOST_LINKS + 1]; /* th, w, m, L of each, then g */
    int input_count;
    Expr accelerations[MOST_LINKS];
    Expr mu[MOST_LINKS];
    Expr sines[MOST_LINKS];
    Expr cosines[MOST_LINKS];
    Expr mass[MOST_LINKS][MOST_LINKS];
    Expr force[MOST_LINKS];
} OrientationClass;

static Expr symbol(OrientationClass *chain, const char *name, int i, SymbolKind kind)
{
    char text[24];

    (void)snprintf(text, sizeof text, "%s%d", name, i);
    return chain->inputs[chain->input_count++] = expr_symbol(chain->arena, text, kind);
}

static Expr held_product(OrientationClass *chain, Expr a, Expr b)
{
    return expr_name_temporary(chain->arena, expr_mul(chain->arena, a, b));
}

/* a*b - c*d, or with plus */
static Expr two_products(OrientationClass *chain, Expr a, Expr b, int sign, Expr c, Expr d)
{
    Expr second = expr_mul(chain->arena, c, d);

    if (sign < 0)
        second = expr_neg(chain->arena, second);
    return expr_name_temporary(chain->arena,
                               expr_add(chain->arena, expr_mul(chain->arena, a, b), second));
}

static void form(OrientationClass *chain)
{
    Arena *a = chain->arena;
    int n = chain->links;
    Expr *angle = chain->inputs;
    Expr rate2[MOST_LINKS];
    Expr *length = chain->inputs + 3 * n;
    Expr g;

    for (int i = 0; i < n; i++)
        (void)symbol(chain, "th", i, SYMBOL_COORDINATE);
    for (int i = 0; i < n; i++)
        rate2[i] = expr_square(a, symbol(chain, "w", i, SYMBOL_SPEED));
    for (int i = 0; i < n; i++)
        (void)symbol(chain, "m", i, SYMBOL_PARAMETER);
    for (int i = 0; i < n; i++)
        (void)symbol(chain, "L", i, SYMBOL_PARAMETER);
    g = symbol(chain, "g", 0, SYMBOL_PARAMETER);

    for (int i = n - 1; i >= 0; i--) {
        Expr mass = chain->inputs[2 * n + i];

        chain->mu[i] =
            i == n - 1 ? mass : expr_name_temporary(a, expr_add(a, chain->mu[i + 1], mass));
        chain->sines[i] = expr_sin(a, angle[i]);
        chain->cosines[i] = expr_cos(a, angle[i]);
    }
    for (int i = 0; i < n; i++) {
        Expr weight = held_product(chain, held_product(chain, chain->mu[i], g), length[i]);

        chain->force[i] = expr_neg(a, expr_mul(a, weight, chain->cosines[i]));
        for (int j = 0; j < n; j++) {
            Expr mu = chain->mu[i > j ? i : j];
            Expr factor = held_product(chain, mu, held_product(chain, length[i], length[j]));
            Expr *s = chain->sines;
            Expr *c = chain->cosines;

            chain->mass[i][j] =
                held_product(chain, factor, two_products(chain, c[i], c[j], 1, s[i], s[j]));
            if (i != j) {
                Expr sine = two_products(chain, s[i], c[j], -1, c[i], s[j]);

                chain->force[i] = expr_sub(
                    a, chain->force[i], expr_mul(a, held_product(chain, factor, sine), rate2[j]));
            }
        }
        chain->force[i] = expr_name_temporary(a, chain->force[i]);
    }
}

/* R on and below the diagonal of mass, its diagonal inverted; then R y = f, R^T x = y */
static void solve(OrientationClass *chain)
{
    Arena *a = chain->arena;
    int n = chain->links;
    Expr(*R)[MOST_LINKS] = chain->mass;
    Expr *x = chain->force;

    for (int j = 0; j < n; j++) {
        for (int i = j; i < n; i++) {
            Expr sum = R[i][j];

            for (int k = 0; k < j; k++)
                sum = expr_sub(a, sum, expr_mul(a, R[i][k], R[j][k]));
            if (i == j)
                R[i][j] = expr_name_temporary(
                    a, expr_div(a, expr_int(a, 1), expr_sqrt(a, expr_name_temporary(a, sum))));
            else
                R[i][j] = held_product(chain, expr_name_temporary(a, sum), R[j][j]);
        }
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++)
            x[i] = expr_sub(a, x[i], expr_mul(a, R[i][k], x[k]));
        x[i] = held_product(chain, expr_name_temporary(a, x[i]), R[i][i]);
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            x[i] = expr_sub(a, x[i], expr_mul(a, R[k][i], x[k]));
        x[i] = held_product(chain, expr_name_temporary(a, x[i]), R[i][i]);
        chain->accelerations[i] = x[i];
    }
}

static OrientationClass *chain_new(int links)
{
    OrientationClass *chain = NEW(OrientationClass);

    chain->arena = arena_new();
    chain->links = links;
    form(chain);
    solve(chain);
    return chain;
}

static void chain_free(OrientationClass *chain)
{
    arena_free(chain->arena);
    mem_free(chain);
}

static void set_inputs(const OrientationClass *chain, double *inputs)
{
    for (int i = 0; i < chain->input_count; i++)
        inputs[i] = 1 + 0.1 * sin(i);
}

/* --- the baseline: one slot and one turn of a switch a node --- */

typedef struct Node {
    ExprKind kind;
    Op op;
    int first; /* of its operands */
    int count;
    double number;
} Node;

typedef struct Plain {
    LIST(Node) nodes;
    LIST(int) operands;
    int *place; /* by creation number: plus 1 */
    double *slots;
} Plain;

static void plain_add(Plain *plain, Expr e)
{
    Node node = {.kind = expr_kind(e), .count = expr_arg_count(e)};

    if (plain->place[expr_number(e)] != 0)
        return;
    if (node.kind == EXPR_CALL)
        node.op = expr_op(e);
    if (expr_is_number(e))
        node.number = expr_value(e);
    for (int i = 0; i < node.count; i++)
        plain_add(plain, expr_arg(e, i));
    node.first = plain->operands.count;
    for (int i = 0; i < node.count; i++)
        LIST_PUSH(plain->operands, plain->place[expr_number(expr_arg(e, i))] - 1);
    LIST_PUSH(plain->nodes, node);
    plain->place[expr_number(e)] = plain->nodes.count;
}

static void plain_run(const Plain *plain)
{
    double *slots = plain->slots;

    for (int n = 0; n < plain->nodes.count; n++) {
        const Node *node = &plain->nodes.at[n];
        const int *operand = plain->operands.at + node->first;
        double value;

        switch (node->kind) {
        case EXPR_SUM:
            value = slots[operand[0]];
            for (int i = 1; i < node->count; i++)
                value += slots[operand[i]];
            break;
        case EXPR_PRODUCT:
            value = slots[operand[0]];
            for (int i = 1; i < node->count; i++)
                value *= slots[operand[i]];
            break;
        case EXPR_POWER:
            value = slots[operand[0]];
            value = slots[operand[1]] == 2    ? value * value
                    : slots[operand[1]] == -1 ? 1 / value
                                              : pow(value, slots[operand[1]]);
            break;
        case EXPR_CALL:
            value = slots[operand[0]];
            if (node->op != OP_HOLD)
                value = node->op == OP_SIN    ? sin(value)
                        : node->op == OP_COS  ? cos(value)
                        : node->op == OP_SQRT ? sqrt(value)
                                              : NAN;
            break;
        case EXPR_SYMBOL:
            continue;
        default:
            value = node->number;
            break;
        }
        slots[n] = value;
    }
}

static Plain *plain_new(const OrientationClass *chain)
{
    Plain *plain = NEW(Plain);

    plain->place = NEW_ARRAY(int, arena_nodes(chain->arena) + 1000);
    for (int i = 0; i < chain->input_count; i++)
        plain_add(plain, chain->inputs[i]);
    for (int i = 0; i < chain->links; i++)
        plain_add(plain, chain->accelerations[i]);
    plain->slots = NEW_ARRAY(double, plain->nodes.count);
    set_inputs(chain, plain->slots);
    return plain;
}

static void plain_free(Plain *plain)
{
    LIST_FREE(plain->nodes);
    LIST_FREE(plain->operands);
    mem_free(plain->place);
    mem_free(plain->slots);
    mem_free(plain);
}

/* --- the rows --- */

static void line(const char *what, const char *size, double value, const char *unit)
{
    char name[40];

    (void)snprintf(name, sizeof name, "program.%s_%s", what, size);
    bench_line(name, value, unit);
}

/* the same natively: of one, and a chain each of as many at once as the processor has it */
/* the slots of so many evaluations side by side, with inputs and constants; new */
static double *slots_of(const OrientationClass *chain, const Program *program, int width)
{
    double *slots = NEW_ARRAY(double, (program->slot_count + program->root_count) * width);

    for (int k = 0; k < width; k++) {
        for (int i = 0; i < chain->input_count; i++)
            slots[i * width + k] = 1 + 0.1 * sin(i + k);
        for (int i = 0; i < program->constants.count; i++)
            slots[(chain->input_count + i) * width + k] = program->constants.at[i];
    }
    return slots;
}

/* as rows are told: by the interpreter, eight at once */
static void measure_abreast(const OrientationClass *chain, const Program *program, const char *size,
                            int calls)
{
    double *slots = slots_of(chain, program, ABREAST), seconds;

    program_interpret_abreast(program, STAGE_PARAMETER, STAGE_ACCELERATION, slots);
    BENCH_LEAST(200, seconds,
                for (int i = 0; i < calls; i++)
                    program_interpret_abreast(program, STAGE_POSITION, STAGE_ACCELERATION, slots));
    line("eval_moving_8", size, 1e9 * seconds / calls / ABREAST, "ns");
    mem_free(slots);
}

static void measure_native(const OrientationClass *chain, const Program *program, const char *size,
                           int calls)
{
    const struct {
        const char *what;
        int width;
        bool fused;
    } rows[] = {
        {"native", 1, true}, {"strict", 1, false}, {"native_4", 4, true}, {"native_8", 8, true}};

    for (int r = 0; r < COUNT(rows); r++) {
        NativeTarget target;
        Native *native;
        NativeFrame *frame;
        double *slots, seconds;
        char name[32];
        const int width = rows[r].width;

        if (!native_target(width, rows[r].fused, &target) || target.width < width)
            continue;
        native = native_new(program, &target);
        if (native == NULL)
            continue;
        frame = native_frame_new(native);
        slots = slots_of(chain, program, width);
        native_run(native, STAGE_PARAMETER, STAGE_ACCELERATION, slots, frame);
        BENCH_LEAST(200, seconds,
                    for (int i = 0; i < calls; i++)
                        native_run(native, STAGE_POSITION, STAGE_ACCELERATION, slots, frame));
        (void)snprintf(name, sizeof name, "eval_%s", rows[r].what);
        line(name, size, 1e9 * seconds / calls / width, "ns");
        native_frame_free(frame);
        native_free(native);
        BENCH_LEAST(20, seconds, native_free(native_new(program, &target)));
        (void)snprintf(name, sizeof name, "make_%s", rows[r].what);
        line(name, size, 1e6 * seconds, "us");
        mem_free(slots);
    }
}

static void measure(int links, const char *size)
{
    OrientationClass *chain = chain_new(links);
    Plain *plain = plain_new(chain);
    Program *program = NULL;
    Workspace *workspace;
    int calls = 400000 / (links * links * links);
    double seconds;

    if (program_new(chain->accelerations, links, chain->inputs, chain->input_count, &program,
                    NULL) != OK)
        return;
    workspace = workspace_new(program);
    set_inputs(chain, workspace_inputs(workspace));

    line("operations", size, (double)op_count_total(program_count(program)), "ops");
    BENCH_LEAST(200, seconds,
                for (int i = 0; i < calls; i++)
                    workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION));
    line("eval", size, 1e9 * seconds / calls, "ns");
    BENCH_LEAST(200, seconds,
                for (int i = 0; i < calls; i++)
                    workspace_run(workspace, STAGE_POSITION, STAGE_ACCELERATION));
    line("eval_moving", size, 1e9 * seconds / calls, "ns");
    measure_abreast(chain, program, size, calls);
    measure_native(chain, program, size, calls);
    BENCH_LEAST(200, seconds, for (int i = 0; i < calls; i++) plain_run(plain));
    line("eval_switch", size, 1e9 * seconds / calls, "ns");

    program_free(program);
    BENCH_LEAST(20, seconds,
                (void)!program_new(chain->accelerations, links, chain->inputs, chain->input_count,
                                   &program, NULL);
                program_free(program));
    line("make", size, 1e6 * seconds, "us");

    workspace_free(workspace);
    plain_free(plain);
    chain_free(chain);
}

int main(void)
{
    measure(4, "170");
    measure(12, "2k");
    measure(32, "20k");
    return 0;
}
