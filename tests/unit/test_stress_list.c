/* test_stress_list.c: what brings solvers down, each with what has to become of it */
#include "session_kit.h"

/* --- tolerances that rounding doesn't leave --- */

/* a crank of 1 mm without mass, a coupler of 1.8 m and 2 mg, a rocker of 4 kg; the tree goes
 * through the crank */
#define DECADES_APART                                                                              \
    "scene planar\ngravity [0, -9.81]\narm g ground [1, 0]\n"                                      \
    "body c mass=0 inertia=0\narm ca c [-0.000572, 0]; arm cb c [0.000572, 0]\n"                   \
    "body k mass=2.2e-6 inertia=6.18e-7\narm ka k [-0.918, 0]; arm kb k [0.918, 0]\n"              \
    "body b mass=4.43 inertia=0.591\narm ba b [-0.633, 0]; arm bb b [0.633, 0]\n"                  \
    "revolute h1 ground ca; revolute h2 cb ka; revolute h3 g ba; revolute h4 kb bb\n"              \
    "guess c.theta=2.37, k.x=0.69, k.y=0.6, k.theta=0.716\n"                                       \
    "guess b.x=1.19, b.y=0.6, b.theta=1.26, h2=-1.65, h3=1.26, h4=0.546\n"                         \
    "init h1 = 2.37, h1' = 7.14\n"

static void a_tolerance_below_rounding_is_told(void)
{
    static const char *const methods[] = {"dop853", "radau", "adams", "ida"};

    for (int i = 0; i < 4; i++) {
        Kit kit = kit_new();
        char run[100];

        EXPECT_DONE(&kit, DECADES_APART "cotree h3");
        (void)snprintf(run, sizeof run, "simulate 0.9 rtol=1e-12 method=%s", methods[i]);
        EXPECT_FAILS(&kit, run, "the tolerance is below what rounding leaves");
        EXPECT_HOLDS(kit.error.hint, "another tree");
        kit_free(&kit);
    }
}

static void the_way_out_leads_out(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, DECADES_APART "cotree h1\nsimulate 0.9 rtol=5e-11");
    kit_free(&kit);
}

/* --- what check=on makes of two runs --- */

static void methods_with_a_history_are_trusted_less(void)
{
    static const struct {
        const char *method;
        double factor;
    } cases[] = {{"dop853", 2}, {"radau", 2}, {"adams", 6}, {"bdf", 6}, {"ida", 6}};

    for (int i = 0; i < 5; i++) {
        Kit kit = kit_new();
        char run[100];
        double told = 0, angle, speed, difference;
        const char *at;

        EXPECT_DONE(&kit, PENDULUM);
        (void)snprintf(run, sizeof run, "simulate 2 every=2 rtol=1e-6 method=%s check=on",
                       cases[i].method);
        EXPECT_DONE(&kit, run);
        EXPECT_DONE(&kit, "show run");
        EXPECT_HOLDS(kit.text, "global error");
        at = kit.text != NULL ? strstr(kit.text, "global error") : NULL;
        EXPECT(at != NULL && sscanf(at + strlen("global error"), "%lf", &told) == 1);
        angle = kit_value(&kit, "h");
        speed = kit_value(&kit, "h'");
        (void)snprintf(run, sizeof run, "simulate 2 every=2 rtol=1e-7 method=%s", cases[i].method);
        EXPECT_DONE(&kit, run);
        difference = fmax(fabs(angle - kit_value(&kit, "h")), fabs(speed - kit_value(&kit, "h'")));
        /* it is printed in two digits */
        EXPECT_NEAR(told / difference, cases[i].factor, 0.06 * cases[i].factor);
        kit_free(&kit);
    }
}

static void what_is_not_resolved_has_no_number(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "body p2 mass=2 inertia=0.5\narm b m [0, -1.5]\n"
                               "arm c p2 [0, 1.5]\nrevolute k b c\ninit h = 3\n"
                               "simulate 100 rtol=1e-5 check=on");
    EXPECT_HOLDS(ct_remarks(kit.session), "not resolved: ");
    EXPECT_LACKS(ct_remarks(kit.session), "e-");
    EXPECT_DONE(&kit, "show run");
    EXPECT_HOLDS(kit.text, "global error       not resolved");
    kit_free(&kit);
}

int main(void)
{
    RUN(methods_with_a_history_are_trusted_less);
    RUN(what_is_not_resolved_has_no_number);
    RUN(a_tolerance_below_rounding_is_told);
    RUN(the_way_out_leads_out);
    return test_end();
}
