/* test_rolling.c: wheels, balls, blades, rods and couplers of rates, against closed forms, the
 * equations of a rolling disc, and the linear equations of a bicycle */
#include "session_kit.h"

#include <complex.h>
#include <math.h>

#define G 9.81

static bool is_near(double got, double expected, double within)
{
    const bool near = fabs(got - expected) <= within * (1 + fabs(expected));

    if (!near)
        (void)fprintf(stderr, "%.15g, expected %.15g\n", got, expected);
    return near;
}

#define EXPECT_VALUE(kit, name, expected, within)                                                  \
    EXPECT(is_near(kit_value(kit, name), expected, within))

/* Chaplygin's sleigh: with v along the blade and w, v' = a w^2 and (I + m a^2) w' = -m a v w, so
 * that v = V tanh(a m V t/(I + m a^2) + c), m V^2 = 2 E */
static void a_sleigh_runs_straight(void)
{
    static const char *const forms[] = {"", "form embedded\n"};
    const double a = 0.3, m = 1.7, inertia = 0.2, v0 = -0.8, w0 = 1.3, T = 4;
    const double whole = inertia + m * a * a, V = sqrt(v0 * v0 + whole / m * w0 * w0);
    const double c = atanh(v0 / V), v = V * tanh(a * m * V / whole * T + c);

    for (int i = 0; i < 2; i++) {
        Kit kit = kit_new();
        char text[600];

        (void)snprintf(text, sizeof text,
                       "scene planar\nbody s mass=%g inertia=%g\narm blade s [%g, 0]\n"
                       "knife k ground blade along=x\n%s"
                       "init s.x = 0, s.y = 0, s.theta = 0\n"
                       "init s.theta' = %g, s.x' = %g\n"
                       "output along = blade.vx*cos(s.theta) + blade.vy*sin(s.theta)\n"
                       "output across = blade.vy*cos(s.theta) - blade.vx*sin(s.theta)\n"
                       "simulate %g rtol=1e-11\n",
                       m, inertia, -a, forms[i], w0, v0, T);
        EXPECT_DONE(&kit, text);
        EXPECT_VALUE(&kit, "along", v, 1e-8);
        EXPECT_VALUE(&kit, "s.theta'", sqrt(m * (V * V - v * v) / whole), 1e-8);
        EXPECT_VALUE(&kit, "across", 0, 1e-12);
        /* m (v' along y of the centre of mass): w v + a w' */
        EXPECT_VALUE(&kit, "k.fn", m * kit_value(&kit, "s.theta'") * v * (1 - m * a * a / whole),
                     1e-8);
        kit_free(&kit);
    }
}

/* a skate on an incline that turns steadily does not run down: x = g sin^2(w t)/(2 w^2) down the
 * slope, y = g (w t - sin(2 w t)/2)/(2 w^2) across it */
static void a_skate_on_an_incline_drifts_across(void)
{
    const double w = 1.5, g = 3, T = 5;
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\ngravity [3, 0]\nbody s mass=2 inertia=0.3\n"
                      "knife k ground s along=x\ninit s.x = 0, s.y = 0, s.theta = 0\n"
                      "init s.x' = 0, s.theta' = 1.5\nsimulate 5 rtol=1e-11\n");
    EXPECT_VALUE(&kit, "s.x", g * pow(sin(w * T), 2) / (2 * w * w), 1e-8);
    EXPECT_VALUE(&kit, "s.y", g * (w * T - sin(2 * w * T) / 2) / (2 * w * w), 1e-8);
    kit_free(&kit);
}

/* --- a disc --- */

typedef struct Disc { /* mass 1 */
    double r, a, c;   /* radius, transverse and axial moment of inertia */
} Disc;

/* Rates of (angle of the axle to the vertical, w along the horizontal diameter, w along the
 * steepest one, w along the axle, precession, spin, x, y of the point of contact): the moments
 * about the point of contact, in axes that follow the axle. */
static void disc_rates(const Disc *disc, const double *s, double *rate)
{
    const double mr2 = disc->r * disc->r, cot = cos(s[0]) / sin(s[0]);
    const double turn = s[2] / sin(s[0]), spin = s[3] - s[2] * cot;

    rate[0] = s[1];
    rate[1] =
        (disc->a * s[2] * s[2] * cot - (disc->c + mr2) * s[2] * s[3] - G * disc->r * cos(s[0])) /
        (disc->a + mr2);
    rate[2] = (disc->c * s[1] * s[3] - disc->a * s[1] * s[2] * cot) / disc->a;
    rate[3] = mr2 * s[1] * s[2] / (disc->c + mr2);
    rate[4] = turn;
    rate[5] = spin;
    rate[6] = -disc->r * spin * cos(s[4]);
    rate[7] = -disc->r * spin * sin(s[4]);
}

static void disc_run(const Disc *disc, double *s, double time, int steps)
{
    const double h = time / steps, weight[4] = {h / 6, h / 3, h / 3, h / 6},
                 at[4] = {0, h / 2, h / 2, h};

    for (int i = 0; i < steps; i++) {
        double rate[8] = {0}, sum[8] = {0}, trial[8];

        for (int k = 0; k < 4; k++) {
            for (int j = 0; j < 8; j++)
                trial[j] = s[j] + at[k] * rate[j];
            disc_rates(disc, trial, rate);
            for (int j = 0; j < 8; j++)
                sum[j] += weight[k] * rate[j];
        }
        for (int j = 0; j < 8; j++)
            s[j] += sum[j];
    }
}

static void a_disc_rolls(void)
{
    static const char *const ways[] = {"", "method=ida", "method=radau", "method=bdf"};
    const Disc disc = {0.4, 0.05, 0.09};
    double s[8] = {1.1, 0.4, 0.7, -3.2, 0.2, 0, 0, 0};
    const double turn = s[2] / sin(s[0]), spin = s[3] - s[2] / tan(s[0]);
    char text[700];

    (void)snprintf(text, sizeof text,
                   "gravity [0, 0, -9.81]\nbody d mass=1 inertia=[0.05, 0.05, 0.09] euler=zxz\n"
                   "roll r ground d axle=z radius=0.4\n"
                   "init d.a1 = 0.2, d.a2 = %.17g, d.a3 = 0, r.x = 0, r.y = 0\n"
                   "init d.a1' = %.17g, d.a2' = %.17g, d.a3' = %.17g\n",
                   s[0], turn, s[1], spin);
    disc_run(&disc, s, 2, 20000);
    for (int i = 0; i < 4; i++) {
        Kit kit = kit_new();
        const double bound = i == 0 ? 1e-9 : 1e-7;
        char run[60];

        (void)snprintf(run, sizeof run, "simulate 2 rtol=1e-11 %s\n", ways[i]);
        EXPECT_DONE(&kit, text);
        EXPECT_DONE(&kit, run);
        EXPECT_VALUE(&kit, "d.a2", s[0], bound);
        EXPECT_VALUE(&kit, "d.a1", s[4], bound);
        EXPECT_VALUE(&kit, "d.a3", s[5], bound);
        EXPECT_VALUE(&kit, "r.x", s[6], bound);
        EXPECT_VALUE(&kit, "r.y", s[7], bound);
        EXPECT_VALUE(&kit, "r.z", 0, 1e-12);
        EXPECT_VALUE(&kit, "energy.total", kit_value(&kit, "energy.total at 0"), 1e-9);
        kit_free(&kit);
    }
}

/* a steady circle: its balance of moments with w1 = 0, and its radius r spin/turn */
static void a_disc_rolls_in_a_circle(void)
{
    const Disc disc = {0.4, 0.05, 0.09};
    const double tilt = 1.2, w2 = 0.8, mr2 = 0.16;
    const double w3 =
        (disc.a * w2 * w2 / tan(tilt) - G * disc.r * cos(tilt)) / ((disc.c + mr2) * w2);
    const double turn = w2 / sin(tilt), spin = w3 - w2 / tan(tilt), round = 2 * M_PI / fabs(turn);
    Kit kit = kit_new();
    char text[700];

    (void)snprintf(text, sizeof text,
                   "gravity [0, 0, -9.81]\nbody d mass=1 inertia=[0.05, 0.05, 0.09] euler=zxz\n"
                   "roll r ground d axle=z radius=0.4\n"
                   "init d.a1 = 0, d.a2 = %.17g, d.a3 = 0, r.x = 0, r.y = 0\n"
                   "init d.a1' = %.17g, d.a2' = 0, d.a3' = %.17g\nsimulate %.17g rtol=1e-12\n",
                   tilt, turn, spin, 2 * round);
    EXPECT_DONE(&kit, text);
    EXPECT_VALUE(&kit, "d.a2", tilt, 1e-9);
    EXPECT_VALUE(&kit, "r.x", 0, 1e-8);
    EXPECT_VALUE(&kit, "r.y", 0, 1e-8);
    (void)snprintf(text, sizeof text, "r.y at %.17g", round / 2);
    EXPECT_VALUE(&kit, text, -2 * disc.r * spin / turn, 1e-7);
    kit_free(&kit);
}

/* --- balls --- */

/* on a turntable the centre of a solid ball goes round at 2/7 of its rate */
static void a_ball_on_a_turntable_circles(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "gravity [0, 0, -9.81]\nbody table mass=10 inertia=[1, 1, 1]\n"
                      "revolute h ground table axis=z\ndriver D h = 2*t\n"
                      "body b mass=2 inertia=0.4*2*0.1^2*[1, 1, 1]\nroll r table b radius=0.1\n"
                      "init b.x = 0.5, b.y = 0, b.x' = 0.3, b.y' = 0.2, b.wz = 0\n"
                      "simulate 7*pi/2 rtol=1e-12\n");
    EXPECT_VALUE(&kit, "b.x", 0.5, 1e-9);
    EXPECT_VALUE(&kit, "b.y", 0, 1e-9);
    EXPECT_VALUE(&kit, "b.x'", 0.3, 1e-9);
    EXPECT_VALUE(&kit, "r.fn", 2 * G, 1e-12);
    /* m v (4/7) across the velocity */
    EXPECT_VALUE(&kit, "r.ft", 2 * sqrt(0.13) * 4 / 7, 1e-9);
    kit_free(&kit);
}

/* w^2 = 5/7 g/(R - r) about the bottom of a bowl; the same in the plane with a disc, 2/3 */
static void a_ball_swings_in_a_bowl(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "gravity [0, 0, -9.81]\nbody b mass=2 inertia=0.4*2*0.1^2*[1, 1, 1]\n"
                      "roll r ground b radius=0.1 bowl=0.6\nguess b.z = -0.5\n"
                      "init b.x = 0, b.y = 0, b.x' = 0, b.y' = 0, b.wz = 0\nmodes\n");
    EXPECT_VALUE(&kit, "modes.omega(6)", sqrt(5.0 / 7 * G / 0.5), 1e-9);
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nbody b mass=2 inertia=2*0.1^2/2\n"
                      "roll r ground b radius=0.1 bowl=0.6\nguess b.y = -0.5\n"
                      "init b.x = 0.3, b.theta = 0, b.x' = 0\nsimulate 3 rtol=1e-11\n");
    EXPECT_VALUE(&kit, "energy.total", kit_value(&kit, "energy.total at 0"), 1e-11);
    EXPECT_VALUE(&kit, "b.x^2 + b.y^2", 0.25, 1e-11);
    kit_free(&kit);
}

/* --- in the plane --- */

/* down a slope: 2/3 g sin(slope) for a disc; the way is tied to the angle, without drift */
static void a_disc_rolls_down(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nslope = 0.3\n"
                      "arm plane ground [0, 0] rotation=z(-slope)\nbody w mass=2 inertia=0.04\n"
                      "roll r plane w radius=0.2\n"
                      "init r.x = 1*cos(slope), w.theta' = 0\nsimulate 2\n");
    EXPECT_VALUE(&kit, "w.theta'", -2.0 / 3 * G * sin(0.3) * 2 / 0.2, 1e-9);
    /* against the slope, which is turned by -0.3 */
    EXPECT_VALUE(&kit, "w.theta + 0.3", -(1 + G * sin(0.3) / 3 * 4) / 0.2, 1e-9);
    EXPECT_VALUE(&kit, "r.fn", 2 * G * cos(0.3), 1e-9);
    EXPECT_VALUE(&kit, "r.ft", 2 * G * sin(0.3) / 3, 1e-9);
    EXPECT_VALUE(&kit, "model.dof", 1, 0);
    kit_free(&kit);
}

/* --- rods, planes, lines --- */

/* a point on a rod is a pendulum: energy, and the pull m (v^2/L + g cos) */
static void a_rod_holds_a_pendulum(void)
{
    Kit kit = kit_new();
    double x, y;

    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nbody m mass=2 inertia=0.1\n"
                      "link L ground m length=0.5\ninit m.x = 0.5, m.y = 0, m.theta = 0\n"
                      "init m.y' = 0, m.theta' = 0\nsimulate 1 rtol=1e-11\n");
    x = kit_value(&kit, "m.x");
    y = kit_value(&kit, "m.y");
    EXPECT(is_near(hypot(x, y), 0.5, 1e-12));
    EXPECT_VALUE(&kit, "m.x'^2 + m.y'^2", -2 * G * y, 1e-8);
    EXPECT_VALUE(&kit, "L.fn", -2 * (-2 * G * y / 0.5 - G * y / 0.5), 1e-8);
    kit_free(&kit);
}

/* two bodies on a rod in space, from centre to centre: each goes round the common centre evenly */
static void a_rod_between_two_bodies_turns_evenly(void)
{
    static const char *const trees[] = {"", "free j a b\ntree a j\n"};
    const double turn = 3 * 0.8; /* 2 m/s across 2/3 of 1.25 m from the centre */

    for (int i = 0; i < 2; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "body a mass=2 inertia=[1, 2, 2]; body b mass=1 inertia=[1, 1, 1]\n"
                          "link L a b length=1.25\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "init a.x = 0, a.y = 0, a.z = 0, b.x = 1.25, b.y = 0, b.z = 0\n"
                          "init a.y' = -1, a.z' = 0.3, b.y' = 2, b.z' = 0.3, a.x' = 0.4\n"
                          "init a.wx = 1, a.wy = 0, a.wz = 0, b.wx = 0, b.wy = 2, b.wz = 1\n"
                          "simulate 2 rtol=1e-11\n");
        EXPECT_VALUE(&kit, "b.x - a.x", 1.25 * cos(turn * 2), 1e-8);
        EXPECT_VALUE(&kit, "b.y - a.y", 1.25 * sin(turn * 2), 1e-8);
        EXPECT_VALUE(&kit, "(2*a.x + b.x)/3", 1.25 / 3 + 0.8, 1e-8);
        EXPECT_VALUE(&kit, "a.z", 0.6, 1e-9);
        EXPECT_VALUE(&kit, "L.fn", -2.0 / 3 * turn * turn * 1.25, 1e-8);
        kit_free(&kit);
    }
}

/* a rod whose ends are on two lines: its centre goes round in a circle, and it is a pendulum */
static void a_trammel_is_a_pendulum(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nbody r mass=1 inertia=1/12\n"
                      "arm a r [-0.5, 0]; arm b r [0.5, 0]\ninline A ground a axis=x\n"
                      "inline B ground b axis=y\ninit r.theta = 2, r.theta' = 0\n"
                      "simulate 0.5 rtol=1e-11\n");
    EXPECT_VALUE(&kit, "r.theta'^2/6 + 9.81*sin(r.theta)/2", G * sin(2) / 2, 1e-9);
    EXPECT_VALUE(&kit, "r.x^2 + r.y^2", 0.25, 1e-12);
    EXPECT_VALUE(&kit, "A.fy - 9.81", kit_value(&kit, "r.ay"), 1e-9);
    EXPECT_VALUE(&kit, "B.fx", kit_value(&kit, "r.ax"), 1e-9);
    kit_free(&kit);
}

/* a body with its foot on a plane, and one on an inclined line */
static void points_remain_in_planes_and_on_lines(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "gravity [0, 0, -9.81]\nbody b mass=2 inertia=[0.1, 0.2, 0.3]\n"
                      "arm foot b [0.2, 0, -0.5]\ninplane P ground foot\n"
                      "init b.x = 0, b.y = 0, b.q1 = 0.1, b.q2 = 0, b.q3 = 0, b.x' = 1, b.y' = 0\n"
                      "init b.wx = 0, b.wy = 0, b.wz = 5\nsimulate 0.5 rtol=1e-11\n");
    EXPECT_VALUE(&kit, "foot.z", 0, 1e-12);
    EXPECT_VALUE(&kit, "b.x", 0.5, 1e-10);
    EXPECT_VALUE(&kit, "P.fn/2 - 9.81", kit_value(&kit, "b.az"), 1e-9);
    EXPECT_VALUE(&kit, "energy.total", kit_value(&kit, "energy.total at 0"), 1e-9);
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, "gravity [0, 0, -9.81]\nbody b mass=2 inertia=[0.1, 0.2, 0.3]\n"
                      "inline S ground b axis=[0.6, 0, -0.8]\n"
                      "init b.x = 0, b.x' = 0, b.wx = 0, b.wy = 0, b.wz = 1\nsimulate 1\n");
    EXPECT_VALUE(&kit, "b.z", -0.8 * 0.8 * G / 2, 1e-9);
    EXPECT_VALUE(&kit, "b.x", 0.6 * 0.8 * G / 2, 1e-9);
    EXPECT_VALUE(&kit, "hypot(S.fx, S.fz)", 2 * G * 0.6, 1e-9);
    kit_free(&kit);
}

/* --- couplers of rates --- */

/* two couplers that are a wheel which steers with its spin, and the knife edge that is one */
static void rates_are_coupled(void)
{
    Kit kit = kit_new(), other = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody s mass=2 inertia=0.3\n"
                      "coupler c s.y' = s.x'*tan(s.theta)\ninit s.x = 0, s.y = 0, s.theta = 0.2\n"
                      "init s.theta' = 0.5, s.x' = 0.4\nforce F s [0.3, 0.2]\n"
                      "simulate 1 rtol=1e-11\n");
    EXPECT_DONE(&other, "scene planar\nbody s mass=2 inertia=0.3\nknife k ground s along=x\n"
                        "init s.x = 0, s.y = 0, s.theta = 0.2\n"
                        "init s.theta' = 0.5, s.x' = 0.4\nforce F s [0.3, 0.2]\n"
                        "simulate 1 rtol=1e-11\n");
    EXPECT_VALUE(&kit, "s.x", kit_value(&other, "s.x"), 1e-10);
    EXPECT_VALUE(&kit, "s.y", kit_value(&other, "s.y"), 1e-10);
    EXPECT_VALUE(&kit, "c.effort", kit_value(&other, "k.fy"), 1e-9);
    EXPECT_VALUE(&kit, "c.power", 0, 1e-12);
    kit_free(&kit);
    kit_free(&other);
}

/* b.x' = 0.3 sin(2 t) + 0.2 b.theta': momentum with P on x and -0.2 P on theta; it does work */
static void a_rate_follows_time(void)
{
    Kit kit = kit_new();
    const char *report;

    EXPECT_DONE(&kit, "scene planar\nbody b mass=1 inertia=1\n"
                      "coupler c b.x' = 0.3*sin(2*t) + b.theta'*0.2\n"
                      "init b.x = 0, b.y = 0, b.theta = 0, b.theta' = 0.5, b.y' = 0\n"
                      "simulate 2 rtol=1e-10\n");
    report = ct_remarks(kit.session);
    EXPECT(report != NULL && strstr(report, "by themselves") == NULL);
    EXPECT_VALUE(&kit, "b.x - 0.2*b.theta", 0.3 * (1 - cos(4)) / 2, 1e-8);
    EXPECT_VALUE(&kit, "b.theta'", 0.5 - 0.06 * sin(4) / 1.04, 1e-8);
    kit_free(&kit);
}

/* a coupler that repeats what a wheel's position row says takes no place: two zero eigenvalues */
static void a_velocity_row_repeats_a_position(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody w mass=2 inertia=0.05\n"
                      "coupler c w.theta' = -w.x'*1000/200\nroll r ground w radius=0.2\n"
                      "init w.x = 0\nlinearize\n");
    EXPECT(isnan(kit_value(&kit, "linear.A(3,3)")));
    EXPECT_VALUE(&kit, "linear.A(1,2)", 1, 1e-12);
    kit_free(&kit);
}

/* a trailer behind a hitch that goes straight: its angle falls as tan(theta/2) e^(-v t/L), whatever
 * the rows that are asked for */
static void a_trailer_follows(void)
{
    static const char *const runs[] = {"simulate 2", "kinematics 2 every=1", "inverse 2 every=0.5"};

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();
        char run[40];

        EXPECT_DONE(&kit, "scene planar\nbody s mass=1 inertia=0.2\narm hitch s [0.7, 0]\n"
                          "knife k ground s\nfree j ground hitch\ninit s.theta = 1\n"
                          "driver DX j.x = 0.5*t\ndriver DY j.y = 0\n");
        (void)snprintf(run, sizeof run, "%s\n", runs[i]);
        EXPECT_DONE(&kit, run);
        EXPECT_VALUE(&kit, "s.theta", 2 * atan(tan(0.5) * exp(-0.5 * 2 / 0.7)), 1e-8);
        EXPECT_VALUE(&kit, "model.dof", 0, 0);
        kit_free(&kit);
    }
}

/* --- a bicycle --- */

/* M s^2 + v C1 s + g K0 + v^2 K2: J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, Proc.
 * R. Soc. A 463 (2007), 1955, for their parameters */
static double complex bicycle(double v, double complex s)
{
    const double complex a = 80.81722 * s * s + G * -80.95;
    const double complex b = 2.31941332208709 * s * s + 33.86641391492494 * v * s +
                             G * -2.59951685249872 + 76.59734589573222 * v * v;
    const double complex c =
        2.31941332208709 * s * s - 0.85035641456978 * v * s + G * -2.59951685249872;
    const double complex d = 0.29784188199686 * s * s + 1.68540397397560 * v * s +
                             G * -0.80329488458618 + 2.65431523794604 * v * v;

    return a * d - b * c;
}

static double complex bicycle_root(double v, double complex s)
{
    for (int i = 0; i < 50; i++) {
        const double h = 1e-6 * (1 + cabs(s));
        const double complex slope = (bicycle(v, s + h) - bicycle(v, s - h)) / (2 * h);

        s -= bicycle(v, s) / slope;
    }
    return s;
}

static void a_bicycle_weaves(void)
{
    static const double speeds[] = {0, 5, 10};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "gravity [0, 0, -9.81]\nv = 5 [m/s]; lam = pi/10\n"
                      "body B mass=85 inertia=[9.2, 11, 2.8, 0, -2.4, 0] euler=zxy\n"
                      "arm rear B [-0.3, 0, -0.6]; arm head B [0.8, 0, -0.9]\n"
                      "body H mass=4 inertia=[0.05892, 0.06, 0.00708, 0, 0.00756, 0]\n"
                      "arm crown H [0.2, 0, -0.7]; arm front H [0.12, 0, -0.35]\n"
                      "revolute delta head crown axis=[-sin(lam), 0, cos(lam)]\n"
                      "body R mass=2 inertia=[0.0603, 0.12, 0.0603]\n"
                      "body F mass=3 inertia=[0.1405, 0.28, 0.1405]\n"
                      "revolute rr rear R axis=y; revolute rf front F axis=y\n"
                      "roll w1 ground R axle=y radius=0.3; roll w2 ground F axle=y radius=0.35\n"
                      "init B.x = 0, B.y = 0, B.z = 0.9, B.a1 = 0, B.a2 = 0, B.a3 = 0, delta = 0\n"
                      "init rr = 0, rf = 0, delta' = 0, B.a2' = 0, rr' = v/0.3\n");
    for (int i = 0; i < 3; i++) {
        char text[60];

        (void)snprintf(text, sizeof text, "v = %g [m/s]\nmodes\n", speeds[i]);
        EXPECT_DONE(&kit, text);
        EXPECT_VALUE(&kit, "model.dof", 3, 0);
        for (int k = 1; k <= 4 - (speeds[i] > 0); k++) {
            const int mode = 6 + k;
            double omega, damping;
            double complex s, root;

            (void)snprintf(text, sizeof text, "modes.omega(%d)", mode);
            omega = kit_value(&kit, text);
            (void)snprintf(text, sizeof text, "modes.damping(%d)", mode);
            damping = kit_value(&kit, text);
            s = -damping * omega +
                omega * csqrt(damping * damping - 1 < 0 ? damping * damping - 1 : 0);
            root = bicycle_root(speeds[i], s);
            EXPECT(is_near(creal(s), creal(root), 1e-10));
            EXPECT(is_near(cimag(s), cimag(root), 1e-10));
        }
    }
    kit_free(&kit);
}

/* what shares its load with a joint is open in the joint's tree, and shared evenly in the other */
static void a_redundant_row_has_no_force_of_its_own(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "gravity [0, 0, -9.81]\nbody b mass=2 inertia=[1, 1, 1]\n"
                      "planarjoint p ground b normal=z\ninplane P ground b\n"
                      "init p.s1 = 0, p.s2 = 0, p.theta = 0\nsimulate 0.1\n");
    EXPECT_FAILS(&kit, "print P.fn\n", "P.fn isn't determined");
    EXPECT_DONE(&kit, "tree absolute\nsimulate 0.1\n");
    EXPECT_VALUE(&kit, "P.fn", G, 1e-9);
    EXPECT_VALUE(&kit, "p.fz", G, 1e-9);
    kit_free(&kit);
}

static void values_are_checked(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body b mass=1 inertia=[1, 1, 1]\n");
    EXPECT_FAILS(&kit, "roll r ground b\n", "needs its radius");
    EXPECT_FAILS(&kit, "roll r ground b radius=-1\n", "radius");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 rim=0.1\n", "only a wheel has a rim");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 semiaxes=[1, 2, 3]\n", "exclude each other");
    EXPECT_FAILS(&kit, "roll r ground b semiaxes=[1, 2]\n", "three semiaxes");
    EXPECT_FAILS(&kit, "roll r ground b semiaxes=[1, 2, 0]\n", "above 0");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 bowl=0.5\n", "does not fit");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 bowl=3 dome=2\n", "exclude each other");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 axle=y bowl=3\n", "only a ball rolls");
    EXPECT_FAILS(&kit, "roll r ground b axle=y semiaxes=[1, 2, 3]\n", "exclude each other");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 offset=3\n", "planar scene");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 axle=[0, 0, 0]\n", "axle");
    EXPECT_DONE(&kit, "roll r ground b radius=1\ninit b.x = 0, b.y = 0, b.vx = 1, b.wx = 0\n");
    EXPECT_FAILS(&kit, "init b.wy = 0\nsimulate 1\n", "b");
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, "scene planar\nbody b mass=1 inertia=1\n");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 rim=0.1\n", "only a wheel has a rim");
    EXPECT_FAILS(&kit, "roll r ground b semiaxes=[1, 2, 3]\n", "spatial scene");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 axle=x\n", "turns about z");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 normal=z\n", "leaves the plane");
    EXPECT_FAILS(&kit, "roll r ground b radius=1 bowl=2 offset=1\n", "exclude each other");
    EXPECT_FAILS(&kit, "knife k ground b along=z\n", "leaves the plane");
    EXPECT_FAILS(&kit, "inline k ground b axis=z\n", "leaves the plane");
    EXPECT_FAILS(&kit, "inplane k ground b normal=z\n", "leaves the plane");
    EXPECT_DONE(&kit, "arm p b [1, 0]\nknife k b p\n");
    EXPECT_FAILS(&kit, "simulate 1\n", "b and p, do not move against each other");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_sleigh_runs_straight);
    RUN(a_skate_on_an_incline_drifts_across);
    RUN(a_disc_rolls);
    RUN(a_disc_rolls_in_a_circle);
    RUN(a_ball_on_a_turntable_circles);
    RUN(a_ball_swings_in_a_bowl);
    RUN(a_disc_rolls_down);
    RUN(a_rod_holds_a_pendulum);
    RUN(a_rod_between_two_bodies_turns_evenly);
    RUN(a_trammel_is_a_pendulum);
    RUN(points_remain_in_planes_and_on_lines);
    RUN(rates_are_coupled);
    RUN(a_rate_follows_time);
    RUN(a_velocity_row_repeats_a_position);
    RUN(a_trailer_follows);
    RUN(a_bicycle_weaves);
    RUN(a_redundant_row_has_no_force_of_its_own);
    RUN(values_are_checked);
    return test_end();
}
