/* test_start.c: the start is the one described: senses of axes, turns, signs of Euler parameters */
#include "session_kit.h"

#define CLOSE 1e-12

static void expect_value(Kit *kit, const char *name, double wanted)
{
    const double got = kit_value(kit, name);

    if (!(fabs(got - wanted) <= CLOSE)) {
        test_faults++;
        printf("%s is %.17g, not %.17g\n", name, got, wanted);
    }
}

/* a weld on a frame that is turned by 120 deg about z: its four parameters up to their sign */
static void welded_frames_are_turned_alike(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body b mass=1 inertia=[1, 2, 3]\n"
                      "arm a ground [1, 0, 0] rotation=z(120 deg)\n"
                      "arm u b [0, 0, 0]\n"
                      "weld w a u\n"
                      "tree absolute\n");
    expect_value(&kit, "u.q0*u.q3", 0.5 * sin(M_PI / 3));
    expect_value(&kit, "u.q0^2", 0.25);
    EXPECT_DONE(&kit, "init b.q0 = -0.5, b.q1 = 0, b.q2 = 0, b.q3 = -0.866025403784439\n");
    expect_value(&kit, "u.q0*u.q3", 0.5 * sin(M_PI / 3));
    kit_free(&kit);
}

/* the body hangs where 30 degrees about -y put it: half a turn about z, then the arm */
static void angles_of_chords_place_bodies(void)
{
    static const char *const trees[] = {"tree joint\n", "tree absolute\n",
                                        "tree translation r\ntree rotation j\n",
                                        "tree translation j\ntree rotation r\n"};

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "arm hm ground [0, 0, 0] rotation=z(180 deg)\n"
                          "body r mass=1 inertia=[0.1, 0.1, 0.1]\n"
                          "arm ra r [-0.5, 0, 0]\n"
                          "revolute j hm ra axis=y\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "init j = 30 deg, j' = 0\n");
        expect_value(&kit, "r.x", -0.5 * cos(M_PI / 6));
        expect_value(&kit, "r.y", 0);
        expect_value(&kit, "r.z", -0.5 * sin(M_PI / 6));
        expect_value(&kit, "j", M_PI / 6);
        kit_free(&kit);
    }
}

#define FOUR_BAR                                                                                   \
    "body a mass=1 inertia=[1, 1, 1]\n"                                                            \
    "body b mass=1 inertia=[1, 1, 1]\n"                                                            \
    "body c mass=1 inertia=[1, 1, 1]\n"                                                            \
    "arm g ground [1, 0, 0]\n"                                                                     \
    "arm a1 a [0, 1, 0]\n"                                                                         \
    "arm b1 b [1, 0, 0]\n"                                                                         \
    "revolute h1 ground a\n"                                                                       \
    "revolute h2 a1 b\n"                                                                           \
    "revolute h3 g c\n"

/* the axes of the closing hinge are opposite in every position, whatever the trees */
static void reversed_axes_are_refused(void)
{
    static const char *const trees[] = {"", "tree absolute\n",
                                        "tree translation h1 h2 h4\ntree rotation h1 h3 h4\n"};

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, FOUR_BAR "arm c1 c [0, 1, 0] rotation=x(180 deg)\n"
                                   "revolute h4 b1 c1\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_FAILS(&kit, "init h1 = 0.3\nassemble\n", "axis");
        EXPECT_HOLDS(kit.error.message, " closes only with its axis reversed: z of ");
        EXPECT_HOLDS(kit.error.message, " point opposite ways");
        EXPECT_HOLDS(kit.error.message, i == 0 ? "h4 closes" : "h");
        kit_free(&kit);
    }
}

/* A flyball governor: two arms of 0.4 m on a spindle, opened by 0.6 rad, whose links of 0.3 m lift
 * a collar. It stands as its hinges say in any trees. */
static void governors_stand_as_told(void)
{
    static const char *const trees[] = {
        "tree joint\n", "tree absolute\n",
        "tree translation s h1 g1 A2 K2 S\ntree rotation s h1 f1 h2 f2 S\n"};
    const double open = 0.6, turn = 0.7, out = 0.05 + 0.4 * sin(open);
    const double leans = asin(0.2 * sin(open) / 0.3);

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit,
                    "body S mass=1 inertia=[1, 1, 1]; body C mass=1 inertia=[1, 1, 1]\n"
                    "body A1 mass=1 inertia=[1, 1, 1]; body A2 mass=1 inertia=[1, 1, 1]\n"
                    "body K1 mass=1 inertia=[1, 1, 1]; body K2 mass=1 inertia=[1, 1, 1]\n"
                    "revolute hs ground S axis=z; prismatic s S C axis=z\n"
                    "arm p1 S [0.05, 0, 0]; arm a1 A1 [0, 0, 0.4]; arm m1 A1 [0, 0, 0.2]\n"
                    "arm p2 S [-0.05, 0, 0]; arm a2 A2 [0, 0, 0.4]; arm m2 A2 [0, 0, 0.2]\n"
                    "arm k1 K1 [0, 0, 0.15]; arm c1 K1 [0, 0, -0.15]; arm n1 C [0.05, 0, 0]\n"
                    "arm k2 K2 [0, 0, 0.15]; arm c2 K2 [0, 0, -0.15]; arm n2 C [-0.05, 0, 0]\n"
                    "revolute h1 p1 a1 axis=-y; revolute g1 m1 k1 axis=-y\n"
                    "revolute h2 p2 a2 axis=y; revolute g2 m2 k2 axis=y\n"
                    "revolute f1 c1 n1 axis=-y; revolute f2 c2 n2 axis=y\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "init hs = 0.7, h1 = 0.6, h2 = 0.6\nassemble\n");
        expect_value(&kit, "A1.x", out * cos(turn));
        expect_value(&kit, "A1.y", out * sin(turn));
        expect_value(&kit, "A2.x", -out * cos(turn));
        expect_value(&kit, "A2.z", -0.4 * cos(open));
        expect_value(&kit, "C.z", -0.2 * cos(open) - 0.3 * cos(leans));
        expect_value(&kit, "g2", -leans - open);
        kit_free(&kit);
    }
}

/* three angles at which two axes fall together have no rates, and print no nan */
static void critical_angles_start_nothing(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body b mass=1 inertia=[1, 2, 3]\nspherical s ground b euler=zxz\n");
    EXPECT_FAILS(&kit, "assemble\n", "s starts at a critical angle");
    EXPECT_HOLDS(kit.error.message, "s.a2 is 0 or 180 deg");
    EXPECT_DONE(&kit, "init s.a2 = 0.2\nassemble\n");
    expect_value(&kit, "s.a3", 0);
    kit_free(&kit);
}

/* the frames of a weld are turned by half a turn against each other */
static void reversed_welds_are_refused(void)
{
    static const char *const trees[] = {"", "tree absolute\n"};

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "body b mass=1 inertia=[1, 2, 3]\n"
                          "arm a ground [1, 0, 0] rotation=z(120 deg)\n"
                          "arm u b [0, 0, 0]\n"
                          "weld w a u\n"
                          "arm v b [0, 0, 0] rotation=y(180 deg)\n"
                          "weld w2 a v\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_FAILS(&kit, "assemble\n",
                     "w2 closes only with its tip reversed: v is turned "
                     "against a by half a turn about y of a");
        kit_free(&kit);
    }
}

/* an event that would open the weld's loop the wrong way round says so, and does not do it */
static void events_close_no_axis_reversed(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body b mass=1 inertia=[1, 2, 3]\n"
                      "revolute h ground b axis=z\n"
                      "tree absolute\n"
                      "init h = 10 deg\n"
                      "event e when=t>0.5 b.q0=0 b.q1=1 b.q2=0 b.q3=0\n");
    EXPECT_FAILS(&kit, "simulate 1\n",
                 "h would close with its axis reversed: z of ground and z of b");
    kit_free(&kit);
}

static void axes_that_agree_close_the_loop(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, FOUR_BAR "arm c1 c [0, 1, 0]\nrevolute h4 b1 c1\n"
                               "tree absolute\ninit h1 = 0.3\nassemble\n");
    expect_value(&kit, "h3", 0.3);
    expect_value(&kit, "h2", -0.3);
    expect_value(&kit, "h4", 0.3);
    kit_free(&kit);
}

/* told by the place of its mass centre, 1.25 rad from the vertical */
static void angles_start_within_half_a_turn(void)
{
    static const char *const trees[] = {"tree joint\n", "tree absolute\n"};

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "gravity [0, 0, -9.81]\n"
                          "body a mass=1 inertia=[1, 1, 1]\n"
                          "arm p a [0, 0, 0.5]\n"
                          "revolute h ground p axis=x\n"
                          "spring k h k=1\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "init a.y = 0.474492309677793, a.z = -0.157661181197634\n");
        expect_value(&kit, "h", 1.25);
        expect_value(&kit, "k.effort", -1.25);
        EXPECT_DONE(&kit, "init none\ninit h = 13\n");
        expect_value(&kit, "h", 13);
        expect_value(&kit, "k.effort", -13);
        kit_free(&kit);
    }
}

/* what the starts before were has no part in the turn of an angle that nobody gives */
static void turns_do_not_pile_up_over_starts(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody a mass=1 inertia=1\narm e a [1, 0]\n"
                      "body b mass=1 inertia=1\nrevolute h1 ground a\nrevolute h2 e b\n"
                      "virtual revolute v ground b\ntree rotation h1 v\n");
    for (int i = 0; i < 8; i++) {
        char line[80];

        (void)snprintf(line, sizeof line, "init h1 = %d, h2 = %g\nassemble\n", i % 3 - 1,
                       i % 2 == 0 ? 1.9 : -1.9);
        EXPECT_DONE(&kit, line);
        expect_value(&kit, "v", i % 3 - 1 + (i % 2 == 0 ? 1.9 : -1.9));
    }
    kit_free(&kit);
}

/* around a planar loop angles add up but for whole turns */
static void given_angles_close_a_loop_modulo_turns(void)
{
    static const char *const trees[] = {"tree h1 h2 s\n", "tree absolute\n", "tree h1 h2 h3\n"};

    for (size_t i = 0; i < sizeof trees / sizeof trees[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "scene planar\n"
                          "body a mass=1 inertia=1\n"
                          "body b mass=1 inertia=1\n"
                          "body c mass=1 inertia=1\n"
                          "revolute h1 ground a\n"
                          "revolute h2 a b\n"
                          "revolute h3 b c\n"
                          "prismatic s ground c axis=x\n");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "init h1 = 2.5, h2 = 2.5\n");
        expect_value(&kit, "h3", 2 * M_PI - 5);
        EXPECT_DONE(&kit, "init h1 = 2.5, h2 = 2.5, h3 = -5\n");
        expect_value(&kit, "h3", -5);
        EXPECT_DONE(&kit, "simulate 0.1\n");
        kit_free(&kit);
    }
}

/* typed with six digits; two of four that leave nothing to the others */
static void rounded_parameters_move_nothing(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body b mass=1 inertia=[1, 2, 3]\ninit b.q0 = 0.866025, b.q3 = 0.5\n");
    expect_value(&kit, "b.x", 0);
    expect_value(&kit, "b.q1", 0);
    expect_value(&kit, "b.q0/b.q3", 0.866025 / 0.5);
    EXPECT_DONE(&kit, "init none\ninit b.q0 = -0.6, b.q3 = -0.8\n");
    expect_value(&kit, "b.q0*b.q3", 0.48);
    EXPECT_FAILS(&kit, "init b.q0 = 1, b.q1 = 1, b.q2 = 0, b.q3 = 0\nassemble\n", "b.q0");
    kit_free(&kit);
}

/* three angles of a chord have no formula, but place what hangs on it */
static void three_angles_of_a_chord_place_bodies(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body b mass=1 inertia=[1, 2, 3]\n"
                      "arm e b [0, 0, 1]\n"
                      "spherical s ground e euler=zyx\n"
                      "tree absolute\n"
                      "init s.a1 = 0, s.a2 = 0, s.a3 = 30 deg\n");
    expect_value(&kit, "b.y", 0.5);
    expect_value(&kit, "b.z", -cos(M_PI / 6));
    kit_free(&kit);
}

static void driven_runs_start_from_the_same(void)
{
    static const char *const runs[] = {"kinematics 0.5\n", "inverse 0.5\n"};

    for (size_t i = 0; i < sizeof runs / sizeof runs[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "arm hm ground [0, 0, 0] rotation=z(180 deg)\n"
                          "body r mass=1 inertia=[0.1, 0.1, 0.1]\n"
                          "arm ra r [-0.5, 0, 0]\n"
                          "revolute j hm ra axis=y\n"
                          "tree absolute\n"
                          "driver D j = pi/6 + t\n");
        EXPECT_DONE(&kit, runs[i]);
        EXPECT(fabs(kit_value(&kit, "r.x") + 0.5 * cos(M_PI / 6 + 0.5)) < 1e-9);
        EXPECT(fabs(kit_value(&kit, "j") - M_PI / 6 - 0.5) < 1e-9);
        kit_free(&kit);
    }
}

/* Turning j1 moves the weld's rows by metres a radian, but one of them by rounding alone. */
static void rows_that_nothing_moves_are_met_by_rounding(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit,
                "body b0 mass=1.18 inertia=[1, 2, 2.5]\n"
                "body b1 mass=2.16 inertia=[1, 2, 2.5]\n"
                "arm t0 ground [0.16323214601972191, -0.44504733008252506, -0.35259648455595649] "
                "rotation=z(-1.0284009544026238)*y(0.16805885027640638)*x(-0.09143891037345421)\n"
                "arm h0 b0 [-0.58250097613320362, -0.31497535150165595, 0.19825930409768011] "
                "rotation=z(1.224364137237715)*y(-0.80192828687954665)*x(2.2319503149946738)\n"
                "revolute j0 t0 h0 axis=[0.089168321754412139, 0.17743768002148075, "
                "-0.5792204495613078]\n"
                "arm h1 b0 [-0.51144873143804248, -0.41416547044727031, -0.37751184198827792] "
                "rotation=z(-2.3808728050527979)*y(1.3209229961190803)*x(-0.44158442599895342)\n"
                "screw j1 b1 h1 axis=-y pitch=0.14473575909175809\n"
                "arm t2 b1 [-0.089179676065144653, 0.57374438624761204, 0.32317844810612573] "
                "rotation=z(0)*y(-0.097687066917185983)*x(0)\n"
                "arm h2 b0 [-0.091799856176064773, -0.93761392972293989, -0.38081813455524305] "
                "rotation=z(2.7954495554168881)*y(1.4648551649550987)*x(-1.5365728892337482)\n"
                "weld j2 t2 h2\n"
                "arm t3 b1 [0.18653584043089233, 0.328527194886021, 0.19962102816312621] "
                "rotation=z(0.81893525226265773)*y(0)*x(-0)\n"
                "arm h3 b0 [-0.41468831795882, -0.78578209427316381, -0.5698296705371666] "
                "rotation=z(1.0511363716199502)*y(-0.50520808513692228)*x(-0.74848569190511904)\n"
                "screw j3 t3 h3 axis=[-0.7764411164239724, -0.19606980561518328, "
                "0.97518627962007476] pitch=0.34287965013533073\n"
                "tree joint\n"
                "guess b0.x = 0.11451947234456877\n"
                "guess b0.y = -0.22309248893558498\n"
                "guess b0.z = 0.30023330553168803\n"
                "guess b0.q0 = -0.21604586070450238\n"
                "guess b0.q1 = 0.4305175790113665\n"
                "guess b0.q2 = 0.77752202627048117\n"
                "guess b0.q3 = 0.40427502878472232\n"
                "guess b1.x = 0.028462175420856245\n"
                "guess b1.y = -0.90704979355953708\n"
                "guess b1.z = -0.010170922902287077\n"
                "guess b1.q0 = 0.44005831438513621\n"
                "guess b1.q1 = 0.60866195375539534\n"
                "guess b1.q2 = -0.66019400674093454\n"
                "guess b1.q3 = 0.0048145045984716722\n");
    EXPECT_DONE(&kit, "assemble\n");
    expect_value(&kit, "b0.x", 0.11451947234456877);
    expect_value(&kit, "b0.y", -0.22309248893558498);
    expect_value(&kit, "b0.z", 0.30023330553168803);
    expect_value(&kit, "b1.x", 0.028462175420856245);
    expect_value(&kit, "b1.y", -0.90704979355953708);
    expect_value(&kit, "b1.z", -0.010170922902287077);
    kit_free(&kit);
}

/* two welds whose distances differ by little are told as those that are missed */
static void loops_open_by_little_are_named(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\n"
                      "body b mass=1 inertia=1\n"
                      "arm there b [1, 0]\n"
                      "arm wall ground [1.00000000003, 0]\n"
                      "weld w1 ground b\n"
                      "weld w2 wall there\n"
                      "tree absolute\n");
    EXPECT(kit_do(&kit, "assemble\n") != CT_OK);
    EXPECT(strstr(kit.error.message, "missed: w1 (x) by 1.5e-11, w2 (x) by 1.5e-11") != NULL);
    kit_free(&kit);
}

int main(void)
{
    RUN(turns_do_not_pile_up_over_starts);
    RUN(welded_frames_are_turned_alike);
    RUN(angles_of_chords_place_bodies);
    RUN(governors_stand_as_told);
    RUN(critical_angles_start_nothing);
    RUN(reversed_axes_are_refused);
    RUN(reversed_welds_are_refused);
    RUN(events_close_no_axis_reversed);
    RUN(axes_that_agree_close_the_loop);
    RUN(angles_start_within_half_a_turn);
    RUN(given_angles_close_a_loop_modulo_turns);
    RUN(rounded_parameters_move_nothing);
    RUN(three_angles_of_a_chord_place_bodies);
    RUN(driven_runs_start_from_the_same);
    RUN(rows_that_nothing_moves_are_met_by_rounding);
    RUN(loops_open_by_little_are_named);
    return test_end();
}
