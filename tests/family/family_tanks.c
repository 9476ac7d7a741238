/* family_tanks.c: tanks, pipes, valves and weirs, against the written ordinary differential
 * equations
 *
 * Each node of a network holds a tank of capacity C = A/(rho g) and pressure p, so that
 *
 *     C_i p_i' = sum of the flows into i
 *
 * A pipe (R, k) between pressures that differ by p carries q with R q + k q |q| = p, a weir of
 * coefficient c, its edge at height e, c (p/(rho g) - e)^1.5 above its edge and nothing below.
 * Networks are integrated here by small steps of the classical Runge-Kutta method, which end where
 * a valve turns. Single tanks have closed forms. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))
#define RHO_G        9810.0 /* water, N/m^3 */
#define MISSES       100    /* tolerances by which a run may be off */
#define SURE         1e-8   /* of the largest pressure: what the steps here may be off */

enum { TANKS = 4, FLOWS = 9, STEPS = 20000, ROWS = 7 };

static const char *const methods[] = {"auto", "dop853", "radau", "bdf", "adams", "ida"};

typedef enum FlowKind { PIPE, TIMED, CHECK_VALVE, SIPHON, WEIR, PUMP, FLOW_KINDS } FlowKind;

/* from tank `from` to tank `to`; -1: the outside at pressure 0, or for SIPHON one of 1 MPa */
typedef struct Flow {
    FlowKind kind;
    int from, to;
    double R, k;            /* Pa*s/m^3, Pa*s^2/m^6 */
    double swing, w;        /* R (1 + swing sin(w t)) */
    double c, edge;         /* weir: m^1.5/s, m */
    double rate, level, at; /* pump: m^3/s; siphon: Pa; valve: s */
    bool open;
} Flow;

typedef struct Tanks {
    int count, flows;
    double A[TANKS], p[TANKS]; /* m^2, Pa at first */
    Flow flow[FLOWS];
    double span;
} Tanks;

/* --- the equations --- */

/* the flow at which R q + k q |q| = p */
static double pipe_flow(double R, double k, double p)
{
    return p == 0 ? 0 : 2 * p / (R + sqrt(R * R + 4 * k * fabs(p)));
}

static double flow_of(const Flow *f, double t, const double *p)
{
    const double source = f->kind == SIPHON ? 1e6 : 0;
    const double drop = (f->from < 0 ? source : p[f->from]) - (f->to < 0 ? 0 : p[f->to]);
    const double R = f->R * (1 + f->swing * sin(f->w * t));

    switch (f->kind) {
    case WEIR:
        return p[f->from] / RHO_G > f->edge ? f->c * pow(p[f->from] / RHO_G - f->edge, 1.5) : 0;
    case PUMP:
        return f->rate * (1 + f->swing * sin(f->w * t));
    case CHECK_VALVE:
        return drop > 0 ? pipe_flow(R, f->k, drop) : 0;
    default:
        return f->open ? pipe_flow(R, f->k, drop) : 0;
    }
}

static void tank_rates(const Tanks *s, double t, const double *p, double *rates)
{
    for (int i = 0; i < s->count; i++)
        rates[i] = 0;
    for (int n = 0; n < s->flows; n++) {
        const Flow *f = &s->flow[n];
        const double q = flow_of(f, t, p);

        if (f->from >= 0)
            rates[f->from] -= q * RHO_G / s->A[f->from];
        if (f->to >= 0)
            rates[f->to] += q * RHO_G / s->A[f->to];
    }
}

static void tanks_step(const Tanks *s, double t, double h, double *p)
{
    double at[TANKS], rates[TANKS], sum[TANKS] = {0};

    memcpy(at, p, sizeof at);
    for (int stage = 0; stage < 4; stage++) {
        const double along = stage < 2 ? h / 2 : h;

        tank_rates(s, t + (stage == 0 ? 0 : stage < 3 ? h / 2 : h), at, rates);
        for (int i = 0; i < s->count; i++) {
            sum[i] += (stage == 0 || stage == 3 ? 1 : 2) * rates[i];
            at[i] = p[i] + along * rates[i];
        }
    }
    for (int i = 0; i < s->count; i++)
        p[i] += h / 6 * sum[i];
}

static bool is_open(const Flow *f, double t, const double *p)
{
    return f->kind == TIMED ? t > f->at : f->kind == SIPHON ? p[f->to] > f->level : true;
}

/* whether a valve turns; it does so in *s with `set` */
static bool valve_turns(Tanks *s, double t, const double *p, bool set)
{
    bool turns = false;

    for (int n = 0; n < s->flows; n++) {
        const bool open = is_open(&s->flow[n], t, p);

        turns = turns || open != s->flow[n].open;
        if (set)
            s->flow[n].open = open;
    }
    return turns;
}

/* p from t to `end`; a step in which a valve turns is cut there by bisection */
static void tanks_run(Tanks *s, double t, double end, double *p)
{
    const double step = s->span / STEPS;

    (void)valve_turns(s, t, p, true);
    while (t < end * (1 - 1e-14)) {
        double high = fmin(step, end - t), low = 0, tried[TANKS];

        memcpy(tried, p, sizeof tried);
        tanks_step(s, t, high, tried);
        if (valve_turns(s, t + high, tried, false)) {
            for (int k = 0; k < 60; k++) {
                const double half = (low + high) / 2;

                memcpy(tried, p, sizeof tried);
                tanks_step(s, t, half, tried);
                *(valve_turns(s, t + half, tried, false) ? &high : &low) = half;
            }
            memcpy(tried, p, sizeof tried);
            tanks_step(s, t, high, tried);
        }
        memcpy(p, tried, sizeof tried);
        t += high;
        (void)valve_turns(s, t, p, true);
    }
}

/* --- members --- */

static void flow_draw(Member *m, Tanks *s, bool closed, Flow *f)
{
    const double q = s->A[0] * 2 / s->span; /* fills 2 m in the run */

    *f = (Flow){.kind = (FlowKind)member_one_of(m, closed ? CHECK_VALVE + 1 : FLOW_KINDS),
                .from = member_one_of(m, s->count),
                .to = -1};
    if (s->count > 1 && (closed || member_one_of(m, 2)))
        f->to = (f->from + 1 + member_one_of(m, s->count - 1)) % s->count;
    if (closed && member_one_of(m, 3) == 0)
        f->kind = WEIR;
    f->R = member_one_of(m, 3) ? member_decades(m, 0.1, 10) * RHO_G / q : 0;
    f->k = f->R == 0 || member_one_of(m, 2) ? member_decades(m, 0.1, 10) * RHO_G / (q * q) : 0;
    f->swing = member_one_of(m, 2) ? member_between(m, 0.1, 0.8) : 0;
    f->w = member_decades(m, 1, 30) / s->span;
    f->c = q * member_decades(m, 0.3, 30);
    f->edge = member_between(m, 0.1, 3);
    f->rate = q * member_between(m, 0.1, 2);
    f->at = s->span * member_between(m, 0.1, 0.9);
    f->level = RHO_G * member_between(m, 0.5, 3);
    if (f->kind == SIPHON || f->kind == PUMP) { /* into a tank */
        f->to = f->from;
        f->from = -1;
    }
    if (f->kind == SIPHON) /* slow by its head of 100 m */
        f->R += 100 * RHO_G / q;
}

static bool tanks_draw(Member *m, Tanks *s)
{
    const bool closed = member_one_of(m, 3) == 0;

    *s = (Tanks){.count = 1 + closed + member_one_of(m, TANKS - closed),
                 .span = member_decades(m, 1, 1e4)};
    if (s->count > TANKS)
        s->count = TANKS;
    for (int i = 0; i < s->count; i++) {
        s->A[i] = i == 0 ? member_decades(m, 0.01, 100) : s->A[0] * member_decades(m, 0.3, 3);
        s->p[i] = member_one_of(m, 4) ? RHO_G * member_between(m, 0, 3) : 0;
    }
    s->flows = 1 + member_one_of(m, FLOWS);
    for (int n = 0; n < s->flows; n++)
        flow_draw(m, s, closed, &s->flow[n]);
    return closed;
}

static void node_write(Script *text, int tank)
{
    write_piece(text, tank < 0 ? " 0" : " n%d", tank);
}

static void flow_write(Script *text, const Flow *f, int n)
{
    static const char *const words[] = {"pipe", "valve", "valve", "valve", "pump", "pump"};
    char wave[100];

    (void)snprintf(wave, sizeof wave, "(1 + %.17g*sin(%.17g*t))", f->swing, f->w);
    if (f->kind == SIPHON)
        write_line(text, "pump S%d s%d 0 pressure=1e6", n, n);
    write_piece(text, "%s Q%d", words[f->kind], n);
    if (f->kind == SIPHON)
        write_piece(text, " s%d", n);
    else if (f->kind != PUMP)
        node_write(text, f->from);
    if (f->kind != PUMP || f->to >= 0)
        node_write(text, f->to);
    if (f->kind == PUMP)
        node_write(text, f->from);
    if (f->kind == WEIR)
        write_line(text, " flow=-1*if(n%d.p > %.17g, %.17g*(n%d.p/9810 - %.17g)^1.5, 0)", f->from,
                   f->edge * RHO_G, f->c, f->from, f->edge);
    else if (f->kind == PUMP)
        write_line(text, " flow=%.17g*%s", f->rate, wave);
    else {
        if (f->R > 0)
            write_piece(text, " R=%.17g*%s", f->R, wave);
        if (f->k > 0)
            write_piece(text, " k=%.17g", f->k);
        if (f->kind == TIMED)
            write_piece(text, " when=t > %.17g", f->at);
        else if (f->kind == CHECK_VALVE)
            write_piece(text, " when=Q%d.p > 0", n);
        else if (f->kind == SIPHON)
            write_piece(text, " when=n%d.p > %.17g", f->to, f->level);
        write_line(text, "%s", "");
    }
}

static void tanks_write(Script *text, const Tanks *s)
{
    *text = (Script){0};
    for (int i = 0; i < s->count; i++)
        write_line(text, "tank T%d n%d 0 A=%.17g", i, i, s->A[i]);
    for (int n = 0; n < s->flows; n++)
        flow_write(text, &s->flow[n], n);
    for (int i = 0; i < s->count; i++)
        write_line(text, "init T%d.p = %.17g", i, s->p[i]);
}

/* what is in all of them, m^3 */
static double volume_of(const Tanks *s, const double *p)
{
    double volume = 0;

    for (int i = 0; i < s->count; i++)
        volume += s->A[i] * p[i] / RHO_G;
    return volume;
}

static Verdict tanks_compare(Member *m, Tanks *s, bool closed, Kit *kit, double rtol)
{
    Verdict verdict = AGREES;
    double p[TANKS], scale = RHO_G, volume = 0, size = 0;
    const double bound = fmax(MISSES * rtol, SURE);

    memcpy(p, s->p, sizeof p);
    for (int row = 1; row <= ROWS; row++) {
        tanks_run(s, (row - 1) * s->span / ROWS, row * s->span / ROWS, p);
        for (int i = 0; i < s->count; i++)
            scale = fmax(scale, fabs(p[i]));
        for (int i = 0; i < s->count; i++) {
            char look[80];
            double got;

            (void)snprintf(look, sizeof look, "T%d.p at %.17g", i, row * s->span / ROWS);
            got = kit_value(kit, look);
            if (!keeps(m, look, fabs(got - p[i]) / scale, bound)) {
                tell(m, "%s is %.12g, not %.12g\n", look, got, p[i]);
                verdict = DISAGREES;
            }
        }
    }
    if (!closed)
        return verdict;
    for (int i = 0; i < s->count; i++) {
        char look[20];

        (void)snprintf(look, sizeof look, "T%d.volume", i);
        volume += kit_value(kit, look);
        size += s->A[i] * scale / RHO_G;
    }
    if (!keeps(m, "volume", fabs(volume - volume_of(s, s->p)) / size, fmax(rtol, SURE))) {
        tell(m, "the volume is %.12g, not %.12g\n", volume, volume_of(s, s->p));
        verdict = DISAGREES;
    }
    return verdict;
}

static Verdict network_member(Member *m)
{
    static Script text;
    Tanks s;
    const bool closed = tanks_draw(m, &s);
    const double rtol = member_decades(m, 1e-9, 1e-5);
    const char *method = methods[member_one_of(m, COUNT(methods))];
    Kit kit = kit_new();
    Verdict verdict = REFUSED;

    tanks_write(&text, &s);
    write_line(&text, "simulate %.17g every=%.17g rtol=%.3g method=%s", s.span, s.span / ROWS, rtol,
               method);
    tell(m, "%s", text.text);
    if (kit_do(&kit, text.text) != CT_OK)
        tell(m, "%s\n%s\n", kit.error.message, kit.error.hint);
    else
        verdict = tanks_compare(m, &s, closed, &kit, rtol);
    kit_free(&kit);
    return verdict;
}

/* --- one tank --- */

/* level h of a tank of area A that an orifice empties: h^0.5 falls by t/(2 A sqrt(k/(rho g))), and
 * the tank is dry from there; above a weir's edge u^-0.5 grows by c t/(2 A); through R, h decays */
static Verdict single_member(Member *m)
{
    static const char *const kinds[] = {"orifice", "weir", "pipe"};
    const double A = member_decades(m, 0.01, 100), h = member_decades(m, 0.01, 10),
                 until = member_decades(m, 1, 1e5), part = member_between(m, 0.2, 3),
                 edge = member_one_of(m, 2) ? 0 : member_decades(m, 0.01, 10),
                 rtol = member_decades(m, 1e-9, 1e-5);
    const int kind = member_one_of(m, COUNT(kinds));
    double wanted = 0, got;
    Kit kit = kit_new();
    Script *text = calloc(1, sizeof *text);
    Verdict verdict = REFUSED;

    write_line(text, "tank T a 0 A=%.17g", A);
    if (kind == 0) {                                        /* dry after until/part */
        const double root = 2 * A * sqrt(h) * part / until; /* sqrt(rho g/k) */

        write_line(text, "pipe P a 0 k=%.17g\ninit T.p = %.17g", RHO_G / (root * root), RHO_G * h);
        wanted = part < 1 ? RHO_G * h * (1 - part) * (1 - part) : 0;
    } else if (kind == 1) {
        const double c = 2 * A * part / (sqrt(h) * until);

        write_line(text,
                   "pump P a 0 flow=-1*if(a.p > %.17g, %.17g*(a.p/9810 - %.17g)^1.5, 0)\n"
                   "init T.p = %.17g",
                   RHO_G * edge, c, edge, RHO_G * (edge + h));
        wanted = RHO_G * (edge + h / ((1 + part) * (1 + part)));
    } else {
        write_line(text, "pipe P a 0 R=%.17g\ninit T.p = %.17g", until * RHO_G / (A * part),
                   RHO_G * h);
        wanted = RHO_G * h * exp(-part);
    }
    write_line(text, "simulate %.17g rtol=%.3g method=%s", until, rtol,
               methods[member_one_of(m, COUNT(methods))]);
    tell(m, "%s", text->text);
    if (kit_do(&kit, text->text) != CT_OK)
        tell(m, "%s\n%s\n", kit.error.message, kit.error.hint);
    else {
        got = kit_value(&kit, "T.p");
        tell(m, "%s: T.p is %.12g, not %.12g\n", kinds[kind], got, wanted);
        verdict = keeps(m, "pressure", fabs(got - wanted) / (RHO_G * (h + edge)), MISSES * rtol)
                      ? AGREES
                      : DISAGREES;
    }
    kit_free(&kit);
    free(text);
    return verdict;
}

static const Family families[] = {
    /* bdf and ida refuse some: a flow of k alone has no slope where a tank is dry */
    {"networks of tanks fill and empty as their equations do", 30, 0.05, 0, network_member},
    {"single tanks empty by their closed forms", 60, 0.05, 0, single_member},
};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}
