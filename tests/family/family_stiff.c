/* family_stiff.c: stiff machines, against their written ordinary differential equations
 *
 * Forces are much faster than the motion: a knife edge as a viscous force, a joint that a stiff
 * spring and damper hold, a ladder of resistors and capacitors at a slow voltage. radau and `auto`
 * have to keep their tolerance, and `auto` has to find stiffness early: it begins with dop853. */
#include "../unit/session_kit.h"
#include "family.h"
#include "implicit_euler.h"
#include "script.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))
#define MISSES       10   /* tolerances by which a run may be off */
#define BEGINS       500  /* evaluations of dop853 before stiffness is found */
#define SURE         1e-9 /* of the largest value: what the steps here may be off */

enum { ROWS = 5, LOOKS = 4 };

typedef struct Stiff {
    StiffProblem problem;
    Real y[STIFF_STATES]; /* at the start */
    double span;
    const char *look[LOOKS]; /* what is compared, */
    double (*value)(const void *context, const Real *y, int look);
    double scale[LOOKS]; /* and its size */
    int looks;
} Stiff;

/* --- a knife edge --- */

/* in the frame of the body: speeds u along it and v across it of its centre, turn w; the edge is at
 * -a, where it moves across by n = v - a w:  m (u' - v w) = 0,  m (v' + u w) = -D n,  J w' = a D n
 */
typedef struct Knife {
    double m, J, a, D;
} Knife;

static void knife_rates(const void *context, const Real *y, Real *rates)
{
    const Knife *k = context;
    const Real u = y[0], v = y[1], w = y[2], n = v - k->a * w;

    rates[0] = v * w;
    rates[1] = -u * w - k->D * n / k->m;
    rates[2] = k->a * k->D * n / k->J;
    rates[3] = w;
}

static double knife_value(const void *context, const Real *y, int look)
{
    (void)context;
    return (double)(look == 0   ? y[2]
                    : look == 1 ? y[0] * cosl(y[3]) - y[1] * sinl(y[3])
                                : y[0] * sinl(y[3]) + y[1] * cosl(y[3]));
}

static void knife_draw(Member *m, Script *text, Knife *k, Stiff *s)
{
    const double speed = member_decades(m, 0.1, 10), turn = member_between(m, -3, 3),
                 angle = member_between(m, -3, 3), length = member_decades(m, 0.1, 2),
                 u = speed * member_between(m, -1, 1), v = speed * member_between(m, -1, 1);
    double size;

    *k = (Knife){.m = member_decades(m, 0.1, 10)};
    k->J = k->m * length * length * member_decades(m, 0.3, 3);
    k->a = length * member_between(m, -1, 1);
    s->span = member_between(m, 1, 4) * length / speed;
    k->D = k->m / s->span * member_decades(m, 1e3, 1e10);
    s->problem.rates = knife_rates;
    s->problem.count = 4;
    s->y[0] = u;
    s->y[1] = v;
    s->y[2] = turn * speed / length;
    s->y[3] = angle;
    s->value = knife_value;
    s->looks = 3;
    s->look[0] = "b.theta'";
    s->look[1] = "b.vx";
    s->look[2] = "b.vy";
    size = sqrt(u * u + v * v + k->J / k->m * (double)(s->y[2] * s->y[2]));
    s->scale[0] = size / length;
    s->scale[1] = s->scale[2] = size;
    write_line(text, "scene planar\nbody b mass=%.17g inertia=%.17g\nfree f ground b", k->m, k->J);
    write_line(text, "arm k b [%.17g, 0]\noutput n = -k.vx*sin(b.theta) + k.vy*cos(b.theta)",
               -k->a);
    write_line(text, "force F k [%.17g*n*sin(b.theta), -%.17g*n*cos(b.theta)]", k->D, k->D);
    write_line(text, "init b.vx = %.17g, b.vy = %.17g, b.theta = %.17g, b.theta' = %.17g",
               u * cos(angle) - v * sin(angle), u * sin(angle) + v * cos(angle), angle,
               (double)s->y[2]);
}

/* --- a stiff joint --- */

/* Two bars of lengths L, centres in the middle, angles p and q = p + r: with c, s of r,
 * [A, B c; B c, C] [p''; q''] = [B s q'^2 - (m1/2 + m2) g L1 cos p + M; -B s p'^2 - m2 g L2/2 cos q
 * - M], M = k r + d r' */
typedef struct Links {
    double m[2], L[2], J[2], k, d, g;
} Links;

static void links_rates(const void *context, const Real *y, Real *rates)
{
    const Links *l = context;
    const Real A = l->J[0] + l->m[0] * l->L[0] * l->L[0] / 4 + l->m[1] * l->L[0] * l->L[0],
               B = l->m[1] * l->L[0] * l->L[1] / 2, C = l->J[1] + l->m[1] * l->L[1] * l->L[1] / 4,
               c = B * cosl(y[1]), s = B * sinl(y[1]), q = y[2] + y[3],
               M = l->k * y[1] + l->d * y[3],
               f = s * q * q - (l->m[0] / 2 + l->m[1]) * l->g * l->L[0] * cosl(y[0]) + M,
               e = -s * y[2] * y[2] - l->m[1] * l->g * l->L[1] / 2 * cosl(y[0] + y[1]) - M;

    rates[0] = y[2];
    rates[1] = y[3];
    rates[2] = (C * f - c * e) / (A * C - c * c);
    rates[3] = (A * e - c * f) / (A * C - c * c) - rates[2];
}

static double links_value(const void *context, const Real *y, int look)
{
    (void)context;
    return (double)(look == 0 ? y[0] : look == 1 ? y[2] : y[1]);
}

static void links_draw(Member *m, Script *text, Links *l, Stiff *s)
{
    const double p = member_between(m, -3, 0), bend = member_one_of(m, 2) ? 0 : 0.01;
    double inertia, rate;

    l->g = 9.81;
    for (int i = 0; i < 2; i++) {
        l->m[i] = member_decades(m, 0.3, 3);
        l->L[i] = member_decades(m, 0.3, 1);
        l->J[i] = l->m[i] * l->L[i] * l->L[i] / 12;
    }
    inertia = 1 / (1 / (l->J[0] + l->m[0] * l->L[0] * l->L[0] / 4) +
                   1 / (l->J[1] + l->m[1] * l->L[1] * l->L[1] / 4));
    rate = member_decades(m, 1e2, 1e5);
    l->k = inertia * rate * rate;
    l->d = 2 * inertia * rate * member_decades(m, 1, 100);
    s->span = member_between(m, 0.3, 1);
    s->problem.rates = links_rates;
    s->problem.count = 4;
    s->y[0] = p;
    s->y[1] = bend;
    s->y[2] = member_between(m, -3, 3);
    s->value = links_value;
    s->looks = 3;
    s->look[0] = "h1";
    s->look[1] = "h1'";
    s->look[2] = "h2";
    s->scale[0] = s->scale[2] = 1;
    s->scale[1] = 10;
    write_line(text, "scene planar\ngravity [0, -9.81]");
    write_line(text, "body b1 mass=%.17g inertia=%.17g\nbody b2 mass=%.17g inertia=%.17g", l->m[0],
               l->J[0], l->m[1], l->J[1]);
    write_line(text, "arm a1 b1 [%.17g, 0]\narm e1 b1 [%.17g, 0]\narm a2 b2 [%.17g, 0]",
               -l->L[0] / 2, l->L[0] / 2, -l->L[1] / 2);
    write_line(text, "revolute h1 ground a1\nrevolute h2 e1 a2");
    write_line(text, "spring k h2 k=%.17g\ndamper d h2 d=%.17g", l->k, l->d);
    if (member_one_of(m, 2))
        write_line(text, "tree absolute");
    write_line(text, "init h1 = %.17g, h2 = %.17g, h1' = %.17g, h2' = 0", p, bend, (double)s->y[2]);
}

/* --- a ladder --- */

/* C_i v_i' = (v_{i-1} - v_i)/R_i - (v_i - v_{i+1})/R_{i+1}, v_0 = sin(w t) */
typedef struct Ladder {
    int count;
    double R[STIFF_STATES], C[STIFF_STATES], w;
} Ladder;

static void ladder_rates(const void *context, const Real *y, Real *rates)
{
    const Ladder *l = context;

    for (int i = 0; i < l->count; i++) {
        const Real in = ((i == 0 ? sinl(l->w * y[l->count]) : y[i - 1]) - y[i]) / l->R[i],
                   out = i + 1 < l->count ? (y[i] - y[i + 1]) / l->R[i + 1] : 0;

        rates[i] = (in - out) / l->C[i];
    }
    rates[l->count] = 1;
}

static double ladder_value(const void *context, const Real *y, int look)
{
    (void)context;
    return (double)y[look];
}

static void ladder_draw(Member *m, Script *text, Ladder *l, Stiff *s)
{
    static const char *const names[] = {"C0.v", "C1.v", "C2.v"};
    const double rate = member_decades(m, 1, 1e5);

    l->count = 1 + member_one_of(m, COUNT(names));
    l->w = rate * member_decades(m, 1e-4, 1);
    s->span = member_between(m, 1, 10) / l->w;
    write_line(text, "vsource E n0 0 sin(%.17g*t)", l->w);
    for (int i = 0; i < l->count; i++) {
        l->R[i] = member_decades(m, 1, 1e5);
        l->C[i] = member_decades(m, 0.1, 10) / (rate * l->R[i]);
        write_line(text, "resistor R%d n%d n%d %.17g\ncapacitor C%d n%d 0 %.17g", i, i, i + 1,
                   l->R[i], i, i + 1, l->C[i]);
        s->look[i] = names[i];
        s->scale[i] = 1;
    }
    s->problem.rates = ladder_rates;
    s->problem.count = l->count + 1;
    s->value = ladder_value;
    s->looks = l->count;
}

/* --- members --- */

typedef union Machine {
    Knife knife;
    Links links;
    Ladder ladder;
} Machine;

static void machine_draw(Member *m, int kind, Script *text, Machine *machine, Stiff *s)
{
    *text = (Script){0};
    *s = (Stiff){.problem = {.context = machine, .enough = 1e-12L}};
    if (kind == 0)
        knife_draw(m, text, &machine->knife, s);
    else if (kind == 1)
        links_draw(m, text, &machine->links, s);
    else
        ladder_draw(m, text, &machine->ladder, s);
}

static bool is_close(Member *m, Kit *kit, Stiff *s, double rtol)
{
    Real y[STIFF_STATES], step = s->span * 1e-12L;
    bool close = true;

    memcpy(y, s->y, sizeof y);
    for (int row = 1; row <= ROWS; row++) {
        if (!stiff_run(&s->problem, s->span / ROWS, &step, y)) {
            tell(m, "the oracle has no answer\n");
            return false;
        }
        for (int i = 0; i < s->looks; i++) {
            const double wanted = s->value(s->problem.context, y, i);
            char look[80];
            double got;

            (void)snprintf(look, sizeof look, "%s at %.17g", s->look[i], row * s->span / ROWS);
            got = kit_value(kit, look);
            if (!keeps(m, look, fabs(got - wanted) / s->scale[i], MISSES * rtol + SURE)) {
                tell(m, "%s is %.12g, not %.12g\n", look, got, wanted);
                close = false;
            }
        }
    }
    return close;
}

static Verdict accurate_member(Member *m)
{
    static const char *const methods[] = {"radau", "auto"};
    static Script text;
    Machine machine;
    Stiff s;
    const int kind = member_one_of(m, 3);
    const double rtol = member_decades(m, 1e-9, 1e-4);
    Kit kit = kit_new();
    Verdict verdict = REFUSED;

    machine_draw(m, kind, &text, &machine, &s);
    write_line(&text, "simulate %.17g every=%.17g rtol=%.3g method=%s", s.span, s.span / ROWS, rtol,
               methods[member_one_of(m, COUNT(methods))]);
    tell(m, "%s", text.text);
    if (kit_do(&kit, text.text) != CT_OK)
        tell(m, "%s\n%s\n", kit.error.message, kit.error.hint);
    else
        verdict = is_close(m, &kit, &s, rtol) ? AGREES : DISAGREES;
    kit_free(&kit);
    return verdict;
}

/* evaluations by one method; 0: it failed */
static double evaluations_of(Member *m, Kit *kit, const Stiff *s, double rtol, const char *method)
{
    ct_figures figures;
    char line[200];

    (void)snprintf(line, sizeof line, "simulate %.17g every=%.17g rtol=%.3g method=%s\n", s->span,
                   s->span / ROWS, rtol, method);
    if (kit_do(kit, line) != CT_OK || !ct_run_figures(kit->session, 0, &figures))
        return 0;
    tell(m, "%s: %lld evaluations, ends with %s\n", method, (long long)figures.evaluations,
         figures.method);
    return (double)figures.evaluations;
}

static Verdict cheap_member(Member *m)
{
    static Script text;
    Machine machine;
    Stiff s;
    const int kind = member_one_of(m, 3);
    const double rtol = member_decades(m, 1e-9, 1e-4);
    Kit kit = kit_new();
    Verdict verdict = REFUSED;

    machine_draw(m, kind, &text, &machine, &s);
    tell(m, "%s", text.text);
    if (kit_do(&kit, text.text) == CT_OK) {
        const double by_auto = evaluations_of(m, &kit, &s, rtol, "auto"),
                     radau = evaluations_of(m, &kit, &s, rtol, "radau"), most = 2 * radau + BEGINS;

        verdict = keeps(m, "evaluations", by_auto, most) ? AGREES : DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

static const Family families[] = {
    /* between steps of slow ladders radau may be 20 tolerances off: 1 in 1000 at 1e-9 */
    {"stiff machines move as their equations do", 30, 0, 0.002, accurate_member},
    /* of ladders that are hardly stiff, ten times as fast as their voltage, some stay with dop853
     */
    {"auto finds stiffness at little cost", 30, 0, 0.05, cheap_member},
};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}
