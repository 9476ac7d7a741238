/* test_bushing.c: bushings against closed forms */
#include "session_kit.h"

#include <math.h>

static bool is_near(double got, double expected, double within)
{
    const bool near = fabs(got - expected) <= within * (1 + fabs(expected));

    if (!near)
        (void)fprintf(stderr, "%.15g, expected %.15g\n", got, expected);
    return near;
}

#define EXPECT_VALUE(kit, name, expected, within)                                                  \
    EXPECT(is_near(kit_value(kit, name), expected, within))

/* about one axis the moment is k times the angle at any size: th = A cos(w t) in space, in the
 * plane and of a torsion spring on a hinge */
static void a_twist_swings_evenly_at_any_angle(void)
{
    static const char *const scenes[] = {
        "body b mass=2 inertia=[0.3, 0.4, 0.5]\nbushing k ground b k=[0, 0, 0, 0, 0, 7]\n"
        "init b.q1 = 0, b.q2 = 0, b.q3 = sin(1.45)\noutput angle = 2*asin(b.q3)\n",
        "scene planar\nbody b mass=2 inertia=0.5\nbushing k ground b k=[0, 0, 7]\n"
        "init b.theta = 2.9\noutput angle = b.theta\n",
        "scene planar\nbody b mass=2 inertia=0.5\nrevolute h ground b\nbushing k ground b k=[5, 6, "
        "7]\ninit h = 2.9\noutput angle = h\n"};
    const double T = 0.6, w = sqrt(7 / 0.5);

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, scenes[i]);
        EXPECT_DONE(&kit, "simulate 0.6 rtol=1e-12\n");
        EXPECT_VALUE(&kit, "angle", 2.9 * cos(w * T), 1e-9);
        EXPECT_VALUE(&kit, "k.Tz", -7 * 2.9 * cos(w * T), 1e-9);
        EXPECT_VALUE(&kit, "energy.potential", 3.5 * pow(2.9 * cos(w * T), 2), 1e-9);
        EXPECT_VALUE(&kit, "energy.total", 3.5 * 2.9 * 2.9, 1e-10);
        kit_free(&kit);
    }
}

/* M x'' = -K x - D x' for small motions: linearize has K and D to rounding, with all couplings */
static void small_motions_have_the_matrices(void)
{
    static const char *const forms[] = {"tree absolute\n", "virtual free v ground b\ntree v\n"};
    const double mass[6] = {2, 2, 2, 0.3, 0.4, 0.5};
    char text[2000], name[48];

    for (int form = 0; form < 2; form++) {
        Kit kit = kit_new();
        int at = snprintf(text, sizeof text,
                          "body b mass=2 inertia=[0.3, 0.4, 0.5]\n"
                          "bushing k1 ground b");

        for (int which = 0; which < 2; which++) {
            at += snprintf(text + at, sizeof text - (size_t)at, " %s=[", which == 0 ? "k" : "d");
            for (int i = 0; i < 6; i++)
                for (int j = 0; j < 6; j++)
                    at +=
                        snprintf(text + at, sizeof text - (size_t)at, "%s%d", i + j > 0 ? ", " : "",
                                 (which == 0 ? 100 : 10) * (i == j) + i + j + which);
            at += snprintf(text + at, sizeof text - (size_t)at, "]");
        }
        (void)snprintf(text + at, sizeof text - (size_t)at, "\n%slinearize\n", forms[form]);
        EXPECT_DONE(&kit, text);
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++) {
                (void)snprintf(name, sizeof name, "linear.A(%d,%d)", 7 + i, 1 + j);
                EXPECT_VALUE(&kit, name, -(100 * (i == j) + i + j) / mass[i], 1e-12);
                (void)snprintf(name, sizeof name, "linear.A(%d,%d)", 7 + i, 7 + j);
                EXPECT_VALUE(&kit, name, -(10 * (i == j) + i + j + 1) / mass[i], 1e-12);
            }
        kit_free(&kit);
    }
}

/* At the attitude (p1, p2, p3) the moment is minus the slope of the energy: for a turn by 2.5 rad
 * about an oblique axis, by differences of rotation vectors of neighbours. Components along the
 * axis of the turn: T.a = -p.K a */
static void a_moment_is_the_slope_of_the_energy(void)
{
    const double a[3] = {2.0 / 7, 3.0 / 7, 6.0 / 7}, th = 2.5, k[3] = {5, 7, 11};
    Kit kit = kit_new();
    char text[600];
    double along = 0, written = 0;

    (void)snprintf(text, sizeof text,
                   "body b mass=1 inertia=[1, 1, 1]\nbushing k ground b k=[0, 0, 0, 5, 7, 11]\n"
                   "init b.q1 = %.17g, b.q2 = %.17g, b.q3 = %.17g\nassemble\n",
                   sin(th / 2) * a[0], sin(th / 2) * a[1], sin(th / 2) * a[2]);
    EXPECT_DONE(&kit, text);
    for (int i = 0; i < 3; i++) {
        static const char *const own[3] = {"k.Tx", "k.Ty", "k.Tz"};
        static const char *const ground[3] = {"k.tx", "k.ty", "k.tz"};

        along += kit_value(&kit, own[i]) * a[i];
        written += k[i] * th * a[i] * a[i];
        EXPECT_VALUE(&kit, ground[i], kit_value(&kit, own[i]), 1e-14);
    }
    EXPECT_VALUE(&kit, "energy.potential", 0.5 * th * written, 1e-13);
    EXPECT(is_near(along, -written, 1e-13));
    /* the written equations, in axes of the body, have the same moment along the axis */
    EXPECT(is_near(kit_value(&kit, "forces(4)") * a[0] + kit_value(&kit, "forces(5)") * a[1] +
                       kit_value(&kit, "forces(6)") * a[2],
                   -written, 1e-12));
    kit_free(&kit);
}

/* m x'' + d x' + k x = 0 from x0, v0: x = e^(-s t) (x0 cos(w t) + (v0 + s x0)/w sin(w t)); the
 * energy account of the run contains what the damper takes */
static void a_damped_swing_fades(void)
{
    const double m = 2, d = 3, k = 50, x0 = 0.2, v0 = 0.5, T = 0.4;
    const double s = d / (2 * m), w = sqrt(k / m - s * s), b = (v0 + s * x0) / w;
    const double x = exp(-s * T) * (x0 * cos(w * T) + b * sin(w * T));
    const double v = exp(-s * T) * ((b * w - s * x0) * cos(w * T) - (x0 * w + s * b) * sin(w * T));
    const char *drift;
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody b mass=2 inertia=1\nbushing k ground b k=[50, 60, 4] "
                      "d=[3, 0, 0]\ninit b.x = 0.2, b.x' = 0.5\nsimulate 0.4 rtol=1e-11\n");
    EXPECT_VALUE(&kit, "b.x", x, 1e-10);
    EXPECT_VALUE(&kit, "k.Fx", -k * x - d * v, 1e-9);
    EXPECT_VALUE(&kit, "k.power", (-k * x - d * v) * v, 1e-9);
    EXPECT_VALUE(&kit, "energy.total", (m * v * v + k * x * x) / 2, 1e-10);
    EXPECT_DONE(&kit, "show run\n");
    drift = strstr(kit.text, "energy drift");
    EXPECT(drift != NULL && strtod(drift + sizeof "energy drift", NULL) < 1e-9);
    kit_free(&kit);
}

/* at rest it carries the weight, and the moment of a load beside it */
static void it_carries_a_weight(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "gravity [0, 0, -10]\nbody b mass=2 inertia=[1, 1, 1]\n"
                      "bushing k ground b k=[1e4, 1e4, 1e4, 200, 200, 200]\n"
                      "torque T b [0, 300, 0]\nequilibrium\n");
    EXPECT_VALUE(&kit, "b.z", -20 / 1e4, 1e-12);
    EXPECT_VALUE(&kit, "b.q2", sin(300.0 / 200 / 2), 1e-10);
    EXPECT_VALUE(&kit, "k.ty", -300, 1e-10);
    EXPECT_VALUE(&kit, "k.fz", 20, 1e-10);
    kit_free(&kit);
}

/* at half a turn it is told; in the plane the angle goes on */
static void half_a_turn_is_told(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body b mass=1 inertia=[1, 1, 1]\nbushing k ground b k=[0, 0, 0, 1, 1, 1]\n"
                      "init b.wz = 3.13\nsimulate 1.7\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "the turns of k are singular at its angle = 180 deg");
    EXPECT_HOLDS(ct_remarks(kit.session), "a stiffer part or a stop avoids it");
    /* through it the run ends, or says so: rounding decides */
    if (kit_do(&kit, "init b.wz = 4\nsimulate 1.5\n") == CT_OK)
        EXPECT_HOLDS(ct_remarks(kit.session), "the turns of k are singular");
    else
        EXPECT_HOLDS(kit.error.message, "k turns through a critical angle");
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, "scene planar\nbody b mass=1 inertia=1\nbushing k ground b k=[0, 0, 1]\n"
                      "init b.theta' = 10\nsimulate 1.5 rtol=1e-11\n");
    EXPECT_VALUE(&kit, "b.theta", 10 * sin(1.5), 1e-9);
    kit_free(&kit);
}

static void values_are_checked(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body b mass=1 inertia=[1, 1, 1]\n");
    EXPECT_FAILS(&kit, "bushing k ground b\n", "or d= is missing");
    EXPECT_FAILS(&kit, "bushing k ground b k=[1, 2, 3]\n", "6 values, or a matrix of 36");
    EXPECT_FAILS(&kit, "bushing k ground b d=[1, 1, 1, 1, 1, -1]\n", "would feed energy");
    EXPECT_DONE(&kit, "bushing k ground b k=[1, 1, 1, 1, 1, -1]\n");
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, "scene planar\nbody b mass=1 inertia=1\n");
    EXPECT_FAILS(&kit, "bushing k ground b k=[1, 2, 3, 4, 5, 6]\n", "3 values in a planar scene");
    EXPECT_FAILS(&kit, "bushing k ground b k=[1, 2, 0, 3, 4, 0, 0, 0, 1]\n",
                 "entries 2,1 and 1,2 are 3 and 2");
    EXPECT_FAILS(&kit, "bushing k ground b k=[1, 1, 1] d=[1, 2, 0, 2, 1, 0, 0, 0, 1]\n",
                 "would feed energy");
    EXPECT_DONE(&kit, "bushing k ground b k=[1, 2, 0, 2, 4, 0, 0, 0, 1] d=[1, 2, 0, 2, 4, 0, 0, 0, "
                      "0]\n");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_twist_swings_evenly_at_any_angle);
    RUN(small_motions_have_the_matrices);
    RUN(a_moment_is_the_slope_of_the_energy);
    RUN(a_damped_swing_fades);
    RUN(it_carries_a_weight);
    RUN(half_a_turn_is_told);
    RUN(values_are_checked);
    return test_end();
}
