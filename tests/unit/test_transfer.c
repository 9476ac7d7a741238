/* test_transfer.c: transfer functions and frequency response against closed forms */
#include "session_kit.h"

#include <complex.h>

/* --- tables of bode --- */

typedef struct Bode {
    double *values;
    int rows, columns;
    char **names;
} Bode;

static Bode bode(Kit *kit, const char *line)
{
    ct_statement *statement = NULL;
    Bode out = {0};

    if (ct_parse(&(ct_cursor){.text = line, .line = 1}, false, &statement, &kit->error) != CT_OK ||
        ct_bode(kit->session, statement, &out.values, &out.rows, &out.columns, &out.names,
                &kit->error) != CT_OK) {
        test_faults++;
        printf("%s: %s\n", line, kit->error.message);
    }
    ct_statement_free(statement);
    return out;
}

static void bode_free(Bode *table)
{
    ct_free(table->values);
    ct_words_free(table->names);
}

/* an entry, row by row; NAN where there is none */
static double bode_at(const Bode *table, int entry)
{
    return table->values != NULL && entry < table->rows * table->columns ? table->values[entry]
                                                                         : NAN;
}

static const char *bode_name(const Bode *table, int column)
{
    return table->names != NULL && column < table->columns ? table->names[column] : "";
}

typedef double complex Response(double complex s);

/* gain and phase of a curve are those of H(s); the phase begins at `start` degrees or near, and
 * never jumps by half a turn unless it `may` */
static void expect_response(const Bode *table, int curve, Response *response, double start,
                            double tolerance)
{
    double before = start;

    for (int r = 0; r < table->rows; r++) {
        const double *row = table->values + (ptrdiff_t)r * table->columns;
        const double complex h = response(I * 2 * M_PI * row[0]);
        const double gain = row[1 + 2 * curve], phase = row[2 + 2 * curve];

        if (!(fabs(gain - 20 * log10(cabs(h))) <= tolerance &&
              fabs(remainder(phase - carg(h) * 180 / M_PI, 360)) <= tolerance &&
              fabs(phase - before) < 170)) {
            test_faults++;
            printf("%s at %.17g Hz: %.17g dB, %.17g deg, wanted %.17g dB, %.17g deg\n",
                   table->names[1 + 2 * curve], row[0], gain, phase, 20 * log10(cabs(h)),
                   carg(h) * 180 / M_PI);
            return;
        }
        before = phase;
    }
}

/* --- closed forms --- */

#define LOWPASS                                                                                    \
    "vsource E1 a 0 0\nresistor R1 a b 1 kohm\ncapacitor C1 b 0 1 uF\n"                            \
    "linearize inputs=[E1] outputs=[C1.v, R1.v, R1.i]\n"

static double complex lowpass(double complex s)
{
    return 1 / (1 + 1e-3 * s);
}

static double complex highpass(double complex s)
{
    return 1e-3 * s / (1 + 1e-3 * s);
}

static void a_low_pass_falls_by_20_decibels_a_decade(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, LOWPASS);
    table = bode(&kit, "bode from=1 to=100 kHz points=301");
    EXPECT(table.rows == 301 && table.columns == 7);
    EXPECT_TEXT(bode_name(&table, 0), "f [Hz]");
    EXPECT_TEXT(bode_name(&table, 1), "gain C1.v/E1 [dB]");
    EXPECT_TEXT(bode_name(&table, 2), "phase C1.v/E1 [deg]");
    EXPECT(bode_at(&table, 0) == 1 && bode_at(&table, 300 * 7) == 1e5);
    expect_response(&table, 0, lowpass, 0, 1e-10);
    expect_response(&table, 1, highpass, 90, 1e-10);
    bode_free(&table);
    EXPECT_DONE(&kit, "show transfer\n");
    EXPECT_HOLDS(kit.text, "C1.v/E1 = 1000/(s + 1000)\n  gain     1000\n  at rest  1\n");
    EXPECT_HOLDS(kit.text, "R1.v/E1 = s/(s + 1000)\n");
    EXPECT_HOLDS(kit.text, "R1.i/E1 = 0.001 s/(s + 1000)\n");
    EXPECT_HOLDS(kit.text, "zeros    0\n  poles    -1000\n");
    kit_free(&kit);
}

/* omega0 = 1e5 rad/s, quality 20 */
static double complex bandpass(double complex s)
{
    return 5 * s / (1e-3 * s * s + 5 * s + 1e7);
}

static void a_resonant_circuit_passes_a_band(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, "vsource E1 a 0 0\nresistor R1 a b 5\ninductor L1 b c 1 mH\n"
                      "capacitor C1 c 0 0.1 uF\nlinearize inputs=[E1] outputs=[R1.v]\n");
    table = bode(&kit, "bode R1.v from=1 kHz to=1 MHz");
    EXPECT(table.rows > 200);
    expect_response(&table, 0, bandpass, 90, 1e-9);
    bode_free(&table);
    EXPECT_DONE(&kit, "show transfer\n");
    EXPECT_HOLDS(kit.text, "R1.v/E1 = 5000 s/(s^2 + 5000 s + 1e+10)\n");
    EXPECT_HOLDS(kit.text, "poles    -2500 +- 99968.7i\n");
    kit_free(&kit);
}

/* J L s^3 + J R s^2 + Kt^2 s */
static double complex motor(double complex s)
{
    return 0.5 / (s * (0.02 * 0.01 * s * s + 0.02 * 2 * s + 0.25));
}

static void a_motor_turns_its_inertia(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, "scene planar\nbody m1 mass=1 inertia=0.02\nrevolute h1 ground m1\n"
                      "vsource V1 a 0 0\nmotor M1 h1 a 0 R=2 L=0.01 Kt=0.5\n"
                      "linearize inputs=[V1] outputs=[h1, h1']\n");
    table = bode(&kit, "bode h1 from=1 [rad/s] to=1e4 [rad/s]");
    EXPECT(fabs(bode_at(&table, 0) * 2 * M_PI - 1) < 1e-14);
    expect_response(&table, 0, motor, -90, 1e-9);
    EXPECT(bode_at(&table, 199 * 3 + 2) < -265);
    bode_free(&table);
    EXPECT_DONE(&kit, "show transfer 1 1\n");
    EXPECT_HOLDS(kit.text, "h1/V1 = 2500/(s^3 + 200 s^2 + 1250 s)\n");
    EXPECT_HOLDS(kit.text, "at rest  no bound\n");
    EXPECT_HOLDS(kit.text, "poles    0, -6.45");
    EXPECT_LACKS(kit.text, "h1'");
    EXPECT_DONE(&kit, "show transfer h1 V1\n");
    EXPECT_HOLDS(kit.text, "h1/V1 = 2500/(s^3 + 200 s^2 + 1250 s)\n");
    EXPECT_LACKS(kit.text, "h1'");
    EXPECT_DONE(&kit, "show transfer 2\n");
    EXPECT_HOLDS(kit.text, "left out  1 state between");
    EXPECT_DONE(&kit, "show transfer h1'\n");
    EXPECT_HOLDS(kit.text, "left out  1 state between");
    EXPECT_FAILS(&kit, "show transfer V1", "V1 is no output of the last linearisation");
    EXPECT_FAILS(&kit, "show transfer h1 h1", "h1 is no independent source");
    EXPECT_FAILS(&kit, "show transfer h1 V1 1", "an output and an input only");
    EXPECT_FAILS(&kit, "show transfer h1 V1 V1", "an output and an input only");
    EXPECT_FAILS(&kit, "clear\nshow transfer h1", "nothing has been linearized yet");
    kit_free(&kit);
}

/* two masses with a spring between them, undamped: s2 is against the first */
static double complex masses(double complex s)
{
    return -1 / (s * s + 12 * (1 + 1.0 / 3));
}

static void what_floats_has_two_poles_at_0(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, "scene planar\nbody a mass=1 inertia=1\nbody b mass=3 inertia=1\n"
                      "prismatic s1 ground a axis=x\nprismatic s2 a b axis=x\n"
                      "spring k1 s2 k=12\nactuator f1 s1 force=0\n"
                      "linearize inputs=[f1] outputs=[s1, s2]\nshow transfer\n");
    EXPECT_HOLDS(kit.text, "s1/f1 = (s^2 + 4)/(s^4 + 16 s^2)\n");
    EXPECT_HOLDS(kit.text, "zeros    +-2i\n  poles    0, 0, +-4i\n");
    EXPECT_HOLDS(kit.text, "s2/f1 = -1/(s^2 + 16)\n");
    table = bode(&kit, "bode s2 from=0.01 to=0.6 points=50");
    expect_response(&table, 0, masses, 180, 1e-9);
    bode_free(&table);
    /* half a turn at the pair of poles, half a turn back at that of zeros before it */
    table = bode(&kit, "bode s1 from=0.01 to=10 points=4");
    EXPECT(fabs(bode_at(&table, 2) + 180) < 1e-9);
    EXPECT(fabs(bode_at(&table, 3 * 3 + 2) + 180) < 1e-9);
    bode_free(&table);
    kit_free(&kit);
}

static double complex allpass(double complex s)
{
    return (1 - s) / (1 + s);
}

/* two dividers of the same times, the other way round */
static void equal_poles_and_zeros_are_left_out(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, "vsource E1 a 0 0\nresistor R1 a b 1\ncapacitor C1 b 0 1\n"
                      "capacitor C2 a c 0.1\nresistor R2 c 0 10\n"
                      "linearize inputs=[E1] outputs=[(C1.v - R2.v)]\nshow transfer\n");
    EXPECT_HOLDS(kit.text, "= (-s + 1)/(s + 1)\n");
    EXPECT_HOLDS(kit.text, "1 pole equal to a zero\n");
    table = bode(&kit, "bode from=0.001 to=10");
    expect_response(&table, 0, allpass, 0, 1e-9);
    bode_free(&table);
    kit_free(&kit);
}

/* (R + Z)/(2 R + Z) of a coil Z with a plunger that is moved by next to no current */
static double complex beside_a_plunger(double complex s)
{
    return (s + 10) / (s + 20);
}

/* What hardly acts on what is asked for has zeros all but equal to its poles: the others are known
 * as well as without it. */
static void zeros_beside_hidden_poles_are_known(void)
{
    static const char *const currents[] = {"1e-30", "1e-13", "1e-7"};

    for (int k = 0; k < 3; k++) {
        Kit kit = kit_new();
        char start[40];
        Bode table;

        EXPECT_DONE(&kit, "scene planar\nbody b mass=1 inertia=1\nprismatic s ground b axis=x\n"
                          "spring k s k=100 d=1\nvsource V a 0 0\nresistor R a n 1\n"
                          "solenoid X s n 0 L=0.1*(1 + 0.3*s) R=1\n");
        (void)snprintf(start, sizeof start, "init X.i=%s\n", currents[k]);
        EXPECT_DONE(&kit, start);
        EXPECT_DONE(&kit, "linearize inputs=[V] outputs=[n.v]\nshow transfer\n");
        EXPECT_HOLDS(kit.text, "gain      1\n");
        EXPECT_HOLDS(kit.text, "at rest   0.5\n");
        EXPECT_HOLDS(kit.text, "zeros     -10\n");
        EXPECT_HOLDS(kit.text, "left out  2 poles equal to zeros\n");
        table = bode(&kit, "bode from=0.001 to=10");
        expect_response(&table, 0, beside_a_plunger, 0, 1e-9);
        bode_free(&table);
        kit_free(&kit);
    }
}

/* a mass on a spring, then two lags */
static double complex behind_two_lags(double complex s)
{
    return 100 / ((s * s + s + 100) * (s + 10) * (s + 10));
}

/* A way that is shorter, but hardly leads on, has zeros far beyond all poles, and costs no others.
 */
static void zeros_far_beyond_poles_are_known(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, "scene planar\nbody b mass=1 inertia=1\nprismatic s ground b axis=x\n"
                      "spring k s k=100 d=1\nactuator F s force=0\nlag L m 0 of=s T=0.1\n"
                      "resistor R m n 1\nplatecap X s n 0 C=0.1*(1 + 0.3*s)\ninit X.v=1e-27\n"
                      "linearize inputs=[F] outputs=[X.v]\nshow transfer\n");
    EXPECT_HOLDS(kit.text, "at rest  0.01\n");
    table = bode(&kit, "bode from=0.001 to=10");
    expect_response(&table, 0, behind_two_lags, 0, 1e-9);
    bode_free(&table);
    kit_free(&kit);
}

/* --- a ladder: one recursion tells all of it --- */

enum { SECTIONS = 60 };

static double complex ladder(double complex s)
{
    double complex v = 1, i = 0; /* behind the last section */

    for (int k = 0; k < SECTIONS; k++) {
        i += 0.5 * s * v;
        v += 2 * i;
    }
    return 1 / v;
}

static void a_long_ladder_keeps_its_digits(void)
{
    Kit kit = kit_new();
    char line[200];
    Bode table;

    EXPECT_DONE(&kit, "vsource E1 n0 0 0\n");
    for (int k = 1; k <= SECTIONS; k++) {
        (void)snprintf(line, sizeof line, "resistor R%d n%d n%d 2\ncapacitor C%d n%d 0 0.5\n", k,
                       k - 1, k, k, k);
        EXPECT_DONE(&kit, line);
    }
    (void)snprintf(line, sizeof line, "linearize inputs=[E1] outputs=[C%d.v]\n", SECTIONS);
    EXPECT_DONE(&kit, line);
    table = bode(&kit, "bode from=1e-5 to=1 points=1000");
    expect_response(&table, 0, ladder, 0, 1e-8);
    EXPECT(bode_at(&table, 999 * 3 + 2) < -3600);
    bode_free(&table);
    kit_free(&kit);
}

/* --- other notations --- */

static void coefficients_go_to_other_programs(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, LOWPASS "show transfer 2 1 as matlab\n");
    EXPECT_HOLDS(kit.text, "% R1.v/E1\nnumerator{2,1} = [1, 0];\ndenominator{2,1} = [1, ");
    EXPECT_DONE(&kit, "show transfer as matlab\n");
    EXPECT_HOLDS(kit.text, "H = tf(numerator, denominator);\n");
    EXPECT_DONE(&kit, "show transfer as c\n");
    EXPECT_HOLDS(kit.text, "static const double numerator_2_1[2] = {1, 0};\n");
    EXPECT_DONE(&kit, "show transfer as latex\n");
    EXPECT_HOLDS(kit.text, "H_{2,1}(s) &= \\frac{s}{s + 1000} \\\\\n");
    kit_free(&kit);
}

/* --- what can't be done --- */

static void a_response_needs_something_linear_and_a_range(void)
{
    /* clang-format off */
    static const struct { const char *before, *line, *message, *hint; } wrong[] = {
        {"",              "bode h8",                   "nothing has been linearized yet", "linearize inputs"},
        {"",              "show transfer",             "nothing has been linearized yet", "linearize inputs"},
        {PENDULUM "linearize outputs=[h]\n", "bode",  "what was linearized has no inputs", "linearize inputs"},
        {PENDULUM "linearize\n", "show transfer",      "has no inputs and outputs",   ""},
        {LOWPASS,         "bode C1.i",                 "C1.i is no output of the last linearisation", "did you mean 'C1.v'"},
        {LOWPASS,         "bode from=10 to=1",         "the frequencies go up",       ""},
        {LOWPASS,         "bode from=0",               "from must be a frequency above 0", ""},
        {LOWPASS,         "bode from=1 kg",            "from= is a frequency",        "from=10 [rad/s]"},
        {LOWPASS,         "bode to=t",                 "to must be a number",         ""},
        {LOWPASS,         "bode points=1",             "a whole number from 2",       ""},
        {LOWPASS,         "show transfer 4",           "there are 3 outputs and 1 inputs", ""},
    };
    /* clang-format on */

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, wrong[i].before);
        EXPECT(kit_do(&kit, wrong[i].line) == CT_FAILED);
        EXPECT_HOLDS(kit.error.message, wrong[i].message);
        EXPECT_HOLDS(kit.error.hint, wrong[i].hint);
        kit_free(&kit);
    }
}

/* the poles lie at 160 Hz: a decade about them, whole decades */
static void without_a_range_all_roots_are_in_sight(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, LOWPASS);
    table = bode(&kit, "bode C1.v");
    EXPECT(bode_at(&table, 0) == 10 && bode_at(&table, 199 * 3) == 1000);
    bode_free(&table);
    table = bode(&kit, "bode C1.v from=1 MHz points=2");
    EXPECT(bode_at(&table, 0) == 1e6 && fabs(bode_at(&table, 3) - 1e8) < 1);
    bode_free(&table);
    kit_free(&kit);
}

/* C1 and C2 stand in a circuit with the source: R C1 s/(1 + R (C1 + C2) s) */
static void capacitors_across_a_source_jump_with_it(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit,
                "vsource E1 a 0 0\ncapacitor C1 a b 1\ncapacitor C2 b 0 2\nresistor R1 b 0 4\n"
                "linearize inputs=[E1] outputs=[C2.v, C1.v]\nshow linear\n");
    EXPECT_HOLDS(kit.text, "less what jumps with the inputs");
    EXPECT_DONE(&kit, "show transfer\n");
    EXPECT_HOLDS(kit.text, "C2.v/E1 = 0.333333 s/(s + 0.0833333)\n");
    EXPECT_HOLDS(kit.text, "C1.v/E1 = (0.666667 s + 0.0833333)/(s + 0.0833333)\n");
    EXPECT(kit_do(&kit, "linearize inputs=[E1] outputs=[C1.i]\n") != CT_OK);
    EXPECT_HOLDS(kit.error.message, "C1.i follows the rate of E1");
    kit_free(&kit);
}

static void what_is_shown_of_another_model_is_said(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, LOWPASS);
    EXPECT_DONE(&kit, "show transfer\n");
    EXPECT_LACKS(ct_remarks(kit.session), "before the model changed");
    EXPECT_DONE(&kit, "set R1.R = 5\nshow transfer\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "linearized before the model changed");
    kit_free(&kit);
}

/* --- parts far apart --- */

#define STAGE(k, from)                                                                             \
    "vccs g" k " n" k " 0 n" from " 0 gain=1\nresistor r" k " n" k " 0 1e5\ninductor l" k " n" k   \
    " 0 1\n"
#define FOUR_STAGES                                                                                \
    "isource iin 0 n1 0\nresistor r1 n1 0 1e5\ninductor l1 n1 0 1\n" STAGE("2", "1")               \
        STAGE("3", "2") STAGE("4", "3") "linearize inputs=[iin] outputs=[n4.v]\n"

/* -1e20 s^4/(s + 1e5)^4 */
static double complex stages(double complex s)
{
    return -1e20 * cpow(s / (s + 1e5), 4);
}

static void equal_stages_have_equal_poles(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, FOUR_STAGES "modes\n");
    EXPECT_HOLDS(kit.text, "   1           -100000         100000  15915.5        1  l4.i 1\n");
    EXPECT_HOLDS(kit.text, "   4           -100000         100000  15915.5        1  l4.i 1\n");
    EXPECT_DONE(&kit, "show transfer\n");
    EXPECT_HOLDS(kit.text, "poles    -100000, -100000, -100000, -100000\n");
    EXPECT_HOLDS(kit.text, "zeros    0?, 0?, 0?, 0?\n");
    EXPECT_HOLDS(kit.text, "at rest  0?\n");
    EXPECT_HOLDS(kit.text, "?        0 within ");
    EXPECT_DONE(&kit, "show linear\n");
    EXPECT_HOLDS(kit.text, "l4.i    1e+20   -1e+15    1e+10  -100000\n");
    table = bode(&kit, "bode from=1 kHz to=1 MHz points=50");
    expect_response(&table, 0, stages, 540, 1e-9);
    bode_free(&table);
    kit_free(&kit);
}

static double complex slow(double complex s)
{
    return 1e24 / ((s + 1e12) * (s + 1e6) * (s + 1e-6));
}

static void a_slow_pole_is_seen_beside_fast_ones(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, "vsource V a 0 0\nresistor R1 a b 1\ncapacitor C1 b 0 1 pF\n"
                      "vccs G 0 c b 0 gain=1\nresistor R2 c 0 1e6\ncapacitor C2 c 0 1e-12\n"
                      "vccs G2 0 d c 0 gain=1\nresistor R3 d 0 1e6\ncapacitor C3 d 0 1\n"
                      "linearize inputs=[V] outputs=[d.v]\nshow transfer\n");
    EXPECT_HOLDS(kit.text, "  at rest  1e+12\n  poles    -1e-06, -1e+06, -1e+12\n");
    table = bode(&kit, "bode from=1e-9 to=1e14 points=100");
    expect_response(&table, 0, slow, 0, 1e-9);
    bode_free(&table);
    kit_free(&kit);
}

static void coefficients_that_no_number_holds_are_not_printed(void)
{
    Kit kit = kit_new();
    char line[200];

    EXPECT_DONE(&kit, "vsource E1 n0 0 0\n");
    for (int k = 1; k <= 30; k++) {
        (void)snprintf(line, sizeof line, "resistor R%d n%d n%d 1e-6\ncapacitor C%d n%d 0 1e-6\n",
                       k, k - 1, k, k, k);
        EXPECT_DONE(&kit, line);
    }
    EXPECT_DONE(&kit, "linearize inputs=[E1] outputs=[C30.v, C1.v]\n");
    EXPECT_FAILS(&kit, "show transfer 1 1", "beyond what numbers hold");
    EXPECT_DONE(&kit, "show transfer 2 1\n");
    EXPECT_LACKS(kit.text, "inf");
    EXPECT_HOLDS(kit.text, "29 zeros and 30 poles");
    EXPECT_HOLDS(kit.text, "poles  -2.65182e+09, -2.38242e+10");
    EXPECT_FAILS(&kit, "show transfer 2 1 as c", "beyond what numbers hold");
    kit_free(&kit);
}

/* a leak far below the rounding of what it stands beside */
static void what_rounding_decides_is_marked(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "resistor R1 a b 1\nresistor R2 a 0 1e20\ncapacitor C1 a 0 1\n"
                      "capacitor C2 b 0 1\nmodes\n");
    EXPECT_HOLDS(kit.text, "   1                0?");
    EXPECT_HOLDS(kit.text, "   2                -2");
    EXPECT_HOLDS(kit.text, "? 0 within ");
    EXPECT_HOLDS(kit.text, "rounding leaves open whether it grows or fades\n");
    kit_free(&kit);
}

/* a bridge whose arms divide alike, and two ways that cancel: 1 is left of 2^106 */
static void what_cancels_within_rounding_is_no_number(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, "vsource E a 0 0\nresistor R1 a b 3\nresistor R2 b 0 7\nresistor R3 a c 0.3\n"
                      "resistor R4 c 0 0.7\ncapacitor C b c 1 uF\n"
                      "linearize inputs=[E] outputs=[C.v]\n");
    EXPECT_HOLDS(kit.text, "B    E\nC.v  0\n");
    EXPECT_DONE(&kit, "clear\nvsource E u 0 0\nintegrator I0 x0 0 of=u.v k=1\n"
                      "integrator A1 a1 0 of=x0.v k=9007199254740991\n"
                      "integrator A2 a2 0 of=a1.v k=9007199254740991\n"
                      "integrator B1 b1 0 of=x0.v k=9007199254740990\n"
                      "integrator B2 b2 0 of=b1.v k=9007199254740992\n"
                      "linearize inputs=[E] outputs=[(a2.v - b2.v)]\nshow transfer\n");
    EXPECT_HOLDS(kit.text, " = 0?\n");
    EXPECT_HOLDS(kit.text, "rounding leaves open whether anything gets through\n");
    EXPECT_DONE(&kit, "linearize inputs=[E] outputs=[(a2.v - b2.v), x0.v]\n");
    table = bode(&kit, "bode from=1 to=100 points=3");
    EXPECT_HOLDS(ct_remarks(kit.session), "(a2.v - b2.v)/E is 0 within ");
    EXPECT_LACKS(ct_remarks(kit.session), "x0.v/E is 0");
    for (int row = 0; row < 3; row++) {
        const double omega = 2 * M_PI * pow(10, row);

        EXPECT(isnan(bode_at(&table, 5 * row + 1)) && isnan(bode_at(&table, 5 * row + 2)));
        EXPECT_NEAR(bode_at(&table, 5 * row + 3), -20 * log10(omega), 1e-9);
    }
    bode_free(&table);
    kit_free(&kit);
}

/* a mass beside a filter, and the filter */
static void what_nothing_reaches_has_no_curve(void)
{
    Kit kit = kit_new();
    Bode table;

    EXPECT_DONE(&kit, "scene planar\nbody b mass=1\nprismatic s ground b axis=x\nspring k s k=100\n"
                      "vsource E a 0 0\nresistor R a c 1 kohm\ncapacitor C c 0 1 uF\n"
                      "linearize inputs=[E] outputs=[s, C.v]\n");
    table = bode(&kit, "bode from=1 to=100 points=3");
    EXPECT_TEXT(ct_remarks(kit.session), "s/E is 0: it has no curve\n");
    for (int row = 0; row < 3; row++) {
        EXPECT(isnan(bode_at(&table, 5 * row + 1)) && isnan(bode_at(&table, 5 * row + 2)));
        EXPECT(isfinite(bode_at(&table, 5 * row + 3)) && isfinite(bode_at(&table, 5 * row + 4)));
    }
    bode_free(&table);
    kit_free(&kit);
}

int main(void)
{
    RUN(a_low_pass_falls_by_20_decibels_a_decade);
    RUN(capacitors_across_a_source_jump_with_it);
    RUN(what_is_shown_of_another_model_is_said);
    RUN(a_resonant_circuit_passes_a_band);
    RUN(a_motor_turns_its_inertia);
    RUN(what_floats_has_two_poles_at_0);
    RUN(equal_poles_and_zeros_are_left_out);
    RUN(zeros_beside_hidden_poles_are_known);
    RUN(zeros_far_beyond_poles_are_known);
    RUN(a_long_ladder_keeps_its_digits);
    RUN(equal_stages_have_equal_poles);
    RUN(a_slow_pole_is_seen_beside_fast_ones);
    RUN(what_rounding_decides_is_marked);
    RUN(what_cancels_within_rounding_is_no_number);
    RUN(what_nothing_reaches_has_no_curve);
    RUN(coefficients_that_no_number_holds_are_not_printed);
    RUN(coefficients_go_to_other_programs);
    RUN(a_response_needs_something_linear_and_a_range);
    RUN(without_a_range_all_roots_are_in_sight);
    return test_end();
}
