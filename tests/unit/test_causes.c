/* test_causes.c: messages that name the cause, at its place */
#include "session_kit.h"

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
        {SWINGS "simulate 1\nsimulate 2\n", "print max(run1.h - run2.h)", 7, "run1 has no value at t = 1.004 s: it goes from 0 to 1 s", "the last of them"},
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

int main(void)
{
    RUN(the_cause_is_named_at_its_place);
    RUN(values_at_different_ends_are_said_to_be);
    return test_end();
}
