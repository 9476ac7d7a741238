/* test_friction_arm.c: an arm with six joints that rub, against a program of its own
 *
 * A chain of links in the plane, with the mass matrix of a multiple pendulum: with absolute angles
 * th, a_jk = sum of m_i r_ij r_ik (r_ij: the lever of th_j for the centre of link i),
 *
 *     M_jk = a_jk cos(th_j - th_k) + I_j (j = k),  h_j = sum of a_jk sin(th_j - th_k) th_k'^2 + g
 * b_j
 *
 * in joint angles q by th_j = q_1 + .. + q_j. A mode says of each joint whether it sticks or which
 * way it slips. Between events steps of Runge and Kutta; an event is located by bisection of the
 * step, and the mode behind it is found among all that are possible. */
#include "base/text.h"
#include "session_kit.h"

#include <math.h>
#include <string.h>

enum { JOINTS = 6, ASSIGNMENTS = 729, HALVINGS = 60 };

#define STEP 5e-5
#define END  1.2
#define G    9.81

static const double length[JOINTS] = {0.5, 0.45, 0.4, 0.3, 0.25, 0.2};
static const double centre[JOINTS] = {0.22, 0.2, 0.25, 0.14, 0.13, 0.1};
static const double mass[JOINTS] = {4, 3.5, 2.5, 1.5, 1, 0.8};
static const double inertia[JOINTS] = {0.09, 0.07, 0.05, 0.02, 0.012, 0.01};
static const double bound[JOINTS] = {6, 5, 3, 2, 1, 0.5};
static const double ratio[JOINTS] = {1.3, 1, 1.5, 1.2, 1, 1.4};
static const double stiffness[JOINTS] = {60, 50, 30, 20, 10, 8};
static const double damping[JOINTS] = {2, 1.5, 1, 0.5, 0.3, 0.2};
static const double torque[JOINTS] = {40, 20, 15, 8, 4, 2};
static const double pace[JOINTS] = {4, 7, 5, 9, 6, 11};
static const double speed[JOINTS] = {0, 0.5, 0, -0.8, 0, 1};

typedef struct Arm {
    double q[JOINTS], u[JOINTS];
    int slips[JOINTS]; /* -1, 1; 0: it sticks */
    int events, stuck; /* how many; with a joint that began to stick */
} Arm;

static double lever(int link, int angle)
{
    return angle < link ? length[angle] : angle == link ? centre[link] : 0;
}

/* M and the other forces, without friction, in joint angles */
static void form(double t, const double *q, const double *u, double m[JOINTS][JOINTS],
                 double *force)
{
    double angle[JOINTS], rate[JOINTS], own[JOINTS][JOINTS], rest[JOINTS];

    angle[0] = q[0];
    rate[0] = u[0];
    for (int j = 1; j < JOINTS; j++) {
        angle[j] = q[j] + angle[j - 1];
        rate[j] = u[j] + rate[j - 1];
    }
    for (int j = 0; j < JOINTS; j++) {
        rest[j] = 0;
        for (int i = j; i < JOINTS; i++)
            rest[j] -= G * mass[i] * lever(i, j) * cos(angle[j]);
        for (int k = 0; k < JOINTS; k++) {
            double a = 0;

            for (int i = 0; i < JOINTS; i++)
                a += mass[i] * lever(i, j) * lever(i, k);
            own[j][k] = a * cos(angle[j] - angle[k]) + (j == k ? inertia[j] : 0);
            rest[j] -= a * sin(angle[j] - angle[k]) * rate[k] * rate[k];
        }
    }
    for (int j = 0; j < JOINTS; j++) {
        force[j] = torque[j] * sin(pace[j] * t) - stiffness[j] * q[j] - damping[j] * u[j];
        for (int i = j; i < JOINTS; i++)
            force[j] += rest[i];
        for (int k = 0; k < JOINTS; k++) {
            m[j][k] = 0;
            for (int i = j; i < JOINTS; i++)
                for (int l = k; l < JOINTS; l++)
                    m[j][k] += own[i][l];
        }
    }
}

/* Accelerations, and efforts of what sticks: rows of joints that stick are q'' = 0, with their
 * effort as unknown. `friction` acts on those that slip. */
static void solve(double t, const double *q, const double *u, const int *slips,
                  const double *friction, double *acceleration, double *effort)
{
    double m[JOINTS][JOINTS], force[JOINTS], a[JOINTS][JOINTS + 1];

    form(t, q, u, m, force);
    for (int j = 0; j < JOINTS; j++) {
        for (int k = 0; k < JOINTS; k++)
            a[j][k] = slips[k] != 0 ? m[j][k] : j == k ? -1 : 0;
        a[j][JOINTS] = force[j] - (slips[j] != 0 ? slips[j] * friction[j] : 0);
    }
    for (int k = 0; k < JOINTS; k++) {
        int best = k;

        for (int j = k + 1; j < JOINTS; j++)
            best = fabs(a[j][k]) > fabs(a[best][k]) ? j : best;
        for (int l = 0; l <= JOINTS; l++) {
            const double kept = a[k][l];

            a[k][l] = a[best][l];
            a[best][l] = kept;
        }
        for (int j = 0; j < JOINTS; j++) {
            const double part = j != k ? a[j][k] / a[k][k] : 0;

            for (int l = k; l <= JOINTS && part != 0; l++)
                a[j][l] -= part * a[k][l];
        }
    }
    for (int k = 0; k < JOINTS; k++) {
        const double value = a[k][JOINTS] / a[k][k];

        acceleration[k] = slips[k] != 0 ? value : 0;
        effort[k] = slips[k] != 0 ? 0 : value;
    }
}

static void step(Arm *arm, double t, double h)
{
    static const double part[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
    double q[JOINTS], u[JOINTS], dq[JOINTS] = {0}, du[JOINTS] = {0}, effort[JOINTS];
    double sum_q[JOINTS] = {0}, sum_u[JOINTS] = {0};

    for (int stage = 0; stage < 4; stage++) {
        for (int j = 0; j < JOINTS; j++) {
            q[j] = arm->q[j] + h * part[stage] * dq[j];
            u[j] = arm->u[j] + h * part[stage] * du[j];
        }
        solve(t + part[stage] * h, q, u, arm->slips, bound, du, effort);
        for (int j = 0; j < JOINTS; j++) {
            dq[j] = u[j];
            sum_q[j] += h / 6 * weight[stage] * dq[j];
            sum_u[j] += h / 6 * weight[stage] * du[j];
        }
    }
    for (int j = 0; j < JOINTS; j++) {
        arm->q[j] += sum_q[j];
        arm->u[j] += sum_u[j];
    }
}

/* the first joint that has turned round, or carries more than it holds; -1: none */
static int ended(const Arm *arm, double t)
{
    double acceleration[JOINTS], effort[JOINTS];

    solve(t, arm->q, arm->u, arm->slips, bound, acceleration, effort);
    for (int j = 0; j < JOINTS; j++)
        if (arm->slips[j] != 0 ? arm->slips[j] * arm->u[j] < 0
                               : fabs(effort[j]) > ratio[j] * bound[j])
            return j;
    return -1;
}

/* Modes of joints at rest that hold with static bounds; those that move take the kinetic one, and
 * the others are looked for again. */
static bool find_mode(Arm *arm, double t, const bool *rests, int leaving, int side)
{
    double friction[JOINTS];
    bool open[JOINTS];

    for (int j = 0; j < JOINTS; j++) {
        open[j] = rests[j] && j != leaving;
        friction[j] = bound[j] * (open[j] ? ratio[j] : 1);
    }
    if (leaving >= 0)
        arm->slips[leaving] = side;
    for (bool again = true; again;) {
        bool found = false;

        for (int number = 0; number < ASSIGNMENTS && !found; number++) {
            double acceleration[JOINTS], effort[JOINTS];

            for (int j = 0, left = number; j < JOINTS; j++, left /= 3)
                if (open[j])
                    arm->slips[j] = left % 3 - 1;
            solve(t, arm->q, arm->u, arm->slips, friction, acceleration, effort);
            found = true;
            for (int j = 0; j < JOINTS; j++)
                if (open[j])
                    found = found && (arm->slips[j] != 0 ? arm->slips[j] * acceleration[j] > 0
                                                         : fabs(effort[j]) <= friction[j]);
        }
        if (!found)
            return false;
        again = false;
        for (int j = 0; j < JOINTS; j++)
            if (open[j] && arm->slips[j] != 0) {
                open[j] = false;
                friction[j] = bound[j];
                again = ratio[j] > 1 || again;
            }
    }
    return true;
}

/* Past the event of joint j, at which the arm stands. */
static bool go_over(Arm *arm, double t, int j)
{
    double acceleration[JOINTS], effort[JOINTS];
    bool rests[JOINTS], sticks = arm->slips[j] == 0;

    solve(t, arm->q, arm->u, arm->slips, bound, acceleration, effort);
    if (!sticks)
        arm->u[j] = 0;
    for (int k = 0; k < JOINTS; k++)
        rests[k] = arm->slips[k] == 0 || k == j;
    arm->events++;
    if (!find_mode(arm, t, rests, sticks ? j : -1, effort[j] > 0 ? -1 : 1))
        return false;
    arm->stuck += !sticks && arm->slips[j] == 0;
    return true;
}

static bool follow(Arm *arm)
{
    double t = 0;

    while (t < END) {
        const Arm before = *arm;
        double low = 0, high = fmin(STEP, END - t);
        int which;

        step(arm, t, high);
        which = ended(arm, t + high);
        for (int k = 0; which >= 0 && k < HALVINGS; k++) {
            const double middle = (low + high) / 2;
            int other;

            *arm = before;
            step(arm, t, middle);
            other = ended(arm, t + middle);
            if (other >= 0)
                which = other;
            *(other >= 0 ? &high : &low) = middle;
        }
        if (which >= 0) {
            *arm = before;
            step(arm, t, high);
            if (!go_over(arm, t + high, which))
                return false;
        }
        t = END - t - high < 1e-15 ? END : t + high;
    }
    return true;
}

static void write_arm(Text *out)
{
    text_addf(out, "scene planar\ngravity [0, -%g]\n", G);
    for (int j = 0; j < JOINTS; j++) {
        text_addf(out,
                  "body b%d mass=%g inertia=%g\narm root%d b%d [-%g, 0]\narm tip%d b%d [%g, 0]\n",
                  j, mass[j], inertia[j], j, j, centre[j], j, j, length[j] - centre[j]);
        if (j == 0)
            text_add(out, "revolute h0 ground root0\n");
        else
            text_addf(out, "revolute h%d tip%d root%d\n", j, j - 1, j);
        text_addf(out, "actuator t%d h%d torque=%g*sin(%g*t) - %g*h%d - %g*h%d'\n", j, j, torque[j],
                  pace[j], stiffness[j], j, damping[j], j);
        text_addf(out, "friction f%d h%d torque=%g static=%g\ninit h%d = 0, h%d' = %g\n", j, j,
                  bound[j], ratio[j], j, j, speed[j]);
    }
}

static void six_joints_stick_and_slip(void)
{
    Arm arm = {0};
    bool rests[JOINTS];
    Kit kit = kit_new();
    Text text = {0};

    memcpy(arm.u, speed, sizeof speed);
    for (int j = 0; j < JOINTS; j++) {
        rests[j] = speed[j] == 0;
        arm.slips[j] = speed[j] > 0 ? 1 : -1;
    }
    EXPECT(find_mode(&arm, 0, rests, -1, 0) && follow(&arm));
    EXPECT(arm.events > 20 && arm.stuck > 5);
    write_arm(&text);
    text_addf(&text, "simulate %g rtol=1e-12 atol=1e-13\n", END);
    EXPECT_DONE(&kit, text.at);
    for (int j = 0; j < JOINTS; j++) {
        char name[16];

        (void)snprintf(name, sizeof name, "h%d", j);
        EXPECT(fabs(kit_value(&kit, name) - arm.q[j]) < 1e-9);
        (void)snprintf(name, sizeof name, "h%d'", j);
        EXPECT(fabs(kit_value(&kit, name) - arm.u[j]) < 1e-9);
    }
    text_free(&text);
    kit_free(&kit);
}

int main(void)
{
    RUN(six_joints_stick_and_slip);
    return test_end();
}
