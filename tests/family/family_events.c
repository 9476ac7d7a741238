/* family_events.c: charges and fluxes over switches and events, against conservation and
 * exponentials in closed form
 *
 * Capacitors with bleeders hang on one rail, and ideal switches in chains and stars join them for a
 * while: within a group the voltage is one, decays by its sums of C and of 1/R, and begins where
 * the charges of its members add up. Coils in a row with their resistances are the dual, parted by
 * switches to ground. Events change s in L(s) and C(s), by which current and voltage are divided,
 * and speeds, as a blow does that acts along nothing else. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#include <math.h>

#define PI 3.14159265358979323846

enum { MOST = 5, INSTANTS = 2 * MOST };

static const char *const methods[] = {"dop853", "rk4", "radau", "ida", "bdf", "adams"};

/* --- a row of things that are joined for a while --- */

typedef struct Row {
    int count;
    double store[MOST]; /* C or L */
    double loss[MOST];  /* 1/R of a capacitor, R of a coil */
    double value[MOST]; /* V or A */
    double drive;       /* of the first one: A into it, or V of it */
    bool turned[MOST];  /* written with its ends exchanged */
    int to[MOST];       /* k is joined to this one */
    double from[MOST], until[MOST];
} Row;

static int pick(uint64_t *random, int count)
{
    return (int)(test_random(random) % (uint64_t)count);
}

static void make(Row *row, uint64_t *random, double store, double loss, bool in_chain)
{
    const bool star = !in_chain && pick(random, 2);

    *row = (Row){.count = 2 + pick(random, MOST - 1)};
    row->drive = pick(random, 2) ? 0 : test_uniform(random, -10, 10);
    for (int k = 0; k < row->count; k++) {
        row->store[k] = store * test_decades(random, 0.1, 10);
        row->loss[k] = loss * test_decades(random, 0.3, 3);
        row->value[k] = test_uniform(random, -10, 10);
        row->turned[k] = pick(random, 2);
        row->to[k] = star ? 0 : k - 1;
        row->from[k] = test_uniform(random, 0.05, 0.9);
        row->until[k] = row->from[k] + test_uniform(random, 0.05, 0.6);
    }
}

static int group_of(const Row *row, const bool *joined, int k)
{
    while (k > 0 && k < MOST && joined[k])
        k = row->to[k];
    return k;
}

/* C v' = drive - loss v of each group, over `time` */
static void decay(Row *row, const bool *joined, double time)
{
    double store[MOST] = {0}, loss[MOST] = {0}, content[MOST] = {0};

    for (int k = 0; k < row->count; k++) {
        const int group = group_of(row, joined, k);

        store[group] += row->store[k];
        loss[group] += row->loss[k];
        content[group] += row->store[k] * row->value[k];
    }
    for (int k = 0; k < row->count; k++) {
        const int group = group_of(row, joined, k);
        const double rest = (group == group_of(row, joined, 0) ? row->drive : 0) / loss[group];

        row->value[k] =
            rest + (content[group] / store[group] - rest) * exp(-time * loss[group] / store[group]);
    }
}

static double energy_of(const Row *row)
{
    double energy = 0;

    for (int k = 0; k < row->count; k++)
        energy += row->store[k] * row->value[k] * row->value[k] / 2;
    return energy;
}

/* values at the end; *lost: what the joints cost, J */
static void follow(Row *row, double end, double *lost)
{
    double now = 0;

    *lost = 0;
    while (now < end) {
        bool joined[MOST] = {false};
        double next = end, before;

        for (int k = 1; k < row->count; k++) {
            joined[k] = row->from[k] <= now && now < row->until[k];
            if (row->from[k] > now)
                next = fmin(next, row->from[k]);
            if (row->until[k] > now)
                next = fmin(next, row->until[k]);
        }
        before = energy_of(row);
        decay(row, joined, 0);
        *lost += before - energy_of(row);
        decay(row, joined, next - now);
        now = next;
    }
}

/* the losses that the run told: the sum where it tells one, else those of each time */
static double told_loss(const char *remarks)
{
    const char *all = strstr(remarks, "more times: ");
    double sum = 0;

    if (all != NULL)
        return strtod(all + strlen("more times: "), NULL);
    for (const char *at = strstr(remarks, "share their "); at != NULL;
         at = strstr(at + 1, "share their "))
        sum += strtod(strchr(at, ',') + 1, NULL);
    return sum;
}

static Verdict compare(Member *m, Row *row, Kit *kit, const Script *script, char letter, char kind,
                       double end)
{
    Verdict verdict = AGREES;
    double lost, told, first = energy_of(row);

    tell(m, "%s", script->text);
    if (kit_do(kit, script->text) != CT_OK) {
        tell(m, "%s\n", kit->error.message);
        return DISAGREES;
    }
    told = told_loss(ct_remarks(kit->session));
    follow(row, end, &lost);
    if (!(fabs(told - lost) <= 1e-4 * lost + 1e-6 * first)) {
        tell(m, "%.9g J are told to be lost, not %.9g\n%s", told, lost, ct_remarks(kit->session));
        verdict = DISAGREES;
    }
    for (int k = 0; k < row->count; k++) {
        const double wanted = row->turned[k] ? -row->value[k] : row->value[k];
        char look[32];
        double got;

        (void)snprintf(look, sizeof look, "%c%d.%c", letter, k, kind);
        got = kit_value(kit, look);
        if (!(fabs(got - wanted) <= 1e-5 * 10)) {
            tell(m, "%s is %.9g, not %.9g\n", look, got, wanted);
            verdict = DISAGREES;
        }
    }
    return verdict;
}

static void write_run(Script *script, const Row *row, uint64_t *random, char letter, char kind,
                      double end)
{
    for (int k = 0; k < row->count; k++)
        write_line(script, "init %c%d.%c = %.17g", letter, k, kind,
                   row->turned[k] ? -row->value[k] : row->value[k]);
    write_line(script, "simulate %.17g every=%.17g rtol=1e-8 method=%s", end, end / 100,
               methods[pick(random, (int)(sizeof methods / sizeof methods[0]))]);
}

static Verdict charges(Member *m)
{
    const double end = test_decades(&m->random, 1e-4, 10),
                 resistance = test_decades(&m->random, 10, 1e5);
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict;
    Row row;

    make(&row, &m->random, end / resistance, 1 / resistance, false);
    row.drive *= row.loss[0];
    write_line(script, "isource J 0 n0 %.17g", row.drive);
    for (int k = 0; k < row.count; k++) {
        char nodes[16];

        (void)snprintf(nodes, sizeof nodes, row.turned[k] ? "0 n%d" : "n%d 0", k);
        write_line(script, "capacitor C%d %s %.17g\nresistor R%d n%d 0 %.17g", k, nodes,
                   row.store[k], k, k, 1 / row.loss[k]);
        row.from[k] *= end;
        row.until[k] *= end;
        if (k > 0)
            write_line(script, "switch S%d n%d n%d when=abs(t - %.17g) < %.17g", k, k, row.to[k],
                       (row.from[k] + row.until[k]) / 2, (row.until[k] - row.from[k]) / 2);
    }
    write_run(script, &row, &m->random, 'C', 'v', end);
    verdict = compare(m, &row, &kit, script, 'C', 'v', end);
    kit_free(&kit);
    free(script);
    return verdict;
}

/* n0 -L0-R0- n1 -L1-R1- n2 ...: the last end is grounded, and n1 ... by switches, which open */
static Verdict fluxes(Member *m)
{
    const double end = test_decades(&m->random, 1e-4, 10),
                 resistance = test_decades(&m->random, 0.1, 1e3);
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict;
    Row row;

    make(&row, &m->random, end * resistance, resistance, true);
    row.drive *= row.loss[0];
    write_line(script, "vsource V n0 0 %.17g", row.drive);
    for (int k = 0; k < row.count; k++) {
        char behind[16] = "0";

        if (k + 1 < row.count)
            (void)snprintf(behind, sizeof behind, "n%d", k + 1);
        write_line(script,
                   row.turned[k] ? "inductor L%d m%d n%d %.17g" : "inductor L%d n%d m%d %.17g", k,
                   k, k, row.store[k]);
        write_line(script, "resistor R%d m%d %s %.17g", k, k, behind, row.loss[k]);
        row.from[k] *= end;
        row.until[k] *= end;
        if (k > 0)
            write_line(script, "switch S%d n%d 0 when=abs(t - %.17g) > %.17g", k, k,
                       (row.from[k] + row.until[k]) / 2, (row.until[k] - row.from[k]) / 2);
    }
    write_run(script, &row, &m->random, 'L', 'i', end);
    verdict = compare(m, &row, &kit, script, 'L', 'i', end);
    kit_free(&kit);
    free(script);
    return verdict;
}

/* --- events --- */

/* L s i' = E - R i and C s v' = -G v between the events, which keep L s i and C s v */
static Verdict laws(Member *m)
{
    const double E = test_uniform(&m->random, -10, 10), R = test_decades(&m->random, 0.1, 100);
    const double L = R * test_decades(&m->random, 0.03, 3),
                 G = test_decades(&m->random, 1e-6, 1e-2);
    const double C = G * test_decades(&m->random, 0.03, 3), v0 = test_uniform(&m->random, -10, 10);
    const int count = 1 + pick(&m->random, 4);
    double s = test_decades(&m->random, 0.1, 10), i = E / R * test_uniform(&m->random, -1, 1),
           v = v0;
    double t = 0;
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    write_line(script, "scene planar\nbody b mass=1 inertia=0\nprismatic s ground b axis=x");
    write_line(script, "vsource V a 0 %.17g\nresistor R a b1 %.17g\ninductor L b1 0 L=%.17g*s", E,
               R, L);
    write_line(script, "resistor Rc c 0 %.17g\ncapacitor C c 0 %.17g*s", 1 / G, C);
    write_line(script, "init s = %.17g, s' = 0, L.i = %.17g, C.v = %.17g", s, i, v);
    for (int k = 0; k < count; k++) {
        const double next = t + test_uniform(&m->random, 0.05, 0.9 / count);
        const double other = test_decades(&m->random, 0.1, 10);

        i = E / R + (i - E / R) * exp(-(next - t) * R / (L * s));
        v *= exp(-(next - t) * G / (C * s));
        write_line(script, "event e%d when=t >= %.17g s = %.17g", k, next, other);
        i *= s / other;
        v *= s / other;
        s = other;
        t = next;
    }
    i = E / R + (i - E / R) * exp(-(1 - t) * R / (L * s));
    v *= exp(-(1 - t) * G / (C * s));
    write_line(script, "simulate 1 rtol=1e-9 method=%s",
               methods[pick(&m->random, (int)(sizeof methods / sizeof methods[0]))]);
    tell(m, "%s", script->text);
    if (kit_do(&kit, script->text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        verdict = DISAGREES;
    } else if (!(fabs(kit_value(&kit, "L.i") - i) <= 1e-4 * fabs(E / R)) ||
               !(fabs(kit_value(&kit, "C.v") - v) <= 1e-4 * fabs(v0))) {
        tell(m, "L.i is %.9g, not %.9g; C.v is %.9g, not %.9g\n", kit_value(&kit, "L.i"), i,
             kit_value(&kit, "C.v"), v);
        verdict = DISAGREES;
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

/* --- new speeds --- */

/* A slide, an arm on it, an arm on that: s, and the angles a and b between them. */
typedef struct Cart {
    double mass[3], inertia[3]; /* of the cart, of the arms */
    double length[2], centre;   /* to the second joint; to the second arm's centre of mass */
    double at[3], rate[3];
} Cart;

/* one body's place moves by `along` for each of the speeds, and turns by `turn` */
static void add_body(double M[3][3], double mass, double inertia, double along[2][3],
                     const double turn[3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            M[i][j] += mass * (along[0][i] * along[0][j] + along[1][i] * along[1][j]) +
                       inertia * turn[i] * turn[j];
}

static void cart_mass(const Cart *c, double M[3][3])
{
    const double one = c->at[1], two = c->at[1] + c->at[2];
    const double turns[2][3] = {{0, 1, 0}, {0, 1, 1}};
    double first[2][3] = {{1, -c->length[0] * sin(one), 0}, {0, c->length[0] * cos(one), 0}};
    double second[2][3];

    memset(M, 0, 9 * sizeof(double));
    M[0][0] = c->mass[0];
    add_body(M, c->mass[1], c->inertia[1], first, turns[0]);
    second[0][0] = 1;
    second[1][0] = 0;
    second[0][2] = -c->centre * sin(two);
    second[1][2] = c->centre * cos(two);
    second[0][1] = -c->length[1] * sin(one) + second[0][2];
    second[1][1] = c->length[1] * cos(one) + second[1][2];
    add_body(M, c->mass[2], c->inertia[2], second, turns[1]);
}

/* The blow acts along what is set, and none is along the others: (M du)_k = 0 there, by Gauss's
 * method. */
static void strike(const Cart *c, const bool *set, const double *to, double *rate)
{
    double M[3][3], a[3][4];

    cart_mass(c, M);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            a[i][j] = set[i] ? (j == 3 ? to[i] - c->rate[i] : i == j) : j < 3 ? M[i][j] : 0;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            const double f = i == k ? 0 : a[i][k] / a[k][k];

            for (int j = k; j < 4; j++)
                a[i][j] -= f * a[k][j];
        }
    for (int i = 0; i < 3; i++)
        rate[i] = c->rate[i] + a[i][3] / a[i][i];
}

static void write_cart(Script *script, const Cart *c)
{
    write_line(script, "scene planar\nbody b0 mass=%.17g inertia=1\nprismatic s ground b0 axis=x",
               c->mass[0]);
    write_line(script, "body b1 mass=%.17g inertia=%.17g\narm p1 b1 [%.17g, 0]\nrevolute a b0 p1",
               c->mass[1], c->inertia[1], -c->length[0]);
    write_line(script, "arm e1 b1 [%.17g, 0]\nbody b2 mass=%.17g inertia=%.17g",
               c->length[1] - c->length[0], c->mass[2], c->inertia[2]);
    write_line(script, "arm p2 b2 [%.17g, 0]\nrevolute b e1 p2", -c->centre);
    for (int i = 0; i < 3; i++)
        write_line(script, "init %c = %.17g, %c' = %.17g", "sab"[i], c -> at[i], "sab"[i],
                   c -> rate[i]);
}

static Verdict blows(Member *m)
{
    static const char *const trees[] = {"tree joint", "tree absolute", "form embedded"};
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = AGREES;
    Cart c;
    bool set[3];
    double to[3], rate[3];

    for (int i = 0; i < 3; i++) {
        c.mass[i] = member_decades(m, 0.1, 10);
        c.inertia[i] = member_decades(m, 0.01, 1);
        c.at[i] = member_between(m, -3, 3);
        c.rate[i] = member_between(m, -2, 2);
        to[i] = member_between(m, -2, 2);
        set[i] = member_one_of(m, 2) == 0;
    }
    set[member_one_of(m, 3)] = true;
    c.length[0] = member_between(m, 0.1, 0.5);
    c.length[1] = member_between(m, 0.5, 1);
    c.centre = member_between(m, 0.1, 0.5);
    write_cart(script, &c);
    write_line(script, "%s", trees[member_one_of(m, 3)]);
    write_piece(script, "event blow when=t > 1e-9");
    for (int i = 0; i < 3; i++)
        if (set[i])
            write_piece(script, " %c'=%.17g", "sab"[i], to[i]);
    write_line(script, "\nsimulate 2e-9");
    tell(m, "%s", script->text);
    strike(&c, set, to, rate);
    if (kit_do(&kit, script->text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        verdict = DISAGREES;
    }
    for (int i = 0; i < 3 && verdict == AGREES; i++) {
        const char name[] = {"sab"[i], '\'', '\0'};

        if (!keeps(m, name, fabs(kit_value(&kit, name) - rate[i]), 1e-5 * (1 + fabs(rate[i]))))
            verdict = DISAGREES;
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

/* --- sampling instants --- */

/* something that jumps, bends or is asked for at t, which is a sampling instant, or nearly */
static void write_corner(Member *m, Script *script, int number, double t, double period)
{
    static const char *const laws[] = {
        "vsource X%d x%d 0 step(t - %.17g)\nresistor Y%d x%d 0 1",
        "vsource X%d x%d 0 pwl(t, 0, 0, %.17g, 1, 1e4, 0)\nresistor Y%d x%d 0 1",
        "vsource X%d x%d 0 abs(t - %.17g)\nresistor Y%d x%d 0 1"};

    switch (member_one_of(m, 3)) {
    case 0:
        write_line(script, "event e%d when=t > %.17g do=mark", number, t);
        break;
    case 1:
        write_line(
            script,
            "vsource X%d x%d 0 pulse(t, 0, 1, %.17g, 0, 0, %.17g, 100)\nresistor Y%d x%d 0 1",
            number, number, t, 3 * period, number, number);
        break;
    default:
        write_line(script, laws[member_one_of(m, 3)], number, number, t, number, number);
        break;
    }
}

/* An integral of 1 that is sampled grows by the period at each instant, whatever else happens
 * there, and in a run of two parts. A row at an instant is from before. */
static Verdict instants(Member *m)
{
    const double period =
        member_one_of(m, 2) ? 0.01 * (1 + member_one_of(m, 9)) : member_decades(m, 1e-3, 10);
    const double k = member_decades(m, 0.1, 10);
    const int count = 20, part = 1 + member_one_of(m, count - 2), corners = member_one_of(m, 5);
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = AGREES;
    double last = 0;

    write_line(script, "integrator c o 0 of=1 k=%.17g period=%.17g\nresistor R o 0 1", k, period);
    write_line(script, "vsource V a 0 sin(t)\nresistor RC a b 1\ncapacitor C b 0 %.17g", period);
    for (int i = 0; i < corners; i++)
        write_corner(m, script, i, (1 + member_one_of(m, count - 1)) * period, period);
    write_line(script, "simulate %.17g every=%.17g method=%s", part * period,
               period / (2 + 2 * member_one_of(m, 2)), methods[member_one_of(m, 6)]);
    write_line(script, "resume %.17g", (count - part) * period);
    tell(m, "%s", script->text);
    if (kit_do(&kit, script->text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        verdict = DISAGREES;
    }
    for (int n = 0; n < count && verdict == AGREES; n++) {
        char look[64];
        double now;

        (void)snprintf(look, sizeof look, "c.v at %.17g", n * period);
        if (n > 0 && !keeps(m, look, fabs(kit_value(&kit, look) - last), 1e-9 * k * period * count))
            verdict = DISAGREES;
        (void)snprintf(look, sizeof look, "c.v at %.17g", (n + 0.5) * period);
        now = kit_value(&kit, look);
        if (n > 0 && !keeps(m, look, fabs(now - last - k * period), 1e-9 * k * period * count))
            verdict = DISAGREES;
        last = now;
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

/* --- two conditions in one step --- */

/* A mark near the top of a swing, where a step that is taken again to end there may come out much
 * longer; and a ball that is thrown back by a wall about then. Its flight is a straight line. */
static Verdict neighbours(Member *m)
{
    const double w = test_decades(&m->random, 0.3, 3), rtol = test_decades(&m->random, 1e-9, 1e-3);
    const double near = test_decades(&m->random, 1e-2 * rtol, 10 * rtol), v = 1;
    const double top = (asin(1 - near) + 2 * PI * pick(&m->random, 3)) / w;
    const double hit = top + 3 * sqrt(near) / w * test_uniform(&m->random, -0.3, 1);
    const double end = hit + test_uniform(&m->random, 0.1, 1) / w;
    const double wanted = -v * (end - hit), within = 100 * rtol * (1 + v * hit);
    static const char *const all[] = {"auto", "dop853", "radau", "bdf", "adams", "ida"};
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = AGREES;
    double got;

    write_line(script, "scene planar\nbody a mass=1 inertia=0\nbody b mass=1 inertia=0");
    write_line(script, "prismatic p ground a axis=x\nprismatic s ground b axis=x");
    write_line(script, "spring k p k=%.17g\ninit p = 0, p' = %.17g, s = %.17g, s' = %.17g", w * w,
               w, -v * hit, v);
    write_line(script, "event high when=p > %.17g do=mark", 1 - near);
    write_line(script, "event wall when=s > 0 s' = -s'");
    write_line(script, "simulate %.17g every=%.17g rtol=%.3g atol=%.3g method=%s", end, end, rtol,
               rtol, all[pick(&m->random, (int)(sizeof all / sizeof all[0]))]);
    tell(m, "%s", script->text);
    if (kit_do(&kit, script->text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        verdict = DISAGREES;
    } else {
        got = kit_value(&kit, "s");
        if (!(fabs(got - wanted) <= within)) {
            tell(m, "s is %.12g, not %.12g: off by %.3g tolerances\n", got, wanted,
                 fabs(got - wanted) / rtol);
            verdict = DISAGREES;
        }
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

/* --- sources --- */

/* E and one capacitor, or J and a row of coils: whatever the values, the source is named */
static Verdict sources(Member *m)
{
    const bool coils = pick(&m->random, 2);
    const int count = coils ? 1 + pick(&m->random, 4) : 1;
    const double when = test_uniform(&m->random, 0.1, 0.9);
    Script *script = calloc(1, sizeof *script);
    Kit kit = kit_new();
    Verdict verdict = DISAGREES;

    write_line(script, coils ? "isource X 0 n0 %.17g" : "vsource X n 0 %.17g",
               (pick(&m->random, 2) ? 1 : -1) * test_decades(&m->random, 1, 100));
    write_line(script, coils ? "switch S n0 0 when=t < %.17g" : "switch S n n0 when=t > %.17g",
               when);
    for (int k = 0; k < count; k++) {
        write_line(script, coils ? "inductor P%d n%d m%d %.17g" : "capacitor P%d n%d n%d %.17g", k,
                   k, coils ? k : k + 1, test_decades(&m->random, 1e-6, 1));
        write_line(script, coils ? "resistor R%d m%d n%d %.17g" : "resistor R%d n%d n%d %.17g", k,
                   k, k + 1, test_decades(&m->random, 1, 1e5));
    }
    if (coils)
        write_line(script, "resistor RE n%d 0 1", count);
    else /* an ammeter, which is a source as well */
        write_line(script, "vsource W n%d 0 0", count);
    write_line(script, "simulate 1");
    tell(m, "%s", script->text);
    if (kit_do(&kit, script->text) == CT_OK) {
        tell(m, "it ran\n");
    } else {
        verdict = strstr(kit.error.message, " would jump from ") != NULL &&
                          (strstr(kit.error.message, "X alone would have to") != NULL ||
                           strstr(kit.error.message, "W alone would have to") != NULL)
                      ? AGREES
                      : DISAGREES;
        tell(m, "%s\n", kit.error.message);
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"capacitors that switches join share their charge", 40, 0, 0, charges},
        {"coils that switches put in series share their flux", 40, 0, 0, fluxes},
        {"events that change a law keep charge and flux", 40, 0, 0, laws},
        {"new speeds are those of a blow along them, in any tree", 60, 0, 0, blows},
        {"what is sampled is so once an instant", 60, 0, 0, instants},
        {"conditions that are met in one step don't hide each other", 60, 0, 0, neighbours},
        {"a source that would give an impulse is named", 40, 0, 0, sources},
    };

    return test_faults + family_main(families, sizeof families / sizeof families[0], argc, argv);
}
