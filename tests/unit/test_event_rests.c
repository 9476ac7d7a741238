/* test_event_rests.c: events that happen ever faster come to rest */
#include "session_kit.h"

#define BALL                                                                                       \
    "scene planar\ngravity [0, -9.81]\nbody m1 mass=1\nprismatic s1 ground m1 axis=y\n"            \
    "init s1 = 1\n"
#define BOUNCE "event hit when=s1 < 0 s1'=-0.8*s1'\n"

/* the instant from which on the last run reports an event at rest; NAN */
static double rest_of(const Kit *kit)
{
    const char *at = strstr(ct_remarks(kit->session), "at rest from t = ");

    return at != NULL ? strtod(at + strlen("at rest from t = "), NULL) : NAN;
}

/* a fall from 1 m takes t1 = sqrt(2/g), and the series t1 (1 + e)/(1 - e) */
static void bounces_that_pile_up_come_to_rest(void)
{
    static const double e[] = {0.01, 0.1, 0.5, 0.8, 0.95};

    for (int i = 0; i < 5; i++) {
        Kit kit = kit_new();
        char line[100];

        (void)snprintf(line, sizeof line, "event hit when=s1 < 0 s1'=-%g*s1'\nsimulate 20", e[i]);
        EXPECT_DONE(&kit, BALL);
        EXPECT_DONE(&kit, line);
        EXPECT_NEAR(rest_of(&kit), sqrt(2 / 9.81) * (1 + e[i]) / (1 - e[i]), 2e-8);
        EXPECT_NEAR(kit_value(&kit, "s1"), 0, 1e-12);
        EXPECT(kit_value(&kit, "s1'") == 0 && kit_value(&kit, "s1''") == 0);
        EXPECT_NEAR(kit_value(&kit, "s1.fy"), 9.81, 1e-12);
        EXPECT(kit_value(&kit, "min(s1)") > -1e-9);
        kit_free(&kit);
    }
}

static void every_method_brings_bounces_to_rest(void)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "bdf", "adams", "ida", "rk4"};

    for (size_t i = 0; i < sizeof methods / sizeof methods[0]; i++) {
        Kit kit = kit_new();
        char line[100];

        (void)snprintf(line, sizeof line, "simulate 10 every=0.01 method=%s", methods[i]);
        EXPECT_DONE(&kit, BALL BOUNCE);
        EXPECT_DONE(&kit, line);
        EXPECT_NEAR(rest_of(&kit), 9 * sqrt(2 / 9.81), 1e-3);
        EXPECT(kit_value(&kit, "s1'") == 0);
        kit_free(&kit);
    }
}

/* A force 4 t lifts 2 kg from t0 = g/2 on: s = t^3/3 then. */
static void what_rests_leaves_where_the_acceleration_points_away(void)
{
    const double left = 8 - 9.81 / 2;
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nbody m1 mass=2\n"
                      "prismatic s1 ground m1 axis=y\ninit s1 = 1\nforce F m1 [0, 4*t]\n"
                      "event hit when=s1 < 0 && s1' < 0 s1'=-0.5*s1'\nsimulate 8 rtol=1e-10");
    EXPECT_HOLDS(ct_remarks(kit.session), " to t = 4.905 s");
    EXPECT_NEAR(kit_value(&kit, "s1"), left * left * left / 3, 1e-8);
    EXPECT_NEAR(kit_value(&kit, "s1'"), left * left, 1e-8);
    EXPECT_NEAR(kit_value(&kit, "s1'' at 3"), 0, 1e-12);
    /* what rests goes on resting, and leaves, in a run that goes on */
    EXPECT_DONE(&kit, "simulate 3 rtol=1e-10\nresume 5");
    EXPECT_NEAR(kit_value(&kit, "s1"), left * left * left / 3, 1e-8);
    EXPECT(kit_value(&kit, "s1'' at 4") == 0);
    /* a run whose equations can't hold it does not go on past its series */
    EXPECT_DONE(&kit, "simulate 1");
    EXPECT(kit_do(&kit, "resume 7") == CT_FAILED);
    EXPECT_HOLDS(kit.error.hint, "simulate");
    kit_free(&kit);
}

/* The guard may be any function of the coordinates, in either tree and form: a rod that falls
 * against a slope is held at its angle, here by a point of it. */
static void guards_are_held_in_every_tree(void)
{
    static const char *const trees[] = {"", "tree absolute\n", "tree absolute\nform embedded\n"};
    double rest[3];

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();
        char text[600];

        (void)snprintf(text, sizeof text,
                       "scene planar; gravity [0, -9.81]\n"
                       "body r mass=1.3 inertia=1.3*0.8^2/12\narm top r [0, 0.4]\n"
                       "revolute h ground top\n%s"
                       "event w when=0.4*sin(h) < 0.4*sin(0.35) h'=-0.6*h'\n"
                       "init h = 1.2, h' = 0\nsimulate 5 rtol=1e-10 atol=1e-12\n",
                       trees[i]);
        EXPECT_DONE(&kit, text);
        rest[i] = rest_of(&kit);
        EXPECT_NEAR(rest[i], rest[0], 1e-8);
        EXPECT_NEAR(kit_value(&kit, "h"), 0.35, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "h''"), 0, 1e-9);
        kit_free(&kit);
    }
}

int main(void)
{
    RUN(bounces_that_pile_up_come_to_rest);
    RUN(every_method_brings_bounces_to_rest);
    RUN(what_rests_leaves_where_the_acceleration_points_away);
    RUN(guards_are_held_in_every_tree);
    return test_end();
}
