/* test_session_figures.c: functions of runs against closed forms, whatever the rows; `keep` */
#include "session_kit.h"

#include <math.h>
#include <stdlib.h>

#define SWING                                                                                      \
    "scene planar\nbody b mass=1 inertia=1\nrevolute h ground b\nspring k1 h k=4\n"                \
    "init h = 0.5, h' = 2\n"
#define BALL                                                                                       \
    "scene planar\ngravity [0, -9.81]\nbody b mass=1 inertia=1\nprismatic s ground b axis=y\n"     \
    "init s = 1\nevent hit when=s < 0 s'=-0.8*s'\n"

static const char *const grids[] = {"0.01", "0.37", "1", "7.9", "10"};

static double swing(double t)
{
    return 0.5 * cos(2 * t) + sin(2 * t);
}

/* h = 0.5 cos 2t + sin 2t */
static void a_swing_has_its_closed_forms_at_any_rows(void)
{
    const double T = 10, A = sqrt(1.25);
    const double mean = (0.25 * sin(2 * T) + 0.5 - 0.5 * cos(2 * T)) / T;
    const double square =
        A * A / 2 + (0.25 - 1) / 2 * sin(4 * T) / (4 * T) + 0.5 * (1 - cos(4 * T)) / (4 * T);

    for (size_t i = 0; i < sizeof grids / sizeof grids[0]; i++) {
        char line[80];
        Kit kit = kit_new();

        (void)snprintf(line, sizeof line, "simulate 10 every=%s rtol=1e-11 atol=1e-12", grids[i]);
        EXPECT_DONE(&kit, SWING);
        EXPECT_DONE(&kit, line);
        EXPECT_NEAR(kit_value(&kit, "max(h)"), A, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "min(h)"), -A, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "mean(h)"), mean, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "rms(h)"), sqrt(square), 1e-9);
        EXPECT_NEAR(kit_value(&kit, "period(h)"), M_PI, 1e-8);
        EXPECT_NEAR(kit_value(&kit, "first(h < 0)"), (M_PI - atan(0.5)) / 2, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "final(h)"), swing(T), 1e-8);
        EXPECT_NEAR(kit_value(&kit, "mean(abs(h'))"), kit_value(&kit, "mean(if(h' > 0, h', -h'))"),
                    1e-8);
        EXPECT_NEAR(kit_value(&kit, "max(h) - 2*rms(h)"), A - 2 * sqrt(square), 1e-9);
        kit_free(&kit);
    }
}

/* for how much of T the swing is above a level: where |2 t - atan 2| is less than `half` of a turn
 */
static double part_above(double level, double T)
{
    const double half = acos(level / sqrt(1.25)), turn = atan(2);
    double sum = 0;

    for (int k = 0; 2 * M_PI * k + turn - half < 2 * T; k++)
        sum += fmin(2 * M_PI * k + turn + half, 2 * T) - fmax(2 * M_PI * k + turn - half, 0);
    return sum / (2 * T);
}

/* wherever a pole lies, and however weak it is; a jump at the same instants has one, and so has
 * what grows without bound more slowly */
static void no_mean_is_told_about_a_pole(void)
{
    static const char *const poles[] = {"mean(1/(h - %g))", "mean(3 - 0.02/(h - %g))",
                                        "rms(1/(h - %g))", "rms(1/sqrt(abs(h - %g)))",
                                        "period(1/(h - %g))"};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SWING "simulate 10 every=0.1");
    for (int k = 0; k < 46; k++) {
        const double level = -1.05 + 0.0471 * k;
        char line[80];

        for (size_t i = 0; i < sizeof poles / sizeof poles[0]; i++) {
            int length = snprintf(line, sizeof line, "print ");

            (void)snprintf(line + length, sizeof line - (size_t)length, poles[i], level);
            EXPECT_FAILS(&kit, line, "grows without bound, and has no mean");
        }
        (void)snprintf(line, sizeof line, "mean(if(h > %g, 1, 0))", level);
        EXPECT_NEAR(kit_value(&kit, line), part_above(level, 10), 1e-3);
        (void)snprintf(line, sizeof line, "mean(1e3*if(abs(h - %g) < 0.04, 1, 0))", level);
        EXPECT_NEAR(kit_value(&kit, line),
                    1e3 * (part_above(level - 0.04, 10) - part_above(level + 0.04, 10)), 0.5);
        (void)snprintf(line, sizeof line, "mean(log(abs(h - %g)))", level);
        EXPECT(isfinite(kit_value(&kit, line)));
    }
    kit_free(&kit);
}

/* falls from 1 m, and leaves the ground with 0.8 of its speed */
static void a_ball_jumps_between_rows(void)
{
    const double g = 9.81, fall = sqrt(2 / g), v = sqrt(2 * g);

    for (size_t i = 0; i < sizeof grids / sizeof grids[0]; i++) {
        char line[80];
        Kit kit = kit_new();

        (void)snprintf(line, sizeof line, "simulate 1.1 every=%s", grids[i]);
        EXPECT_DONE(&kit, BALL);
        EXPECT_DONE(&kit, line);
        EXPECT_NEAR(kit_value(&kit, "min(s')"), -v, 1e-7);
        EXPECT_NEAR(kit_value(&kit, "max(s')"), 0.8 * v, 1e-7);
        EXPECT_NEAR(kit_value(&kit, "first(s' > 0)"), fall, 1e-7);
        EXPECT_NEAR(kit_value(&kit, "first(s < 0.5)"), sqrt(1 / g), 1e-8);
        /* the mean speed is the way */
        EXPECT_NEAR(1.1 * kit_value(&kit, "mean(s')"),
                    0.8 * v * (1.1 - fall) - g / 2 * (1.1 - fall) * (1.1 - fall) - 1, 1e-8);
        kit_free(&kit);
    }
}

/* exp(-t): within a hundredth of its end from ln 100 and a little on */
static void what_decays_settles(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource V a 0 1\nresistor R a b 1\ncapacitor C b 0 1\ninit C.v = 0\n"
                      "simulate 12 every=3 rtol=1e-10 atol=1e-12");
    EXPECT_NEAR(kit_value(&kit, "settling(C.v, 0.01)"), -log(0.01 + exp(-12)), 1e-6);
    EXPECT_FAILS(&kit, "print settling(C.v, 0)", "above 0");
    EXPECT_FAILS(&kit, "print period(C.v)", "it rises once through its mean in the run");
    EXPECT_FAILS(&kit, "print period(-C.v)", "it never rises through its mean");
    EXPECT_FAILS(&kit, "print period(C.v)", "no period can be told");
    EXPECT_FAILS(&kit, "print first(C.v > 2)", "at no instant");
    EXPECT_FAILS(&kit, "print settling(C.v)", "settling");
    kit_free(&kit);
}

static void what_is_kept_is_a_number_with_its_unit(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SWING "simulate 1\nkeep A = max(h), v = h'\nkeep early = h at 0");
    EXPECT_NEAR(kit_value(&kit, "early"), 0.5, 1e-15);
    EXPECT_NEAR(kit_value(&kit, "v - h'"), 0, 1e-15);
    EXPECT_DONE(&kit, "simulate 2\nprint A");
    EXPECT_NEAR(kit_value(&kit, "A - max(run1.h)"), 0, 1e-15);
    EXPECT_DONE(&kit, "keep A = 7");
    EXPECT_NEAR(kit_value(&kit, "A"), 7, 0);
    EXPECT_FAILS(&kit, "keep B = 2, C = 1/0", "division by zero");
    EXPECT_FAILS(&kit, "print B", "unknown name");
    EXPECT_FAILS(&kit, "keep B = 2, h = 3", "h");
    EXPECT_FAILS(&kit, "print B", "unknown name");
    EXPECT_FAILS(&kit, "keep h' = 3", "primes");
    EXPECT_DONE(&kit, "show runs");
    EXPECT_HOLDS(kit.text, "run2  simulate  0 ... 2 s");
    EXPECT_DONE(&kit, "show init");
    EXPECT_HOLDS(kit.text, "init h' = 2\n");
    kit_free(&kit);
}

static void a_run_remembers_its_parameters(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SWING "L = 3\nsimulate 1\nL = 4\nunused = L^2\nsimulate 1");
    EXPECT_NEAR(kit_value(&kit, "run1.L"), 3, 0);
    EXPECT_NEAR(kit_value(&kit, "run2.L + L"), 8, 0);
    EXPECT_NEAR(kit_value(&kit, "run2.unused"), 16, 0);
    kit_free(&kit);
}

/* --- spectra --- */

/* all lines of a spectrum: frequency, Hz, and amplitude in turn; new, ct_free(); NULL if it fails
 */
static double *spectrum_lines(Kit *kit, const char *item, int *count)
{
    char line[200], **names = NULL;
    double *values = NULL;
    int columns = 0;
    ct_statement *statement = NULL;
    ct_cursor cursor = {.text = line, .line = 1};

    *count = 0;
    (void)snprintf(line, sizeof line, "table %s", item);
    EXPECT(ct_parse(&cursor, true, &statement, &kit->error) == CT_OK);

    const ct_expression *wanted = ct_operand(statement, 0);

    if (ct_table(kit->session, &wanted, 1, 0, &values, count, &columns, &names, &kit->error) ==
        CT_OK)
        ct_words_free(names);
    ct_statement_free(statement);
    return values;
}

/* the amplitude at that frequency, which has to be a line; NAN */
static double amplitude_at(const double *lines, int count, double frequency)
{
    double out = NAN;

    for (int i = 0; i < count; i++)
        out = fabs(lines[2 * i] - frequency) < 1e-9 ? lines[2 * i + 1] : out;
    return out;
}

static double amplitude(Kit *kit, const char *item, double frequency)
{
    int count;
    double *lines = spectrum_lines(kit, item, &count);
    const double out = amplitude_at(lines, count, frequency);

    ct_free(lines);
    return out;
}

static void a_tone_shows_its_amplitude(void)
{
    for (size_t i = 0; i < sizeof grids / sizeof grids[0]; i++) {
        char line[80];
        Kit kit = kit_new();
        const char *both = "spectrum(2*sin(2*pi*5*t) - 0.3*cos(2*pi*7.5*t) + 4)";

        (void)snprintf(line, sizeof line, "simulate 10 every=%s", grids[i]);
        EXPECT_DONE(&kit, SWING);
        EXPECT_DONE(&kit, line);
        EXPECT_NEAR(amplitude(&kit, both, 5), 2, 1e-9);
        EXPECT_NEAR(amplitude(&kit, both, 7.5), 0.3, 1e-9);
        EXPECT_NEAR(amplitude(&kit, both, 6), 0, 1e-9);
        EXPECT_NEAR(amplitude(&kit, both, 0), 4, 1e-9);
        EXPECT_NEAR(amplitude(&kit, "spectrum(0*t - 3)", 0), 3, 1e-12);
        EXPECT_NEAR(amplitude(&kit, "spectrum(0*t - 3)", 0.1), 0, 1e-12);
        /* far above what the run's steps resolve, and at a whole number of samples */
        EXPECT_NEAR(amplitude(&kit, "spectrum(sin(2*pi*900*t))", 900), 1, 1e-9);
        EXPECT_NEAR(amplitude(&kit, "spectrum(cos(2*pi*409.6*t))", 409.6), 1, 1e-9);
        EXPECT_NEAR(amplitude(&kit, "spectrum(cos(2*pi*409.6*t))", 0), 0, 1e-9);
        kit_free(&kit);
    }
}

/* between the lines of a tone there is nothing: no roundings of its samples, nor of large numbers
 * that it is the difference of */
static void rounding_is_no_tone(void)
{
    static const char *const tones[] = {"spectrum(3*sin(2*pi*5*t))", "spectrum(E1.v)",
                                        "spectrum(E1.v) [mV]",
                                        "spectrum((1e6 + sin(2*pi*5*t)) - 1e6)"};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E1 a 0 3 V*sin(2*pi*5 Hz*t)\nresistor R1 a 0 10 ohm\nsimulate 2");
    for (size_t i = 0; i < sizeof tones / sizeof tones[0]; i++) {
        int count;
        double *lines = spectrum_lines(&kit, tones[i], &count);

        EXPECT(amplitude_at(lines, count, 5) > 0.99);
        EXPECT(amplitude_at(lines, count, 4.5) > 0.49); /* of the window */
        for (int k = 0; k < 9; k++)
            EXPECT_NEAR(amplitude_at(lines, count, 0.5 * k), 0, 0);
        for (int k = 12; k < 200; k++)
            EXPECT_NEAR(amplitude_at(lines, count, 0.5 * k), 0, 0);
        ct_free(lines);
    }
    /* what is small without being rounding stays */
    EXPECT_NEAR(amplitude(&kit, "spectrum(sin(2*pi*5*t) + 1e-12*sin(2*pi*9*t))", 9), 1e-12, 1e-14);
    kit_free(&kit);
}

/* 0.5 cos 2t + sin 2t over ten periods, in a unit, of one run among two */
static void a_swing_has_one_line(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SWING "simulate (10*pi) rtol=1e-11 atol=1e-12\nsimulate 1");
    EXPECT_NEAR(amplitude(&kit, "spectrum(run1.h)", 1 / M_PI), sqrt(1.25), 1e-8);
    EXPECT_NEAR(amplitude(&kit, "spectrum(run1.h) [deg]", 1 / M_PI), sqrt(1.25) * 180 / M_PI, 1e-6);
    EXPECT_NEAR(amplitude(&kit, "spectrum(run1.h')", 1 / M_PI), 2 * sqrt(1.25), 1e-8);
    EXPECT_NEAR(amplitude(&kit, "spectrum(run1.h)", 2 / M_PI), 0, 1e-8);
    kit_free(&kit);
}

/* A ball that loses nothing: parabolas of height 1, whose k-th tone is 4/(pi k)^2 */
static void a_ball_has_the_tones_of_parabolas(void)
{
    const double period = 2 * sqrt(2 / 9.81);
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nbody b mass=1 inertia=1\n"
                      "prismatic s ground b axis=y\ninit s = 1\nevent hit when=s < 0 s'=-s'\n"
                      "simulate (16*sqrt(2/9.81)) every=0.3 rtol=1e-10 atol=1e-12");
    EXPECT_NEAR(amplitude(&kit, "spectrum(s)", 0), 2.0 / 3, 1e-4);
    for (int k = 1; k < 9; k++)
        EXPECT_NEAR(amplitude(&kit, "spectrum(s)", k / period), 4 / (M_PI * M_PI * k * k), 1e-4);
    /* the speed is a saw of height v: 2 v/(pi k) */
    EXPECT_NEAR(amplitude(&kit, "spectrum(s')", 1 / period), 2 * sqrt(2 * 9.81) / M_PI, 4e-3);
    EXPECT_NEAR(amplitude(&kit, "spectrum(s')", 3 / period), 2 * sqrt(2 * 9.81) / M_PI / 3, 4e-3);
    kit_free(&kit);
}

static void a_spectrum_stands_where_it_can(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SWING);
    EXPECT_FAILS(&kit, "table spectrum(h)", "there is none");
    EXPECT_DONE(&kit, "simulate 1");
    EXPECT_FAILS(&kit, "print spectrum(h)", "is no number");
    EXPECT_FAILS(&kit, "print 2*spectrum(h)", "is no number");
    EXPECT_FAILS(&kit, "table spectrum(h) h", "over frequency");
    EXPECT_FAILS(&kit, "table spectrum(2*spectrum(h))", "is no number");
    EXPECT_FAILS(&kit, "table spectrum(h, h')", "one variable");
    EXPECT_FAILS(&kit, "table spectrum(h) every=0.1", "no every=");
    EXPECT_FAILS(&kit, "table spectrum(h) [mm]", "mm");
    EXPECT_FAILS(&kit, "table spectrum(1/(t - 0.5 + abs(t - 0.5)))", "isn't a number");
    EXPECT_FAILS(&kit, "output y = spectrum(h)", "nothing can depend on it");
    EXPECT_DONE(&kit, "export csv spectrum(h)");
    EXPECT_HOLDS(kit.text, "f,spectrum(h)\n0,");
    kit_free(&kit);
}

/* 1 but for rounding, which no pieces of a run agree about */
static void rounding_has_a_mean(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SWING "simulate 10 every=0.1");
    EXPECT_NEAR(kit_value(&kit, "mean(sin(h)^2 + cos(h)^2 - 1)"), 0, 1e-15);
    EXPECT_NEAR(kit_value(&kit, "rms(sin(h)^2 + cos(h)^2 - 1)"), 0, 1e-15);
    kit_free(&kit);
}

int main(void)
{
    RUN(a_tone_shows_its_amplitude);
    RUN(rounding_is_no_tone);
    RUN(a_swing_has_one_line);
    RUN(a_ball_has_the_tones_of_parabolas);
    RUN(a_spectrum_stands_where_it_can);
    RUN(a_swing_has_its_closed_forms_at_any_rows);
    RUN(no_mean_is_told_about_a_pole);
    RUN(a_ball_jumps_between_rows);
    RUN(what_decays_settles);
    RUN(what_is_kept_is_a_number_with_its_unit);
    RUN(rounding_has_a_mean);
    RUN(a_run_remembers_its_parameters);
    return test_end();
}
