/* test_multi_turn.c: angles of joints that are chords, over full turns
 *
 * The same scene with the joint as a branch has the angle for a coordinate, and is the reference.
 */
#include "session_kit.h"

/* two bodies about skew axes; b counts turns, and its spring, motor and damper feel them */
#define ARMS                                                                                       \
    "gravity [0.5, 1, -9.81]\n"                                                                    \
    "body A mass=1.2 inertia=[0.4, 0.35, 0.45, 0.01, -0.02, 0.03]\n"                               \
    "body B mass=0.8 inertia=[0.3, 0.4, 0.35, 0.02, 0.01, -0.03]\n"                                \
    "arm ha A [-0.1, 0.2, 0.3]\n"                                                                  \
    "arm ta A [0.2, 0.1, -0.1] rotation=x(0.4)*z(0.3)\n"                                           \
    "arm hb B [0.1, -0.05, 0.1] rotation=y(0.7)\n"                                                 \
    "revolute a ground ha axis=[0.3, 0.2, 1]\n"                                                    \
    "revolute b ta hb axis=[1, 0.2, 0.5]\n"
#define EFFORTS "spring k b k=0.05 rest=1\nactuator m b torque=1.5-0.02*b\ndamper d b d=0.01\n"
#define BRANCH  "tree a b\n"
#define CHORD   "tree a B\n" /* B moves freely, and b is three and two constraints */
#define START   "init a=0.2, b=0.3, a'=1, b'=2\n"

/* the same text in both trees; whatever is compared is compared within `within` */
static void compare(const char *scene, const char *run, const char *const *items, double within)
{
    Kit branch = kit_new(), chord = kit_new();

    EXPECT_DONE(&branch, scene);
    EXPECT_DONE(&branch, BRANCH);
    EXPECT_DONE(&branch, run);
    EXPECT_DONE(&chord, scene);
    EXPECT_DONE(&chord, CHORD);
    EXPECT_DONE(&chord, run);
    for (int i = 0; items[i] != NULL; i++) {
        double wanted = kit_value(&branch, items[i]), got = kit_value(&chord, items[i]);

        EXPECT_NEAR(got, wanted, within);
        if (!(fabs(got - wanted) <= within))
            printf("    %s after %s\n", items[i], run);
    }
    kit_free(&branch);
    kit_free(&chord);
}

/* --- motion --- */

static void a_chord_turns_as_the_branch_does(void)
{
    static const char *const items[] = {
        "a",         "b",        "b'",     "b''",    "k.effort",  "m.effort", "b at 3",
        "b at 6.25", "b' at 12", "max(b)", "min(b)", "mean(b'')", NULL};
    Kit kit = kit_new();

    compare(ARMS EFFORTS START, "simulate 15 every=0.25 rtol=1e-12 atol=1e-12", items, 1e-8);
    /* and that is over several turns */
    EXPECT_DONE(&kit, ARMS EFFORTS START CHORD "simulate 15");
    EXPECT(kit_value(&kit, "max(b)") > 12 * M_PI);
    kit_free(&kit);
}

static void every_method_counts_the_same_turns(void)
{
    static const struct {
        const char *run;
        double within;
    } runs[] = {{"simulate 6 every=1 rtol=1e-11 method=radau", 1e-8},
                {"simulate 6 every=1 rtol=1e-10 method=bdf", 1e-5},
                {"simulate 6 every=1 rtol=1e-10 method=adams", 1e-5},
                {"simulate 6 every=1 rtol=1e-10 method=ida", 1e-5},
                {"simulate 6 every=1 step=0.002 method=rk4", 1e-7},
                {"simulate 6 every=6 rtol=1e-3", 1e-1}};
    Kit reference = kit_new();
    double wanted;

    EXPECT_DONE(&reference, ARMS EFFORTS START BRANCH "simulate 6 rtol=1e-12 atol=1e-12");
    wanted = kit_value(&reference, "b");
    EXPECT(wanted > 4 * M_PI);
    for (int i = 0; i < (int)(sizeof runs / sizeof runs[0]); i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, ARMS EFFORTS START CHORD);
        EXPECT_DONE(&kit, runs[i].run);
        EXPECT_NEAR(kit_value(&kit, "b"), wanted, runs[i].within);
        kit_free(&kit);
    }
    kit_free(&reference);
}

static void both_angles_of_a_universal_joint_count_turns(void)
{
    static const char scene[] = "body A mass=1 inertia=[0.2, 0.3, 0.25]\n"
                                "universal u ground A axes=[z, x] coords=[u1, u2]\n"
                                "virtual universal v ground A axes=[z, x] coords=[v1, v2]\n"
                                "init u1=0.2, u2=0.4, u1'=5, u2'=-4\n";
    Kit kit = kit_new();

    EXPECT_DONE(&kit, scene);
    EXPECT_DONE(&kit, "simulate 10 every=0.5 rtol=1e-10");
    EXPECT(fabs(kit_value(&kit, "u1")) > 4 * M_PI);
    EXPECT(fabs(kit_value(&kit, "u2")) > 4 * M_PI);
    EXPECT_NEAR(kit_value(&kit, "v1"), kit_value(&kit, "u1"), 1e-11);
    EXPECT_NEAR(kit_value(&kit, "v2"), kit_value(&kit, "u2"), 1e-11);
    EXPECT_NEAR(kit_value(&kit, "max(abs(u1 - v1))"), 0, 1e-11);
    EXPECT_NEAR(kit_value(&kit, "v2 at 7.77"), kit_value(&kit, "u2 at 7.77"), 1e-11);
    EXPECT_NEAR(kit_value(&kit, "v2' at 7.77"), kit_value(&kit, "u2' at 7.77"), 1e-8);
    kit_free(&kit);
}

/* a screw as a chord is told by its shift, which knows all turns */
static void a_screw_that_is_a_chord_counts_turns(void)
{
    static const char *const items[] = {"a", "b", "b'", "b.s", "k.effort", NULL};

    compare("gravity [0, 0, -9.81]\nbody A mass=1 inertia=[0.2, 0.3, 0.25]\n"
            "body B mass=0.5 inertia=[0.02, 0.03, 0.01]\nrevolute a ground A axis=[1, 0.2, 0]\n"
            "arm ta A [0.1, 0, 0]\nscrew b ta B axis=z pitch=0.01\nspring k b k=0.01 rest=0\n"
            "init a=0.1, b=20, a'=0, b'=15\n",
            "simulate 3 every=0.5 rtol=1e-11 atol=1e-11", items, 1e-7);
}

/* sin(b - s/lead) = 0 holds half a turn off, too: the assembly doesn't end there */
static void an_assembly_is_not_half_a_turn_off(void)
{
    for (int k = -4; k <= 8; k++) {
        Kit kit = kit_new();
        char line[200];

        (void)snprintf(line, sizeof line,
                       "body A mass=1 inertia=[0.2, 0.3, 0.25]\n"
                       "body B mass=0.5 inertia=[0.02, 0.03, 0.01]\n"
                       "revolute a ground A axis=x\nscrew b A B axis=z pitch=0.01\n");
        EXPECT_DONE(&kit, line);
        (void)snprintf(line, sizeof line, "tree a B\ninit a=0.3, b=%d\nassemble", 2 * k);
        EXPECT_DONE(&kit, line);
        EXPECT_NEAR(kit_value(&kit, "b"), 2 * k, 1e-9);
        /* B has turned about its own z by b, and about x by a before: trace of the rotation */
        EXPECT_NEAR(fabs(kit_value(&kit, "B.q0")), fabs(cos(k) * cos(0.15)), 1e-9);
        kit_free(&kit);
    }
}

static void a_driver_that_can_not_be_met_is_told(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, ARMS CHORD "driver D b = 1\ninit b = 2");
    EXPECT(kit_do(&kit, "assemble") != CT_OK);
    EXPECT_HOLDS(kit.error.message, "given: b = 2");
    EXPECT_HOLDS(kit.error.message, "D (driver)");
    kit_free(&kit);
}

/* nothing but rotation: steps are as long as the integrator likes, and rows many turns apart */
static void no_turn_is_lost_in_long_steps(void)
{
    Kit kit = kit_new();
    double miss;

    EXPECT_DONE(&kit, "body A mass=1 inertia=[0.2, 0.3, 0.25]\nrevolute a ground A axis=z\n"
                      "virtual revolute v ground A axis=[0.4, 0, 1]\ninit a'=300\n"
                      "simulate 10 every=5");
    miss = kit_value(&kit, "v - a");
    EXPECT_NEAR(kit_value(&kit, "a"), 3000, 1e-6);
    EXPECT(fabs(miss) < 1); /* the axis leans: between turns it goes ahead and stays behind */
    EXPECT(fabs(kit_value(&kit, "v - a at 5")) < 1);
    EXPECT(fabs(kit_value(&kit, "v - a at 6.789")) < 1);
    kit_free(&kit);
}

/* --- what a run is cut into --- */

static void a_resumed_run_goes_on_in_its_turn(void)
{
    Kit whole = kit_new(), cut = kit_new();

    EXPECT_DONE(&whole, ARMS EFFORTS START CHORD "simulate 9 every=0.5 rtol=1e-12 atol=1e-12");
    EXPECT_DONE(&cut, ARMS EFFORTS START CHORD "simulate 5.1 every=0.5 rtol=1e-12 atol=1e-12");
    EXPECT(kit_value(&cut, "b") > 4 * M_PI);
    EXPECT_DONE(&cut, "resume 3.9 rtol=1e-12 atol=1e-12");
    EXPECT_NEAR(kit_value(&cut, "b"), kit_value(&whole, "b"), 1e-8);
    EXPECT_NEAR(kit_value(&cut, "b at 2.5"), kit_value(&whole, "b at 2.5"), 1e-8);
    kit_free(&whole);
    kit_free(&cut);
}

static void a_second_run_finds_the_same_turns(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, ARMS EFFORTS START CHORD "simulate 8 every=0.5 check=on");
    EXPECT_HOLDS(kit.text, "global error");
    EXPECT(strstr(ct_remarks(kit.session), "not resolved") == NULL);
    kit_free(&kit);
}

static void events_see_the_turns(void)
{
    static const char *const items[] = {"t", "a", "b", "b'", NULL};

    compare(ARMS EFFORTS START, "event e when=b > 4*pi do=stop\nsimulate 9 rtol=1e-12 atol=1e-12",
            items, 1e-8);
}

/* ... also one that the angle is in already but for full turns */
static void a_new_value_chooses_its_turn(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, ARMS EFFORTS START CHORD
                "event e when=b > 4*pi b=-6*pi\nsimulate 3 every=0.01 rtol=1e-10");
    EXPECT_NEAR(kit_value(&kit, "max(b)"), 4 * M_PI, 1e-8);
    EXPECT_NEAR(kit_value(&kit, "min(b)"), -6 * M_PI, 1e-8);
    EXPECT_NEAR(kit_value(&kit, "max(k.effort)"), 0.05 * (6 * M_PI + 1), 1e-9);
    kit_free(&kit);
}

static void switches_in_the_equations_see_the_turns(void)
{
    static const char *const items[] = {"a", "b", "b'", "m.effort", NULL};

    compare(ARMS START "actuator m b torque=if(b > 3*pi, -1, 1)\n",
            "simulate 6 rtol=1e-12 atol=1e-12", items, 1e-7);
}

/* a circuit that reads the angle, through an ideal diode: one phase hands the turn to the next */
static void phases_of_ideal_switches_see_the_turns(void)
{
    static const char *const items[] = {"a", "b", "b'", "b at 3", "max(D.i)", "mean(M.i)", NULL};

    compare(ARMS EFFORTS START "motor M b e 0 R=1 L=0.1 Kt=0.8 Kv=0.8\n"
                               "vsource V f 0 30*sin(3*t) + 0.1*b\ndiode D f e\n",
            "simulate 6 every=0.1 rtol=1e-11 atol=1e-11", items, 1e-6);
}

/* --- the start --- */

static void a_given_value_chooses_the_turn(void)
{
    static const char *const items[] = {"a", "b", "k.effort", "b at 0", NULL};
    Kit kit = kit_new();

    compare(ARMS EFFORTS "init a=0.2, b=7, a'=1, b'=2\n", "simulate 2 rtol=1e-12 atol=1e-12", items,
            1e-8);
    EXPECT_DONE(&kit, ARMS EFFORTS CHORD "init a=0.2, b=-20");
    EXPECT_NEAR(kit_value(&kit, "b"), -20, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "k.effort"), 0.05 * 21, 1e-12);
    EXPECT_DONE(&kit, "init none\ninit a=0.2\nguess b=13");
    EXPECT(fabs(kit_value(&kit, "b") - 13) < M_PI);
    EXPECT_DONE(&kit, "init b=0.5");
    EXPECT_NEAR(kit_value(&kit, "b"), 0.5, 1e-12);
    kit_free(&kit);
}

static void an_equilibrium_keeps_its_turn(void)
{
    static const char *const items[] = {"a", "b", "k.effort", NULL};
    static const char scene[] = ARMS "spring k b k=30 rest=9\nspring l a k=50 rest=0.2\n"
                                     "init b=8.5, a=0.2\n";

    compare(scene, "equilibrium", items, 1e-8);
    compare(scene, "equilibrium\nsimulate 1", items, 1e-6);
    /* turns that a search goes through count as well */
    compare(ARMS "spring k b k=50 rest=30\nspring l a k=50 rest=0.2\ninit b=2, a=0.2\n",
            "equilibrium", items, 1e-8);
}

static void another_tree_takes_over_the_turn(void)
{
    static const char *const trees[] = {CHORD, BRANCH, CHORD};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, ARMS "spring k b k=30 rest=9\nspring l a k=50 rest=0.2\n" CHORD
                           "init b=8.5, a=0.2\nequilibrium\ninit none");
    EXPECT_DONE(&kit, "equilibrium");
    for (int i = 0; i < 3; i++) {
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "simulate 0.1");
        EXPECT_NEAR(kit_value(&kit, "b"), 9, 1);
    }
    kit_free(&kit);
}

/* --- driven runs --- */

static void a_driven_chord_follows_its_driver(void)
{
    static const char driven[] = ARMS "driver D b = 8 + 5*t + sin(3*t)\ndriver E a = 2*t\n";
    static const char *const items[] = {"b",        "b'",        "D.effort", "E.effort",
                                        "b at 1.2", "b at 1.23", NULL};
    Kit kit = kit_new();

    compare(driven, "inverse 4 every=0.02", items, 1e-7);
    EXPECT_DONE(&kit, driven);
    EXPECT_DONE(&kit, CHORD "kinematics 4 every=2");
    EXPECT_NEAR(kit_value(&kit, "b"), 28 + sin(12), 1e-10);
    EXPECT_NEAR(kit_value(&kit, "b at 0"), 8, 1e-10);
    EXPECT_DONE(&kit, "simulate 4 every=0.5 rtol=1e-10");
    EXPECT_NEAR(kit_value(&kit, "b"), 28 + sin(12), 1e-9);
    kit_free(&kit);
}

static void a_driven_run_counts_turns_between_rows(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(
        &kit,
        "body A mass=1 inertia=[0.2, 0.3, 0.25]\nuniversal u ground A axes=[z, x] coords=[u1, u2]\n"
        "virtual universal v ground A axes=[z, x] coords=[v1, v2]\n"
        "driver D u1 = 40*t^2\ndriver E u2 = -7*t\n"
        "event e when=v1 > 9*pi do=mark\nkinematics 3 every=1.5");
    EXPECT_NEAR(kit_value(&kit, "v1"), 360, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "v2"), -21, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "v2 at 1.5"), -10.5, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "v2 at 2"), -14, 1e-9);
    EXPECT_DONE(&kit, "show events");
    EXPECT_HOLDS(kit.text, "e  0.84074");
    kit_free(&kit);
}

/* --- about the motion --- */

static void linear_equations_see_the_turn(void)
{
    static const char *const items[] = {"b", "modes.omega(1)", "modes.omega(2)", NULL};

    compare(ARMS "actuator m b torque=-0.1*(b - 5)^3\nspring l a k=50 rest=0.2\n"
                 "init b=8.5, a=0.2\n",
            "equilibrium\nmodes", items, 1e-7);
}

/* --- what is printed --- */

static void what_picks_the_turn_is_said(void)
{
    static const struct {
        const char *show, *has;
    } rows[] = {
        {"show b", "unwrap(y, x, a) is the angle of (x, y) that is nearest to a"},
        {"show b as latex", "\\text{: kept less than half a turn from it}"},
        {"show b as c", "/* b_near: any value less than half a turn from the angle"},
        {"show b as matlab", "% b_near: any value less than half a turn from the angle"},
        {"export c", "b.near  (what angles over full turns lie next to)"},
        {"export c", "const real b_near = y["},
    };
    Kit kit = kit_new();

    EXPECT_DONE(&kit, ARMS EFFORTS CHORD);
    for (int i = 0; i < (int)(sizeof rows / sizeof rows[0]); i++) {
        EXPECT_DONE(&kit, rows[i].show);
        EXPECT_HOLDS(kit.text, rows[i].has);
    }
    EXPECT_DONE(&kit, BRANCH "show k.effort");
    EXPECT(strstr(kit.text, "unwrap") == NULL);
    EXPECT_DONE(&kit, "export c");
    EXPECT(strstr(kit.text, "b.near") == NULL);
    EXPECT_NEAR(kit_value(&kit, "unwrap(1, 0, 20)"), M_PI / 2 + 6 * M_PI, 1e-14);
    kit_free(&kit);
}

int main(void)
{
    RUN(a_chord_turns_as_the_branch_does);
    RUN(every_method_counts_the_same_turns);
    RUN(both_angles_of_a_universal_joint_count_turns);
    RUN(a_screw_that_is_a_chord_counts_turns);
    RUN(an_assembly_is_not_half_a_turn_off);
    RUN(a_driver_that_can_not_be_met_is_told);
    RUN(no_turn_is_lost_in_long_steps);
    RUN(a_resumed_run_goes_on_in_its_turn);
    RUN(a_second_run_finds_the_same_turns);
    RUN(events_see_the_turns);
    RUN(a_new_value_chooses_its_turn);
    RUN(switches_in_the_equations_see_the_turns);
    RUN(phases_of_ideal_switches_see_the_turns);
    RUN(a_given_value_chooses_the_turn);
    RUN(an_equilibrium_keeps_its_turn);
    RUN(another_tree_takes_over_the_turn);
    RUN(a_driven_chord_follows_its_driver);
    RUN(a_driven_run_counts_turns_between_rows);
    RUN(linear_equations_see_the_turn);
    RUN(what_picks_the_turn_is_said);
    return test_end();
}
