/* bench_native.c: mass matrix and forces of chains by each evaluator, and a run
 *
 * Chains of N joints of a spatial robot with axes of its own each, and of planar links; parameters
 * are numbers here, which the equations keep as such. Rows of ratios are by how much the
 * interpreter takes longer, and by how much eight evaluations one by one take longer than eight
 * lanes. */
#include "../random.h"
#include "../unit/form.h"
#include "../unit/session_kit.h"
#include "bench.h"
#include "bench_model.h"

#include "base/text.h"
#include "compile/program.h"
#include "compile/simd_batch.h"

#include <math.h>

static char *chain_text(bool is_planar, int joints)
{
    Text text = {0};
    uint64_t random = 1993;

    text_add(&text, is_planar ? "scene planar\ngravity [0, -9.81]\n" : "gravity [0, 0, -9.81]\n");
    for (int i = 0; i < joints; i++) {
        const double length = test_uniform(&random, 0.3, 0.6), mass = test_uniform(&random, 0.5, 2);

        if (is_planar)
            text_addf(&text,
                      "body b%d mass=%.3f inertia=0.02\narm h%d b%d [%.3f, 0]\n"
                      "arm t%d b%d [%.3f, 0]\n",
                      i, mass, i, i, -length, i, i, length);
        else
            text_addf(&text,
                      "body b%d mass=%.3f inertia=[0.3, 0.4, 0.35]\narm h%d b%d [%.3f, 0, 0.1]\n"
                      "arm t%d b%d [%.3f, 0, 0]\n",
                      i, mass, i, i, -length, i, i, length);
        if (i == 0)
            text_add(&text, "revolute j0 ground h0\n");
        else
            text_addf(&text, "revolute j%d t%d h%d%s\n", i, i - 1, i,
                      is_planar    ? ""
                      : i % 2 == 0 ? " axis=z"
                                   : " axis=y");
    }
    text_add(&text, "tree joint\n");
    return text_done(&text);
}

/* nanoseconds of an evaluation of all that moves */
static double evaluation(const Program *program, Evaluator evaluator)
{
    Workspace *workspace = workspace_new(program);
    double *inputs = workspace_inputs(workspace), seconds;

    workspace_choose(workspace, evaluator);
    for (int i = 0; i < program_input_count(program); i++)
        inputs[i] = 1 + 0.1 * sin(i);
    for (int i = 0; i < 5000; i++) /* so often that it is made native */
        workspace_run(workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
    BENCH_LEAST(200, seconds,
                for (int i = 0; i < 20; i++)
                    workspace_run(workspace, STAGE_TIME, STAGE_ACCELERATION));
    workspace_free(workspace);
    return 1e9 * seconds / 20;
}

/* Nanoseconds of eight evaluations of all that moves, side by side; NAN: no native code. */
static double side_by_side(const Program *program)
{
    enum { LANES = 8 };
    Native *native = simd_batch_native(program, LANES, EVALUATOR_NATIVE);
    SimdBatch *lanes = native != NULL ? simd_batch_new(program, native, LANES) : NULL;
    double values[2][LANES], seconds = NAN;

    for (int i = program_input_count(program) - 1; lanes != NULL && i >= 0; i--) {
        for (int k = 0; k < LANES; k++) {
            values[0][k] = 1 + 0.1 * sin(i) + 0.01 * k;
            values[1][k] = 0.1 + values[0][k];
        }
        simd_batch_set(lanes, i, STAGE_TIME, values[0]);
    }
    if (lanes != NULL)
        BENCH_LEAST(
            200, seconds, for (int i = 1; i <= 20; i++) { /* what is put again runs nothing */
                                                          simd_batch_set(lanes, 0, STAGE_TIME,
                                                                         values[i % 2]);
                                                          simd_batch_run(lanes);
            });
    simd_batch_free(lanes);
    native_free(native);
    return 1e9 * seconds / 20;
}

static void line(const char *what, const char *name, double value, const char *unit)
{
    char row[64];

    (void)snprintf(row, sizeof row, "native.%s_%s", what, name);
    bench_line(row, value, unit);
}

static void measure(const Program *program, const char *name)
{
    const double interpreter = evaluation(program, EVALUATOR_INTERPRETER),
                 strict = evaluation(program, EVALUATOR_STRICT),
                 native = evaluation(program, EVALUATOR_NATIVE), lanes = side_by_side(program);

    line("interpreter", name, interpreter, "ns");
    line("strict", name, strict, "ns");
    line("fused", name, native, "ns");
    line("strict_part", name, strict / interpreter, "of the interpreter's");
    if (!isnan(lanes)) {
        line("eight_lanes", name, lanes, "ns");
        line("eight_by_lanes", name, 8 * native / lanes, "one by one");
    }
}

static void measure_chain(bool is_planar, int joints, const char *name)
{
    char *text = chain_text(is_planar, joints);
    Model *model = bench_model(text);
    System *system = NULL;
    Program *program = NULL;
    const EquationForm *r;
    Expr *roots, *inputs;
    int count;

    mem_free(text);
    if (model == NULL || form_system(model, &system, NULL) != OK ||
        system_form_mass(system, NULL) != OK)
        return;
    r = system_run(system);
    roots = NEW_ARRAY(Expr, joints * joints + joints);
    memcpy(roots, r->mass, (size_t)(joints * joints) * sizeof(Expr));
    memcpy(roots + joints * joints, r->force, (size_t)joints * sizeof(Expr));
    count = expr_symbols(roots, joints * joints + joints, &inputs);
    if (program_new(roots, joints * joints + joints, inputs, count, &program, NULL) == OK) {
        line("operations", name, (double)op_count_total(program_count(program)), "ops");
        measure(program, name);
    }
    program_free(program);
    mem_free(inputs);
    mem_free(roots);
    system_free(system);
    model_free(model);
}

/* seconds of a run of a double pendulum */
static double run(const char *evaluator)
{
    Kit kit = kit_new();
    char text[64];
    double seconds;

    (void)snprintf(text, sizeof text, "set evaluator %s\n", evaluator);
    if (kit_do(&kit, text) != CT_OK ||
        kit_do(&kit, "scene planar\ngravity [0, -9.81]\nbody a mass=1 inertia=0\n"
                     "body b mass=1 inertia=0\narm a0 a [0, 1]; arm b0 b [0, 1]\n"
                     "revolute h1 ground a0\nrevolute h2 a b0\ninit h1 = 1.5, h2 = 0.7\n") != CT_OK)
        return NAN;
    BENCH_LEAST(20, seconds, (void)kit_do(&kit, "simulate 10 rtol=1e-6 atol=1e-6 every=10\n"));
    kit_free(&kit);
    return seconds;
}

int main(void)
{
    double interpreter, strict;

    measure_chain(false, 6, "6r");
    measure_chain(true, 10, "chain_10");
    measure_chain(true, 50, "chain_50");
    measure_chain(false, 10, "spatial_10");
    measure_chain(false, 20, "spatial_20");
    interpreter = run("interpreter");
    strict = run("strict");
    bench_line("native.run_interpreter", 1e3 * interpreter, "ms");
    bench_line("native.run_strict", 1e3 * strict, "ms");
    bench_line("native.run_strict_part", strict / interpreter, "of the interpreter's");
    return 0;
}
