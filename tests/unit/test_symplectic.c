/* method=symplectic: the same motion backwards, and energy in long runs
 *
 * That a step back ends where the step began is what the method is made for, and holds to rounding;
 * one of any other method here misses it by its error. */
#include "base/memory.h"
#include "session_kit.h"

#define ROD                                                                                        \
    "scene planar\ngravity [0, -9.81]\nbody b1 mass=1 inertia=0.1\narm p1 b1 [0, 1]\n"             \
    "revolute h1 ground p1\n"
#define TWO_RODS                                                                                   \
    "scene planar\ngravity [0, -9.81]\nbody b1 mass=1 inertia=0.1\nbody b2 mass=1 inertia=0.1\n"   \
    "arm p1 b1 [0, 0.5]\narm q1 b1 [0, -0.5]\narm p2 b2 [0, 0.5]\nrevolute h1 ground p1\n"         \
    "revolute h2 q1 p2\n"
#define CRANKS                                                                                     \
    "scene planar\ngravity [0, -9.81]\nbody b1 mass=1 inertia=0.1\nbody b2 mass=2 inertia=0.2\n"   \
    "body b3 mass=1 inertia=0.1\narm p1 b1 [-0.5, 0]\narm q1 b1 [0.5, 0]\narm p2 b2 [-1, 0]\n"     \
    "arm q2 b2 [1, 0]\narm p3 b3 [-0.75, 0]\narm q3 b3 [0.75, 0]\narm g ground [1.75, 0]\n"        \
    "revolute h1 ground p1\nrevolute h2 q1 p2\nrevolute h3 q2 q3\nrevolute h4 g p3\n"              \
    "guess h4 = 110 deg, h2 = -75 deg\n"
#define BODY                                                                                       \
    "body b mass=2 inertia=[1, 2, 3]\nbody c mass=1 inertia=[0.2, 0.3, 0.1]\n"                     \
    "arm p b [0.3, 0.1, 0]\narm q c [0, 0, 0.4]\nrevolute h p q axis=[1, 1, 0]\n"

typedef struct Way {
    const char *model, *start;
    const char *turn; /* what starts the way back, from what the way there ended with */
    const char *same; /* what holds at its end */
} Way;

static void a_motion_runs_back_to_where_it_began(void)
{
    static const Way ways[] = {
        {ROD, "init h1 = 60 deg", "keep a = h1\nkeep v = h1'\ninit h1 = a, h1' = -v",
         "expect h1 ~ 60 deg within 1e-11"},
        {ROD "tree b1\n", "init h1 = 60 deg", "keep a = h1\nkeep v = h1'\ninit h1 = a, h1' = -v",
         "expect h1 ~ 60 deg within 1e-11"},
        {TWO_RODS, "init h1 = 40 deg, h2 = 10 deg",
         "keep a = h1\nkeep b = h2\nkeep v = h1'\nkeep w = h2'\n"
         "init h1 = a, h2 = b, h1' = -v, h2' = -w",
         "expect h2 ~ 10 deg within 1e-11"},
        {CRANKS, "init h1 = 80 deg, h1' = -0.3",
         "keep a = h1\nkeep b = h4\nkeep c = h2\nkeep v = h1'\n"
         "guess h4 = b, h2 = c\ninit h1 = a, h1' = -v",
         "expect h1 ~ 80 deg within 1e-11\nexpect h1' ~ 0.3 within 1e-11"},
        {CRANKS "tree b1 b2 b3\n", "init h1 = 80 deg, h1' = -0.3",
         "keep a = h1\nkeep b = h4\nkeep c = h2\nkeep v = h1'\n"
         "guess h4 = b, h2 = c\ninit h1 = a, h1' = -v",
         "expect h1 ~ 80 deg within 1e-11\nexpect h1' ~ 0.3 within 1e-11"},
    };

    for (int i = 0; i < COUNT(ways); i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, ways[i].model);
        EXPECT_DONE(&kit, ways[i].start);
        EXPECT_DONE(&kit, "simulate 2 every=1 method=symplectic step=0.01");
        EXPECT_DONE(&kit, ways[i].turn);
        EXPECT_DONE(&kit, "simulate 2 every=1 method=symplectic step=0.01");
        EXPECT_DONE(&kit, ways[i].same);
        kit_free(&kit);
    }
}

/* In a run ten times as long energy swings no further: what creeps is ten times as far. */
static void energy_does_not_creep(void)
{
    static const char *const scenes[] = {
        ROD "init h1 = 60 deg",
        ROD "tree b1\ninit h1 = 60 deg",
        TWO_RODS "init h1 = 40 deg, h2 = 10 deg",
        TWO_RODS "tree b1 b2\ninit h1 = 40 deg, h2 = 10 deg",
        BODY "init b.Wx = 0.3, b.Wy = 2, b.Wz = 0.2, b.vx = 0.1, h = 0.5, h' = 1",
    };

    for (int i = 0; i < COUNT(scenes); i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, scenes[i]);
        EXPECT_DONE(&kit, "simulate 50 every=0.1 method=symplectic step=0.05\n"
                          "keep once = max(energy.total) - min(energy.total)\n"
                          "simulate 500 every=0.1 method=symplectic step=0.05\n"
                          "expect max(energy.total) - min(energy.total) < 3*once\n"
                          "expect once < 1e-5");
        kit_free(&kit);
    }
}

/* Steps that the mass on its spring swings within can't be solved for, nor taken shorter one after
 * the other: the way out is told. */
static void steps_that_are_far_too_long_are_refused(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody m mass=1 inertia=1\nspring s ground m k=1e6 length=1\n"
                      "init m.x = 1.1");
    EXPECT_FAILS(&kit, "simulate 10 method=symplectic step=0.1", "too long");
    EXPECT_HOLDS(kit.error.hint, "step=");
    EXPECT_DONE(&kit, "simulate 0.1 method=symplectic step=1e-4\n"
                      "expect m.x ~ 1 + 0.1*cos(100) within 1e-9");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_motion_runs_back_to_where_it_began);
    RUN(energy_does_not_creep);
    RUN(steps_that_are_far_too_long_are_refused);
    return test_end();
}
