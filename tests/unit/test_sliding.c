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

/* What an if chooses from meets where another variable, or another zero, is above 0 alone: friction
 * by |y| against y < 0, from 2 m/s; and one that holds s' = -2 but not s' = 2. */
static void what_meets_for_one_sign_alone_jumps(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDE "body b mass=1\nprismatic y ground b axis=y\ninit y = -1, y' = 0\n"
                            "actuator f s force=-if(s' > 0, abs(y), y)\ninit s = 0, s' = 2\n"
                            "simulate 4 every=0.1\n");
    EXPECT(is_near(kit_value(&kit, "s"), 2, 1e-9));
    EXPECT(is_near(kit_value(&kit, "s'"), 0, 1e-12));
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, SLIDE "actuator f s force=if(s'*s' > 4, -s', -2)\ninit s = 0, s' = -3\n"
                            "simulate 1 every=0.1\n");
    EXPECT(is_near(kit_value(&kit, "s'"), -2, 1e-9));
    EXPECT(is_near(kit_value(&kit, "s"), -1 - 2 * (1 - log(1.5)), 1e-7));
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

/* masses on a row of springs, some of which stick from time to time */
#define ROW_OF_MASSES                                                                              \
    "scene planar\n"                                                                               \
    "body m0 mass=1.77095 inertia=0\n"                                                             \
    "prismatic s0 ground m0 axis=x\n"                                                              \
    "body m1 mass=2.30869 inertia=0\n"                                                             \
    "prismatic s1 ground m1 axis=x\n"                                                              \
    "body m2 mass=0.599202 inertia=0\n"                                                            \
    "prismatic s2 ground m2 axis=x\n"                                                              \
    "body m3 mass=2.81632 inertia=0\n"                                                             \
    "prismatic s3 ground m3 axis=x\n"                                                              \
    "actuator f2 s2 force=if(s2' > 0.0488819, -3.52729, if(s2' < 0.0488819, 3.52729, 0))\n"        \
    "actuator f0 s0 force=if(s0' > -0.406218, -4.36506, if(s0' < -0.406218, 4.36506, 0))\n"        \
    "actuator f3 s3 force=-3.28693*sign(s3')\n"                                                    \
    "actuator f1 s1 force=if(s1' > 0, -1.42032, if(s1' < 0, 1.42032, 0))\n"                        \
    "actuator v1 s0 force=22.9192*(s1 - s0)\n"                                                     \
    "actuator v2 s1 force=34.603*(s2 - s1)\n"                                                      \
    "spring k3 s3 k=25.2451\n"                                                                     \
    "actuator v3 s2 force=32.2117*(s3 - s2)\n"                                                     \
    "spring k2 s2 k=25.2074\n"                                                                     \
    "spring k0 s0 k=14.0323\n"                                                                     \
    "actuator l3 s3 force=3.7802 + 0*sin(1.30643*t + 2.45755)\n"                                   \
    "actuator u3 s3 force=-32.2117*(s3 - s2)\n"                                                    \
    "damper d1 s1 d=0.668588\n"                                                                    \
    "spring k1 s1 k=14.8202\n"                                                                     \
    "actuator l0 s0 force=3.08573*sin(5.18425*t + 4.74276)\n"                                      \
    "actuator l2 s2 force=2.93476*sin(2.97611*t + 5.20023)\n"                                      \
    "actuator u2 s2 force=-34.603*(s2 - s1)\n"                                                     \
    "damper d3 s3 d=0.577794\n"                                                                    \
    "actuator l1 s1 force=6.53002*sin(1.75441*t + 5.87387)\n"                                      \
    "actuator u1 s1 force=-22.9192*(s1 - s0)\n"                                                    \
    "init s0 = 0, s0' = 0\n"                                                                       \
    "init s1 = -0.300335, s1' = 0\n"                                                               \
    "init s2 = 0.230199, s2' = -0.889643\n"                                                        \
    "init s3 = 0, s3' = 0.934923\n"

/* while others slip, one that sticks stays where it is, whatever rounding leaves of its force */
static void what_sticks_stays_by_every_method(void)
{
    static const char *const methods[] = {"dop853", "radau", "bdf", "adams", "ida"};

    for (size_t k = 0; k < sizeof methods / sizeof methods[0]; k++) {
        Kit kit = kit_new();
        char line[80];

        EXPECT_DONE(&kit, ROW_OF_MASSES);
        (void)snprintf(line, sizeof line, "simulate 1.15 rtol=1e-11 method=%s\n", methods[k]);
        EXPECT(kit_do(&kit, line) == CT_OK);
        EXPECT(is_near(kit_value(&kit, "max(abs(s3')*(t > 1))"), 0, 1e-12));
        EXPECT(is_near(kit_value(&kit, "max(if(t > 1, s3, 0)) - min(if(t > 1, s3, 1))"), 0, 1e-11));
        kit_free(&kit);
    }
}

/* each way of sliding has independent speeds of its own */
static void embedded_equations_stick_and_slip(void)
{
    Kit plain = kit_new(), embedded = kit_new();

    EXPECT_DONE(&plain, ROW_OF_MASSES "simulate 2 rtol=1e-10\n");
    EXPECT_DONE(&embedded, ROW_OF_MASSES "form embedded\nsimulate 2 rtol=1e-9 method=ida\n");
    EXPECT(is_near(kit_value(&embedded, "s0"), kit_value(&plain, "s0"), 1e-5));
    EXPECT(is_near(kit_value(&embedded, "s2'"), kit_value(&plain, "s2'"), 1e-5));
    kit_free(&plain);
    kit_free(&embedded);
}

/* 2.5 N on either side of rest; then steps of 4 N at whole speeds, against a load of 3 N a second:
 * down to 1 m/s, held there until 4/3 s, up to 2 m/s, and held there until 8/3 s */
static void steps_of_floor_are_slid_along(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDE "actuator f s force=-5*(floor(s') + 0.5)\ninit s = 0, s' = 0.5\n"
                            "simulate 2\n");
    EXPECT(is_near(kit_value(&kit, "s"), 0.05, 1e-9));
    EXPECT(is_near(kit_value(&kit, "s'"), 0, 1e-12));
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, SLIDE "actuator f s force=-4*floor(s') + 3*t\ninit s = 0, s' = 2.5\n"
                            "simulate 2.5\n");
    EXPECT(is_near(kit_value(&kit, "s'"), 2, 1e-9));
    EXPECT(is_near(kit_value(&kit, "f.effort"), 0, 1e-9));
    EXPECT(kit_do(&kit, "resume 0.5\n") == CT_OK);
    EXPECT(is_near(kit_value(&kit, "s'"), 2 + 1.5 / 9, 1e-7));
    kit_free(&kit);
}

/* Its swings fade, ever faster and without an end: what a run may spend on them is bounded. */
static void fading_swings_end_in_rest_and_say_so(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDE "actuator f s force=-5*sign(s)\ndamper d s d=1\n"
                            "init s = 1, s' = 0\nsimulate 1000\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "the sign of s (f) switches ever faster");
    EXPECT(is_near(kit_value(&kit, "s"), 0, 1e-8));
    EXPECT(is_near(kit_value(&kit, "s'"), 0, 1e-12));
    kit_free(&kit);
    kit = kit_new(); /* these don't fade: each takes 4 sqrt(2 s0/5) */
    EXPECT_DONE(&kit, SLIDE "actuator f s force=-5*sign(s)\ninit s = 0.0001, s' = 0\n"
                            "simulate 60 every=1\n");
    EXPECT_LACKS(ct_remarks(kit.session), "ever faster");
    EXPECT(is_near(kit_value(&kit, "s'*s'/2 + 5*abs(s)"), 5e-4, 1e-8));
    kit_free(&kit);
}

/* A relay about a place that swings itself: its swings fade, and the load goes with the place. A
 * method that doesn't follow them names ways that do. */
static void swings_that_one_method_loses_another_follows(void)
{
    static const char *const ways[] = {"method=bdf", "method=radau", "method=bdf rtol=1e-9"};

    for (int i = 0; i < (int)(sizeof ways / sizeof ways[0]); i++) {
        Kit kit = kit_new();
        char run[80];

        EXPECT_DONE(&kit, "scene planar\nbody m mass=1.3419392738166587 inertia=0\n"
                          "prismatic s ground m axis=x\ndamper d s d=0.7311202963451392\n"
                          "actuator f s force=-6.4037263785534186*sign(s - 0.17587301774142061*"
                          "sin(0.44055690581567297*t))\n"
                          "init s = -0.16210986972542796, s' = 0.77790355330482241\n");
        (void)snprintf(run, sizeof run, "simulate 55.06368571047728 %s", ways[i]);
        if (i > 0 || kit_do(&kit, run) == CT_OK) {
            if (i > 0)
                EXPECT_DONE(&kit, run);
            EXPECT(is_near(kit_value(&kit, "s"),
                           0.17587301774142061 * sin(0.44055690581567297 * 55.06368571047728),
                           1e-4));
        } else {
            EXPECT_HOLDS(kit.error.hint, "a smaller rtol=, or method=radau");
        }
        kit_free(&kit);
    }
}

/* Where it sticks nothing but the work isn't straight: it is integrated as well as the tolerance
 * asks all the same, for what the belt gives less what friction takes is what the spring has. */
static void work_is_as_true_while_all_else_is_straight(void)
{
    static const char *const methods[] = {"dop853", "radau", "bdf", "adams", "ida"};

    for (int i = 0; i < (int)(sizeof methods / sizeof methods[0]); i++) {
        Kit kit = kit_new();
        char run[80];
        const char *drift;

        (void)snprintf(run, sizeof run, "simulate 20 rtol=1e-6 method=%s", methods[i]);
        EXPECT_DONE(&kit, SLIDE "spring k s k=10\nactuator f s force=-3*sign(s' - 0.5)\n"
                                "init s = 0, s' = 0\n");
        EXPECT_DONE(&kit, run);
        drift = kit.text != NULL ? strstr(kit.text, "energy drift") : NULL;
        EXPECT(drift == NULL || strtod(drift + strlen("energy drift"), NULL) < 1e-3);
        (void)snprintf(run, sizeof run, "simulate 20 rtol=1e-3 method=%s", methods[i]);
        EXPECT_DONE(&kit, run);
        kit_free(&kit);
    }
}

int main(void)
{
    RUN(a_mass_that_rubs_comes_to_rest);
    RUN(friction_holds_a_load_up_to_its_limit);
    RUN(what_meets_for_one_sign_alone_jumps);
    RUN(two_that_hold_the_same_share);
    RUN(a_relay_leads_along_its_surface);
    RUN(a_two_point_control_without_hysteresis_holds);
    RUN(a_drop_against_a_current_that_follows_at_once);
    RUN(two_surfaces_end_in_a_point);
    RUN(what_can_t_be_resolved_is_named);
    RUN(what_sticks_stays_by_every_method);
    RUN(embedded_equations_stick_and_slip);
    RUN(steps_of_floor_are_slid_along);
    RUN(fading_swings_end_in_rest_and_say_so);
    RUN(swings_that_one_method_loses_another_follows);
    RUN(work_is_as_true_while_all_else_is_straight);
    return test_end();
}
