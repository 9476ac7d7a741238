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

int main(void)
{
    RUN(a_tolerance_below_rounding_is_told);
    RUN(the_way_out_leads_out);
    return test_end();
}
