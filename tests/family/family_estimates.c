/* family_estimates.c: what check=on says of the error of a run, against the error
 *
 * Pendulums follow Jacobi's elliptic functions, first-order networks an exponential and a sine, and
 * two rods, which may be chaotic, a Runge-Kutta method in long double whose steps are halved until
 * two of its runs agree. A number is right within ten of the largest error over the rows; a run may
 * be left unresolved where it is on another motion. */
#include "../unit/session_kit.h"
#include "base/memory.h"
#include "family.h"
#include "script.h"

#include <gsl/gsl_sf_ellint.h>
#include <gsl/gsl_sf_elljac.h>
#include <math.h>

#define GRAVITY 9.81
#define ROWS    20
#define RIGHT   10.0 /* times too large or too small */
#define FAR     0.1  /* rad or rad/s: perhaps another motion */

typedef struct Way {
    const char *method;
    bool is_fixed;
    double finest; /* tolerance that it is asked for; of fixed steps the step, in s */
} Way;

static const Way ways[] = {{"auto", false, 1e-10}, {"dop853", false, 1e-10},
                           {"radau", false, 1e-9}, {"bdf", false, 1e-9},
                           {"adams", false, 1e-9}, {"ida", false, 1e-9},
                           {"rk4", true, 1e-3},    {"symplectic", true, 2e-2}};

static Script script;

static const Way *draw_way(Member *m)
{
    return &ways[member_one_of(m, COUNT(ways))];
}

static void write_run(Member *m, const Way *way, double duration, double coarsest)
{
    write_piece(&script, "simulate %.17g every=%.17g method=%s check=on", duration, duration / ROWS,
                way->method);
    if (way->is_fixed)
        write_line(&script, " step=%.3g", member_decades(m, way->finest, 10 * way->finest));
    else
        write_line(&script, " rtol=%.3g", member_decades(m, way->finest, coarsest));
}

/* a row's items, the time first; false: there is none */
static bool read_row(Kit *kit, const char *const *items, int count, int row, double duration,
                     double *out)
{
    char text[80];

    for (int i = 0; i < count; i++) {
        (void)snprintf(text, sizeof text, "%s at %.17g", items[i], duration * row / ROWS);
        out[i] = kit_value(kit, text);
        if (isnan(out[i]))
            return false;
    }
    return true;
}

/* what was said against the largest error; `least` is what the answers from elsewhere can tell */
static Verdict judge(Member *m, Kit *kit, double error, double least)
{
    ct_figures told;

    if (!ct_run_figures(kit->session, 0, &told))
        return DISAGREES;
    tell(m, "%s: told %.3g, off by %.3g\n%s", told.method, told.global_error, error,
         ct_remarks(kit->session));
    if (isnan(told.global_error))
        return error > FAR ? REFUSED : DISAGREES;
    if (error < least)
        return told.global_error < RIGHT * least ? AGREES : DISAGREES;
    m->figure = fmax(told.global_error / error, error / told.global_error) / RIGHT;
    return m->figure <= 1 ? AGREES : DISAGREES;
}

/* --- a pendulum, released at rest: sin(h/2) = k sn(w t + K(k), k) --- */

static Verdict pendulums(Member *m)
{
    static const char *const items[] = {"h", "h'"};
    const double length = member_between(m, 0.2, 2), mass = member_decades(m, 0.1, 10);
    const double inertia = member_decades(m, 0.01, 1), from = member_between(m, 0.1, 3);
    const double w = sqrt(mass * GRAVITY * length / (inertia + mass * length * length));
    const double duration = member_between(m, 1, 10), k = sin(from / 2);
    const double quarter = gsl_sf_ellint_Kcomp(k, GSL_PREC_DOUBLE);
    const Way *way = draw_way(m);
    Kit kit = kit_new();
    Verdict verdict = DISAGREES;
    double error = 0, got[2];
    bool done;

    script.length = 0;
    write_line(&script, "scene planar\ngravity [0, -%g]\nbody b mass=%.17g inertia=%.17g", GRAVITY,
               mass, inertia);
    write_line(&script, "arm top b [0, %.17g]\nrevolute h ground top\ninit h = %.17g", length,
               from);
    write_run(m, way, duration, 1e-3);
    tell(m, "%s", script.text);
    done = kit_do(&kit, script.text) == CT_OK;
    for (int row = 0; row <= ROWS && done; row++) {
        double sn, cn, dn;

        done = gsl_sf_elljac_e(w * duration * row / ROWS + quarter, k * k, &sn, &cn, &dn) == 0 &&
               read_row(&kit, items, 2, row, duration, got);
        error = fmax(error, fabs(got[0] - 2 * asin(k * sn)));
        error = fmax(error, fabs(got[1] - 2 * k * w * cn));
    }
    if (done)
        verdict = judge(m, &kit, error, 1e-11);
    else
        tell(m, "%s\n", kit.error.message);
    kit_free(&kit);
    return verdict;
}

/* --- a capacitor behind a resistor and a source, soft to stiff --- */

static Verdict networks(Member *m)
{
    static const char *const items[] = {"C.v"};
    const double amplitude = member_decades(m, 0.1, 100), w = member_decades(m, 1, 30);
    const double tau = member_decades(m, 1e-4, 1), duration = member_between(m, 0.5, 3);
    const double first = member_between(m, -1, 1) * amplitude;
    const double part = amplitude / (1 + w * tau * w * tau);
    const Way *way = &ways[member_one_of(m, 6)];
    Kit kit = kit_new();
    Verdict verdict = DISAGREES;
    double error = 0, got;
    bool done;

    script.length = 0;
    write_line(&script, "vsource E a 0 %.17g*sin(%.17g*t)\nresistor R a b %.17g", amplitude, w,
               tau * 1e3);
    write_line(&script, "capacitor C b 0 1e-3\ninit C.v = %.17g", first);
    write_run(m, way, duration, 1e-3);
    tell(m, "%s", script.text);
    done = kit_do(&kit, script.text) == CT_OK;
    for (int row = 0; row <= ROWS && done; row++) {
        const double t = duration * row / ROWS;

        done = read_row(&kit, items, 1, row, duration, &got);
        error = fmax(error, fabs(got - part * (sin(w * t) - w * tau * cos(w * t)) -
                                 (first + part * w * tau) * exp(-t / tau)));
    }
    if (done)
        verdict = judge(m, &kit, error, 1e-12 * amplitude);
    else
        tell(m, "%s\n", kit.error.message);
    kit_free(&kit);
    return verdict;
}

/* --- two rods --- */

typedef struct Rods {
    double mass[2], length[2];
} Rods;

/* by the angles of both against the vertical */
static void accelerations(const Rods *rods, const long double y[4], long double out[4])
{
    const long double m1 = rods->mass[0], m2 = rods->mass[1];
    const long double l1 = rods->length[0], l2 = rods->length[1];
    const long double c = m2 * l1 * l2 / 2 * cosl(y[0] - y[1]);
    const long double s = m2 * l1 * l2 / 2 * sinl(y[0] - y[1]);
    const long double a = (m1 / 3 + m2) * l1 * l1, b = m2 * l2 * l2 / 3, d = a * b - c * c;
    const long double f = -s * y[3] * y[3] - (m1 / 2 + m2) * l1 * GRAVITY * sinl(y[0]);
    const long double g = s * y[2] * y[2] - m2 * l2 / 2 * GRAVITY * sinl(y[1]);

    out[0] = y[2];
    out[1] = y[3];
    out[2] = (b * f - c * g) / d;
    out[3] = (a * g - c * f) / d;
}

static void step(const Rods *rods, long double h, long double y[4])
{
    long double k[4][4], at[4];

    accelerations(rods, y, k[0]);
    for (int stage = 1; stage < 4; stage++) {
        for (int i = 0; i < 4; i++)
            at[i] = y[i] + (stage == 3 ? h : h / 2) * k[stage - 1][i];
        accelerations(rods, at, k[stage]);
    }
    for (int i = 0; i < 4; i++)
        y[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
}

/* in so many steps a row: rows of the joints' angles and rates */
static void follow(const Rods *rods, const double from[2], double duration, int steps,
                   double out[ROWS + 1][4])
{
    long double y[4] = {from[0], from[0] + from[1], 0, 0};

    for (int row = 0; row <= ROWS; row++) {
        out[row][0] = (double)y[0];
        out[row][1] = (double)(y[1] - y[0]);
        out[row][2] = (double)y[2];
        out[row][3] = (double)(y[3] - y[2]);
        for (int i = 0; i < steps && row < ROWS; i++)
            step(rods, (long double)duration / ROWS / steps, y);
    }
}

static double apart(double a[ROWS + 1][4], double b[ROWS + 1][4])
{
    double most = 0;

    for (int row = 0; row <= ROWS; row++)
        for (int i = 0; i < 4; i++)
            most = fmax(most, fabs(a[row][i] - b[row][i]));
    return most;
}

static Verdict rods_fall(Member *m)
{
    static const char *const items[] = {"h", "k", "h'", "k'"};
    const Rods rods = {{member_decades(m, 0.3, 3), member_decades(m, 0.3, 3)},
                       {member_between(m, 0.5, 2), member_between(m, 0.5, 2)}};
    const double from[2] = {member_between(m, -3, 3), member_between(m, -3, 3)};
    const double duration = member_between(m, 2, 12);
    const Way *way = draw_way(m);
    double right[ROWS + 1][4], coarser[ROWS + 1][4], got[ROWS + 1][4], unsure = INFINITY;
    Kit kit = kit_new();
    Verdict verdict = DISAGREES;
    bool done;

    script.length = 0;
    write_line(&script, "scene planar\ngravity [0, -%g]", GRAVITY);
    for (int i = 0; i < 2; i++)
        write_line(&script,
                   "body b%d mass=%.17g inertia=%.17g\narm u%d b%d [0, %.17g]\n"
                   "arm d%d b%d [0, -%.17g]",
                   i, rods.mass[i], rods.mass[i] * rods.length[i] * rods.length[i] / 12, i, i,
                   rods.length[i] / 2, i, i, rods.length[i] / 2);
    write_line(&script,
               "revolute h ground u0\nrevolute k d0 u1\ntree joint\ninit h = %.17g, "
               "k = %.17g",
               from[0], from[1]);
    write_run(m, way, duration, 1e-4);
    tell(m, "%s", script.text);
    follow(&rods, from, duration, 200, right);
    for (int steps = 400; steps <= 12800 && unsure > 1e-9; steps *= 2) {
        memcpy(coarser, right, sizeof right);
        follow(&rods, from, duration, steps, right);
        unsure = apart(right, coarser) / 15;
    }
    done = kit_do(&kit, script.text) == CT_OK;
    for (int row = 0; row <= ROWS && done; row++)
        done = read_row(&kit, items, 4, row, duration, got[row]);
    if (done)
        verdict = judge(m, &kit, apart(right, got), 10 * unsure);
    else
        tell(m, "%s\n", kit.error.message);
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"pendulums are as wrong as check=on says", 40, 0, 0, pendulums},
        {"networks are as wrong as check=on says", 40, 0, 0, networks},
        {"two rods are as wrong as check=on says", 24, 0.1, 0, rods_fall},
    };

    return family_main(families, COUNT(families), argc, argv);
}
