/* test_between.c: what a run was between two rows is as accurate as the run, however far apart
 * these are
 *
 * Against closed forms, and against rows of runs with many of them. */
#include "session_kit.h"

#include <math.h>

#define FEWER        0.65 /* times the errors by angles: 0.72 where masses tell what is nearest */
#define COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))

static const char *const methods[] = {"auto", "dop853", "radau", "bdf", "adams", "ida"};

/* the run in two rows, asked at an instant between them */
static void expect_between(const char *model, const char *run, const char *expression, double value,
                           double error)
{
    for (int i = 0; i < COUNT(methods); i++) {
        Kit kit = kit_new();
        char line[200];
        double got;

        EXPECT_DONE(&kit, model);
        (void)snprintf(line, sizeof line, "%s method=%s\n", run, methods[i]);
        EXPECT_DONE(&kit, line);
        got = kit_value(&kit, expression);
        if (!(fabs(got - value) <= error)) {
            test_faults++;
            printf("%s by %s: %s is %.12g, not %.12g\n", run, methods[i], expression, got, value);
        }
        kit_free(&kit);
    }
}

static void one_step_of_output_hides_nothing(void)
{
    expect_between("capacitor C b 0 1\nresistor R b 0 1\ninit C.v = 1\n", "simulate 10 every=10",
                   "C.v at 2.34", exp(-2.34), 1e-6);
    expect_between("scene planar\ngravity [0, 0]\nbody m mass=2\nprismatic s ground m axis=x\n"
                   "spring k s k=8\ninit s = 1, s' = 0\n",
                   "simulate 20 every=20", "s at 7.7", cos(2 * 7.7), 1e-5);
    expect_between("capacitor C b 0 1\nisource I 0 b exp(-((t - 5)/0.01)^2)\ninit C.v = 0\n",
                   "simulate 10 every=10", "C.v at 5.005",
                   0.005 * sqrt(acos(-1.0)) * (1 + erf(0.5)), 1e-6);
}

/* an absolute nearness of 1 ns took the row before for any instant of a run of 10 ns */
static void short_runs_have_instants_too(void)
{
    expect_between("capacitor C b 0 1 nF\nresistor R b 0 1\ninit C.v = 1\n",
                   "simulate 1e-8 every=5e-9", "C.v at 2.34e-9", exp(-2.34), 1e-6);
}

/* current of a coil of 1 H and 1 ohm behind a source that is at 1 V for 0.3 of each second */
static double chopped(double t)
{
    double i = 0, at = 0;

    for (; at + 1 <= t; at++)
        i = exp(-0.7) * (1 + (i - 1) * exp(-0.3));
    if (t - at <= 0.3)
        return 1 + (i - 1) * exp(-(t - at));
    return exp(-(t - at - 0.3)) * (1 + (i - 1) * exp(-0.3));
}

static void jumps_between_rows_are_kept(void)
{
    static const char *const model =
        "vsource V a 0 pulse(t, 0, 1, 0, 0, 0, 0.3, 1)\nresistor R a b 1\ninductor L b 0 1\n"
        "init L.i = 0\n";

    expect_between(model, "simulate 6.5 every=6.5", "L.i at 4.21", chopped(4.21), 1e-6);
    expect_between(model, "simulate 6.5 every=6.5", "L.i at 3.77", chopped(3.77), 1e-6);
    expect_between(model, "simulate 6.5 every=2", "L.i at 4.21", chopped(4.21), 1e-6);
}

/* each model's run of few rows between them, and one of many rows at them */
static void few_rows_tell_what_many_do(void)
{
    static const struct {
        const char *model, *variable;
        double duration;
    } cases[] = {
        /* ideal switches: other equations from corner to corner */
        {"vsource V a 0 10*sin(2*pi*50*t)\ndiode D a b\ncapacitor C b 0 1 mF\nresistor R b 0 50\n"
         "resistor Rs a 0 1e3\ninit C.v = 0\n",
         "C.v", 0.1},
        /* friction: it slips and sticks */
        {"scene planar\ngravity [0, 0]\nbody m mass=1\nprismatic s ground m axis=x\nspring k s "
         "k=10\nactuator f s force=-1*sign(s')\ninit s = 1, s' = 0\n",
         "s", 3},
        /* events of the state */
        {"scene planar\ngravity [0, -9.81]\nbody m mass=1\nprismatic s ground m axis=y\ninit s = "
         "1, "
         "s' = 0\nevent hit when=s < 0 s'=-0.8*s'\n",
         "s", 1.7},
        /* a sampled controller */
        {"scene planar\ngravity [0, 0]\nbody m mass=1\nprismatic s ground m axis=x\n"
         "pid c a 0 ref=1 of=s Kp=4 Ki=1 Kd=3 period=0.1\nresistor R a 0 1\n"
         "actuator f s force=a.v*1\ninit s = 0, s' = 0\n",
         "s", 3},
        /* a pendulum that goes round, in absolute coordinates */
        {"scene planar\ngravity [0, -9.81]\nbody m mass=1 inertia=0.1\narm r m [-0.5, 0]\n"
         "revolute h ground r\ninit h = 0, h' = 12\ntree absolute\n",
         "h", 4},
    };

    for (int i = 0; i < COUNT(cases); i++)
        for (int k = 0; k < COUNT(methods); k++) {
            Kit few = kit_new(), many = kit_new();
            char line[200];
            double off = 0;

            EXPECT_DONE(&few, cases[i].model);
            EXPECT_DONE(&many, cases[i].model);
            (void)snprintf(line, sizeof line, "simulate %g every=%g method=%s rtol=1e-9\n",
                           cases[i].duration, cases[i].duration / 3.3, methods[k]);
            EXPECT_DONE(&few, line);
            (void)snprintf(line, sizeof line, "simulate %g every=%g method=%s rtol=1e-9\n",
                           cases[i].duration, cases[i].duration / 100, methods[k]);
            EXPECT_DONE(&many, line);
            for (int p = 1; p < 100; p += 7) {
                (void)snprintf(line, sizeof line, "%s at %.17g", cases[i].variable,
                               cases[i].duration / 100 * p);
                off = fmax(off, fabs(kit_value(&few, line) - kit_value(&many, line)));
            }
            if (!(off < 1e-5)) {
                test_faults++;
                printf("case %d by %s: off by %g\n", i, methods[k], off);
            }
            kit_free(&few);
            kit_free(&many);
        }
}

static void a_table_and_a_question_agree(void)
{
    static const char *const text = "vsource V a 0 sin(3*t)\nresistor R a b 1\ncapacitor C b 0 1\n"
                                    "init C.v = 0\nsimulate 10 every=4\n";
    Kit kit = kit_new();
    ct_cursor cursor = {.text = "table C.v", .line = 1};
    ct_statement *statement = NULL;
    double *values = NULL;
    int rows = 0, columns = 0;
    char **names = NULL;
    const ct_expression *item;

    EXPECT_DONE(&kit, text);
    EXPECT(ct_parse(&cursor, false, &statement, &kit.error) == CT_OK);
    item = ct_operand(statement, 0);
    EXPECT(ct_table(kit.session, &item, 1, 0.7, &values, &rows, &columns, &names, &kit.error) ==
           CT_OK);
    for (int r = 0; r < rows; r++) {
        const double t = values[r * columns];
        char asked[60];

        (void)snprintf(asked, sizeof asked, "C.v at %.17g", t);
        EXPECT(kit_value(&kit, asked) == values[r * columns + 1]);
        EXPECT(fabs(values[r * columns + 1] - (sin(3 * t) - 3 * cos(3 * t) + 3 * exp(-t)) / 10) <
               1e-8);
    }
    ct_free(values);
    ct_words_free(names);
    ct_statement_free(statement);
    kit_free(&kit);
}

/* What a driver prescribes is where it has to be, however far a method that projects no steps
 * drifts from it: a cart on a spring rests again, and takes up nothing of that. */
static void what_drifts_from_a_driver_moves_nothing_else(void)
{
    expect_between("scene planar\nbody a mass=1\nprismatic d ground a axis=x\nbody b mass=0.5\n"
                   "prismatic s a b axis=x\nspring k s k=1 d=1.5\ninit s = 0, s' = 0\n"
                   "driver D d = exp(-((t - 5)/0.5)^2)\n",
                   "simulate 400 every=40 rtol=1e-6", "s", 0, 1e-6);
}

/* What supplies a driven motion follows from it at the instant: R i + L i' + K theta', i = J
 * theta'' / K, of theta = t^3. */
static void efforts_between_rows_are_solved_for(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\ngravity [0, 0]\nbody m mass=2 inertia=0.03\n"
                      "revolute h ground m\nmotor M h e 0 R=1.2 L=0.05 Kt=0.8 Kv=0.8\n"
                      "vsource V e 0 0\ndriver D h = t^3 by=V\ninverse 2 every=1\n");
    EXPECT(fabs(kit_value(&kit, "h at 1.3") - 1.3 * 1.3 * 1.3) < 1e-12);
    EXPECT(fabs(kit_value(&kit, "M.i at 1.3") - 0.03 * 6 * 1.3 / 0.8) < 1e-9);
    EXPECT(fabs(kit_value(&kit, "V.v at 1.3") -
                (1.2 * 0.03 * 6 * 1.3 / 0.8 + 0.05 * 0.03 * 6 / 0.8 + 0.8 * 3 * 1.3 * 1.3)) < 1e-9);
    kit_free(&kit);
}

/* of an angle in that run and in the first one */
static double largest_difference(Kit *kit, int run)
{
    double largest = 0;

    for (int t = 1; t <= 20; t++) {
        char expression[60];

        (void)snprintf(expression, sizeof expression, "run%d.h - run1.h at %g", run, 0.5 * t);
        largest = fmax(largest, fabs(kit_value(kit, expression)));
    }
    return largest;
}

/* Pendulums that go round, in absolute coordinates, by methods that drift off the circle: positions
 * are brought back by the measure of the error test, in which they are off, and not by masses. What
 * is right is the run by angles at a fine tolerance. */
static void what_drifts_is_read_by_the_measure_of_errors(void)
{
    static const struct {
        double mass, inertia, length, speed;
    } pendulums[] = {{2, 0.3, 0.8, 9}, {5, 12, 1.4, 8}, {1, 0.02, 1.1, 8}, {10, 9, 0.9, 9}};
    static const char *const drifting[] = {"bdf", "adams"};
    double logarithms = 0;

    for (int i = 0; i < 2 * COUNT(pendulums); i++) {
        Kit kit = kit_new();
        char text[500];
        double error[2];

        (void)snprintf(text, sizeof text,
                       "scene planar\ngravity [0, -9.81]\nbody b mass=%g inertia=%g\n"
                       "arm a b [-%g, 0]\nrevolute h ground a\ntree joint\n"
                       "init h = 0.3, h' = %g\nsimulate 10 rtol=1e-12 atol=1e-12\n",
                       pendulums[i / 2].mass, pendulums[i / 2].inertia, pendulums[i / 2].length,
                       pendulums[i / 2].speed);
        EXPECT_DONE(&kit, text);
        for (int k = 0; k < 2; k++) {
            (void)snprintf(text, sizeof text, "%ssimulate 10 rtol=1e-8 atol=1e-8 method=%s\n",
                           k == 0 ? "" : "tree absolute\n", drifting[i % 2]);
            EXPECT_DONE(&kit, text);
            error[k] = largest_difference(&kit, k + 2);
        }
        logarithms += log(error[1] / error[0]);
        kit_free(&kit);
    }
    EXPECT(exp(logarithms / (2 * COUNT(pendulums))) < FEWER);
}

int main(void)
{
    RUN(one_step_of_output_hides_nothing);
    RUN(short_runs_have_instants_too);
    RUN(jumps_between_rows_are_kept);
    RUN(few_rows_tell_what_many_do);
    RUN(a_table_and_a_question_agree);
    RUN(what_drifts_from_a_driver_moves_nothing_else);
    RUN(efforts_between_rows_are_solved_for);
    RUN(what_drifts_is_read_by_the_measure_of_errors);
    return test_end();
}
