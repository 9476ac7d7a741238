/* test_operating.c: operating points of networks against closed forms */
#include "session_kit.h"

#include "base/memory.h"
#include "base/text.h"

#include <gsl/gsl_sf_lambert.h>
#include <math.h>

/* i = Is (exp((E - R i)/V) - 1): R i = V W(R Is/V exp((E + R Is)/V)) - R Is, Corless and others
 * 1996 */
static void a_diode_behind_a_resistor_obeys_lambert(void)
{
    static const double sources[] = {0.3, 1, 5, 15};

    for (int k = 0; k < COUNT(sources); k++) {
        const double E = sources[k], R = 1000, Is = 1e-14, V = 0.025;
        const double i = V / R * gsl_sf_lambert_W0(R * Is / V * exp((E + R * Is) / V)) - Is;
        Kit kit = kit_new();
        Text lines = {0};

        text_addf(&lines,
                  "vsource E a 0 %g\nresistor R a b 1000\ncapacitor C b 0 1 uF\n"
                  "isource D b 0 1e-14*(exp(D.v/0.025) - 1)\nop\n"
                  "expect D.i ~ %.17g within %.17g\nexpect C.v ~ %.17g within 1e-9\n",
                  E, i, 1e-8 * i + 1e-18, E - R * i);
        EXPECT_DONE(&kit, lines.at);
        text_free(&lines);
        kit_free(&kit);
    }
}

static void capacitors_are_open_and_inductors_short(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 12*cos(50*t)\nresistor R1 a b 100\ninductor L b c 1\n"
                      "resistor R2 c 0 200\ncapacitor C c d 1 uF\nresistor R3 d 0 1e6\nop\n"
                      "expect L.i ~ 0.04 within 1e-14\nexpect C.v ~ 8 within 1e-12\n"
                      "expect d.v ~ 0 within 1e-12\n");
    kit_free(&kit);
}

/* no step of Newton's from nothing leads there at once; a run starts there */
static void many_diodes_in_a_row_share_a_high_voltage(void)
{
    enum { DIODES = 20 };
    Kit kit = kit_new();
    Text lines = {0};

    text_addf(&lines, "vsource E n0 0 1000\n");
    for (int k = 0; k < DIODES; k++)
        text_addf(&lines, "diode D%d n%d n%d Is=1e-14\n", k, k, k + 1);
    text_addf(&lines,
              "resistor R n%d 0 100\ninductor L n%d m 1\nresistor RL m 0 1e3\n"
              "Vt = 1.380649e-23*300.15/1.602176634e-19\nop\n"
              "expect D3.i ~ 1e-14*(exp(D3.v/Vt) - 1) + 1e-12*D3.v within 1e-7\n"
              "expect D3.i ~ (1000 - %d*D3.v)*(1/100 + 1/1000) within 1e-8\n"
              "simulate 1 ms\nexpect D7.i ~ (1000 - %d*D3.v)*(1/100 + 1/1000) within 1e-7\n",
              DIODES, DIODES, DIODES, DIODES);
    EXPECT_DONE(&kit, lines.at);
    text_free(&lines);
    kit_free(&kit);
}

/* two stages, each drawing current as the other's voltage rises: v = 1/2 +- d, d = tanh(4 d)/2 */
#define FLIP_FLOP                                                                                  \
    "vsource E s 0 1\nresistor Ra s a 1\nresistor Rb s b 1\n"                                      \
    "isource Ta a 0 0.5*(1 + tanh(4*(b.v - 0.5)))\n"                                               \
    "isource Tb b 0 0.5*(1 + tanh(4*(a.v - 0.5)))\ncapacitor Ca a 0 1\ncapacitor Cb b 0 1\n"

static void the_start_chooses_the_state_of_a_flip_flop(void)
{
    double d = 0.4;

    for (int i = 0; i < 100; i++)
        d = tanh(4 * d) / 2;
    for (int side = -1; side <= 1; side += 2) {
        Kit kit = kit_new();
        Text lines = {0};

        text_addf(&lines,
                  FLIP_FLOP "init Ca.v = %g, Cb.v = %g\nop\nexpect a.v ~ %.17g within 1e-9\n"
                            "expect b.v ~ %.17g within 1e-9\n",
                  0.5 + 0.45 * side, 0.5 - 0.45 * side, 0.5 + side * d, 0.5 - side * d);
        EXPECT_DONE(&kit, lines.at);
        text_free(&lines);
        kit_free(&kit);
    }
}

static void a_node_that_floats_is_named(void)
{
    Kit kit = kit_new();
    Text lines = {0};

    EXPECT_DONE(&kit, "vsource E a 0 12\nresistor R1 a b 100\nresistor R2 b 0 200\n"
                      "capacitor C1 b c 1 uF\ncapacitor C2 c 0 1 uF\nop\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "at rest nothing determines C");
    kit_free(&kit);

    kit = kit_new();
    text_addf(&lines, "vsource E n0 0 1\n");
    for (int k = 1; k <= 400; k++)
        text_addf(&lines, "resistor R%d n%d n%d 10\ncapacitor C%d n%d 0 1e-9\n", k, k - 1, k, k, k);
    text_addf(&lines, "capacitor CX n400 x 1 uF\ncapacitor CY x 0 1 uF\n");
    EXPECT_DONE(&kit, lines.at);
    EXPECT(kit_do(&kit, "op\n") != CT_OK);
    EXPECT_HOLDS(kit.error.message, "at rest nothing determines CY.v");
    text_free(&lines);
    kit_free(&kit);
}

/* an even fall of voltage along 600 resistors, with diodes that block at its end */
static void large_networks_rest_too(void)
{
    Kit kit = kit_new();
    Text lines = {0};

    text_addf(&lines, "vsource E n0 0 6\n");
    for (int k = 1; k <= 600; k++)
        text_addf(&lines, "resistor R%d n%d n%d 10\ncapacitor C%d n%d 0 1e-9\n", k, k - 1, k, k, k);
    text_addf(&lines, "resistor RL n600 0 6000\nisource D 0 n600 1e-14*(exp(D.v/0.025) - 1)\nop\n"
                      "expect C300.v ~ 4.5 within 1e-9\nexpect C600.v ~ 3 within 1e-9\n");
    EXPECT_DONE(&kit, lines.at);
    text_free(&lines);
    kit_free(&kit);
}

/* what came behind the operating point comes and goes; itself it stays */
static void undo_of_an_init_leaves_the_operating_point(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource V a 0 10\nresistor R1 a b 100\ncapacitor C1 b 0 1 uF\n"
                      "resistor R2 b c 100\ncapacitor C2 c 0 1 uF\nresistor R3 c 0 200\nop\n"
                      "expect C1.v ~ 7.5 within 1e-9\ninit C1.v = 1\n"
                      "expect C1.v ~ 1 within 1e-9\nexpect C2.v ~ 5 within 1e-9\n"
                      "init C2.v = 2\nexpect C2.v ~ 2 within 1e-9\nundo\n"
                      "expect C2.v ~ 5 within 1e-9\nexpect C1.v ~ 1 within 1e-9\nundo\n"
                      "expect C1.v ~ 7.5 within 1e-9\nredo\nexpect C1.v ~ 1 within 1e-9\n"
                      "undo\nsimulate 1 us\nexpect C1.v ~ 7.5 within 1e-9\n"
                      "guess none\nexpect C1.v ~ 0 within 1e-9\n");
    kit_free(&kit);
}

/* nor is a number told where there is none: a root of what becomes negative, no inertia at all */
static void what_is_undefined_is_called_so(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody b mass=1e9 inertia=1\nrevolute h ground b\n"
                      "actuator a h torque=sqrt(h) + 1\ninit h = -1\n");
    EXPECT(kit_do(&kit, "equilibrium\n") != CT_OK);
    EXPECT_LACKS(kit.error.message, "nan");
    EXPECT_HOLDS(kit.error.message, "the forces on h, undefined");
    EXPECT_DONE(&kit, "clear\nscene planar\nbody b mass=1 inertia=0\nrevolute h ground b\n"
                      "actuator a h torque=tan(h)\ninit h = 1\nexpect h ~ 1 within 1e-12\n");
    EXPECT(isnan(kit_value(&kit, "h''")));
    kit_free(&kit);
}

/* the next sample leaves everything as it is: c = G.v/2 = 2 (2 - c)/2, and integral control leaves
 * no error */
static void what_samples_holds_what_it_would_take_next(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource V b 0 2\nresistor R2 c 0 1\ncapacitor C c 0 1\n"
                      "gain G a 0 of=b.v-c.v k=2 period=0.1\nresistor R a c 1\n"
                      "input U u 0 period=0.1 initial=3\n"
                      "lag L d 0 of=u.v+c.v k=0.5 T=2 period=0.01\nresistor R3 d 0 1\n"
                      "capacitor C2 e 0 1\npid P f 0 ref=u.v of=e.v Kp=1 Ki=0.5 period=0.2\n"
                      "resistor R4 f e 1\nresistor R5 e 0 1\nop\n"
                      "expect c.v ~ 1 within 1e-10\nexpect u.v ~ 3 within 1e-12\n"
                      "expect d.v ~ 2 within 1e-10\nexpect e.v ~ 3 within 1e-9\n"
                      "expect P.integral ~ 12 within 1e-8\nsimulate 1\n"
                      "expect c.v ~ 1 within 1e-9\nexpect d.v ~ 2 within 1e-9\n"
                      "expect e.v ~ 3 within 1e-8\n");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_diode_behind_a_resistor_obeys_lambert);
    RUN(capacitors_are_open_and_inductors_short);
    RUN(many_diodes_in_a_row_share_a_high_voltage);
    RUN(the_start_chooses_the_state_of_a_flip_flop);
    RUN(a_node_that_floats_is_named);
    RUN(large_networks_rest_too);
    RUN(undo_of_an_init_leaves_the_operating_point);
    RUN(what_is_undefined_is_called_so);
    RUN(what_samples_holds_what_it_would_take_next);
    return test_end();
}
