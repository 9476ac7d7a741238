/* bench_formulate.c: formulation of chains of N spatial revolute joints: milliseconds, nodes, and
 * operations of M, of F and of both, each shared definition once
 *
 * M has N^2 entries and its operations grow so; those of F, by recursion, grow with N. */
#include "formulate/system/system.h"

#include "../random.h"
#include "../unit/form.h"
#include "bench.h"
#include "bench_model.h"

#include <math.h>
#include <string.h>

/* a body on an arm on a joint, N times, each with its own axis and numbers */
static char *chain_text(int joints)
{
    Text text = {0};
    uint64_t random = 1993;

    text_add(&text, "gravity [0, 0, -9.81]\n");
    for (int i = 0; i < joints; i++) {
        text_addf(&text, "body b%d mass=%.3f inertia=[%.3f, %.3f, %.3f, 0.01, -0.02, 0.03]\n", i,
                  test_uniform(&random, 0.5, 2.0), test_uniform(&random, 0.3, 0.5),
                  test_uniform(&random, 0.3, 0.5), test_uniform(&random, 0.3, 0.5));
        text_addf(&text, "arm h%d b%d [%.3f, 0, 0.1]\n", i, i, test_uniform(&random, -0.6, -0.3));
        if (i == 0)
            text_add(&text, "revolute j0 ground h0 axis=z\n");
        else
            text_addf(&text,
                      "arm t%d b%d [%.3f, 0.2, 0]\nrevolute j%d t%d h%d axis=[%.3f, %.3f, 1]\n", i,
                      i - 1, test_uniform(&random, 0.3, 0.6), i, i, i,
                      test_uniform(&random, -1.0, 1.0), test_uniform(&random, -1.0, 1.0));
    }
    text_add(&text, "tree joint\n");
    return text_done(&text);
}

static void chain_line(int joints, const char *what, double value, const char *unit)
{
    char name[64];

    (void)snprintf(name, sizeof name, "formulate.chain_%d_%s", joints, what);
    bench_line(name, value, unit);
}

static void count_operations(int joints, System *system)
{
    const EquationForm *reading = system_definitions(system);
    int entries = joints * joints;
    Expr *both = NEW_ARRAY(Expr, entries + joints);

    if (system_form_mass(system, NULL) != OK)
        return;

    memcpy(both, reading->mass, (size_t)entries * sizeof *both);
    memcpy(both + entries, reading->force, (size_t)joints * sizeof *both);
    chain_line(joints, "M", (double)op_count_total(expr_count_shared(both, entries)), "operations");
    chain_line(joints, "F", (double)op_count_total(expr_count_shared(both + entries, joints)),
               "operations");
    chain_line(joints, "M_and_F", (double)op_count_total(expr_count_shared(both, entries + joints)),
               "operations");
    mem_free(both);
}

static void bench_chain(int joints)
{
    char *text = chain_text(joints);
    double least = 1e300;
    int tries = joints > 50 ? 2 : 5;

    for (int i = 0; i < tries; i++) {
        Model *model = bench_model(text);
        System *system = NULL;
        Diag diag = {0};
        double began;
        int64_t nodes;

        if (model == NULL)
            break;
        nodes = arena_nodes(model_arena(model));
        began = clock_now();
        if (form_system(model, &system, &diag) == OK) {
            least = fmin(least, clock_now() - began);
            if (i == tries - 1) {
                chain_line(joints, "time", 1e3 * least, "ms");
                chain_line(joints, "nodes", (double)(arena_nodes(model_arena(model)) - nodes),
                           "nodes");
                count_operations(joints, system);
            }
        } else {
            printf("# %d joints: %s\n", joints, diag.message);
        }
        system_free(system);
        model_free(model);
    }
    mem_free(text);
}

int main(void)
{
    static const int joints[] = {2, 6, 10, 20, 50, 100, 200};

    for (int i = 0; i < COUNT(joints); i++)
        bench_chain(joints[i]);
    return 0;
}
