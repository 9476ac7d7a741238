/* test_couplers.c: coordinates that follow others: closed forms, and what is refused */
#include "session_kit.h"

#include <math.h>

#define PAIR                                                                                       \
    "scene planar\nbody a mass=1 inertia=2; body b mass=1 inertia=3\n"                             \
    "revolute h1 ground a; revolute h2 ground b\n"

static void expect_value(Kit *kit, const char *what, double wanted)
{
    EXPECT_NEAR(kit_value(kit, what), wanted, 1e-8 * (1 + fabs(wanted)));
}

/* T = (I1 + I2/9) h1'', what the teeth carry is I2 h2'' */
static void gear_reflects_an_inertia(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PAIR "coupler C1 h2 = -h1/3 + 0.2\nactuator T h1 torque=5\n"
                           "init h1 = 0\nsimulate 2\n");
    expect_value(&kit, "h1", 5 / (2 + 3.0 / 9) * 2);
    expect_value(&kit, "h2", 0.2 - 5 / (2 + 3.0 / 9) * 2 / 3);
    expect_value(&kit, "C1.effort", -3 * 5 / (2 + 3.0 / 9) / 3);
    expect_value(&kit, "energy.total", 5 * kit_value(&kit, "h1"));
    expect_value(&kit, "model.dof", 1);
    EXPECT_DONE(&kit, "set C1.value = 2*h1\nsimulate 2\n");
    expect_value(&kit, "h1", 5.0 / (2 + 4 * 3) * 2);
    kit_free(&kit);
}

/* a pinion of 50 mm moves a rack that hangs on it */
static void rack_goes_with_its_pinion(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar; gravity [0, -10]\nr = 50 mm\nbody p mass=1 inertia=0.01\n"
                      "body k mass=4 inertia=1\nrevolute h ground p\n"
                      "prismatic s ground k axis=y\ncoupler C s = r*h\nsimulate 0.5\n");
    /* (I + m r^2) h'' = -m g r */
    expect_value(&kit, "h", -0.5 * 4 * 10 * 0.05 / (0.01 + 4 * 0.0025) * 0.25);
    expect_value(&kit, "C.effort", 4 * 10 + 4 * 0.05 * kit_value(&kit, "h''"));
    expect_value(&kit, "h.fy", 10);
    kit_free(&kit);
}

/* a differential shares torque evenly; wheels may turn against each other */
static void differential_shares_its_torque(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PAIR "body c mass=1 inertia=0.5; revolute h3 ground c\n"
                           "coupler D h3 = (h1 + h2)/2\nactuator T h3 torque=7\n"
                           "actuator B h1 torque=-1\nsimulate 1\n");
    const double push = -kit_value(&kit, "D.effort") / 2; /* on each wheel */

    expect_value(&kit, "h1''", (push * -1 * -1 - 1) / 2);
    expect_value(&kit, "h2''", push / 3);
    expect_value(&kit, "h3''", (7 - 2 * push) / 0.5);
    expect_value(&kit, "h3", (kit_value(&kit, "h1") + kit_value(&kit, "h2")) / 2);
    expect_value(&kit, "model.dof", 2);
    kit_free(&kit);
}

/* a follower on a cam that turns evenly */
static void cam_moves_its_follower(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody w mass=1 inertia=1; body f mass=2 inertia=1\n"
                      "revolute h ground w; prismatic s ground f axis=y\n"
                      "coupler C s = 0.1*(1 - cos(2*h))\ndriver D h = 3*t\n"
                      "inverse 1 every=0.01\n");
    expect_value(&kit, "C.effort at 0.4", 2 * 0.1 * 36 * cos(2.4));
    expect_value(&kit, "D.effort at 0.4", 2 * 0.1 * 36 * cos(2.4) * 0.2 * sin(2.4));
    EXPECT_DONE(&kit, "kinematics 1 every=0.01\n");
    expect_value(&kit, "s at 0.7", 0.1 * (1 - cos(4.2)));
    kit_free(&kit);
}

static void trees_and_forms_agree(void)
{
    static const char *const ways[] = {"tree joint\n", "tree absolute\n", "form embedded\n",
                                       "tree absolute\nform embedded\n"};

    for (int i = 0; i < 4; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "scene planar; gravity [0, -9.81]\n"
                          "body a mass=1 inertia=0.1; arm a1 a [-1/2, 0]; arm a2 a [1/2, 0]\n"
                          "body b mass=2 inertia=0.3; arm b1 b [-1/2, 0]\n"
                          "revolute h1 ground a1; revolute h2 a2 b1\n"
                          "coupler C h2 = -2*h1\ninit h1 = 0.3\n");
        EXPECT_DONE(&kit, ways[i]);
        EXPECT_DONE(&kit, "simulate 1 rtol=1e-10\n");
        /* the middle of b is opposite to that of a: x = 3/2 cos, y = 1/2 sin */
        const double q = kit_value(&kit, "h1"), w = kit_value(&kit, "h1'"),
                     a = kit_value(&kit, "h1''"),
                     M = 0.1 + 0.25 + 0.3 + 2 * (2.25 * sin(q) * sin(q) + 0.25 * cos(q) * cos(q)),
                     slope = 2 * 2 * 2 * sin(q) * cos(q);

        EXPECT_NEAR(M * a + slope * w * w / 2, -9.81 * cos(q) * (0.5 + 2 * 0.5), 1e-7);
        EXPECT_NEAR(kit_value(&kit, "h2"), -2 * q, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "energy.total"), 9.81 * 1.5 * sin(0.3), 1e-7);
        kit_free(&kit);
    }
}

/* of two that say the same each effort is open, but not the motion */
static void repeated_couplers_are_told(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PAIR "coupler C1 h2 = 2*h1\ncoupler C2 h1 = h2/2\nactuator T h1 torque=7\n"
                           "simulate 1\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "repeats C1");
    expect_value(&kit, "h1", 7.0 / (2 + 12) / 2);
    kit_free(&kit);
}

static void subsystems_have_couplers(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nsubsystem box frames=[A]\nN = 3; Ti = 0; To = 0\n"
                      "body i mass=1 inertia=2; body o mass=1 inertia=5\n"
                      "revolute hi A i; revolute ho A o\ncoupler C hi = N*ho\n"
                      "actuator T1 hi torque=Ti; actuator T2 ho torque=To\nend\n"
                      "use box g1 g2 A=ground N=[3, 5] Ti=[4, 0] To=[0, 4]\nsimulate 1\n");
    expect_value(&kit, "g1.hi", 4 / (2 + 5.0 / 9) / 2);
    expect_value(&kit, "g2.ho", 4 / (5 + 2.0 * 25) / 2);
    expect_value(&kit, "g2.C.effort", 2 * kit_value(&kit, "g2.hi''"));
    kit_free(&kit);
}

/* the same machine in two trees: bodies whose coordinates are coupled, one with a's angle */
static void bodies_are_coupled(void)
{
    static const char *const trees[] = {"tree a b\n", "tree h a\n"};
    double at[2][3];

    for (int i = 0; i < 2; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\n"
                          "body a mass=1 inertia=0.2; body b mass=2 inertia=0.3\n"
                          "arm r a [0.5, 0]; revolute h r b\ncoupler C b.theta = -0.5*a.x\n"
                          "spring k ground b k=30 length=0.3\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "init a.x = 0, a.y = 0.1, a.theta = 0.2, a.x' = 0.3, a.y' = 0\n"
                          "init a.theta' = 0\nsimulate 1 rtol=1e-11\n");
        expect_value(&kit, "energy.total", kit_value(&kit, "energy.total at 0"));
        expect_value(&kit, "b.theta + 0.5*a.x", 0);
        expect_value(&kit, "C.power", 0);
        at[i][0] = kit_value(&kit, "a.x");
        at[i][1] = kit_value(&kit, "h");
        at[i][2] = kit_value(&kit, "C.effort");
        kit_free(&kit);
    }
    for (int k = 0; k < 3; k++)
        EXPECT(fabs(at[0][k] - at[1][k]) < 1e-8);
}

static void what_cant_couple_is_refused(void)
{
    static const struct {
        const char *statement, *message, *hint;
    } wrong[] = {
        {"coupler C h2 = t", "follows coordinates, not time", "driver"},
        {"coupler C h2 = h1'", "not rates", ""},
        {"coupler C h2 = h2", "h2 would follow itself", ""},
        {"coupler C h2 = nothing", "nothing", ""},
        {"coupler C h2'' = h1'", "not its acceleration", "h2' = ..."},
        {"coupler C h2' = h1''", "follows no accelerations", ""},
        {"coupler C h2' = h1'^2", "h2' is not linear in h1'", "coordinates, t and parameters"},
        {"coupler C h2' = h2'", "h2 would follow itself", ""},
        {"coupler C h2 = h1 by=T", "no key 'by'", ""},
        {"coupler C h2 = [h1, h1]", "", ""},
        {"coupler C h2 = 5 V*h1", "", ""},
    };
    Kit kit = kit_new(), other = kit_new();

    EXPECT_DONE(&kit, PAIR);
    for (int i = 0; i < (int)(sizeof wrong / sizeof *wrong); i++) {
        EXPECT(kit_do(&kit, wrong[i].statement) == CT_FAILED);
        EXPECT_HOLDS(kit.error.message, wrong[i].message);
        EXPECT_HOLDS(kit.error.hint, wrong[i].hint);
    }
    EXPECT_DONE(&other, "body a mass=1 inertia=[1, 1, 1]; body b mass=1 inertia=[1, 1, 1]\n");
    EXPECT_FAILS(&other, "coupler C b.x = a.q1\n", "can't act on a.q1");
    EXPECT_FAILS(&other, "coupler C b.q1 = a.x\n", "Euler parameter");
    kit_free(&other);
    EXPECT_DONE(&kit, "coupler C h2 = h1\nsimulate 1\n");
    EXPECT(kit_do(&kit, "delete h1") == CT_FAILED);
    EXPECT(kit_do(&kit, "set C.value = t") == CT_FAILED);
    EXPECT_DONE(&kit, "delete C\n");
    expect_value(&kit, "h2", 0);
    kit_free(&kit);
}

/* A nut of mass m and inertia I that turns by alpha is pushed by m p alpha, p the shift per angle,
 * and the thread's moment is -p times that, whatever turns it and wherever the screw stands. */
static void a_thread_carries_the_same_in_all_trees(void)
{
    static const struct {
        const char *turned, *alpha;
    } cases[] = {
        {"actuator A j.theta torque=0.7", "0.7/(0.1 + m*p^2)"},
        {"spring k j.theta k=2 rest=0.35", "0.7/(0.1 + m*p^2)"},
        {"driver D j.theta = 0.3*t^2", "0.6"},
        {"vsource E e 0 3; motor M j.theta e 0 R=2 Kt=0.4 J=0.05", "0.6/(0.15 + m*p^2)"},
        {"body w mass=1 inertia=[1, 1, 1]; revolute h ground w axis=x\n"
         "actuator A h torque=0.9; coupler C j.theta = 2*h\ninit h = 0, h' = 0",
         "2*0.9/(1 + 4*(0.1 + m*p^2))"},
    };
    static const char *const trees[] = {"tree joint\n", "tree absolute\n"};

    for (size_t i = 0; i < 2 * sizeof cases / sizeof *cases; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "m = 1.5; p = 0.9/(2*pi)\nbody b mass=m inertia=[0.1, 0.2, 0.3]\n"
                          "screw j ground b axis=x pitch=0.9\ninit j.theta = 0, j.theta' = 0\n");
        EXPECT_DONE(&kit, cases[i / 2].turned);
        EXPECT_DONE(&kit, trees[i % 2]);
        expect_value(&kit, "j.theta''", kit_value(&kit, cases[i / 2].alpha));
        expect_value(&kit, "j.fx", kit_value(&kit, "m*p*j.theta''"));
        expect_value(&kit, "j.tx", kit_value(&kit, "-p*m*p*j.theta''"));
        kit_free(&kit);
    }
}

int main(void)
{
    RUN(gear_reflects_an_inertia);
    RUN(rack_goes_with_its_pinion);
    RUN(differential_shares_its_torque);
    RUN(cam_moves_its_follower);
    RUN(trees_and_forms_agree);
    RUN(a_thread_carries_the_same_in_all_trees);
    RUN(repeated_couplers_are_told);
    RUN(subsystems_have_couplers);
    RUN(bodies_are_coupled);
    RUN(what_cant_couple_is_refused);
    return test_end();
}
