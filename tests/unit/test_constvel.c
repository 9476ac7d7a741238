/* test_constvel.c: constant-velocity couplings against closed forms */
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

static const char *const trees[] = {"", "tree absolute\n", "tree absolute\nform embedded\n"};

#define SHAFTS                                                                                     \
    "body in mass=1 inertia=[0.03, 0.03, 0.01]\nbody out mass=1 inertia=[0.03, 0.03, 0.02]\n"

/* A torque turns both shafts as one: w' = T/(J1 + J2), and the coupling passes on J2 w', of which
 * its moment along the bisector is 1/cos(bend/2). */
static void shafts_turn_as_one(void)
{
    const double bend = 0.9, T = 0.6, rate = T / 0.03;

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "arm seat ground [0, 0, 0] rotation=y(0.9)\n" SHAFTS
                          "revolute h1 ground in axis=z\nrevolute h2 seat out axis=z\n"
                          "constvel c in out\ntorque T in [0, 0, 0.6]\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "simulate 1 rtol=1e-11\n");
        EXPECT_VALUE(&kit, "in.wz", rate, 1e-9);
        EXPECT_VALUE(&kit, "h2'", rate, 1e-9);
        EXPECT_VALUE(&kit, "c.tn", 0.02 * rate / cos(bend / 2), 1e-9);
        EXPECT_VALUE(&kit, "c.tz", 0.02 * rate, 1e-9);
        EXPECT_VALUE(&kit, "c.power", 0, 1e-9);
        kit_free(&kit);
    }
}

/* while the bend swings in a plane the angles of both shafts against their bearings are equal */
static void a_bend_that_changes_turns_no_shaft(void)
{
    const double T = 1.3, angle = 5 * T + T * T;

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, SHAFTS "body swing mass=1 inertia=[1, 1, 1]\n"
                                 "revolute b ground swing axis=y\nrevolute h1 ground in axis=z\n"
                                 "revolute h2 swing out axis=z\nconstvel c in out\n"
                                 "driver D1 b = 1.1*sin(3*t)\ndriver D2 h1 = 5*t + t^2\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "simulate 1.3 rtol=1e-11\n");
        EXPECT_VALUE(&kit, "h2", angle, 1e-9);
        EXPECT_VALUE(&kit, "h2'", 5 + 2 * T, 1e-9);
        EXPECT_VALUE(&kit, "h2''", 2, 1e-7);
        kit_free(&kit);
    }
}

/* Two universals in a Z with equal bends turn their last shaft as the coupling does; the shaft
 * between them runs unevenly, tan(h1) = cos(bend) tan(m) with its fork across that of the first. */
static void two_universals_in_a_z_do_the_same(void)
{
    const double bend = 0.5, T = 0.37;
    Kit kit = kit_new();
    char text[900];

    (void)snprintf(text, sizeof text,
                   SHAFTS "body mid mass=1 inertia=[0.02, 0.02, 0.01]\n"
                          "arm far mid [0, 0, 0.3]\n"
                          "arm seat ground [%.17g, 0, %.17g] rotation=y(1)\n"
                          "revolute h1 ground in axis=z\nrevolute h2 seat out axis=z\n"
                          "universal u1 in mid axes=[x, y]\nuniversal u2 far out axes=[y, x]\n"
                          "body twin mass=1 inertia=[1, 1, 1]\nrevolute h3 seat twin axis=z\n"
                          "constvel c in twin\ndriver D h1 = 4*t\n"
                          "simulate 0.37 rtol=1e-11\n",
                   0.3 * sin(bend), 0.3 * cos(bend));
    EXPECT_DONE(&kit, text);
    EXPECT_VALUE(&kit, "h2", 4 * T, 1e-9);
    EXPECT_VALUE(&kit, "h3", 4 * T, 1e-9);
    EXPECT_VALUE(&kit, "h2 - h3", 0, 1e-9);
    EXPECT_VALUE(&kit, "mid.wx*sin(0.5) + mid.wz*cos(0.5)",
                 4 * cos(bend) / (1 - pow(sin(bend) * cos(4 * T), 2)), 1e-8);
    kit_free(&kit);
}

static void it_is_refused_in_a_plane(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody a mass=1 inertia=1\n");
    EXPECT_FAILS(&kit, "constvel c ground a\n", "leaves the plane");
    kit_free(&kit);
}

int main(void)
{
    RUN(shafts_turn_as_one);
    RUN(a_bend_that_changes_turns_no_shaft);
    RUN(two_universals_in_a_z_do_the_same);
    RUN(it_is_refused_in_a_plane);
    return test_end();
}
