/* bench_dynamics.c: operations and time of one evaluation of a robot's and of chains' accelerations
 *
 * The robot and the chains of tests/bench/peers.py, which puts other programs beside these rows.
 * An evaluation is one of the equations' rate: q' and u' where t, q and u are given; inverse, one
 * of the joints' torques where u' are given too. Named as an argument, one of them alone. The robot
 * is exported as C, too, which cc makes a library of here, and timed beside. */
#include "../unit/session_kit.h"
#include "bench.h"
#include "bench_model.h"
#include "robot_text.h"

#include "../unit/form.h"
#include "formulate/dynamics/cutset_equations.h"
#include "formulate/reduced/accelerations.h"
#include "formulate/reduced/prescribed.h"
#include "simulate/equations/compiled_equations.h"
#include "simulate/equations/motion.h"

#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    TRIES = 300,
    FEW = 3000 /* evaluations until a program has been made native */,
    FEW_LINKS = 50 /* of chains that are driven, too */
};

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

/* Nanoseconds of one evaluation; `kept` takes the rates. */
static double evaluation(const Motion *motion, const System *system, double *kept)
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
    memcpy(kept, rate, (size_t)length * sizeof(double));
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
        system_accelerations(system, force, pushes, told, told + nu) != ELIMINATED_NOT) {
        const OpCount ops = expr_count_without(told, nu, 1U << SYMBOL_PARAMETER);

        line(name, "operations", (double)(ops.add + ops.mul), "ops");
        line(name, "functions", (double)ops.fun, "ops");
    }
    mem_free(told);
}

/* --- the C that comes out --- */

/* model_rates() and model_parameters() of exported code, with real = double */
typedef int Rates(const double *p, double t, const double *y, double *s, double *work, double *out);
typedef void Values(double *p);

enum { ROOM = 4096 /* for parameters, unknowns and workspace: far more than six joints take */ };

/* Operations as the code's head counts them, in its line "accelerations: ...". */
static void count_exported(const char *code, const char *name)
{
    const char *told = strstr(code, "accelerations: "), *counts = told != NULL ? told : "";
    int add, mul, fun;

    counts += strcspn(counts, "(\n");
    if (sscanf(counts, "(%d, %d, %d)", &add, &mul, &fun) == 3) {
        line(name, "exported_operations", add + mul, "ops");
        line(name, "exported_functions", fun, "ops");
    }
}

/* As evaluation(), at the same states; the first `length` of `y` and `rate` are used. */
static double evaluation_exported(Rates *rates, Values *parameters, const System *system,
                                  int length, double *rate)
{
    static double p[ROOM], s[ROOM], work[ROOM];
    double *y = NEW_ARRAY(double, 2 * length), seconds;
    const int few = 2 + 2 * (200 / (10 + system_nu(system)));

    parameters(p);
    place(system, y);
    memcpy(y + length, y, (size_t)length * sizeof(double));
    y[length] += 0.1;
    BENCH_LEAST(TRIES, seconds,
                for (int i = 0; i < few; i++)(void) rates(p, 0, y + i % 2 * length, s, work, rate));
    (void)rates(p, 0, y, s, work, rate);
    mem_free(y);
    return 1e9 * seconds / few;
}

/* Export, compile, load and time; `right` are the rates of our program, which took `own` ns. */
static void measure_exported(const char *text, const char *name, const System *robot, double own,
                             const double *right)
{
    char folder[] = "/tmp/bench_dynamics_XXXXXX", command[512];
    const int length = system_n(robot) + system_nu(robot);
    double *rate = NEW_ARRAY(double, length), off = 0, took;
    Kit kit = kit_new();
    void *library = NULL;
    FILE *file = NULL;
    Rates *rates;
    Values *parameters;

    if (mkdtemp(folder) == NULL)
        goto done;
    if (kit_do(&kit, text) != CT_OK || kit_do(&kit, "export c\n") != CT_OK || kit.text == NULL) {
        printf("# %s: not exported: %s\n", name, kit.error.message);
        goto done;
    }
    count_exported(kit.text, name);
    (void)snprintf(command, sizeof command, "%s/robot.c", folder);
    file = fopen(command, "w");
    if (file == NULL || fputs(kit.text, file) < 0) {
        printf("# %s: can't write %s\n", name, command);
        goto done;
    }
    (void)fclose(file);
    file = NULL;
    (void)snprintf(command, sizeof command,
                   "cc -O3 -march=native -shared -fPIC -o %s/robot.so %s/robot.c -lm 2>%s/said",
                   folder, folder, folder);
    if (system(command) != 0) {
        printf("# %s: exported C is not timed: no compiler cc that takes it is here\n", name);
        goto done;
    }
    (void)snprintf(command, sizeof command, "%s/robot.so", folder);
    library = dlopen(command, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        printf("# %s: exported C is not timed: %s\n", name, dlerror());
        goto done;
    }
    *(void **)&rates = dlsym(library, "model_rates");
    *(void **)&parameters = dlsym(library, "model_parameters");
    took = evaluation_exported(rates, parameters, robot, length, rate);
    for (int i = 0; i < length; i++)
        off = fmax(off, fabs(rate[i] - right[i]) / fmax(1, fabs(right[i])));
    if (off > 1e-9) {
        printf("# %s: exported C is off by %.2g\n", name, off);
        goto done;
    }
    line(name, "exported", took, "ns");
    line(name, "exported_times", took / own, "ours");
done:
    if (file != NULL)
        (void)fclose(file);
    if (library != NULL)
        (void)dlclose(library);
    (void)snprintf(command, sizeof command, "rm -rf %s", folder);
    (void)system(command);
    kit_free(&kit);
    mem_free(rate);
}

/* --- torques of a motion that is given --- */

/* drivers of all joints: of that name, and numbers from `first` on */
static char *driven(const char *text, const char *joint, int first, int count)
{
    Text all = {0};

    text_add(&all, text);
    for (int j = 0; j < count; j++)
        text_addf(&all, "driver D%d %s%d = %.17g*t^2/2\n", j, joint, first + j, sin(3 + 0.7 * j));
    return text_done(&all);
}

/* Nanoseconds of one evaluation; the torques are printed. */
static double evaluation_inverse(Motion *motion, const System *system)
{
    const int length = motion_length(motion), few = 2 + 2 * (200 / (10 + system_nu(system)));
    double *y = NEW_ARRAY(double, 2 * length), seconds;
    Solved solved;

    place(system, y);
    memcpy(y + length, y, (size_t)length * sizeof(double));
    y[length] += 0.1;
    for (int i = 0; i < FEW; i++)
        (void)motion_solve(motion, 0, y + i % 2 * length, &solved);
    BENCH_LEAST(TRIES, seconds,
                for (int i = 0; i < few; i++)(void)
                    motion_solve(motion, 0, y + i % 2 * length, &solved));
    (void)motion_solve(motion, 0, y, &solved);
    printf("# tau");
    for (int j = 0; j < system_nu(system); j++)
        printf(" %.15g", -solved.multipliers[j]);
    printf("\n");
    mem_free(y);
    return 1e9 * seconds / few;
}

static void count_inverse(System *system, const char *name)
{
    const int nu = system_nu(system);
    Expr *told = NEW_ARRAY(Expr, 2 * nu);

    if (system_prescribed(system, told, told + nu)) {
        const OpCount ops = expr_count_without(told, 2 * nu, 1U << SYMBOL_PARAMETER);

        line(name, "inverse_operations", (double)(ops.add + ops.mul), "ops");
        line(name, "inverse_functions", (double)ops.fun, "ops");
    }
    mem_free(told);
}

typedef enum Asked { ASKED_RATES, ASKED_EXPORT, ASKED_TORQUES } Asked;

static void measure(const char *text, const char *name, Asked asked)
{
    Model *model = bench_model(text);
    System *system = NULL;
    Parameters parameters = {.value = parameter, .context = model};
    CompiledEquations *numbers = NULL;
    Motion *motion = NULL;
    VariableIndex *layout;
    Diag diag = {0};
    double *rate, took;
    int *rows;

    if (form_system(model, &system, &diag) != OK) {
        printf("# %s: %s\n", name, diag.message);
        return;
    }
    if (asked == ASKED_TORQUES)
        count_inverse(system, name);
    else
        count(system, name);
    layout = variable_index_new(system);
    rows = NEW_ARRAY(int, layout->m);
    for (int k = 0; k < layout->m; k++)
        rows[k] = k;
    parameters.evaluator = EVALUATOR_STRICT;
    if (compiled_new(layout, &parameters, &numbers, &diag) == OK) {
        motion =
            motion_new(compiled_equations(numbers),
                       &(MotionOptions){.rows = rows, .row_count = layout->m, .tolerance = 1e-9});
        rate = NEW_ARRAY(double, motion_length(motion));
        took = asked == ASKED_TORQUES ? evaluation_inverse(motion, system)
                                      : evaluation(motion, system, rate);
        line(name, asked == ASKED_TORQUES ? "inverse" : "forward", took, "ns");
        if (asked == ASKED_EXPORT)
            measure_exported(text, name, system, took, rate);
        mem_free(rate);
    }
    mem_free(rows);
    motion_free(motion);
    compiled_free(numbers);
    parameters_free(&parameters);
    variable_index_free(layout);
    system_free(system);
    model_free(model);
}

/* a row of `inverse`, all that a run does for it */
static void measure_row(const char *driven_text, const char *name)
{
    enum { ROWS = 100000 };
    Kit kit = kit_new();
    double many = 0, few = 0;
    bool sound = kit_do(&kit, driven_text) == CT_OK;

    if (sound)
        BENCH_LEAST(5, many, sound = sound && kit_do(&kit, "inverse 1 every=0.00001\n") == CT_OK);
    if (sound)
        BENCH_LEAST(5, few, sound = sound && kit_do(&kit, "inverse 1 every=0.5\n") == CT_OK);
    if (sound)
        line(name, "inverse_row", 1e9 * (many - few) / ROWS, "ns");
    else
        printf("# %s: %s\n", name, kit.error.message);
    kit_free(&kit);
}

/* a model, and the same with a driver on each of its joints */
static void measure_both(const char *text, const char *name, const char *joint, int first,
                         int count)
{
    char *all = driven(text, joint, first, count);

    measure(text, name, first > 0 ? ASKED_EXPORT : ASKED_RATES);
    if (count <= FEW_LINKS)
        measure(all, name, ASKED_TORQUES);
    if (count <= FEW_LINKS)
        measure_row(all, name);
    mem_free(all);
}

int main(int argc, char **argv)
{
    static const int links[] = {2, 10, 50, 200, 1000};

    if (argc < 2 || strcmp(argv[1], "6r") == 0)
        measure_both(robot_6r, "6r", "j", 1, 6);
    for (int i = 0; i < COUNT(links); i++) {
        char *text = robot_chain(links[i]), name[24];

        (void)snprintf(name, sizeof name, "chain_%d", links[i]);
        if (argc < 2 || strcmp(argv[1], name) == 0)
            measure_both(text, name, "h", 0, links[i]);
        mem_free(text);
    }
    return 0;
}
