/* pieces.h: networks of parts that are straight lines, without steps that err
 *
 * While no diode and no switch goes over the network is linear, and its sources are sines: node
 * voltages, states, sine, cosine and 1 make a vector z with z' = M z, and z a time h on is
 * exp(M h) z. Tables of exp(M h) - 1 by halves of h (less 1, so that short times keep their digits)
 * take z anywhere. A time behind which a diode is wrong is halved until nothing is left of it, and
 * the diode goes over there. What is as good as rounding needs no order and no tolerance. */
#ifndef COTREE_TESTS_PIECES_H
#define COTREE_TESTS_PIECES_H

#include "networks.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define PER_PERIOD 20000 /* times at which sides are looked at, of the source's period, */
#define PER_SWING  100   /* and at least of the fastest swing */
#define RANK       1e-13 /* of the largest eigenvalue: none */
#define EXACT      1e-9  /* of the largest source: what is certain of a voltage */

#define ROUNDING 1e-12 /* of the largest source, or of the terms of a sum */

enum { ENTRIES = ROOM + 12, LEVELS = 64, KEPT_MODES = 48, INSTANT = 28 /* a level: no time */ };

typedef double VerifiedSolve[ENTRIES][ENTRIES];

typedef struct Mode {
    bool closed[PARTS];
    bool known;
    double volts[ROOM + 1][ENTRIES]; /* node voltages from z */
    int finest;
    VerifiedSolve *grown; /* one a level: exp(M longest/2^level) - 1 */
} Mode;

typedef struct Pieces {
    const Network *net;
    int rank;                 /* of the capacitors' matrix: so many charges */
    int coils, size;          /* z: charges' voltages, coils' currents, sine, cosine, 1 */
    int coil[PARTS];          /* part of each */
    double basis[ROOM][ROOM]; /* eigenvectors of that matrix, by columns; charges first */
    double stored[ROOM];      /* eigenvalues, F */
    double longest;           /* s */
    double largest;           /* V of any source */
    Mode mode[KEPT_MODES];
    int next_mode;
    Mode *now;
    bool closed[PARTS];
    double t, z[ENTRIES];
    double lost[ENTRIES]; /* what rounding has kept from z, for many short times add up */
} Pieces;

/* --- the capacitors' matrix --- */

static void turn_pair(double a[ROOM][ROOM], double u[ROOM][ROOM], int n, int p, int q)
{
    const double angle = 0.5 * atan2(2 * a[p][q], a[q][q] - a[p][p]);
    const double c = cos(angle), s = sin(angle);

    for (int k = 0; k < n; k++) {
        const double kp = a[k][p], kq = a[k][q], up = u[k][p], uq = u[k][q];

        a[k][p] = c * kp - s * kq;
        a[k][q] = s * kp + c * kq;
        u[k][p] = c * up - s * uq;
        u[k][q] = s * up + c * uq;
    }
    for (int k = 0; k < n; k++) {
        const double pk = a[p][k], qk = a[q][k];

        a[p][k] = c * pk - s * qk;
        a[q][k] = s * pk + c * qk;
    }
}

static void swap_columns(Pieces *o, int a, int b)
{
    for (int k = 0; k < o->net->nodes; k++) {
        const double kept = o->basis[k][a];

        o->basis[k][a] = o->basis[k][b];
        o->basis[k][b] = kept;
    }
}

/* eigenvectors by Jacobi's method, those that store something first */
static void find_basis(Pieces *o)
{
    static double a[ROOM][ROOM];
    const int n = o->net->nodes;
    double largest = 0;

    memset(a, 0, sizeof a);
    for (int i = 0; i < o->net->count; i++) {
        const Part *p = &o->net->part[i];
        const int ends[] = {p->plus - 1, p->minus - 1};

        for (int k = 0; k < 2 && p->kind == CAPACITOR; k++) {
            if (ends[k] >= 0)
                a[ends[k]][ends[k]] += p->value;
            if (ends[0] >= 0 && ends[1] >= 0)
                a[ends[k]][ends[1 - k]] -= p->value;
        }
    }
    for (int i = 0; i < n; i++)
        o->basis[i][i] = 1;
    for (int sweep = 0; sweep < 30; sweep++)
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++)
                if (a[p][q] != 0)
                    turn_pair(a, o->basis, n, p, q);
    for (int i = 0; i < n; i++)
        largest = fmax(largest, a[i][i]);
    for (int i = 0; i < n; i++)
        if (a[i][i] > RANK * largest) {
            swap_columns(o, i, o->rank);
            o->stored[o->rank] = a[i][i];
            a[i][i] = a[o->rank][o->rank]; /* the two change places */
            o->rank++;
        }
}

/* --- one mode --- */

/* i = conductance v + rest, rest by sine, cosine and 1 */
static void line_in_mode(const Pieces *o, int i, const bool *closed, double *conductance,
                         double rest[3])
{
    const Part *p = &o->net->part[i];

    *conductance = rest[0] = rest[1] = rest[2] = 0;
    if (p->kind == RESISTOR) {
        *conductance = 1 / p->value;
    } else if (p->kind == SOURCE) {
        *conductance = 1 / p->series;
        rest[0] = -p->value * cos(p->phase) / p->series;
        rest[1] = -p->value * sin(p->phase) / p->series;
    } else if (p->kind == DIODE) {
        *conductance = 1 / (closed[i] ? p->on : p->off);
        rest[2] = closed[i] ? p->least / p->off - p->least / p->on : 0;
    } else if (p->kind == SWITCH) {
        *conductance = 1 / ((closed[i] ? p->on : p->off) + p->series);
    }
}

/* conductances between nodes, and what else flows out of each by z */
static void write_nodes(const Pieces *o, const bool *closed, double g[ROOM][ROOM],
                        double out[ROOM][ENTRIES])
{
    for (int i = 0; i < o->net->count; i++) {
        const Part *p = &o->net->part[i];
        const int ends[] = {p->plus - 1, p->minus - 1};
        double conductance, rest[3];

        line_in_mode(o, i, closed, &conductance, rest);
        for (int k = 0; k < 2; k++) {
            const int sign = k == 0 ? 1 : -1;

            if (ends[k] < 0)
                continue;
            g[ends[k]][ends[k]] += conductance;
            if (ends[1 - k] >= 0)
                g[ends[k]][ends[1 - k]] -= conductance;
            for (int j = 0; j < 3; j++)
                out[ends[k]][o->size - 3 + j] += sign * rest[j];
        }
    }
    for (int c = 0; c < o->coils; c++) {
        const Part *p = &o->net->part[o->coil[c]];

        if (p->plus > 0)
            out[p->plus - 1][o->rank + c] += 1;
        if (p->minus > 0)
            out[p->minus - 1][o->rank + c] -= 1;
    }
}

/* Gauss's method with many right sides, in place: a is symmetric and positive definite */
static void solve_many(int n, double a[ROOM][ROOM], int count, double b[ROOM][ENTRIES])
{
    for (int c = 0; c < n; c++)
        for (int r = c + 1; r < n; r++) {
            const double f = a[r][c] / a[c][c];

            for (int k = c; k < n && f != 0; k++)
                a[r][k] -= f * a[c][k];
            for (int k = 0; k < count && f != 0; k++)
                b[r][k] -= f * b[c][k];
        }
    for (int r = n - 1; r >= 0; r--)
        for (int j = 0; j < count; j++) {
            for (int k = r + 1; k < n; k++)
                b[r][j] -= a[r][k] * b[k][j];
            b[r][j] /= a[r][r];
        }
}

/* Node voltages from z: what no capacitor holds follows from the currents. */
static void find_volts(const Pieces *o, const bool *closed, double volts[ROOM + 1][ENTRIES],
                       double g[ROOM][ROOM], double out[ROOM][ENTRIES])
{
    static double gu[ROOM][ROOM], a[ROOM][ROOM], b[ROOM][ENTRIES];
    const int n = o->net->nodes, free = n - o->rank;

    memset(g, 0, sizeof(double[ROOM][ROOM]));
    memset(out, 0, sizeof(double[ROOM][ENTRIES]));
    memset(volts, 0, sizeof(double[ROOM + 1][ENTRIES]));
    memset(b, 0, sizeof b);
    write_nodes(o, closed, g, out);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            gu[i][k] = 0;
            for (int j = 0; j < n; j++)
                gu[i][k] += g[i][j] * o->basis[j][k];
        }
    for (int r = 0; r < free; r++)
        for (int j = 0; j < n; j++) {
            const double u = o->basis[j][o->rank + r];

            for (int k = 0; k < free; k++)
                a[r][k] = (j > 0 ? a[r][k] : 0) + u * gu[j][o->rank + k];
            for (int k = 0; k < o->rank; k++)
                b[r][k] -= u * gu[j][k];
            for (int k = o->rank; k < o->size; k++)
                b[r][k] -= u * out[j][k];
        }
    solve_many(free, a, o->size, b);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < o->size; k++) {
            volts[i + 1][k] = k < o->rank ? o->basis[i][k] : 0;
            for (int r = 0; r < free; r++)
                volts[i + 1][k] += o->basis[i][o->rank + r] * b[r][k];
        }
}

/* z' = M z */
static void find_rates(const Pieces *o, const Mode *mode, double g[ROOM][ROOM],
                       double out[ROOM][ENTRIES], VerifiedSolve rates)
{
    const int n = o->net->nodes;

    memset(rates, 0, sizeof(VerifiedSolve));
    for (int i = 0; i < n; i++)
        for (int k = 0; k < o->size; k++)
            for (int j = 0; j < n; j++)
                out[i][k] += g[i][j] * mode->volts[j + 1][k];
    for (int r = 0; r < o->rank; r++)
        for (int k = 0; k < o->size; k++)
            for (int i = 0; i < n; i++)
                rates[r][k] -= o->basis[i][r] * out[i][k] / o->stored[r];
    for (int c = 0; c < o->coils; c++) {
        const Part *p = &o->net->part[o->coil[c]];

        for (int k = 0; k < o->size; k++)
            rates[o->rank + c][k] = (mode->volts[p->plus][k] - mode->volts[p->minus][k]) / p->value;
    }
    rates[o->size - 3][o->size - 2] = o->net->omega;
    rates[o->size - 2][o->size - 3] = -o->net->omega;
}

static void multiply(int n, const VerifiedSolve a, const VerifiedSolve b, VerifiedSolve out)
{
    memset(out, 0, sizeof(VerifiedSolve));
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            for (int j = 0; j < n && a[i][k] != 0; j++)
                out[i][j] += a[i][k] * b[k][j];
}

/* exp(M h) - 1 by its series where h is next to nothing, and from there by exp(2x) - 1 = 2e + e^2,
 * e = exp(x) - 1 */
static void find_growth(const Pieces *o, Mode *mode, VerifiedSolve rates)
{
    static VerifiedSolve power, next;
    const int n = o->size;
    double norm = 0, h;

    for (int i = 0; i < n; i++) {
        double sum = 0;

        for (int k = 0; k < n; k++)
            sum += fabs(rates[i][k]);
        norm = fmax(norm, sum);
    }
    for (mode->finest = 45;
         mode->finest < LEVELS - 1 && norm * ldexp(o->longest, -mode->finest) > 1e-3;)
        mode->finest++;
    h = ldexp(o->longest, -mode->finest);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            power[i][k] = rates[i][k] *= h;
    memcpy(mode->grown[mode->finest], rates, sizeof(VerifiedSolve));
    for (int term = 2; term <= 6; term++) {
        multiply(n, power, rates, next);
        for (int i = 0; i < n; i++)
            for (int k = 0; k < n; k++)
                mode->grown[mode->finest][i][k] += power[i][k] = next[i][k] / term;
    }
    for (int level = mode->finest; level > 0; level--) {
        const double(*e)[ENTRIES] = (const double(*)[ENTRIES])mode->grown[level];
        double(*twice)[ENTRIES] = mode->grown[level - 1];

        multiply(n, e, e, twice);
        for (int i = 0; i < n; i++)
            for (int k = 0; k < n; k++)
                twice[i][k] += 2 * e[i][k];
    }
}

static void take_mode(Pieces *o)
{
    static double g[ROOM][ROOM], out[ROOM][ENTRIES];
    static VerifiedSolve rates;
    Mode *mode;

    for (int i = 0; i < KEPT_MODES; i++)
        if (o->mode[i].known && memcmp(o->mode[i].closed, o->closed, sizeof o->closed) == 0) {
            o->now = &o->mode[i];
            return;
        }
    mode = o->now = &o->mode[o->next_mode];
    o->next_mode = (o->next_mode + 1) % KEPT_MODES;
    if (mode->grown == NULL)
        mode->grown = malloc(LEVELS * sizeof(VerifiedSolve));
    mode->known = true;
    memcpy(mode->closed, o->closed, sizeof o->closed);
    find_volts(o, mode->closed, mode->volts, g, out);
    find_rates(o, mode, g, out, rates);
    find_growth(o, mode, rates);
}

/* --- sides --- */

static double node_voltage(const Pieces *o, double volts[ROOM + 1][ENTRIES], const double *z,
                           int node)
{
    double sum = 0;

    for (int k = 0; k < o->size && node > 0; k++)
        sum += volts[node][k] * z[k];
    return sum;
}

/* V by which a diode is on the wrong side; negative: it isn't */
static double excess_of(const Pieces *o, int i, const bool *closed, double volts[ROOM + 1][ENTRIES],
                        const double *z)
{
    const Part *p = &o->net->part[i];
    const double excess =
        node_voltage(o, volts, z, p->plus) - node_voltage(o, volts, z, p->minus) - p->least;

    return closed[i] ? -excess : excess;
}

/* What rounding may make of that. An open diode may be closed too late by so many of the source's
 * volts; a closed one has to open by less, of what its own voltage sums: where a leak pushes it
 * back, that is smaller by Ron/Roff than what it blocks when open. */
static double excess_rounding(const Pieces *o, int i, const bool *closed,
                              double volts[ROOM + 1][ENTRIES], const double *z)
{
    const Part *p = &o->net->part[i];
    double terms = p->least;

    if (!closed[i])
        return ROUNDING * o->largest;
    for (int k = 0; k < o->size; k++)
        terms += (fabs(volts[p->plus][k]) + fabs(volts[p->minus][k])) * fabs(z[k]);
    return ROUNDING * fmin(terms, o->largest);
}

/* a diode that isn't on the side that its voltage asks for; -1: none */
static int wrong_diode(const Pieces *o, const bool *closed, double volts[ROOM + 1][ENTRIES],
                       const double *z)
{
    for (int i = 0; i < o->net->count; i++)
        if (o->net->part[i].kind == DIODE &&
            excess_of(o, i, closed, volts, z) > excess_rounding(o, i, closed, volts, z))
            return i;
    return -1;
}

/* Sides at z by one exchange after another (Murty 1974), and voltages; false: it goes in circles.
 */
static bool settle_sides(const Pieces *o, bool *closed, double volts[ROOM + 1][ENTRIES],
                         const double *z)
{
    static double g[ROOM][ROOM], out[ROOM][ENTRIES];

    for (int turn = 0; turn < 4000; turn++) {
        int i;

        find_volts(o, closed, volts, g, out);
        i = wrong_diode(o, closed, volts, z);
        if (i < 0)
            return true;
        closed[i] = !closed[i];
    }
    return false;
}

/* --- from start to end --- */

/* Charges that the capacitors' voltages at the start make. */
static void begin_charged(Pieces *o)
{
    for (int i = 0; i < o->net->count; i++) {
        const Part *p = &o->net->part[i];

        for (int r = 0; r < o->rank && p->kind == CAPACITOR; r++)
            o->z[r] += p->value * p->start / o->stored[r] *
                       ((p->plus > 0 ? o->basis[p->plus - 1][r] : 0) -
                        (p->minus > 0 ? o->basis[p->minus - 1][r] : 0));
    }
}

/* all diodes right at the very instant; false: they go in circles */
static bool pieces_settle(Pieces *o)
{
    static double volts[ROOM + 1][ENTRIES];
    const bool settled = settle_sides(o, o->closed, volts, o->z);

    take_mode(o);
    return settled;
}

/* at time 0; false: there is no start */
static bool pieces_begin(Pieces *o, const Network *net)
{
    double slowest = INFINITY, least = INFINITY;

    memset(o, 0, offsetof(Pieces, mode));
    for (int i = 0; i < KEPT_MODES; i++)
        o->mode[i].known = false;
    memset(o->closed, 0, sizeof o->closed);
    memset(o->z, 0, sizeof o->z);
    memset(o->lost, 0, sizeof o->lost);
    o->net = net;
    o->t = 0;
    find_basis(o);
    for (int i = 0; i < net->count; i++) {
        const Part *p = &net->part[i];

        if (p->kind == COIL) {
            o->coil[o->coils++] = i;
            least = fmin(least, p->value);
        } else if (p->kind == SOURCE) {
            o->largest = fmax(o->largest, p->value);
        } else if (p->kind == SWITCH) {
            o->closed[i] = sin(p->phase) > p->level;
        }
    }
    for (int r = 0; r < o->rank; r++)
        slowest = fmin(slowest, o->stored[r]);
    o->size = o->rank + o->coils + 3;
    o->longest = 2 * PI / net->omega / PER_PERIOD;
    if (isfinite(least) && isfinite(slowest))
        o->longest = fmin(o->longest, 2 * PI * sqrt(least * slowest) / PER_SWING);
    o->z[o->size - 2] = o->z[o->size - 1] = 1;
    begin_charged(o);
    return pieces_settle(o);
}

static void pieces_free(Pieces *o)
{
    for (int i = 0; i < KEPT_MODES; i++)
        free(o->mode[i].grown);
    free(o);
}

/* the first instant behind t, and not behind `end`, at which a switch goes over; *which: -1 none */
static double next_change(const Pieces *o, double end, int *which, bool *closes)
{
    const double w = o->net->omega;

    *which = -1;
    for (int i = 0; i < o->net->count; i++) {
        const Part *p = &o->net->part[i];
        const double places[] = {asin(p->level) - p->phase, PI - asin(p->level) - p->phase};

        for (int k = 0; k < 2 && p->kind == SWITCH; k++) {
            const double turns = floor((w * o->t - places[k]) / (2 * PI) + 1e-9) + 1;
            const double t = (places[k] + 2 * PI * turns) / w;

            if (t <= end) {
                end = t;
                *which = i;
                *closes = k == 0;
            }
        }
    }
    return end;
}

/* z a time of that level on */
static void look_on(const Pieces *o, int level, double *next, double *lost)
{
    const double(*grown)[ENTRIES] = (const double(*)[ENTRIES])o->now->grown[level];

    for (int i = 0; i < o->size; i++) {
        double sum = 0;

        for (int k = 0; k < o->size; k++)
            sum += grown[i][k] * o->z[k];
        lost[i] = o->lost[i] + sum;
        next[i] = o->z[i] + lost[i];
        lost[i] -= next[i] - o->z[i];
    }
}

/* To `end` without a switch that goes over; false: diodes go to and fro. */
static bool go_on(Pieces *o, double end)
{
    int level = o->now->finest, flips = 0;

    while (o->t < end) {
        double next[ENTRIES], lost[ENTRIES];
        int wrong;

        while (level < o->now->finest && ldexp(o->longest, -level) > end - o->t)
            level++;
        if (end - o->t <= 1e-15 * end) {
            o->t = end;
            break;
        }
        look_on(o, level, next, lost);
        wrong = wrong_diode(o, o->closed, o->now->volts, next);
        if (wrong >= 0 && level < o->now->finest &&
            (level < INSTANT || excess_of(o, wrong, o->closed, o->now->volts, o->z) < 0)) {
            level++;
            continue;
        }
        if (wrong >= 0 && ++flips < 1000) {
            o->closed[wrong] = !o->closed[wrong];
            take_mode(o);
            level = o->now->finest;
            continue;
        }
        if (wrong >= 0)
            return false;
        memcpy(o->z, next, sizeof next);
        memcpy(o->lost, lost, sizeof lost);
        o->t += ldexp(o->longest, -level);
        if (level > 0)
            level--;
        if (level == 0)
            flips = 0;
    }
    return true;
}

static bool pieces_go_to(Pieces *o, double end)
{
    while (o->t < end) {
        bool closes = false;
        int which;
        const double to = next_change(o, end, &which, &closes);

        if (!go_on(o, to))
            return false;
        o->t = to;
        if (which >= 0) {
            o->closed[which] = closes;
            if (!pieces_settle(o))
                return false;
        }
    }
    return true;
}

/* Node voltages, and by how much those change where each state is off by as much as `off` allows of
 * its size. */
static bool pieces_read(const Pieces *o, double off, double *v, double *spread)
{
    static double volts[ROOM + 1][ENTRIES];
    const int n = o->net->nodes;

    for (int i = 1; i <= n; i++) {
        v[i] = node_voltage(o, o->now->volts, o->z, i);
        spread[i] = 0;
    }
    for (int k = 0; k < 2 * (o->size - 3) && off > 0; k++) {
        double z[ENTRIES], moved[ROOM + 1];
        bool closed[PARTS];

        memcpy(z, o->z, sizeof z);
        memcpy(closed, o->closed, sizeof closed);
        z[k / 2] += (k % 2 ? off : -off) * (1 + fabs(z[k / 2]));
        if (!settle_sides(o, closed, volts, z))
            return false;
        for (int i = 1; i <= n; i++) {
            moved[i] = fabs(node_voltage(o, volts, z, i) - v[i]);
            spread[i] += moved[i];
        }
    }
    return true;
}

#endif
