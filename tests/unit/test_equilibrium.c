/* test_equilibrium.c: where networks and mechanisms rest together, against closed forms */
#include "session_kit.h"

#include "base/memory.h"
#include "base/text.h"

#include <math.h>

/* the lines, whose `expect`s tell */
static void rests(const char *lines)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, lines);
    kit_free(&kit);
}

/* which continuations were begun: bits by phase */
enum { SOURCES = 1, GMIN = 2, CREEPING = 4 };

static void note_phase(void *context, const char *phase, double fraction)
{
    static const char *const phases[] = {"equilibrium: source stepping",
                                         "equilibrium: gmin stepping", "equilibrium: creeping"};
    int *seen = context;

    (void)fraction;
    for (int i = 0; i < COUNT(phases); i++)
        if (strcmp(phase, phases[i]) == 0)
            *seen |= 1 << i;
}

static void rests_by(const char *model, int phases, const char *expectations)
{
    int seen = 0;
    const ct_hooks hooks = {.context = &seen, .progress = note_phase};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, model);
    ct_session_hooks(kit.session, &hooks);
    EXPECT_DONE(&kit, "equilibrium\n");
    EXPECT(seen == phases);
    EXPECT_DONE(&kit, expectations);
    kit_free(&kit);
}

/* --- transducers --- */

/* the pull Q i^2/(2 (X + x)^2) carries the weight at a gap that no one else's is stable at */
static void a_ball_rests_below_a_magnet_where_the_pull_is_its_weight(void)
{
    rests("scene planar\ng = 9.81; gravity [0, -g]\n"
          "m = 0.05; x0 = 8e-3; X = 2e-3; Q = 2e-4; R = 8; i0 = sqrt(2*m*g/Q)*(X + x0)\n"
          "body ball mass=m inertia=0\nprismatic gap ground ball axis=-y\n"
          "solenoid coil gap a 0 L=0.02 + Q/(X + gap) R=R\nvsource bias a 0 R*i0\n"
          "init gap = 5e-3\nequilibrium\n"
          "expect gap ~ x0 within 1e-14\nexpect coil.i ~ i0 within 1e-13\n");
}

/* k s (s0 - s)^2 = eA V^2/2 has two roots in the gap; from the relaxed spring the one before a
 * third of it */
static void a_plate_rests_before_a_third_of_its_gap(void)
{
    rests("scene planar\neA = 5e-5; s0 = 0.05; k = 200\nbody p mass=0.1 inertia=0\n"
          "prismatic s ground p axis=y\nspring k1 s k=k\nvsource E a 0 11.5\n"
          "resistor R a b 10\nplatecap C s b 0 C=eA/(s0 - s)\nequilibrium\n"
          "expect k*s*(s0 - s)^2 ~ eA*11.5^2/2 within 1e-16\nexpect s > 0 && s < s0/3\n"
          "expect C.v ~ 11.5 within 1e-12\n"
          "init s = 0.025, C.v = 11.5\nequilibrium\n"
          "expect k*s*(s0 - s)^2 ~ eA*11.5^2/2 within 1e-16\nexpect s > s0/3 && s < s0\n");
}

/* V/R through the winding, with or without its inductance, and geared up */
static void a_motor_turns_until_its_spring_holds_it(void)
{
    static const char *const motors[] = {"R=1.5 L=0.1 Kt=0.5 Kv=0.5", "R=1.5 L=0 Kt=0.5 Kv=0.5",
                                         "R=1.5 L=0.1 Kt=0.05 Kv=0.05 ratio=10"};

    for (int i = 0; i < COUNT(motors); i++) {
        Text lines = {0};

        text_addf(&lines,
                  "scene planar\nbody r mass=1 inertia=0.01\nrevolute h ground r\n"
                  "spring k1 h k=2\nmotor M h a 0 %s\nvsource E a 0 6*cos(30*t)\nequilibrium\n"
                  "expect h ~ 1 within 1e-14\nexpect M.i ~ 4 within 1e-14\n"
                  "expect h' ~ 0 within 0\n",
                  motors[i]);
        rests(lines.at);
        text_free(&lines);
    }
}

/* L = L0/(1 + x/d): k (rest - x) = i^2/2 L0/d/(1 + x/d)^2 */
static void a_relay_rests_where_its_spring_outweighs_the_coil(void)
{
    rests("scene planar\nbody armature mass=0.02 inertia=0\nprismatic x ground armature axis=x\n"
          "spring k1 x k=400 rest=6e-3\nsolenoid X x a 0 L=0.02/(1 + x/1e-3) R=20\n"
          "vsource E a 0 6\ninit x = 6e-3\nequilibrium\n"
          "expect 400*(6e-3 - x) ~ 0.3^2/2*20/(1 + x/1e-3)^2 within 1e-13\n"
          "expect x > 5.9e-3 && x < 6e-3\n");
}

/* an angle, measured as a voltage, drives a diode: neither knows of the other's equations */
static void a_diode_rests_on_a_sensed_position(void)
{
    rests("scene planar\ngravity [0, -9.81]\nbody r mass=1 inertia=0.1\narm p r [0, 0.5]\n"
          "revolute h ground p\nspring k1 h k=2 rest=60 deg\nsensor S h a 0 gain=5\n"
          "resistor R a b 1000\ndiode D b 0 Is=1e-14\nequilibrium\n"
          "Vt = 1.380649e-23*300.15/1.602176634e-19\n"
          "expect 9.81*0.5*sin(h) + 2*(h - 60 deg) ~ 0 within 1e-14\n"
          "expect D.i ~ (5*h - D.v)/1000 within 1e-16\n"
          "expect D.i ~ 1e-14*(exp(D.v/Vt) - 1) + 1e-12*D.v within 1e-15\n");
}

/* A p = m g + k x behind a pipe; shut in, the oil carries the weight alone, at any height */
static void a_cylinder_carries_its_load(void)
{
    Kit kit = kit_new();

    rests("scene planar\ngravity [0, -9.81]\nbody load mass=800 inertia=50\n"
          "prismatic rise ground load axis=y\nspring guide rise k=1000\n"
          "pump P a 0 pressure=25e5*(1 + t)\npipe line a b R=2.5e9\n"
          "cylinder lift rise b 0 area=40e-4\ntank oil b 0 C=2e-12\nequilibrium\n"
          "expect oil.p ~ 25e5 within 1e-8\n"
          "expect rise ~ (40e-4*25e5 - 800*9.81)/1000 within 1e-12\n");
    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nbody load mass=800 inertia=50\n"
                      "prismatic rise ground load axis=y\ninit rise = 0.3\n"
                      "cylinder lift rise b 0 area=40e-4\npipe line b c R=1e9\n"
                      "tank oil c 0 C=2e-12\nequilibrium\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "1 direction in which nothing pushes back");
    EXPECT_DONE(&kit, "expect oil.p ~ 800*9.81/40e-4 within 1e-8\n"
                      "expect rise ~ 0.3 within 0\n");
    kit_free(&kit);
}

static void a_node_that_floats_beside_a_mechanism_is_named(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody r mass=1 inertia=0.01\nrevolute h ground r\n"
                      "spring k1 h k=2\nmotor M h b 0 R=1.5 L=0.1 Kt=0.5 Kv=0.5\n"
                      "vsource E a 0 12\nresistor R1 a b 100\ncapacitor C1 b c 1 uF\n"
                      "capacitor C2 c 0 1 uF\nequilibrium\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "at rest nothing determines C");
    EXPECT_DONE(&kit, "expect h ~ 0.5*12/101.5/2 within 1e-15\n"
                      "expect C1.v + C2.v ~ 1.5*12/101.5 within 1e-15\n");
    kit_free(&kit);
}

static void nothing_rests_and_what_is_driven_does(void)
{
    rests("equilibrium\n");
    rests("scene planar\nbody m mass=1 inertia=1\nrevolute h ground m\n"
          "driver D h = 1 + t\nequilibrium\nexpect h ~ 1 within 1e-15\n");
}

/* --- mechanisms --- */

/* hinges of a planar four-bar in space: half of what they hold the others hold too. At rest two
 * equal cranks hang straight down, and each end carries half the weight. */
static void a_redundant_four_bar_hangs_down(void)
{
    static const char *const trees[] = {"tree h1 h2 h3\n", "tree absolute\n"};

    for (int i = 0; i < COUNT(trees); i++) {
        Text lines = {0};

        text_addf(&lines,
                  "gravity [0, 0, -9.81]\nbody m1 mass=1 inertia=[0.01, 0.1, 0.1]\n"
                  "body m2 mass=2 inertia=[0.01, 0.2, 0.2]\n"
                  "body m3 mass=1 inertia=[0.01, 0.1, 0.1]\n"
                  "arm a1 m1 [-0.5, 0, 0]\narm b1 m1 [0.5, 0, 0]\narm a2 m2 [-1, 0, 0]\n"
                  "arm b2 m2 [1, 0, 0]\narm a3 m3 [0.5, 0, 0]\narm b3 m3 [-0.5, 0, 0]\n"
                  "arm g ground [2, 0, 0]\nrevolute h1 ground a1 axis=y\n"
                  "revolute h2 b1 a2 axis=y\nrevolute h3 b2 a3 axis=y\nrevolute h4 g b3 axis=y\n"
                  "init h1 = 60 deg\nguess h2 = -60 deg, h3 = 60 deg, h4 = 60 deg\n%s"
                  "equilibrium\n"
                  "expect h1 ~ pi/2 within 1e-12\nexpect m1.z ~ -0.5 within 1e-12\n"
                  "expect m2.z ~ -1 within 1e-12\nexpect m2.x ~ 1 within 1e-12\n"
                  "expect h1.fz ~ 2*9.81 within 1e-11\nexpect h1.fx ~ 0 within 1e-11\n",
                  trees[i]);
        rests(lines.at);
        text_free(&lines);
    }
}

/* A rod of length 1 on a ball joint, a spring of no length from its end e to c: what turns it is
 * e x (k c - m g/2 z), so e stands along that, or against it. Begun nearly upside down. */
static void a_spatial_pendulum_points_along_what_pulls_it(void)
{
    static const char *const trees[] = {"tree j1\n", "tree absolute\n"};
    static const struct {
        const char *start;
        int side;
    } starts[] = {
        {"init j1.q0 = 0.1, j1.q1 = 0.9\nguess j1.q2 = 0.3\n", -1},
        {"init j1.q0 = 0.9, j1.q1 = 0.3\nguess j1.q2 = -0.2\n", 1},
    };

    for (int i = 0; i < COUNT(trees) * COUNT(starts); i++) {
        Kit kit = kit_new();
        Text lines = {0};

        text_addf(&lines,
                  "gravity [0, 0, -9.81]\nbody m1 mass=2 inertia=[0.1, 0.2, 0.25]\n"
                  "arm p1 m1 [0, 0, 0.5]\narm e1 m1 [0, 0, -0.5]\nspherical j1 ground p1\n"
                  "arm c ground [0.4, -0.3, -0.6]\nspring k1 c e1 k=30\n%s%sequilibrium\n",
                  starts[i / 2].start, trees[i % 2]);
        EXPECT_DONE(&kit, lines.at);
        EXPECT_HOLDS(ct_remarks(kit.session), "1 direction in which nothing pushes back");
        text_free(&lines);
        text_addf(&lines,
                  "X = 0.4*30; Y = -0.3*30; Z = -0.6*30 - 9.81\nS = %d/2/sqrt(X^2 + Y^2 + Z^2)\n"
                  "expect m1.x ~ S*X within 1e-12\nexpect m1.y ~ S*Y within 1e-12\n"
                  "expect m1.z ~ S*Z within 1e-12\n",
                  starts[i / 2].side);
        EXPECT_DONE(&kit, lines.at);
        text_free(&lines);
        kit_free(&kit);
    }
}

/* -s^3 has a root of order 3: steps of a third of the way, and nothing to divide by at the end */
static void a_singular_equilibrium_is_come_close_to(void)
{
    rests("scene planar\nbody m1 mass=1 inertia=1\nprismatic s ground m1 axis=x\n"
          "actuator f s force=-(s - 1)^3\ninit s = 3\nequilibrium\nexpect s ~ 1 within 1e-3\n");
}

/* Links of length 1 and weight G between two pins: tan a_i = G ((n + 1)/2 - i)/H, with H from the
 * span. So many unknowns are solved sparse. */
static void a_long_chain_hangs_in_its_catenary(void)
{
    enum { LINKS = 16 };
    const double weight = 9.81, span = 0.8 * LINKS;
    double low = 1e-3, high = 1e3, pull = 1;
    Kit kit = kit_new();
    Text lines = {0};

    for (int k = 0; k < 200; k++) {
        double width = 0;

        pull = sqrt(low * high);
        for (int i = 1; i <= LINKS; i++)
            width += cos(atan(weight * ((LINKS + 1) / 2.0 - i) / pull));
        *(width < span ? &low : &high) = pull;
    }
    text_addf(&lines, "scene planar\ngravity [0, -9.81]\n");
    for (int i = 1; i <= LINKS; i++)
        text_addf(&lines,
                  "body b%d mass=1 inertia=1/12\narm l%d b%d [-0.5, 0]\narm r%d b%d [0.5, 0]\n"
                  "revolute h%d %s%.0d l%d\nguess b%d.x = %g, b%d.y = %g, b%d.theta = %g\n",
                  i, i, i, i, i, i, i > 1 ? "r" : "ground", i - 1, i, i, 0.8 * (i - 0.5), i,
                  -0.6 * fmin(i - 0.5, LINKS + 0.5 - i), i, i <= LINKS / 2 ? -0.64 : 0.64);
    text_addf(&lines, "arm g ground [%.17g, 0]\nrevolute e r%d g\ntree absolute\nequilibrium\n",
              span, LINKS);
    EXPECT_DONE(&kit, lines.at);
    for (int i = 1; i <= LINKS; i++) {
        char name[20];

        (void)snprintf(name, sizeof name, "b%d.theta", i);
        EXPECT_NEAR(kit_value(&kit, name), -atan(weight * ((LINKS + 1) / 2.0 - i) / pull), 1e-9);
    }
    EXPECT_NEAR(kit_value(&kit, "-h1.fx"), pull, 1e-8);
    EXPECT_NEAR(kit_value(&kit, "h1.fy"), weight * LINKS / 2.0, 1e-9);
    text_free(&lines);
    kit_free(&kit);
}

/* --- where Newton's method alone doesn't arrive --- */

/* A ball below a magnet that a chain of diodes feeds, each of its ends with `shunt` to ground, from
 * a source that isn't one of the loads (a block's output). Its place: m g = Q i^2/(2 (X + x)^2). */
static void ball_behind_diodes(Text *model, int diodes, const char *voltage, const char *shunt)
{
    text_addf(model,
              "scene planar\ng = 9.81; gravity [0, -g]\nm = 0.05; X = 2e-3; Q = 2e-4\n"
              "body ball mass=m inertia=0\nprismatic gap ground ball axis=-y\n"
              "gain supply n0 0 of=%s k=1\ninit gap = 5e-3\n"
              "solenoid coil gap n%d 0 L=0.02 + Q/(X + gap) R=8\n",
              voltage, diodes);
    for (int k = 0; k < diodes; k++) {
        text_addf(model, "diode D%d n%d n%d Is=1e-14\n", k, k, k + 1);
        if (shunt != NULL)
            text_addf(model, "resistor R%d n%d 0 %s\n", k + 1, k + 1, shunt);
    }
}

#define BALANCE                                                                                    \
    "Vt = 1.380649e-23*300.15/1.602176634e-19\n"                                                   \
    "expect 2*m*g*(X + gap)^2/Q ~ coil.i^2 within 1e-11\n"                                         \
    "expect D1.i ~ 1e-14*(exp(D1.v/Vt) - 1) + 1e-12*D1.v within 1e-11\n"

/* Without a current nothing tells how to move the ball, so all at once leads nowhere. */
static void a_network_settles_before_mechanics_moves(void)
{
    Text model = {0};

    ball_behind_diodes(&model, 4, "10", NULL);
    rests_by(model.at, 0, BALANCE "expect coil.i ~ (10 - 4*D1.v)/8 within 1e-12\n");
    text_free(&model);
}

/* Newton's method overshoots the exponentials; and without weight nothing keeps the ball off the
 * magnet, so loads can't grow from nothing. */
static void beside_mechanics_leaks_shrink_where_loads_cannot_grow(void)
{
    Text model = {0};

    ball_behind_diodes(&model, 12, "100", "1000");
    rests_by(model.at, GMIN,
             BALANCE "expect D0.i ~ n1.v/1000 + D1.i within 1e-11\n"
                     "expect D0.i ~ 1e-14*(exp(D0.v/Vt) - 1) + 1e-12*D0.v within 1e-11\n"
                     "expect D11.i ~ n12.v/1000 + coil.i within 1e-11\n"
                     "expect coil.i ~ n12.v/8 within 1e-12\nexpect n0.v ~ 100 within 1e-12\n");
    text_free(&model);
}

/* The motor's torque 4 (V/R = 4, Kt = 1) against s + 4 sin(2 s), which rises and falls on the way
 * from 8.5 */
static void beside_a_network_sources_grow(void)
{
    rests_by("scene planar\nbody r mass=1 inertia=0.1\nrevolute h ground r\n"
             "actuator f1 h torque=-4*sin(2*h)\nspring k1 h k=1\n"
             "motor M h a 0 R=2 L=0.1 Kt=1 Kv=1\nvsource E a 0 8\ninit h = 8.5\n",
             SOURCES, "expect h - 4 + 4*sin(2*h) ~ 0 within 1e-12\nexpect M.i ~ 4 within 1e-13\n");
}

/* a cubic with three solutions, the middle one beyond reach of the others' slopes */
static void a_guess_of_a_network_chooses_among_its_solutions(void)
{
    static const struct {
        const char *guess, *found;
    } guesses[] = {{"1.9", "1.8"}, {"1.05", "1"}, {"0.1", "0.2"}};
    static const char *const runs[] = {"assemble\n", "equilibrium\n", "op\n",
                                       "simulate 1 every=0.1\n"};

    for (int i = 0; i < COUNT(guesses); i++)
        for (int k = 0; k < COUNT(runs); k++) {
            Kit kit = kit_new();
            char line[80];

            EXPECT_DONE(&kit, "vsource E a 0 1.44\nresistor R a b 1\n"
                              "isource I b 0 4*(I.v - 0.2)*(I.v - 1)*(I.v - 1.8) + 1.44 - I.v\n");
            (void)snprintf(line, sizeof line, "guess I.v = %s\n", guesses[i].guess);
            EXPECT_DONE(&kit, line);
            EXPECT_DONE(&kit, runs[k]);
            (void)snprintf(line, sizeof line, "expect I.v ~ %s within 1e-9\n", guesses[i].found);
            EXPECT_DONE(&kit, line);
            kit_free(&kit);
        }
}

int main(void)
{
    RUN(a_ball_rests_below_a_magnet_where_the_pull_is_its_weight);
    RUN(a_plate_rests_before_a_third_of_its_gap);
    RUN(a_motor_turns_until_its_spring_holds_it);
    RUN(a_relay_rests_where_its_spring_outweighs_the_coil);
    RUN(a_diode_rests_on_a_sensed_position);
    RUN(a_cylinder_carries_its_load);
    RUN(a_node_that_floats_beside_a_mechanism_is_named);
    RUN(nothing_rests_and_what_is_driven_does);
    RUN(a_redundant_four_bar_hangs_down);
    RUN(a_spatial_pendulum_points_along_what_pulls_it);
    RUN(a_singular_equilibrium_is_come_close_to);
    RUN(a_long_chain_hangs_in_its_catenary);
    RUN(a_network_settles_before_mechanics_moves);
    RUN(beside_mechanics_leaks_shrink_where_loads_cannot_grow);
    RUN(beside_a_network_sources_grow);
    RUN(a_guess_of_a_network_chooses_among_its_solutions);
    return test_end();
}
