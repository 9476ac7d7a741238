/* test_friction_by_load.c: friction whose bound follows from the reaction of its joint */
#include "session_kit.h"

#include <string.h>

#define BOB                                                                                        \
    "scene planar; gravity [0, -9.81]\nbody bob mass=2\narm top bob [0, 0.5]\n"                    \
    "revolute h ground top\n"
#define INCLINE                                                                                    \
    "scene planar; gravity [0, -9.81]\nbody m mass=3 inertia=0.1\n"                                \
    "prismatic s ground m axis=[cos(a), sin(a)]\n"
#define RAIL                                                                                       \
    "scene planar; gravity [0, -1]\nbody m mass=1 inertia=0.01\narm p m [0, -0.5]\n"               \
    "prismatic s ground p axis=x\n"

static bool is_near(double got, double expected, double within)
{
    return fabs(got - expected) <= within;
}

/* A point of mass m on a rod l with c = mu*radius. The torque c N of the journal makes the force
 * c N/l across the rod, so N^2 = F_r^2 + (c N/l)^2 with F_r = m (l h'^2 + g cos h) along it. Then
 * h'^2 is the solution of a linear equation in h. */
static void a_pendulum_in_a_journal(void)
{
    const double l = 0.5, c = 0.05, g = 9.81, G = g / l, k = c / l / sqrt(1 - c * c / l / l);
    const double a = 2 * G * (1 - 2 * k * k) / (1 + 4 * k * k), b = -6 * G * k / (1 + 4 * k * k);
    const double start = -M_PI / 3, A = -(a * cos(start) + b * sin(start)) * exp(2 * k * start);
    static const char *const settings[] = {"", "tree absolute\n", "form embedded\n",
                                           "tree absolute\nform embedded\n"};

    for (int i = 0; i < 4; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, BOB "friction f h mu=0.5 radius=0.1\ninit h = -60 deg, h' = 0\n");
        EXPECT_DONE(&kit, settings[i][0] != '\0' ? settings[i] : "print t\n");
        EXPECT_DONE(&kit, "simulate 0.6 rtol=1e-11\n");
        {
            const double h = kit_value(&kit, "h"), rate = kit_value(&kit, "h'");

            EXPECT(rate > 1);
            EXPECT(is_near(rate * rate, A * exp(-2 * k * h) + a * cos(h) + b * sin(h), 1e-7));
            EXPECT(is_near(kit_value(&kit, "f.load"),
                           2 * (l * rate * rate + g * cos(h)) / sqrt(1 - c * c / l / l), 1e-7));
            EXPECT(is_near(kit_value(&kit, "f.effort"), -c * kit_value(&kit, "f.load"), 1e-9));
            EXPECT(
                is_near(kit_value(&kit, "sqrt(h.fx^2 + h.fy^2)"), kit_value(&kit, "f.load"), 1e-9));
        }
        kit_free(&kit);
    }
}

/* it sticks while tan(a) <= static*mu, whatever its mass, and else slides as on a plane with mu */
static void a_block_on_an_incline(void)
{
    static const double angles[] = {0.2, 0.31, 0.33, 0.5};
    static const char *const trees[] = {"", "tree absolute\n"};
    const double mu = 0.3, ratio = 1.1, g = 9.81;

    for (int i = 0; i < 8; i++) {
        const double a = angles[i % 4];
        const double rate = tan(a) > ratio * mu ? g * (sin(a) - mu * cos(a)) : 0;
        Kit kit = kit_new();
        char text[400];

        (void)snprintf(text, sizeof text,
                       "a = %.17g\n" INCLINE "friction f s mu=0.3 static=1.1\n%s"
                       "init s = 0, s' = 0\nsimulate 2\n",
                       a, trees[i / 4]);
        EXPECT_DONE(&kit, text);
        EXPECT(is_near(kit_value(&kit, "s"), -rate * 2, 1e-9));
        EXPECT(is_near(kit_value(&kit, "s'"), -rate * 2, 1e-9));
        EXPECT(is_near(kit_value(&kit, "f.load"), 3 * g * cos(a), 1e-9));
        kit_free(&kit);
    }
}

/* In space, with gravity across the rail in both directions, and a moment over the span: the mass
 * centre is 0.4 m along the rail, so that m g presses with a moment of 0.4 m times as much. */
static void a_slider_in_space(void)
{
    const double across = 2 * sqrt(3 * 3 + 4 * 4), load = across + across * 0.4 / 0.8;
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene spatial; gravity [0, -3, -4]\nbody m mass=2 inertia=[1, 1, 1]\n"
                      "arm p m [-0.4, 0, 0]\nprismatic s ground p axis=x\n"
                      "friction f s mu=0.1 span=0.8\ninit s = 0, s' = 3\nsimulate 1\n");
    EXPECT(is_near(kit_value(&kit, "f.load"), load, 1e-9));
    EXPECT(is_near(kit_value(&kit, "s'"), 3 - 0.1 * load / 2, 1e-9));
    kit_free(&kit);
}

/* a journal in space counts the force along its axis, too */
static void a_journal_in_space(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene spatial; gravity [0, -3, -4]\nbody m mass=2 inertia=[1, 1, 0.5]\n"
                      "revolute h ground m axis=z\nfriction f h mu=0.1 radius=0.2\n"
                      "init h = 0, h' = 3\nsimulate 1\n");
    EXPECT(is_near(kit_value(&kit, "f.load"), 10, 1e-9));
    EXPECT(is_near(kit_value(&kit, "h'"), 3 - 0.1 * 0.2 * 10 / 0.5, 1e-9));
    kit_free(&kit);
}

/* A force F along the rail with the lever 0.5 m: N = F*0.5/span presses. It moves where mu*0.5 is
 * below the span, however large F is. */
static void a_drawer_jams(void)
{
    static const char *const jams[] = {"0.3", "0.15"};

    for (int i = 0; i < 2; i++) {
        Kit kit = kit_new();
        char text[400];

        (void)snprintf(
            text, sizeof text,
            "scene planar\nbody m mass=1 inertia=0.01\narm e m [0, 0.5]\n"
            "prismatic s ground m axis=x\nfriction f s mu=%s span=0.1\nforce F e [7, 0]\n"
            "init s = 0, s' = 0\nsimulate 1\n",
            jams[i]);
        EXPECT_DONE(&kit, text);
        EXPECT(is_near(kit_value(&kit, "s'"), i == 0 ? 0 : 7 * (1 - 0.15 * 5), 1e-9));
        EXPECT(is_near(kit_value(&kit, "f.load"), 35, 1e-9));
        kit_free(&kit);
    }
}

/* Friction 0.5 m off the mass centre presses the rail: |N| + |M|/0.1 with M = 0.5*mu*load, so that
 * no load is in balance from mu = 0.2 on. */
static void self_locking_is_named(void)
{
    static const struct {
        const char *text, *message;
    } locks[] = {
        {RAIL "friction f s mu=0.3 span=0.1\ninit s = 0, s' = 1\nsimulate 1\n",
         "no accelerations can be found at the start"},
        {RAIL "friction f s mu=0.3 span=0.1\nactuator A s force=2*t\ninit s = 0, s' = 0\n"
              "simulate 10\n",
         "no motion leads on from where s' (f) is 0"},
        {RAIL "friction f s mu=0.1*t span=0.1\ninit s = 0, s' = 50\nsimulate 10\n",
         "at t = 2 s: the step became too small"},
    };
    Kit kit = kit_new();

    EXPECT_DONE(&kit, RAIL "friction f s mu=0.1 span=0.1\ninit s = 0, s' = 1\nsimulate 1e-3\n");
    EXPECT(is_near(kit_value(&kit, "f.load"), 1 / (1 - 0.1 * 5), 1e-9));
    kit_free(&kit);
    for (int i = 0; i < (int)(sizeof locks / sizeof locks[0]); i++) {
        kit = kit_new();
        EXPECT_FAILS(&kit, locks[i].text, locks[i].message);
        EXPECT_HOLDS(kit.error.hint, "self-locking of f");
        kit_free(&kit);
    }
}

/* --- a four-bar against accelerations and forces of bodies, with the loads iterated --- */

enum { EQUATIONS = 17 };

static void eliminate(double a[EQUATIONS][EQUATIONS + 1], double *x)
{
    for (int k = 0; k < EQUATIONS; k++) {
        int pivot = k;

        for (int i = k + 1; i < EQUATIONS; i++)
            pivot = fabs(a[i][k]) > fabs(a[pivot][k]) ? i : pivot;
        for (int j = 0; j <= EQUATIONS; j++) {
            const double kept = a[k][j];

            a[k][j] = a[pivot][j];
            a[pivot][j] = kept;
        }
        for (int i = 0; i < EQUATIONS; i++) {
            const double part = i == k ? 0 : a[i][k] / a[k][k];

            for (int j = k; j <= EQUATIONS && part != 0; j++)
                a[i][j] -= part * a[k][j];
        }
    }
    for (int k = 0; k < EQUATIONS; k++)
        x[k] = a[k][EQUATIONS] / a[k][k];
}

/* Bars 0, 1, 2 with half lengths, angles and rates; joint j leads from bar j - 1 (or the ground) to
 * bar j (or the ground), 3 with the ends reversed: D is at the tail end of bar 2. x: accelerations
 * ax, ay, alpha of each bar, forces on the later bar (of D on bar 2) in each joint. */
static void four_bar_loads(const double *mass, const double *inertia, const double *half,
                           const double *angle, const double *rate, double c, double *load,
                           double *alpha)
{
    static const int before[] = {-1, 0, 1, -1}, after[] = {0, 1, 2, 2};
    static const int end_before[] = {0, 1, 1, 0}, end_after[] = {-1, -1, 1, -1};

    for (int j = 0; j < 4; j++)
        load[j] = 0;
    for (int turn = 0; turn < 200; turn++) {
        double a[EQUATIONS][EQUATIONS + 1] = {{0}}, x[EQUATIONS];

        for (int i = 0; i < 3; i++) {
            a[3 * i][3 * i] = a[3 * i + 1][3 * i + 1] = mass[i];
            a[3 * i + 2][3 * i + 2] = inertia[i];
            a[3 * i + 1][EQUATIONS] = -mass[i] * 9.81;
        }
        for (int j = 0; j < 4; j++) {
            const double slip = rate[after[j]] - (before[j] >= 0 ? rate[before[j]] : 0);
            const double torque = -c * load[j] * (slip > 0 ? 1 : -1);

            for (int side = 0; side < 2; side++) {
                const int bar = side == 0 ? before[j] : after[j], sign = side == 0 ? -1 : 1;
                const double arm = side == 0 ? end_before[j] : end_after[j];
                double rx, ry;

                if (bar < 0)
                    continue;
                rx = arm * half[bar] * cos(angle[bar]);
                ry = arm * half[bar] * sin(angle[bar]);
                /* force on the later bar, its reverse on the earlier one */
                a[3 * bar][9 + 2 * j] = -sign;
                a[3 * bar + 1][10 + 2 * j] = -sign;
                a[3 * bar + 2][9 + 2 * j] = sign * ry;
                a[3 * bar + 2][10 + 2 * j] = -sign * rx;
                a[3 * bar + 2][EQUATIONS] += sign * torque;
                /* both ends have one acceleration */
                a[9 + 2 * j][3 * bar] = sign;
                a[9 + 2 * j][3 * bar + 2] = -sign * ry;
                a[9 + 2 * j][EQUATIONS] += sign * rate[bar] * rate[bar] * rx;
                a[10 + 2 * j][3 * bar + 1] = sign;
                a[10 + 2 * j][3 * bar + 2] = sign * rx;
                a[10 + 2 * j][EQUATIONS] += sign * rate[bar] * rate[bar] * ry;
            }
        }
        eliminate(a, x);
        for (int j = 0; j < 4; j++)
            load[j] = hypot(x[9 + 2 * j], x[10 + 2 * j]);
        *alpha = x[2];
    }
}

static void a_four_bar_with_four_journals(void)
{
    static const char *const settings[] = {"print t\n", "tree absolute\n", "form embedded\n"};
    static const char *const angles[] = {"b1.theta", "b2.theta", "b3.theta"};
    const double mass[] = {1, 2, 1.5}, inertia[] = {0.02, 0.1, 0.06}, half[] = {0.15, 0.4, 0.3};

    for (int i = 0; i < 3; i++) {
        double angle[3], rate[3], load[4], alpha;
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "scene planar; gravity [0, -9.81]\n"
                          "body b1 mass=1 inertia=0.02\narm a1 b1 [-0.15, 0]\narm c1 b1 [0.15, 0]\n"
                          "body b2 mass=2 inertia=0.1\narm a2 b2 [-0.4, 0]\narm c2 b2 [0.4, 0]\n"
                          "body b3 mass=1.5 inertia=0.06\narm a3 b3 [-0.3, 0]\narm c3 b3 [0.3, 0]\n"
                          "arm g ground [0.9, 0]\nrevolute A ground a1\nrevolute B c1 a2\n"
                          "revolute C c2 c3\nrevolute D g a3\n"
                          "friction fA A mu=0.4 radius=0.05\nfriction fB B mu=0.4 radius=0.05\n"
                          "friction fC C mu=0.4 radius=0.05\nfriction fD D mu=0.4 radius=0.05\n");
        EXPECT_DONE(&kit, settings[i]);
        EXPECT_DONE(&kit, "init A = 60 deg, A' = 5\nguess B = -40 deg, D = 110 deg\n"
                          "simulate 0.2 rtol=1e-11\n");
        for (int k = 0; k < 3; k++) {
            char name[32];

            (void)snprintf(name, sizeof name, "%s'", angles[k]);
            angle[k] = kit_value(&kit, angles[k]);
            rate[k] = kit_value(&kit, name);
        }
        four_bar_loads(mass, inertia, half, angle, rate, 0.02, load, &alpha);
        EXPECT(is_near(kit_value(&kit, "fA.load"), load[0], 1e-7));
        EXPECT(is_near(kit_value(&kit, "fB.load"), load[1], 1e-7));
        EXPECT(is_near(kit_value(&kit, "fC.load"), load[2], 1e-7));
        EXPECT(is_near(kit_value(&kit, "fD.load"), load[3], 1e-7));
        EXPECT(is_near(kit_value(&kit, "b1.theta''"), alpha, 1e-6));
        kit_free(&kit);
    }
}

static void wrong_uses_name_their_cure(void)
{
    static const struct {
        const char *text, *message, *hint;
    } wrong[] = {
        {BOB "friction f h mu=0.1\n", "needs radius=", "radius=20 mm"},
        {BOB "friction f h mu=0.1 radius=0.1 span=1\n", "span= does not fit", "use radius="},
        {BOB "friction f h mu=0.1 radius=-1\n", "radius of f is negative", ""},
        {BOB "friction f h mu=-0.1 radius=1\n", "mu of f is negative", ""},
        {BOB "friction f h mu=0.1 radius=1 torque=2\n", "mu= or torque=, not both", "second"},
        {BOB "friction f h radius=0.1 torque=2\n", "radius= has no effect without mu=", "mu=0.1"},
        {BOB "friction f h mu=0.1 N radius=1\n", "mu has no unit", ""},
        {BOB "friction f h mu=0.1 radius=1 s\n", "m expected for radius", ""},
        {BOB "friction f h mu=0.1 radius=1 static=0.5\n", "static=0.5", "1 or more"},
        {BOB "brake f h mu=0.1\n", "no key 'mu'", ""},
        {RAIL "friction f s mu=0.1 radius=1\n", "radius= does not fit", "use span="},
        {RAIL "friction f s mu=0.1 span=0\n", "span of f is zero", ""},
        {RAIL "friction f s mu=0.1 force=1\n", "mu= or force=, not both", ""},
        {"friction f a 0 mu=0.1\n", "mu= needs a joint", "torque=mu*n"},
        {"scene spatial\nbody b mass=1 inertia=[1, 1, 1]\ncylindrical c ground b axis=z\n"
         "friction f c.s mu=0.1\n",
         "needs a revolute or a prismatic, and c is a cylindrical", "force=2"},
        {"scene spatial; gravity [0, -9.81, 0]\nbody b mass=1 inertia=[1, 1, 1]\n"
         "revolute h1 ground b axis=z\narm q b [0, 0, 1]\narm g ground [0, 0, 1]\n"
         "revolute h2 g q axis=z\nfriction f h1 mu=0.1 radius=0.01\nsimulate 1\n",
         "the load of f can't be determined", "h2"},
    };

    for (int i = 0; i < (int)(sizeof wrong / sizeof wrong[0]); i++) {
        Kit kit = kit_new();

        EXPECT_FAILS(&kit, wrong[i].text, wrong[i].message);
        EXPECT_HOLDS(kit.error.hint != NULL ? kit.error.hint : "", wrong[i].hint);
        kit_free(&kit);
    }
}

/* undone, written to a file and in a subsystem it is the same */
static void it_survives_undo_and_subsystems(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, BOB "friction f h mu=0.5 radius=0.1\ndelete f\nundo\n"
                          "init h = -60 deg, h' = 0\nsimulate 0.3\n");
    EXPECT(kit_value(&kit, "f.load") > 10);
    EXPECT_DONE(&kit, "equilibrium\nguess f.load = 20\nsimulate 0.1\n");
    kit_free(&kit);
    kit = kit_new();
    EXPECT_DONE(&kit, "scene planar; gravity [0, -9.81]\nsubsystem swing frames=[A]\n"
                      "body bob mass=2\narm top bob [0, 0.5]\nrevolute h A top\n"
                      "friction f h mu=0.5 radius=0.1\nend\nuse swing S1 A=ground\n"
                      "use swing S2 A=ground\ninit S1.h = 1, S1.h' = 0, S2.h = 1, S2.h' = 0\n"
                      "simulate 0.3\n");
    EXPECT(is_near(kit_value(&kit, "S1.f.load"), kit_value(&kit, "S2.f.load"), 1e-7));
    kit_free(&kit);
}

int main(void)
{
    RUN(a_pendulum_in_a_journal);
    RUN(a_block_on_an_incline);
    RUN(a_slider_in_space);
    RUN(a_journal_in_space);
    RUN(a_drawer_jams);
    RUN(self_locking_is_named);
    RUN(a_four_bar_with_four_journals);
    RUN(wrong_uses_name_their_cure);
    RUN(it_survives_undo_and_subsystems);
    return test_end();
}
