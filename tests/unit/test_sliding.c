/* test_sliding.c: runs on surfaces that the equations jump on: dry friction, relays */
#include "session_kit.h"

#define SLIDE "scene planar\nbody m mass=1 inertia=0\nprismatic s ground m axis=x\n"

static bool is_near(double got, double expected, double within)
{
    return fabs(got - expected) <= within;
}

/* 1 m/s against 5 m/s^2: at rest after 0.2 s and 0.1 m, with nothing left to hold */
static void a_mass_that_rubs_comes_to_rest(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDE "actuator f s force=-5*sign(s')\ninit s = 0, s' = 1\n"
                            "simulate 1 every=0.1\n");
    EXPECT(is_near(kit_value(&kit, "s"), 0.1, 1e-9));
    EXPECT(is_near(kit_value(&kit, "s'"), 0, 1e-12));
    EXPECT(is_near(kit_value(&kit, "s''"), 0, 1e-9));
    EXPECT(is_near(kit_value(&kit, "f.effort"), 0, 1e-9));
    EXPECT(kit_do(&kit, "resume 1\n") == CT_OK);
    EXPECT(is_near(kit_value(&kit, "s"), 0.1, 1e-9));
    kit_free(&kit);
}

/* the load grows by 2 N/s: friction holds it to 5 N, at 2.5 s, then s = (t - 2.5)^3/3 */
static void friction_holds_a_load_up_to_its_limit(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDE "actuator f s force=if(s' > 0, -5, 5)\nactuator l s force=2*t\n"
                            "init s = 0, s' = 0\nsimulate 4 every=0.1\n");
    EXPECT(is_near(kit_value(&kit, "max(abs(s)*(t < 2.5))"), 0, 1e-12));
    EXPECT(is_near(kit_value(&kit, "s"), pow(1.5, 3) / 3, 1e-7));
    EXPECT(is_near(kit_value(&kit, "f.effort"), -5, 1e-12));
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, SLIDE "actuator f s force=-5*sign(s')\nactuator l s force=3\n"
                            "init s = 0, s' = 0\nsimulate 4 every=0.1\n");
    EXPECT(is_near(kit_value(&kit, "s"), 0, 1e-12));
    EXPECT(is_near(kit_value(&kit, "f.effort"), -3, 1e-9));
    kit_free(&kit);
}

/* nothing tells which of them holds how much */
static void two_that_hold_the_same_share(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDE "actuator f s force=-5*sign(s')\nactuator g s force=-2*sign(2*s')\n"
                            "actuator l s force=6\ninit s = 0, s' = 0\nsimulate 1\n");
    EXPECT(is_near(kit_value(&kit, "s"), 0, 1e-12));
    EXPECT(is_near(kit_value(&kit, "f.effort + g.effort"), -6, 1e-9));
    kit_free(&kit);
}

/* a relay whose surface moves: h' = -3 h on it */
static void a_relay_leads_along_its_surface(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDE "actuator f s force=-10*sign(s' + 3*s)\ninit s = 1, s' = -3\n"
                            "simulate 2\n");
    EXPECT(is_near(kit_value(&kit, "s"), exp(-6), 1e-7));
    EXPECT(is_near(kit_value(&kit, "f.effort"), 9 * exp(-6), 1e-6));
    kit_free(&kit);
}

static void a_two_point_control_without_hysteresis_holds(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "capacitor C b 0 1 mF\nvsource V a 0 if(C.v < 3, 10, -10)\n"
                      "resistor R a b 100\nresistor L b 0 1000\ninit C.v = 0\nsimulate 1\n");
    EXPECT(is_near(kit_value(&kit, "C.v"), 3, 1e-9));
    EXPECT(is_near(kit_value(&kit, "V.v"), 3.3, 1e-6)); /* 3 mA through R */
    kit_free(&kit);
}

/* a voltage of 5 against the current, which nothing stores: none flows below it */
static void a_drop_against_a_current_that_follows_at_once(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "resistor R b 0 100\nvsource V a 0 10*sin(t)\n"
                      "vsource F a b 5*sign(R.i)\nsimulate 3 every=0.05\n");
    EXPECT(is_near(kit_value(&kit, "max(R.i)"), 0.05, 1e-4));
    EXPECT(is_near(kit_value(&kit, "max(abs(R.i)*(V.v < 5))"), 0, 1e-12));
    EXPECT(is_near(kit_value(&kit, "max(abs(V.v - F.v - 100*R.i))"), 0, 1e-9));
    kit_free(&kit);
}

/* Each swing is (5 - 2)/(5 + 2) of the last: it ends at a time of its own, with both at 0. */
static void two_surfaces_end_in_a_point(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDE "actuator f s force=-5*sign(s) - 2*sign(s')\ninit s = 1, s' = 0\n"
                            "simulate 10\n");
    EXPECT(is_near(kit_value(&kit, "s"), 0, 1e-8));
    EXPECT(is_near(kit_value(&kit, "s'"), 0, 1e-8));
    kit_free(&kit);
}

static void what_can_t_be_resolved_is_named(void)
{
    Kit kit = kit_new();

    EXPECT_FAILS(&kit,
                 "capacitor C b 0 1 mF\nvsource V a 0 10\nswitch S a c when=C.v < 3\n"
                 "resistor R c b 100\nresistor L b 0 1000\ninit C.v = 0\nsimulate 1\n",
                 "C.v");
    EXPECT_HOLDS(kit.error.message, "S");
    EXPECT_LACKS(kit.error.message, "nan");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_mass_that_rubs_comes_to_rest);
    RUN(friction_holds_a_load_up_to_its_limit);
    RUN(two_that_hold_the_same_share);
    RUN(a_relay_leads_along_its_surface);
    RUN(a_two_point_control_without_hysteresis_holds);
    RUN(a_drop_against_a_current_that_follows_at_once);
    RUN(two_surfaces_end_in_a_point);
    RUN(what_can_t_be_resolved_is_named);
    return test_end();
}
