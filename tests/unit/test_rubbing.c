/* test_rubbing.c: friction with one bound in two or three directions, in joints and between frames
 */
#include "session_kit.h"

#include <math.h>

#define PUCK                                                                                       \
    "gravity [0, 0, -9.81]\nbody b mass=1 inertia=[0.1, 0.1, 0.1]\nplanarjoint p ground b\n"       \
    "init p.s1 = 0, p.s2 = 0, p.theta = 0\n"
#define BALL                                                                                       \
    "body b mass=1 inertia=[0.5, 0.5, 0.5]\nspherical s ground b\nfriction f s torque=0.4\n"       \
    "init b.wx = 1, b.wy = 2, b.wz = 2\n"

/* v^2/(2 T/m) far, after v/(T/m); the pivoting has its own bound and instant */
static void sliding_and_pivoting_are_independent(void)
{
    static const char *const trees[] = {"", "tree absolute\n", "form embedded\n"};

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, PUCK "friction f p force=2 static=1.3\nfriction g p.theta torque=0.05\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "init p.s1' = 3, p.s2' = 4, p.theta' = 2\nsimulate 5\n");
        EXPECT_NEAR(kit_value(&kit, "p.s1"), 3.75, 1e-8);
        EXPECT_NEAR(kit_value(&kit, "p.s2"), 5, 1e-8);
        EXPECT_NEAR(kit_value(&kit, "p.theta"), 4, 1e-8);
        EXPECT_NEAR(kit_value(&kit, "f.lost"), 12.5, 1e-7);
        EXPECT_NEAR(kit_value(&kit, "g.lost"), 0.2, 1e-7);
        EXPECT_NEAR(kit_value(&kit, "f.hold"), 2.6, 1e-12);
        EXPECT_NEAR(kit_value(&kit, "energy.total + energy.lost"), 12.7, 1e-7);
        kit_free(&kit);
    }
}

static void sides_are_shown(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PUCK "friction f p force=2 static=1.5\nactuator l p.s1 force=1.5\n"
                           "init p.s1' = 0, p.s2' = 1, p.theta' = 0\nsimulate 10\n");
    EXPECT_DONE(&kit, "show sides at 0.1\n");
    EXPECT_HOLDS(kit.text, "slips");
    EXPECT_HOLDS(kit.text, "2 N    2 N  100 %");
    EXPECT_DONE(&kit, "show sides at 10\n");
    EXPECT_HOLDS(kit.text, "f     sticks   1.5 N    3 N   50 %");
    kit_free(&kit);
}

/* a spherical inertia: its axis stays, and w falls by T/I */
static void a_ball_stops_about_its_axis(void)
{
    static const char *const trees[] = {"", "tree absolute\n"};

    for (int i = 0; i < 2; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, BALL);
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "simulate 3\n");
        EXPECT_NEAR(kit_value(&kit, "b.wx"), 0.2, 1e-8);
        EXPECT_NEAR(kit_value(&kit, "b.wz"), 0.4, 1e-8);
        EXPECT_DONE(&kit, "resume 2\n");
        EXPECT(kit_value(&kit, "abs(b.wx) + abs(b.wy) + abs(b.wz)") < 1e-13);
        EXPECT_NEAR(kit_value(&kit, "f.lost"), 2.25, 1e-7);
        kit_free(&kit);
    }
}

/* Turned by what drives the tail: the head follows as long as the bound allows, 2 N on 1 kg. */
static void frames_slide_on_a_plane(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body belt mass=1 inertia=[1, 1, 1]\nprismatic s ground belt axis=x\n"
                      "driver d s = 3*t\nbody b mass=1 inertia=[1, 1, 1]\n"
                      "planarjoint p ground b normal=y\nfriction f belt b force=2 normal=y\n"
                      "init b.x = 0, b.z = 0, b.vx = 0, b.vz = 4, b.wy = 0\nsimulate 4\n");
    EXPECT_NEAR(kit_value(&kit, "b.vx"), 3, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "b.vz"), 0, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "b.z"), 5, 1e-8); /* 5 m/s along [-3, 4]/5 in 2.5 s */
    EXPECT_NEAR(kit_value(&kit, "b.x"), 12 - 3.75, 1e-8);
    kit_free(&kit);
}

static void what_lacks_it_refuses_it(void)
{
    static const struct {
        const char *text, *message, *hint;
    } wrong[] = {
        {PUCK "friction f p\n", "f needs force=", "force=2"},
        {PUCK "friction f p torque=2\n", "torque= does not fit", "use force="},
        {PUCK "friction f p force=2 normal=x\n", "normal= does not fit", "FRAME FRAME"},
        {PUCK "friction f p.s1 force=2 normal=x\n", "normal= does not fit", "FRAME FRAME"},
        {PUCK "friction f p mu=0.1\n", "mu= does not fit", "force=mu*n"},
        {PUCK "friction f ground b force=1 radius=1\n", "radius= does not fit", ""},
        {PUCK "friction f ground b torque=1\n", "torque= does not fit", "use force="},
        {PUCK "friction f b b force=1\n", "both ends of f are b", ""},
        {PUCK "brake f p force=1\n", "p has several", "p.s1"},
        {"body b mass=1 inertia=[1, 1, 1]\ncylindrical c ground b\nfriction f c force=1\n",
         "don't share one bound", "friction f c.s"},
        {BALL "friction g s force=1\n", "force= does not fit", "use torque="},
        {BALL "delete s\n", "s is used by f", ""},
        {BALL "export c\n", "f sticks at rest", ""},
    };

    for (int i = 0; i < (int)(sizeof wrong / sizeof wrong[0]); i++) {
        Kit kit = kit_new();

        EXPECT_FAILS(&kit, wrong[i].text, wrong[i].message);
        EXPECT_HOLDS(kit.error.hint, wrong[i].hint);
        kit_free(&kit);
    }
}

int main(void)
{
    RUN(sliding_and_pivoting_are_independent);
    RUN(sides_are_shown);
    RUN(a_ball_stops_about_its_axis);
    RUN(frames_slide_on_a_plane);
    RUN(what_lacks_it_refuses_it);
    return test_end();
}
