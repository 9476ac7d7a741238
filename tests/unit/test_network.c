/* test_network.c: scalar networks in both forms, nonlinear ones, and those that are refused */
#include "session_kit.h"

#include "base/memory.h"
#include "base/text.h"

#include <string.h>

#define MICROPHONE                                                                                 \
    "scene planar\ngravity [0, -9.81]\neA = 5e-5; s0 = 0.05\nbody m5 mass=0.1 inertia=0\n"         \
    "prismatic s ground m5 axis=y\nspring k6 s k=200 d=0.8\n"                                      \
    "vsource E4 a 0 8*(1 - exp(-t/0.1)) + 1.5*sin(12*pi*t)\nresistor R1 a b 10\n"                  \
    "inductor L3 b c 1\ncapacitor C2 c 0 eA/(s0 - s)\n"                                            \
    "actuator F2 s force=0.5*eA/(s0 - s)^2*C2.v^2\n"                                               \
    "init s = -0.1*9.81/200, s' = 0, C2.v = 0, C2.i = 0\n"

/* rows of seed case 5, from an independent integration */
#define MICROPHONE_ROWS                                                                            \
    "expect s ~ -0.00369538254013318 within 7e-11 at 0.1\n"                                        \
    "expect C2.i ~ 0.0430975953997413 within 1e-9 at 0.1\n"                                        \
    "expect C2.i' ~ -2.94120867796656 within 3e-8 at 0.1\n"                                        \
    "expect s ~ -0.00246320910175911 within 7e-11 at 1\n"                                          \
    "expect C2.v ~ 7.08065505597401 within 9e-8 at 1\n"

static void both_forms_of_a_microphone_move_alike(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, MICROPHONE "simulate 1 every=0.005 rtol=1e-10 atol=1e-13\n" MICROPHONE_ROWS);
    EXPECT_DONE(&kit, "tree electrical E4 R1 L3\nset network tree\n"
                      "simulate 1 every=0.005 rtol=1e-10 atol=1e-13\n" MICROPHONE_ROWS);
    EXPECT_DONE(&kit, "show coordinates\n");
    EXPECT_HOLDS(kit.text, "C2.i'");
    kit_free(&kit);
}

/* with the capacitor in the cotree the equation is of second order in its current: theory 8 */
static void the_tree_chooses_the_variables(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, MICROPHONE "tree electrical E4 R1 L3\nshow network\n");
    EXPECT_HOLDS(kit.text, "C2.i''");
    EXPECT_LACKS(kit.text, "C2.v");
    EXPECT_LACKS(kit.text, "L3.i");
    EXPECT_DONE(&kit, "tree electrical E4 R1 C2\nshow network\n");
    EXPECT_LACKS(kit.text, "C2.i");
    EXPECT_LACKS(kit.text, "''");
    EXPECT_HOLDS(kit.text, "L3.i'");
    EXPECT_HOLDS(kit.text, "C2.v'");
    kit_free(&kit);
}

/* what brings no state has a rate by its own relation */
static void rates_of_stored_variables_follow_from_their_relations(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E1 a 0 sin(t)\nresistor R1 a b 2\ninductor L1 b c 3\n"
                      "capacitor C1 c 0 4\ntransformer T1 c 0 e 0 n=2\nresistor R3 e 0 7\n"
                      "tree electrical E1 R1 L1 R3\nset network tree\nsimulate 1 every=0.1\n"
                      "expect C1.v' ~ C1.i/4 within 1e-9\nexpect L1.i' ~ L1.v/3 within 1e-9\n");
    kit_free(&kit);
}

/* two capacitors side by side, both chords: their currents' rates can't be distinguished, and their
 * voltages are one state */
static void rows_without_highest_rates_lower_the_order(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "a = 1/30\nvsource E a 0 sin(3*t)\nresistor R1 a b 10\ncapacitor C1 b 0 1\n"
                      "capacitor C2 b 0 2\ninit C1.v = 0\nset network tree\ntree electrical E R1\n"
                      "simulate 2 rtol=1e-10 atol=1e-13\n");
    /* v' + v/30 = sin(3 t)/30 */
    EXPECT_DONE(&kit, "expect C2.v ~ a*(a*sin(6) - 3*cos(6) + 3*exp(-2*a))/(a^2 + 9) "
                      "within 1e-10\nexpect C2.i ~ 2*C1.i within 1e-12\n");
    kit_free(&kit);
}

/* a mesh of resistors alone, by Kirchhoff's laws solved by hand for the bridge in balance */
static void a_bridge_in_balance_carries_no_current(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 10\nresistor Ra a b 10\nresistor Rb a c 20\n"
                      "resistor Rc b c 30\nresistor Rd b 0 40\nresistor Re c 0 80\nsimulate 1\n"
                      "expect Rc.i ~ 0 within 1e-14\nexpect E.i ~ -(0.2 + 0.1) within 1e-14\n");
    kit_free(&kit);
}

/* i = Is (exp((E - R i)/Vt) - 1): R i = Vt W(R Is/Vt exp((E + R Is)/Vt)) - R Is, Corless and others
 * 1996; the number is from an independent evaluation of W */
static void a_steep_characteristic_is_solved(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 5\nresistor R a b 1000\n"
                      "isource D b 0 1e-14*(exp(D.v/0.025) - 1)\nsimulate 1\n"
                      "expect D.i ~ 1e-14*(exp((5 - 1000*D.i)/0.025) - 1) within 1e-12\n"
                      "expect 1000*D.i ~ 4.330149050323344 within 1e-9\n");
    kit_free(&kit);
}

/* sin(pi k/(N + 1)) decays as a whole: v_k' = (v_(k-1) - 2 v_k + v_(k+1))/(R C) */
static void long_stiff_ladder(Text *lines, int sections)
{
    text_addf(lines, "vsource E n0 0 0\n");
    for (int k = 1; k <= sections; k++)
        text_addf(lines,
                  "resistor R%d n%d n%d 10\ncapacitor C%d n%d 0 1e-9\n"
                  "init C%d.v = sin(pi*%d/%d)\n",
                  k, k - 1, k, k, k, k, k, sections + 1);
    text_addf(lines, "resistor RL n%d 0 10\n", sections);
}

static void large_stiff_networks_are_solved_sparse(void)
{
    Kit kit = kit_new();
    Text lines = {0};

    long_stiff_ladder(&lines, 120);
    text_addf(&lines, "d = exp(-2e-5/1e-8*4*sin(pi/242)^2)\n"
                      "simulate 2e-5 method=ida rtol=1e-7 atol=1e-10\n"
                      "expect C60.v ~ sin(pi*60/121)*d within 1e-6\n"
                      "expect C7.v ~ sin(pi*7/121)*d within 1e-6\n"
                      "expect energy.potential ~ 0.5e-9*60.5*d^2 within 1e-14\n"
                      "set E.value = 1\nsimulate 4e-4 rtol=1e-7\n");
    EXPECT_DONE(&kit, lines.at);
    EXPECT_HOLDS(kit.text, "ida");
    /* an even fall of voltage, once all has settled */
    EXPECT_DONE(&kit, "expect C60.v ~ 61/121 within 1e-6\nexpect E.i ~ -1/1210 within 1e-8\n");
    text_free(&lines);
    kit_free(&kit);
}

/* v = r i^2 discharges C: sqrt(v) falls by 1/(2 C sqrt(r)) a second */
static void algebraic_unknowns_are_solved_with_the_states(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "capacitor C a 0 1\ninit C.v = 4\nresistor R a 0 0.25*(abs(R.i) + 1e-9)\n"
                      "simulate 1 method=ida rtol=1e-9 atol=1e-12\n"
                      "expect C.v ~ 1 within 1e-7\nexpect R.i ~ 2 within 1e-7\n");
    kit_free(&kit);
}

/* a force sensor drives a force: both are solved together */
static void a_network_may_read_accelerations(void)
{
    Kit kit = kit_new();

    /* as if the mass were 1.95 kg */
    EXPECT_DONE(&kit, "m = 2 - 0.05; w = sqrt(100/m - 1/(4*m^2)); b = 1/(2*m); s1 = -2*9.81/100\n"
                      "scene planar\ngravity [0, -9.81]\nbody m1 mass=2 inertia=0\n"
                      "prismatic s ground m1 axis=y\nspring k s k=100 d=1\n"
                      "vsource S a 0 m1.ay\nresistor R a 0 10\nactuator F s force=0.5*R.i\n"
                      "init s = 0.1, s' = 0\nsimulate 1 rtol=1e-10 atol=1e-12\n"
                      "expect 2*s'' ~ -2*9.81 - 100*s - s' + 0.05*s'' within 1e-10\n"
                      "expect s ~ s1 + exp(-b)*((0.1 - s1)*cos(w) + b*(0.1 - s1)/w*sin(w)) "
                      "within 1e-9\n");
    kit_free(&kit);
}

/* m a = 3 - 2 a moves as if the mass were 2 kg more: p = t^2/2 of 1 kg */
static void laws_may_hold_accelerations(void)
{
    static const char *const scenes[] = {"scene planar\nbody m mass=1 inertia=0.1\n",
                                         "scene spatial\nbody m mass=1 inertia=[0.1, 0.1, 0.1]\n"};
    static const char *const laws[] = {"force F m [-2*p'' + 3, 0%s]\n",
                                       "force F m [3 - m.x'' - p'', 0%s]\n",
                                       "output a = -2*p''\nforce F m [a + 3, 0%s]\n",
                                       "arm e ground [-1, 0%s]\nactuator F e m force=3 - 2*p''\n"};
    static const char *const trees[] = {"joint", "absolute"};

    for (int i = 0; i < COUNT(scenes) * COUNT(laws) * COUNT(trees); i++) {
        const int spatial = i % COUNT(scenes);
        const bool joint = i / 2 / COUNT(laws) == 0;
        char law[120], text[400];
        Kit kit;

        /* off the joint, the line doesn't push along what the law reads */
        if (!joint && i / 2 % COUNT(laws) == COUNT(laws) - 1)
            continue;
        kit = kit_new();
        (void)snprintf(law, sizeof law, laws[i / 2 % COUNT(laws)], spatial ? ", 0" : "");
        (void)snprintf(text, sizeof text,
                       "%sprismatic p ground m axis=x\n%stree %s\nshow equations\n",
                       scenes[spatial], law, trees[!joint]);
        EXPECT_DONE(&kit, text);
        EXPECT_HOLDS(kit.text, joint ? "p'' = 3" : "3*m.x''");
        EXPECT_DONE(&kit, "simulate 1 rtol=1e-9\nexpect p ~ 0.5 within 1e-8\n"
                          "expect p'' ~ 1 within 1e-9\nexpect p.fx ~ 0 within 1e-9\n");
        kit_free(&kit);
    }
}

#define TWO_SLIDERS                                                                                \
    "scene planar\nbody m mass=1 inertia=0.1\nbody n mass=1 inertia=0.1\n"                         \
    "prismatic p ground m axis=x\nprismatic h ground n axis=x\nforce G n [cos(t), 0]\n"

static void laws_that_are_no_inertia_are_refused(void)
{
    static const char *const cases[][2] = {
        {"force F m [3 - 2*p''^2, 0]\n", "F pushes with more than a multiple of an acceleration"},
        {"force F m [3 - h'', 0]\n",
         "F passes the acceleration of one of p' and h' on to the other one way only"},
        {"force F m [3 - c*h'', 0]\nforce H n [-d*p'', 0]\n",
         "F passes the acceleration of one of p' and h' on to the other one way only"},
        {"force F m [0.1*p.fy, 0]\n", "the law of F reads what follows from all forces"},
    };

    for (int i = 0; i < COUNT(cases); i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "c = 0.2\nd = 0.2\n" TWO_SLIDERS);
        EXPECT_DONE(&kit, cases[i][0]);
        EXPECT_FAILS(&kit, "simulate 1\n", cases[i][1]);
        kit_free(&kit);
    }
}

/* the way out that is told */
static void a_network_hands_an_acceleration_on_one_way(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, TWO_SLIDERS "vsource S a 0 n.ax\nresistor R a 0 1\n"
                                  "force F m [3 - 0.5*R.i, 0]\nsimulate 1 rtol=1e-9\n"
                                  "expect p ~ 1.5 - 0.5*(1 - cos(1)) within 1e-8\n");
    kit_free(&kit);
}

/* the op-amp holds the capacitor at the source: out = -R C E', and the start follows E(0) */
static void an_equation_without_unknowns_is_differentiated(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 sin(3*t) + 0.5\ncapacitor C a n 1 mF\nopamp U 0 n out\n"
                      "resistor R n out 1000\nsimulate 1\nexpect C.v ~ 0.5 within 1e-12 at 0\n"
                      "expect C.v ~ sin(3) + 0.5 within 1e-8\n"
                      "expect U.out.v ~ -3*cos(3) within 1e-8\n");
    kit_free(&kit);
}

/* nothing said: what is a state in state form is zero, whatever the tree's own unknowns are */
static void a_start_at_rest_is_that_of_the_states(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 5\nresistor R a b 2\ncapacitor C b 0 0.25\n"
                      "tree electrical E R\nset network tree\nsimulate 1\n"
                      "expect C.v ~ 0 within 1e-12 at 0\nexpect C.i ~ 2.5 within 1e-12 at 0\n"
                      "expect C.v ~ 5*(1 - exp(-2)) within 1e-7\n");
    kit_free(&kit);
}

/* v' = u, u = -K v held for T: v falls by 1 - K T each period, along a line */
static void a_sampled_gain_holds_its_output(void)
{
    static const char *const methods[] = {"dop853", "bdf", "ida", "radau"};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vccs I 0 a y 0 gain=1\ncapacitor C a 0 1\n"
                      "gain G y 0 of=-C.v k=2 period=0.1\ninit C.v = 1\n");
    for (size_t i = 0; i < sizeof methods / sizeof methods[0]; i++) {
        char line[80];

        (void)snprintf(line, sizeof line, "simulate 1 every=0.05 method=%s\n", methods[i]);
        EXPECT_DONE(&kit, line);
        EXPECT_DONE(&kit, "expect C.v ~ 0.8^10 within 1e-9\nexpect C.v ~ 0.8^3 within 1e-9 at 0.3\n"
                          "expect G.v ~ -2*0.8^3 within 1e-9 at 0.35\n"
                          "expect C.v ~ 0.9*0.8^3 within 1e-9 at 0.35\n");
    }
    EXPECT_DONE(&kit, "resume 1\nexpect C.v ~ 0.8^20 within 1e-9\n");
    EXPECT_FAILS(&kit, "p = 0; set G.period = p\n", "period of G is zero");
    EXPECT_DONE(&kit, "p = 0.1; set G.period = p\n");
    EXPECT_FAILS(&kit, "p = -1\n", "period of G is negative");
    EXPECT_DONE(&kit, "simulate 1\nexpect C.v ~ 0.8^10 within 1e-9\n");
    kit_free(&kit);
}

/* e = 1 - v, u = 2 e + I, I and v grow by T e and T u: 50 steps by hand of a machine */
static void a_sampled_controller_counts_in_periods(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource R r 0 1\nvccs I 0 a y 0 gain=1\ncapacitor C a 0 1\n"
                      "pid P y 0 ref=R.v of=C.v Kp=2 Ki=1 period=0.1\ninit C.v = 0\nsimulate 5\n"
                      "expect C.v ~ 1.0234783092777917 within 1e-9\n"
                      "expect P.integral ~ 0.028632084485111738 within 1e-9\n");
    kit_free(&kit);
}

/* R.i = L'' : i' (L1 + L2) + R i = E, with the second coil's current (1 + k) times the first's */
static void a_controlled_current_among_coils_is_integrated(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 1\nresistor R a b 2\ninductor L1 b c 0.5\n"
                      "cccs G 0 c of=R.i gain=3\ninductor L2 c 0 0.25\nsimulate 1\n"
                      "expect R.i ~ 0.5*(1 - exp(-2/1.5)) within 1e-8\n"
                      "expect L2.i ~ 4*R.i within 1e-10\n");
    kit_free(&kit);
}

/* the last row stands at the end, also where a source switches there */
static void a_switch_at_the_end_keeps_the_last_row(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit,
                "vsource E a 0 if(sin(2*pi*5e3*t) > 0, 10, 0)\nresistor R a b 10\n"
                "capacitor C b 0 10 uF\nsimulate 0.02\nexpect t ~ 0.02 within 0\n"
                /* mean of a square wave, less half the ripple: C v' = -v/R for half a period */
                "x = exp(-1)\n");
    EXPECT_DONE(&kit, "simulate 0.02\nexpect C.v ~ 10*x*(1 - x)/(1 - x^2) within 1e-6\n");
    kit_free(&kit);
}

static void a_step_across_capacitors_is_refused(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 step(t - 0.1)\ncapacitor C1 a b 1 uF\n"
                      "capacitor C2 b 0 1 uF\nresistor R b 0 1\n");
    EXPECT_FAILS(&kit, "simulate 1\n", "a source that jumps would drive an impulse through C");
    EXPECT_DONE(&kit, "set E.value = pulse(t, 0, 1, 0.1, 0.01, 0.01, 0.1, 0.3)\nsimulate 1\n");
    kit_free(&kit);
}

static void a_tree_that_needs_a_jump_differentiated_is_refused(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 step(t - 0.1)\nresistor R a b 1\ninductor L b c 1\n"
                      "capacitor C c 0 1\ntree electrical E R L\nsimulate 1\n");
    EXPECT_FAILS(&kit, "set network tree\n",
                 "in this tree C needs the derivative of a source that jumps");
    EXPECT_DONE(&kit, "set E.value = sin(t)\nset network tree\nsimulate 1\n"
                      "set E.value = step(t - 0.1)\n");
    EXPECT_FAILS(&kit, "simulate 1\n",
                 "in this tree C needs the derivative of a source that jumps");
    EXPECT_FAILS(&kit, "set network mesh\n", "network is state or tree");
    kit_free(&kit);
}

/* D.i follows from D.v, and that from the law of D alone */
static void a_derivative_that_is_refused_is_the_one_asked_for(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource V a 0 5*sin(t)\nresistor R a b 1\ndiode D b 0 Is=1e-12\n"
                      "resistor Q b 0 5\nsimulate 1\n");
    EXPECT_FAILS(&kit, "print D.i'\n",
                 "the derivative of D.i is not among the network's equations");
    EXPECT_FAILS(&kit, "print 2*R.i + Q.v'\n", "the derivative of Q.v is not among");
    kit_free(&kit);
}

static void sources_against_each_other_are_refused(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 10\nvsource F a 0 5\nresistor R a 0 1\n");
    EXPECT_FAILS(&kit, "simulate 1\n", "the sources E F form a circuit");
    EXPECT_DONE(&kit, "clear\nisource I 0 a 1\nisource J a 0 2\n");
    EXPECT_FAILS(&kit, "simulate 1\n", "nothing but sources joins two parts of the network: I J");
    kit_free(&kit);
}

/* V = R i + L i' + K h', i from the torque: the third derivative of the motion counts */
static void an_inverse_run_wants_a_smooth_driver(void)
{
    static const char model[] = "scene planar\nbody b mass=1 inertia=0.1\nrevolute h ground b\n"
                                "vsource V a 0 0\nmotor M h a 0 R=1 L=0.1 Kt=0.5\n";
    Kit kit = kit_new();

    EXPECT_DONE(&kit, model);
    EXPECT_DONE(&kit, "driver D h = ramp(t - 0.5)^2 by=V\n");
    EXPECT_FAILS(&kit, "inverse 1\n", "the acceleration that D asks for jumps");
    EXPECT_DONE(&kit, "clear\n");
    EXPECT_DONE(&kit, model);
    EXPECT_DONE(&kit, "driver D h = ramp(t - 0.5)^3 by=V\ninverse 1\n"
                      "expect V.v ~ 0.6 + 0.12 + 0.375 within 1e-9\n");
    kit_free(&kit);
}

/* a run in steps cut at every kink of a diode, against one by another method */
static void steps_are_cut_at_kinks_of_diodes(void)
{
    static const struct {
        const char *network, *method;
        double instants[3];
    } runs[] = {{"scene planar\n"
                 "vsource E s 0 5*sin(700*t)\n"
                 "resistor RS s n1 5\n"
                 "diode DT2 n1 n2 Ron=0.1 Roff=1e5\n"
                 "diode DT3 n3 n2 Ron=0.1 Roff=1e5\n"
                 "resistor R0 0 n1 50\n"
                 "resistor R1 n3 n2 50\n"
                 "resistor R2 n1 n2 200\n"
                 "capacitor C0 n1 n2 10 uF\n"
                 "diode D0 0 n1 Ron=0.1 Roff=1e5\n"
                 "switch S 0 n3 when=sin(300*t)>0 Ron=0.1 Roff=1e5\n"
                 "init C0.v=0\n",
                 "method=radau",
                 {0.0314, 0.0315, 0.05}},
                {"scene planar\n"
                 "vsource E s 0 20*sin(100*t)\n"
                 "resistor RS s n1 5\n"
                 "resistor RT2 n1 n2 50\n"
                 "diode DT3 n1 n3 Ron=0.01 Roff=1e6\n"
                 "resistor R0 n3 n2 50\n"
                 "resistor R1 n3 n1 1000\n"
                 "resistor R2 n1 n2 50\n"
                 "capacitor C0 0 n3 1 uF\n"
                 "capacitor C1 0 n1 100 uF\n"
                 "inductor L0 n3 n2 1 mH\n"
                 "diode D0 n1 n3 Ron=0.01 Roff=1e6\n"
                 "diode D1 n3 n2 Ron=0.01 Roff=1e6\n"
                 "diode D2 n1 n3 Ron=0.01 Roff=1e6\n"
                 "switch S n1 n3 when=sin(300*t)>0 Ron=0.01 Roff=1e6\n"
                 "init C0.v=0, C1.v=0, L0.i=0\n",
                 "",
                 {0.0162, 0.01622, 0.05}}};

    for (size_t i = 0; i < sizeof runs / sizeof runs[0]; i++) {
        Kit kit = kit_new();
        double values[3];
        char line[80];

        EXPECT_DONE(&kit, runs[i].network);
        (void)snprintf(line, sizeof line, "simulate 0.05 every=0.00001 %s\n", runs[i].method);
        EXPECT_DONE(&kit, line);
        for (int k = 0; k < 3; k++) {
            (void)snprintf(line, sizeof line, "C0.v at %.5f", runs[i].instants[k]);
            values[k] = kit_value(&kit, line);
        }
        EXPECT_DONE(&kit, "simulate 0.05 every=0.00001 method=bdf rtol=1e-9 atol=1e-9\n");
        for (int k = 0; k < 3; k++) {
            (void)snprintf(line, sizeof line, "expect C0.v ~ %.9g within 1e-5 at %.5f\n", values[k],
                           runs[i].instants[k]);
            EXPECT_DONE(&kit, line);
        }
        kit_free(&kit);
    }
}

int main(void)
{
    RUN(both_forms_of_a_microphone_move_alike);
    RUN(the_tree_chooses_the_variables);
    RUN(rates_of_stored_variables_follow_from_their_relations);
    RUN(rows_without_highest_rates_lower_the_order);
    RUN(a_bridge_in_balance_carries_no_current);
    RUN(a_steep_characteristic_is_solved);
    RUN(large_stiff_networks_are_solved_sparse);
    RUN(algebraic_unknowns_are_solved_with_the_states);
    RUN(a_network_may_read_accelerations);
    RUN(laws_may_hold_accelerations);
    RUN(laws_that_are_no_inertia_are_refused);
    RUN(a_network_hands_an_acceleration_on_one_way);
    RUN(an_equation_without_unknowns_is_differentiated);
    RUN(a_start_at_rest_is_that_of_the_states);
    RUN(a_sampled_gain_holds_its_output);
    RUN(a_sampled_controller_counts_in_periods);
    RUN(a_controlled_current_among_coils_is_integrated);
    RUN(a_switch_at_the_end_keeps_the_last_row);
    RUN(a_step_across_capacitors_is_refused);
    RUN(a_tree_that_needs_a_jump_differentiated_is_refused);
    RUN(a_derivative_that_is_refused_is_the_one_asked_for);
    RUN(sources_against_each_other_are_refused);
    RUN(an_inverse_run_wants_a_smooth_driver);
    RUN(steps_are_cut_at_kinks_of_diodes);
    return test_end();
}
