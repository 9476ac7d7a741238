/* test_host.c: runs that a program takes part in, against the exact motion between its instants */
#include "session_kit.h"

#include <math.h>

#define SLIDE "scene planar\nbody m mass=2 inertia=0\nprismatic s ground m axis=x\n"
#define SET   "input U1 u 0 period=10 ms\nactuator a s force=U1.v\ninit s = 1\n"

enum { CALLS = 2000 };

/* what a program was told, and does: a force of gains times what it is told */
typedef struct Program {
    double gain[2], stop_at;
    int inputs, rows;
    double times[CALLS], values[CALLS][2];
    double row_times[CALLS], row_values[CALLS];
} Program;

static bool set_force(void *context, const char *name, double t, const double *values,
                      double *value)
{
    Program *p = context;

    EXPECT_TEXT(name, "U1");
    if (p->inputs < CALLS) {
        p->times[p->inputs] = t;
        memcpy(p->values[p->inputs++], values, 2 * sizeof(double));
    }
    *value = -p->gain[0] * values[0] - p->gain[1] * values[1];
    return false;
}

static bool see_row(void *context, double t, const double *values)
{
    Program *p = context;

    if (p->rows < CALLS) {
        p->row_times[p->rows] = t;
        p->row_values[p->rows++] = values[0];
    }
    return t >= p->stop_at;
}

typedef struct Loop {
    Kit kit;
    ct_cursor cursor;
    ct_statement *items;
    const ct_expression *list[8];
    Program program;
    ct_run_options options;
} Loop;

static Loop *loop_new(const char *model, const char *items)
{
    Loop *l = calloc(1, sizeof *l);

    l->kit = kit_new();
    EXPECT_DONE(&l->kit, model);
    l->cursor = (ct_cursor){.text = items, .line = 1};
    EXPECT(ct_parse(&l->cursor, false, &l->items, &l->kit.error) == CT_OK);
    for (int i = 0; i < ct_operand_count(l->items); i++)
        l->list[i] = ct_operand(l->items, i);
    l->program = (Program){.gain = {4, 3}, .stop_at = INFINITY};
    l->options = (ct_run_options){.duration = 2,
                                  .every = 0.05,
                                  .items = l->list,
                                  .item_count = ct_operand_count(l->items),
                                  .context = &l->program,
                                  .row = see_row,
                                  .input = set_force};
    return l;
}

static ct_status loop_run(Loop *l)
{
    return ct_simulate(l->kit.session, &l->options, &l->kit.error);
}

static void loop_free(Loop *l)
{
    ct_statement_free(l->items);
    kit_free(&l->kit);
    free(l);
}

/* (s, s') of 2 kg at t, a force held from each 10 ms to the next; `from`: only from then on */
static void exact(double t, double gain, double damping, double s[2])
{
    const double h = 0.01;

    s[0] = 1;
    s[1] = 0;
    for (int k = 0; t > 1e-12; k++) {
        const double a = (-gain * s[0] - damping * s[1]) / 2, d = fmin(h, t);

        s[0] += d * s[1] + d * d / 2 * a;
        s[1] += d * a;
        t -= d;
    }
}

/* --- inputs --- */

static void program_closes_the_loop(void)
{
    static const char *const methods[] = {NULL, "dop853", "radau", "bdf", "rk4", "symplectic"};

    for (int k = 0; k < (int)(sizeof methods / sizeof *methods); k++) {
        Loop *l = loop_new(SLIDE SET, "table s s'");
        double s[2];

        l->options.method = methods[k];
        EXPECT(loop_run(l) == CT_OK);
        EXPECT(l->program.inputs == 200);
        EXPECT(l->program.rows == 41);
        for (int i = 0; i < l->program.inputs; i++) {
            exact(0.01 * i, 4, 3, s);
            EXPECT_NEAR(l->program.times[i], 0.01 * i, 1e-12);
            EXPECT_NEAR(l->program.values[i][0], s[0], 1e-6);
            EXPECT_NEAR(l->program.values[i][1], s[1], 1e-6);
        }
        for (int i = 0; i < l->program.rows; i++) {
            exact(0.05 * i, 4, 3, s);
            EXPECT_NEAR(l->program.row_values[i], s[0], 1e-6);
        }
        loop_free(l);
    }
}

/* what is asked for afterwards, between rows too, is of the inputs as they were set */
static void what_was_set_stays_with_the_run(void)
{
    Loop *l = loop_new(SLIDE SET, "table s s'");
    const int asked = l->program.inputs;
    double s[2];

    EXPECT(loop_run(l) == CT_OK);
    for (int i = 0; i < 37; i++) {
        const double t = 0.0531 * i;
        char text[64];

        (void)snprintf(text, sizeof text, "s at %.17g", t);
        exact(t, 4, 3, s);
        EXPECT_NEAR(kit_value(&l->kit, text), s[0], 1e-8);
    }
    exact(0.48, 4, 3, s); /* the value that holds from 0.48 s on */
    EXPECT_NEAR(kit_value(&l->kit, "a.effort at 0.487"), -4 * s[0] - 3 * s[1], 1e-8);
    EXPECT_NEAR(kit_value(&l->kit, "U1.v at 0.487"), -4 * s[0] - 3 * s[1], 1e-8);
    EXPECT(asked == 0);
    EXPECT(l->program.inputs == 200);
    loop_free(l);
}

/* a second run at a tenth of the tolerance has the same inputs, and nobody sees its rows */
static void error_estimate_asks_nobody(void)
{
    Loop *l = loop_new(SLIDE SET, "table s s'");
    ct_figures figures;

    l->options.check = true;
    EXPECT(loop_run(l) == CT_OK);
    EXPECT(l->program.inputs == 200);
    EXPECT(l->program.rows == 41);
    EXPECT(ct_run_figures(l->kit.session, 0, &figures));
    EXPECT(figures.global_error < 1e-7);
    loop_free(l);
}

/* the first run stays as it was when another program goes on from its end */
static void resumed_run_goes_on(void)
{
    Loop *l = loop_new(SLIDE SET, "table s s'");
    double s[2], v;

    l->options.duration = 1;
    EXPECT(loop_run(l) == CT_OK);
    l->options.resumes = true;
    l->program.gain[0] = l->program.gain[1] = 0;
    EXPECT(loop_run(l) == CT_OK);
    exact(1, 4, 3, s);
    v = s[1];
    EXPECT_NEAR(kit_value(&l->kit, "s at 1.777"), s[0] + 0.777 * v, 1e-8);
    exact(0.333, 4, 3, s);
    EXPECT_NEAR(kit_value(&l->kit, "s at 0.333"), s[0], 1e-8);
    EXPECT(l->program.inputs == 200);
    EXPECT_DONE(&l->kit, "resume 1\n"); /* by nobody: what was set last is held */
    EXPECT_NEAR(kit_value(&l->kit, "s'"), v, 1e-9);
    loop_free(l);
}

/* an input goes on through the modes of ideal diodes: C is charged through one, never discharged */
static void inputs_go_on_where_diodes_switch(void)
{
    Loop *l = loop_new("input U1 a 0 period=1 ms\ndiode D1 a b Vf=0\nresistor R1 b c 1 ohm\n"
                       "capacitor C1 c 0 1 mF\n",
                       "table C1.v t");
    double v = 0;

    l->options.duration = 0.02;
    l->options.every = 1e-4;
    l->program.gain[0] = -0.5;
    l->program.gain[1] = -200; /* 0.5 v + 200 t: rises, and falls below v once v > 400 t */
    EXPECT(loop_run(l) == CT_OK);
    for (int k = 0; k < 20; k++) {
        const double u = 0.5 * v + 200 * 0.001 * k;

        EXPECT_NEAR(l->program.values[k][0], v, 1e-6 * (1 + v));
        v = u > v ? u + (v - u) * exp(-1) : v;
    }
    EXPECT_NEAR(kit_value(&l->kit, "C1.v"), v, 1e-6 * v);
    loop_free(l);
}

static void nobody_sets_an_input_of_the_shell(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDE "input U1 u 0 period=0.1 initial=6\nactuator a s force=U1.v\n"
                            "simulate 2\n");
    EXPECT_NEAR(kit_value(&kit, "s"), 6, 1e-8);
    kit_free(&kit);
}

/* --- stopping --- */

static void row_stops_the_run(void)
{
    Loop *l = loop_new(SLIDE SET, "table s s'");
    ct_figures figures;

    l->program.stop_at = 0.42;
    EXPECT(loop_run(l) == CT_STOPPED);
    EXPECT_HOLDS(l->kit.error.message, "stopped at t = 0.45 s");
    EXPECT(ct_run_figures(l->kit.session, 0, &figures));
    EXPECT(figures.rows == 10);
    EXPECT(figures.stopped);
    EXPECT_NEAR(figures.to, 0.45, 1e-12);
    EXPECT_NEAR(l->program.row_times[9], 0.45, 1e-12);
    EXPECT(l->program.rows == 10);
    loop_free(l);
}

static void free_flight_stops_within_a_step(void)
{
    Loop *l = loop_new(SLIDE "init s' = 3\n", "table s");
    ct_figures figures;

    l->program.stop_at = 0.6;
    EXPECT(loop_run(l) == CT_STOPPED);
    EXPECT(ct_run_figures(l->kit.session, 0, &figures));
    EXPECT_NEAR(figures.to, 0.6, 1e-9);
    EXPECT_NEAR(kit_value(&l->kit, "s"), 1.8, 1e-9);
    loop_free(l);
}

static bool set_nan(void *context, const char *name, double t, const double *values, double *value)
{
    (void)context;
    (void)name;
    (void)values;
    *value = t > 0.5 ? NAN : 1;
    return t > 0.9;
}

static bool stop_input(void *context, const char *name, double t, const double *values,
                       double *value)
{
    return set_nan(context, name, t / 2, values, value) || t > 0.705;
}

static void input_stops_the_run(void)
{
    Loop *l = loop_new(SLIDE SET, "table s");

    l->options.input = stop_input;
    EXPECT(loop_run(l) == CT_STOPPED);
    EXPECT_HOLDS(l->kit.error.message, "stopped at t = 0.71 s");
    loop_free(l);
}

static void wrong_calls_are_refused(void)
{
    Loop *l = loop_new(SLIDE SET, "table s s'");

    l->options.input = set_nan;
    EXPECT(loop_run(l) == CT_FAILED);
    EXPECT_HOLDS(l->kit.error.message, "U1 was set to no number at t = 0.51 s");
    l->options.input = set_force;
    l->options.duration = -1;
    EXPECT(loop_run(l) == CT_FAILED);
    EXPECT_HOLDS(l->kit.error.message, "a run takes a duration above 0");
    l->options.duration = NAN;
    EXPECT(loop_run(l) == CT_FAILED);
    l->options.duration = 1;
    l->options.rtol = NAN;
    EXPECT(loop_run(l) == CT_FAILED);
    l->options.rtol = 0;
    l->options.method = "dop583";
    EXPECT(loop_run(l) == CT_FAILED);
    EXPECT_HOLDS(l->kit.error.hint, "dop853");
    loop_free(l);

    l = loop_new(SLIDE SET, "table s nobody");
    EXPECT(loop_run(l) == CT_FAILED);
    EXPECT_HOLDS(l->kit.error.message, "nobody");
    EXPECT(l->program.rows == 0);
    l->options.item_count = 1;
    l->options.resumes = true;
    EXPECT(loop_run(l) == CT_FAILED);
    EXPECT_HOLDS(l->kit.error.message, "there is no run to go on with");
    loop_free(l);
}

/* --- columns --- */

static void columns_have_names_and_units(void)
{
    static const char *const names[] = {"t", "s", "s'", "s", "a.effort", "m.x + s"};
    static const char *const units[] = {"s", "m", "m/s", "mm", "N", "m"};
    Loop *l = loop_new(SLIDE SET, "table s s' s [mm] a.effort (m.x + s)");
    ct_column *columns;
    int count, rows;

    l->options.item_count = 2;
    EXPECT(loop_run(l) == CT_OK);
    EXPECT(ct_columns(l->kit.session, l->list, 5, 0, &columns, &count, &rows, &l->kit.error) ==
           CT_OK);
    EXPECT(count == 6);
    EXPECT(rows == 41);
    EXPECT(columns[count].name == NULL);
    for (int c = 0; c < count; c++) {
        EXPECT_HOLDS(columns[c].name, names[c]);
        EXPECT_TEXT(columns[c].unit, units[c]);
    }
    for (int r = 0; r < rows; r++) {
        EXPECT_NEAR(columns[1].values[r], l->program.row_values[r], 1e-12);
        EXPECT_NEAR(columns[3].values[r], 1000 * columns[1].values[r], 1e-9);
        EXPECT_NEAR(columns[5].values[r], 2 * columns[1].values[r], 1e-12);
    }
    ct_columns_free(columns);
    EXPECT(ct_columns(l->kit.session, NULL, 0, 0, &columns, &count, &rows, &l->kit.error) == CT_OK);
    EXPECT(count == 4);
    EXPECT_TEXT(columns[3].name, "U1.held");
    EXPECT_TEXT(columns[3].unit, "V");
    EXPECT_TEXT(columns[2].name, "s'");
    EXPECT_TEXT(columns[2].unit, "m/s");
    ct_columns_free(columns);
    ct_columns_free(NULL);
    loop_free(l);
}

int main(void)
{
    RUN(program_closes_the_loop);
    RUN(what_was_set_stays_with_the_run);
    RUN(error_estimate_asks_nobody);
    RUN(resumed_run_goes_on);
    RUN(inputs_go_on_where_diodes_switch);
    RUN(nobody_sets_an_input_of_the_shell);
    RUN(row_stops_the_run);
    RUN(free_flight_stops_within_a_step);
    RUN(input_stops_the_run);
    RUN(wrong_calls_are_refused);
    RUN(columns_have_names_and_units);
    return test_end();
}
