/* bench_network.c: ladders: of coils and capacitors, their equations, cost of an evaluation, and a
 * whole run beside ngspice; of diodes, their operating point; stiff ones, sparse beside dense
 *
 * bench_network SCRIPTS PROGRAM. tests/oracle/spice/ladder writes them. Error against run time: the
 * program at three tolerances, ngspice in three lengths of its steps, both processes whole, with
 * what they read and write; the error is that of three waveforms against a run at 1e-11. How many
 * times the program's time ngspice takes is told of the quickest run whose error is no larger. */
#include "formulate/system/system.h"
#include "simulate/run/run.h"

#include "../unit/form.h"
#include "bench.h"
#include "bench_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WAVES = 3, LONG = 1000 };

typedef struct Row {
    double at[1 + WAVES]; /* t, waves */
} Row;

typedef LIST(Row) Table;

/* what a command of the shell prints; new */
static char *printed(const char *command)
{
    Text text = {0};
    char piece[4096];
    FILE *pipe = popen(command, "r");

    while (pipe != NULL && fgets(piece, sizeof piece, pipe) != NULL)
        text_add(&text, piece);
    if (pipe != NULL)
        (void)pclose(pipe);
    return text_done(&text);
}

static bool shell(const char *command)
{
    return system(command) == 0; /* NOLINT(cert-env33-c): paths of our own */
}

/* --- equations and evaluations --- */

/* what a script below tests/oracle/spice writes of so many sections */
static Model *model_by(const char *scripts, const char *script, int sections)
{
    Text command = {0};
    Model *model;
    char *text;

    text_addf(&command, "'%s/../tests/oracle/spice/%s' ct %d", scripts, script, sections);
    text = printed(command.at);
    model = bench_model(text);
    mem_free(text);
    text_free(&command);
    return model;
}

static double parameter_value(void *context, Expr symbol)
{
    return model_parameter_value(context, symbol);
}

static void bench_ladder(const char *scripts, int sections)
{
    StartValues none = {0};
    double formulation = 1e300, evaluation = 1e300;
    char name[64];

    for (int i = 0; i < 3; i++) {
        Model *model = model_by(scripts, "ladder", sections);
        SimulationInput setting = {.parameter = parameter_value,
                                   .context = model,
                                   .scene = model_scene_source(model),
                                   .start = &none};
        RunOptions options = {.duration = 2e-5, .rtol = 1e-6, .atol = 1e-6, .method = "dop853"};
        System *system = NULL;
        Result *result = NULL;
        Diag diag = {0};
        double began = clock_now();

        if (model != NULL && form_system(model, &system, &diag) == OK &&
            system_run(system) != NULL) {
            formulation = fmin(formulation, clock_now() - began);
            if (run_simulate(system, &setting, &options, &result, NULL, &diag) == OK) {
                const RunReport *report = result_report(result);

                evaluation = fmin(evaluation, report->wall / (double)report->evaluations);
            }
        }
        if (result == NULL)
            printf("# ladder of %d: %s\n", sections, diag.message);
        result_free(result);
        system_free(system);
        model_free(model);
    }
    (void)snprintf(name, sizeof name, "network.ladder_%d_formulate", sections);
    bench_line(name, formulation, "s");
    (void)snprintf(name, sizeof name, "network.ladder_%d_evaluation", sections);
    bench_line(name, 1e6 * evaluation, "us");
}

/* --- diodes --- */

/* the operating point of a ladder of exponential diodes, from equations that are there */
static void bench_diodes(const char *scripts, int count)
{
    StartValues none = {0};
    double formulation = 1e300, point = 1e300;
    char name[64];

    for (int i = 0; i < 3; i++) {
        Model *model = model_by(scripts, "points/chain", count);
        SimulationInput setting = {.parameter = parameter_value,
                                   .context = model,
                                   .scene = model_scene_source(model),
                                   .start = &none};
        System *system = NULL;
        Result *result = NULL;
        Diag diag = {0};
        double began = clock_now();

        if (model != NULL && form_system(model, &system, &diag) == OK &&
            system_run(system) != NULL) {
            formulation = fmin(formulation, clock_now() - began);
            began = clock_now();
            if (run_equilibrium(system, &setting, &result, NULL, &diag) == OK)
                point = fmin(point, clock_now() - began);
        }
        if (result == NULL)
            printf("# %d diodes: %s\n", count, diag.message);
        result_free(result);
        system_free(system);
        model_free(model);
    }
    (void)snprintf(name, sizeof name, "network.diodes_%d_formulate", count);
    bench_line(name, formulation, "s");
    (void)snprintf(name, sizeof name, "network.diodes_%d_op", count);
    bench_line(name, 1e3 * point, "ms");
}

/* --- sparse against dense --- */

/* R and C of three decades: time constants from 1 ns to the minutes of the whole line */
static Model *stiff_ladder(int sections)
{
    Text text = {0};
    Model *model;

    text_add(&text, "vsource E1 n0 0 1 - exp(-t/1e-3)\n");
    for (int k = 1; k <= sections; k++)
        text_addf(&text, "resistor R%d n%d n%d %d\ncapacitor C%d n%d 0 %s\n", k, k - 1, k,
                  k % 2 == 1 ? 1 : 100, k, k, k % 10 == 0 ? "1 nF" : "1 uF");
    model = bench_model(text.at);
    text_free(&text);
    return model;
}

static double time_of(System *system, const SimulationInput *setting, const char *method)
{
    const RunOptions options = {
        .duration = 1, .every = 0.01, .rtol = 1e-6, .atol = 1e-9, .method = method};
    Result *result = NULL;
    Diag diag = {0};
    double began = clock_now();

    if (run_simulate(system, setting, &options, &result, NULL, &diag) != OK)
        printf("# %s: %s\n", method, diag.message);
    result_free(result);
    return clock_now() - began;
}

/* the same run by both methods, one after the other, so that their ratio holds on any machine */
static void bench_stiff(int sections)
{
    Model *model = stiff_ladder(sections);
    StartValues none = {0};
    const SimulationInput setting = {.parameter = parameter_value,
                                     .context = model,
                                     .scene = model_scene_source(model),
                                     .start = &none};
    System *system = NULL;
    Diag diag = {0};

    if (model != NULL && form_system(model, &system, &diag) == OK && system_run(system) != NULL) {
        double sparse = time_of(system, &setting, "ida");
        double dense = time_of(system, &setting, "bdf");
        char name[64];

        (void)snprintf(name, sizeof name, "network.stiff_%d_ida", sections);
        bench_line(name, sparse, "s");
        (void)snprintf(name, sizeof name, "network.stiff_%d_bdf", sections);
        bench_line(name, dense, "s");
        (void)snprintf(name, sizeof name, "network.stiff_%d_ida_of_bdf", sections);
        bench_line(name, sparse / dense, "ratio");
    } else {
        printf("# stiff ladder: %s\n", diag.message);
    }
    system_free(system);
    model_free(model);
}

/* --- ideal parts against resistances --- */

enum { PERIODS = 1000 };

typedef struct Switched {
    RunReport report;
    double average; /* of the output, V */
} Switched;

/* The last tenth of the rows of C1.v, the first and the last of them by half: edges of the switch
 * fall on them. */
static double average_of(ResultReader *reader, Diag *diag)
{
    const Result *result = result_reader_result(reader);
    const int rows = result_rows(result), from = rows - 1 - rows / 10;
    double *values = NEW_ARRAY(double, rows);
    double average = NAN;
    Expr output;

    if (system_variable(result_system(result), "C1.v", 0, &output, diag) == OK &&
        result_reader_values(reader, &output, 1, values, diag) == OK) {
        average = (values[from] + values[rows - 1]) / 2;
        for (int i = from + 1; i < rows - 1; i++)
            average += values[i];
        average /= rows - 1 - from;
    }
    mem_free(values);
    return average;
}

/* a circuit from rest; `text` is used up */
static Switched run_circuit(const char *name, Text *text, const RunOptions *options, bool averaged)
{
    StartValues none = {0};
    Switched out = {.report = {.wall = NAN}, .average = NAN};
    System *system = NULL;
    ResultReader *reader = NULL;
    Result *result = NULL;
    Diag diag = {0};
    Model *model = bench_model(text->at);
    const SimulationInput setting = {.parameter = parameter_value,
                                     .context = model,
                                     .scene = model_scene_source(model),
                                     .start = &none};

    text_free(text);
    if (model != NULL && form_system(model, &system, &diag) == OK && system_run(system) != NULL &&
        run_simulate(system, &setting, options, &result, &reader, &diag) == OK) {
        out.report = *result_report(result);
        if (averaged)
            out.average = average_of(reader, &diag);
    } else
        printf("# %s: %s\n", name, diag.message);
    result_reader_free(reader);
    result_free(result);
    system_free(system);
    model_free(model);
    return out;
}

/* A buck converter over PERIODS of its switch. */
static Switched switched(const char *keys)
{
    const RunOptions options = {.duration = 20e-6 * PERIODS, .every = 1e-6};
    Text text = {0};

    text_addf(&text,
              "vsource V1 a 0 12\nswitch S1 a b when=t*50e3 - floor(t*50e3) < 0.4%s\n"
              "diode D1 0 b%s\ninductor L1 b c 100 uH\ncapacitor C1 c 0 22 uF\n"
              "resistor R1 c 0 50\n",
              keys, keys);
    return run_circuit("converter", &text, &options, true);
}

static void bench_converter(void)
{
    Switched ideal = {0}, real = {0};
    double ideal_time = 1e300, real_time = 1e300;

    for (int i = 0; i < 3; i++) {
        ideal = switched("");
        real = switched(" Ron=1e-3 Roff=1e6");
        ideal_time = fmin(ideal_time, ideal.report.wall);
        real_time = fmin(real_time, real.report.wall);
    }
    bench_line("network.converter_1000_ideal", ideal_time, "s");
    bench_line("network.converter_1000_ideal_steps", (double)ideal.report.steps, "steps");
    bench_line("network.converter_1000_ideal_rhs", (double)ideal.report.evaluations, "evaluations");
    bench_line("network.converter_1000_real", real_time, "s");
    bench_line("network.converter_1000_real_steps", (double)real.report.steps, "steps");
    bench_line("network.converter_1000_real_rhs", (double)real.report.evaluations, "evaluations");
    bench_line("network.converter_1000_real_of_ideal", real_time / ideal_time, "ratio");
    bench_line("network.converter_1000_averages_apart", fabs(ideal.average - real.average), "V");
}

/* --- multipliers --- */

/* Of so many stages, over 20 periods from rest. */
static Switched multiplied(int stages, const char *keys)
{
    const RunOptions options = {.duration = 0.02, .every = 1e-4};
    Text text = {0};

    text_add(&text, "vsource V s0 0 100*sin(2*pi*1e3*t)\nresistor RS s0 a0 10\n");
    for (int k = 1; k <= stages; k++)
        text_addf(&text,
                  "capacitor Ca%d a%d a%d 1 uF\ndiode Da%d b%d a%d%s\ndiode Db%d a%d b%d%s\n"
                  "capacitor Cb%d b%d b%d 1 uF\n",
                  k, k - 1, k, k, k - 1, k, keys, k, k, k, keys, k, k - 1, k);
    text_addf(&text, "resistor R0 b0 0 1e-3\nresistor RL b%d 0 1e6\n", stages);
    return run_circuit("multiplier", &text, &options, false);
}

static void bench_multiplier(int stages, int runs)
{
    double ideal_time = 1e300, real_time = 1e300;
    double ideal_steps = NAN, real_steps = NAN;
    char name[80];

    for (int i = 0; i < runs; i++) {
        const Switched ideal = multiplied(stages, "");
        const Switched real = multiplied(stages, " Ron=0.1 Roff=1e7");

        ideal_time = fmin(ideal_time, ideal.report.wall);
        real_time = fmin(real_time, real.report.wall);
        ideal_steps = (double)ideal.report.steps;
        real_steps = (double)real.report.steps;
    }
    (void)snprintf(name, sizeof name, "network.multiplier_%d_ideal", stages);
    bench_line(name, ideal_time, "s");
    (void)snprintf(name, sizeof name, "network.multiplier_%d_ideal_steps", stages);
    bench_line(name, ideal_steps, "steps");
    (void)snprintf(name, sizeof name, "network.multiplier_%d_real", stages);
    bench_line(name, real_time, "s");
    (void)snprintf(name, sizeof name, "network.multiplier_%d_real_steps", stages);
    bench_line(name, real_steps, "steps");
    (void)snprintf(name, sizeof name, "network.multiplier_%d_real_of_ideal", stages);
    bench_line(name, real_time / ideal_time, "ratio");
}

/* --- a ladder --- */

/* Of ideal diodes, over two periods: each goes over by itself, so that there are many modes. */
static void bench_diode_ladder(int count)
{
    const RunOptions options = {.duration = 2e-3, .every = 1e-5};
    Text text = {0};
    char name[80];

    text_add(&text, "vsource V n0 0 10*sin(2*pi*1e3*t)\n");
    for (int k = 1; k <= count; k++)
        text_addf(&text,
                  "resistor R%d n%d n%d 10\ndiode D%d n%d m%d\ncapacitor C%d m%d 0 0.1 uF\n"
                  "resistor L%d m%d 0 1e4\n",
                  k, k - 1, k, k, k, k, k, k, k, k);
    (void)snprintf(name, sizeof name, "network.diode_ladder_%d_ideal", count);
    bench_line(name, run_circuit(name, &text, &options, false).report.wall, "s");
}

/* --- a sampled PWM --- */

/* A current of 12 A or so out of 24 V, by a duty that is sampled every period. */
static Switched sampled_pwm(const char *keys)
{
    const RunOptions options = {.duration = 0.05, .every = 1e-5};
    Text text = {0};

    text_addf(&text,
              "Ts = 1e-4\nvsource V s 0 24\ninductor L s y 1 mH\nresistor R y x 0.8\n"
              "gain c cc 0 of=0.4 k=1 period=Ts\n"
              "switch S x 0 when=t/Ts - floor(t/Ts) < cc.v%s\ndiode D x s%s\ninit L.i = 0\n",
              keys, keys);
    return run_circuit("sampled PWM", &text, &options, false);
}

static void bench_sampled_pwm(void)
{
    double ideal_time = 1e300, real_time = 1e300;

    for (int i = 0; i < 3; i++) {
        ideal_time = fmin(ideal_time, sampled_pwm("").report.wall);
        real_time = fmin(real_time, sampled_pwm(" Ron=0.01 Roff=1e5").report.wall);
    }
    bench_line("network.sampled_pwm_ideal", ideal_time, "s");
    bench_line("network.sampled_pwm_real", real_time, "s");
    bench_line("network.sampled_pwm_real_of_ideal", real_time / ideal_time, "ratio");
}

/* --- side by side --- */

/* rows of numbers between blanks or commas; other lines are passed over */
static Table read_table(const char *path)
{
    Table table = {0};
    char line[400];
    FILE *file = fopen(path, "r");

    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        const char *from = line;
        Row row;
        int count = 0;

        for (char *end; count < 1 + WAVES; count++, from = end) {
            row.at[count] = strtod(from + strspn(from, ", "), &end);
            if (end == from + strspn(from, ", "))
                break;
        }
        if (count == 1 + WAVES)
            LIST_PUSH(table, row);
    }
    if (file != NULL)
        (void)fclose(file);
    return table;
}

/* by a cubic through four rows, from `first` on */
static double interpolated(const Table *table, int first, double t, int wave)
{
    double sum = 0.0;

    for (int i = first; i < first + 4; i++) {
        double weight = table->at[i].at[wave];

        for (int j = first; j < first + 4; j++)
            if (j != i)
                weight *= (t - table->at[j].at[0]) / (table->at[i].at[0] - table->at[j].at[0]);
        sum += weight;
    }
    return sum;
}

/* largest difference, relative to each wave's largest value; ngspice's table begins behind 0 */
static double error_of(const Table *exact, const Table *table)
{
    double worst = 0.0;

    if (table->count < 4)
        return NAN;
    for (int wave = 1; wave <= WAVES; wave++) {
        double off = 0.0, size = 0.0;
        int row = 0;

        for (int i = 1; i < exact->count; i++) {
            double t = exact->at[i].at[0];

            while (row < table->count - 4 && table->at[row + 2].at[0] < t)
                row++;
            off = fmax(off, fabs(interpolated(table, row, t, wave) - exact->at[i].at[wave]));
            size = fmax(size, fabs(exact->at[i].at[wave]));
        }
        worst = fmax(worst, off / size);
    }
    return worst;
}

typedef struct Taken {
    double seconds, error;
} Taken;

/* what a command that writes `path` takes; the table is handed on where it is wanted */
static Taken take(const char *command, const char *path, const Table *exact, Table *out)
{
    double began = clock_now();
    Taken taken = {NAN, NAN};
    Table table;

    (void)remove(path);
    if (!shell(command))
        (void)printf("# %s\n", command);
    taken.seconds = clock_now() - began;
    table = read_table(path);
    if (exact != NULL)
        taken.error = error_of(exact, &table);
    if (out != NULL)
        *out = table;
    else
        LIST_FREE(table);
    return taken;
}

/* the program's run at a tolerance; `out` NULL: only measured */
static Taken take_program(const char *scripts, const char *program, double tolerance,
                          const Table *exact, Table *out)
{
    Text command = {0};
    Taken taken = {NAN, NAN};

    text_addf(
        &command,
        "'%s/../tests/oracle/spice/ladder' ct %d | sed 's/rtol=.*/rtol=%g atol=%g/' >ladder.ct",
        scripts, LONG, tolerance, tolerance);
    if (shell(command.at)) {
        text_free(&command);
        text_addf(&command, "'%s' -q ladder.ct >ladder.log 2>&1", program);
        taken = take(command.at, "ladder.csv", exact, out);
    }
    text_free(&command);
    return taken;
}

/* ngspice in `steps` equal steps to an output */
static Taken take_ngspice(const char *scripts, int steps, const Table *exact)
{
    double every = exact->at[1].at[0] - exact->at[0].at[0];
    Text command = {0};
    Taken taken = {NAN, NAN};

    text_addf(&command,
              "'%s/../tests/oracle/spice/ladder' cir %d | sed -e 's/^.param h=.*/.param h=%.9g/' "
              "-e '1a .options trtol=1e12 reltol=1e-6 chgtol=1e-25' "
              "-e '/^.control/a set numdgt=15 wr_singlescale' >ladder.cir",
              scripts, LONG, every / steps);
    if (shell(command.at))
        taken = take("ngspice -n -b ladder.cir >ladder.log 2>&1 </dev/null || :", "ladder.out",
                     exact, NULL);
    text_free(&command);
    return taken;
}

static void line_of(const char *who, double which, const char *what, double value, const char *unit)
{
    char name[80];

    (void)snprintf(name, sizeof name, "network.ladder_%d_%s_%g_%s", LONG, who, which, what);
    bench_line(name, value, unit);
}

/* of runs that are at least so right; infinite: there is none */
static double least_time(const Taken *runs, int count, double error)
{
    double least = INFINITY;

    for (int i = 0; i < count; i++)
        if (runs[i].error <= error)
            least = fmin(least, runs[i].seconds);
    return least;
}

static void side_by_side(const char *scripts, const char *program)
{
    static const double tolerances[] = {1e-3, 1e-4, 1e-6};
    static const int steps[] = {15, 45, 135};
    Table exact = {0};
    Taken ours[COUNT(tolerances)];
    Taken theirs = {NAN, NAN};

    (void)take_program(scripts, program, 1e-11, NULL, &exact);
    if (exact.count < 4) {
        printf("# no run of the ladder\n");
        LIST_FREE(exact);
        return;
    }
    for (int i = 0; i < COUNT(tolerances); i++) {
        ours[i] = take_program(scripts, program, tolerances[i], &exact, NULL);
        line_of("rtol", tolerances[i], "time", ours[i].seconds, "s");
        line_of("rtol", tolerances[i], "error", ours[i].error, "of_largest");
    }
    if (shell("command -v ngspice >/dev/null")) {
        for (int i = 0; i < COUNT(steps); i++) {
            theirs = take_ngspice(scripts, steps[i], &exact);
            line_of("ngspice", steps[i], "time", theirs.seconds, "s");
            line_of("ngspice", steps[i], "error", theirs.error, "of_largest");

            const double least = least_time(ours, COUNT(tolerances), theirs.error);

            if (least < INFINITY)
                line_of("ngspice", steps[i], "times", theirs.seconds / least, "ours");
        }
    } else {
        printf("# ngspice isn't here\n");
    }
    LIST_FREE(exact);
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: bench_network SCRIPTS PROGRAM\n");
        return 2;
    }
    bench_ladder(argv[1], 250);
    bench_ladder(argv[1], 500);
    bench_ladder(argv[1], LONG);
    bench_diodes(argv[1], LONG);
    bench_stiff(LONG);
    bench_converter();
    bench_sampled_pwm();
    bench_diode_ladder(200);
    bench_multiplier(3, 3);
    bench_multiplier(10, 3);
    bench_multiplier(30, 1);
    side_by_side(argv[1], argv[2]);
    return 0;
}
