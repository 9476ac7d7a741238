/* family_beams.c: beams against sums over points of them
 *
 * Where a point of a beam is follows from its coordinates by the field of theory 9 alone, here
 * with shapes from their own recurrences and integrals by Simpson's rule; speeds are differences
 * of positions. Kinetic energy, momentum and Lagrange's equations follow from nothing else. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

enum { CELLS = 160, TERMS = 4, FAMILIES_OF_SHAPES = 4, MOST = FAMILIES_OF_SHAPES * TERMS };

static const char *const bases[] = {"legendre", "taylor", "chebyshev"};
static const char *const letters[FAMILIES_OF_SHAPES] = {"u", "v", "w", "phi"};

typedef struct Bar {
    bool planar;
    int basis, modes[FAMILIES_OF_SHAPES], count;
    double L, rho, J[3], stiff[FAMILIES_OF_SHAPES];
} Bar;

/* of the root, and shapes; `turn` comes behind the attitude R, in the root's axes */
typedef struct State {
    double r[3], R[9], turn[3], q[MOST];
} State;

/* --- shapes --- */

static double polynomial(int basis, int k, double xi)
{
    const double z = 2 * xi - 1;
    double before = 1, now = z;

    if (basis == 1 || k == 0)
        return pow(xi, k);
    for (int n = 1; n < k; n++) {
        const double next =
            basis == 0 ? ((2 * n + 1) * z * now - n * before) / (n + 1) : 2 * z * now - before;

        before = now;
        now = next;
    }
    return now;
}

/* integrals of Legendre's from 0, once and twice, by their neighbours (Abramowitz and Stegun 8.5)
 */
static double once(int k, double xi)
{
    return k == 0 ? xi : (polynomial(0, k + 1, xi) - polynomial(0, k - 1, xi)) / (2 * (2 * k + 1));
}

static double twice(int k, double xi)
{
    return k == 0 ? xi * xi / 2 : (once(k + 1, xi) - once(k - 1, xi)) / (2 * (2 * k + 1));
}

/* the k-th shape of a family; its slope by xi, by differences */
static double shape(int basis, int order, int k, double xi)
{
    if (basis == 0)
        return order == 2 ? twice(k, xi) : once(k, xi);
    return pow(xi, order) * polynomial(basis, k, xi);
}

static double slope(int basis, int order, int k, double xi)
{
    const double h = 1e-3;

    return (shape(basis, order, k, xi - 2 * h) - 8 * shape(basis, order, k, xi - h) +
            8 * shape(basis, order, k, xi + h) - shape(basis, order, k, xi + 2 * h)) /
           (12 * h);
}

/* what the shapes are at the points, once a bar: Simpson's points of CELLS cells */
typedef struct Table {
    double value[MOST][2 * CELLS + 1], slope[MOST][2 * CELLS + 1];
    int family[MOST];
} Table;

static void make_table(const Bar *bar, Table *table)
{
    int i = 0;

    for (int f = 0; f < FAMILIES_OF_SHAPES; f++)
        for (int k = 0; k < bar->modes[f]; k++, i++)
            for (int p = 0; p <= 2 * CELLS; p++) {
                const int order = f == 1 || f == 2 ? 2 : 1;
                const double xi = p / (2.0 * CELLS);

                table->family[i] = f;
                table->value[i][p] = shape(bar->basis, order, k, xi);
                table->slope[i][p] = slope(bar->basis, order, k, xi) / bar->L;
            }
}

/* --- points --- */

typedef struct Field {
    double d[FAMILIES_OF_SHAPES], bent[2]; /* and the slopes of v and w */
} Field;

static Field field(const Bar *bar, const Table *table, const double *q, int p)
{
    Field f = {{0}, {0}};

    for (int i = 0; i < bar->count; i++) {
        const int family = table->family[i];

        f.d[family] += q[i] * table->value[i][p];
        if (family == 1 || family == 2)
            f.bent[family - 1] += q[i] * table->slope[i][p];
    }
    return f;
}

static void turn_by(const double w[3], const double v[3], double out[3])
{
    const double a = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    const double s = a > 1e-12 ? sin(a) / a : 1, c = a > 1e-12 ? (1 - cos(a)) / (a * a) : 0.5;
    const double x[3] = {w[1] * v[2] - w[2] * v[1], w[2] * v[0] - w[0] * v[2],
                         w[0] * v[1] - w[1] * v[0]};
    const double y[3] = {w[1] * x[2] - w[2] * x[1], w[2] * x[0] - w[0] * x[2],
                         w[0] * x[1] - w[1] * x[0]};

    for (int k = 0; k < 3; k++)
        out[k] = v[k] + s * x[k] + c * y[k];
}

/* s at all points: cubics through four of them */
static void shorten(const double *bent, double h, double *s)
{
    const int n = 2 * CELLS;

    s[0] = 0;
    for (int p = 1; p <= n; p++) {
        double area = p == 1   ? 9 * bent[0] + 19 * bent[1] - 5 * bent[2] + bent[3]
                      : p == n ? 9 * bent[n] + 19 * bent[n - 1] - 5 * bent[n - 2] + bent[n - 3]
                               : 13 * (bent[p - 1] + bent[p]) - bent[p - 2] - bent[p + 1];

        s[p] = s[p - 1] + area * h / 24;
    }
}

/* all points of the axis in ground axes */
static void place(const Bar *bar, const Table *table, const State *state,
                  double out[2 * CELLS + 1][3])
{
    const double h = bar->L / (2 * CELLS);
    double bent[2 * CELLS + 1], s[2 * CELLS + 1];

    for (int p = 0; p <= 2 * CELLS; p++) {
        const Field f = field(bar, table, state->q, p);

        bent[p] = (f.bent[0] * f.bent[0] + f.bent[1] * f.bent[1]) / 2;
    }
    shorten(bent, h, s);
    for (int p = 0; p <= 2 * CELLS; p++) {
        const Field f = field(bar, table, state->q, p);
        const double at[3] = {p * h + f.d[0] - s[p], f.d[1], f.d[2]};
        double turned[3];

        turn_by(state->turn, at, turned);
        for (int k = 0; k < 3; k++)
            out[p][k] = state->r[k] + state->R[3 * k] * turned[0] +
                        state->R[3 * k + 1] * turned[1] + state->R[3 * k + 2] * turned[2];
    }
}

static State moved(const State *state, const State *rate, double t)
{
    State out = *state;

    for (int k = 0; k < 3; k++) {
        out.r[k] += t * rate->r[k];
        out.turn[k] += t * rate->turn[k];
    }
    for (int i = 0; i < MOST; i++)
        out.q[i] += t * rate->q[i];
    return out;
}

/* for differences, whose error is about its square, however fast it goes */
static double moment_of(const State *rate)
{
    double fastest = 1;

    for (int k = 0; k < 3; k++)
        fastest = fmax(fastest, fmax(fabs(rate->r[k]), fabs(rate->turn[k])));
    for (int i = 0; i < MOST; i++)
        fastest = fmax(fastest, fabs(rate->q[i]));
    return 2e-5 / fastest;
}

/* the sum over points of 1/2 m v.v; of a plane with the spin of sections */
static double kinetic(const Bar *bar, const Table *table, const State *state, const State *rate)
{
    static double low[2 * CELLS + 1][3], high[2 * CELLS + 1][3];
    const double t = moment_of(rate);
    const State before = moved(state, rate, -t), after = moved(state, rate, t);
    double sum = 0;

    place(bar, table, &before, low);
    place(bar, table, &after, high);
    for (int p = 0; p <= 2 * CELLS; p++) {
        const double weight = (p == 0 || p == 2 * CELLS ? 1
                               : p % 2 == 1             ? 4
                                                        : 2) *
                              bar->L / (6 * CELLS);
        const Field turning = field(bar, table, rate->q, p);
        const double spin = rate->turn[2] + turning.bent[0];

        for (int k = 0; k < 3; k++) {
            const double v = (high[p][k] - low[p][k]) / (2 * t);

            sum += weight * bar->rho * v * v / 2;
        }
        if (bar->planar)
            sum += weight * bar->J[2] * spin * spin / 2;
    }
    return sum;
}

/* --- members --- */

static void draw_bar(Member *m, Bar *bar, bool planar)
{
    *bar = (Bar){.planar = planar, .basis = (int)(test_random(&m->random) % 3)};
    bar->L = member_between(m, 0.5, 2);
    bar->rho = member_between(m, 0.5, 3);
    for (int f = 0; f < (planar ? 2 : 3); f++)
        bar->modes[f] = (int)(test_random(&m->random) % (f == 0 ? 3 : TERMS + 1));
    if (bar->modes[1] + bar->modes[0] == 0)
        bar->modes[1] = 2;
    if (!planar && bar->modes[2] == 0)
        bar->modes[2] = 1;
    for (int f = 0; f < FAMILIES_OF_SHAPES; f++) {
        bar->count += bar->modes[f];
        bar->stiff[f] = member_between(m, 5, 50);
    }
    bar->J[2] = planar ? member_between(m, 0, 0.05) : 0;
}

static void write_bar(const Bar *bar, Script *script)
{
    if (bar->planar)
        write_line(script, "scene planar");
    write_piece(script,
                "beam b length=%.17g mass_per_length=%.17g EA=%.17g EIz=%.17g EIy=%.17g GJ=1 "
                "basis=%s ",
                bar->L, bar->rho, bar->stiff[0], bar->stiff[1], bar->stiff[2], bases[bar->basis]);
    if (bar->planar)
        write_line(script, "inertia_per_length=%.17g modes=[%d, %d]", bar->J[2], bar->modes[0],
                   bar->modes[1]);
    else
        write_line(script, "modes=[%d, %d, %d, 0]", bar->modes[0], bar->modes[1], bar->modes[2]);
}

/* turned about z */
static void attitude(State *state, double angle)
{
    const double R[9] = {cos(angle), -sin(angle), 0, sin(angle), cos(angle), 0, 0, 0, 1};

    memcpy(state->R, R, sizeof R);
}

static void draw_state(Member *m, const Bar *bar, State *state, State *rate)
{
    memset(state, 0, sizeof *state);
    memset(rate, 0, sizeof *rate);
    for (int k = 0; k < (bar->planar ? 2 : 3); k++) {
        state->r[k] = member_between(m, -1, 1);
        rate->r[k] = member_between(m, -1, 1);
    }
    for (int k = bar->planar ? 2 : 0; k < 3; k++)
        rate->turn[k] = member_between(m, -2, 2);
    attitude(state, bar->planar ? member_between(m, -3, 3) : 0);
    for (int i = 0; i < bar->count; i++) {
        state->q[i] = member_between(m, -0.1, 0.1);
        rate->q[i] = member_between(m, -0.3, 0.3);
    }
}

static void write_state(const Bar *bar, const State *state, const State *rate, Script *script)
{
    int i = 0;

    for (int k = 0; k < (bar->planar ? 2 : 3); k++)
        write_line(script, "init b.%c = %.17g, b.%c' = %.17g", 'x' + k, state->r[k], 'x' + k,
                   rate->r[k]);
    if (bar->planar)
        write_line(script, "init b.theta = %.17g, b.theta' = %.17g",
                   atan2(state->R[3], state->R[0]), rate->turn[2]);
    else
        write_line(script,
                   "init b.q0 = 1, b.q1 = 0, b.q2 = 0, b.q3 = 0, b.Wx = %.17g, b.Wy = %.17g, "
                   "b.Wz = %.17g",
                   rate->turn[0], rate->turn[1], rate->turn[2]);
    for (int f = 0; f < FAMILIES_OF_SHAPES; f++)
        for (int k = 1; k <= bar->modes[f]; k++, i++)
            write_line(script, "init b.%s%d = %.17g, b.%s%d' = %.17g", letters[f], k, state->q[i],
                       letters[f], k, rate->q[i]);
}

/* --- families --- */

/* the session of a member, run; false: it failed, which the story tells */
static bool run(Member *m, Kit *kit, const Script *script)
{
    const bool done = kit_do(kit, script->text) == CT_OK;

    if (!done)
        tell(m, "%s\n", kit->error.message);
    if (!done || m->told)
        tell(m, "%s", script->text);
    return done;
}

static Verdict energy(Member *m, bool planar)
{
    static Script script;
    static Table table;
    Bar bar;
    State state, rate;
    double wanted;
    Kit kit = kit_new();
    bool agrees;

    script.length = 0;
    draw_bar(m, &bar, planar);
    make_table(&bar, &table);
    draw_state(m, &bar, &state, &rate);
    write_bar(&bar, &script);
    write_state(&bar, &state, &rate, &script);
    write_line(&script, "assemble");
    wanted = kinetic(&bar, &table, &state, &rate);
    agrees =
        run(m, &kit, &script) &&
        keeps(m, "kinetic energy", fabs(kit_value(&kit, "energy.kinetic at 0") / wanted - 1), 1e-6);
    if (!agrees)
        tell(m, "%s", script.text);
    kit_free(&kit);
    return agrees ? AGREES : DISAGREES;
}

static Verdict energy_in_plane(Member *m)
{
    return energy(m, true);
}

static Verdict energy_in_space(Member *m)
{
    return energy(m, false);
}

static double named(Kit *kit, const char *format, const char *what, int k, const char *primes)
{
    char name[64];

    (void)snprintf(name, sizeof name, format, what, k, primes);
    return kit_value(kit, name);
}

/* --- virtual work --- */

/* elastic energy, from curvatures and strains by differences of slopes and stretch */
static double stored(const Bar *bar, const State *state)
{
    const double h = 1e-3;
    double sum = 0;

    for (int p = 0; p <= 2 * CELLS; p++) {
        const double weight = (p == 0 || p == 2 * CELLS ? 1
                               : p % 2 == 1             ? 4
                                                        : 2) *
                              bar->L / (6 * CELLS);
        const double xi = p / (2.0 * CELLS);
        double strain[FAMILIES_OF_SHAPES] = {0};
        int i = 0;

        for (int f = 0; f < FAMILIES_OF_SHAPES; f++)
            for (int k = 0; k < bar->modes[f]; k++, i++)
                strain[f] +=
                    state->q[i] * (f == 1 || f == 2 ? (slope(bar->basis, 2, k, xi + h) -
                                                       slope(bar->basis, 2, k, xi - h)) /
                                                          (2 * h * bar->L * bar->L)
                                                    : slope(bar->basis, 1, k, xi) / bar->L);
        for (int f = 0; f < FAMILIES_OF_SHAPES; f++)
            sum += weight * bar->stiff[f] * strain[f] * strain[f] / 2;
    }
    return sum;
}

static double *part_of(State *state, int j)
{
    return j < 2 ? &state->r[j] : j == 2 ? &state->turn[2] : &state->q[j - 3];
}

/* dT/d(rate j), by differences, T a quadratic form in rates */
static double momentum_of(const Bar *bar, const Table *table, const State *state, const State *rate,
                          int j)
{
    State high = *rate, low = *rate;

    *part_of(&high, j) += 0.5;
    *part_of(&low, j) -= 0.5;
    return kinetic(bar, table, state, &high) - kinetic(bar, table, state, &low);
}

static double lagrangian(const Bar *bar, const Table *table, const State *state, const State *rate)
{
    return kinetic(bar, table, state, rate) - stored(bar, state);
}

/* d/dt dT/dq' - d(T - V)/dq by differences, at the accelerations that are told */
static Verdict lagrange(Member *m)
{
    static Script script;
    static Table table;
    Bar bar;
    State state, rate, second, after[2], speed[2];
    Kit kit = kit_new();
    double off = 0, size = 0, t;
    bool agrees;
    int i = 0;

    script.length = 0;
    draw_bar(m, &bar, true);
    make_table(&bar, &table);
    draw_state(m, &bar, &state, &rate);
    write_bar(&bar, &script);
    write_state(&bar, &state, &rate, &script);
    write_line(&script, "assemble");
    agrees = run(m, &kit, &script);
    memset(&second, 0, sizeof second);
    second.r[0] = kit_value(&kit, "b.x'' at 0");
    second.r[1] = kit_value(&kit, "b.y'' at 0");
    second.turn[2] = kit_value(&kit, "b.theta'' at 0");
    for (int f = 0; f < 2; f++)
        for (int k = 1; k <= bar.modes[f]; k++, i++)
            second.q[i] = named(&kit, "b.%s%d%s", letters[f], k, "'' at 0");
    /* nothing moves far: how much speeds change doesn't count, momentum is straight in them */
    t = fmin(20 * moment_of(&rate), sqrt(0.02 * moment_of(&second)));
    for (int s = 0; s < 2; s++) {
        const double dt = s == 0 ? -t : t;

        after[s] = moved(&state, &rate, dt);
        after[s] = moved(&after[s], &second, dt * dt / 2);
        speed[s] = moved(&rate, &second, dt);
    }
    for (int j = 0; agrees && j < 3 + bar.count; j++) {
        const double h = 1e-3;
        State up = state, down = state;
        double rise = (momentum_of(&bar, &table, &after[1], &speed[1], j) -
                       momentum_of(&bar, &table, &after[0], &speed[0], j)) /
                      (2 * t);

        *part_of(&up, j) += h;
        *part_of(&down, j) -= h;
        size = fmax(size, fabs(rise));
        rise -= (lagrangian(&bar, &table, &up, &rate) - lagrangian(&bar, &table, &down, &rate)) /
                (2 * h);
        off = fmax(off, fabs(rise));
    }
    agrees = agrees && keeps(m, "Lagrange's equations", off / (size + 1), 1e-4);
    if (!agrees)
        tell(m, "%s", script.text);
    kit_free(&kit);
    return agrees ? AGREES : DISAGREES;
}

/* --- trees and bases --- */

typedef struct Rig {
    Bar bar;
    bool hangs; /* from its tip: the tree passes it backwards */
    bool driven;
    double mass, spring, load[2], damping, angle;
} Rig;

static void draw_rig(Member *m, Rig *rig, bool planar)
{
    draw_bar(m, &rig->bar, planar);
    for (int f = 0; f < (planar ? 2 : 3); f++)
        rig->bar.modes[f] = rig->bar.modes[f] > 2 ? 2 : rig->bar.modes[f];
    rig->bar.stiff[0] *= 20;
    rig->hangs = test_random(&m->random) % 2 == 0;
    rig->driven = test_random(&m->random) % 3 == 0;
    rig->mass = member_between(m, 0.1, 1);
    rig->spring = member_between(m, 1, 50);
    rig->damping = member_between(m, 0, 0.01);
    rig->angle = member_between(m, -1, 1);
    for (int k = 0; k < 2; k++)
        rig->load[k] = member_between(m, -2, 2);
}

static void write_rig(const Rig *rig, int basis, const char *tree, Script *script)
{
    const Bar *bar = &rig->bar;

    script->length = 0;
    if (bar->planar)
        write_line(script, "scene planar");
    write_line(script, bar->planar ? "gravity [0, -9.81]" : "gravity [0, 0, -9.81]");
    write_piece(script,
                "beam b length=%.17g mass_per_length=%.17g EA=%.17g EIz=%.17g EIy=%.17g GJ=20 "
                "basis=%s damping=[0.1, %.17g] load=[%.17g, %.17g%s] ",
                bar->L, bar->rho, bar->stiff[0], bar->stiff[1], bar->stiff[2], bases[basis],
                rig->damping, rig->load[0], rig->load[1], bar->planar ? "" : ", 1");
    if (bar->planar)
        write_line(script, "inertia_per_length=%.17g modes=[%d, %d]", bar->J[2], bar->modes[0],
                   bar->modes[1]);
    else
        write_line(script, "inertia_per_length=[0.03, 0.02, 0.01] modes=[%d, %d, %d, 1]",
                   bar->modes[0], bar->modes[1], bar->modes[2]);
    write_line(script, "arm mid b at=%.17g", 0.4 * bar->L);
    write_line(script, "arm tip b at=%.17g", bar->L);
    write_line(script, "arm off mid %s", bar->planar ? "[0.1, 0.2]" : "[0.1, 0.2, 0.3]");
    write_line(script, "revolute h ground %s", rig->hangs ? "tip" : "b");
    write_line(script, "body m mass=%.17g inertia=%s", rig->mass,
               bar->planar ? "0.02" : "[0.02, 0.03, 0.04]");
    write_line(script, "weld w %s m", rig->hangs ? "b" : "tip");
    write_line(script, "arm post ground %s", bar->planar ? "[0.3, 1.4]" : "[0.3, 1.4, 0.2]");
    write_line(script, "spring k1 post off k=%.17g d=0.2 length=0.5", rig->spring);
    write_line(script, "%s", tree);
    if (rig->driven)
        write_line(script, "driver D h = %.17g + t^2", rig->angle);
    else
        write_line(script, "init h = %.17g, h' = 1", rig->angle);
    for (int f = 0; f < FAMILIES_OF_SHAPES; f++)
        for (int k = 1; k <= (f == 3 ? !bar->planar : bar->modes[f]); k++)
            write_line(script, "init b.%s%d = 0, b.%s%d' = 0", letters[f], k, letters[f], k);
    write_line(script, "simulate 0.04 rtol=1e-9 atol=1e-11");
}

enum { TOLD = 8 };

static bool run_rig(Member *m, const Rig *rig, int basis, const char *tree, double *out)
{
    static const char *const told[TOLD] = {"tip.x", "tip.y",        "off.x",        "off.y",
                                           "m.vx",  "h.Fx at 0.02", "energy.total", "m.vy"};
    static Script script;
    Kit kit = kit_new();
    bool done;

    write_rig(rig, basis, tree, &script);
    done = run(m, &kit, &script);
    for (int i = 0; i < TOLD; i++)
        out[i] = kit_value(&kit, told[i]);
    kit_free(&kit);
    return done;
}

/* Joints, bodies, springs and loads on a beam, in coordinates of joints and of bodies, with shapes
 * of one kind and another. */
static Verdict rig(Member *m, bool planar)
{
    Rig rig = {.driven = false};
    double told[3][TOLD];
    bool agrees = true;

    draw_rig(m, &rig, planar);
    agrees = run_rig(m, &rig, 0, "tree joint", told[0]) &&
             run_rig(m, &rig, 1, "tree absolute", told[1]) &&
             run_rig(m, &rig, 2, "tree joint", told[2]);
    for (int way = 1; agrees && way < 3; way++)
        for (int i = 0; i < TOLD; i++)
            agrees = keeps(m, "trees and bases",
                           fabs(told[way][i] - told[0][i]) / (1 + fabs(told[0][i])), 1e-5) &&
                     agrees;
    if (!agrees)
        tell(m, "hangs: %d\n", rig.hangs);
    return agrees ? AGREES : DISAGREES;
}

static Verdict rig_in_plane(Member *m)
{
    return rig(m, true);
}

static Verdict rig_in_space(Member *m)
{
    return rig(m, false);
}

static const Family families[] = {
    {"a beam in the plane has the kinetic energy of its points", 60, 0, 0, energy_in_plane},
    {"a beam in space has the kinetic energy of its points", 30, 0, 0, energy_in_space},
    {"the accelerations of a beam obey Lagrange's equations", 20, 0, 0, lagrange},
    {"trees and bases agree on what hangs on a beam in the plane", 4, 0, 0, rig_in_plane},
    {"trees and bases agree on what hangs on a beam in space", 1, 0, 0, rig_in_space},
};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}
