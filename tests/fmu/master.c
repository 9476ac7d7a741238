/* master.c: a simulator for one FMU
 *
 *     master FILE.fmu exchange|simulation REFERENCE.csv TOLERANCE
 *         runs it and compares what the columns say, to ten tolerances; a column of an input is
 *         what it is given, held from row to row
 *     master FILE.fmu behind REFERENCE.csv TOLERANCE
 *         co-simulation; compares what outputs are once the inputs of a row are set
 *     master FILE.fmu marked OUTPUT,...
 *         of the outputs those alone have no derivatives
 *     master FILE.fmu crude|drifting REFERENCE.csv TOLERANCE
 *         model exchange by even steps of the midpoint rule, which leave the constraints: puts
 *         states back when it is asked to, or never does
 *     master FILE.fmu rules SEED [END]
 *         calls it in orders at random that the standard allows, and some that it doesn't, in steps
 *         of at most a twentieth of the time END
 *
 * Model exchange is by the pair of Dormand and Prince, which knows nothing of what is inside. */
#include "importer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STAGES = 7, COLUMNS = 200, MOST_EVENTS = 20000, CRUDE = 40 /* steps a row */ };
#define LOCATED 1e-13 /* of 1 + |t|: events */

static int bad;

static void report_error(const char *what, double t, double is, double should)
{
    if (bad++ < 5)
        printf("%s at t = %.17g: %.17g instead of %.17g\n", what, t, is, should);
}

static void expect_ok(int status, const Instance *in, const char *what)
{
    if (status == OK)
        return;
    printf("%s: status %d: %s\n", what, status, in->unit->said);
    exit(1);
}

/* --- model exchange --- */

typedef struct Run {
    Instance in;
    int n, indicators;
    double t, step, tolerance;
    double *x, *rate, *at, *next, *error, *sign, *sign_next, *k[STAGES];
    Discrete event;
    bool ends;
    int events, steps, put_back;
} Run;

static double *numbers(int count)
{
    double *made = calloc((size_t)count + 1, sizeof *made);

    if (made == NULL)
        exit(1);
    return made;
}

static Run run_new(Unit *unit, double tolerance)
{
    Run run = {.in = instance_new(unit, "run", false),
               .n = unit->state_count,
               .indicators = unit->indicator_count,
               .tolerance = tolerance};

    if (run.in.handle == NULL)
        exit(1);
    run.x = numbers(run.n);
    run.rate = numbers(run.n);
    run.at = numbers(run.n);
    run.next = numbers(run.n);
    run.error = numbers(run.n);
    run.sign = numbers(run.indicators);
    run.sign_next = numbers(run.indicators);
    for (int i = 0; i < STAGES; i++)
        run.k[i] = numbers(run.n);
    return run;
}

static void run_free(Run *run)
{
    free(run->x), free(run->rate), free(run->at), free(run->next), free(run->error);
    free(run->sign), free(run->sign_next);
    for (int i = 0; i < STAGES; i++)
        free(run->k[i]);
    instance_free(&run->in);
}

static void rates(Run *run, double t, const double *x, double *out)
{
    expect_ok(instance_set_time(&run->in, t), &run->in, "SetTime");
    expect_ok(instance_set_states(&run->in, x), &run->in, "SetContinuousStates");
    expect_ok(instance_rates(&run->in, out), &run->in, "GetDerivatives");
}

/* events until there are no more, and on in continuous time */
static void settle(Run *run)
{
    int rounds = 0;

    do
        expect_ok(instance_update(&run->in, &run->event), &run->in, "NewDiscreteStates");
    while (run->event.again && ++rounds < 100);
    run->ends = run->ends || run->event.ends;
    expect_ok(instance_enter_continuous(&run->in), &run->in, "EnterContinuousTimeMode");
    expect_ok(instance_states(&run->in, run->x), &run->in, "GetContinuousStates");
    if (run->indicators > 0)
        expect_ok(instance_indicators(&run->in, run->sign), &run->in, "GetEventIndicators");
    rates(run, run->t, run->x, run->k[0]);
    if (++run->events > MOST_EVENTS) {
        printf("events without end at t = %.17g\n", run->t);
        exit(1);
    }
}

/* `next` one step on; its error in tolerances */
static double take(Run *run, double h)
{
    static const double a[STAGES][STAGES] = {
        {0},
        {1.0 / 5},
        {3.0 / 40, 9.0 / 40},
        {44.0 / 45, -56.0 / 15, 32.0 / 9},
        {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
        {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
        {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static const double c[STAGES] = {0, 0.2, 0.3, 0.8, 8.0 / 9, 1, 1};
    static const double e[STAGES] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                     -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    double sum = 0;

    for (int s = 1; s < STAGES; s++) {
        for (int i = 0; i < run->n; i++) {
            run->next[i] = run->x[i];
            for (int j = 0; j < s; j++)
                run->next[i] += h * a[s][j] * run->k[j][i];
        }
        rates(run, run->t + c[s] * h, run->next, run->k[s]);
    }
    for (int i = 0; i < run->n; i++) {
        double error = 0;
        const double size = fmax(fabs(run->x[i]), fabs(run->next[i])) + 0.01;

        for (int j = 0; j < STAGES; j++)
            error += h * e[j] * run->k[j][i];
        sum += pow(error / (0.02 * run->tolerance * size), 2);
    }
    return run->n > 0 ? sqrt(sum / run->n) : 0;
}

static bool has_crossed(Run *run)
{
    if (run->indicators == 0)
        return false;
    expect_ok(instance_indicators(&run->in, run->sign_next), &run->in, "GetEventIndicators");
    for (int i = 0; i < run->indicators; i++)
        if ((run->sign_next[i] > 0) != (run->sign[i] > 0))
            return true;
    return false;
}

/* the step again, up to just behind the first sign that changes */
static double locate(Run *run, double h)
{
    double low = 0, high = h;

    while (high - low > LOCATED * (1 + fabs(run->t))) {
        const double middle = (low + high) / 2;

        (void)take(run, middle);
        rates(run, run->t + middle, run->next, run->error);
        *(has_crossed(run) ? &high : &low) = middle;
    }
    (void)take(run, high);
    rates(run, run->t + high, run->next, run->error);
    return high;
}

static void step_on(Run *run, double end)
{
    bool is_event = false, wants = false, ends = false;
    const bool meets = run->event.has_next && run->event.next <= end;
    const double most = (meets ? run->event.next : end) - run->t;
    double h, error, now;

    for (;;) {
        h = run->step < most ? run->step : most;
        error = take(run, h);
        if (error <= 1)
            break;
        run->step = h * fmax(0.2, 0.9 * pow(error, -0.2));
        if (run->step < 1e-15 * (1 + fabs(run->t))) {
            printf("steps get too short at t = %.17g\n", run->t);
            exit(1);
        }
    }
    if (h < most || error > 0.5)
        run->step = h * fmin(5, 0.9 * pow(error + 1e-10, -0.2));
    rates(run, run->t + h, run->next, run->error);
    is_event = has_crossed(run);
    if (is_event)
        h = locate(run, h);
    now = h < most ? run->t + h : meets ? run->event.next : end;
    is_event = is_event || (meets && now >= run->event.next);
    run->t = now;
    memcpy(run->x, run->next, (size_t)run->n * sizeof(double));
    rates(run, run->t, run->x, run->k[0]);
    expect_ok(instance_step_done(&run->in, &wants, &ends), &run->in, "CompletedIntegratorStep");
    run->steps++;
    run->put_back += wants;
    run->ends = run->ends || ends;
    if (is_event || wants) {
        expect_ok(instance_enter_events(&run->in), &run->in, "EnterEventMode");
        settle(run);
    }
}

static void run_begin(Run *run)
{
    run->step = 1e-5;
    expect_ok(instance_initialise(&run->in, run->tolerance, 0), &run->in, "initialisation");
    expect_ok(instance_initialised(&run->in), &run->in, "ExitInitializationMode");
    settle(run);
}

/* --- a reference --- */

typedef struct Reference {
    int columns, rows;
    char *names[COLUMNS];
    double *values;
    double size[COLUMNS];
} Reference;

/* a name, between quotes where it holds a comma */
static char *cut_name(char **at)
{
    char *name = *at, *end;

    if (*name == '"') {
        name++;
        end = strchr(name, '"');
        *at = end + 1;
    } else {
        end = name + strcspn(name, ",\n");
        *at = end;
    }
    if (**at != '\0')
        (*at)++;
    *end = '\0';
    return name;
}

static Reference reference_read(const char *path)
{
    static char head[20000];
    Reference r = {0};
    FILE *file = fopen(path, "r");
    double value;
    int room = 0;

    if (file == NULL || fgets(head, sizeof head, file) == NULL) {
        printf("can't read %s\n", path);
        exit(1);
    }
    r.values = numbers(COLUMNS);
    room = COLUMNS;
    for (char *at = head; *at != '\0' && r.columns < COLUMNS;)
        r.names[r.columns++] = cut_name(&at);
    if (r.columns == 0)
        exit(1);
    for (int i = 0; fscanf(file, i % r.columns == r.columns - 1 ? "%lf" : "%lf ,", &value) == 1;
         i++) {
        if (i == room)
            r.values = realloc(r.values, (size_t)(room *= 2) * sizeof(double));
        if (r.values == NULL)
            exit(1);
        r.values[i] = value;
        r.rows = (i + 1) / r.columns;
        r.size[i % r.columns] = fmax(r.size[i % r.columns], fabs(value));
    }
    fclose(file);
    return r;
}

/* rows at an instant are more than one where something jumps: those say nothing of it */
static bool is_row(const Reference *r, int row)
{
    const double *t = r->values + row * r->columns;

    return (row == 0 || t[0] - t[-r->columns] > 1e-9) &&
           (row == r->rows - 1 || t[r->columns] - t[0] > 1e-9);
}

/* a column of the reference that is an input; NULL: another one */
static const Variable *input_of(const Unit *unit, const Reference *r, int column)
{
    const Variable *v = unit_variable(unit, r->names[column]);

    return v != NULL && strcmp(v->causality, "input") == 0 ? v : NULL;
}

static void compare(Instance *in, const Reference *r, int row, double tolerance)
{
    for (int c = 1; c < r->columns; c++) {
        const Variable *v = unit_variable(in->unit, r->names[c]);
        const double should = r->values[row * r->columns + c];
        double is = 0;

        if (v == NULL) {
            printf("there is no variable '%s'\n", r->names[c]);
            exit(1);
        }
        if (input_of(in->unit, r, c) != NULL)
            continue;
        expect_ok(instance_get(in, &v->reference, 1, &is), in, "GetReal");
        if (!(fabs(is - should) <= 10 * tolerance * (1 + r->size[c])))
            report_error(r->names[c], r->values[row * r->columns], is, should);
    }
}

/* Whether an input is another from a row on: then outputs may jump there. */
static bool is_other(const Unit *unit, const Reference *r, int row)
{
    for (int c = 1; c < r->columns && row > 0; c++) {
        const double *value = r->values + row * r->columns + c;

        if (input_of(unit, r, c) != NULL && fabs(value[0] - value[-r->columns]) > 0)
            return true;
    }
    return false;
}

/* Inputs hold what a row says to the next one. */
static void hold(Instance *in, const Reference *r, int row)
{
    for (int c = 1; c < r->columns; c++) {
        const Variable *v = input_of(in->unit, r, c);

        if (v != NULL)
            expect_ok(instance_set(in, &v->reference, 1, r->values + row * r->columns + c), in,
                      "SetReal");
    }
}

static void exchange(Unit *unit, const Reference *r, double tolerance)
{
    Run run = run_new(unit, tolerance);

    run.step = 1e-5;
    expect_ok(instance_initialise(&run.in, tolerance, 0), &run.in, "initialisation");
    hold(&run.in, r, 0);
    expect_ok(instance_initialised(&run.in), &run.in, "ExitInitializationMode");
    settle(&run);
    for (int row = 0; row < r->rows && !run.ends; row++) {
        while (run.t < r->values[row * r->columns] && !run.ends)
            step_on(&run, r->values[row * r->columns]);
        if (is_row(r, row) && !is_other(unit, r, row) && !run.ends)
            compare(&run.in, r, row, tolerance);
        if (is_other(unit, r, row) && !run.ends) {
            expect_ok(instance_enter_events(&run.in), &run.in, "EnterEventMode");
            hold(&run.in, r, row);
            settle(&run);
        }
    }
    if (run.ends && fabs(run.t - r->values[(r->rows - 1) * r->columns]) > 10 * tolerance)
        report_error("it ends", run.t, run.t, r->values[(r->rows - 1) * r->columns]);
    expect_ok(instance_terminate(&run.in), &run.in, "Terminate");
    printf("%d steps, %d events, %d times put back\n", run.steps, run.events, run.put_back);
    run_free(&run);
}

/* Even steps between rows. A unit that is asked for 1e-6 asks for event mode on its way. */
static void crude(Unit *unit, const Reference *r, double tolerance, bool is_put_back)
{
    Run run = run_new(unit, 1e-6);

    run_begin(&run);
    for (int row = 1; row < r->rows; row++) {
        const double from = run.t, span = r->values[row * r->columns] - from;

        for (int k = 1; k <= CRUDE; k++) {
            const double h = span / CRUDE;
            bool wants = false, ends = false;

            for (int i = 0; i < run.n; i++)
                run.at[i] = run.x[i] + h / 2 * run.k[0][i];
            rates(&run, run.t + h / 2, run.at, run.k[1]);
            for (int i = 0; i < run.n; i++)
                run.x[i] += h * run.k[1][i];
            run.t = from + span * k / CRUDE;
            rates(&run, run.t, run.x, run.k[0]);
            expect_ok(instance_step_done(&run.in, &wants, &ends), &run.in,
                      "CompletedIntegratorStep");
            run.put_back += wants;
            if (wants && is_put_back) {
                expect_ok(instance_enter_events(&run.in), &run.in, "EnterEventMode");
                settle(&run);
            }
        }
        compare(&run.in, r, row, tolerance);
    }
    printf("put back %d times\n", run.put_back);
    bad += run.put_back == 0;
    run_free(&run);
}

/* `is_behind`: compared behind what a row sets, before a step */
static void simulation(Unit *unit, const Reference *r, double tolerance, bool is_behind)
{
    Instance in = instance_new(unit, "run", true);
    double t = 0;
    bool ends = false;

    expect_ok(instance_initialise(&in, tolerance, 0), &in, "initialisation");
    hold(&in, r, 0);
    expect_ok(instance_initialised(&in), &in, "ExitInitializationMode");
    for (int row = 0; row < r->rows && !ends; row++) {
        const double to = r->values[row * r->columns];
        double reached = to;

        if (to > t)
            expect_ok(instance_do_step(&in, t, to - t, &ends, &reached), &in, "DoStep");
        t = to;
        if (ends && fabs(reached - r->values[(r->rows - 1) * r->columns]) > 10 * tolerance)
            report_error("it ends", reached, reached, r->values[(r->rows - 1) * r->columns]);
        if (is_row(r, row) && !is_other(unit, r, row) && !ends && !is_behind)
            compare(&in, r, row, tolerance);
        if (!ends)
            hold(&in, r, row);
        for (int again = 0; again < 2 && is_behind && !ends; again++)
            compare(&in, r, row, tolerance);
    }
    expect_ok(instance_terminate(&in), &in, "Terminate");
    instance_free(&in);
}

/* --- rules --- */

static unsigned long long seed;
static double longest_step = 0.02; /* s */

static double random_number(void) /* 0 ... 1 */
{
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(seed >> 11) / 9007199254740992.0;
}

static void expect_same(Instance *a, Instance *b, double t)
{
    Unit *unit = a->unit;

    for (int i = 0; i < unit->variable_count; i++) {
        double x = 0, y = 0;

        expect_ok(instance_get(a, &unit->variables[i].reference, 1, &x), a, "GetReal");
        expect_ok(instance_get(b, &unit->variables[i].reference, 1, &y), b, "GetReal");
        if (x < y || x > y || isnan(x) != isnan(y))
            report_error(unit->variables[i].name, t, x, y);
    }
}

/* Two instances in turns, one of them thrown back again and again: they stay the same. */
static void interleaved(Unit *unit)
{
    Instance a = instance_new(unit, "a", true), b = instance_new(unit, "b", true);
    double t = 0;

    for (Instance *in = &a; in != NULL; in = in == &a ? &b : NULL) {
        expect_ok(instance_initialise(in, 1e-6, 0), in, "initialisation");
        expect_ok(instance_initialised(in), in, "ExitInitializationMode");
    }
    for (int i = 0; i < 30; i++) {
        const double step = longest_step * random_number();
        void *kept = NULL;
        bool ends_a, ends_b;
        double reached;

        expect_ok(instance_keep(&a, &kept), &a, "GetFMUstate");
        expect_ok(instance_do_step(&a, t, 2.5 * longest_step * random_number(), &ends_a, &reached),
                  &a, "DoStep");
        if (random_number() < 0.5)
            expect_ok(instance_through_bytes(&a, &kept), &a, "SerializeFMUstate");
        expect_ok(instance_go_back(&a, kept), &a, "SetFMUstate");
        expect_ok(instance_forget(&a, &kept), &a, "FreeFMUstate");
        expect_ok(instance_do_step(&a, t, step, &ends_a, &reached), &a, "DoStep");
        expect_ok(instance_do_step(&b, t, step, &ends_b, &reached), &b, "DoStep");
        if (ends_a != ends_b)
            report_error("one of two ends", t, ends_a, ends_b);
        expect_same(&a, &b, t);
        if (ends_a || ends_b)
            break;
        t += step;
    }
    instance_free(&a);
    instance_free(&b);
}

/* what derivatives are by: states and inputs in continuous time, parameters in event mode */
typedef struct Knowns {
    unsigned *references;
    int states, count;
} Knowns;

static void put_knowns(Run *run, const Knowns *knowns, const double *values)
{
    const int others = knowns->count - knowns->states;

    if (knowns->states > 0)
        expect_ok(instance_set_states(&run->in, values), &run->in, "SetContinuousStates");
    if (others > 0)
        expect_ok(instance_set(&run->in, knowns->references + knowns->states, others,
                               values + knowns->states),
                  &run->in, "SetReal");
}

/* derivatives of rates and outputs against differences of two sides */
static void derivatives_by(Run *run, const Knowns *knowns)
{
    Unit *unit = run->in.unit;
    const int n = run->n, all = n + unit->output_count, known = knowns->count;
    unsigned *unknowns = calloc((size_t)all + 1, sizeof *unknowns);
    double *up = numbers(all), *down = numbers(all), *exact = numbers(all);
    double *from = numbers(known), *at = numbers(known), *seed_of = numbers(known);
    const double h = 1e-6;
    int status, marked = 0;

    for (int i = 0; i < all; i++)
        unknowns[i] = i < n ? unit->rates[i] : unit->outputs[i - n];
    expect_ok(instance_get(&run->in, knowns->references, known, from), &run->in, "GetReal");
    for (int i = 0; i < known; i++)
        seed_of[i] = (2 * random_number() - 1) * (i < knowns->states ? 1 : fmin(1, fabs(from[i])));
    for (int side = -1; side <= 1; side += 2) {
        for (int i = 0; i < known; i++)
            at[i] = from[i] + side * h * seed_of[i];
        put_knowns(run, knowns, at);
        expect_ok(instance_get(&run->in, unknowns, all, side > 0 ? up : down), &run->in, "GetReal");
    }
    put_knowns(run, knowns, from);
    status =
        instance_derivative(&run->in, unknowns, all, knowns->references, known, seed_of, exact);
    for (int i = 0; i < all; i++)
        marked += i >= n && isnan(exact[i]);
    if (status != WARNING || marked == 0) /* of shares, which a warning tells */
        expect_ok(status, &run->in, "GetDirectionalDerivative");
    for (int i = 0; i < all; i++) {
        const double about = (up[i] - down[i]) / (2 * h);
        const double size = 1 + fabs(exact[i]) + fabs(up[i]) * 1e-3;

        if (!(fabs(about - exact[i]) <= 1e-5 * size) && !(i >= n && isnan(exact[i])))
            report_error("a derivative", run->t, exact[i], about);
    }
    free(unknowns), free(up), free(down), free(exact), free(from), free(at), free(seed_of);
}

static void derivatives(Run *run)
{
    const Unit *unit = run->in.unit;
    Knowns knowns = {calloc((size_t)(run->n + unit->input_count) + 1, sizeof(unsigned)), run->n,
                     run->n + unit->input_count};

    if (knowns.references == NULL)
        exit(1);
    for (int i = 0; i < knowns.count; i++)
        knowns.references[i] = i < run->n ? unit->states[i] : unit->inputs[i - run->n];
    derivatives_by(run, &knowns);
    free(knowns.references);
}

/* An instance of its own, whose events have nothing to put back when parameters were others. */
static void derivatives_by_parameters(Unit *unit)
{
    const Knowns knowns = {unit->parameters, 0, unit->parameter_count};
    Run run = run_new(unit, 1e-6);

    run_begin(&run);
    expect_ok(instance_enter_events(&run.in), &run.in, "EnterEventMode");
    derivatives_by(&run, &knowns);
    run_free(&run);
}

/* what a simulator may do between two steps leaves no trace */
static void disturbed(Unit *unit)
{
    Run run = run_new(unit, 1e-6), other = run_new(unit, 1e-6);

    run_begin(&run);
    run_begin(&other);
    for (int i = 0; i < 60 && !run.ends; i++) {
        const double to = run.t + longest_step * random_number();
        void *kept = NULL;

        expect_ok(instance_keep(&run.in, &kept), &run.in, "GetFMUstate");
        for (int k = 0; k < 4; k++) {
            for (int j = 0; j < run.n; j++)
                run.at[j] = run.x[j] + 0.01 * (random_number() - 0.5);
            rates(&run, run.t + 0.5 * longest_step * random_number(), run.at, run.rate);
            if (run.indicators > 0)
                (void)instance_indicators(&run.in, run.sign_next);
        }
        if (random_number() < 0.5)
            expect_ok(instance_through_bytes(&run.in, &kept), &run.in, "SerializeFMUstate");
        expect_ok(instance_go_back(&run.in, kept), &run.in, "SetFMUstate");
        expect_ok(instance_forget(&run.in, &kept), &run.in, "FreeFMUstate");
        if (unit->has_derivatives && i % 10 == 5)
            derivatives(&run);
        rates(&run, run.t, run.x, run.k[0]);
        while (run.t < to && !run.ends)
            step_on(&run, to);
        while (other.t < to && !other.ends)
            step_on(&other, to);
        for (int j = 0; j < run.n; j++)
            if (!(fabs(run.x[j] - other.x[j]) <= 1e-9 * (1 + fabs(other.x[j]))))
                report_error("a state after a disturbance", run.t, run.x[j], other.x[j]);
    }
    run_free(&run);
    run_free(&other);
}

/* Of the outputs just those among `names`, between commas, have no derivatives by the states. */
static void marked(Unit *unit, const char *names)
{
    Run run = run_new(unit, 1e-6);

    run_begin(&run);
    for (int k = 0; k < unit->variable_count; k++) {
        const Variable *v = &unit->variables[k];
        const char *at = strstr(names, v->name);
        const bool is_named = at != NULL && strchr(",", at[strlen(v->name)]) != NULL;
        double value = 0, one = 1;
        int status;

        if (strcmp(v->causality, "output") != 0)
            continue;
        status = instance_derivative(&run.in, &v->reference, 1, unit->states, 1, &one, &value);
        if (isnan(value) != is_named || status != (is_named ? WARNING : OK))
            report_error(v->name, run.t, value, is_named ? NAN : 0);
        if (instance_get(&run.in, &v->reference, 1, &value) != OK || isnan(value))
            report_error(v->name, run.t, value, 0);
    }
    run_free(&run);
}

static void expect_refused(int status, Unit *unit, int before, const char *what)
{
    if (status < ERROR || unit->messages == before)
        report_error(what, 0, status, ERROR);
}

/* what may not be called there is refused, with a message, and does no harm */
static void refused(Unit *unit)
{
    Instance in = instance_new(unit, "a", false);
    double *x = numbers(unit->state_count), value = 0;
    const unsigned nobody = 1000000;
    int before = unit->messages;
    Discrete event;

    expect_refused(instance_enter_continuous(&in), unit, before, "continuous time at once");
    before = unit->messages;
    expect_refused(instance_update(&in, &event), unit, before, "events at once");
    expect_ok(instance_initialise(&in, 1e-6, 0), &in, "initialisation");
    before = unit->messages;
    expect_refused(instance_set_states(&in, x), unit, before, "states while initialising");
    expect_ok(instance_initialised(&in), &in, "ExitInitializationMode");
    before = unit->messages;
    expect_refused(instance_get(&in, &nobody, 1, &value), unit, before, "an unknown reference");
    expect_ok(instance_reset(&in), &in, "Reset");
    expect_ok(instance_initialise(&in, 1e-6, 0), &in, "initialisation");
    expect_ok(instance_initialised(&in), &in, "ExitInitializationMode");
    expect_ok(instance_terminate(&in), &in, "Terminate");
    before = unit->messages;
    expect_refused(instance_enter_events(&in), unit, before, "events behind the end");
    instance_free(&in);
    strcat(unit->token, "x");
    in = instance_new(unit, "a", false);
    if (in.handle != NULL)
        report_error("an instance of another token", 0, 1, 0);
    unit->token[strlen(unit->token) - 1] = '\0';
    free(x);
}

/* each start value and parameter is what the description says, and can be set and read again */
static void variables(Unit *unit)
{
    Instance in = instance_new(unit, "a", false);

    expect_ok(instance_initialise(&in, 1e-6, 0), &in, "initialisation");
    for (int i = 0; i < unit->variable_count; i++) {
        const Variable *v = &unit->variables[i];
        double value = 0, other;

        if (!v->has_start)
            continue;
        expect_ok(instance_get(&in, &v->reference, 1, &value), &in, "GetReal");
        if (value < v->start || value > v->start)
            report_error(v->name, 0, value, v->start);
        other = value * 1.25 + 0.5;
        expect_ok(instance_set(&in, &v->reference, 1, &other), &in, "SetReal");
        expect_ok(instance_get(&in, &v->reference, 1, &value), &in, "GetReal");
        if (value < other || value > other)
            report_error(v->name, 0, value, other);
    }
    instance_free(&in);
}

int main(int argc, char **argv)
{
    Unit *unit;

    if (argc < 4) {
        fputs("usage: master FILE.fmu exchange|simulation|behind|crude|drifting REFERENCE "
              "TOLERANCE | "
              "FILE.fmu rules SEED [END] | FILE.fmu marked OUTPUT,...\n",
              stderr);
        return 2;
    }
    unit = unit_open(argv[1]);
    if (strcmp(argv[2], "rules") == 0) {
        seed = strtoull(argv[3], NULL, 10);
        if (argc > 4)
            longest_step = fmin(longest_step, strtod(argv[4], NULL) / 20);
        variables(unit);
        refused(unit);
        if (unit->has_simulation)
            interleaved(unit);
        if (unit->has_exchange)
            disturbed(unit);
        if (unit->has_exchange && unit->has_derivatives)
            derivatives_by_parameters(unit);
    } else if (strcmp(argv[2], "marked") == 0)
        marked(unit, argv[3]);
    else {
        const Reference r = reference_read(argv[3]);
        const double tolerance = strtod(argv[4], NULL);

        if (strcmp(argv[2], "exchange") == 0)
            exchange(unit, &r, tolerance);
        else if (strcmp(argv[2], "simulation") == 0)
            simulation(unit, &r, tolerance, false);
        else if (strcmp(argv[2], "behind") == 0)
            simulation(unit, &r, tolerance, true);
        else
            crude(unit, &r, tolerance, strcmp(argv[2], "crude") == 0);
        free(r.values);
    }
    unit_close(unit);
    if (bad > 0)
        printf("%d times\n", bad);
    return bad > 0;
}
