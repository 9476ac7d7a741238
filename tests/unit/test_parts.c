/* test_parts.c: electrical components against closed forms, and their edges in trees */
#include "session_kit.h"
#include "test_model.h"

#include <math.h>

#define RUN_FOR(seconds) "simulate " #seconds " rtol=1e-10 atol=1e-12\n"

static void expect_value(const char *model, const char *what, double wanted, double relative)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, model);
    EXPECT_NEAR(kit_value(&kit, what), wanted, relative * (fabs(wanted) + 1e-9));
    kit_free(&kit);
}

/* --- coupling --- */

/* two equal windings: sum and difference of the currents see L + M and L - M */
static double coupled_current(double t, double M, int sign)
{
    double sum = 1 - exp(-10 * t / (0.2 + M));
    double difference = 1 - exp(-10 * t / (0.2 - M));

    return (sum + sign * difference) / 2 * 5 / 10;
}

#define TWO_WINDINGS                                                                               \
    "vsource V1 a 0 5\nresistor R1 a b 10\ninductor L1 b 0 0.2\n"                                  \
    "inductor L2 c 0 0.2\nresistor R2 c 0 10\ninit L1.i = 0, L2.i = 0\n"

static void coupled_windings_share_their_flux(void)
{
    static const char *const said[] = {"coupling K1 L1 L2 k=0.9\n", "coupling K1 L1 L2 M=0.18\n",
                                       "m = 0.9\ncoupling K1 L1 L2 k=m\n"};
    double i1 = coupled_current(0.02, 0.18, 1);
    double i2 = coupled_current(0.02, 0.18, -1);

    for (int k = 0; k < 3; k++) {
        char model[400];
        Kit kit = kit_new();

        (void)snprintf(model, sizeof model, "%s%s%s", TWO_WINDINGS, said[k], RUN_FOR(0.02));
        EXPECT_DONE(&kit, model);
        EXPECT_NEAR(kit_value(&kit, "L1.i"), i1, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "L2.i"), i2, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "L1.flux"), 0.2 * i1 + 0.18 * i2, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "energy.potential"), 0.1 * (i1 * i1 + i2 * i2) + 0.18 * i1 * i2,
                    1e-9);
        kit_free(&kit);
    }
}

/* turned round, a winding takes the other sign */
/* M beyond sqrt(L1*L2), three windings of which each pair could be but not all, and values that
 * come to that later, are refused and change nothing */
static void couplings_that_no_coils_have_are_refused(void)
{
    static const struct {
        const char *before, *line, *message;
    } wrong[] = {
        {"", "coupling K1 L1 L2 M=0.21", "L1 and L2 can't be coupled by M = 0.21 H"},
        {"", "coupling K1 L1 L2 M=-0.5", "L1 and L2 can't be coupled by M = -0.5 H"},
        {"m = 0.3\n", "coupling K1 L1 L2 M=m", "sqrt(L1*L2) is 0.2 H"},
        {"m = 0.1\ncoupling K1 L1 L2 M=m\n", "m = 0.3", "m = 0.3 is refused: L1 and L2"},
        {"coupling K1 L1 L2 M=0.1\n", "set L1.L = 0.05", "can't be coupled by M = 0.1 H"},
        {"coupling K1 L1 L2 k=0.6\ncoupling K2 L2 L3 k=0.6\n", "coupling K3 L1 L3 k=-0.9",
         "L1, L2 and L3 can't be coupled like this"},
        {"coupling K1 L1 L2 k=0.7\n", "coupling K2 L2 L1 k=0.7", "L1 and L2 can't be coupled"},
    };

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "inductor L1 a 0 0.4 H\ninductor L2 c 0 0.1 H\ninductor L3 d 0 1 H\n");
        EXPECT_DONE(&kit, wrong[i].before);
        EXPECT_FAILS(&kit, wrong[i].line, wrong[i].message);
        EXPECT_HOLDS(kit.error.hint, "M");
        EXPECT_DONE(&kit, "coupling K9 L1 L3 M=0.01"); /* and nothing has changed */
        kit_free(&kit);
    }
}

/* Each pair of three close windings could be, and so can all three, but not two pairs alone: that
 * is told while the third is missing, and refused where equations are asked for. */
static void close_coils_are_coupled_one_by_one(void)
{
    static const char *const orders[][3] = {
        {"coupling K1 L1 L2 k=0.95\n", "coupling K2 L2 L3 k=0.96\n", "coupling K3 L1 L3 k=0.97\n"},
        {"coupling K3 L1 L3 k=0.97\n", "coupling K1 L1 L2 k=0.95\n", "coupling K2 L2 L3 k=0.96\n"},
        {"coupling K2 L2 L3 k=0.96\n", "coupling K3 L1 L3 k=0.97\n", "coupling K1 L1 L2 k=0.95\n"}};
    /* v = M i' across all, one of them driven: the first current's rate, by Cramer's rule */
    const double k12 = 0.95, k23 = 0.96, k13 = 0.97,
                 det = 1 + 2 * k12 * k23 * k13 - k12 * k12 - k23 * k23 - k13 * k13;

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "vsource V a 0 3\ninductor L1 a 0 0.4 H\ninductor L2 c 0 0.1 H\n"
                          "inductor L3 d 0 1 H\nresistor R2 c 0 1e-9\nresistor R3 d 0 1e-9\n");
        EXPECT_DONE(&kit, orders[i][0]);
        EXPECT_DONE(&kit, orders[i][1]);
        EXPECT_HOLDS(ct_remarks(kit.session), "waits for couplings");
        EXPECT_FAILS(&kit, "simulate 0.1", "L1, L2 and L3 can't be coupled like this");
        if (i < 2)
            EXPECT_FAILS(&kit, "coupling K9 L2 L1 k=0.1",
                         "L1 and L2 can't be coupled by M = 0.21 H");
        EXPECT_DONE(&kit, orders[i][2]);
        EXPECT_LACKS(ct_remarks(kit.session), "waits");
        EXPECT_DONE(&kit, "init L1.i = 0, L2.i = 0, L3.i = 0\nassemble");
        EXPECT_NEAR(kit_value(&kit, "L1.i'"), 3 * (1 - k23 * k23) / det / 0.4, 1e-6);
        EXPECT_FAILS(&kit, "set K3.k = -0.5", "can't be coupled like this");
        kit_free(&kit);
    }
}

static void negative_coupling_turns_a_winding_round(void)
{
    expect_value(TWO_WINDINGS "coupling K1 L1 L2 k=-0.9\n" RUN_FOR(0.02), "L2.i",
                 -coupled_current(0.02, 0.18, -1), 1e-8);
}

/* an inductor in a cutset of inductors alone: L1 + L2 + 2 M in series */
static void coupled_inductors_in_series_add_both_ways(void)
{
    expect_value("vsource V1 a 0 5\nresistor R1 a b 10\ninductor L1 b c 0.2\ninductor L2 c 0 0.1\n"
                 "coupling K1 L1 L2 M=0.05\ninit L1.i = 0\n" RUN_FOR(0.02),
                 "L2.i", 0.5 * (1 - exp(-10 * 0.02 / 0.4)), 1e-8);
}

/* --- controlled sources --- */

static void controlled_sources_follow_at_any_load(void)
{
    const char *model = "vsource V1 a 0 3\nresistor R1 a b 1000\nresistor R2 b 0 2000\n"
                        "vcvs E1 c 0 a b gain=7\nresistor R3 c 0 10\n"
                        "vccs G1 0 d b 0 gain=0.02\nresistor R4 d 0 50\n"
                        "ccvs H1 e 0 of=R1.i gain=500\nresistor R5 e 0 20\n"
                        "cccs F1 0 f of=R1.i gain=-30\nresistor R6 f 0 40\n" RUN_FOR(1);
    Kit kit = kit_new();

    EXPECT_DONE(&kit, model);
    EXPECT_NEAR(kit_value(&kit, "E1.v"), 7.0, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "R3.i"), 0.7, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "d.v"), 0.02 * 2 * 50, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "H1.v"), 0.5, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "f.v"), -30 * 1e-3 * 40, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "R1.i"), 1e-3, 1e-12); /* nothing loads it */
    kit_free(&kit);
}

/* its own voltage controls it: a conductance, so that C discharges through 1/g */
static void source_controlled_by_its_own_voltage_is_a_conductance(void)
{
    expect_value("capacitor C1 a 0 1e-3\nvccs G1 a 0 a 0 gain=0.5\ninit C1.v = 4\n" RUN_FOR(0.003),
                 "C1.v", 4 * exp(-1.5), 1e-8);
}

/* --- op-amp --- */

static void opamp_with_feedback_makes_its_inputs_equal(void)
{
    expect_value("vsource V1 a 0 0.3\nresistor R1 a m 1000\nresistor R2 m out 4700\n"
                 "opamp U1 0 m out\n" RUN_FOR(1),
                 "out.v", -0.3 * 4.7, 1e-12);
    expect_value("vsource V1 a 0 0.3\nresistor R1 m 0 1000\nresistor R2 m out 4700\n"
                 "opamp U1 a m out\nresistor R3 out 0 10\n" RUN_FOR(1),
                 "U1.out.i", -(0.3 * 5.7 / 10 + 0.3 / 1000), 1e-12);
    expect_value("vsource V1 a 0 0.3\nopamp U1 a out out\nresistor R3 out 0 10\n" RUN_FOR(1),
                 "R3.i", 0.03, 1e-12);
}

static void opamp_integrates(void)
{
    expect_value("vsource V1 a 0 sin(10*t)\nresistor R1 a m 10 kohm\ncapacitor C1 m out 10 uF\n"
                 "opamp U1 0 m out\ninit C1.v = 0\n" RUN_FOR(1),
                 "U1.out.v", -(1 - cos(10)) / 10 / 0.1, 1e-8);
}

/* the source fixes the capacitor's voltage: no state is left */
static void opamp_differentiates(void)
{
    expect_value("vsource V1 a 0 sin(t)\ncapacitor C1 a m 1 uF\nresistor R1 m out 1 Mohm\n"
                 "opamp U1 0 m out\n" RUN_FOR(1),
                 "out.v", -cos(1), 1e-8);
}

/* unity-gain low pass of second order (Sallen and Key 1955): w0 = 1/(R C), zeta = 1 */
static void opamp_filters(void)
{
    expect_value("vsource V1 a 0 1\nresistor R1 a b 1 kohm\nresistor R2 b p 1 kohm\n"
                 "capacitor C1 b out 1 uF\ncapacitor C2 p 0 1 uF\nopamp U1 p out out\n"
                 "init C1.v = 0, C2.v = 0\n" RUN_FOR(0.002),
                 "out.v", 1 - 3 * exp(-2), 1e-8);
}

/* --- two-ports --- */

#define TRANSFORMER "vsource V1 a 0 10\nresistor R1 a b 5\ntransformer T1 b 0 c 0 n=4\n"

static void transformer_shows_its_load_times_n_squared(void)
{
    const char *model = TRANSFORMER "resistor R2 c 0 2\n" RUN_FOR(1);

    expect_value(model, "T1.p.i", 10.0 / 37, 1e-12);
    expect_value(model, "T1.s.i", -40.0 / 37, 1e-12);
    expect_value(model, "T1.s.v", 80.0 / 37, 1e-12);
    expect_value(model, "T1.p.power + T1.s.power", 0, 1e-3);
    expect_value(TRANSFORMER "capacitor C1 c 0 1e-3\ninit C1.v = 0\n" RUN_FOR(0.0005), "C1.v",
                 2.5 * (1 - exp(-0.0005 / (5 * 1e-3 / 16))), 1e-8);
}

/* an inductor behind it is n^2 times as large, with a resistor in front and without */
static void transformer_feeds_an_inductor(void)
{
    expect_value(TRANSFORMER "inductor L1 c 0 0.02\ninit L1.i = 0\n" RUN_FOR(0.05), "T1.p.i",
                 2 * (1 - exp(-5 * 0.05 / (16 * 0.02))), 1e-8);
    expect_value("vsource V1 a 0 10\ntransformer T1 a 0 c 0 n=4\ninductor L1 c 0 0.02\n"
                 "init L1.i = 0\n" RUN_FOR(0.05),
                 "V1.i", -10.0 / 16 * 0.05 / 0.02, 1e-8);
}

/* the source fixes the capacitor's voltage through it: i = C E'/n^2 */
static void transformer_feeds_a_capacitor_from_an_ideal_source(void)
{
    expect_value(
        "vsource V1 a 0 sin(10*t)\ntransformer T1 a 0 c 0 n=4\ncapacitor C1 c 0 0.02\n" RUN_FOR(
            0.5),
        "V1.i", -0.02 * 10 * cos(5) / 16, 1e-8);
}

static void gyrator_turns_a_capacitor_into_an_inductor(void)
{
    const char *model = "vsource V1 a 0 1\nresistor R1 a b 10\ngyrator G1 b 0 c 0 r=100\n";
    char text[300];

    (void)snprintf(text, sizeof text, "%s%s", model,
                   "capacitor C1 c 0 10 uF\ninit C1.v = 0\n" RUN_FOR(0.02));
    expect_value(text, "G1.p.i", 0.1 * (1 - exp(-10 * 0.02 / 0.1)), 1e-8);
    (void)snprintf(text, sizeof text, "%s%s", model,
                   "inductor L1 c 0 0.1\ninit L1.i = 0\n" RUN_FOR(0.0002));
    expect_value(text, "G1.p.v", 1 - exp(-0.0002 / (10 * 1e-5)), 1e-8);
    expect_value(text, "G1.p.power + G1.s.power", 0, 1e-3);
}

static void potentiometer_divides_under_load(void)
{
    const double R = 1000, load = 300;
    static const struct {
        const char *text;
        double at;
    } table[] = {{"0.25", 0.25}, {"0.25*t", 0.25}, {"t", 1}, {"1 - t", 0}, {"0", 0}, {"1", 1}};

    for (int k = 0; k < 6; k++) {
        double low = R * (1 - table[k].at) * load / (R * (1 - table[k].at) + load);
        double wanted = 8 * low / (R * table[k].at + low);
        char model[300];

        (void)snprintf(model, sizeof model,
                       "vsource V1 a 0 8\npotentiometer P1 a w 0 R=1000 at=%s\n"
                       "resistor R1 w 0 300\n" RUN_FOR(1),
                       table[k].text);
        expect_value(model, "w.v", wanted, 1e-9);
    }
}

/* The track is a resistance wherever the wiper stands: the capacitor across it is a state. */
static void capacitor_empties_over_a_moving_wiper(void)
{
    const char *model = "scene planar\nbody b mass=1 inertia=0.1\nrevolute h ground b\n"
                        "capacitor C a 0 0.1\npotentiometer P a w 0 R=16 at=0.5 + 0.4*sin(h)\n"
                        "resistor R a 0 5*(1 + h - t)\ninit h = 0, h' = 1, C.v = 3\n" RUN_FOR(1);
    const double v = 3 * exp(-21 / (0.1 * 16 * 5));

    expect_value(model, "C.v", v, 1e-7);
    expect_value(model, "w.v", v * (0.5 - 0.4 * sin(1)), 1e-7);
}

/* --- diode and switch --- */

/* E = v + R Is (exp(v/Vt) - 1), by bisection */
static double diode_voltage(double E, double R, double Is)
{
    double Vt = 1.380649e-23 * 300.15 / 1.602176634e-19;
    double low = -1000;
    double high = 1;

    for (int k = 0; k < 200; k++) {
        double v = (low + high) / 2;

        if (v + R * (Is * expm1(v / Vt) + 1e-12 * v) < E)
            low = v;
        else
            high = v;
    }
    return low;
}

static void exponential_diode_meets_its_load_line(void)
{
    static const double sources[] = {5, 0.1, 300, -5, -300};

    for (int k = 0; k < 5; k++) {
        char model[200];

        (void)snprintf(model, sizeof model,
                       "vsource V1 a 0 %g\nresistor R1 a b 100\ndiode D1 b 0 Is=1e-14\n" RUN_FOR(1),
                       sources[k]);
        expect_value(model, "D1.v", diode_voltage(sources[k], 100, 1e-14), 1e-10);
    }
}

static void diode_of_straight_lines_follows_them(void)
{
    static const struct {
        const char *diode;
        double source, current;
    } table[] = {
        {"Ron=2 Roff=1e4 Vf=0.7", 5, (4.3 + 2 * 0.7e-4) / 12},
        {"Ron=2 Roff=1e4 Vf=0.7", -5, -5 / 10010.0},
        {"Ron=2 Vf=0.7", 5, 4.3 / 12},
        {"Ron=2", -5, 0},
        {"", 5, 0.5},
        {"", -5, 0},
        {"Vf=0.7", 5, 0.43},
        {"Vf=0.7", 0.6, 0},
    };

    for (int k = 0; k < 8; k++) {
        char model[200];

        (void)snprintf(model, sizeof model,
                       "vsource V1 a 0 %g\nresistor R1 a b 10\ndiode D1 b 0 %s\n" RUN_FOR(1),
                       table[k].source, table[k].diode);
        expect_value(model, "D1.i", table[k].current, 1e-10);
    }
}

/* peak detector with hardly any resistance, then discharge: the diode opens where the sine falls
 * faster than exp(-t/RC) */
static void diode_opens_where_its_current_ends(void)
{
    const double w = 100, tau = 0.05;
    double opens = (M_PI - atan(w * tau)) / w; /* tan(w t) = -w tau */

    expect_value("vsource V1 a 0 10*sin(100*t)\ndiode D1 a b Ron=0.01\ncapacitor C1 b 0 50 uF\n"
                 "resistor R1 b 0 1000\ninit C1.v = 0\nsimulate 0.03 rtol=1e-8\n",
                 "C1.v", 10 * sin(w * opens) * exp(-(0.03 - opens) / tau), 1e-5);
}

#define CHARGING "vsource V1 a 0 10\nresistor R1 b c 100\ncapacitor C1 c 0 10 uF\n"

static void switch_opens_and_closes_by_time(void)
{
    double charged = 10 * (1 - exp(-2));

    expect_value(CHARGING "switch S1 a b when=t < 2 [ms]\nresistor R2 c 0 1e6\n"
                          "init C1.v = 0\n" RUN_FOR(0.005),
                 "C1.v", 10 / 1.0001 * (1 - exp(-2 * 1.0001)) * exp(-3e-3 / 10), 1e-8);
    expect_value(CHARGING "switch S1 a b when=t < 2 [ms] Roff=1e9 Ron=0.001\n"
                          "init C1.v = 0\n" RUN_FOR(0.005),
                 "C1.v", charged, 1e-4);
}

/* a relaxation oscillator's first stroke: closed below 4 V, then it stays as it is */
static void switch_opens_by_state(void)
{
    expect_value(CHARGING "switch S1 a b when=C1.v < 4\ninit C1.v = 0\n" RUN_FOR(0.005), "C1.v", 4,
                 1e-8);
}

/* --- edges in trees --- */

static void edges_of_one_part_are_named_apart(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, TRANSFORMER "resistor R2 c 0 2\ntree electrical V1 R1 T1.s\n");
    EXPECT_DONE(&kit, "tree\n");
    EXPECT_HOLDS(kit.text, "T1.s");
    EXPECT_DONE(&kit, "set network tree\n" RUN_FOR(1));
    EXPECT_NEAR(kit_value(&kit, "T1.p.i"), 10.0 / 37, 1e-12);
    EXPECT_DONE(&kit, "info T1\n");
    EXPECT_HOLDS(kit.text, "T1.p");
    EXPECT_HOLDS(kit.text, "chord");
    EXPECT_DONE(&kit, "info T1.s.v\n");
    EXPECT_HOLDS(kit.text, "voltage of the second side");
    EXPECT_DONE(&kit, "tree + T1.p - R1\ncotree T1.s\ntree\n");
    EXPECT_DONE(&kit, RUN_FOR(1));
    EXPECT_NEAR(kit_value(&kit, "T1.p.i"), 10.0 / 37, 1e-12);
    kit_free(&kit);
}

/* what is saved makes the same trees, and init reaches the members of an edge */
static void edges_are_saved_by_their_names(void)
{
    const char *const text = TRANSFORMER "capacitor C1 c 0 1e-3\ntree electrical V1 R1 T1.s\n"
                                         "init C1.v = 1\n";
    Model *model = model_of(text);
    char *saved = model_save(model);
    Model *again = model_of(saved);
    char *before = branches(model, TREE_ELECTRICAL);
    char *after = branches(again, TREE_ELECTRICAL);

    EXPECT(strstr(saved, "tree electrical V1 R1 T1.s") != NULL);
    EXPECT_TEXT(after, before);
    mem_free(before);
    mem_free(after);
    mem_free(saved);
    model_free(model);
    model_free(again);
}

static void coupled_inductors_stay_while_they_are_coupled(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, TWO_WINDINGS "coupling K1 L1 L2 k=0.9\ninfo K1\n");
    EXPECT_HOLDS(kit.text, "L1 L2");
    EXPECT(kit_do(&kit, "delete L1\n") != CT_OK);
    EXPECT_HOLDS(kit.error.message, "L1 is used by");
    EXPECT_DONE(&kit, "delete K1\ninit none\ndelete L1\n");
    kit_free(&kit);
}

int main(void)
{
    RUN(coupled_windings_share_their_flux);
    RUN(negative_coupling_turns_a_winding_round);
    RUN(couplings_that_no_coils_have_are_refused);
    RUN(close_coils_are_coupled_one_by_one);
    RUN(coupled_inductors_in_series_add_both_ways);
    RUN(controlled_sources_follow_at_any_load);
    RUN(source_controlled_by_its_own_voltage_is_a_conductance);
    RUN(opamp_with_feedback_makes_its_inputs_equal);
    RUN(opamp_integrates);
    RUN(opamp_differentiates);
    RUN(opamp_filters);
    RUN(transformer_shows_its_load_times_n_squared);
    RUN(transformer_feeds_an_inductor);
    RUN(transformer_feeds_a_capacitor_from_an_ideal_source);
    RUN(gyrator_turns_a_capacitor_into_an_inductor);
    RUN(potentiometer_divides_under_load);
    RUN(capacitor_empties_over_a_moving_wiper);
    RUN(exponential_diode_meets_its_load_line);
    RUN(diode_of_straight_lines_follows_them);
    RUN(diode_opens_where_its_current_ends);
    RUN(switch_opens_and_closes_by_time);
    RUN(switch_opens_by_state);
    RUN(edges_of_one_part_are_named_apart);
    RUN(edges_are_saved_by_their_names);
    RUN(coupled_inductors_stay_while_they_are_coupled);
    return test_end();
}
