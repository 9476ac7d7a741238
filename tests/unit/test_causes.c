/* test_causes.c: messages that name the cause, at its place */
#include "session_kit.h"

#include "base/memory.h"

#define SWINGS PENDULUM "init none\ninit h = 1\n"
#define MEETING                                                                                    \
    PENDULUM "init none\narm a1 ground [1, 0]\narm a2 m [1, 1]\nspring k1 a1 a2 k=3 length=1\n"

static void the_cause_is_named_at_its_place(void)
{
    /* clang-format off */
    static const Refusal wrong[] = {
        {SWINGS "simulate 1\ndriver D1 h = t\n", "print max(D1.effort)", 7, "'D1.effort' came after the run", "in the next run"},
        {SWINGS "simulate 1\nbody b mass=1 inertia=1\n", "print b.x at 0.5", 7, "'b.x' came after the run", "next run"},
        {SWINGS "simulate 1\nbody b mass=1 inertia=1\n", "table h b.x", 9, "'b.x' came after the run", "next run"},
        {SWINGS "simulate 1\nbody b mass=1 inertia=1\n", "plot h (2*b.x)", 11, "'b.x' came after the run", "next run"},
        {SWINGS "simulate 1\nbody b mass=1 inertia=1\n", "linearize at=0.5 outputs=[h, b.x]", 30, "'b.x' came after the run", "next run"},
        {SWINGS "simulate 1\nsimulate 2\n", "print max(run1.h - run2.h)", 7, "run1 has no value at t = 1.0", "the last of them"},
        {SWINGS "simulate 1\nsimulate 2\n", "table run2.h run1.h", 14, "run1 has no value at t = 1.004 s", "the last of them"},
        {"scene planar\nbody m1 mass=1\nrevolute h1 ground m1\n", "simulate 1", 1, "what h1 moves has no mass or inertia", "inertia=0.1"},
        {"body m1 mass=1\nrevolute h1 ground m1\n", "simulate 1", 1, "what h1 moves has no mass or inertia", "inertia=[0.1, 0.2, 0.2]"},
        {MEETING, "simulate 1", 1, "the frames of k1, a1 and a2, are at the same point", "'init' or 'guess'"},
        {MEETING, "equilibrium", 1, "the frames of k1, a1 and a2, are at the same point", "'init' or 'guess'"},
        {MEETING, "modes", 1, "the frames of k1, a1 and a2, are at the same point", "'init' or 'guess'"},
        {MEETING "driver D h = t\n", "kinematics 1", 1, "the frames of k1, a1 and a2, are at the same point", "'init' or 'guess'"},
        {PENDULUM "damper d1 ground p d=3\n", "simulate 1", 1, "the frames of d1, ground and p, are always at the same point", "an arm away"},
    };
    /* clang-format on */

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        kit_expect_refused(&wrong[i]);
}

static void values_at_different_ends_are_said_to_be(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SWINGS "simulate 1\nsimulate 2\nprint run1.h - run2.h\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "each run is taken at its own end, 1 s and 2 s");
    EXPECT_DONE(&kit, "print run1.h - run2.h at 1\n");
    EXPECT_LACKS(ct_remarks(kit.session), "its own end");
    EXPECT(fabs(kit_value(&kit, "run1.h - run2.h at 1")) < 1e-6);
    kit_free(&kit);
}

/* a slider drawn beyond crank and rod, and a four-bar's crank driven beyond its change point: at
 * 1.2 + 0.5 t = 0.5 + 1, and where the diagonal has the length of rod and rocker */
static void drivers_that_lead_too_far_are_named(void)
{
    static const char *const trees[] = {"", "tree absolute\n", "form embedded\n"};
    static const char *const methods[] = {"dop853", "radau", "bdf", "ida", "rk4", "symplectic"};
    static const char *const scenes[] = {
        "scene planar\n"
        "body crank mass=1 inertia=0.1\n"
        "body rod mass=1 inertia=0.1\n"
        "body slider mass=1 inertia=0.1\n"
        "arm c0 crank [-0.25, 0]\n"
        "arm c1 crank [0.25, 0]\n"
        "arm r0 rod [-0.5, 0]\n"
        "arm r1 rod [0.5, 0]\n"
        "revolute a ground c0\n"
        "revolute b c1 r0\n"
        "revolute c r1 slider\n"
        "prismatic d ground slider axis=[1, 0]\n"
        "guess a = 1\n"
        "guess b = -1.5\n"
        "driver D d = 1.2 + 0.5*t\n",
        "scene planar\n"
        "body crank mass=1 inertia=0.1\n"
        "body rod mass=1 inertia=0.1\n"
        "body rocker mass=1 inertia=0.1\n"
        "arm c0 crank [-0.25, 0]\n"
        "arm c1 crank [0.25, 0]\n"
        "arm r0 rod [-0.3, 0]\n"
        "arm r1 rod [0.3, 0]\n"
        "arm o0 rocker [-0.3, 0]\n"
        "arm o1 rocker [0.3, 0]\n"
        "arm post ground [1, 0]\n"
        "revolute a ground c0\n"
        "revolute b c1 r0\n"
        "revolute c r1 o1\n"
        "revolute d post o0\n"
        "guess b = 0.5\n"
        "guess d = 2\n"
        "driver D a = 0.2 + t\n",
    };
    /* cos(0.2 + t) = (0.5^2 + 1 - 1.2^2) / (2 * 0.5) */
    const double ends[] = {0.6, acos((0.25 + 1 - 1.44) / 1) - 0.2};

    for (int i = 0; i < 2 * 3 * 5; i++) {
        const int scene = i % 2;
        Kit kit = kit_new();
        const char *when;
        char run[60];

        EXPECT_DONE(&kit, scenes[scene]);
        EXPECT_DONE(&kit, trees[i / 2 % 3]);
        (void)snprintf(run, sizeof run, "simulate 2 every=0.1 method=%s", methods[i / 6]);
        EXPECT(kit_do(&kit, run) != CT_OK);
        EXPECT_HOLDS(kit.error.message, ": D leads where ");
        when = strstr(kit.error.message, "at t = ");
        EXPECT(when != NULL && fabs(strtod(when + 7, NULL) - ends[scene]) < 1e-5);
        kit_free(&kit);
    }
}

/* A force that is infinite where it changes its sign ends a run of any method: what limits the step
 * is named, and a way out. */
static void what_limits_the_step_is_named(void)
{
    static const char limit[] = "the error of s' limits it, F pushes hardest";
    static const struct {
        const char *name, *message, *hint;
    } methods[] = {{"dop853", limit, "rtol="},
                   {"radau", limit, "rtol="},
                   {"bdf", limit, "rtol="},
                   {"adams", limit, "rtol="},
                   {"ida", limit, "rtol="}};

    for (int i = 0; i < COUNT(methods); i++) {
        Kit kit = kit_new();
        char run[60];

        EXPECT_DONE(&kit, "scene planar\n"
                          "body b mass=1 inertia=1\n"
                          "prismatic s ground b axis=x\n"
                          "actuator F s force=-1e2*abs(s)^-0.5*tanh(1e16*s)\n"
                          "init s = 0.3, s' = 0.1\n");
        (void)snprintf(run, sizeof run, "simulate 5 method=%s", methods[i].name);
        EXPECT(kit_do(&kit, run) != CT_OK);
        EXPECT_HOLDS(kit.error.message, methods[i].message);
        EXPECT_HOLDS(kit.error.hint, methods[i].hint);
        kit_free(&kit);
    }
}

int main(void)
{
    RUN(the_cause_is_named_at_its_place);
    RUN(values_at_different_ends_are_said_to_be);
    RUN(drivers_that_lead_too_far_are_named);
    RUN(what_limits_the_step_is_named);
    return test_end();
}
