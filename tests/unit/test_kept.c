/* test_kept.c: starts and resting places: what was given, what is kept, what doesn't exist */
#include "session_kit.h"

static bool is_near(double got, double expected, double within)
{
    return fabs(got - expected) <= within;
}

#define STAR                                                                                       \
    "vsource V1 a s 10*sin(314*t)\nvsource V2 b s 10*sin(314*t - 2.0944)\n"                        \
    "vsource V3 c s 10*sin(314*t + 2.0944)\n"                                                      \
    "inductor L1 a p 1 mH\ninductor L2 b q 1 mH\ninductor L3 c r 1 mH\n"                           \
    "diode D1 p 0 Ron=1e-3 Roff=1e3 Vf=0.7\ndiode D2 q 0 Ron=1e-3 Roff=1e3 Vf=0.7\n"               \
    "diode D3 r 0 Ron=1e-3 Roff=1e3 Vf=0.7\n"

/* the third current is minus the sum of the others, whatever the diodes do */
static void currents_of_a_star_begin_as_given(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, STAR "init L1.i = 0, L2.i = 0\nsimulate 0.001\n");
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, STAR "init L1.i = 1, L2.i = 2, L3.i = -3\nassemble\n");
    EXPECT(is_near(kit_value(&kit, "L1.i"), 1, 1e-9));
    EXPECT(is_near(kit_value(&kit, "L2.i"), 2, 1e-9));
    EXPECT(is_near(kit_value(&kit, "L3.i"), -3, 1e-9));
    kit_free(&kit);
    kit = kit_new();
    EXPECT_FAILS(&kit, STAR "init L1.i = 1, L2.i = 2, L3.i = 3\nsimulate 0.001\n", "L1.i = 1");
    kit_free(&kit);
}

/* pull-in at V^2 = 8 k d^3/(27 eps A), with s = d/3 there */
static void no_plate_rests_beyond_its_electrode(void)
{
    static const char *const ways[] = {"d - s", "s"};

    for (int way = 0; way < 2; way++) {
        Kit kit = kit_new();
        char text[600];

        (void)snprintf(text, sizeof text,
                       "scene planar\nd = 2e-6; k = 5; A = 1e-8; eps0 = 8.854e-12\n"
                       "body p mass=1e-10 inertia=0\nprismatic s ground p axis=x\n"
                       "spring k1 s k=k rest=%s\nVpi = sqrt(8*k*d^3/(27*eps0*A))\n"
                       "vsource V a 0 0.9*Vpi\nresistor R a b 1000\n"
                       "platecap C s b 0 C=eps0*A/(%s)\ninit s = %s\nequilibrium\n",
                       way == 0 ? "0" : "d", ways[way], way == 0 ? "0" : "d");
        EXPECT_DONE(&kit, text);
        EXPECT(is_near(kit_value(&kit, way == 0 ? "s/d" : "1 - s/d"), 0.177292, 1e-5));
        EXPECT_FAILS(&kit, "set V.value = 1.05*Vpi\nequilibrium\n", "the law of C ends");
        EXPECT_FAILS(&kit, "set V.value = 30*Vpi\nequilibrium\n", "the law of C ends");
        kit_free(&kit);
    }
}

/* a capacitor on the source alone: its current is that of the ramp, however short that is */
static void a_short_ramp_is_a_ramp(void)
{
    static const char *const smooth[] = {
        "pulse(t, 0, 1, 1e-8, 1e-7, 1e-7, 1e-7, 1)", "pulse(t, 0, 1, 1, 1e-12, 1e-12, 1e-7, 3)",
        "pulse(t, 0, 1, 0, 1e-12, 1e-9, 1e-7, 3)", "1e9*sin(t)", "ramp(t)^2"};
    static const char *const rough[] = {"pulse(t, 0, 1, 0, 0, 1e-7, 1e-7, 1)",
                                        "pulse(t, 0, 1, 1e-8, 1e-7, 0, 1e-7)", "step(t - 1e-7)"};
    char text[200];

    for (size_t i = 0; i < sizeof smooth / sizeof smooth[0]; i++) {
        Kit kit = kit_new();

        (void)snprintf(text, sizeof text, "vsource V b 0 %s\ncapacitor C b 0 1\nsimulate 4e-7\n",
                       smooth[i]);
        EXPECT_DONE(&kit, text);
        kit_free(&kit);
    }
    for (size_t i = 0; i < sizeof rough / sizeof rough[0]; i++) {
        Kit kit = kit_new();

        (void)snprintf(text, sizeof text, "vsource V b 0 %s\ncapacitor C b 0 1\nsimulate 4e-7\n",
                       rough[i]);
        EXPECT_FAILS(&kit, text, "impulse through C");
        kit_free(&kit);
    }
}

static void an_operating_point_stays_but_for_what_is_given(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource V a 0 10\nresistor R1 a b 1000\ncapacitor C1 b 0 1 uF\n"
                      "resistor R2 b c 1000\ncapacitor C2 c 0 1 uF\nresistor R3 c 0 1000\n"
                      "init C1.v = 5, C2.v = 7\nop\ninit C1.v = 0\nassemble\n");
    EXPECT(is_near(kit_value(&kit, "C1.v"), 0, 1e-12));
    EXPECT(is_near(kit_value(&kit, "C2.v"), 10.0 / 3, 1e-6));
    EXPECT_DONE(&kit, "simulate 1e-9\n");
    EXPECT(is_near(kit_value(&kit, "C2.v"), 10.0 / 3, 1e-4));
    EXPECT_DONE(&kit, "assemble\nguess none\n");
    EXPECT(is_near(kit_value(&kit, "C2.v"), 0, 1e-12));
    kit_free(&kit);
}

/* the source is a conductance g that an event makes a thousandth: the coil's flux stays */
static void a_source_that_follows_its_own_voltage_is_a_resistor(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "capacitor Q q 0 1\nvsource V a 0 50\nisource S a b S.v*(1 + 999*Q.v)\n"
                      "inductor L b c 0.1\nresistor R c 0 1\n"
                      "event off when=t >= 0.5 Q.v = 0\ninit L.i = 0, Q.v = 1\n"
                      "simulate 0.5 every=0.1\n");
    EXPECT(is_near(kit_value(&kit, "max(L.i)"), 50 / 1.001 * (1 - exp(-0.5 * 10.01)), 1e-4));
    EXPECT(is_near(kit_value(&kit, "L.i"), kit_value(&kit, "max(L.i)"), 1e-9));
    kit_free(&kit);
}

/* s goes from 1 to 0.1 at once: the flux is that of 10 V/R before it, and decays from there */
static void flux_and_charge_stay_where_a_law_moves(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody m mass=1 inertia=0\nprismatic s ground m axis=x\n"
                      "vsource V a 0 10\nresistor R a b 1\ninductor L b 0 L=0.1*s\n"
                      "resistor Rc c 0 1e9\ncapacitor C c 0 1e-6*s\n"
                      "event jump when=t >= 0.5 s = 0.1\n"
                      "init s = 1, s' = 0, L.i = 0, C.v = 3\nsimulate 0.5 every=0.1\n");
    EXPECT(is_near(kit_value(&kit, "L.flux"), 1 - exp(-5), 1e-7));
    EXPECT(is_near(kit_value(&kit, "L.i"), 100 * (1 - exp(-5)), 1e-5));
    EXPECT(is_near(kit_value(&kit, "C.q"), 3e-6, 1e-8));
    EXPECT(is_near(kit_value(&kit, "C.v"), 30, 0.02));
    kit_free(&kit);
}

/* in closed form: C1 and C2 decay by themselves, share what is left, and decay together */
static void capacitors_that_a_switch_joins_share_their_charge(void)
{
    Kit kit = kit_new();
    const double v1 = 10 * exp(-1), v2 = 2 * exp(-1.0 / 3), v = (v1 + 3 * v2) / 4;

    EXPECT_DONE(&kit, "capacitor C1 a 0 1 uF\ncapacitor C2 b 0 3 uF\nresistor R1 a 0 1 kohm\n"
                      "resistor R2 b 0 1 kohm\nswitch S a b when=t > 1 [ms]\n"
                      "init C1.v = 10, C2.v = 2\nsimulate 5 ms every=1e-4 rtol=1e-9\n");
    EXPECT_HOLDS(ct_remarks(kit.session),
                 "S closes at t = 0.001 s: C1 and C2 share their charge, 1.89");
    EXPECT(is_near(kit_value(&kit, "C1.v"), v * exp(-2), 1e-7));
    EXPECT(is_near(kit_value(&kit, "C2.v"), v * exp(-2), 1e-7));
    kit_free(&kit);
}

static void coils_that_a_switch_puts_in_series_share_their_flux(void)
{
    Kit kit = kit_new();
    const double before = 10 * (1 - exp(-0.5)), behind = before / 4;

    EXPECT_DONE(&kit, "vsource V a 0 10\nresistor R1 a b 1\ninductor L1 b c 0.1\n"
                      "inductor L2 c d 0.3\nresistor R2 d 0 1\nswitch S c 0 when=t < 0.05\n"
                      "init L1.i = 0, L2.i = 0\nsimulate 0.1 rtol=1e-9\n");
    EXPECT_HOLDS(ct_remarks(kit.session),
                 "S opens at t = 0.05 s: L1 and L2 share their flux, 0.58");
    EXPECT(is_near(kit_value(&kit, "L1.i"), 5 + (behind - 5) * exp(-0.25), 1e-7));
    EXPECT(is_near(kit_value(&kit, "L2.i"), 5 + (behind - 5) * exp(-0.25), 1e-7));
    kit_free(&kit);
}

static void a_source_that_would_give_an_impulse_is_named(void)
{
    static const char *const scenes[][2] = {
        {"vsource E a 0 10\nswitch S a b when=t > 1 [ms]\ncapacitor C b 0 1 uF\n"
         "resistor R b 0 1 kohm\nsimulate 5 ms\n",
         "C.v would jump from 0 to 10: E alone would have to give the impulse"},
        {"vsource E a 0 10\nswitch S a b when=t > 1 [ms]\ncapacitor C b c 1 uF\n"
         "capacitor C2 c 0 1 uF\nresistor R c 0 1 kohm\nsimulate 5 ms\n",
         "E alone would have to give the impulse"},
        {"isource J 0 a 2\ninductor L a b 0.1\nswitch S a 0 when=t < 0.1\nresistor R b 0 1\n"
         "simulate 1\n",
         "L.i would jump from 0 to 2: J alone would have to give the impulse"},
    };

    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        Kit kit = kit_new();

        EXPECT_FAILS(&kit, scenes[i][0], scenes[i][1]);
        EXPECT_HOLDS(kit.error.hint, "a resistance in that circuit");
        kit_free(&kit);
    }
}

/* A follower has no way to take its load's charge back: what it does is no sharing. */
static void an_amplifier_is_not_taken_for_a_capacitor(void)
{
    Kit kit = kit_new();

    EXPECT_FAILS(&kit,
                 "capacitor C1 a 0 1 uF\nresistor R1 a 0 1 Mohm\nvcvs A o 0 a 0 gain=0.5\n"
                 "capacitor C2 b 0 1 uF\nresistor R2 b 0 1 Mohm\nswitch S o b when=t > 1 [ms]\n"
                 "init C1.v = 10, C2.v = 0\nsimulate 5 ms\n",
                 "would jump");
    EXPECT_HOLDS(kit.error.message, "A alone would have to give the impulse");
    kit_free(&kit);
}

/* D lets the charge through that C2 takes, and none back */
static void a_diode_closes_behind_what_is_shared(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "capacitor C1 a 0 1 uF\nresistor R1 a 0 1 Mohm\ndiode D b 0\n"
                      "capacitor C2 b c 3 uF\nresistor R2 b 0 1 Gohm\nresistor R3 c 0 1 Mohm\n"
                      "switch S a c when=t > 1 [ms]\ninit C1.v = 8, C2.v = 0\nsimulate 1\n");
    EXPECT(is_near(kit_value(&kit, "D.i"), 0, 1e-15));
    EXPECT(is_near(kit_value(&kit, "C2.v"), -2 * exp(-1e-3 / 4), 1e-2));
    EXPECT(is_near(kit_value(&kit, "C1.v"), 2 * exp(-2 * 0.999), 1e-2));
    kit_free(&kit);
}

int main(void)
{
    RUN(a_diode_closes_behind_what_is_shared);
    RUN(capacitors_that_a_switch_joins_share_their_charge);
    RUN(coils_that_a_switch_puts_in_series_share_their_flux);
    RUN(a_source_that_would_give_an_impulse_is_named);
    RUN(an_amplifier_is_not_taken_for_a_capacitor);
    RUN(flux_and_charge_stay_where_a_law_moves);
    RUN(a_source_that_follows_its_own_voltage_is_a_resistor);
    RUN(currents_of_a_star_begin_as_given);
    RUN(no_plate_rests_beyond_its_electrode);
    RUN(a_short_ramp_is_a_ramp);
    RUN(an_operating_point_stays_but_for_what_is_given);
    return test_end();
}
