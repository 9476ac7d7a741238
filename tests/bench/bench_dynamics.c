/* bench_dynamics.c: operations and time of one evaluation of a robot's and of chains' accelerations
 *
 * The robot and the chains of tests/bench/peers.py, which puts other programs beside these rows.
 * An evaluation is one of the equations' rate: q' and u' where t, q and u are given. Named as an
 * argument, one of them alone. */
#include "bench.h"
#include "bench_model.h"
#include "robot_text.h"

#include "../unit/form.h"
#include "formulate/accelerations.h"
#include "simulate/equations/motion.h"
#include "simulate/equations/numbers.h"

#include <math.h>
#include <string.h>

enum { TRIES = 300, FEW = 3000 /* evaluations until a program has been made native */ };

static double parameter(void *model, Expr symbol)
{
    return model_parameter_value(model, symbol);
}

/* angles and speeds that no joint shares with another */
static void place(const System *system, double *y)
{
    const int n = system_n(system), nu = system_nu(system);

    for (int i = 0; i < n; i++)
        y[i] = sin(1 + 1.7 * i);
    for (int j = 0; j < nu; j++)
        y[n + j] = cos(2 + 1.3 * j);
}

static double evaluation(const Motion *motion, const System *system)
{
    const Ode *ode = motion_ode(motion);
    const int length = motion_length(motion);
    double *y = NEW_ARRAY(double, 2 * length); /* two places in turn: none is met twice */
    double *rate = NEW_ARRAY(double, motion_length(motion));
    const int few = 2 + 2 * (200 / (10 + system_nu(system)));
    double seconds;

    place(system, y);
    memcpy(y + length, y, (size_t)length * sizeof(double));
    y[length] += 0.1;
    for (int i = 0; i < FEW; i++)
        (void)ode->rate(ode->context, 0, y + i % 2 * length, rate);
    BENCH_LEAST(TRIES, seconds,
                for (int i = 0; i < few; i++)(void)
                    ode->rate(ode->context, 0, y + i % 2 * length, rate));
    (void)ode->rate(ode->context, 0, y, rate);
    printf("# u'");
    for (int j = 0; j < system_nu(system); j++)
        printf(" %.15g", rate[system_n(system) + j]);
    printf("\n");
    MEM_FREE(y, rate);
    return 1e9 * seconds / few;
}

static void line(const char *name, const char *what, double value, const char *unit)
{
    char row[64];

    (void)snprintf(row, sizeof row, "dynamics.%s_%s", name, what);
    bench_line(row, value, unit);
}

static void count(System *system, const char *name)
{
    const int nu = system_nu(system);
    Expr *told = NEW_ARRAY(Expr, 4 * nu), *pushes = told + 2 * nu, *force = told + 3 * nu;

    memcpy(force, system_run(system)->force, (size_t)nu * sizeof(Expr));
    if (system_pushes(system, pushes, NULL) == OK &&
        system_accelerations(system, force, pushes, told, told + nu) != TOLD_NOT) {
        const OpCount ops = expr_count_beside(told, nu, 1U << SYMBOL_PARAMETER);

        line(name, "operations", (double)(ops.add + ops.mul), "ops");
        line(name, "functions", (double)ops.fun, "ops");
    }
    mem_free(told);
}

static void measure(const char *text, const char *name)
{
    Model *model = bench_model(text);
    System *system = NULL;
    Parameters parameters = {.value = parameter, .context = model};
    Numbers *numbers = NULL;
    Motion *motion = NULL;
    Layout *layout;
    Diag diag = {0};

    if (form_system(model, &system, &diag) != OK) {
        printf("# %s: %s\n", name, diag.message);
        return;
    }
    count(system, name);
    layout = layout_new(system);
    parameters.evaluator = EVALUATOR_STRICT;
    if (numbers_new(layout, &parameters, &numbers, &diag) == OK) {
        motion = motion_new(numbers_equations(numbers), &(MotionOptions){.tolerance = 1e-9});
        line(name, "forward", evaluation(motion, system), "ns");
    }
    motion_free(motion);
    numbers_free(numbers);
    parameters_free(&parameters);
    layout_free(layout);
    system_free(system);
    model_free(model);
}

int main(int argc, char **argv)
{
    static const int links[] = {2, 10, 50, 200, 1000};

    if (argc < 2 || strcmp(argv[1], "6r") == 0)
        measure(robot_6r, "6r");
    for (int i = 0; i < COUNT(links); i++) {
        char *text = robot_chain(links[i]), name[24];

        (void)snprintf(name, sizeof name, "chain_%d", links[i]);
        if (argc < 2 || strcmp(argv[1], name) == 0)
            measure(text, name);
        mem_free(text);
    }
    return 0;
}
