/* family_beam_laws.c: free beams of many shapes keep momentum, its moment and energy
 *
 * Not by runs, whose tolerance would be all that shows, but of the equations: where a beam is and
 * how it moves is drawn, the accelerations are the session's, and rates of what has to stay are
 * differences along the path that they begin. What a beam has of each follows from the field of
 * theory 9 by sums over Gauss's points, with shapes and derivatives from recurrences. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

enum {
    FAMILIES_OF_SHAPES = 4,
    TERMS = 16,
    MOST = FAMILIES_OF_SHAPES * TERMS,
    POINTS = 36, /* exact up to the degree 71: 4 N + 2 of s^2, N = 16 */
    INNER = 18,  /* 35: 2 N of v'^2 */
    KEPT = 7     /* momentum, its moment, energy */
};

static const char *const bases[] = {"legendre", "taylor", "chebyshev"};
static const char *const letters[FAMILIES_OF_SHAPES] = {"u", "v", "w", "phi"};

typedef struct Bar {
    bool planar;
    int basis, modes[FAMILIES_OF_SHAPES], count;
    int family[MOST], term[MOST];
    double L, rho, J[3], stiff[FAMILIES_OF_SHAPES];
} Bar;

/* r and q with their rates; the root's attitude is exp(turn), W its angular velocity in its axes */
typedef struct State {
    double r[3], v[3], turn[3], W[3], q[MOST], rate[MOST];
} State;

/* --- shapes --- */

typedef struct Shape {
    double value, slope, curve; /* and derivatives by xi */
} Shape;

/* the k-th polynomial of Legendre or Chebyshev over 0..1 */
static Shape orthogonal(bool legendre, int k, double xi)
{
    const double z = 2 * xi - 1;
    Shape before = {1, 0, 0}, now = {z, 2, 0};

    for (int n = 1; n < k; n++) {
        const double a = legendre ? (2 * n + 1.0) / (n + 1) : 2, c = legendre ? n / (n + 1.0) : 1;
        const Shape next = {a * z * now.value - c * before.value,
                            a * (z * now.slope + 2 * now.value) - c * before.slope,
                            a * (z * now.curve + 4 * now.slope) - c * before.curve};

        before = now;
        now = next;
    }
    return k == 0 ? before : now;
}

/* integrals of Legendre's from 0 (Abramowitz and Stegun 8.5) */
static double integral_of(int times, int k, double xi)
{
    if (times == 0)
        return orthogonal(true, k, xi).value;
    if (k == 0)
        return times == 1 ? xi : xi * xi / 2;
    return (integral_of(times - 1, k + 1, xi) - integral_of(times - 1, k - 1, xi)) /
           (2 * (2 * k + 1));
}

static Shape shape(int basis, bool bends, int k, double xi)
{
    const int order = bends ? 2 : 1, n = k + order;
    Shape own;

    if (basis == 1)
        return (Shape){pow(xi, n), n * pow(xi, n - 1), n > 1 ? n * (n - 1) * pow(xi, n - 2) : 0};
    if (basis == 0)
        return (Shape){integral_of(order, k, xi), integral_of(order - 1, k, xi),
                       bends ? integral_of(0, k, xi) : 0};
    own = orthogonal(false, k, xi);
    return bends ? (Shape){xi * xi * own.value, xi * xi * own.slope + 2 * xi * own.value,
                           xi * xi * own.curve + 4 * xi * own.slope + 2 * own.value}
                 : (Shape){xi * own.value, xi * own.slope + own.value, 0};
}

/* --- Gauss's points --- */

typedef struct Rule {
    double at[POINTS], weight[POINTS];
} Rule;

static Rule rule_of(int n)
{
    const double pi = acos(-1);
    Rule rule = {{0}, {0}};

    for (int i = 0; i < n; i++) {
        double xi = (1 - cos(pi * (i + 0.75) / (n + 0.5))) / 2;
        Shape p = orthogonal(true, n, xi);

        for (int round = 0; round < 8; round++) {
            xi -= p.value / p.slope;
            p = orthogonal(true, n, xi);
        }
        rule.at[i] = xi;
        rule.weight[i] = 1 / (xi * (1 - xi) * p.slope * p.slope);
    }
    return rule;
}

typedef struct Table {
    Rule outer, inner;
    Shape at[MOST][POINTS];
    double below[MOST][POINTS][INNER]; /* slopes between 0 and a point */
} Table;

static bool bends(const Bar *bar, int i)
{
    return bar->family[i] == 1 || bar->family[i] == 2;
}

static void make_table(const Bar *bar, Table *table)
{
    table->outer = rule_of(POINTS);
    table->inner = rule_of(INNER);
    for (int i = 0; i < bar->count; i++)
        for (int p = 0; p < POINTS; p++) {
            const double xi = table->outer.at[p];

            table->at[i][p] = shape(bar->basis, bends(bar, i), bar->term[i], xi);
            for (int k = 0; k < INNER && bends(bar, i); k++)
                table->below[i][p][k] =
                    shape(bar->basis, true, bar->term[i], xi * table->inner.at[k]).slope;
        }
}

/* --- what a beam has --- */

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* exp(turn) v */
static void turned(const double turn[3], const double v[3], double out[3])
{
    const double a = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    const double s = a > 1e-9 ? sin(a) / a : 1, c = a > 1e-9 ? (1 - cos(a)) / (a * a) : 0.5;
    double x[3], y[3];

    cross(turn, v, x);
    cross(turn, x, y);
    for (int k = 0; k < 3; k++)
        out[k] = v[k] + s * x[k] + c * y[k];
}

/* at a point: where (axes of the root), section angles c, b, a, and rates of both; strains */
typedef struct Field {
    double p[3], p_rate[3], angle[3], turning[3], strain[FAMILIES_OF_SHAPES];
} Field;

static Field field(const Bar *bar, const Table *table, const State *state, int p)
{
    static const int shifted[] = {0, 1, 2, -1}, angle[] = {-1, 2, 1, 0};
    const double L = bar->L;
    Field f = {.p = {L * table->outer.at[p]}};

    for (int i = 0; i < bar->count; i++) {
        const Shape *own = &table->at[i][p];
        const int family = bar->family[i], s = shifted[family], a = angle[family];
        const double turn = a == 0 ? own->value : (a == 1 ? -1 : 1) * own->slope / L;

        if (s >= 0) {
            f.p[s] += state->q[i] * own->value;
            f.p_rate[s] += state->rate[i] * own->value;
        }
        if (a >= 0) {
            f.angle[a] += state->q[i] * turn;
            f.turning[a] += state->rate[i] * turn;
        }
        f.strain[family] += state->q[i] * (bends(bar, i) ? own->curve / (L * L) : own->slope / L);
    }
    for (int k = 0; k < INNER; k++) {
        const double weight = table->inner.weight[k] * table->outer.at[p] / L;
        double bent[2] = {0}, bending[2] = {0};

        for (int i = 0; i < bar->count; i++)
            if (bends(bar, i)) {
                bent[bar->family[i] - 1] += state->q[i] * table->below[i][p][k];
                bending[bar->family[i] - 1] += state->rate[i] * table->below[i][p][k];
            }
        f.p[0] -= weight * (bent[0] * bent[0] + bent[1] * bent[1]) / 2;
        f.p_rate[0] -= weight * (bent[0] * bending[0] + bent[1] * bending[1]);
    }
    return f;
}

/* angular velocity of a section by the root's and its own: A w + C theta' */
static void spin_of(const Field *f, const double W[3], double A[3][3], double out[3])
{
    const double c = f->angle[0], b = f->angle[1], a = f->angle[2];
    const double *rate = f->turning;
    const double entries[3][3] = {{1 - (a * a + b * b) / 2, a, -b},
                                  {-a + b * c, 1 - (a * a + c * c) / 2, c},
                                  {b + a * c, -c + a * b, 1 - (b * b + c * c) / 2}};
    const double own[3] = {rate[0] - b * rate[2], rate[1] + c * rate[2], rate[2] - c * rate[1]};

    memcpy(A, entries, sizeof entries);
    for (int r = 0; r < 3; r++) {
        out[r] = own[r];
        for (int s = 0; s < 3; s++)
            out[r] += A[r][s] * W[s];
    }
}

/* momentum, its moment about ground's origin, energy; *kinetic of it */
static void find_kept(const Bar *bar, const Table *table, const State *state, double kept[KEPT],
                      double *kinetic)
{
    double stored = 0;

    memset(kept, 0, KEPT * sizeof *kept);
    *kinetic = 0;
    for (int p = 0; p < POINTS; p++) {
        const double weight = bar->L * table->outer.weight[p];
        const Field f = field(bar, table, state, p);
        double at[3], v[3], spun[3], moment[3], A[3][3], w[3], h[3] = {0}, spin[3];

        cross(state->W, f.p, spun);
        for (int k = 0; k < 3; k++)
            spun[k] += f.p_rate[k];
        turned(state->turn, spun, v);
        turned(state->turn, f.p, at);
        for (int k = 0; k < 3; k++) {
            v[k] += state->v[k];
            at[k] += state->r[k];
            kept[k] += weight * bar->rho * v[k];
            *kinetic += weight * bar->rho * v[k] * v[k] / 2;
        }
        spin_of(&f, state->W, A, w);
        for (int r = 0; r < 3; r++) {
            *kinetic += weight * bar->J[r] * w[r] * w[r] / 2;
            for (int s = 0; s < 3; s++)
                h[s] += A[r][s] * bar->J[r] * w[r];
        }
        cross(at, v, moment);
        turned(state->turn, h, spin);
        for (int k = 0; k < 3; k++)
            kept[3 + k] += weight * (bar->rho * moment[k] + spin[k]);
        for (int family = 0; family < FAMILIES_OF_SHAPES; family++)
            stored += weight * bar->stiff[family] * f.strain[family] * f.strain[family] / 2;
    }
    kept[6] = *kinetic + stored;
}

/* --- members --- */

static void draw_bar(Member *m, Bar *bar, bool planar)
{
    *bar = (Bar){.planar = planar, .basis = (int)(test_random(&m->random) % 3)};
    const int most = bar->basis == 1 ? 5 : planar ? TERMS : 6;

    bar->L = member_between(m, 0.5, 2);
    bar->rho = member_between(m, 0.5, 3);
    bar->modes[0] = (int)(test_random(&m->random) % 3);
    bar->modes[1] = 1 + (int)(test_random(&m->random) % (unsigned)most);
    bar->modes[2] = planar ? 0 : 1 + (int)(test_random(&m->random) % (unsigned)most);
    bar->modes[3] = planar ? 0 : (int)(test_random(&m->random) % 4);
    for (int f = 0; f < FAMILIES_OF_SHAPES; f++) {
        for (int k = 0; k < bar->modes[f]; k++, bar->count++) {
            bar->family[bar->count] = f;
            bar->term[bar->count] = k;
        }
        bar->stiff[f] = member_between(m, 5, 50);
    }
    for (int k = planar ? 2 : 0; k < 3; k++)
        bar->J[k] = member_between(m, 0.01, 0.1);
}

/* deflections of some hundredths of the length */
static void draw_state(Member *m, const Bar *bar, const Table *table, State *state)
{
    *state = (State){.turn = {0}};
    for (int k = 0; k < (bar->planar ? 2 : 3); k++) {
        state->r[k] = member_between(m, -1, 1);
        state->v[k] = member_between(m, -1, 1);
    }
    for (int k = bar->planar ? 2 : 0; k < 3; k++)
        state->W[k] = member_between(m, -3, 3);
    for (int i = 0; i < bar->count; i++) {
        const double part = 0.1 / ((bar->term[i] + 1) * (bar->term[i] + 1));
        double most = 0;

        for (int p = 0; p < POINTS; p++)
            most = fmax(most, fabs(table->at[i][p].value));
        state->q[i] = member_between(m, -part, part) / most;
        state->rate[i] = 5 * member_between(m, -part, part) / most;
    }
}

static void write_bar(const Bar *bar, Script *script)
{
    script->length = 0;
    if (bar->planar)
        write_line(script, "scene planar");
    write_piece(script,
                "beam b length=%.17g mass_per_length=%.17g EA=%.17g EIz=%.17g EIy=%.17g GJ=%.17g "
                "basis=%s ",
                bar->L, bar->rho, bar->stiff[0], bar->stiff[1], bar->stiff[2], bar->stiff[3],
                bases[bar->basis]);
    if (bar->planar)
        write_line(script, "inertia_per_length=%.17g modes=[%d, %d]", bar->J[2], bar->modes[0],
                   bar->modes[1]);
    else
        write_line(script, "inertia_per_length=[%.17g, %.17g, %.17g] modes=[%d, %d, %d, %d]",
                   bar->J[0], bar->J[1], bar->J[2], bar->modes[0], bar->modes[1], bar->modes[2],
                   bar->modes[3]);
}

static void write_state(const Bar *bar, const State *state, Script *script)
{
    for (int k = 0; k < (bar->planar ? 2 : 3); k++)
        write_line(script, "init b.%c = %.17g, b.%c' = %.17g", 'x' + k, state->r[k], 'x' + k,
                   state->v[k]);
    if (bar->planar)
        write_line(script, "init b.theta = 0, b.theta' = %.17g", state->W[2]);
    else
        write_line(script,
                   "init b.q0 = 1, b.q1 = 0, b.q2 = 0, b.q3 = 0, b.Wx = %.17g, b.Wy = %.17g, "
                   "b.Wz = %.17g",
                   state->W[0], state->W[1], state->W[2]);
    for (int i = 0; i < bar->count; i++)
        write_line(script, "init b.%s%d = %.17g, b.%s%d' = %.17g", letters[bar->family[i]],
                   bar->term[i] + 1, state->q[i], letters[bar->family[i]], bar->term[i] + 1,
                   state->rate[i]);
    write_line(script, "assemble");
}

static double told(Kit *kit, const char *name, int k)
{
    char text[64];

    (void)snprintf(text, sizeof text, name, k);
    return kit_value(kit, text);
}

/* accelerations, in the places of what they are rates of */
static State accelerations(Kit *kit, const Bar *bar)
{
    State out = {.turn = {0}};

    for (int k = 0; k < (bar->planar ? 2 : 3); k++)
        out.v[k] = told(kit, "b.%c'' at 0", 'x' + k);
    for (int k = 0; k < 3 && !bar->planar; k++)
        out.W[k] = told(kit, "b.W%c' at 0", 'x' + k);
    if (bar->planar)
        out.W[2] = kit_value(kit, "b.theta'' at 0");
    for (int i = 0; i < bar->count; i++) {
        char name[32];

        (void)snprintf(name, sizeof name, "b.%s%d'' at 0", letters[bar->family[i]],
                       bar->term[i] + 1);
        out.rate[i] = kit_value(kit, name);
    }
    return out;
}

/* the path that begins so: to second order, which is all that a rate at its beginning needs */
static State moved(const State *state, const State *second, double t)
{
    State out = *state;

    for (int k = 0; k < 3; k++) {
        out.r[k] += t * state->v[k] + t * t / 2 * second->v[k];
        out.v[k] += t * second->v[k];
        out.turn[k] += t * state->W[k] + t * t / 2 * second->W[k];
        out.W[k] += t * second->W[k];
    }
    for (int i = 0; i < MOST; i++) {
        out.q[i] += t * state->rate[i] + t * t / 2 * second->rate[i];
        out.rate[i] += t * second->rate[i];
    }
    return out;
}

/* rates by central differences of order 6, and how much there is in them to cancel */
static void find_rates(const Bar *bar, const Table *table, const State *state, const State *second,
                       double rate[KEPT], double size[KEPT])
{
    static const double factor[] = {0.75, -0.15, 1.0 / 60};
    double fastest = 1, t, kinetic;

    for (int i = 0; i < bar->count; i++)
        fastest = fmax(fastest, fabs(second->rate[i]));
    for (int k = 0; k < 3; k++)
        fastest = fmax(fastest, fmax(fabs(second->v[k]), fabs(second->W[k])));
    t = 0.01 / fastest;
    memset(rate, 0, KEPT * sizeof *rate);
    memset(size, 0, KEPT * sizeof *size);
    for (int side = -3; side <= 3; side++) {
        const State there = moved(state, second, side * t);
        double kept[KEPT];

        if (side == 0)
            continue;
        find_kept(bar, table, &there, kept, &kinetic);
        for (int k = 0; k < KEPT; k++) {
            rate[k] += (side < 0 ? -1 : 1) * factor[abs(side) - 1] * kept[k] / t;
            size[k] = fmax(size[k], fabs(kept[k]));
        }
    }
    for (int k = 0; k < KEPT; k++)
        size[k] = (size[k] + 1) * fastest;
}

static Verdict laws(Member *m, bool planar)
{
    static Script script;
    static Table table;
    Bar bar;
    State state, second;
    double kept[KEPT], kinetic, rate[KEPT], size[KEPT];
    Kit kit = kit_new();
    bool agrees;

    draw_bar(m, &bar, planar);
    make_table(&bar, &table);
    draw_state(m, &bar, &table, &state);
    write_bar(&bar, &script);
    write_state(&bar, &state, &script);
    find_kept(&bar, &table, &state, kept, &kinetic);
    agrees = kit_do(&kit, script.text) == CT_OK;
    if (!agrees)
        tell(m, "%s\n", kit.error.message);
    agrees = agrees && keeps(m, "kinetic energy",
                             fabs(kit_value(&kit, "energy.kinetic at 0") / kinetic - 1), 1e-12);
    agrees = agrees &&
             keeps(m, "elastic energy",
                   fabs(kit_value(&kit, "energy.potential at 0") / (kept[6] - kinetic) - 1), 1e-11);
    if (agrees) {
        second = accelerations(&kit, &bar);
        find_rates(&bar, &table, &state, &second, rate, size);
        for (int k = 0; k < KEPT; k++)
            agrees = keeps(m,
                           k < 3   ? "momentum"
                           : k < 6 ? "its moment"
                                   : "energy",
                           fabs(rate[k]) / size[k], 1e-12) &&
                     agrees;
    }
    if (!agrees || m->told)
        tell(m, "%s", script.text);
    kit_free(&kit);
    return agrees ? AGREES : DISAGREES;
}

static Verdict laws_in_plane(Member *m)
{
    return laws(m, true);
}

static Verdict laws_in_space(Member *m)
{
    return laws(m, false);
}

static const Family families[] = {
    {"a free beam in the plane, of up to 16 shapes, keeps what it has to", 24, 0, 0, laws_in_plane},
    {"a free beam in space, sections turning, keeps what it has to", 8, 0, 0, laws_in_space},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof *families), argc, argv);
}
