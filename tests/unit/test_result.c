/* test_result.c: a result is const, and read by the reader of its run */
#include "simulate_script.h"

#include "form.h"
#include "simulate/run/result_reader_impl.h"

/* a rectifier of an ideal diode, which has two modes, that an event is counted in */
#define RECTIFIER                                                                                  \
    "vsource V a 0 10*sin(300*t)\ndiode D a b\ncapacitor C b 0 1 mF\nresistor R b 0 40\n"          \
    "event high when=C.v > 8 do=mark\ninit C.v = 2\n"

static Script open_rectifier(void)
{
    Script script;

    script_open(&script, RECTIFIER, &(Changes){0});
    return script;
}

/* what a reader finds in a result, at rows and between them: C.v, D.i, R.i */
enum { ASKED = 3, INSTANTS = 5 };

static void read_values(ResultReader *reader, const Script *script, double out[INSTANTS * ASKED])
{
    static const char *const names[ASKED] = {"C.v", "D.i", "R.i"};
    static const double instants[INSTANTS] = {0, 0.0031, 0.0111, 0.0137, 0.02};
    Expr items[ASKED];
    Diag diag = {0};

    for (int i = 0; i < ASKED; i++)
        items[i] = expr_symbol(system_arena(script->system), names[i], SYMBOL_VARIABLE);
    for (int k = 0; k < INSTANTS; k++)
        EXPECT(result_reader_values_at(reader, items, ASKED, instants[k], out + k * ASKED, &diag) ==
               OK);
}

static void resuming_leaves_the_old_result_as_it_was(void)
{
    Script script = open_rectifier();
    StartValue value = {"C.v", 0, 2, false};
    StartValues start = {1, &value};
    const Event *high = model_event(script.model, 0);
    SimulationInput setting = {.parameter = script_parameter,
                               .context = script.model,
                               .scene = model_scene_source(script.model),
                               .events = &high,
                               .event_count = 1,
                               .start = &start};
    RunOptions options = {.duration = 0.02, .every = 0.001, .rtol = 1e-9};
    ResultReader *reader = NULL;
    Result *resumed = NULL;
    double before[INSTANTS * ASKED], after[INSTANTS * ASKED];
    Diag diag = {0};
    EventRecord once;

    EXPECT(form_system(script.model, &script.system, &diag) == OK);
    EXPECT(run_simulate(script.system, &setting, &options, &script.result, &script.reader, &diag) ==
           OK);
    read_values(script.reader, &script, before);
    once = result_event(script.result, 0);
    options.duration = 0.2;
    EXPECT(run_resume(script.result, &setting, &options, &resumed, &reader, &diag) == OK);
    EXPECT(result_rows(script.result) < result_rows(resumed));
    EXPECT(result_report(script.result)->reached == 0.02);
    EXPECT(result_event(script.result, 0).count == once.count);
    EXPECT(result_event(script.result, 0).times == once.times);
    EXPECT(result_event(resumed, 0).count > once.count);
    read_values(script.reader, &script, after);
    for (int i = 0; i < INSTANTS * ASKED; i++)
        EXPECT_NEAR(after[i], before[i], 1e-12);
    for (int k = 0; k < INSTANTS; k++) /* of the resistor alone */
        EXPECT_NEAR(before[k * ASKED], 40 * before[k * ASKED + 2], 1e-12);
    result_reader_free(script.reader);
    result_free(script.result);
    script.reader = reader;
    script.result = resumed;
    EXPECT_NEAR(value_at(&script, "C.v", 0.0137), before[3 * ASKED], 1e-9);
    script_close(&script);
}

/* the first of its kind; NULL: nothing of the kind is said */
static const Remark *remark_of(const Result *result, RemarkKind kind)
{
    const Remarks *remarks = result_remarks(result);

    for (int i = 0; i < remarks->list.count; i++)
        if (remarks->list.at[i].kind == kind)
            return &remarks->list.at[i];
    return NULL;
}

static void remarks_tell_of_which_part_and_when(void)
{
    Script script;
    const Remark *twice, *left, *started;

    script_open(&script,
                "scene planar\nbody a mass=1 inertia=1\nrevolute h ground a\nrevolute k ground a\n"
                "tree absolute\ninit h = 0.3, h' = 1\nsimulate 1\n",
                &(Changes){0});
    twice = remark_of(script.result, REMARK_REDUNDANT);
    left = remark_of(script.result, REMARK_UNDETERMINED);
    started = remark_of(script.result, REMARK_START_SINGULAR);
    EXPECT(twice != NULL && left != NULL && started == NULL);
    if (twice != NULL && left != NULL) {
        EXPECT_TEXT(twice->what, "k");
        EXPECT_TEXT(twice->more, "x, y");
        EXPECT_TEXT(twice->others, "h");
        EXPECT(left->count == 1);
    }
    EXPECT_TEXT(script_remarks(&script),
                "redundant: k (x, y) repeats h\n"
                "1 degree of freedom without what is redundant; reactions there are not "
                "determined: those reported are the least (minimum norm) of the joints outside the "
                "tree, and depend on it\n");
    script_close(&script);
}

/* Rows of what the state tells are read as they are: nothing is factored, and the values are those
 * of the closed form; accelerations beside them have to be solved for. */
static void rows_of_coordinates_and_speeds_solve_nothing(void)
{
    static const char *const names[] = {"h", "h'", "b.x", "energy.kinetic", "h''"};
    enum { ITEMS = COUNT(names), ROWS = 21 };
    Script script;
    const Motion *motion;
    Expr items[ITEMS];
    double values[ROWS * ITEMS];
    int64_t before;
    Diag diag = {0};

    /* a bar on a pin, with its place as two coordinates more */
    script_open(&script,
                "scene planar\nbody b mass=2 inertia=0.5\narm p b [-1, 0]\nrevolute h ground p\n"
                "tree translation b\ntree rotation h\ninit h = 0.3, h' = 1.5\n"
                "simulate 1 every=0.05\n",
                &(Changes){0});
    for (int i = 0; i < ITEMS; i++)
        items[i] = expr_symbol(system_arena(script.system), names[i], SYMBOL_VARIABLE);
    EXPECT(system_m(script.system) > 0);
    motion = result_reader_first(script.reader)->motion;
    before = motion_counts(motion).factorisations;
    EXPECT(result_reader_values(script.reader, items, ITEMS - 1, values, &diag) == OK);
    EXPECT(motion_counts(motion).factorisations == before);
    for (int k = 0; k < ROWS;
         k++) { /* eight at once, and the rest; nothing slows it: (0.5 + 2*1^2)*1.5^2/2 */
        const double *row = values + (ptrdiff_t)k * (ITEMS - 1);

        EXPECT_NEAR(row[0], 0.3 + 0.075 * k, 1e-6);
        EXPECT_NEAR(row[1], 1.5, 1e-6);
        EXPECT_NEAR(row[2], cos(0.3 + 0.075 * k), 1e-6);
        EXPECT_NEAR(row[3], 2.8125, 1e-5);
    }
    EXPECT(result_reader_values(script.reader, items, ITEMS, values, &diag) == OK);
    EXPECT(motion_counts(motion).factorisations >= before + ROWS - 1);
    EXPECT_NEAR(values[ITEMS - 1], 0, 1e-9);
    script_close(&script);
}

/* A controller that follows an angle of two joints: smooth, but intervals promise far more than
 * there is. Its first look ahead took 5 million ranges. */
static void the_look_ahead_of_a_smooth_reference_is_bounded(void)
{
    Script script;

    script_open(
        &script,
        "scene planar\nT0 = 3 s\nr = 0.4/sqrt(3)\n"
        "S(t) = t/T0 - sin(2*pi*t/T0)/(2*pi)\nX(t) = 0.5 + 0.05*S(t)\n"
        "Y(t) = 0.5/sqrt(3) + (0.35 - 0.5/sqrt(3))*S(t)\nP(t) = pi/12*S(t)\n"
        "ankle(x, y) = atan2(y, x) - acos((x^2 + y^2 + 0.4^2 - 0.6^2)/(2*0.4*sqrt(x^2 + "
        "y^2)))\n"
        "vsource V1 v1 0 ankle(X(t) + r*cos(P(t) + 210 deg), Y(t) + r*sin(P(t) + 210 deg))\n"
        "body b mass=1 inertia=1\nrevolute h ground b\nsensor s h y 0 gain=1\n"
        "pd c1 u 0 ref=v1.v of=y.v Kp=4000 Kd=8000\ninit h=-1.34\n"
        "motor M h u 0 R=1 L=1 Kt=1 Kv=1 B=.01\nsimulate 0.01 every=0.01\n",
        &(Changes){0});
    EXPECT(script.status == OK);
    EXPECT(result_report(script.result)->visits > 100); /* it does look */
    EXPECT(result_report(script.result)->visits < 1000000);
    script_close(&script);
}

int main(void)
{
    RUN(rows_of_coordinates_and_speeds_solve_nothing);
    RUN(resuming_leaves_the_old_result_as_it_was);
    RUN(remarks_tell_of_which_part_and_when);
    RUN(the_look_ahead_of_a_smooth_reference_is_bounded);
    return test_end();
}
