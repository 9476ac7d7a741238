/* test_linear.c: equilibrium, linearize and modes against closed forms
 *
 * Numbers are asked of a session, so that what the language says is tested too. */
#include "session_kit.h"

#include "base/text.h"

static void expect_value(Kit *kit, const char *expression, double wanted, double tolerance)
{
    double got = kit_value(kit, expression);

    if (!(fabs(got - wanted) <= tolerance)) {
        test_faults++;
        printf("%s is %.17g, wanted %.17g within %.3g\n", expression, got, wanted, tolerance);
    }
}

/* modes.omega(1..count) */
static void expect_omegas(Kit *kit, const double *wanted, int count, double tolerance)
{
    for (int i = 0; i < count; i++) {
        char text[40];

        (void)snprintf(text, sizeof text, "modes.omega(%d)", i + 1);
        expect_value(kit, text, wanted[i], tolerance * wanted[i]);
    }
}

/* two rods without inertia of their own: length 1, mass 1 at the ends */
#define TWO_PENDULUMS                                                                              \
    "scene planar\n"                                                                               \
    "gravity [0, -9.81]\n"                                                                         \
    "body a mass=1 inertia=0\n"                                                                    \
    "arm pa a [0, 1]\n"                                                                            \
    "revolute h1 ground pa\n"                                                                      \
    "body b mass=1 inertia=0\n"                                                                    \
    "arm pb b [0, 1]\n"                                                                            \
    "revolute h2 a pb\n"

/* --- modes --- */

/* six masses on springs with dampers: up to six parts a mode, late by angles of all sizes */
static void modes_keep_to_the_page(void)
{
    Text text = {0};
    Kit kit = kit_new();
    int longest = 0, parts = 0;

    text_add(&text, "scene planar\narm n0 ground [0, 0]\n");
    for (int i = 1; i <= 6; i++)
        text_addf(&text,
                  "body mass%d mass=%d inertia=1\nprismatic shift_%d %s%d mass%d axis=x\n"
                  "spring k%d shift_%d k=%d\ndamper d%d shift_%d d=%d\n",
                  i, i, i, i == 1 ? "n" : "mass", i - 1, i, i, i, 100 * i, i, i, i * i % 5);
    text_add(&text, "equilibrium\nmodes\n");
    EXPECT_DONE(&kit, text.at);
    for (const char *line = kit.text; *line != '\0'; line += strcspn(line, "\n") + 1)
        longest = (int)strcspn(line, "\n") > longest ? (int)strcspn(line, "\n") : longest;
    for (const char *at = kit.text; (at = strstr(at, "shift_")) != NULL; at++)
        parts++;
    EXPECT(longest <= 80);
    EXPECT(parts == 36);
    /* a part and its angle hold together */
    EXPECT_LACKS(kit.text, "\n      (");
    EXPECT_LACKS(kit.text, "\n      0");
    kit_free(&kit);
    text_free(&text);
}

static void modes_may_stand_in_any_expression(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, TWO_PENDULUMS "equilibrium\nmodes\n");
    EXPECT_DONE(&kit, "expect max(modes.omega(1), modes.omega(2), 1) ~ modes.omega(2) within 0\n"
                      "expect min(modes.omega(2), 100, modes.omega(1)) ~ modes.omega(1) within 0\n"
                      "expect max(modes.damping(1), modes.damping(2), -1) ~ 0 within 1e-12\n");
    EXPECT(kit_do(&kit, "print modes.omega(3)") != CT_OK);
    EXPECT_TEXT(kit.error.message, "there are 2 modes, counted from 1");
    EXPECT_DONE(&kit, "clear\n" PENDULUM "equilibrium\nmodes\n");
    EXPECT(kit_do(&kit, "print modes.omega(2)") != CT_OK);
    EXPECT_TEXT(kit.error.message, "there is 1 mode, counted from 1");
    kit_free(&kit);
}

static void a_pendulum_swings_at_the_root_of_g_over_l(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "equilibrium\nmodes\n");
    expect_value(&kit, "modes.omega(1)", sqrt(9.81), 1e-12);
    expect_value(&kit, "modes.damping(1)", 0, 1e-14);
    kit_free(&kit);
}

static void two_pendulums_have_their_two_modes_in_any_trees(void)
{
    const double wanted[] = {sqrt(9.81 * (2 - sqrt(2))), sqrt(9.81 * (2 + sqrt(2)))};
    static const char *const trees[] = {"", "tree absolute\n", "tree joint\n",
                                        "tree absolute\nform embedded\n"};

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, TWO_PENDULUMS "init h1 = 0.3\nequilibrium\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "modes\n");
        expect_omegas(&kit, wanted, 2, 1e-10);
        kit_free(&kit);
    }
}

/* bodies that also turn about the vertical for nothing, in coordinates that see it differently */
static void spatial_pendulums_have_the_modes_of_planar_ones(void)
{
    static const char *const trees[] = {"tree joint\n", "tree absolute\n"};

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "gravity [0, 0, -9.81]\n"
                          "body m1 mass=2 inertia=[0.1, 0.2, 0.25]\n"
                          "arm p1 m1 [0, 0, 0.5]\n"
                          "spherical j1 ground p1\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "equilibrium\nmodes\n");
        expect_value(&kit, "modes.omega(1)", 0, 1e-12);
        expect_value(&kit, "modes.omega(2)", 0, 1e-12);
        expect_value(&kit, "modes.omega(3)", sqrt(2 * 9.81 * 0.5 / (0.2 + 0.5)), 1e-11);
        expect_value(&kit, "modes.omega(4)", sqrt(2 * 9.81 * 0.5 / (0.1 + 0.5)), 1e-11);
        kit_free(&kit);
    }
}

/* two masses on a line with a spring between them, and nothing else: k (1/m + 1/M) */
static void what_floats_has_modes_of_frequency_0(void)
{
    static const char *const trees[] = {"tree absolute\n", "tree s1 s2\n"};

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "scene planar\nbody a mass=1 inertia=1\nbody b mass=3 inertia=1\n"
                          "prismatic s1 ground a axis=x\nprismatic s2 a b axis=x\n"
                          "spring k1 s2 k=12\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "modes\n");
        expect_value(&kit, "modes.omega(1)", 0, 0);
        expect_value(&kit, "modes.omega(2)", 0, 0);
        expect_value(&kit, "modes.omega(3)", 4, 1e-12);
        kit_free(&kit);
    }
}

/* relative angle of the slow mode: (sqrt(2) - 1) of the first, along; of the fast one against */
static void shapes_tell_what_moves_with_and_against(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, TWO_PENDULUMS "equilibrium\nmodes\n");
    EXPECT_HOLDS(kit.text, "h1 1, h2 0.414\n");
    EXPECT_HOLDS(kit.text, "h2 1, h1 -0.414\n");
    EXPECT_DONE(&kit, "export csv modes");
    EXPECT_HOLDS(kit.text,
                 "mode,real,imaginary,omega,frequency,damping,error,h1,h1 phase [deg],h2,");
    kit_free(&kit);
}

/* L C s^2 + R C s + 1 */
static void a_series_circuit_has_its_poles(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E1 a 0 10*cos(t)\nresistor R1 a b 2\ninductor L1 b c 0.5\n"
                      "capacitor C1 c 0 0.1\nop\nmodes\n");
    expect_value(&kit, "C1.v", 10, 1e-12);
    expect_value(&kit, "modes.omega(1)", sqrt(20), 1e-12);
    expect_value(&kit, "modes.damping(1)", 1 * sqrt(0.1 / 0.5), 1e-12);
    EXPECT_DONE(&kit, "set R1.R = 20\nmodes\n");
    expect_value(&kit, "modes.omega(1)", 20 - sqrt(380), 1e-11);
    expect_value(&kit, "modes.omega(2)", 20 + sqrt(380), 1e-11);
    expect_value(&kit, "modes.damping(2)", 1, 1e-14);
    kit_free(&kit);
}

static void what_falls_over_has_a_negative_damping(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "init h = 179 deg\nequilibrium\nmodes\n");
    expect_value(&kit, "abs(h)", 3.14159265358979323846, 1e-12);
    expect_value(&kit, "modes.omega(1)", sqrt(9.81), 1e-10);
    expect_value(&kit, "modes.damping(1)", -1, 1e-12);
    expect_value(&kit, "modes.damping(2)", 1, 1e-12);
    kit_free(&kit);
}

static void what_cannot_move_has_no_modes_and_says_why(void)
{
#define FIXED    "scene planar\nbody b mass=1 inertia=1\nweld w ground b\n"
#define RESISTOR "vsource V a 0 1\nresistor R a 0 1\n"
    static const struct {
        const char *model, *why;
    } cases[] = {
        {PENDULUM "driver D1 h = 60 deg\n", "drivers prescribe all motion (D1)"},
        {PENDULUM "driver D1 h = 60 deg\n" RESISTOR,
         "drivers prescribe all motion (D1), and nothing in the"},
        {FIXED, "no joint leaves a motion free"},
        {FIXED "revolute h ground b\n", "the joints together leave no motion free"},
        {RESISTOR, "nothing in the network stores energy"},
        {"scene planar\n", "there are no bodies and no network"},
    };

    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        Kit kit = kit_new();
        char line[120];

        EXPECT_DONE(&kit, cases[i].model);
        EXPECT_DONE(&kit, "modes");
        (void)snprintf(line, sizeof line, "no modes: %s", cases[i].why);
        EXPECT_HOLDS(kit.text, line);
        EXPECT_DONE(&kit, "linearize");
        (void)snprintf(line, sizeof line, "states  none: %s", cases[i].why);
        EXPECT_HOLDS(kit.text, line);
        EXPECT_FAILS(&kit, "print modes.omega(1)", "there are no modes");
        EXPECT_HOLDS(kit.error.hint, "'modes' shows why");
        kit_free(&kit);
    }
#undef FIXED
#undef RESISTOR
}

/* --- linear equations --- */

/* M l^2 = 0.08 + J = 0.03, K = 0.8, R = 1.2, L = 0.05 at the angle where K V/R holds M g l cos */
static void the_motor_arm_is_linear_as_by_hand(void)
{
    const double inertia = 2 * 0.04 + 0.03, weight = 2 * 9.81 * 0.2;
    Kit kit = kit_new();
    double theta;

    EXPECT_DONE(&kit, MOTOR_ARM "set V1.value = 5 + sin(t)\ninit theta = -30 deg\nequilibrium\n");
    theta = kit_value(&kit, "theta");
    EXPECT_NEAR(weight * cos(theta), 0.8 * 5 / 1.2, 1e-12);
    expect_value(&kit, "M7.i", 5 / 1.2, 1e-12);
    EXPECT_DONE(&kit, "linearize inputs=[V1, a] outputs=[theta, M7.torque, m1.ay]\n");
    expect_value(&kit, "linear.A(1,2)", 1, 1e-14);
    expect_value(&kit, "linear.A(2,1)", weight * sin(theta) / inertia, 1e-10);
    expect_value(&kit, "linear.A(2,3)", 0.8 / inertia, 1e-12);
    expect_value(&kit, "linear.A(3,2)", -0.8 / 0.05, 1e-12);
    expect_value(&kit, "linear.A(3,3)", -1.2 / 0.05, 1e-12);
    expect_value(&kit, "linear.B(3,1)", 1 / 0.05, 1e-12);
    /* (K i - M g a cos)/(J + M a^2), whose numerator is 0 here */
    expect_value(&kit, "linear.B(2,2)", -2 * 9.81 * cos(theta) / inertia, 1e-10);
    expect_value(&kit, "linear.C(2,3)", 0.8, 1e-12);
    expect_value(&kit, "linear.C(3,3)", 0.2 * cos(theta) * 0.8 / inertia, 1e-11);
    expect_value(&kit, "linear.D(1,1)", 0, 0);
    kit_free(&kit);
}

/* h'' = -g sin(h): at an instant of a run the slope is -g cos(h) */
static void an_instant_of_a_run_is_where_it_is_then(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "simulate 1 rtol=1e-10\nlinearize at=0.37\n");
    expect_value(&kit, "linear.A(2,1) + 9.81*cos(h) at 0.37", 0, 1e-9);
    kit_free(&kit);
}

/* At rest at an angle a pendulum has h'' = -g sin(h), or, of x = sin(h),
 * x'' = -g x sqrt(1 - x^2) - x x'^2/(1 - x^2): the slopes there aren't each other's. Hanging down
 * they are, and so they are where a wheel turns, whose equations stay as they are. */
static void modes_of_no_rest_say_whose_they_are(void)
{
    static const struct {
        const char *statements;
        double omega;
        const char *remark; /* part of it, NULL: none */
    } cases[] = {
        {PENDULUM "init h = 30 deg\nmodes", 9.81 * 0.86602540378443865, "of the coordinates h;"},
        {PENDULUM "tree absolute\nform embedded independent=m.x\ninit h = 30 deg\nmodes",
         9.81 * 0.5 / 0.86602540378443865, "of the coordinates m.x;"},
        {PENDULUM "simulate 1\nmodes at=0.3", NAN, "no rest and no steady motion at t = 0.3 s"},
        {PENDULUM "equilibrium\nmodes", 9.81, NULL},
        {PENDULUM "tree absolute\nform embedded independent=m.x\nequilibrium\nmodes", 9.81, NULL},
        {"scene planar\nbody m mass=1 inertia=2\nrevolute h ground m\ninit h' = 30\n"
         "simulate 1\nmodes at=0.5",
         0, NULL}};

    for (int i = 0; i < (int)(sizeof cases / sizeof cases[0]); i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, cases[i].statements);
        if (cases[i].remark != NULL)
            EXPECT_HOLDS(ct_remarks(kit.session), cases[i].remark);
        else
            EXPECT_LACKS(ct_remarks(kit.session), "coordinates");
        if (cases[i].omega == cases[i].omega)
            expect_value(&kit, "modes.omega(1)^2", cases[i].omega, 1e-9);
        kit_free(&kit);
    }
}

/* its poles are the same eigenvalues */
static void poles_of_no_rest_say_whose_they_are(void)
{
    static const char *const looks[] = {"show transfer", "show linear"};

    for (int i = 0; i < 4; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, PENDULUM "k = 0\nactuator f h torque=k\ninit h = 30 deg");
        EXPECT_DONE(&kit, i % 2 == 0 ? "linearize inputs=[k] outputs=[h]"
                                     : "equilibrium\nlinearize inputs=[k] outputs=[h]");
        EXPECT_DONE(&kit, looks[i / 2]);
        if (i % 2 == 0)
            EXPECT_HOLDS(ct_remarks(kit.session), "the poles are those of the coordinates h;");
        else
            EXPECT_LACKS(ct_remarks(kit.session), "coordinates");
        kit_free(&kit);
    }
}

/* rotating body without moments, in its own axes: I w' = (I w) x w, s' = dw - w x s */
static void small_turns_of_a_spinning_body_follow_its_axes(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit,
                "body m1 mass=2 inertia=[0.1, 0.2, 0.25]\ninit m1.Wx = 3, m1.Wy = 2, m1.Wz = 5\n"
                "linearize\n");
    EXPECT_HOLDS(kit.text, "m1.turnX");
    /* states: x y z and turns, then their rates */
    expect_value(&kit, "linear.A(4,5)", 5, 1e-12);
    expect_value(&kit, "linear.A(5,4)", -5, 1e-12);
    expect_value(&kit, "linear.A(4,6)", -2, 1e-12);
    expect_value(&kit, "linear.A(5,6)", 3, 1e-12);
    expect_value(&kit, "linear.A(4,10)", 1, 1e-12);
    expect_value(&kit, "linear.A(4,4)", 0, 1e-12);
    expect_value(&kit, "linear.A(10,11)", (0.2 - 0.25) / 0.1 * 5, 1e-11);
    expect_value(&kit, "linear.A(12,10)", (0.1 - 0.2) / 0.25 * 2, 1e-11);
    kit_free(&kit);
}

/* The planar slider-crank by hand: x = a cos h + b cos p, b sin p = a sin h, one coordinate h. */
typedef struct Crank {
    double a, b, c1, c2, k, rest; /* crank, rod; centres of mass from the pin and the slide end */
    double m1, j1, m2, j2, m3;
} Crank;

/* energies: potential, and half the mass felt by h' */
static void crank_energies(const Crank *s, double h, double *potential, double *mass)
{
    double p = asin(s->a * sin(h) / s->b);
    double p_h = s->a * cos(h) / (s->b * cos(p)), x_h = -s->a * sin(h) - s->b * sin(p) * p_h;
    double x = s->a * cos(h) + s->b * cos(p);
    /* the rod's centre: c2 from the slide end */
    double y2 = s->c2 * sin(p), y2_h = s->c2 * cos(p) * p_h, x2_h = x_h + s->c2 * sin(p) * p_h;

    *potential =
        9.81 * (s->m1 * s->c1 * sin(h) + s->m2 * y2) + s->k / 2 * (x - s->rest) * (x - s->rest);
    *mass = s->m1 * s->c1 * s->c1 + s->j1 + s->m2 * (x2_h * x2_h + y2_h * y2_h) +
            s->j2 * p_h * p_h + s->m3 * x_h * x_h;
}

/* omega^2 is V'' over the mass at the place where V' = 0; V'' by differences of high order */
static void the_slider_crank_with_a_spring_swings_as_one_coordinate_does(void)
{
    const Crank crank = {0.2, 0.6, 0.08, 0.35, 100, 0.7, 2, 0.01, 1.2, 0.03, 3};
    static const double weights[] = {-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
    Kit kit = kit_new();
    double h, mass, potential, second = 0;

    EXPECT_DONE(&kit,
                SLIDER_CRANK ONE_TREE "delete F12\nspring k1 s11 k=100 rest=0.7\n"
                                      "init h8 = 20 deg\nguess h10 = 2.85\nequilibrium\nmodes\n");
    h = kit_value(&kit, "h8");
    for (int i = -4; i <= 4; i++) {
        crank_energies(&crank, h + 0.02 * i, &potential, &mass);
        second += weights[i < 0 ? -i : i] * potential / (0.02 * 0.02);
    }
    crank_energies(&crank, h, &potential, &mass);
    expect_value(&kit, "modes.omega(1)", sqrt(second / mass), 1e-8);
    EXPECT_DONE(&kit, TWO_TREES "modes\n");
    expect_value(&kit, "modes.omega(1)", sqrt(second / mass), 1e-8);
    EXPECT_DONE(&kit, "tree absolute\nform embedded independent=[m1.theta]\nmodes\n");
    expect_value(&kit, "modes.omega(1)", sqrt(second / mass), 1e-8);
    kit_free(&kit);
}

/* an expression at a start a little off */
static double value_at(Kit *kit, double h, double rate, const char *expression)
{
    char line[120];

    (void)snprintf(line, sizeof line, "init h8 = %.17g, h8' = %.17g\n", h, rate);
    EXPECT_DONE(kit, line);
    return kit_value(kit, expression);
}

/* by differences of order 4, in position or in rate */
static double slope(Kit *kit, bool of_rate, const char *expression)
{
    const double h = 1.1, rate = 12, step = 1e-3;
    const double dh = of_rate ? 0 : step, dr = of_rate ? step : 0;

    return (8 * (value_at(kit, h + dh, rate + dr, expression) -
                 value_at(kit, h - dh, rate - dr, expression)) -
            value_at(kit, h + 2 * dh, rate + 2 * dr, expression) +
            value_at(kit, h - 2 * dh, rate - 2 * dr, expression)) /
           (12 * step);
}

static void a_moving_mechanism_has_the_slopes_of_neighbouring_motions(void)
{
    static const char *const trees[] = {ONE_TREE, TWO_TREES,
                                        "tree m1 m2 m3\nform embedded independent=[m1.theta]\n"};

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();
        double slopes[4];

        EXPECT_DONE(&kit, SLIDER_CRANK CRANK_START);
        EXPECT_DONE(&kit, trees[i]);
        slopes[0] = slope(&kit, false, "h8''");
        slopes[1] = slope(&kit, true, "h8''");
        slopes[2] = slope(&kit, false, "h9.fx");
        slopes[3] = slope(&kit, true, "m2.vy");
        EXPECT_DONE(&kit, "init h8 = 1.1, h8' = 12\nlinearize outputs=[h9.fx, m2.vy]\n");
        expect_value(&kit, "linear.A(2,1)", slopes[0], 1e-7 * fabs(slopes[0]));
        expect_value(&kit, "linear.A(2,2)", slopes[1], 1e-7 * fabs(slopes[1]));
        expect_value(&kit, "linear.C(1,1)", slopes[2], 1e-7 * fabs(slopes[2]));
        expect_value(&kit, "linear.C(2,2)", slopes[3], 1e-9);
        kit_free(&kit);
    }
}

/* --- equilibrium --- */

static void runs_start_at_the_equilibrium_until_init(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "spring k1 h k=3 rest=60 deg\nequilibrium\nsimulate 1\n");
    expect_value(&kit, "9.81*sin(h) - 3*(60 deg - h)", 0, 1e-9);
    expect_value(&kit, "max(h) - min(h)", 0, 1e-12);
    EXPECT_DONE(&kit, "init h = 60 deg\nsimulate 1\n");
    EXPECT(kit_value(&kit, "max(h) - min(h)") > 0.1);
    kit_free(&kit);
}

static void a_change_of_numbers_starts_from_the_old_equilibrium(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit,
                "E = 1\nvsource V1 a 0 E\nresistor R1 a b 2\ncapacitor C1 b 0 0.5\nop\nE = 3\n"
                "simulate 1\n");
    expect_value(&kit, "C1.v at 0", 1, 1e-12);
    expect_value(&kit, "C1.v at 1", 3 - 2 * exp(-1), 1e-7);
    EXPECT_DONE(&kit, "assemble\n");
    expect_value(&kit, "C1.v", 1, 1e-12);
    EXPECT_DONE(&kit, "guess none\n");
    expect_value(&kit, "C1.v", 0, 0);
    kit_free(&kit);
}

/* far from the start, with forces that bend the way there */
static void a_heavy_chain_finds_its_rest_from_anywhere(void)
{
    static const double starts[] = {1, 2, 2.8, -2};

    for (size_t i = 0; i < sizeof starts / sizeof starts[0]; i++) {
        Kit kit = kit_new();
        char line[80];

        EXPECT_DONE(&kit, TWO_PENDULUMS);
        (void)snprintf(line, sizeof line, "init h1 = %g, h2 = %g\nequilibrium\n", starts[i],
                       -0.7 * starts[i]);
        EXPECT_DONE(&kit, line);
        expect_value(&kit, "sin(h1)", 0, 1e-9);
        expect_value(&kit, "sin(h1 + h2)", 0, 1e-9);
        kit_free(&kit);
    }
}

static void note_phase(void *context, const char *phase, double fraction)
{
    (void)fraction;
    (void)snprintf(context, 80, "%s", phase);
}

/* Newton's method gets stuck at a residual that is least but not 0: what goes on from there */
static void where_newton_gets_stuck_other_ways_go_on(void)
{
    static const struct {
        const char *spring, *force, *start, *residual, *phase;
    } cases[] = {
        /* r = s - 4 + 4 sin(2 s), positive and least near 8.57 */
        {"spring k1 s k=1\n", "4 - 4*sin(2*s)", "8.5", "s - 4 + 4*sin(2*s)",
         "equilibrium: source stepping"},
        /* near -1 nearly a root, with loads of any size */
        {"", "-(s - 2)*((s + 1)^2 + 0.1)", "-1", "s - 2", "equilibrium: creeping"},
    };

    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        Kit kit = kit_new();
        char line[200], phase[80] = "";
        ct_hooks hooks = {.context = phase, .progress = note_phase};

        (void)snprintf(line, sizeof line,
                       "scene planar\nbody a mass=1 inertia=1\nprismatic s ground a axis=x\n"
                       "%sactuator f1 s force=%s\ninit s = %s\n",
                       cases[i].spring, cases[i].force, cases[i].start);
        EXPECT_DONE(&kit, line);
        ct_session_hooks(kit.session, &hooks);
        EXPECT_DONE(&kit, "equilibrium\n");
        EXPECT_TEXT(phase, cases[i].phase);
        expect_value(&kit, cases[i].residual, 0, 1e-9);
        kit_free(&kit);
    }
}

static bool stop_now(void *context)
{
    (void)context;
    return true;
}

static void a_search_can_be_stopped(void)
{
    Kit kit = kit_new();
    const ct_hooks hooks = {.stop = stop_now};

    EXPECT_DONE(&kit, "scene planar\nbody a mass=1 inertia=1\nprismatic s ground a axis=x\n"
                      "actuator f1 s force=1\n");
    (void)kit_value(&kit, "s");
    ct_session_hooks(kit.session, &hooks);
    EXPECT(kit_do(&kit, "equilibrium") == CT_STOPPED);
    kit_free(&kit);
}

/* a driver that moves: at rest it stands where it is at t = 0 */
static void a_moving_driver_stands_still_in_the_search_and_moves_after_it(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, TWO_PENDULUMS "driver D1 h1 = 90 deg + 3*t\nequilibrium\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "drivers move, which an equilibrium leaves out");
    expect_value(&kit, "h1", 1.5707963267948966, 1e-12);
    expect_value(&kit, "cos(h2)", 0, 1e-9);
    expect_value(&kit, "h1'", 3, 1e-12);
    kit_free(&kit);
}

/* what a driver moves goes on, and all else rests against it: a pendulum on a shaft that turns, at
 * cos h = g/(W^2 l), swings about it with W sin h */
#define GOVERNOR                                                                                   \
    "W = 7; l = 0.5\ngravity [0, 0, -9.81]\nbody s mass=1 inertia=[0.1, 0.1, 0.1]\n"               \
    "body m mass=2 inertia=[1e-9, 1e-9, 1e-9]\narm top m [0, 0, l]\n"                              \
    "revolute hub ground s axis=z\nrevolute h s top axis=y\nguess h = 60 deg\n"

static void a_governor_rests_against_its_shaft(void)
{
    static const char *const drivers[] = {"driver D hub = W*t\nequilibrium at=0\n",
                                          "driver D hub = W*t\nequilibrium at=3 s\n",
                                          "driver D hub = 1 - W*t + (t - 2)^3\nequilibrium at=2\n"};
    const double h = acos(9.81 / (49 * 0.5));

    for (int i = 0; i < (int)(sizeof drivers / sizeof *drivers); i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, GOVERNOR);
        EXPECT_DONE(&kit, drivers[i]);
        expect_value(&kit, "h", h, 1e-12);
        expect_value(&kit, "h'", 0, 1e-12);
        EXPECT(fabs(fabs(kit_value(&kit, "hub'")) - 7) < 1e-12);
        EXPECT_DONE(&kit, "modes\n");
        expect_value(&kit, "modes.omega(1)", 7 * sin(h), 1e-8);
        EXPECT_DONE(&kit, "simulate 1\n");
        if (i < 2)
            expect_value(&kit, "h", h, 1e-6);
        kit_free(&kit);
    }
}

static void what_has_to_move_with_a_driver_is_named(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody a mass=1 inertia=1\nbody b mass=1 inertia=1\n"
                      "arm a1 a [1, 0]\narm b1 b [2, 0]\nrevolute h1 ground a\n"
                      "body c mass=1 inertia=1\nrevolute h2 a1 b\nprismatic s ground c axis=x\n"
                      "revolute h3 b1 c\ndriver D h1 = 1 + t\nguess s = 2\n");
    EXPECT(kit_do(&kit, "equilibrium at=0") != CT_OK);
    EXPECT_HOLDS(kit.error.message, "has to move with what is driven at t = 0 s");
    EXPECT_HOLDS(kit.error.hint, "no closed loop is driven");
    EXPECT_DONE(&kit, "equilibrium\n");
    kit_free(&kit);
}

/* --- wrong uses --- */

static void wrong_uses_are_refused_with_a_way_out(void)
{
    /* clang-format off */
    static const Refusal wrong[] = {
        {PENDULUM, "equilibrium at=h", 16, "made of parameters", ""},
        {PENDULUM, "equilibrium at=1 m", 18, "an instant", ""},
        {PENDULUM, "modes at=1", 10, "there is none", "without at= it is about the start"},
        {PENDULUM "simulate 1\n", "modes at=2", 1, "outside the run", ""},
        {PENDULUM "simulate 1\n", "modes at=h", 10, "made of parameters", ""},
        {PENDULUM, "linearize inputs=[m]", 18, "no value that an input could be", "parameters"},
        {PENDULUM "stiff = 3\n", "linearize inputs=[stif]", 19, "none is called 'stif'", "did you mean 'stiff'"},
        {PENDULUM, "linearize inputs=[2*L]", 19, "a source, an actuator or a parameter", "inputs=[V1]"},
        {PENDULUM, "linearize outputs=[q]", 20, "unknown name 'q'", ""},
        {PENDULUM, "linearize input=[L]", 11, "has no key 'input'", "did you mean 'inputs'"},
        {PENDULUM, "print modes.omega(1)", 7, "there are no modes yet", "'modes' finds them"},
        {PENDULUM "modes\n", "print modes.omega(2)", 7, "there is 1 mode", ""},
        {PENDULUM, "print linear.A(1,2)", 7, "nothing has been linearized", "linearize inputs"},
        {PENDULUM "linearize\n", "print linear.A(3,1)", 7, "has 2 rows and 2 columns", ""},
        {PENDULUM "linearize\n", "print linear.A(h,1)", 16, "picked by whole numbers", ""},
        {PENDULUM, "show linear", 6, "nothing has been linearized", "linearize inputs"},
        {PENDULUM, "export csv modes", 12, "there are no modes yet", "'modes' finds them"},
        {PENDULUM "torque T1 m 30\n", "equilibrium", 1, "no equilibrium was found; missed: the forces on h by", "keeps moving"},
    };
    /* clang-format on */

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        kit_expect_refused(&wrong[i]);
}

static void a_model_that_changed_has_no_inputs_at_an_old_instant(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "actuator a1 h torque=0\nsimulate 1\nbody m2 mass=1\n");
    EXPECT(kit_do(&kit, "linearize at=1 inputs=[a1]") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "has changed since the run");
    kit_free(&kit);
}

static void many_equilibria_are_spoken_of(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(
        &kit,
        "scene planar\nbody m1 mass=1 inertia=1\nprismatic s1 ground m1 axis=x\nequilibrium\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "1 direction in which nothing pushes back");
    kit_free(&kit);
}

/* --- what is shown --- */

static void matrices_are_written_in_other_notations(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E1 a 0 1\nresistor R1 a b 2\ncapacitor C1 b 0 0.5\n"
                      "linearize inputs=[E1] outputs=[C1.v]\nshow linear\n");
    EXPECT_HOLDS(kit.text, "A     C1.v\nC1.v    -1\n");
    EXPECT_DONE(&kit, "show linear as matlab\n");
    EXPECT_HOLDS(kit.text, "A = [-1];\nB = [1];\nC = [1];\nD = [0];\n");
    EXPECT_DONE(&kit, "show linear as c\n");
    EXPECT_HOLDS(kit.text, "static const double A[1][1] = {{-1}};\n");
    EXPECT_DONE(&kit, "show linear as latex\n");
    EXPECT_HOLDS(kit.text, "A &= \\begin{bmatrix} -1 \\end{bmatrix}");
    EXPECT_DONE(&kit, "set C1.C = 1e-9\nlinearize inputs=[E1] outputs=[C1.v]\n"
                      "show linear as latex\n");
    EXPECT_HOLDS(kit.text, "A &= \\begin{bmatrix} -5\\cdot 10^{8} \\end{bmatrix}");
    EXPECT_DONE(&kit, "show transfer as latex\n");
    EXPECT_HOLDS(kit.text, "\\frac{5\\cdot 10^{8}}{s + 5\\cdot 10^{8}}");
    kit_free(&kit);
}

int main(void)
{
    RUN(modes_keep_to_the_page);
    RUN(modes_may_stand_in_any_expression);
    RUN(a_pendulum_swings_at_the_root_of_g_over_l);
    RUN(two_pendulums_have_their_two_modes_in_any_trees);
    RUN(spatial_pendulums_have_the_modes_of_planar_ones);
    RUN(what_floats_has_modes_of_frequency_0);
    RUN(shapes_tell_what_moves_with_and_against);
    RUN(a_series_circuit_has_its_poles);
    RUN(what_falls_over_has_a_negative_damping);
    RUN(what_cannot_move_has_no_modes_and_says_why);
    RUN(the_motor_arm_is_linear_as_by_hand);
    RUN(an_instant_of_a_run_is_where_it_is_then);
    RUN(modes_of_no_rest_say_whose_they_are);
    RUN(poles_of_no_rest_say_whose_they_are);
    RUN(small_turns_of_a_spinning_body_follow_its_axes);
    RUN(the_slider_crank_with_a_spring_swings_as_one_coordinate_does);
    RUN(a_moving_mechanism_has_the_slopes_of_neighbouring_motions);
    RUN(runs_start_at_the_equilibrium_until_init);
    RUN(a_change_of_numbers_starts_from_the_old_equilibrium);
    RUN(a_heavy_chain_finds_its_rest_from_anywhere);
    RUN(where_newton_gets_stuck_other_ways_go_on);
    RUN(a_search_can_be_stopped);
    RUN(a_moving_driver_stands_still_in_the_search_and_moves_after_it);
    RUN(a_governor_rests_against_its_shaft);
    RUN(what_has_to_move_with_a_driver_is_named);
    RUN(wrong_uses_are_refused_with_a_way_out);
    RUN(a_model_that_changed_has_no_inputs_at_an_old_instant);
    RUN(many_equilibria_are_spoken_of);
    RUN(matrices_are_written_in_other_notations);
    return test_end();
}
