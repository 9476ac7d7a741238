/* test_stops.c: rigid and compliant stops, backlash, rigid one-way clutches, against closed forms
 */
#include "session_kit.h"

#include "base/random.h"
#include "base/text.h"

#define G 9.81
#define BALL                                                                                       \
    "scene planar; gravity [0, -9.81]\nbody m mass=1 inertia=0.1\nprismatic s ground m axis=y\n"
#define PAIR                                                                                       \
    "scene planar\nbody a mass=%g inertia=0.1\nbody b mass=%g inertia=0.1\n"                       \
    "prismatic s1 ground a axis=x\nprismatic s2 ground b axis=x\n"

static bool is_near(double got, double expected, double within)
{
    return fabs(got - expected) <= within * (1 + fabs(expected));
}

/* a ball falls from 1 m: it is at rest after t1 (1 + e)/(1 - e) */
static void a_ball_comes_to_rest(void)
{
    static const double e[] = {0, 0.5, 0.8, 0.95};
    const double fall = sqrt(2 / G);

    for (int i = 0; i < 4; i++) {
        const double rest = fall * (1 + e[i]) / (1 - e[i]);
        Kit kit = kit_new();
        char text[400];

        (void)snprintf(text, sizeof text,
                       BALL "stop floor s low=0 e=%g\ninit s = 1, s' = 0\nsimulate %.17g\n", e[i],
                       rest + 1);
        EXPECT_DONE(&kit, text);
        if (e[i] > 0) {
            const char *report = strstr(ct_remarks(kit.session), "at rest from t = ");

            EXPECT(report != NULL);
            if (report != NULL)
                EXPECT(is_near(strtod(report + strlen("at rest from t = "), NULL), rest, 1e-8));
        }
        EXPECT(is_near(kit_value(&kit, "s"), 0, 1e-10));
        EXPECT(kit_value(&kit, "s'") == 0);
        EXPECT(is_near(kit_value(&kit, "floor.effort"), G, 1e-12));
        kit_free(&kit);
    }
}

/* the height of each flight is e^2 of the one before */
static void flights_become_lower(void)
{
    const double fall = sqrt(2 / G), e = 0.8;
    double start = fall, flight = 2 * e * fall;
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL "stop floor s low=0 e=0.8\ninit s = 1, s' = 0\nsimulate 3 rtol=1e-10\n");
    for (int k = 1; k < 5; k++) {
        char text[80];

        (void)snprintf(text, sizeof text, "s at %.17g", start + flight / 2);
        EXPECT(is_near(kit_value(&kit, text), pow(e, 2 * k), 1e-8));
        (void)snprintf(text, sizeof text, "s' at %.17g", start + flight / 4);
        EXPECT(is_near(kit_value(&kit, text), G * flight / 4, 1e-7));
        start += flight;
        flight *= e;
    }
    kit_free(&kit);
}

/* between two walls it goes to and fro: place by reflection */
static void between_two_walls(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody m mass=2 inertia=0\nprismatic s ground m axis=x\n"
                      "stop w s low=-0.3 high=0.5 e=1\ninit s = 0.1, s' = 3\n"
                      "simulate 7.13 rtol=1e-10\n");
    /* 21.39 m of way, 1.6 m a period; the first 0.4 m to the right */
    EXPECT(is_near(kit_value(&kit, "s"),
                   0.5 - (fmod(21.39 - 0.4, 1.6) > 0.8 ? 1.6 - fmod(21.39 - 0.4, 1.6)
                                                       : fmod(21.39 - 0.4, 1.6)),
                   1e-9));
    EXPECT(is_near(fabs(kit_value(&kit, "s'")), 3, 1e-12));
    EXPECT(is_near(kit_value(&kit, "energy.kinetic"), 9, 1e-12));
    kit_free(&kit);
}

/* two masses with play: momentum is kept, the relative speed reversed by e */
static void masses_meet_over_backlash(void)
{
    static const double e[] = {0, 0.4, 1};

    for (int i = 0; i < 3; i++) {
        const double m1 = 1.5, m2 = 4, v = 2, gap = 0.1;
        const double mean = m1 * v / (m1 + m2);
        const double v1 = mean - e[i] * v * m2 / (m1 + m2), v2 = mean + e[i] * v * m1 / (m1 + m2);
        const double t = gap / 2 / v;
        Kit kit = kit_new();
        char text[600];

        (void)snprintf(text, sizeof text,
                       PAIR "backlash g s1 s2 gap=0.1 e=%g\n"
                            "init s1 = 0, s2 = 0, s1' = 2, s2' = 0\nsimulate 0.04 rtol=1e-10\n",
                       m1, m2, e[i]);
        EXPECT_DONE(&kit, text);
        EXPECT(is_near(kit_value(&kit, "s1'"), v1, 1e-10));
        EXPECT(is_near(kit_value(&kit, "s2'"), v2, 1e-10));
        EXPECT(is_near(kit_value(&kit, "s1"), v * t + v1 * (0.04 - t), 1e-9));
        EXPECT(is_near(kit_value(&kit, "s2"), v2 * (0.04 - t), 1e-9));
        kit_free(&kit);
    }
}

/* a rod that hangs is turned against a stop at angle `at`; the tree doesn't matter */
static void a_rod_in_two_trees(void)
{
    static const char *const trees[] = {"", "tree absolute\n", "tree absolute\nform embedded\n"};
    const double length = 0.8, at = 0.35, from = 1.2, e = 0.6;
    const double weight = 1.3 * G * length / 2, inertia = 1.3 * length * length / 3;
    const double speed = sqrt(2 * weight * (cos(at) - cos(from)) / inertia);
    const double back = acos(cos(at) - inertia * e * e * speed * speed / (2 * weight));

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();
        char text[600];

        (void)snprintf(text, sizeof text,
                       "scene planar; gravity [0, -9.81]\n"
                       "body r mass=1.3 inertia=1.3*0.8^2/12\narm top r [0, 0.4]\n"
                       "revolute h ground top\nstop w h low=%.17g e=0.6\n%s"
                       "init h = 1.2, h' = 0\nsimulate 1.1 rtol=1e-10 atol=1e-12\n",
                       at, trees[i]);
        EXPECT_DONE(&kit, text);
        /* it turns at `back` behind the first impact */
        EXPECT(is_near(kit_value(&kit, "max(if(t > 0.5, h, 0))"), back, 1e-7));
        kit_free(&kit);
    }
}

/* A mass on a rope in free fall is stopped by the rope and swings: the rope is a stop of the
 * distance, and its force that of a pendulum. */
static void a_rope_becomes_tight(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar; gravity [0, -9.81]\nbody m mass=2 inertia=0.1\n"
                      "planarjoint j ground m\nstop rope ground m high=1 e=0\n"
                      "init j.s1 = 0.6, j.s2 = 0, j.s1' = 0, j.s2' = 0, j.theta = 0, j.theta' = 0\n"
                      "simulate 0.6 rtol=1e-10 atol=1e-12\n");
    {
        /* it falls to y = -0.8, and keeps the speed across the rope; then a pendulum */
        const double v = sqrt(2 * G * 0.8) * 0.6;
        const double x = kit_value(&kit, "j.s1"), y = kit_value(&kit, "j.s2");
        const double vx = kit_value(&kit, "j.s1'"), vy = kit_value(&kit, "j.s2'");
        const double speed = v * v + 2 * G * (-0.8 - y);

        EXPECT(is_near(hypot(x, y), 1, 1e-9));
        EXPECT(is_near(vx * vx + vy * vy, speed, 1e-8));
        EXPECT(is_near(kit_value(&kit, "-rope.effort"), 2 * (speed - G * y), 1e-7));
    }
    kit_free(&kit);
}

/* pulled back by a spring it leaves a stop where the spring no longer presses */
static void it_leaves_a_stop(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody m mass=1 inertia=0\nprismatic s ground m axis=x\n"
                      "stop w s low=0\nactuator f s force=-1 + t\ninit s = 0, s' = 0\n"
                      "simulate 2.5 rtol=1e-10\n");
    EXPECT(is_near(kit_value(&kit, "s"), pow(1.5, 3) / 6, 1e-9));
    EXPECT(is_near(kit_value(&kit, "w.effort at 0.25"), 0.75, 1e-10));
    kit_free(&kit);
}

/* a spring of the stop, half a period of contact */
static void a_compliant_stop(void)
{
    const double k = 400, w = 20, v = 3;
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody m mass=1 inertia=0\nprismatic s ground m axis=x\n"
                      "stop w s high=0.3 k=400\ninit s = 0, s' = 3\nsimulate 0.5 rtol=1e-10\n");
    EXPECT(is_near(kit_value(&kit, "max(s)"), 0.3 + v / w, 1e-8));
    EXPECT(is_near(kit_value(&kit, "-min(w.effort)"), k * v / w, 1e-7));
    EXPECT(is_near(kit_value(&kit, "s"), 0.3 - v * (0.5 - 0.1 - M_PI / w), 1e-8));
    kit_free(&kit);
}

/* With damping it leaves where the force would pull: at d/2m = a, frequency n, that is where
 * tan(n t) = 2 a n/(a^2 - n^2). */
static void a_compliant_stop_with_damping(void)
{
    const double k = 400, d = 8, a = d / 2, n = sqrt(k - a * a), v = 3;
    const double t = (M_PI - atan2(2 * a * n, n * n - a * a)) / n;
    const double speed = v * exp(-a * t) * (cos(n * t) - a / n * sin(n * t));
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nbody m mass=1 inertia=0\nprismatic s ground m axis=x\n"
                      "stop w s high=0.3 k=400 d=8\ninit s = 0, s' = 3\nsimulate 0.5 rtol=1e-10\n");
    EXPECT(is_near(kit_value(&kit, "s'"), speed, 1e-8));
    EXPECT(is_near(kit_value(&kit, "min(-w.effort)"), 0, 1e-8));
    kit_free(&kit);
}

/* J1 driven by 10 sin(t) drives J2 along, and runs slower where the torque turns */
static void a_rigid_one_way_clutch(void)
{
    const double J1 = 0.5, J = 1.5, T = 10;
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "flywheel J1 a 0 J=0.5\nflywheel J2 b 0 J=1\ntorquesource T1 a 0 10*sin(t)\n"
                      "oneway o1 a b\ninit J1.w = 0, J2.w = 0\nsimulate 4 rtol=1e-10\n");
    /* together until T is 0 at pi */
    EXPECT(is_near(kit_value(&kit, "J2.w at 2"), T * (1 - cos(2)) / J, 1e-9));
    EXPECT(is_near(kit_value(&kit, "J2.w"), 2 * T / J, 1e-9));
    EXPECT(is_near(kit_value(&kit, "J1.w"), 2 * T / J - T * (1 + cos(4)) / J1, 1e-8));
    EXPECT(is_near(kit_value(&kit, "o1.torque at 1"), T * sin(1) / J * 1, 1e-8));
    kit_free(&kit);
}

/* A mass between stops that rubs, in bounces that become short beside errors: it never passes them,
 * and rests on one until its force turns. */
static void stops_beside_friction(void)
{
    static const char *const methods[] = {"dop853", "radau", "bdf", "ida"};
    double first = 0;

    for (int i = 0; i < 4; i++) {
        Kit kit = kit_new();
        char text[600];

        (void)snprintf(text, sizeof text,
                       PAIR "actuator l s1 force=2.4 + 10*sin(3.7*t + 5.8)\n"
                            "spring k s1 k=12\nspring m s2 k=18\nfriction f s1 force=4\n"
                            "friction g s2 force=1.4\nclutch c s2 s1 force=1.6\n"
                            "stop w s1 low=-0.064 high=0.064 e=0.44\n"
                            "init s1 = 0, s1' = 0, s2 = 0, s2' = 0\n"
                            "simulate 2.1 method=%s rtol=1e-8\n",
                       1.6, 3.3, methods[i]);
        EXPECT_DONE(&kit, text);
        EXPECT(is_near(kit_value(&kit, "max(s1)"), 0.064, 1e-8));
        first = i == 0 ? kit_value(&kit, "s1'") : first;
        EXPECT(is_near(kit_value(&kit, "s1'"), first, 1e-5));
        kit_free(&kit);
    }
}

/* A diode turns off while the wheel that its current drove rests on a stop. */
static void a_stop_holds_while_a_diode_turns_off(void)
{
    static const char *const methods[] = {"dop853", "bdf", "adams"};

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();
        char text[600];

        (void)snprintf(text, sizeof text,
                       "scene planar\nbody a mass=1 inertia=1.03\nrevolute h ground a\n"
                       "actuator l h torque=-5.67 + 7.75*sin(6.3*t + 1.27)\n"
                       "friction f h torque=1.76\nstop w h low=-0.2328 high=0.2328 e=0.376\n"
                       "vsource V p 0 5.26*sin(13.65*t)\ndiode D p q\n"
                       "motor M h q 0 R=2.2 L=0.122 Kt=0.488\ninit h = 0, h' = 0\n"
                       "simulate 0.93 method=%s rtol=1e-8\n",
                       methods[i]);
        EXPECT_DONE(&kit, text);
        EXPECT(is_near(kit_value(&kit, "min(h)"), -0.2328, 1e-8));
        EXPECT(is_near(kit_value(&kit, "h"), -0.2328, 1e-8));
        kit_free(&kit);
    }
}

/* A motor behind a diode presses a shaft that a rigid one-way clutch holds: L i' + R i = V sin(w t)
 * from the start on. */
static void a_diode_turns_on_beside_a_rigid_clutch(void)
{
    static const char *const methods[] = {"dop853", "bdf", "ida", "adams"};

    for (int i = 0; i < 4; i++) {
        Kit kit = kit_new();
        char text[600];

        (void)snprintf(text, sizeof text,
                       "flywheel J a 0 J=4\ntorquesource T a 0 2 + 3*sin(1.8*t)\noneway o a 0\n"
                       "vsource V p 0 12*sin(40*t)\ndiode D p q\nresistor R q n 1.2\n"
                       "inductor L n e 0.09\nvsource E e 0 0.8*J.w\ntorquesource M a 0 0.8*L.i\n"
                       "init J.w = 0, L.i = 0\nsimulate 2 method=%s rtol=1e-9\n"
                       "expect L.i ~ 4.235631219526551 within 1e-6 at 0.06\n"
                       "expect max(J.w) ~ 0 within 1e-9\n",
                       methods[i]);
        EXPECT_DONE(&kit, text);
        kit_free(&kit);
    }
}

/* --- at rest --- */

/* the start of a model is in the mode that it goes on in */
static void a_start_at_rest_is_held(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL "stop floor s low=0 e=0.5\ninit s = 0, s' = 0\nassemble\n");
    EXPECT(is_near(kit_value(&kit, "floor.effort"), G, 1e-12));
    EXPECT(kit_value(&kit, "s''") == 0);
    EXPECT_DONE(&kit, "clear\nscene planar\ngravity [9.81*sin(0.1), -9.81*cos(0.1)]\n"
                      "body m mass=2 inertia=0.1\nprismatic s ground m axis=x\n"
                      "friction f s force=3\ninit s = 0, s' = 0\nassemble\n");
    EXPECT(is_near(kit_value(&kit, "f.effort"), -2 * G * sin(0.1), 1e-12));
    EXPECT(kit_value(&kit, "s''") == 0);
    kit_free(&kit);
}

static void a_ball_lies_on_a_floor_in_equilibrium(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL "stop floor s low=0 e=0.5\nguess s = 1\nequilibrium\n");
    EXPECT(is_near(kit_value(&kit, "s"), 0, 1e-14));
    EXPECT(is_near(kit_value(&kit, "floor.effort"), G, 1e-12));
    /* it remains there */
    EXPECT_DONE(&kit, "simulate 1\n");
    EXPECT(is_near(kit_value(&kit, "s"), 0, 1e-14));
    kit_free(&kit);
}

/* a rope that hangs, and a rod against a stop, in two trees */
static void ropes_and_rods_rest_in_equilibrium(void)
{
    static const char *const trees[] = {"", "tree absolute\n"};
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar; gravity [0, -9.81]\nbody m mass=2 inertia=0.1\n"
                      "planarjoint j ground m\nstop rope ground m high=1 e=0\n"
                      "guess j.s1 = 0.6, j.s2 = -0.2\nequilibrium\n");
    EXPECT(is_near(kit_value(&kit, "j.s1"), 0, 1e-9));
    EXPECT(is_near(kit_value(&kit, "j.s2"), -1, 1e-12));
    EXPECT(is_near(kit_value(&kit, "rope.effort"), -2 * G, 1e-9));
    kit_free(&kit);
    for (int i = 0; i < 2; i++) {
        char text[500];

        kit = kit_new();
        (void)snprintf(text, sizeof text,
                       "scene planar; gravity [0, -9.81]\nbody r mass=1.3 inertia=0.1\n"
                       "arm top r [0, 0.4]\nrevolute h ground top\n%s"
                       "stop w h low=0.35 high=2\nguess h = 1\nequilibrium\n",
                       trees[i]);
        EXPECT_DONE(&kit, text);
        EXPECT(is_near(kit_value(&kit, "h"), 0.35, 1e-12));
        EXPECT(is_near(kit_value(&kit, "w.effort"), 1.3 * G * 0.4 * sin(0.35), 1e-9));
        kit_free(&kit);
    }
}

/* Masses in a row, tied by springs and to ground, each between two stops: their potential energy is
 * convex, and projected coordinate descent finds its least value between the stops. */
static void masses_between_stops_lie_where_their_energy_is_least(void)
{
    enum { COUNT = 6, MODELS = 8 };
    uint64_t seed = 29;

    for (int model = 0; model < MODELS; model++) {
        double k[COUNT], own[COUNT], rest[COUNT], low[COUNT], high[COUNT], x[COUNT] = {0};
        Kit kit = kit_new();
        Text text = {0};

        text_add(&text, "scene planar\n");
        for (int i = 0; i < COUNT; i++) {
            const double middle = random_unit(&seed), width = 0.1 + fabs(random_unit(&seed));

            k[i] = exp(3 * random_unit(&seed) + 4);
            own[i] = exp(3 * random_unit(&seed) + 4);
            rest[i] = 2 * random_unit(&seed);
            low[i] = middle - width / 2;
            high[i] = middle + width / 2;
            text_addf(&text, "body m%d mass=1 inertia=0.1\nprismatic s%d ground m%d axis=x\n", i, i,
                      i);
            text_addf(&text, "spring o%d s%d k=%.17g rest=%.17g\nguess s%d = %.17g\n", i, i, own[i],
                      rest[i], i, middle);
            if (i > 0)
                text_addf(&text,
                          "actuator t%d s%d force=-%.17g*(s%d - s%d)\n"
                          "actuator u%d s%d force=%.17g*(s%d - s%d)\n",
                          i, i, k[i], i, i - 1, i, i - 1, k[i], i, i - 1);
            text_addf(&text, "stop w%d s%d low=%.17g high=%.17g\n", i, i, low[i], high[i]);
        }
        text_add(&text, "equilibrium\n");
        EXPECT_DONE(&kit, text.at);
        for (int sweep = 0; sweep < 20000; sweep++)
            for (int i = 0; i < COUNT; i++) {
                double sum = own[i], pull = own[i] * rest[i];

                if (i > 0) {
                    sum += k[i];
                    pull += k[i] * x[i - 1];
                }
                if (i + 1 < COUNT) {
                    sum += k[i + 1];
                    pull += k[i + 1] * x[i + 1];
                }
                x[i] = fmin(high[i], fmax(low[i], pull / sum));
            }
        for (int i = 0; i < COUNT; i++) {
            char name[20];

            (void)snprintf(name, sizeof name, "s%d", i);
            EXPECT(is_near(kit_value(&kit, name), x[i], 1e-11));
        }
        text_free(&text);
        kit_free(&kit);
    }
}

static void values_are_checked(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BALL);
    EXPECT_FAILS(&kit, "stop w s\n", "w has no limit");
    EXPECT_FAILS(&kit, "stop w s low=0 e=2\n", "is not between 0 and 1");
    EXPECT_FAILS(&kit, "stop w s low=0 e=0.5 k=3\n", "takes e= or k=, not both");
    EXPECT_FAILS(&kit, "stop w s low=0 d=3\n", "d= has no effect without k=");
    EXPECT_FAILS(&kit, "stop w s low=1 high=0\n", "low= is not below high=");
    EXPECT_DONE(&kit, "stop w s low=0.1\n");
    EXPECT_FAILS(&kit, "init s = 0, s' = 0\nsimulate 1\n", "w is 0.1 beyond its limit");
    kit_free(&kit);
    kit = kit_new();
    EXPECT_FAILS(&kit,
                 "flywheel J1 a 0 J=0.5\nflywheel J2 b 0 J=1\noneway o1 a b\n"
                 "init J1.w = 6, J2.w = 0\nsimulate 1\n",
                 "o1 is 6 beyond its limit");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_ball_comes_to_rest);
    RUN(flights_become_lower);
    RUN(between_two_walls);
    RUN(masses_meet_over_backlash);
    RUN(a_rod_in_two_trees);
    RUN(a_rope_becomes_tight);
    RUN(it_leaves_a_stop);
    RUN(a_compliant_stop);
    RUN(a_compliant_stop_with_damping);
    RUN(a_rigid_one_way_clutch);
    RUN(stops_beside_friction);
    RUN(a_stop_holds_while_a_diode_turns_off);
    RUN(a_diode_turns_on_beside_a_rigid_clutch);
    RUN(a_start_at_rest_is_held);
    RUN(a_ball_lies_on_a_floor_in_equilibrium);
    RUN(ropes_and_rods_rest_in_equilibrium);
    RUN(masses_between_stops_lie_where_their_energy_is_least);
    RUN(values_are_checked);
    return test_end();
}
