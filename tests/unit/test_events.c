/* test_events.c: events of a run: when they happen, what comes of it, and what is refused */
#include "session_kit.h"

/* a ball above the floor */
#define BALL                                                                                       \
    "scene planar\ngravity [0, -9.81]\nbody m1 mass=1\nprismatic s1 ground m1 axis=y\n"            \
    "init s1 = 1\n"
#define BOUNCE "event hit when=s1 < 0 s1'=-0.8*s1'\n"

/* two carts that don't know of each other */
#define CARTS                                                                                      \
    "scene planar\nbody a mass=1\nbody b mass=2\nprismatic s1 ground a axis=x\n"                   \
    "prismatic s2 ground b axis=x\n"

/* the k-th time of an event by its line in `show events`; NAN: there are fewer */
static double time_of(Kit *kit, const char *event, int k)
{
    char name[40];
    const char *at;
    double t = NAN;
    char *end;

    EXPECT_DONE(kit, "show events");
    at = kit->text != NULL ? strstr(kit->text, "in the last run") : NULL;
    (void)snprintf(name, sizeof name, "\n  %s  ", event);
    at = at != NULL ? strstr(at, name) : NULL;
    if (at == NULL)
        return NAN;
    at += strlen(name);
    if (strchr(at, ':') != NULL && strchr(at, ':') < strchr(at, '\n'))
        at = strchr(at, ':') + 1;
    for (int i = 0; i <= k; i++, at = end) {
        t = strtod(at, &end);
        if (end == at)
            return NAN;
    }
    return t;
}

/* --- closed forms --- */

static void a_ball_bounces_when_the_closed_form_says(void)
{
    static const struct {
        const char *method;
        double within;
    } methods[] = {{"dop853", 1e-9}, {"radau", 1e-9}, {"ida", 1e-5},
                   {"rk4", 1e-9},    {"bdf", 1e-4},   {"adams", 1e-4}};
    const double fall = sqrt(2 / 9.81);

    for (size_t i = 0; i < sizeof methods / sizeof methods[0]; i++) {
        Kit kit = kit_new();
        char line[100];
        double t = fall, leap = 2 * 0.8 * fall;

        (void)snprintf(line, sizeof line, "simulate 3 every=0.01 method=%s", methods[i].method);
        EXPECT_DONE(&kit, BALL BOUNCE);
        EXPECT_DONE(&kit, line);
        for (int k = 0; k < 5; k++, t += leap, leap *= 0.8)
            EXPECT_NEAR(time_of(&kit, "hit", k), t, methods[i].within);
        /* the top of the third leap */
        EXPECT_NEAR(kit_value(&kit, "s1 at 1.7519117270246358 + 0.8^3*0.4515236409857309"),
                    pow(0.8, 6), methods[i].within);
        kit_free(&kit);
    }
}

static void a_fall_stops_at_the_floor(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL "event floor when=s1 < 0 do=stop\nsimulate 3 every=0.1");
    EXPECT_HOLDS(ct_remarks(kit.session),
                 "event floor ended the run at t = 0.451523641 s: s1 < 0 became true");
    EXPECT_HOLDS(kit.text, "0 ... 0.451524 s, 6 rows");
    EXPECT_NEAR(kit_value(&kit, "t"), sqrt(2 / 9.81), 1e-15);
    EXPECT_NEAR(kit_value(&kit, "s1"), 0, 1e-15);
    EXPECT_NEAR(kit_value(&kit, "s1'"), -sqrt(2 * 9.81), 1e-14);
    kit_free(&kit);
}

static void a_stopped_run_goes_on_and_does_not_stop_there_again(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL "event floor when=s1 < 0 do=stop\nsimulate 3 every=0.1\nresume 0.5");
    EXPECT_NEAR(kit_value(&kit, "t"), sqrt(2 / 9.81) + 0.5, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "s1"), 1 - 9.81 / 2 * pow(sqrt(2 / 9.81) + 0.5, 2), 1e-8);
    EXPECT_DONE(&kit, "show events");
    EXPECT_HOLDS(kit.text, "floor  0.451523640986 s\n");
    kit_free(&kit);
}

static void marks_lie_at_quarters_of_the_pendulums_period(void)
{
    Kit kit = kit_new();
    double a = 1, b = cos(M_PI / 6), period;

    for (int i = 0; i < 6; i++) {
        const double mean = (a + b) / 2;

        b = sqrt(a * b);
        a = mean;
    }
    period = 2 * M_PI / sqrt(9.81) / a;
    EXPECT_DONE(&kit, PENDULUM "event down when=h < 0\nevent back when=h' > 0 do=mark\n"
                               "simulate 6 every=0.1 rtol=1e-12 atol=1e-12");
    EXPECT_NEAR(time_of(&kit, "down", 0), period / 4, 2e-9);
    EXPECT_NEAR(time_of(&kit, "down", 1), period * 5 / 4, 2e-9);
    EXPECT_NEAR(time_of(&kit, "back", 0), period / 2, 2e-9);
    EXPECT_NEAR(time_of(&kit, "back", 1), period * 3 / 2, 2e-9);
    EXPECT(isnan(time_of(&kit, "down", 3)));
    kit_free(&kit);
}

/* charged to V (1 - exp(-t/RC)), emptied at V/2: a saw tooth of period RC log 2 */
static void a_capacitor_that_is_emptied_makes_a_saw_tooth(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource V1 a 0 10\nresistor R1 a b 1 kohm\ncapacitor C1 b 0 1 mF\n"
                      "event empty when=C1.v > 5 C1.v=0\nevent weak when=R1.i < 7 mA\n"
                      "simulate 3 every=0.01 rtol=1e-11 atol=1e-11");
    for (int k = 0; k < 4; k++) {
        EXPECT_NEAR(time_of(&kit, "empty", k), (k + 1) * log(2), 1e-8);
        EXPECT_NEAR(time_of(&kit, "weak", k), k * log(2) - log(0.7), 1e-8);
    }
    EXPECT_NEAR(kit_value(&kit, "C1.v at 2.5"), 10 * (1 - exp(-(2.5 - 3 * log(2)))), 1e-8);
    kit_free(&kit);
}

/* no state says how short the steps have to be */
static void what_follows_a_source_is_seen_in_every_period(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 10*sin(100*pi*t)\nresistor R1 a b 100\nresistor R2 b 0 100\n"
                      "event high when=b.v > 2 do=mark\nsimulate 1 every=10 ms\n");
    for (int k = 0; k < 50; k++)
        EXPECT_NEAR(time_of(&kit, "high", k), asin(0.4) / (100 * M_PI) + 0.02 * k, 1e-12);
    EXPECT(isnan(time_of(&kit, "high", 50)));
    kit_free(&kit);
}

static void a_condition_may_hold_forces_and_accelerations(void)
{
    Kit kit = kit_new();

    /* the tension v^2 + g cos h vanishes where 3 g cos h = 2 g - v0^2 */
    EXPECT_DONE(&kit, PENDULUM "init h = 0, h' = 5.2\n"
                               "event slack when=h.fy*cos(h) - h.fx*sin(h) < 0 do=stop\n"
                               "event slow when=h'' < -8\nsimulate 2 rtol=1e-11 atol=1e-11");
    EXPECT_NEAR(3 * 9.81 * cos(kit_value(&kit, "h")), 2 * 9.81 - 5.2 * 5.2, 1e-8);
    EXPECT_NEAR(kit_value(&kit, "h.fx^2 + h.fy^2"), 0, 1e-12);
    EXPECT_DONE(&kit, "event slow when=h'' < -8 do=stop\nsimulate 2");
    EXPECT_NEAR(9.81 * sin(kit_value(&kit, "h")), 8, 1e-9);
    kit_free(&kit);
}

/* --- instants --- */

static void an_instant_in_time_is_exact_and_a_row(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL "event kick when=t > 0.3 s1'=2\nsimulate 0.5 every=0.1");
    EXPECT_HOLDS(kit.text, "7 rows"); /* 0.3 twice: before and behind */
    EXPECT_NEAR(kit_value(&kit, "s1' at 0.3"), 2, 1e-15);
    EXPECT_NEAR(kit_value(&kit, "s1' at 0.29999999"), -9.81 * 0.29999999, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "s1"), 1 - 9.81 / 2 * 0.09 + 2 * 0.2 - 9.81 / 2 * 0.04, 1e-9);
    EXPECT(time_of(&kit, "kick", 0) == 0.3);
    kit_free(&kit);
}

static void every_operator_of_conditions_works(void)
{
    Kit kit = kit_new();
    const double down = sqrt(2 * 0.5 / 9.81); /* at s1 = 0.5 */

    EXPECT_DONE(&kit,
                BALL "low = 0.5\nlimit(x) = x*low\noutput depth = 1 - s1\n"
                     "event e1 when=s1 < low && t > 0.1\nevent e2 when=s1 < low && t < 0.1\n"
                     "event e3 when=s1 < low || t >= 0.2\nevent e4 when=!(s1 >= limit(1))\n"
                     "event e5 when=depth > 0.5\nevent e6 when=if(t < 0.1, s1 > 2, s1 <= low)\n"
                     "event e7 when=low > 0 && m1.y < low\nevent e8 when=low == 1 && s1 < low\n"
                     "simulate 0.4");
    EXPECT_NEAR(time_of(&kit, "e1", 0), down, 1e-9);
    EXPECT(isnan(time_of(&kit, "e2", 0)));
    EXPECT(time_of(&kit, "e3", 0) == 0.2);
    for (int k = 4; k <= 7; k++) {
        char name[16];

        (void)snprintf(name, sizeof name, "e%d", k);
        EXPECT_NEAR(time_of(&kit, name, 0), down, 1e-9);
    }
    EXPECT(isnan(time_of(&kit, "e8", 0)));
    kit_free(&kit);
}

static void what_holds_at_the_start_must_be_false_before_it_happens(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL BOUNCE "event high when=s1 > 0.5\nsimulate 1");
    EXPECT_HOLDS(ct_remarks(kit.session), "event high: s1 > 0.5 holds at the start; it must be "
                                          "false before it can become true");
    /* on its way up after the bounce: 0.5 = v t - g/2 t^2 */
    EXPECT_NEAR(time_of(&kit, "high", 0),
                sqrt(2 / 9.81) + (0.8 * sqrt(2 * 9.81) - sqrt(0.64 * 2 * 9.81 - 9.81)) / 9.81,
                1e-8);
    EXPECT_DONE(&kit, "event over when=s1 > 0.9 do=stop\nsimulate 1");
    EXPECT_HOLDS(ct_remarks(kit.session),
                 "event over ended the run at t = 0 s: s1 > 0.9 holds at the start");
    EXPECT_NEAR(kit_value(&kit, "t"), 0, 0);
    kit_free(&kit);
}

static void a_condition_that_is_met_on_leaving_the_start_happens_there(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL "init s1 = 0, s1' = 1\nevent up when=s1 > 0\nevent now when=t > 0\n"
                           "event down when=s1 < 0\nevent turn when=s1' < 1\nsimulate 0.1");
    EXPECT(time_of(&kit, "up", 0) == 0);
    EXPECT(time_of(&kit, "now", 0) == 0);
    EXPECT(time_of(&kit, "turn", 0) == 0);
    EXPECT(isnan(time_of(&kit, "down", 0)));
    kit_free(&kit);
}

static void a_condition_without_a_value_is_not_true(void)
{
    Kit kit = kit_new();

    /* the root has none above s1 = 0.5 */
    EXPECT_DONE(&kit, BALL "event e1 when=sqrt(0.5 - s1) > 0.1\nevent e2 when=sqrt(0.5 - s1) >= 0\n"
                           "event e3 when=sqrt(-1 - s1) > 0\nsimulate 0.44");
    EXPECT_NEAR(time_of(&kit, "e1", 0), sqrt(2 * 0.51 / 9.81), 1e-9);
    EXPECT_NEAR(time_of(&kit, "e2", 0), sqrt(2 * 0.5 / 9.81), 1e-6);
    EXPECT(isnan(time_of(&kit, "e3", 0)));
    kit_free(&kit);
}

/* --- new values --- */

static void right_hand_sides_are_those_just_before(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, CARTS "init s1' = 3, s2' = 1\n"
                            "event swap when=t > 1 s1'=s2' s2'=s1' s1=s1 + s2\n"
                            "event after when=s1' < 2 s2=t*s2'\nsimulate 2 every=0.5");
    EXPECT_NEAR(kit_value(&kit, "s1' at 1"), 1, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "s2' at 1"), 3, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "s1 at 1"), 4, 1e-9);
    /* an event that another one brings about comes after it, at the same instant */
    EXPECT_NEAR(kit_value(&kit, "s2 at 1"), 3, 1e-9);
    EXPECT(time_of(&kit, "after", 0) == 1);
    kit_free(&kit);
}

static void an_elastic_impact_keeps_momentum_and_energy(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, CARTS "init s1' = 3, s2 = 1\n"
                            "event impact when=s1 > s2 s1'=(4*s2' - s1')/3 "
                            "s2'=(2*s1' + s2')/3\nsimulate 1");
    EXPECT_NEAR(time_of(&kit, "impact", 0), 1. / 3, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "s1' + 2*s2'"), 3, 1e-12);
    EXPECT_NEAR(kit_value(&kit, "energy.kinetic"), 4.5, 1e-12);
    kit_free(&kit);
}

/* the crank turns back: its coordinate as branch, and as chord of another tree */
static void constraints_hold_after_new_values_in_whatever_tree(void)
{
    static const char *const trees[] = {"tree h8 h10 s11\n", "tree m1 m2 m3\n", "tree h8 h9 s11\n",
                                        TWO_TREES, "form embedded\n"};
    double slide[5];

    for (int i = 0; i < 5; i++) {
        Kit kit = kit_new();
        double before;

        EXPECT_DONE(&kit, SLIDER_CRANK);
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "init h8 = 60 deg, h8' = 12\nguess h10 = 2.85, s11 = 0.67\n"
                          "simulate 0.1 rtol=1e-11 atol=1e-11");
        before = kit_value(&kit, "h8'");
        EXPECT_DONE(&kit, "event back when=t > 0.1 h8'=-0.5*h8'\n"
                          "simulate 0.2 every=0.01 rtol=1e-11 atol=1e-11");
        EXPECT_HOLDS(ct_remarks(kit.session), "energy drift");
        EXPECT_NEAR(kit_value(&kit, "h8' at 0.1"), -0.5 * before, 1e-8);
        EXPECT(kit_value(&kit, "max(constraint.error)") < 1e-12);
        slide[i] = kit_value(&kit, "s11");
        EXPECT_NEAR(slide[i], slide[0], 1e-8);
        kit_free(&kit);
    }
}

static void a_position_can_be_set_and_the_rest_follows(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE CRANK_START
                "event jump when=t > 0.05 s11=0.55\nevent twin when=t > 0.1 h8=h8 + 0.1 h8'=1\n"
                "simulate 0.12 every=0.01");
    EXPECT_NEAR(kit_value(&kit, "s11 at 0.05"), 0.55, 1e-10);
    EXPECT_NEAR(kit_value(&kit, "h8' at 0.1"), 1, 1e-10);
    EXPECT(kit_value(&kit, "max(constraint.error)") < 1e-12);
    kit_free(&kit);
}

enum { ROW_HOLDS = 4 };

/* what an event names not stays, in coordinates of joints and their rates */
static void expect_joints_to_stay(const char *chain, const char *const *trees, int count)
{
    static const char *const stays[ROW_HOLDS] = {"h2", "h1'", "h2'", "h1 - 0.2"};
    double end[ROW_HOLDS] = {0};

    for (int i = 0; i < count; i++) {
        Kit kit = kit_new();
        double before[ROW_HOLDS] = {0};

        EXPECT_DONE(&kit, chain);
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "simulate 0.1 rtol=1e-11 atol=1e-12");
        for (int k = 0; k < ROW_HOLDS - 1; k++)
            before[k] = kit_value(&kit, stays[k]);
        EXPECT_DONE(&kit, "event kick when=t > 0.1 h1=0.2\n"
                          "simulate 0.2 every=0.1 rtol=1e-11 atol=1e-12");
        for (int k = 0; k < ROW_HOLDS; k++) {
            char at[40];

            (void)snprintf(at, sizeof at, "%s at 0.1", stays[k]);
            EXPECT_NEAR(kit_value(&kit, at), before[k], 1e-8);
            if (i == 0)
                end[k] = kit_value(&kit, stays[k]);
            EXPECT_NEAR(kit_value(&kit, stays[k]), end[k], 1e-7);
        }
        kit_free(&kit);
    }
}

static void joints_stay_when_another_is_set_in_whatever_tree(void)
{
    static const char *const planar[] = {"tree joint", "tree absolute",
                                         "tree translation h1 h2; tree rotation a b",
                                         "tree rotation h1 b"};
    static const char *const spatial[] = {"tree joint", "tree absolute", "tree rotation h1 b"};

    expect_joints_to_stay("scene planar\ngravity [0, -9.81]\nbody a mass=2 inertia=0.2\n"
                          "body b mass=1 inertia=0.1\narm a1 a [0, 0.5]\narm a2 a [0, -0.5]\n"
                          "arm b1 b [0, 0.4]\nrevolute h1 ground a1\nrevolute h2 a2 b1\n"
                          "init h1 = 60 deg, h2 = -20 deg, h1' = 1\n",
                          planar, 4);
    expect_joints_to_stay("gravity [0, 0, -9.81]\nbody a mass=2 inertia=[0.2, 0.3, 0.4]\n"
                          "body b mass=1 inertia=[0.1, 0.2, 0.15]\narm a1 a [0, 0.5, 0.1]\n"
                          "arm a2 a [0, -0.5, 0.2]\narm b1 b [0.1, 0.4, 0]\n"
                          "revolute h1 ground a1 axis=x\nrevolute h2 a2 b1 axis=[0, 1, 1]\n"
                          "init h1 = 60 deg, h2 = -20 deg, h1' = 1\n",
                          spatial, 3);
}

/* where neither what is set nor what stays decides, whatever the tree */
static void an_event_that_leaves_joints_open_is_refused(void)
{
    static const char *const trees[] = {"tree joint", "tree absolute", "tree rotation h1 b"};

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "scene planar\nbody a mass=2 inertia=0.2\nbody b mass=1 inertia=0.1\n"
                          "arm a2 a [1, 0]\narm b1 b [-1, 0]\nrevolute h1 ground a\n"
                          "revolute h2 a2 b1\ninit h1 = 0.3, h2 = 0.5, h1' = 1");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "event e when=t > 0.1 b.y=0.5");
        EXPECT(kit_do(&kit, "simulate 0.2") == CT_FAILED);
        EXPECT_HOLDS(kit.error.message, "at t = 0.1 s: event e doesn't determine where h1 goes");
        EXPECT_HOLDS(kit.error.hint, "h1=h1 stays");
        EXPECT_DONE(&kit, "event e when=t > 0.1 b.y=0.5 h2=h2\nsimulate 0.1001");
        EXPECT_NEAR(kit_value(&kit, "b.y"), 0.5, 1e-3);
        EXPECT_DONE(&kit, "event e when=t > 0.1 b.y=0.5 b.x=1\nsimulate 0.1001");
        EXPECT_NEAR(kit_value(&kit, "b.x"), 1, 1e-3);
        kit_free(&kit);
    }
}

/* A slider at the end of its way has no speed, and tells none of the crank. */
static void an_event_that_leaves_rates_open_is_refused(void)
{
    static const char *const trees[] = {"tree joint", "tree absolute"};

    for (int i = 0; i < 2; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "scene planar\nbody a mass=2 inertia=0.2\nbody b mass=1 inertia=0.1\n"
                          "body c mass=1\narm a2 a [1, 0]\narm b1 b [-1, 0]\narm b2 b [1, 0]\n"
                          "revolute h1 ground a\nrevolute h2 a2 b1\nrevolute h3 b2 c\n"
                          "prismatic s ground c axis=x\ninit h1 = 0.3, h1' = 1");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "event e when=t > 0.1 s=3");
        EXPECT(kit_do(&kit, "simulate 0.2") == CT_FAILED);
        EXPECT_HOLDS(kit.error.message, "at t = 0.1 s: event e sets a singular position");
        EXPECT_HOLDS(kit.error.hint, "rates that the event gives, too");
        EXPECT_DONE(&kit, "event e when=t > 0.1 s=3 h1'=0.5\nsimulate 0.1001");
        EXPECT_NEAR(kit_value(&kit, "h1'"), 0.5, 1e-3);
        EXPECT_DONE(&kit, "event e when=t > 0.1 h1=0 h2=0\nsimulate 0.1001");
        EXPECT_NEAR(kit_value(&kit, "s"), 3, 1e-4);
        kit_free(&kit);
    }
}

/* An attitude that is set keeps its angular velocity in its own axes, the joint its angle and rate,
 * and the body that is named its place. */
static void a_floating_chain_turns_with_the_body_that_is_named(void)
{
    static const char *const trees[] = {"tree joint", "tree absolute",
                                        "tree rotation b h; tree translation a h"};
    static const char *const stay[] = {"b.Wx", "b.Wy", "b.Wz", "b.x", "b.z", "b.vx", "h", "h'"};

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();
        double before[8];

        EXPECT_DONE(&kit, "body a mass=2 inertia=[0.2, 0.3, 0.4]\n"
                          "body b mass=1 inertia=[0.1, 0.2, 0.15]\narm a2 a [0, -0.5, 0.2]\n"
                          "arm b1 b [0.1, 0.4, 0]\nrevolute h a2 b1 axis=[0, 1, 1]\n"
                          "init h = 0.4, h' = 0.5, a.vx = 0.3, a.wz = 0.7");
        EXPECT_DONE(&kit, trees[i]);
        EXPECT_DONE(&kit, "simulate 0.2 rtol=1e-11 atol=1e-12");
        for (int k = 0; k < 8; k++)
            before[k] = kit_value(&kit, stay[k]);
        EXPECT_DONE(&kit, "event turn when=t > 0.2 b.q0=cos(0.6) b.q1=sin(0.6) b.q2=0 b.q3=0\n"
                          "simulate 0.3 every=0.1 rtol=1e-11 atol=1e-12");
        for (int k = 0; k < 8; k++) {
            char at[40];

            (void)snprintf(at, sizeof at, "%s at 0.2", stay[k]);
            EXPECT_NEAR(kit_value(&kit, at), before[k], 1e-8);
        }
        EXPECT_NEAR(fabs(kit_value(&kit, "b.q1 at 0.2")), sin(0.6), 1e-8);
        kit_free(&kit);
    }
}

/* in Euler parameters the rates of coordinates are no speeds */
static void a_spinning_body_is_stopped(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "body b mass=1 inertia=[1, 2, 3]\nspherical j ground b\n"
                      "init b.wx = 0.1, b.wz = 2\nevent halt when=t > 1 b.wz=0\nsimulate 2");
    EXPECT_NEAR(kit_value(&kit, "b.wz at 1"), 0, 1e-9);
    EXPECT(fabs(kit_value(&kit, "b.wz at 0.99")) > 1);
    EXPECT_NEAR(kit_value(&kit, "j.q0^2 + j.q1^2 + j.q2^2 + j.q3^2"), 1, 1e-12);
    kit_free(&kit);
}

static void energy_that_events_take_is_no_drift(void)
{
    Kit kit = kit_new();
    const char *at;

    EXPECT_DONE(&kit, BALL BOUNCE "simulate 3\nshow run");
    at = kit.text != NULL ? strstr(kit.text, "energy drift") : NULL;
    EXPECT(at != NULL && strtod(at + strcspn(at, "0123456789"), NULL) < 1e-9);
    kit_free(&kit);
}

/* --- without end --- */

/* capacitors that fall and bounce as a ball does: no equations hold such a state */
static void states_that_pile_up_end_with_a_message(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "capacitor C2 b 0 1\nisource J2 0 b -9.81\n"
                      "capacitor C1 a 0 1\nisource J1 0 a C2.v\ninit C1.v = 1, C2.v = 0\n"
                      "event hit when=C1.v < 0 C2.v=-0.8*C2.v");
    EXPECT(kit_do(&kit, "simulate 10 every=0.01") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "event hit happens without end: C1.v < 0 became true");
    EXPECT(kit.error.hint[0] != '\0');
    /* what was computed is kept: up to 9 times the first fall */
    EXPECT_NEAR(kit_value(&kit, "t"), 9 * sqrt(2 / 9.81), 0.01);
    EXPECT(kit_value(&kit, "min(C1.v)") > -1e-6);
    kit_free(&kit);
}

static void events_that_set_each_other_off_end_with_a_message(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, CARTS "init s1' = 1\nevent to when=s1 > 1 s1=0 s2=2\n"
                            "event fro when=s2 > 1 s2=0 s1=2");
    EXPECT(kit_do(&kit, "simulate 2") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "at t = 1 s: event");
    EXPECT_HOLDS(kit.error.message, "without end");
    kit_free(&kit);
}

static void new_values_against_the_constraints_end_with_a_message(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE CRANK_START "event far when=t > 0.05 s11=3");
    EXPECT(kit_do(&kit, "simulate 1") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "at t = 0.05 s: the new values of event far can't be met");
    EXPECT_DONE(&kit, "event far when=t > 0.05 s11'=3 h8'=3");
    EXPECT(kit_do(&kit, "simulate 1") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "can't be met");
    kit_free(&kit);
}

/* --- driven runs --- */

#define TURNING                                                                                    \
    "scene planar\nbody m1 mass=1\narm p m1 [-0.5, 0]\nrevolute h1 ground p\n"                     \
    "driver D1 h1 = 2*pi*t\n"

static void driven_runs_mark_and_stop(void)
{
    static const char *const verbs[] = {"kinematics", "inverse"};

    for (int i = 0; i < 2; i++) {
        Kit kit = kit_new();
        char line[60];

        EXPECT_DONE(&kit, TURNING "event left when=m1.x < 0\nevent end when=t > 1 && m1.y > 0.25 "
                                  "do=stop\nevent pull when=m1.ax > 0");
        (void)snprintf(line, sizeof line, "%s 3 every=0.1", verbs[i]);
        EXPECT_DONE(&kit, line);
        EXPECT_HOLDS(ct_remarks(kit.session), "event end ended the run at t = 1.08333333 s");
        EXPECT_NEAR(time_of(&kit, "left", 0), 0.25, 1e-9);
        EXPECT_NEAR(time_of(&kit, "pull", 0), 0.25, 1e-9);
        EXPECT_NEAR(kit_value(&kit, "t"), 1 + 1. / 12, 1e-14);
        EXPECT_NEAR(kit_value(&kit, "m1.y"), 0.25, 1e-14);
        EXPECT_DONE(&kit, "event at0 when=m1.x > 0 do=stop");
        EXPECT_DONE(&kit, line);
        EXPECT_NEAR(kit_value(&kit, "t"), 0, 0);
        EXPECT_DONE(&kit, "delete at0\nevent set when=t > 1 h1=0");
        EXPECT(kit_do(&kit, line) == CT_FAILED);
        EXPECT_HOLDS(kit.error.message, "event set: new values are for `simulate`");
        kit_free(&kit);
    }
}

static void what_an_inverse_run_finds_later_can_be_no_condition(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, MOTOR_ARM "delete V1\nvsource V2 e 0 0\ndriver D1 theta = sin(t) by=V2\n"
                                "event hot when=M7.i > 1 do=stop\nevent far when=theta > 0.5");
    EXPECT(kit_do(&kit, "inverse 1 every=0.1") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "event hot: forces, currents and voltages are found after");
    EXPECT_DONE(&kit, "delete hot\ninverse 1 every=0.1");
    EXPECT_NEAR(time_of(&kit, "far", 0), M_PI / 6, 1e-9);
    kit_free(&kit);
}

/* --- the model --- */

static void events_belong_to_the_model(void)
{
    Kit kit = kit_new();
    char *saved;

    EXPECT_DONE(&kit, BALL "event e1 when=s1 < 0.1 do=stop\nv0 = 2\n"
                           "event e2 when=s1 < v0/4 s1'=0 s1=20 mm\ndelete e1\nundo\nshow events");
    EXPECT_HOLDS(kit.text, "e1  s1 < 0.1   stops the run\n");
    EXPECT_HOLDS(kit.text, "e2  s1 < v0/4  s1' = 0, s1 = ");
    EXPECT_DONE(&kit, "redo\nshow events");
    EXPECT(strstr(kit.text, "e1") == NULL);
    /* the same name again is the same event */
    EXPECT_DONE(&kit, "event e2 when=t > 1 do=mark\ninfo e2");
    EXPECT_HOLDS(kit.text, "e2: event, when t > 1: marks\nmade by: event e2 when=t > 1 do=mark\n");
    EXPECT_DONE(&kit, "undo\ninfo e2");
    EXPECT_HOLDS(kit.text, "e2: event, when s1 < v0/4: s1' = 0, s1 = ");
    saved = ct_save(kit.session);
    EXPECT_HOLDS(saved, "event e2 when=s1 < v0/4 s1'=0 s1=20 mm\n");
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, saved);
    EXPECT_DONE(&kit, "simulate 1\nshow events");
    EXPECT_HOLDS(kit.text, "in the last run");
    ct_free(saved);
    EXPECT(kit_do(&kit, "delete s1") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "s1 is used by e2");
    EXPECT(kit_do(&kit, "delete v0") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "v0 is used by e2");
    EXPECT(kit_do(&kit, "print e2") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "e2 is an event, no variable");
    EXPECT_DONE(&kit, "delete e2\ndelete v0\nshow events");
    EXPECT_HOLDS(kit.text, "in the last run:\n  e2  ");
    EXPECT_DONE(&kit, "clear\nshow events");
    EXPECT_HOLDS(kit.text, "no events\n");
    kit_free(&kit);
}

static void a_new_value_of_a_parameter_counts_without_a_new_event(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL "low = 0.5\nevent e when=s1 < low do=stop\nsimulate 1");
    EXPECT_NEAR(kit_value(&kit, "s1"), 0.5, 1e-12);
    EXPECT_DONE(&kit, "low = 0.25\nsimulate 1");
    EXPECT_NEAR(kit_value(&kit, "s1"), 0.25, 1e-12);
    kit_free(&kit);
}

static void an_estimate_of_the_error_follows_events_too(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL BOUNCE "simulate 2 every=0.1 check=on\nshow run");
    EXPECT_HOLDS(kit.text, "global error");
    EXPECT(strstr(kit.text, "not resolved") == NULL);
    EXPECT_NEAR(time_of(&kit, "hit", 2), 1.7519117270246358, 1e-9);
    EXPECT(isnan(time_of(&kit, "hit", 3)));
    kit_free(&kit);
}

static void words_are_offered(void)
{
    Kit kit = kit_new();
    const char *line = "event e1 d";
    size_t start;
    char **words;

    EXPECT_DONE(&kit, BALL "event e1 when=s1 < 0");
    words = ct_complete(kit.session, line, strlen(line), &start);
    EXPECT_TEXT(words[0], "do=");
    ct_words_free(words);
    words = ct_complete(kit.session, "event e1 do=s", 13, &start);
    EXPECT_TEXT(words[0], "stop");
    ct_words_free(words);
    words = ct_complete(kit.session, "delete e", 8, &start);
    EXPECT_TEXT(words[0], "e1");
    ct_words_free(words);
    kit_free(&kit);
}

/* --- what is refused --- */

static void wrong_statements_are_refused_at_their_place(void)
{
    static const struct {
        const char *line, *message;
        int column;
    } wrong[] = {
        {"event e1 do=stop", "event e1 needs a condition", 7},
        {"event s1 when=t > 1", "'s1' is already a prismatic", 7},
        {"event t when=t > 1", "'t' can't be redefined", 7},
        {"event a when=t > 1", "'a' is already a terminal", 7},
        {"event e1 when=s1", "this is no condition", 15},
        {"event e1 when=1 > 0", "this can't become true during a run", 15},
        {"event e1 when=k > 0", "this can't become true during a run", 15},
        {"event e1 when=s1 == 1", "are equal between two numbers", 18},
        {"event e1 when=t > 1 && s1 != 1", "are equal between two numbers", 27},
        {"event e1 when=s2 > 0", "unknown name 's2'", 15},
        {"event e1 when=max(s1) > 0", "max of one argument is taken over a run", 15},
        {"event e1 when=run1.s1 > 0", "run1.s1 is of a run", 15},
        {"event e1 when=t > 1 do=go", "do= is stop or mark", 24},
        {"event e1 when=t > 1 do=stop s1=0", "event e1 has both do= and new values", 7},
        {"event e1 when=t > 1 k=2", "k is a parameter, no variable", 21},
        {"event e1 when=t > 1 t=0", "unknown name 't'", 21},
        {"event e1 when=t > 1 s1''=0", "s1'' can't be given: it follows from the rest", 21},
        {"event e1 when=t > 1 s1.fy=0", "s1.fy can't be given: it follows from the rest", 21},
        {"event e1 when=t > 1 s1=1 kg", "m expected for s1, got kg", 26},
        {"event e1 when=t > 1 s1=[1, 2]", "one number is expected here", 24},
        {"event e1 when=t > 1 s1=0 s1=1", "'s1' is given twice", 26},
        {"event e1 when=t > 1 s1=0 m1.y=0 m1.y=1", "is given twice", 33},
    };
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL "k = 3\nresistor R a 0 1\nvsource V a 0 1");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        EXPECT(kit_do(&kit, wrong[i].line) == CT_FAILED);
        EXPECT_HOLDS(kit.error.message, wrong[i].message);
        if (kit.error.column != wrong[i].column) {
            test_faults++;
            printf("%s: column %d\n", wrong[i].line, kit.error.column);
        }
    }
    EXPECT_DONE(&kit, "show events");
    EXPECT_TEXT(kit.text, "no events\n");
    kit_free(&kit);
}

static void what_follows_from_the_rest_is_refused_by_the_run(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource V1 a 0 10\nresistor R1 a b 1\nresistor R2 b 0 1\n"
                      "event e when=t > 1 R1.i=0");
    EXPECT(kit_do(&kit, "simulate 2") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "event e: R1.i follows from the rest and can't be set");
    EXPECT_HOLDS(kit.error.hint, "storage");
    EXPECT_DONE(&kit, "event e when=count.mass.add > t");
    EXPECT(kit_do(&kit, "simulate 2") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "event e: ");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_ball_bounces_when_the_closed_form_says);
    RUN(a_fall_stops_at_the_floor);
    RUN(a_stopped_run_goes_on_and_does_not_stop_there_again);
    RUN(marks_lie_at_quarters_of_the_pendulums_period);
    RUN(a_capacitor_that_is_emptied_makes_a_saw_tooth);
    RUN(what_follows_a_source_is_seen_in_every_period);
    RUN(a_condition_may_hold_forces_and_accelerations);
    RUN(an_instant_in_time_is_exact_and_a_row);
    RUN(every_operator_of_conditions_works);
    RUN(what_holds_at_the_start_must_be_false_before_it_happens);
    RUN(a_condition_that_is_met_on_leaving_the_start_happens_there);
    RUN(a_condition_without_a_value_is_not_true);
    RUN(right_hand_sides_are_those_just_before);
    RUN(an_elastic_impact_keeps_momentum_and_energy);
    RUN(constraints_hold_after_new_values_in_whatever_tree);
    RUN(a_position_can_be_set_and_the_rest_follows);
    RUN(joints_stay_when_another_is_set_in_whatever_tree);
    RUN(an_event_that_leaves_joints_open_is_refused);
    RUN(an_event_that_leaves_rates_open_is_refused);
    RUN(a_floating_chain_turns_with_the_body_that_is_named);
    RUN(a_spinning_body_is_stopped);
    RUN(energy_that_events_take_is_no_drift);
    RUN(states_that_pile_up_end_with_a_message);
    RUN(events_that_set_each_other_off_end_with_a_message);
    RUN(new_values_against_the_constraints_end_with_a_message);
    RUN(driven_runs_mark_and_stop);
    RUN(what_an_inverse_run_finds_later_can_be_no_condition);
    RUN(events_belong_to_the_model);
    RUN(a_new_value_of_a_parameter_counts_without_a_new_event);
    RUN(an_estimate_of_the_error_follows_events_too);
    RUN(words_are_offered);
    RUN(wrong_statements_are_refused_at_their_place);
    RUN(what_follows_from_the_rest_is_refused_by_the_run);
    return test_end();
}
