/* family_pulses.c: what conducts or acts for a short time, against fixed steps and closed forms
 *
 * Supplies: rectifier, doubler and bridge of exponential diodes behind a source of five kinds. The
 * reference is the classical Runge-Kutta method on equations written here, with steps that are
 * halved until two runs agree. Bursts: a Gaussian pulse of a current into a capacitor, or of a
 * force on a cart, anywhere in a long run; the answer is an error function. */
#include "../unit/session_kit.h"
#include "family.h"
#include "one_node.h"

#include <math.h>

#define PI      3.14159265358979323846
#define THERMAL (1.380649e-23 * 300.15 / 1.602176634e-19)
#define LEAKAGE 1e-12
#define MOST    4e5 /* steps of a reference */
#define PLACES  12  /* at which states are compared */
#define MISSES  100 /* tolerances by which a run may be off, */
#define ADDED   60  /* and by what adds up over the steps of one pulse */

static const char *const methods[] = {"auto", "dop853", "radau", "bdf", "adams", "ida"};

/* --- supplies --- */

typedef enum Circuit { RECTIFIER, DOUBLER, BRIDGE, CIRCUITS } Circuit;
typedef enum Shape { SINE, TWO_SINES, PULSES, AMPLITUDE, CHIRP, SHAPES } Shape;

typedef struct Supply {
    Circuit circuit;
    Shape shape;
    double peak, f, ratio, duty;
    double Rs, C, RL, Is, n;
    double Ca; /* of the doubler */
    double duration;
} Supply;

static double source(const Supply *s, double t)
{
    const double w = 2 * PI * s->f;

    switch (s->shape) {
    case SINE:
        return s->peak * sin(w * t);
    case TWO_SINES:
        return s->peak * (0.7 * sin(w * t) + 0.3 * sin(s->ratio * w * t));
    case PULSES: /* narrow where duty is small */
        return s->peak * exp((cos(w * t) - 1) / (s->duty * s->duty));
    case AMPLITUDE:
        return s->peak * (1 + 0.5 * sin(w * t / s->ratio)) / 1.5 * sin(w * t);
    default:
        return s->peak * sin(w * t * (1 + t / s->duration));
    }
}

static void print_source(const Supply *s, char *out, size_t room)
{
    const double w = 2 * PI * s->f;

    switch (s->shape) {
    case SINE:
        (void)snprintf(out, room, "%.17g*sin(%.17g*t)", s->peak, w);
        break;
    case TWO_SINES:
        (void)snprintf(out, room, "%.17g*(0.7*sin(%.17g*t) + 0.3*sin(%.17g*t))", s->peak, w,
                       s->ratio * w);
        break;
    case PULSES:
        (void)snprintf(out, room, "%.17g*exp((cos(%.17g*t) - 1)/%.17g)", s->peak, w,
                       s->duty * s->duty);
        break;
    case AMPLITUDE:
        (void)snprintf(out, room, "%.17g*(1 + 0.5*sin(%.17g*t))/1.5*sin(%.17g*t)", s->peak,
                       w / s->ratio, w);
        break;
    default:
        (void)snprintf(out, room, "%.17g*sin(%.17g*t*(1 + t/%.17g))", s->peak, w, s->duration);
    }
}

static double diode(const Supply *s, double v, double *slope)
{
    return diode_current(s->Is, s->n * THERMAL, LEAKAGE, v, slope);
}

/* what flows out of a node at v: into one diode up to `top`, less what comes up from 0 by another
 */
static double segment(const Supply *s, double v, double top, double *slope)
{
    double up, down;
    const double i = diode(s, v - top, &up) - diode(s, -v, &down);

    *slope = up + down;
    return i;
}

/* residual of the one node that isn't a state, rising in v */
static double node(const void *of, double t, const double *x, double v, double *slope)
{
    const Supply *s = of;
    const double E = source(s, t);
    double i, below;

    switch (s->circuit) {
    case RECTIFIER: /* v at the anode */
        i = diode(s, v - x[0], slope);
        *slope += 1 / s->Rs;
        return i - (E - v) / s->Rs;
    case DOUBLER: /* v between the diodes; x = upper, series */
        i = segment(s, v, x[0], slope);
        *slope += 1 / s->Rs;
        return i - (E - v - x[1]) / s->Rs;
    default: /* v behind the resistor, the other end of the source is at v + Rs i - E */
        i = segment(s, v, x[0], slope);
        i += segment(s, v + s->Rs * i - E, x[0], &below);
        *slope += below * (1 + s->Rs * *slope);
        return i;
    }
}

static void rates(const Supply *s, double t, const double *x, double *v, double *out)
{
    const double E = source(s, t);
    double slope, i;

    *v = solve_node(node, s, t, x, fabs(E) + fabs(x[0]) + fabs(x[1]) + 10, *v);
    switch (s->circuit) {
    case RECTIFIER:
        out[0] = ((E - *v) / s->Rs - x[0] / s->RL) / s->C;
        out[1] = 0;
        break;
    case DOUBLER:
        out[0] = (diode(s, *v - x[0], &slope) - x[0] / s->RL) / s->C;
        out[1] = (E - *v - x[1]) / s->Rs / s->Ca;
        break;
    default:
        i = segment(s, *v, x[0], &slope);
        out[0] = (diode(s, *v - x[0], &slope) + diode(s, *v + s->Rs * i - E - x[0], &slope) -
                  x[0] / s->RL) /
                 s->C;
        out[1] = 0;
    }
}

static void fixed_steps(const Supply *s, double steps, double *out)
{
    const double h = s->duration / (steps * PLACES);
    double x[2] = {0, 0}, k[4][2], y[2], v = 0;

    for (int p = 0; p < PLACES; p++) {
        for (int j = 0; j < steps; j++) {
            const double t = s->duration * p / PLACES + h * j;

            rates(s, t, x, &v, k[0]);
            for (int stage = 1; stage < 4; stage++) {
                const double part = stage == 3 ? h : h / 2;

                for (int i = 0; i < 2; i++)
                    y[i] = x[i] + part * k[stage - 1][i];
                rates(s, t + part, y, &v, k[stage]);
            }
            for (int i = 0; i < 2; i++)
                x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
        }
        out[p] = x[0];
    }
}

/* Two runs and what they extrapolate to; false: not to be had within so many steps. */
static bool refer(const Supply *s, double error, double *out)
{
    const double fast = s->Rs * (s->circuit == DOUBLER ? fmin(s->C, s->Ca) : s->C);
    double steps = ceil(s->duration / PLACES / fmin(fast / 3, s->duty / s->f / 100));
    double coarse[PLACES];

    if (2 * steps * PLACES > MOST)
        return false;
    fixed_steps(s, steps, coarse);
    for (steps *= 2; steps * PLACES < MOST; steps *= 2) {
        double off = 0;

        fixed_steps(s, steps, out);
        for (int p = 0; p < PLACES; p++)
            off = isnan(out[p] - coarse[p]) ? INFINITY : fmax(off, fabs(out[p] - coarse[p]));
        if (off / 15 < error) {
            for (int p = 0; p < PLACES; p++)
                out[p] += (out[p] - coarse[p]) / 15;
            return true;
        }
        memcpy(coarse, out, sizeof coarse);
    }
    return false;
}

static Supply random_supply(Member *m)
{
    Supply s = {.circuit = (Circuit)member_one_of(m, CIRCUITS),
                .shape = (Shape)member_one_of(m, SHAPES)};
    double period, fast;

    s.peak = member_decades(m, 3, 300);
    s.f = member_decades(m, 10, 1e5);
    s.ratio = member_between(m, 2.2, 6);
    s.duty = s.shape == PULSES ? member_between(m, 0.1, 0.5) : 0.5;
    period = 1 / s.f;
    fast = member_decades(m, 3e-3, 0.3) * period;
    s.Rs = member_decades(m, 0.1, 1000);
    s.C = fast / s.Rs;
    s.Ca = s.C * member_between(m, 0.5, 2);
    s.RL = member_decades(m, 1, 1e4) * period / s.C;
    s.Is = member_decades(m, 1e-16, 1e-9);
    s.n = member_between(m, 1, 2);
    s.duration = member_between(m, 3, 8) * period;
    return s;
}

static void print_supply(const Supply *s, char *out, size_t room)
{
    const char *const end = s->circuit == BRIDGE ? "e" : "0";
    char value[300];
    int at;

    print_source(s, value, sizeof value);
    at = snprintf(out, room,
                  "vsource V p %s %s\nresistor Rs p s %.17g\ncapacitor C b 0 %.17g\n"
                  "resistor RL b 0 %.17g\ninit C.v = 0\n",
                  end, value, s->Rs, s->C, s->RL);
    if (s->circuit == RECTIFIER)
        (void)snprintf(out + at, room - (size_t)at, "diode D s b Is=%.17g n=%.17g\n", s->Is, s->n);
    else if (s->circuit == DOUBLER)
        (void)snprintf(out + at, room - (size_t)at,
                       "capacitor Ca s a %.17g\ndiode Da 0 a Is=%.17g n=%.17g\n"
                       "diode Db a b Is=%.17g n=%.17g\ninit Ca.v = 0\n",
                       s->Ca, s->Is, s->n, s->Is, s->n);
    else
        (void)snprintf(out + at, room - (size_t)at,
                       "diode D1 s b Is=%.17g n=%.17g\ndiode D2 e b Is=%.17g n=%.17g\n"
                       "diode D3 0 s Is=%.17g n=%.17g\ndiode D4 0 e Is=%.17g n=%.17g\n",
                       s->Is, s->n, s->Is, s->n, s->Is, s->n, s->Is, s->n);
}

/* how far a run is off at the places, in tolerances */
static double run_off(Member *m, Kit *kit, const Supply *s, double rtol, const double *right)
{
    double off = 0;

    for (int p = 0; p < PLACES; p++) {
        char expression[100];
        double got;

        (void)snprintf(expression, sizeof expression, "C.v at %.17g",
                       p + 1 < PLACES ? s->duration / PLACES * (p + 1) : s->duration);
        got = kit_value(kit, expression);
        off = fmax(off, fabs(got - right[p]) / (rtol * fmax(s->peak, 1)));
        if (!(off <= MISSES))
            tell(m, "  at %g: %.12g for %.12g\n", s->duration * (p + 1) / PLACES, got, right[p]);
        if (isnan(got))
            return INFINITY;
    }
    return off;
}

static Verdict supplies(Member *m)
{
    const char *const method = methods[member_one_of(m, (int)(sizeof methods / sizeof methods[0]))];
    const double rtol = pow(10, -member_between(m, 3, 10));
    const Supply s = random_supply(m);
    double right[PLACES], off;
    char text[2000], run[200];
    Kit kit;

    if (!refer(&s, 3 * rtol * fmax(s.peak, 1), right))
        return AGREES; /* nobody knows */
    kit = kit_new();
    print_supply(&s, text, sizeof text);
    if (m->told)
        printf("%s", text);
    (void)snprintf(run, sizeof run, "simulate %.17g every=%.17g rtol=%.3g method=%s\n", s.duration,
                   s.duration / PLACES, rtol, method);
    tell(m, "%s%s", text, run);
    if (kit_do(&kit, text) != CT_OK || kit_do(&kit, run) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        kit_free(&kit);
        return REFUSED;
    }
    off = run_off(m, &kit, &s, rtol, right);
    tell(m, "off by %.3g tolerances\n", off);
    kit_free(&kit);
    return off <= MISSES ? AGREES : DISAGREES;
}

/* --- bursts --- */

/* A pulse of a function of t in a long run: what it adds, and how a cart goes on. */
static Verdict bursts(Member *m)
{
    const char *const method = methods[member_one_of(m, (int)(sizeof methods / sizeof methods[0]))];
    const double rtol = pow(10, -member_between(m, 3, 9));
    const double span = member_decades(m, 0.1, 1e4), width = span * member_decades(m, 1e-6, 1e-2);
    const double top = span * member_between(m, 0.1, 0.9),
                 height = member_decades(m, 1, 1e3) / width;
    const double mass = member_decades(m, 0.1, 10), area = height * width * sqrt(PI);
    const bool is_cart = member_one_of(m, 2) == 0;
    char text[1000];
    Kit kit = kit_new();
    double speed, off;

    if (is_cart)
        (void)snprintf(text, sizeof text,
                       "scene planar\ngravity [0, 0]\nbody b mass=%.17g\n"
                       "prismatic s ground b axis=x\ninit s = 0, s' = 0\n"
                       "actuator f s force=%.17g*exp(-((t - %.17g)/%.17g)^2)\n"
                       "simulate %.17g rtol=%.3g method=%s\n",
                       mass, height, top, width, span, rtol, method);
    else
        (void)snprintf(text, sizeof text,
                       "capacitor C b 0 %.17g\ninit C.v = 0\n"
                       "isource I 0 b %.17g*exp(-((t - %.17g)/%.17g)^2)\n"
                       "simulate %.17g rtol=%.3g method=%s\n",
                       mass, height, top, width, span, rtol, method);
    tell(m, "%s", text);
    if (kit_do(&kit, text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        kit_free(&kit);
        return REFUSED;
    }
    speed = kit_value(&kit, is_cart ? "s'" : "C.v");
    off = fabs(speed - area / mass) / (rtol * fmax(1, area / mass));
    tell(m, "%.12g for %.12g: off by %.3g tolerances\n", speed, area / mass, off);
    kit_free(&kit);
    return off <= ADDED ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"supplies_are_what_fixed_steps_find", 40, 0, 1e-3, supplies},
        {"bursts_in_long_runs_are_seen", 60, 0, 0, bursts},
    };

    (void)test_faults; /* verdicts count here */
    return family_main(families, 2, argc, argv);
}
