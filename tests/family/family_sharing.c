/* family_sharing.c: what is shared over a switch through sources, laws, windings and amplifiers,
 * against charge and flux added up by hand
 *
 * A circuit that a switch closes carries one impulse q. Each capacitor in it changes its charge by
 * q, and behind it the voltages around it add up to that of the sources in it: one equation for q,
 * linear or solved by halves. Nothing discharges before or after. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#include <math.h>

enum { MOST = 5 };

static const char *const methods[] = {"dop853", "radau", "ida", "bdf", "adams", "rk4"};

static int pick(uint64_t *random, int count)
{
    return (int)(test_random(random) % (uint64_t)count);
}

/* one number of the run against one by hand */
static void hold(Member *m, Kit *kit, const char *name, double wanted, double within,
                 Verdict *verdict)
{
    const double got = kit_value(kit, name);

    if (fabs(got - wanted) <= within)
        return;
    tell(m, "%s is %.12g, not %.12g\n", name, got, wanted);
    *verdict = DISAGREES;
}

static bool runs(Member *m, Kit *kit, const Script *script)
{
    tell(m, "%s", script->text);
    if (kit_do(kit, script->text) == CT_OK)
        return true;
    tell(m, "%s\n", kit->error.message);
    return false;
}

static void write_end(Script *script, uint64_t *random, bool is_stiff, double end)
{
    write_line(script, "simulate %.17g every=%.17g rtol=1e-9 method=%s", end, end / 20,
               methods[pick(random, (int)(sizeof methods / sizeof methods[0]) - is_stiff)]);
}

/* the first number behind a text of the remarks; NAN: it isn't there */
static double told_loss(const char *remarks)
{
    const char *at = strstr(remarks, "share their charge, ");

    return at != NULL ? strtod(at + strlen("share their charge, "), NULL) : NAN;
}

/* --- a circuit of capacitors, sources and ammeters --- */

/* Sum of E = sum of (v + q/C) */
static Verdict circuit(Member *m)
{
    const double end = test_decades(&m->random, 1e-6, 1),
                 when = end * test_uniform(&m->random, 0, 0.9);
    const int count = 2 + pick(&m->random, MOST - 1), sources = 1 + pick(&m->random, 2);
    double C[MOST], v[MOST], sum = 0, elastance = 0, energy = 0, after = 0, work = 0, q;
    bool turned[MOST], ran;
    int node = 0;
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    write_line(script, "switch S x n0 when=t > %.17g", when);
    for (int k = 0; k < count; k++) {
        C[k] = test_decades(&m->random, 1e-9, 1e-3);
        v[k] = test_uniform(&m->random, -10, 10);
        turned[k] = pick(&m->random, 2);
        write_line(script, "capacitor C%d n%d n%d %.17g", k, turned[k] ? node + 1 : node,
                   turned[k] ? node : node + 1, C[k]);
        write_line(script, "init C%d.v = %.17g", k, turned[k] ? -v[k] : v[k]);
        node++;
        sum += v[k];
        elastance += 1 / C[k];
        energy += C[k] * v[k] * v[k] / 2;
        if (k < sources) {
            const double E = pick(&m->random, 3) == 0 ? 0 : test_uniform(&m->random, -20, 20);

            write_line(script, "vsource E%d n%d n%d %.17g", k, node, node + 1, E);
            node++;
            sum += E;
            work -= E;
        }
    }
    write_line(script, "vsource Z n%d 0 0\nvsource Y x 0 0", node);
    write_end(script, &m->random, false, end);
    q = -sum / elastance;
    work *= q;
    for (int k = 0; k < count; k++) {
        v[k] += q / C[k];
        after += C[k] * v[k] * v[k] / 2;
    }
    ran = runs(m, &kit, script);
    if (!ran) {
        /* what is stored would grow: the sources alone would have to give that */
        if (after <= energy || strstr(kit.error.message, "alone would have to give") == NULL)
            verdict = DISAGREES;
    } else if (after > energy * (1 + 1e-6)) {
        tell(m, "%.9g J grow to %.9g\n", energy, after);
        verdict = DISAGREES;
    } else {
        const double told = told_loss(ct_remarks(kit.session));
        double lost;

        for (int k = 0; k < count; k++) {
            char name[32];

            (void)snprintf(name, sizeof name, "C%d.v", k);
            hold(m, &kit, name, turned[k] ? -v[k] : v[k], 1e-6 * 10, &verdict);
        }
        lost = energy - after + work;
        if (!(fabs(told - lost) <= 1e-4 * lost + 1e-6 * energy)) {
            tell(m, "%.9g J are told to be lost, not %.9g\n", told, lost);
            verdict = DISAGREES;
        }
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

/* --- charges and fluxes that aren't in proportion --- */

typedef struct Law {
    double a, b, x;
    bool bends;
} Law;

/* a x (1 + b x^2), or a x sqrt(1 + b x^2) */
static double content(const Law *law, double x)
{
    return law->a * x * (law->bends ? sqrt(1 + law->b * x * x) : 1 + law->b * x * x);
}

/* the x at which all contents add up to `sum`, by halves */
static double common(const Law *laws, int count, double sum)
{
    double low = -100, high = 100;

    for (int k = 0; k < 200; k++) {
        const double middle = (low + high) / 2;
        double found = 0;

        for (int i = 0; i < count; i++)
            found += content(&laws[i], middle);
        if (found < sum)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static Verdict laws(Member *m)
{
    const bool coils = pick(&m->random, 2);
    const int count = 2 + pick(&m->random, MOST - 1);
    const double scale = test_decades(&m->random, 1e-9, 1e-1);
    Law all[MOST];
    double sum = 0, x;
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    for (int k = 0; k < count; k++) {
        const char *const kind = coils ? "i" : "v";
        char law[120];

        all[k] = (Law){.a = scale * test_decades(&m->random, 0.1, 10),
                       .b = pick(&m->random, 4) == 0 ? 0 : test_decades(&m->random, 0.01, 1),
                       .x = test_uniform(&m->random, -5, 5),
                       .bends = pick(&m->random, 2)};
        sum += content(&all[k], all[k].x);
        (void)snprintf(law, sizeof law,
                       all[k].bends ? "%.17g*sqrt(1 + %.17g*P%d.%s^2)"
                                    : "%.17g*(1 + %.17g*P%d.%s^2)",
                       all[k].a, all[k].b, k, kind);
        /* capacitors on nodes that switches join; coils in a row that switches to ground part */
        if (coils)
            write_line(script, "inductor P%d n%d n%d %s", k, k, (k + 1) % count, law);
        else
            write_line(script, "capacitor P%d n%d 0 %s", k, k, law);
        write_line(script, "init P%d.%s = %.17g", k, kind, all[k].x);
        if (coils)
            write_line(script, k > 0 ? "switch S%d n%d n0 when=t < 0.5" : "vsource S%d n%d 0 0", k,
                       k);
        else if (k > 0)
            write_line(script, "switch S%d n%d n%d when=t > 0.5", k, k, pick(&m->random, k));
    }
    write_end(script, &m->random, false, 1);
    x = common(all, count, sum);
    if (!runs(m, &kit, script))
        verdict = DISAGREES;
    for (int k = 0; k < count && verdict == AGREES; k++) {
        char name[32];

        (void)snprintf(name, sizeof name, "P%d.%c", k, coils ? 'i' : 'v');
        hold(m, &kit, name, x, 1e-6, &verdict);
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

/* --- windings --- */

/* a capacitor on each side of a transformer; v1 = n v2, and q goes through the first side */
static Verdict transformers(Member *m)
{
    const double n = (pick(&m->random, 2) ? 1 : -1) * test_decades(&m->random, 0.1, 10);
    const double C1 = test_decades(&m->random, 1e-9, 1e-3),
                 C2 = test_decades(&m->random, 1e-9, 1e-3);
    const double v1 = test_uniform(&m->random, -10, 10), v2 = test_uniform(&m->random, -10, 10);
    const double q = (v1 - n * v2) / (1 / C1 + n * n / C2);
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    write_line(script, "capacitor C1 a 0 %.17g\ncapacitor C2 c 0 %.17g", C1, C2);
    if (pick(&m->random, 2)) /* on either side of it */
        write_line(script, "switch S a b when=t > 0.5\ntransformer T b 0 c 0 n=%.17g", n);
    else
        write_line(script, "switch S c b when=t > 0.5\ntransformer T a 0 b 0 n=%.17g", n);
    write_line(script, "init C1.v = %.17g, C2.v = %.17g", v1, v2);
    write_end(script, &m->random, false, 1);
    if (runs(m, &kit, script)) {
        hold(m, &kit, "C1.v", v1 - q / C1, 1e-6 * 100, &verdict);
        hold(m, &kit, "C2.v", v2 + n * q / C2, 1e-6 * 100, &verdict);
    } else {
        verdict = DISAGREES;
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

/* Two coils come in series, a third is coupled with the first: both circuits keep their flux. */
static Verdict couplings(Member *m)
{
    const double L1 = test_decades(&m->random, 1e-3, 1), L2 = test_decades(&m->random, 1e-3, 1);
    const double L3 = test_decades(&m->random, 1e-3, 1);
    const double M = test_uniform(&m->random, -0.95, 0.95) * sqrt(L1 * L2);
    const double i1 = test_uniform(&m->random, -5, 5), i2 = test_uniform(&m->random, -5, 5);
    const double i3 = test_uniform(&m->random, -5, 5);
    const double first = L1 * i1 + M * i2 + L3 * i3, second = L2 * i2 + M * i1;
    const double i = (first - M / L2 * second) / (L1 + L3 - M * M / L2);
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    write_line(script, "inductor L1 0 a %.17g\ninductor L2 b 0 %.17g\ninductor L3 a 0 %.17g", L1,
               L2, L3);
    write_line(script, "coupling K L1 L2 M=%.17g\nvsource W b 0 0\nswitch S a 0 when=t < 0.5", M);
    write_line(script, "init L1.i = %.17g, L2.i = %.17g, L3.i = %.17g", i1, i2, i3);
    write_end(script, &m->random, false, 1);
    if (runs(m, &kit, script)) {
        hold(m, &kit, "L1.i", i, 1e-6 * 100, &verdict);
        hold(m, &kit, "L3.i", i, 1e-6 * 100, &verdict);
        hold(m, &kit, "L2.i", (second - M * i) / L2, 1e-6 * 100, &verdict);
    } else {
        verdict = DISAGREES;
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

/* A gyrator shows a coil as a capacitor of L/r^2, at v = r i. */
static Verdict gyrators(Member *m)
{
    const double r = test_decades(&m->random, 0.1, 100), L = test_decades(&m->random, 1e-3, 1);
    const double C = L / (r * r) * test_decades(&m->random, 0.1, 10);
    const double v = test_uniform(&m->random, -10, 10), v2 = test_uniform(&m->random, -10, 10);
    const double joined = (C * v + L / (r * r) * v2) / (C + L / (r * r));
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    write_line(script, "capacitor C a 0 %.17g\nswitch S a b when=t > 1e-9*%.17g", C, sqrt(L * C));
    write_line(script, "r = %.17g", r);
    write_line(script, "gyrator G b 0 c 0 r=%.17g\ninductor L 0 c %.17g\nresistor R b 0 1e12", r,
               L);
    write_line(script, "init C.v = %.17g, L.i = %.17g", v, v2 / r);
    write_end(script, &m->random, false, 2e-9 * sqrt(L * C));
    if (runs(m, &kit, script)) {
        hold(m, &kit, "C.v", joined, 1e-5 * 10, &verdict);
        hold(m, &kit, "r*L.i", joined, 1e-5 * 10, &verdict);
    } else {
        verdict = DISAGREES;
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

/* --- amplifiers --- */

/* switched-capacitor integrators in a row: each clock hands C1 v of the input to C2 */
static Verdict integrators(Member *m)
{
    const double period = test_decades(&m->random, 1e-6, 1e-1), E = test_uniform(&m->random, -2, 2);
    const int clocks = 2 + pick(&m->random, 6), stages = 1 + pick(&m->random, 3);
    double out[4] = {E}, gain[4];
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    write_line(script, "T = %.17g\nvsource V s 0 %.17g\nresistor RS s o0 1", period, E);
    for (int k = 1; k <= stages; k++) {
        const double C = period / 2000 * test_decades(&m->random, 0.1, 1);
        const bool turns = pick(&m->random, 2); /* C1 upside down: + in the place of - */
        const double ratio = test_uniform(&m->random, 0.05, 0.5);

        gain[k] = turns ? ratio : -ratio;
        out[k] = test_uniform(&m->random, -1, 1);
        write_line(script, "capacitor C%d a%d b%d %.17g", k, k, k, ratio * C);
        write_line(script, "switch S%d o%d a%d when=t/T - floor(t/T) < 0.4", k, k - 1, k);
        write_line(script, "switch Q%d b%d 0 when=t/T - floor(t/T) < 0.4", k, k);
        write_line(script, "switch P%d %c%d m%d when=abs(t/T - floor(t/T) - 0.7) < 0.2", k,
                   turns ? 'b' : 'a', k, k);
        write_line(script, "switch O%d %c%d 0 when=abs(t/T - floor(t/T) - 0.7) < 0.2", k,
                   turns ? 'a' : 'b', k);
        write_line(script, "capacitor F%d m%d o%d %.17g\nopamp U%d 0 m%d o%d", k, k, k, C, k, k, k);
        write_line(script, "init F%d.v = %.17g", k, -out[k]);
    }
    write_end(script, &m->random, true, clocks * period);
    for (int n = 0; n < clocks; n++)
        for (int k = stages; k > 0; k--)
            out[k] += gain[k] * out[k - 1];
    if (!runs(m, &kit, script))
        verdict = DISAGREES;
    for (int k = 1; k <= stages && verdict == AGREES; k++) {
        char name[32];

        (void)snprintf(name, sizeof name, "U%d.out.v", k);
        hold(m, &kit, name, out[k], 1e-5, &verdict);
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"a circuit of capacitors and sources closes", 40, 0, 0, circuit},
        {"charges and fluxes by any law are shared", 40, 0, 0, laws},
        {"capacitors share through a transformer", 20, 0, 0, transformers},
        {"coupled coils keep the flux of each circuit", 20, 0, 0, couplings},
        {"a capacitor shares with a coil behind a gyrator", 20, 0, 0, gyrators},
        {"switched capacitors integrate", 15, 0, 0, integrators},
    };

    return test_faults + family_main(families, sizeof families / sizeof families[0], argc, argv);
}
