/* test_session_virtual.c: virtual branches must leave every freedom that real joints have */
#include "session_kit.h"

#include <math.h>
#include <string.h>

/* two bodies, the second on `joint`; a virtual joint beside it takes its place in rotation */
#define BODIES                                                                                     \
    "gravity [0, 0, -9.81]\n"                                                                      \
    "body a mass=1 inertia=[0.1, 0.2, 0.3]\n"                                                      \
    "body b mass=1 inertia=[0.1, 0.2, 0.3]\n"                                                      \
    "arm pa a [0.5, 0, 0]\n"                                                                       \
    "arm pb b [0, 0, 0.4]\n"                                                                       \
    "revolute j1 ground a axis=z\n"

static void a_virtual_hinge_does_not_cover_a_ball(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BODIES "spherical j2 pa pb\nvirtual revolute v1 a b axis=z\n");
    EXPECT(kit_do(&kit, "tree rotation + v1 - j2") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "b can also turn about ");
    EXPECT_HOLDS(kit.error.message, "v1 does not cover that");
    /* the trees are as they were */
    EXPECT_DONE(&kit, "simulate 0.1\nexpect model.m == 0\n");
    kit_free(&kit);
}

/* values that nothing can be assembled with tell nothing of the trees, but later ones do */
static void what_the_tree_could_not_know_the_run_refuses(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BODIES "spherical j2 pa pb\nvirtual revolute v1 a b axis=z\ninit a.x = 5\n"
                             "tree rotation + v1 - j2\n");
    EXPECT_DONE(&kit, "init a.x = 0\n");
    EXPECT(kit_do(&kit, "assemble") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "v1 does not cover that");
    EXPECT(kit_do(&kit, "simulate 0.1") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "v1 does not cover that");
    /* the way out that the hint names */
    EXPECT_HOLDS(kit.error.hint, "tree - v1");
    EXPECT_DONE(&kit, "tree - v1\nsimulate 0.1\n");
    kit_free(&kit);
}

/* freedoms are told of the rank where it is known, and are never negative */
static void freedoms_are_what_is_free(void)
{
    static const char loop[] =
        "body c mass=1 inertia=[1, 1, 1]\nbody r mass=2 inertia=[1, 3, 3]\n"
        "body o mass=1 inertia=[1, 1, 1]\narm ca c [0.5, 0, 0]\narm ra r [1.5, 0, 0]\n"
        "arm oa o [1, 0, 0]\narm g ground [1.2, 0, 0]\nrevolute h1 ground c\nrevolute h2 ca r\n"
        "revolute h3 g o\nrevolute h4 ra oa\n";
    Kit kit = kit_new();

    EXPECT_DONE(&kit, loop);
    EXPECT_DONE(&kit, "init h1 = 60 deg\nguess c.q0 = 0.87, c.q3 = 0.5, r.x = 0.25, r.y = 0.43\n"
                      "guess o.x = 1.2, o.q0 = 0.8, o.q3 = 0.6\ntree absolute\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "20 constraints, 1 degree of freedom;");
    EXPECT_DONE(&kit, "init h1' = 1, h2' = 7, h3' = 3, c.x = 9\ntree c r o\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "20 constraints, n - m = -2;");
    kit_free(&kit);
}

/* a universal joint turns about z, then about x; a hinge about z lacks the latter */
static void the_turn_that_is_lost_is_named(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BODIES "universal j2 pa pb axes=[z, x]\n"
                             "virtual revolute v1 a b axis=z\n");
    EXPECT(kit_do(&kit, "tree rotation + v1 - j2") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "b can also turn about x (ground axes) against a");
    kit_free(&kit);
}

static void a_virtual_hinge_covers_a_hinge(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BODIES "revolute j2 pa pb axis=x\nvirtual revolute v1 a b axis=x\n"
                             "tree rotation + v1 - j2\nsimulate 0.1\n");
    kit_free(&kit);
}

static void a_virtual_free_joint_covers_all_and_is_warned_of(void)
{
    Kit kit = kit_new();
    double height;

    EXPECT_DONE(&kit, BODIES "spherical j2 pa pb\nvirtual free v1 a b\ntree joint\n"
                             "init j1' = 1\nsimulate 0.5 rtol=1e-11 atol=1e-12\n");
    height = kit_value(&kit, "b.x");
    EXPECT_DONE(&kit, "tree rotation + v1 - j2\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "v1 covers every motion of its frames");
    EXPECT_DONE(&kit, "simulate 0.5 rtol=1e-11 atol=1e-12\n");
    EXPECT(fabs(kit_value(&kit, "b.x") - height) < 1e-8);
    kit_free(&kit);
}

/* a spherical joint in the place of a hinge tells more than moves: equations stay, freedoms too */
static void more_than_moves_is_accepted(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BODIES "revolute j2 pa pb axis=x\nvirtual spherical v1 a b\n"
                             "tree rotation + v1 - j2\nsimulate 0.1\nexpect model.m > 0\n");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_virtual_hinge_does_not_cover_a_ball);
    RUN(what_the_tree_could_not_know_the_run_refuses);
    RUN(freedoms_are_what_is_free);
    RUN(the_turn_that_is_lost_is_named);
    RUN(a_virtual_hinge_covers_a_hinge);
    RUN(a_virtual_free_joint_covers_all_and_is_warned_of);
    RUN(more_than_moves_is_accepted);
    return test_end();
}
