/* test_domains.c: hydraulics, shafts, slides and heat, against closed forms and laws */
#include "session_kit.h"

#include <math.h>

/* models of this file run with these */
#define RUN_FOR(seconds) "simulate " #seconds " rtol=1e-10 atol=1e-12\n"

static void expect_value(const char *model, const char *what, double wanted, double relative)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, model);
    EXPECT_NEAR(kit_value(&kit, what), wanted, relative * (fabs(wanted) + 1e-12));
    kit_free(&kit);
}

/* --- hydraulic --- */

#define WATER_TANK "tank T1 a 0 A=0.5\n"

static const double tank_capacity = 0.5 / (1000 * 9.81); /* m^3/Pa */

static void tank_drains_exponentially_through_a_laminar_pipe(void)
{
    const char *model = WATER_TANK "pipe P1 a 0 R=1e7\ninit T1.p = 10 kPa\n" RUN_FOR(300);
    double left = 1e4 * exp(-300 / (1e7 * tank_capacity));

    expect_value(model, "T1.p", left, 1e-9);
    expect_value(model, "P1.flow", left / 1e7, 1e-9);
    expect_value(model, "T1.volume", tank_capacity * left, 1e-9);
    expect_value(model, "T1.flow", -left / 1e7, 1e-9);
}

/* Torricelli: C p' = -sqrt(p/k), so that sqrt(p) falls linearly */
static void tank_drains_linearly_in_the_root_through_an_orifice(void)
{
    const char *model = WATER_TANK "pipe P1 a 0 k=5e8\ninit T1.p = 10 kPa\n" RUN_FOR(60);
    double root = sqrt(1e4) - 60 / (2 * tank_capacity * sqrt(5e8));

    expect_value(model, "T1.p", root * root, 1e-9);
    expect_value(model, "P1.flow", root / sqrt(5e8), 1e-9);
}

/* R q + k q^2 = p, C p' = -q: with q as variable, t = C (R ln(q0/q) + 2 k (q0 - q)) */
static void tank_drains_through_both(void)
{
    const double R = 2e6, k = 5e8, p0 = 1e4;
    double q0 = (sqrt(R * R + 4 * k * p0) - R) / (2 * k);
    double low = 0, high = q0;
    double q = 0;

    for (int i = 0; i < 200; i++) {
        q = (low + high) / 2;
        if (tank_capacity * (R * log(q0 / q) + 2 * k * (q0 - q)) > 100)
            low = q;
        else
            high = q;
    }
    expect_value(WATER_TANK "pipe P1 a 0 R=2e6 k=5e8\ninit T1.p = 10 kPa\n" RUN_FOR(100), "P1.flow",
                 q, 1e-9);
}

/* the pipe as a branch: its flow is that of the inertance; I q' = -k q^2, q = 1/(1/q0 + k t/I) */
static void turbulent_pipe_stops_the_flow_of_an_inertance(void)
{
    expect_value("inertance I1 a 0 I=2e6\npipe P1 a 0 k=1e8\ninit I1.flow = 0.01\n" RUN_FOR(10),
                 "I1.flow", 1 / (100 + 1e8 * 10 / 2e6), 1e-9);
}

static void water_hammer_swings_at_the_root_of_its_inertance_and_capacity(void)
{
    /* the flow stops at t = 0 against a valve, the pipe's own liquid gives way: p = q0 sqrt(I/C)
     * sin(w t) */
    const char *model = "tank T1 a 0 C=1e-9\ninertance I1 0 a I=4e6\n"
                        "init T1.p = 0, I1.flow = 0.002\n" RUN_FOR(0.3);
    double w = 1 / sqrt(4e6 * 1e-9);

    expect_value(model, "T1.p", 0.002 * sqrt(4e6 / 1e-9) * sin(w * 0.3), 1e-7);
    expect_value(model, "I1.flow", 0.002 * cos(w * 0.3), 1e-7);
    expect_value(model, "I1.impulse", 4e6 * 0.002 * cos(w * 0.3), 1e-7);
    expect_value(model, "energy.kinetic + energy.potential", 0.5 * 4e6 * 0.002 * 0.002, 1e-8);
    expect_value(model, "energy.kinetic", 0.5 * 4e6 * pow(0.002 * cos(w * 0.3), 2), 1e-6);
}

static void pump_holds_its_pressure_or_its_flow(void)
{
    expect_value("pump U1 a 0 pressure=2e5*cos(t)\npipe P1 a 0 R=1e8\n" RUN_FOR(1), "P1.flow",
                 2e5 * cos(1.0) / 1e8, 1e-12);
    expect_value("pump U1 a 0 flow=1e-3\npipe P1 a 0 R=1e8\n" RUN_FOR(1), "P1.flow", 1e-3, 1e-12);
    expect_value("pump U1 a 0 flow=1e-3\npipe P1 a 0 R=1e8\n" RUN_FOR(1), "U1.flow", -1e-3, 1e-12);
    expect_value("pump U1 a 0 flow=1e-3\npipe P1 a 0 R=1e8\n" RUN_FOR(1), "U1.power", -100, 1e-12);
}

#define VALVE_TANK                                                                                 \
    "pump U1 a 0 pressure=2e5\ntank T1 b 0 C=1e-8\ninit T1.p = 0\nvalve V1 a b R=1e8 when=t > 1"

static void valve_opens_at_its_instant(void)
{
    expect_value(VALVE_TANK "\n" RUN_FOR(3), "T1.p", 2e5 * (1 - exp(-2.0)), 1e-8);
    expect_value(VALVE_TANK "\n" RUN_FOR(3), "V1.flow", 2e-3 * exp(-2.0), 1e-8);
    expect_value(VALVE_TANK "\n" RUN_FOR(0.9), "T1.p", 0, 1e-12);
    /* closed it leaks with a time constant of 10 s */
    expect_value(VALVE_TANK " Roff=1e9\n" RUN_FOR(0.5), "T1.p", 2e5 * (1 - exp(-0.05)), 1e-8);
    expect_value(VALVE_TANK " k=0 Roff=1e9\n" RUN_FOR(3), "T1.p", 2e5 * (1 - exp(-0.1) * exp(-2.0)),
                 1e-8);
}

static void check_valve_lets_nothing_back(void)
{
    /* the pump swings, the tank keeps the peak: what is reached at pi/2 stays until 3 pi/2 */
    expect_value("pump U1 a 0 pressure=1e5*sin(t)\nvalve V1 a b R=1e4 when=V1.p > 0\n"
                 "tank T1 b 0 C=1e-8\ninit T1.p = 0\nsimulate 4 rtol=1e-9\n",
                 "T1.p", 1e5, 1e-4);
}

static void valve_with_turbulent_flow_is_an_orifice(void)
{
    double root = sqrt(1e4) - 60 / (2 * tank_capacity * sqrt(5e8));

    expect_value(WATER_TANK "valve V1 a 0 k=5e8 when=t < 60\ninit T1.p = 10 kPa\n" RUN_FOR(90),
                 "T1.p", root * root, 1e-8);
}

#define LIFT                                                                                       \
    "scene planar\ngravity [0, -9.81]\nbody load mass=500 inertia=1\n"                             \
    "prismatic s1 ground load axis=y\ncylinder Y1 s1 b 0 area=30e-4\n"

static void lift_rises_at_the_speed_of_its_pump(void)
{
    /* behind a pipe from a pressure: A p = m g at rest, and A s' = (P - m g/A)/R in the long run */
    const char *model =
        LIFT "pump U1 a 0 pressure=20e5\npipe P1 a b R=1e10\ninit s1 = 0, s1' = 0\nsimulate 2\n";
    double weight = 500 * 9.81;

    expect_value(model, "Y1.p", weight / 30e-4, 1e-7);
    expect_value(model, "s1'", (20e5 - weight / 30e-4) / 1e10 / 30e-4, 1e-7);
    expect_value(model, "Y1.flow", (20e5 - weight / 30e-4) / 1e10, 1e-7);
    expect_value(model, "Y1.force", weight, 1e-7);
    expect_value(model, "s1.effort", weight, 1e-7);
}

static void lift_on_a_gas_spring_swings(void)
{
    /* the tank's C holds the load like a spring A^2/C about its own weight */
    const char *model = LIFT "tank T1 b 0 C=2e-10\n"
                             "init s1 = 0, s1' = 0, T1.p = 0\n" RUN_FOR(0.1);
    double w = sqrt(30e-4 * 30e-4 / 2e-10 / 500);

    expect_value(model, "s1", -9.81 / w / w * (1 - cos(w * 0.1)), 1e-6);
}

/* the liquid in the pipe has to move with the piston: A^2 I joins the mass */
static void inertance_before_a_cylinder_joins_the_mass(void)
{
    const char *model = LIFT "inertance I1 b 0 I=5e7\ninit s1 = 0, s1' = 0\n";
    double mass = 500 + 30e-4 * 30e-4 * 5e7;
    Kit kit = kit_new();

    EXPECT_DONE(&kit, model);
    EXPECT_DONE(&kit, RUN_FOR(1));
    EXPECT_NEAR(kit_value(&kit, "s1"), -0.5 * 500 * 9.81 / mass, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "mass(1,1)"), mass, 1e-9 * mass);
    EXPECT_NEAR(kit_value(&kit, "s1''"), -500 * 9.81 / mass, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "Y1.force"), 500 * (9.81 - 500 * 9.81 / mass), 1e-6);
    EXPECT_NEAR(kit_value(&kit, "energy.total"), 0, 1e-6);
    EXPECT_DONE(&kit, "show mass\n");
    EXPECT_HOLDS(kit.text, "950");
    kit_free(&kit);
}

static void exchanged_terminals_push_back(void)
{
    /* two sides of one piston on the same pressure: nothing is left */
    expect_value("scene planar\nbody b mass=2 inertia=1\nprismatic s1 ground b axis=x\n"
                 "pump U1 a 0 pressure=1e5\ncylinder Y1 s1 a 0 area=1e-3\n"
                 "cylinder Y2 s1 0 a area=4e-4\ninit s1 = 0, s1' = 0\n" RUN_FOR(1),
                 "s1", 0.5 * (1e-3 - 4e-4) * 1e5 / 2, 1e-9);
}

/* --- shafts and slides --- */

static void two_flywheels_swing_on_a_compliant_shaft(void)
{
    const char *model = "flywheel J1 a 0 J=0.1\nshaft k1 a b k=300\nflywheel J2 b 0 J=0.2\n"
                        "init J1.w = 3, J2.w = 0, k1.torque = 0\n" RUN_FOR(1);
    double w = sqrt(300 * (1 / 0.1 + 1 / 0.2));
    double mean = 3 * 0.1 / 0.3;

    expect_value(model, "J1.w", mean + (3 - mean) * cos(w), 1e-7);
    expect_value(model, "J2.w", mean - mean * cos(w), 1e-7);
    expect_value(model, "k1.twist", 3 / w * sin(w), 1e-7);
    expect_value(model, "k1.torque", 300 * 3 / w * sin(w), 1e-7);
    expect_value(model, "J1.momentum + J2.momentum", 0.3, 1e-9);
    expect_value(model, "energy.total", 0.5 * 0.1 * 9, 1e-8);
    expect_value(model, "energy.potential", 0.5 * 300 * pow(3 / w * sin(w), 2), 1e-6);
}

static void damped_shaft_rings_down(void)
{
    const char *model = "flywheel J1 a 0 J=2\nshaft k1 a 0 k=50 d=1.6\n"
                        "init J1.w = 0, k1.twist = 0.1\n" RUN_FOR(2);
    double decay = 1.6 / 4;
    double w = sqrt(25 - decay * decay);

    expect_value(model, "k1.twist", 0.1 * exp(-2 * decay) * (cos(2 * w) + decay / w * sin(2 * w)),
                 1e-7);
    expect_value(model, "k1.torque/(50*k1.twist + 1.6*J1.w)", 1, 1e-12);
}

static void shaft_without_stiffness_is_a_damper(void)
{
    expect_value("flywheel J1 a 0 J=2\nshaft d1 a 0 d=0.5\ninit J1.w = 4\n" RUN_FOR(3), "J1.w",
                 4 * exp(-0.75), 1e-9);
    expect_value("flywheel J1 a 0 J=2\nshaft d1 a b d=0.5\nspeedsource W1 b 0 4\n"
                 "init J1.w = 0\n" RUN_FOR(3),
                 "J1.w", 4 * (1 - exp(-0.75)), 1e-9);
}

#define BEHIND_GEAR "torquesource T1 a 0 1\ngear g1 a 0 b 0 ratio=5\n"

static void gear_shows_an_inertia_by_the_square_of_its_ratio(void)
{
    const char *model = "flywheel J1 a 0 J=0.01\n" BEHIND_GEAR "flywheel J2 b 0 J=1\n"
                        "init J1.w = 0\n" RUN_FOR(1);
    double rate = 1 / (0.01 + 1.0 / 25);

    expect_value(model, "J1.w", rate, 1e-9);
    expect_value(model, "J2.w", rate / 5, 1e-9);
    expect_value(model, "J2.torque", rate / 5, 1e-9);
    expect_value(model, "energy.total", 0.5 * (0.01 * rate * rate + rate * rate / 25), 1e-9);
}

/* the state is on either side, or on both with a source that holds one of them */
static void gear_takes_whatever_side_is_given(void)
{
    expect_value(BEHIND_GEAR "flywheel J2 b 0 J=1\ninit J2.w = 0\n" RUN_FOR(1), "J2.w", 5, 1e-9);
    expect_value(
        "speedsource W1 b 0 2*t\ngear g1 a 0 b 0 ratio=5\nflywheel J1 a 0 J=3\n" RUN_FOR(1),
        "W1.torque", -3 * 5 * 5 * 2, 1e-9);
    expect_value(
        "speedsource W1 a 0 2*t\ngear g1 a 0 b 0 ratio=5\nflywheel J1 b 0 J=3\n" RUN_FOR(1),
        "W1.torque", -3 * 2.0 / 25, 1e-9);
    expect_value(BEHIND_GEAR "gear g2 b 0 c 0 ratio=2\nflywheel J2 c 0 J=1\nflywheel J3 b 0 J=2\n"
                             "init J2.w = 0\n" RUN_FOR(1),
                 "J2.w", 1 / (1.0 / 100 + 2.0 / 25) / 10, 1e-9);
    /* compliances on both sides of it */
    expect_value("speedsource W1 a 0 5\nshaft k1 a b d=1\ngear g1 b 0 c 0 ratio=5\n"
                 "shaft d1 c 0 d=75\n" RUN_FOR(1),
                 "g1.p.w", 5.0 / 4, 1e-9);
}

static void gear_gives_the_same_from_every_tree(void)
{
    static const char *const trees[] = {"J1 J2", "g1.p J2", "J1 g1.s", "T1 J2", "g1.p g1.s"};

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();
        char line[80];

        (void)snprintf(line, sizeof line, "tree shaft %s\nset network tree\n", trees[i]);
        EXPECT_DONE(&kit, "flywheel J1 a 0 J=0.01\n" BEHIND_GEAR "flywheel J2 b 0 J=1\n");
        EXPECT_DONE(&kit, line);
        EXPECT_DONE(&kit, "init J1.w = 0\n" RUN_FOR(1));
        EXPECT_NEAR(kit_value(&kit, "J1.w"), 20, 1e-7);
        kit_free(&kit);
    }
}

#define ARM                                                                                        \
    "scene planar\ngravity [0, -9.81]\nbody b1 mass=2 inertia=0.1\narm p b1 [0, 0.5]\n"            \
    "revolute h1 ground p\n"

/* a flywheel on the joint's own axis is inertia of the joint, and weighs nothing */
static void shaftend_with_a_flywheel_is_a_body_with_more_inertia(void)
{
    static const char *const run = "init h1 = 1, h1' = 0\n" RUN_FOR(2);
    Kit with = kit_new();
    Kit without = kit_new();

    EXPECT_DONE(&with, ARM "shaftend Z1 h1 a 0\nflywheel J1 a 0 J=0.3\n");
    EXPECT_DONE(&with, run);
    EXPECT_DONE(&without, "scene planar\ngravity [0, -9.81]\nbody b1 mass=2 inertia=0.4\n"
                          "arm p b1 [0, 0.5]\nrevolute h1 ground p\n");
    EXPECT_DONE(&without, run);
    EXPECT_NEAR(kit_value(&with, "h1"), kit_value(&without, "h1"), 1e-9);
    EXPECT_NEAR(kit_value(&with, "h1''"), kit_value(&without, "h1''"), 1e-8);
    EXPECT_NEAR(kit_value(&with, "h1.fx"), kit_value(&without, "h1.fx"), 1e-7);
    EXPECT_NEAR(kit_value(&with, "mass(1,1)"), 0.9, 1e-12);
    EXPECT_NEAR(kit_value(&with, "J1.w"), kit_value(&with, "h1'"), 1e-12);
    EXPECT_NEAR(kit_value(&with, "energy.total"), kit_value(&without, "energy.total"), 1e-8);
    kit_free(&with);
    kit_free(&without);
}

static void shaftend_carries_inertia_through_a_gear_and_between_joints(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, ARM "shaftend Z1 h1 a 0\ngear g1 b 0 a 0 ratio=10\n"
                          "flywheel J1 b 0 J=0.002\n");
    EXPECT_DONE(&kit, "init h1 = 1, h1' = 0\n" RUN_FOR(1));
    EXPECT_NEAR(kit_value(&kit, "mass(1,1)"), 0.1 + 2 * 0.25 + 100 * 0.002, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "J1.w"), 10 * kit_value(&kit, "h1'"), 1e-9);
    EXPECT_NEAR(kit_value(&kit, "energy.total"), -2 * 9.81 * 0.5 * cos(1.0), 1e-7);
    EXPECT_DONE(&kit, "clear\n");
    /* a differential: the flywheel turns with the sum of both rates */
    EXPECT_DONE(&kit, "scene planar\nbody b1 mass=1 inertia=0.5\nbody b2 mass=1 inertia=0.7\n"
                      "revolute h1 ground b1\nrevolute h2 ground b2\n"
                      "shaftend Z1 h1 a 0\nshaftend Z2 h2 b a\nflywheel J1 b 0 J=0.2\n"
                      "torquesource T1 b 0 1\ninit h1 = 0, h2 = 0, h1' = 0, h2' = 0\n" RUN_FOR(1));
    EXPECT_NEAR(kit_value(&kit, "mass(1,2)"), 0.2, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "mass(1,1)"), 0.7, 1e-12);
    /* both rates follow the torque that passes through both: 1 - 0.2 (w1 + w2)' */
    EXPECT_NEAR(kit_value(&kit, "h1'") * 0.5, kit_value(&kit, "h2'") * 0.7, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "J1.w"), 1 / (0.2 + 1 / (1 / 0.5 + 1 / 0.7)), 1e-8);
    kit_free(&kit);
}

/* the torque that swings the arm as told, as its source gives it */
static void sources_supply_the_motion_of_a_driver(void)
{
    const char *model =
        ARM "shaftend Z1 h1 a 0\ngear g1 b 0 a 0 ratio=10\nflywheel J1 b 0 J=0.002\n"
            "torquesource T1 b 0 0\ndriver D1 h1 = 0.3*sin(2*t) by=T1\n"
            "inverse 1 every=0.5\n";
    double h = 0.3 * sin(2.0);
    double torque = 0.8 * -4 * h + 2 * 9.81 * 0.5 * sin(h);

    expect_value(model, "T1.torque", -torque / 10, 1e-7);
}

static void slide_of_a_spring_and_a_mass_swings(void)
{
    const char *model = "slug m1 a 0 m=2\nrod k1 a 0 k=200\n"
                        "init m1.v = 0, k1.deflection = 0.1\n" RUN_FOR(1);

    expect_value(model, "m1.v", -sin(10.0), 1e-7);
    expect_value(model, "k1.force", 20 * cos(10.0), 1e-7);
    expect_value(model, "m1.momentum", 2 * -sin(10.0), 1e-7);
    expect_value(model, "energy.total", 1, 1e-8);
}

static void forces_and_velocities_drive_a_line(void)
{
    expect_value(
        "forcesource F1 a 0 10\nslug m1 a 0 m=2\nrod d1 a 0 d=4\ninit m1.v = 0\n" RUN_FOR(3),
        "m1.v", 2.5 * (1 - exp(-6.0)), 1e-8);
    expect_value("velocitysource V1 a 0 0.2\nrod d1 a b d=5\nslug m1 b 0 m=10\n"
                 "init m1.v = 0\n" RUN_FOR(2),
                 "V1.force", -5 * 0.2 * exp(-1.0), 1e-8);
}

static void rodend_with_a_slug_is_a_heavier_body(void)
{
    const char *model = "scene planar\nbody cart mass=3 inertia=1\n"
                        "prismatic s1 ground cart axis=x\nrodend Z1 s1 a 0\nslug m1 a 0 m=2\n"
                        "rod k1 a 0 k=500\ninit s1 = 0, s1' = 1, k1.force = 0\n" RUN_FOR(1);

    expect_value(model, "s1", 0.1 * sin(10.0), 1e-7);
    expect_value(model, "s1'", cos(10.0), 1e-7);
    expect_value(model, "Z1.force", -2 * -10 * sin(10.0) - 500 * 0.1 * sin(10.0), 1e-6);
}

/* --- heat --- */

static void warm_bodies_approach_each_other(void)
{
    const char *model = "heatcap C1 a 0 C=100\nheatcap C2 b 0 C=300\nheatres R1 a b R=0.5\n"
                        "init C1.T = 80, C2.T = 20\n" RUN_FOR(30);
    double fall = 60 * exp(-30 / 0.5 * (1.0 / 100 + 1.0 / 300));

    expect_value(model, "C1.T - C2.T", fall, 1e-9);
    expect_value(model, "R1.heat", fall / 0.5, 1e-9);
    expect_value(model, "C1.stored + C2.stored", 100 * 80 + 300 * 20, 1e-9);
}

static void sources_warm_a_body(void)
{
    expect_value("heatsource H1 a 0 10\nheatcap C1 a 0 C=50\nheatres R1 a 0 R=2\n"
                 "init C1.T = 0\n" RUN_FOR(100),
                 "C1.T", 20 * (1 - exp(-1.0)), 1e-9);
    expect_value("tempsource T1 a 0 300\nheatres R1 a b R=2\nheatcap C1 b 0 C=50\n"
                 "init C1.T = 280\n" RUN_FOR(100),
                 "T1.heat", -10 * exp(-1.0), 1e-7);
    /* what a resistor loses warms it */
    expect_value("vsource E1 e 0 10\nresistor R1 e 0 20 ohm\nheatsource H1 a 0 R1.power\n"
                 "heatcap C1 a 0 C=30\ninit C1.T = 0\n" RUN_FOR(60),
                 "C1.T", 5 * 60 / 30.0, 1e-9);
}

/* heat is a power by itself, its product with temperature is none */
static void heat_is_no_energy_of_the_balance(void)
{
    const char *model = "heatsource H1 a 0 10\nheatcap C1 a 0 C=50\ninit C1.T = 0\n" RUN_FOR(10);
    Kit kit = kit_new();

    EXPECT_DONE(&kit, model);
    EXPECT_NEAR(kit_value(&kit, "C1.T"), 2, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "energy.total"), 0, 1e-300);
    EXPECT(kit_do(&kit, "print C1.power\n") != CT_OK);
    EXPECT_HOLDS(kit.error.message, "heatcap C1 has no variable 'power'");
    kit_free(&kit);
}

/* --- laws of all of them --- */

/* one model a domain that has each row, what sums to zero by Tellegen's theorem, and what a
 * transducer's edge takes less the work on its joint */
static const struct {
    const char *name, *model, *sum, *work;
} laws[] = {
    {"hydraulic",
     LIFT "pump U1 a 0 pressure=20e5 + 1e5*sin(9*t)\ninertance I1 a c I=1e7\npipe P1 c b R=1e9 "
          "k=1e13\ntank T1 b 0 C=1e-10\nvalve V1 b 0 R=1e10 when=t > 0.7\npump U2 b 0 "
          "flow=1e-6\ninit s1 = 0, s1' = 0, T1.p = 16e5\n",
     "U1.power + I1.power + P1.power + T1.power + V1.power + U2.power + Y1.power",
     "Y1.power - Y1.force*s1'"},
    {"shaft",
     ARM "shaftend Z1 h1 a 0\ngear g1 b 0 a 0 ratio=3\nflywheel J1 b 0 J=0.01\n"
         "shaft k1 b c k=40 d=0.1\nflywheel J2 c 0 J=0.02\ntorquesource T1 c 0 sin(3*t)\n"
         "shaft k2 c d k=30\nspeedsource W1 d 0 cos(t)\ninit h1 = 0.5, h1' = 0, J2.w = 1\n",
     "Z1.power + g1.p.power + g1.s.power + J1.power + k1.power + J2.power + T1.power + k2.power + "
     "W1.power",
     "Z1.power - Z1.torque*h1'"},
    {"slide",
     "scene planar\nbody cart mass=3 inertia=1\nprismatic s1 ground cart axis=x\n"
     "rodend Z1 s1 a 0\nslug m1 a 0 m=2\nrod k1 a b k=50 d=1\nslug m2 b 0 m=1\n"
     "forcesource F1 b 0 sin(3*t)\nrod k2 b c k=30\nvelocitysource V1 c 0 cos(t)\n"
     "init s1 = 0, s1' = 1, m2.v = 0\n",
     "Z1.power + m1.power + k1.power + m2.power + F1.power + k2.power + V1.power",
     "Z1.power - Z1.force*s1'"},
    {"thermal",
     "heatsource H1 a 0 10\nheatcap C1 a 0 C=50\nheatres R1 a b R=2\ntempsource T1 b 0 20\n"
     "init C1.T = 0\n",
     "H1.T*H1.heat + C1.T*C1.heat + R1.T*R1.heat + T1.T*T1.heat", "0"},
};

static void products_of_across_and_through_sum_to_zero(void)
{
    for (size_t i = 0; i < sizeof laws / sizeof laws[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, laws[i].model);
        EXPECT_DONE(&kit, "simulate 2 every=0.25\n");
        for (int k = 0; k <= 8; k++) {
            char what[400];

            (void)snprintf(what, sizeof what, "%s at %g", laws[i].sum, 0.25 * k);
            EXPECT_NEAR(kit_value(&kit, what), 0, 1e-9 * (i == 0 ? 100 : 1));
            (void)snprintf(what, sizeof what, "%s at %g", laws[i].work, 0.25 * k);
            EXPECT_NEAR(kit_value(&kit, what), 0, 1e-10);
        }
        kit_free(&kit);
    }
}

static double drift_of(const char *report)
{
    const char *line = report != NULL ? strstr(report, "energy drift") : NULL;

    return line != NULL ? strtod(line + strlen("energy drift"), NULL) : 0;
}

static void energy_is_balanced(void)
{
    for (size_t i = 0; i < 3; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, laws[i].model);
        EXPECT_DONE(&kit, "simulate 2 rtol=1e-9 atol=1e-11\nshow run\n");
        EXPECT_HOLDS(kit.text, "energy drift");
        EXPECT_NEAR(drift_of(kit.text), 0, i == 0 ? 1e-3 : 1e-6);
        kit_free(&kit);
    }
}

static void trees_of_every_domain_can_be_chosen(void)
{
    static const struct {
        const char *domain, *tree;
    } trees[] = {{"hydraulic", "U1 I1 T1"},
                 {"shaft", "Z1 J1 k1 W1"},
                 {"slide", "Z1 k1 V1"},
                 {"thermal", "R1 T1"}};

    for (size_t i = 0; i < sizeof laws / sizeof laws[0]; i++) {
        Kit kit = kit_new();
        char line[80];

        EXPECT_DONE(&kit, laws[i].model);
        (void)snprintf(line, sizeof line, "tree %s %s\n", trees[i].domain, trees[i].tree);
        EXPECT_DONE(&kit, line);
        EXPECT_DONE(&kit, "tree\n");
        EXPECT_HOLDS(kit.text, trees[i].domain);
        EXPECT_DONE(&kit, "show tree\n");
        EXPECT_HOLDS(kit.text, trees[i].tree);
        EXPECT_DONE(&kit, "show edges\n");
        EXPECT_HOLDS(kit.text, trees[i].domain);
        EXPECT_DONE(&kit, "show nodes\nshow network\nsimulate 0.5\n");
        kit_free(&kit);
    }
}

/* --- faults --- */

static void expect_refused(const char *setup, const char *run, const char *message)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, setup);
    EXPECT(kit_do(&kit, run) != CT_OK);
    EXPECT_HOLDS(kit.error.message, message);
    kit_free(&kit);
}

static void networks_without_an_answer_are_refused(void)
{
    expect_refused(ARM "shaftend Z1 h1 a 0\n", "torquesource T1 a 0 -h1''^2\nsimulate 1\n",
                   "Z1 pushes with more than a multiple of an acceleration");
    expect_refused("scene planar\nbody b1 mass=1 inertia=0.5\nbody b2 mass=1 inertia=0.7\n"
                   "revolute h1 ground b1\nrevolute h2 ground b2\n",
                   "shaftend Z1 h1 a 0\ntorquesource T1 a 0 0.1*h2''\nsimulate 1\n",
                   "Z1 passes the acceleration of one of h1' and h2' on to the other one way only");
    expect_refused(LIFT, "pump U1 b 0 flow=1e-4\nsimulate 1\n",
                   "nothing but sources joins two parts of the network: Y1 U1");
    expect_refused("pump U1 a 0 pressure=step(t - 1)*1e5\n", "tank T1 a 0 A=1\nsimulate 2\n",
                   "a source that jumps would drive an impulse through T1");
}

int main(void)
{
    RUN(tank_drains_exponentially_through_a_laminar_pipe);
    RUN(tank_drains_linearly_in_the_root_through_an_orifice);
    RUN(tank_drains_through_both);
    RUN(turbulent_pipe_stops_the_flow_of_an_inertance);
    RUN(water_hammer_swings_at_the_root_of_its_inertance_and_capacity);
    RUN(pump_holds_its_pressure_or_its_flow);
    RUN(valve_opens_at_its_instant);
    RUN(check_valve_lets_nothing_back);
    RUN(valve_with_turbulent_flow_is_an_orifice);
    RUN(lift_rises_at_the_speed_of_its_pump);
    RUN(lift_on_a_gas_spring_swings);
    RUN(inertance_before_a_cylinder_joins_the_mass);
    RUN(exchanged_terminals_push_back);
    RUN(two_flywheels_swing_on_a_compliant_shaft);
    RUN(damped_shaft_rings_down);
    RUN(shaft_without_stiffness_is_a_damper);
    RUN(gear_shows_an_inertia_by_the_square_of_its_ratio);
    RUN(gear_takes_whatever_side_is_given);
    RUN(gear_gives_the_same_from_every_tree);
    RUN(shaftend_with_a_flywheel_is_a_body_with_more_inertia);
    RUN(shaftend_carries_inertia_through_a_gear_and_between_joints);
    RUN(sources_supply_the_motion_of_a_driver);
    RUN(slide_of_a_spring_and_a_mass_swings);
    RUN(forces_and_velocities_drive_a_line);
    RUN(rodend_with_a_slug_is_a_heavier_body);
    RUN(warm_bodies_approach_each_other);
    RUN(sources_warm_a_body);
    RUN(heat_is_no_energy_of_the_balance);
    RUN(products_of_across_and_through_sum_to_zero);
    RUN(energy_is_balanced);
    RUN(trees_of_every_domain_can_be_chosen);
    RUN(networks_without_an_answer_are_refused);
    return test_end();
}
