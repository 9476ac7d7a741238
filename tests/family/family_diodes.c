/* family_diodes.c: random networks of diodes and switches, ideal and exponential, against an
 * integration of its own in fine fixed steps; rectifiers and multipliers against closed forms
 *
 * The oracle writes each network's node equations by the implicit Euler method: capacitors and
 * coils are conductances beside sources, sources of voltage stand behind resistances, diodes are of
 * two straight lines. In each step diodes go over until none is wrong (Murty 1974); exponential
 * ones are solved for by Newton's method, with the steps of their voltages limited. Runs of n and
 * of 2n steps are extrapolated, and differ by what they may be off. An ideal part is one of 10
 * uohm and 100 Gohm to the oracle. */
#include "../unit/session_kit.h"
#include "family.h"
#include "networks.h"
#include "networks_script.h"

#include <math.h>

#define MANY    100 /* tolerances: more than errors of a run may add up to */
#define THERMAL (1.380649e-23 * 300.15 / 1.602176634e-19) /* V, at 27 degrees */

/* --- the oracle --- */

typedef double Values[POINTS][ROOM + 1 + PARTS]; /* node voltages, then states */

typedef struct Oracle {
    const Network *net;
    double step;
    double v[ROOM + 1];
    double state[PARTS]; /* V of capacitors, A of coils */
    bool closed[PARTS];
    double guess[PARTS]; /* V of exponential diodes */
} Oracle;

static double across(const Oracle *o, const Part *p)
{
    return o->v[p->plus] - o->v[p->minus];
}

static bool is_closed(const Network *net, const Part *p, double t)
{
    return sin(net->omega * t + p->phase) > p->level;
}

/* where the first switch goes over between two instants; else the later one */
static double next_switch(const Network *net, double from, double to)
{
    const double first = from + 1e-9 * (to - from);

    for (int i = 0; i < net->count; i++) {
        const Part *p = &net->part[i];
        double low = first;

        if (p->kind != SWITCH || is_closed(net, p, first) == is_closed(net, p, to))
            continue;
        for (int k = 0; k < 60; k++) {
            const double middle = (low + to) / 2;

            if (is_closed(net, p, middle) == is_closed(net, p, first))
                low = middle;
            else
                to = middle;
        }
    }
    return to;
}

/* the tangent of Is (exp(v/(n VT)) - 1) + 1e-12 v, as the manual has it */
static void tangent_of(const Oracle *o, int i, double *conductance, double *rest)
{
    const Part *p = &o->net->part[i];
    const double scale = p->scale * THERMAL, grown = p->Is * exp(o->guess[i] / scale);

    *conductance = grown / scale + 1e-12;
    *rest = grown - p->Is + 1e-12 * o->guess[i] - *conductance * o->guess[i];
}

/* i = conductance v + rest of a part in a step that ends at t */
static void line_of(const Oracle *o, int i, double t, double *conductance, double *rest)
{
    const Part *p = &o->net->part[i];
    double value;

    *conductance = *rest = 0;
    switch (p->kind) {
    case RESISTOR:
        *conductance = 1 / p->value;
        break;
    case CAPACITOR:
        *conductance = p->value / o->step;
        *rest = -*conductance * o->state[i];
        break;
    case COIL:
        *conductance = o->step / p->value;
        *rest = o->state[i];
        break;
    case SOURCE:
        value = p->value * sin(o->net->omega * t + p->phase);
        *conductance = 1 / p->series;
        *rest = -value / p->series;
        break;
    case DIODE:
        if (o->net->exponential) {
            tangent_of(o, i, conductance, rest);
            break;
        }
        *conductance = 1 / (o->closed[i] ? p->on : p->off);
        *rest = o->closed[i] ? p->least / p->off - p->least / p->on : 0;
        break;
    case SWITCH: /* it doesn't go over within a step */
        value = is_closed(o->net, p, t - o->step / 2) ? p->on : p->off;
        *conductance = 1 / (value + p->series);
        break;
    }
}

/* node voltages by Gauss's method: the matrix is symmetric and positive definite */
static void solve_nodes(Oracle *o, double t)
{
    double a[ROOM + 1][ROOM + 2] = {{0}};
    const int n = o->net->nodes;

    for (int i = 0; i < o->net->count; i++) {
        const Part *p = &o->net->part[i];
        double conductance, rest;

        line_of(o, i, t, &conductance, &rest);
        a[p->plus][p->plus] += conductance;
        a[p->minus][p->minus] += conductance;
        a[p->plus][p->minus] -= conductance;
        a[p->minus][p->plus] -= conductance;
        a[p->plus][ROOM + 1] -= rest;
        a[p->minus][ROOM + 1] += rest;
    }
    for (int c = 1; c <= n; c++)
        for (int r = c + 1; r <= n; r++) {
            const double f = a[r][c] / a[c][c];

            for (int k = c; k <= n && f != 0; k++)
                a[r][k] -= f * a[c][k];
            a[r][ROOM + 1] -= f * a[c][ROOM + 1];
        }
    for (int r = n; r > 0; r--) {
        o->v[r] = a[r][ROOM + 1];
        for (int k = r + 1; k <= n; k++)
            o->v[r] -= a[r][k] * o->v[k];
        o->v[r] /= a[r][r];
    }
}

/* What a closed diode's voltage tells no backward current from: rounding, for 0.1 nA through 100
 * kohm is 10 uV; more only where diodes would go over for ever. */
static double told_by_rounding(const Oracle *o, const Part *p, int turn)
{
    double largest = 0;

    for (int i = 1; i <= o->net->nodes; i++)
        largest = fmax(largest, fabs(o->v[i]));
    return fmax(turn < 200 ? 0 : 1e-9 * p->on, 1e-15 * largest);
}

/* Exponential diodes by Newton's method. Up the exponential a voltage goes by the logarithm of what
 * its tangent asks for (Nagel 1975). */
static void settle_exponentials(Oracle *o, double t)
{
    for (int turn = 0; turn < 1000; turn++) {
        bool right = true;

        solve_nodes(o, t);
        for (int i = 0; i < o->net->count; i++) {
            const Part *p = &o->net->part[i];
            const double scale = p->scale * THERMAL, v = across(o, p), from = o->guess[i];
            const double critical = scale * log(scale / (sqrt(2) * p->Is));
            double next = v;

            if (p->kind != DIODE)
                continue;
            if (v > critical && fabs(v - from) > 2 * scale)
                next = from > 0 && 1 + (v - from) / scale > 0
                           ? from + scale * log(1 + (v - from) / scale)
                       : from > 0 ? critical
                                  : scale * log(v / scale);
            right = right && fabs(next - from) <= 1e-10 + 1e-12 * fabs(v) && next == v;
            o->guess[i] = next;
        }
        if (right)
            return;
    }
}

static void settle_lines(Oracle *o, double t)
{
    for (int turn = 0; turn < 2000; turn++) {
        bool right = true;

        solve_nodes(o, t);
        for (int i = 0; i < o->net->count && (right || turn < 50); i++) {
            const Part *p = &o->net->part[i];
            const double excess = across(o, p) - p->least;

            if (p->kind == DIODE &&
                (o->closed[i] ? excess < -told_by_rounding(o, p, turn) : excess > 1e-12)) {
                o->closed[i] = !o->closed[i];
                right = false;
            }
        }
        if (right)
            return;
    }
}

static void take_step(Oracle *o, double t)
{
    if (o->net->exponential)
        settle_exponentials(o, t);
    else
        settle_lines(o, t);
    for (int i = 0; i < o->net->count; i++) {
        const Part *p = &o->net->part[i];

        if (p->kind == CAPACITOR)
            o->state[i] = across(o, p);
        else if (p->kind == COIL)
            o->state[i] += o->step / p->value * across(o, p);
    }
}

/* Node voltages and states at POINTS instants, of so many steps between two. At the start and
 * behind each switch there may be fast changes, and steps grow from short ones. */
static void integrate(const Network *net, int steps, Values out)
{
    const double step = net->end / POINTS / steps;
    const double grow = 1 + 60.0 / steps;
    double most = 1e-6 * step;
    Oracle o = {.net = net};

    for (int i = 0; i < net->count; i++)
        o.state[i] = net->part[i].start;
    for (int k = 0; k < POINTS; k++) {
        const double end = net->end * (k + 1) / POINTS;
        double t = net->end * k / POINTS;

        while (t < end) {
            const double wanted = end - t < 1.5 * most ? end : t + fmin(most, step);
            const double to = next_switch(net, t, wanted);

            o.step = to - t;
            take_step(&o, to);
            most = to < wanted ? 1e-6 * step : fmin(grow * most, step);
            t = to;
        }
        memcpy(out[k], o.v, sizeof o.v);
        memcpy(out[k] + ROOM + 1, o.state, sizeof o.state);
    }
}

/* --- side by side --- */

/* what is told of a network whatever open ideal diodes part: states, and with resistances nodes */
static bool is_told(const Network *net, int k, char name[16])
{
    if (k > 0 && k <= net->nodes && net->tolerance == 0)
        (void)snprintf(name, 16, "n%d.v", k);
    else if (k > ROOM && k - ROOM - 1 < net->count && net->part[k - ROOM - 1].kind == CAPACITOR)
        (void)snprintf(name, 16, "C%d.v", k - ROOM - 1);
    else if (k > ROOM && k - ROOM - 1 < net->count && net->part[k - ROOM - 1].kind == COIL)
        (void)snprintf(name, 16, "L%d.i", k - ROOM - 1);
    else
        return false;
    return true;
}

static double largest_of(const Values a, const Values b, int k)
{
    double largest = 0;

    for (int i = 0; i < POINTS; i++)
        largest = fmax(largest, fabs(a[i][k] - b[i][k]));
    return largest;
}

/* With shorter steps where the network swings fast; how far apart the node voltages are then. */
static void integrate_twice(const Network *net, double size, Values coarse, Values fine)
{
    for (int steps = 2000; steps < 50000; steps *= 4) {
        double apart = 0;

        integrate(net, steps, coarse);
        integrate(net, 2 * steps, fine);
        for (int k = 1; k <= net->nodes; k++)
            apart = fmax(apart, largest_of(fine, coarse, k));
        if (apart < 1e-4 * size)
            return;
    }
}

static Verdict compare(Member *m, const Network *net, Kit *kit)
{
    static Values coarse, fine, nothing;
    double size = 0; /* V of the largest source */
    Verdict verdict = AGREES;

    for (int i = 0; i < net->count; i++)
        if (net->part[i].kind == SOURCE)
            size = fmax(size, net->part[i].value);
    integrate_twice(net, size, coarse, fine);
    for (int k = 0; k < ROOM + 1 + PARTS; k++) {
        char name[16], look[64];
        double largest, within = net->ideal ? 1e-4 : 1e-5, apart = largest_of(fine, coarse, k);

        if (!is_told(net, k, name))
            continue;
        largest = name[0] != 'L' ? size : size * (net->ideal ? 0.5 : 1e-3);
        if (net->tolerance > 0) {
            largest = 1 + largest_of(fine, nothing, k);
            within = fmax(1e-5, MANY * net->tolerance);
        }
        if (apart > 1e-3 * largest)
            continue; /* too fast for any of these steps */
        for (int i = 0; i < POINTS; i++) {
            const double wanted = 2 * fine[i][k] - coarse[i][k];
            double got;

            (void)snprintf(look, sizeof look, "%s at %.17g", name, net->end * (i + 1) / POINTS);
            got = kit_value(kit, look);
            m->figure = fmax(m->figure, fabs(got - wanted) / (3 * apart + within * largest));
            if (fabs(got - wanted) <= 3 * apart + within * largest)
                continue;
            tell(m, "%s is %.9g, not %.9g within %.2g\n", look, got, wanted, apart);
            verdict = DISAGREES;
        }
    }
    return verdict;
}

static Verdict run_network(Member *m, const Network *net)
{
    Script *script = malloc(sizeof *script);
    Kit kit = kit_new();
    Verdict verdict;

    write_script(script, net);
    tell(m, "%s", script->text);
    if (kit_do(&kit, script->text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        verdict = net->tolerance > 0 ? REFUSED : DISAGREES;
    } else {
        verdict = compare(m, net, &kit);
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

static Verdict run_random(Member *m, Diodes law)
{
    Network net;

    make(&net, &m->random, law);
    return run_network(m, &net);
}

static Verdict networks_of_ideal_parts(Member *m)
{
    return run_random(m, IDEAL);
}

static Verdict networks_of_exponential_diodes(Member *m)
{
    return run_random(m, EXPONENTIAL);
}

/* --- coils whose currents tell diodes' voltages --- */

/* Many coils' currents alone tell them, which no method but ida may take. A resistor across the
 * diode makes them follow; one that explicit methods may meet is small, for stability's sake. */
static void add_resistor_across(Network *net, uint64_t *random, double R)
{
    const bool is_explicit = net->method[0] == 'd' || strcmp(net->method, "adams") == 0;

    if (is_explicit ? pick(random, 4) > 0 : pick(random, 3) > 0)
        add(net, RESISTOR, 1, 2)->value = R * test_decades(random, 10, is_explicit ? 100 : 1e6);
    else if (is_explicit)
        net->tolerance = fmax(1e-6, net->tolerance);
}

/* A source behind a diode and a coil; beside it may be another diode, and a capacitor at the end.
 */
static void make_coil(Network *net, uint64_t *random)
{
    static const char *const methods[] = {"auto", "ida", "radau", "dop853", "bdf", "adams"};
    const double f = test_decades(random, 1, 1e4), R = test_decades(random, 1, 1e3);
    const bool turned = pick(random, 3) == 0;
    Part *source;

    *net = (Network){.nodes = 3, .exponential = true, .omega = 2 * PI * f, .end = 2.3 / f};
    net->tolerance = test_decades(random, 1e-8, 1e-2);
    net->method = methods[pick(random, sizeof methods / sizeof methods[0])];
    source = add(net, SOURCE, 1, 0);
    source->value = R * test_decades(random, 0.1, 10);
    source->phase = pick(random, 2) ? test_uniform(random, -PI, PI) : 0;
    source->series = 0.1 * R;
    add(net, DIODE, turned ? 2 : 1, turned ? 1 : 2);
    if (pick(random, 3) == 0)
        add(net, DIODE, 0, 2);
    add_resistor_across(net, random, R);
    add(net, COIL, 2, 3)->value = R * test_decades(random, 0.01, 1) / f;
    add(net, RESISTOR, 3, 0)->value = R;
    if (pick(random, 4) == 0)
        add(net, CAPACITOR, 3, 0)->value = test_decades(random, 0.1, 10) / f / R;
    for (int i = 0; i < net->count; i++)
        if (net->part[i].kind == DIODE) {
            net->part[i].Is = test_decades(random, 1e-15, 1e-8);
            net->part[i].scale = test_uniform(random, 1, 2);
        }
}

static Verdict coils_behind_diodes(Member *m)
{
    Network net;

    make_coil(&net, &m->random);
    return run_network(m, &net);
}

/* As part of a run of many thousand periods, with few rows: no step is cut by them, and steps that
 * are short against the run get far enough all the same. */
static void make_long_coil(Network *net, uint64_t *random)
{
    make_coil(net, random);
    net->method = "auto";
    net->tolerance = test_decades(random, 1e-8, 1e-5);
    net->end *= 10;
    net->longer = 1000;
}

static Verdict coils_in_long_runs(Member *m)
{
    Network net;

    make_long_coil(&net, &m->random);
    return run_network(m, &net);
}

/* --- those that failed --- */

static void make_ideal(Network *net, uint64_t *random)
{
    make(net, random, IDEAL);
}

static void make_exponential(Network *net, uint64_t *random)
{
    make(net, random, EXPONENTIAL);
}

/* Members that went wrong once, by seed and number: ideal diodes side by side that share a current,
 * a switch that was crossed although next to nothing moves, exponential diodes whose currents
 * have no value far within a step, a margin that ends too slowly to be seen from near, a coil's
 * current that went on backwards through its diode, and exponential diodes whose search began at
 * what a trial step far off had left, or went on where rounding of states left nothing to find, a
 * diode that began to conduct again and again as steps grew, one whose margin leaves 0 by the
 * square of time, three in parallel beside resistances in which their leaks are lost, and
 * one that was seen to close a step behind a switch, where it would make a state jump. */
static Verdict networks_that_failed(Member *m)
{
    static const struct {
        uint64_t seed, number;
        void (*make)(Network *net, uint64_t *random);
    } failed[] = {{991, 14, make_ideal},     {5, 5, make_ideal},         {6, 33, make_ideal},
                  {7, 0, make_exponential},  {32, 7, make_ideal},        {33, 9, make_coil},
                  {34, 2, make_exponential}, {34, 41, make_exponential}, {35, 29, make_exponential},
                  {1, 2, make_long_coil},    {104, 3, make_ideal},       {34, 6, make_ideal},
                  {34, 69, make_ideal}};
    const size_t which = (size_t)m->number % (sizeof failed / sizeof failed[0]);
    Network net;

    m->random = failed[which].seed * 0x9E3779B97F4A7C15U + failed[which].number;
    (void)test_random(&m->random);
    failed[which].make(&net, &m->random);
    return run_network(m, &net);
}

/* --- closed forms --- */

typedef struct Rectifier {
    double E, w, r, R, C, Vf; /* source, all in series with the diode, load */
} Rectifier;

/* C v' = (E sin wt - Vf - v)/r - v/R from v at `from`: a wave, and what decays */
static double conducting(const Rectifier *p, double from, double v, double t)
{
    const double g = 1 / p->r + 1 / p->R, rate = g / p->C;
    const double size = p->E / p->r / hypot(g, p->w * p->C), turn = atan2(p->w * p->C, g);
    const double rest = -p->Vf / p->r / g;

    return size * sin(p->w * t - turn) + rest +
           (v - size * sin(p->w * from - turn) - rest) * exp(-rate * (t - from));
}

static double blocking(const Rectifier *p, double from, double v, double t)
{
    return v * exp(-(t - from) / (p->R * p->C));
}

/* the diode's voltage less Vf, and r times its current, is positive while it conducts */
static double forward(const Rectifier *p, double t, double v)
{
    return p->E * sin(p->w * t) - p->Vf - v;
}

typedef double (*Law)(const Rectifier *p, double from, double v, double t);

/* v at `end`, by pieces, from rest */
static double rectified(const Rectifier *p, double end)
{
    double from = 0, v = 0;
    bool conducts = forward(p, 1e-9 / p->w, 0) > 0;

    while (from < end) {
        const Law law = conducts ? conducting : blocking;
        const double step = 2 * PI / p->w / 2000;
        double low = from + 1e-9 * step, high;
        double t = low + step;

        for (; t < end && (forward(p, t, law(p, from, v, t)) > 0) == conducts; t += step)
            low = t;
        if (t >= end && (forward(p, end, law(p, from, v, end)) > 0) == conducts)
            return law(p, from, v, end);
        high = fmin(t, end);
        for (int k = 0; k < 100; k++) {
            const double middle = (low + high) / 2;

            if ((forward(p, middle, law(p, from, v, middle)) > 0) == conducts)
                low = middle;
            else
                high = middle;
        }
        v = law(p, from, v, high);
        from = high;
        conducts = !conducts;
    }
    return v;
}

static Verdict rectifiers(Member *m)
{
    const double Ron = test_decades(&m->random, 1e-3, 10), Rs = test_decades(&m->random, 0.1, 100);
    const double f = test_decades(&m->random, 10, 1e4);
    Rectifier p = {.E = test_decades(&m->random, 2, 1000),
                   .w = 2 * PI * f,
                   .r = Ron + Rs,
                   .Vf = pick(&m->random, 2) * test_uniform(&m->random, 0, 1)};
    Verdict verdict = AGREES;
    Kit kit = kit_new();
    char text[600];

    p.C = test_decades(&m->random, 0.01, 10) / f / p.r;
    p.R = p.r * test_decades(&m->random, 1, 1e3);
    (void)snprintf(text, sizeof text,
                   "vsource E s 0 %.17g*sin(%.17g*t)\nresistor RS s a %.17g\n"
                   "diode D a b Ron=%.17g Roff=1e14 Vf=%.17g\ncapacitor C b 0 %.17g\n"
                   "resistor R b 0 %.17g\nsimulate %.17g every=%.17g rtol=1e-9\n",
                   p.E, p.w, Rs, Ron, p.Vf, p.C, p.R, 3.1 / f, 0.31 / f);
    tell(m, "%s", text);
    if (kit_do(&kit, text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        verdict = DISAGREES;
    }
    for (int k = 1; k <= 10 && verdict == AGREES; k++) {
        const double t = 3.1 / f * k / 10, wanted = rectified(&p, t);
        double got;

        (void)snprintf(text, sizeof text, "b.v at %.17g", t);
        got = kit_value(&kit, text);
        if (!(fabs(got - wanted) <= 1e-6 * p.E)) {
            tell(m, "%s is %.12g, not %.12g\n", text, got, wanted);
            verdict = DISAGREES;
        }
    }
    kit_free(&kit);
    return verdict;
}

/* Unloaded, each stage adds twice the amplitude less both forward voltages. */
static Verdict multipliers(Member *m)
{
    const int stages = 1 + pick(&m->random, 3);
    const double E = test_decades(&m->random, 10, 500), C = test_decades(&m->random, 1e-8, 1e-6);
    const double Vf = pick(&m->random, 2) * 0.7, Ron = test_decades(&m->random, 0.1, 10);
    const double wanted = 2 * stages * (E - Vf);
    Script *script = malloc(sizeof *script);
    Verdict verdict = AGREES;
    Kit kit = kit_new();

    script->length = 0;
    put(script, "vsource V s0 0 %.17g*sin(2000*pi*t)\nresistor RS s0 a0 10\n", E);
    for (int k = 1; k <= stages; k++)
        put(script,
            "capacitor Ca%d a%d a%d %.17g\ndiode Da%d b%d a%d Vf=%g Ron=%g Roff=1e13\n"
            "diode Db%d a%d b%d Vf=%g Ron=%g Roff=1e13\ncapacitor Cb%d b%d b%d %.17g\n",
            k, k - 1, k, C, k, k - 1, k, Vf, Ron, k, k, k, Vf, Ron, k, k, k - 1, C);
    put(script, "resistor R0 b0 0 1e-3\nsimulate 0.15 every=1e-3 rtol=1e-6\n");
    tell(m, "%s", script->text);
    if (kit_do(&kit, script->text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        verdict = DISAGREES;
    } else {
        char look[32];
        double got;

        (void)snprintf(look, sizeof look, "b%d.v", stages);
        got = kit_value(&kit, look);
        if (!(fabs(got - wanted) <= 2e-3 * wanted)) {
            tell(m, "%s is %.9g, not %.9g\n", look, got, wanted);
            verdict = DISAGREES;
        }
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"networks of ideal parts follow fine steps", 15, 0, 0, networks_of_ideal_parts},
        {"networks of exponential diodes follow them", 2, 0, 0, networks_of_exponential_diodes},
        {"coils behind exponential diodes follow them", 15, 0.5, 0, coils_behind_diodes},
        {"coils in long runs follow them", 3, 0.1, 0, coils_in_long_runs},
        {"networks that failed once follow them", 13, 0, 0, networks_that_failed},
        {"rectifiers follow their closed form", 40, 0, 0, rectifiers},
        {"multipliers end where no diode conducts", 3, 0, 0, multipliers},
    };

    return test_faults + family_main(families, sizeof families / sizeof families[0], argc, argv);
}
