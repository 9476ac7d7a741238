/* family_sliding.c: dry friction and relays, against a machine of states that knows stick and slip
 *
 * The oracle: masses between springs, each rubbing on its own belt. Whether one sticks is a state;
 * one that sticks moves with its belt until the load exceeds the static friction, one that slips
 * does so until it meets the belt's speed. Fixed steps of Runge-Kutta, the last of them before a
 * change by halves. No sign stands in its equations. */
#include "../unit/session_kit.h"
#include "family.h"

#include <math.h>

enum { FEW_MASSES = 4, MOST_MASSES = 12, STATES = 2 * MOST_MASSES };

typedef struct Masses {
    int count;
    double mass[MOST_MASSES], spring[MOST_MASSES], joined[MOST_MASSES], damper[MOST_MASSES];
    double friction[MOST_MASSES], ratio[MOST_MASSES], belt[MOST_MASSES];
    double constant[MOST_MASSES], swing[MOST_MASSES], pace[MOST_MASSES], phase[MOST_MASSES];
    double start[STATES]; /* places, then speeds */
    double end;
} Masses;

/* --- the oracle --- */

typedef enum Contact { STICKS = 0, AHEAD = 1, BEHIND = -1 } Contact; /* of its belt */

/* all that acts on mass i but friction */
static double load(const Masses *m, int i, double t, const double *y)
{
    double sum = m->constant[i] + m->swing[i] * sin(m->pace[i] * t + m->phase[i]);

    sum -= m->spring[i] * y[i] + m->damper[i] * y[m->count + i];
    if (i > 0 && i < MOST_MASSES)
        sum -= m->joined[i] * (y[i] - y[i - 1]);
    if (i + 1 < m->count)
        sum -= m->joined[i + 1] * (y[i] - y[i + 1]);
    return sum;
}

static void rates(const Masses *m, const Contact *contact, double t, const double *y, double *out)
{
    for (int i = 0; i < m->count; i++) {
        out[i] = y[m->count + i];
        out[m->count + i] = contact[i] == STICKS
                                ? 0
                                : (load(m, i, t, y) - contact[i] * m->friction[i]) / m->mass[i];
    }
}

static void runge_kutta(const Masses *m, const Contact *contact, double t, double h,
                        const double *y, double *out)
{
    const int n = 2 * m->count;
    double k[4][STATES], at[STATES];

    for (int stage = 0; stage < 4; stage++) {
        const double share = stage == 0 ? 0 : stage == 3 ? 1 : 0.5;

        for (int i = 0; i < n; i++)
            at[i] = y[i] + (stage > 0 ? share * h * k[stage - 1][i] : 0);
        rates(m, contact, t + share * h, at, k[stage]);
    }
    for (int i = 0; i < n; i++)
        out[i] = y[i] + h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
}

/* whether a contact no longer is what it is taken for */
static bool is_over(const Masses *m, const Contact *contact, int i, double t, const double *y)
{
    if (contact[i] == STICKS)
        return fabs(load(m, i, t, y)) > m->ratio[i] * m->friction[i];
    return contact[i] * (y[m->count + i] - m->belt[i]) < 0;
}

static bool any_over(const Masses *m, const Contact *contact, double t, const double *y)
{
    for (int i = 0; i < m->count; i++)
        if (is_over(m, contact, i, t, y))
            return true;
    return false;
}

/* those that are over become what they are next */
static void change(const Masses *m, Contact *contact, double t, double *y)
{
    for (int i = 0; i < m->count; i++) {
        double acts = load(m, i, t, y);

        if (!is_over(m, contact, i, t, y))
            continue;
        if (contact[i] != STICKS)
            y[m->count + i] = m->belt[i];
        contact[i] = fabs(acts) <= m->ratio[i] * m->friction[i] ? STICKS
                     : acts > 0                                 ? AHEAD
                                                                : BEHIND;
    }
}

static void begin(const Masses *m, Contact *contact, const double *y)
{
    for (int i = 0; i < m->count; i++) {
        double acts = load(m, i, 0, y), slip = y[m->count + i] - m->belt[i];

        contact[i] = slip > 0                                     ? AHEAD
                     : slip < 0                                   ? BEHIND
                     : fabs(acts) <= m->ratio[i] * m->friction[i] ? STICKS
                     : acts > 0                                   ? AHEAD
                                                                  : BEHIND;
    }
}

static void solve(const Masses *m, double h, double *y)
{
    Contact contact[MOST_MASSES];
    double t = 0, next[STATES];

    memcpy(y, m->start, sizeof m->start);
    begin(m, contact, y);
    while (t < m->end - 1e-12) {
        double step = fmin(h, m->end - t), low = 0;

        runge_kutta(m, contact, t, step, y, next);
        if (any_over(m, contact, t + step, next)) {
            for (int k = 0; k < 60; k++) {
                double middle = (low + step) / 2;

                runge_kutta(m, contact, t, middle, y, next);
                if (any_over(m, contact, t + middle, next))
                    step = middle;
                else
                    low = middle;
            }
            runge_kutta(m, contact, t, step, y, next);
            change(m, contact, t + step, next);
        }
        t += step;
        memcpy(y, next, sizeof next);
    }
}

/* --- the same in statements --- */

typedef struct Lines {
    char at[6 * MOST_MASSES][200];
    int count;
} Lines;

__attribute__((format(printf, 2, 3))) static void line(Lines *lines, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(lines->at[lines->count++], sizeof lines->at[0], format, arguments);
    va_end(arguments);
}

static int chance(Member *member, int count)
{
    return (int)(test_random(&member->random) % (uint64_t)count);
}

/* friction as somebody may write it */
static void write_friction(Member *member, Lines *lines, const Masses *m, int i)
{
    const double F = m->friction[i], v = m->belt[i];

    if (v == 0 && (m->ratio[i] > 1 || chance(member, 3) == 0)) {
        line(lines, "friction f%d s%d force=%.17g static=%.17g", i, i, F, m->ratio[i]);
        return;
    }
    if (m->ratio[i] > 1) {
        line(lines, "actuator f%d s%d force=-%.17g*stick(s%d' - %.17g, %.17g)", i, i, F, i, v,
             m->ratio[i]);
        return;
    }
    switch (chance(member, 6)) {
    case 0:
        line(lines, "actuator f%d s%d force=-%.17g*sign(s%d' - %.17g)", i, i, F, i, v);
        break;
    case 1:
        line(lines, "actuator f%d s%d force=%.17g*sign(%.17g - s%d')", i, i, F, v, i);
        break;
    case 2:
        line(lines, "actuator f%d s%d force=if(s%d' > %.17g, -%.17g, %.17g)", i, i, i, v, F, F);
        break;
    case 3:
        line(lines, "actuator f%d s%d force=if(s%d' > %.17g, -%.17g, if(s%d' < %.17g, %.17g, 0))",
             i, i, i, v, F, i, v, F);
        break;
    case 4:
        line(lines, "actuator f%d s%d force=%.17g - 2*%.17g*step(s%d' - %.17g)", i, i, F, F, i, v);
        break;
    default:
        line(lines, "actuator f%d s%d force=%.17g*((s%d' <= %.17g) - (s%d' > %.17g))", i, i, F, i,
             v, i, v);
        break;
    }
}

static void write_lines(Member *member, Lines *lines, const Masses *m)
{
    for (int i = 0; i < m->count; i++) {
        write_friction(member, lines, m, i);
        line(lines, "spring k%d s%d k=%.17g", i, i, m->spring[i]);
        line(lines, "damper d%d s%d d=%.17g", i, i, m->damper[i]);
        line(lines, "actuator l%d s%d force=%.17g + %.17g*sin(%.17g*t + %.17g)", i, i,
             m->constant[i], m->swing[i], m->pace[i], m->phase[i]);
        if (i > 0) {
            line(lines, "actuator u%d s%d force=-%.17g*(s%d - s%d)", i, i, m->joined[i], i, i - 1);
            line(lines, "actuator v%d s%d force=%.17g*(s%d - s%d)", i, i - 1, m->joined[i], i,
                 i - 1);
        }
    }
    for (int i = lines->count - 1; i > 0; i--) {
        int other = chance(member, i + 1);
        char kept[sizeof lines->at[0]];

        memcpy(kept, lines->at[i], sizeof kept);
        memcpy(lines->at[i], lines->at[other], sizeof kept);
        memcpy(lines->at[other], kept, sizeof kept);
    }
}

typedef struct How {
    const char *method;
    double rtol, loose; /* what a method makes of its tolerance */
} How;

static How choose_method(Member *member)
{
    static const How all[] = {{"auto", 1, 30},  {"dop853", 1, 30},  {"radau", 1, 100},
                              {"bdf", 1, 3000}, {"adams", 1, 3000}, {"ida", 1, 3000},
                              {"rk4", 0, 0}};
    How how = all[chance(member, (int)(sizeof all / sizeof all[0]))];

    how.rtol = pow(10, -test_uniform(&member->random, 6, 10));
    return how;
}

static void write_scene(Member *member, const Masses *m, const How *how, char *text, size_t size)
{
    static Lines lines;
    size_t n = (size_t)snprintf(text, size, "scene planar\n");

    lines.count = 0;
    for (int i = 0; i < m->count; i++)
        n += (size_t)snprintf(text + n, size - n,
                              "body m%d mass=%.17g inertia=0\nprismatic s%d ground m%d axis=x\n", i,
                              m->mass[i], i, i);
    write_lines(member, &lines, m);
    for (int i = 0; i < lines.count; i++)
        n += (size_t)snprintf(text + n, size - n, "%s\n", lines.at[i]);
    if (chance(member, 4) == 0)
        n += (size_t)snprintf(text + n, size - n, "tree absolute\n");
    if (chance(member, 4) == 0)
        n += (size_t)snprintf(text + n, size - n, "form embedded\n");
    for (int i = 0; i < m->count; i++)
        n += (size_t)snprintf(text + n, size - n, "init s%d = %.17g, s%d' = %.17g\n", i,
                              m->start[i], i, m->start[m->count + i]);
    if (strcmp(how->method, "rk4") == 0)
        (void)snprintf(text + n, size - n, "simulate %.17g method=rk4 step=0.0005\n", m->end);
    else
        (void)snprintf(text + n, size - n, "simulate %.17g method=%s rtol=%.3g\n", m->end,
                       how->method, how->rtol);
}

static double pick(Member *member, double low, double high)
{
    return test_uniform(&member->random, low, high);
}

static void choose_masses(Member *member, Masses *m)
{
    *m = (Masses){.count = 1 + chance(member, FEW_MASSES), .end = pick(member, 1, 6)};
    if (chance(member, 12) == 0) { /* more surfaces than have all their sides kept */
        m->count = MOST_MASSES - chance(member, 4);
        m->end = pick(member, 0.5, 2);
    }
    for (int i = 0; i < m->count; i++) {
        m->mass[i] = pick(member, 0.5, 3);
        m->spring[i] = chance(member, 5) == 0 ? 0 : pick(member, 2, 40);
        m->joined[i] = pick(member, 2, 40);
        m->damper[i] = chance(member, 2) == 0 ? 0 : pick(member, 0, 1);
        m->friction[i] = pick(member, 0.5, 6);
        m->ratio[i] = chance(member, 3) == 0 ? pick(member, 1, 2) : 1;
        m->belt[i] = chance(member, 2) == 0 ? 0 : pick(member, -0.5, 0.5);
        m->constant[i] = chance(member, 2) == 0 ? 0 : pick(member, -6, 6);
        m->swing[i] = chance(member, 3) == 0 ? 0 : pick(member, 0, 8);
        m->pace[i] = pick(member, 0.5, 6);
        m->phase[i] = pick(member, 0, 6);
        m->start[i] = chance(member, 3) == 0 ? 0 : pick(member, -0.5, 0.5);
        m->start[m->count + i] = chance(member, 3) == 0   ? m->belt[i]
                                 : chance(member, 2) == 0 ? 0
                                                          : pick(member, -1, 1);
    }
}

/* where the oracle itself isn't sure: a contact on the edge between stick and slip */
static bool is_delicate(const Masses *m, const double *fine)
{
    double coarse[STATES];

    solve(m, 2.3e-3, coarse);
    for (int i = 0; i < 2 * m->count; i++)
        if (!(fabs(coarse[i] - fine[i]) < 1e-4))
            return true;
    return false;
}

static Verdict masses_stick_and_slip(Member *member)
{
    static char text[16384];
    double expected[STATES];
    Masses m;
    How how;
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    choose_masses(member, &m);
    how = choose_method(member);
    write_scene(member, &m, &how, text, sizeof text);
    tell(member, "%s", text);
    solve(&m, 1e-3, expected);
    if (kit_do(&kit, text) != CT_OK) {
        tell(member, "refused: %s\n", kit.error.message);
        verdict = REFUSED;
    }
    for (int i = 0; i < 2 * m.count && verdict != REFUSED; i++) {
        char name[16];
        double got;

        (void)snprintf(name, sizeof name, i < m.count ? "s%d" : "s%d'", i % m.count);
        got = kit_value(&kit, name);
        tell(member, "%s %.10g, expected %.10g\n", name, got, expected[i]);
        if (!(fabs(got - expected[i]) <=
              1e-6 + how.loose * how.rtol + (strcmp(how.method, "rk4") == 0 ? 1e-5 : 0)))
            verdict = DISAGREES;
    }
    if (verdict == DISAGREES && is_delicate(&m, expected))
        verdict = REFUSED;
    kit_free(&kit);
    return verdict;
}

/* --- relays on a position --- */

/* m s'' = -k sign(s - r) - d s': swings about r fade, ever faster, without an end of their own.
 * After many times m/d only r is left, and the force that r asks for. */
static Verdict swings_come_to_rest(Member *member)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "bdf", "adams", "ida"};
    const double mass = pick(member, 0.3, 3), force = pick(member, 2, 8);
    const double damping = mass * pick(member, 0.5, 2), swing = pick(member, -0.2, 0.2);
    const double pace = pick(member, 0.05, 0.5), end = 30 * mass / damping;
    const double follows = swing * pace * cos(pace * end);
    const double needed = -mass * swing * pace * pace * sin(pace * end) + damping * follows;
    const char *method = methods[chance(member, (int)(sizeof methods / sizeof methods[0]))];
    char text[1000];
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    (void)snprintf(text, sizeof text,
                   "scene planar\nbody m mass=%.17g inertia=0\nprismatic s ground m axis=x\n"
                   "actuator f s force=-%.17g*sign(s - %.17g*sin(%.17g*t))\ndamper d s d=%.17g\n"
                   "init s = %.17g, s' = %.17g\nsimulate %.17g method=%s\n",
                   mass, force, swing, pace, damping, pick(member, -1, 1), pick(member, -1, 1), end,
                   method);
    tell(member, "%s", text);
    if (kit_do(&kit, text) != CT_OK) {
        tell(member, "refused: %s\n", kit.error.message);
        verdict = REFUSED;
    } else {
        const double got[] = {kit_value(&kit, "s"), kit_value(&kit, "s'"),
                              kit_value(&kit, "f.effort")};

        tell(member, "%.9g %.9g %.9g, not %.9g %.9g %.9g\n", got[0], got[1], got[2],
             swing * sin(pace * end), follows, needed);
        if (!(fabs(got[0] - swing * sin(pace * end)) < 2e-5) || !(fabs(got[1] - follows) < 1e-6) ||
            !(fabs(got[2] - needed) < 1e-5))
            verdict = DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    const Family families[] = {
        {"masses_stick_and_slip", 50, 0.01, 0, masses_stick_and_slip},
        {"swings_come_to_rest", 2, 0.1, 0, swings_come_to_rest},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
