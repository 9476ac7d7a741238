/* free_bodies.h: an oracle for bodies in space: Newton and Euler in absolute coordinates
 *
 *     m v' = m g + sum F,   J w' + w x J w = sum (r x F + T)
 *
 * with the rows of ball joints and rods on accelerations, all in one dense system, and fixed steps
 * of Runge and Kutta. Body GROUND does not move. A bushing acts by the position d of its tip and
 * its rotation vector p in axes of its tail, e = -K x - D x', with p = th a from acos() of the
 * trace,
 *
 *     p' = B w,   B = 1 - [p]/2 + g [p]^2,   g = 1/th^2 - (1 + cos th)/(2 th sin th)
 *
 * where w is the angular velocity of the tip against the tail; its moment is B^T e. */
#ifndef COTREE_TESTS_FAMILY_FREE_BODIES_H
#define COTREE_TESTS_FAMILY_FREE_BODIES_H

#include "vectors.h"

#include <stdbool.h>
#include <string.h>

enum {
    GROUND = -1,
    MOST_BODIES = 4,
    MOST_TIES = 6,
    MOST_ROWS = 24,
    MOST_SIZE = 6 * MOST_BODIES + MOST_ROWS
};

typedef struct Spot { /* a place on a body, in its axes */
    int body;
    V at;
    double turn[2]; /* of the frame there: about x, then the new y */
} Spot;

typedef struct Bush {
    Spot tail, tip;
    double k[6][6], d[6][6];
} Bush;

/* a ball joint, a rod of that length, or a coupling of two shafts along z, which holds
 * (z_tip + z_tail).(w_tip - w_tail) = 0 */
typedef enum TieKind { TIE_BALL, TIE_ROD, TIE_SPIN } TieKind;

typedef struct Tie {
    Spot tail, tip;
    TieKind kind;
    double length, force; /* of a rod: on its tip, away from the tail */
} Tie;

typedef struct Strut { /* a spring and a damper along a line */
    Spot tail, tip;
    double k, d, length;
} Strut;

typedef struct FreeBody {
    double mass, inertia[3];
    double q[4];
    V c, v, w;
    V push; /* a force on its centre */
} FreeBody;

typedef struct FreeBodies {
    int count, bushes, ties, struts;
    FreeBody body[MOST_BODIES];
    Bush bush[MOST_TIES];
    Tie tie[MOST_TIES];
    Strut strut[MOST_TIES];
    V gravity;
} FreeBodies;

typedef struct SpotMotion {
    V r, way, v, w; /* place, from the centre of its body, velocity, angular velocity */
    M turn;
} SpotMotion;

static V zero_vector(void)
{
    return (V){{0}};
}

static M product(const M *a, const M *b)
{
    M out = {{{0}}};

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                out.at[i][j] += a->at[i][k] * b->at[k][j];
    return out;
}

static SpotMotion spot_motion(const FreeBodies *s, const Spot *spot)
{
    const M own = turned(spot->turn);
    SpotMotion m = {.r = spot->at, .turn = own};

    if (spot->body == GROUND)
        return m;
    const FreeBody *body = &s->body[spot->body];
    const M turn = matrix_of(body->q);

    m.way = apply(&turn, spot->at);
    m.r = plus(body->c, 1, m.way);
    m.v = plus(body->v, 1, cross(body->w, m.way));
    m.w = body->w;
    m.turn = product(&turn, &own);
    return m;
}

/* generalised forces: of each body a force on its centre and a moment about it */
static void push_at(const Spot *spot, V way, V force, V moment, double *f)
{
    const V about = plus(moment, 1, cross(way, force));

    for (int i = 0; i < 3 && spot->body != GROUND; i++) {
        f[6 * spot->body + i] += force.at[i];
        f[6 * spot->body + 3 + i] += about.at[i];
    }
}

static void rotation_vector(const M *turn, double p[3], double *angle)
{
    const double c = (turn->at[0][0] + turn->at[1][1] + turn->at[2][2] - 1) / 2;
    const double s[3] = {(turn->at[2][1] - turn->at[1][2]) / 2,
                         (turn->at[0][2] - turn->at[2][0]) / 2,
                         (turn->at[1][0] - turn->at[0][1]) / 2};
    const double size = sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);

    *angle = atan2(size, c);
    for (int i = 0; i < 3; i++)
        p[i] = size > 0 ? *angle * s[i] / size : 0;
}

/* B, with its series at 0 */
static M vector_rate(const double p[3], double angle)
{
    const double a2 = angle * angle;
    const double g = angle > 0.05 ? 1 / a2 - (1 + cos(angle)) / (2 * angle * sin(angle))
                                  : 1.0 / 12 + a2 / 720 + a2 * a2 / 30240;
    const M cross_p = {{{0, -p[2], p[1]}, {p[2], 0, -p[0]}, {-p[1], p[0], 0}}};
    const M square = product(&cross_p, &cross_p);
    M out;

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out.at[i][j] = (i == j) - cross_p.at[i][j] / 2 + g * square.at[i][j];
    return out;
}

/* adds its load to f, and returns what it stores; *largest: of the angles so far */
static double bush_push(const FreeBodies *s, const Bush *bush, double *f, double *largest)
{
    const SpotMotion tail = spot_motion(s, &bush->tail), tip = spot_motion(s, &bush->tip);
    const V apart = plus(tip.r, -1, tail.r), w = plus(tip.w, -1, tail.w);
    const V v = plus(plus(tip.v, -1, tail.v), -1, cross(tail.w, apart));
    const V x = apply_back(&tail.turn, apart), x_rate = apply_back(&tail.turn, v);
    double p[3], angle, effort[6], stored = 0;
    M relative, B;
    V turn_rate, moment, force;

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            relative.at[i][j] = 0;
            for (int k = 0; k < 3; k++)
                relative.at[i][j] += tail.turn.at[k][i] * tip.turn.at[k][j];
        }
    rotation_vector(&relative, p, &angle);
    *largest = fmax(*largest, angle);
    B = vector_rate(p, angle);
    turn_rate = apply(&B, apply_back(&tail.turn, w));
    for (int i = 0; i < 6; i++) {
        effort[i] = 0;
        for (int j = 0; j < 6; j++) {
            const double at = j < 3 ? x.at[j] : p[j - 3];
            const double rate = j < 3 ? x_rate.at[j] : turn_rate.at[j - 3];

            effort[i] -= bush->k[i][j] * at + bush->d[i][j] * rate;
            stored += bush->k[i][j] * at * (i < 3 ? x.at[i] : p[i - 3]) / 2;
        }
    }
    force = apply(&tail.turn, (V){{effort[0], effort[1], effort[2]}});
    moment = apply(&tail.turn, apply_back(&B, (V){{effort[3], effort[4], effort[5]}}));
    push_at(&bush->tip, tip.way, force, moment, f);
    push_at(&bush->tail, plus(tail.way, 1, apart), plus(zero_vector(), -1, force),
            plus(zero_vector(), -1, moment), f);
    return stored;
}

static double strut_push(const FreeBodies *s, const Strut *strut, double *f)
{
    const SpotMotion tail = spot_motion(s, &strut->tail), tip = spot_motion(s, &strut->tip);
    const V apart = plus(tip.r, -1, tail.r), v = plus(tip.v, -1, tail.v);
    const double length = sqrt(dot(apart, apart)), rate = dot(apart, v) / length;
    const double pull = strut->k * (length - strut->length) + strut->d * rate;

    push_at(&strut->tip, tip.way, plus(zero_vector(), -pull / length, apart), zero_vector(), f);
    push_at(&strut->tail, tail.way, plus(zero_vector(), pull / length, apart), zero_vector(), f);
    return strut->k * (length - strut->length) * (length - strut->length) / 2;
}

/* what accelerations in the columns of its body add to n . (acceleration of the spot) */
static void spot_row(const Spot *spot, V way, V n, double sign, double *row)
{
    const V about = cross(way, n);

    for (int i = 0; i < 3 && spot->body != GROUND; i++) {
        row[6 * spot->body + i] += sign * n.at[i];
        row[6 * spot->body + 3 + i] += sign * about.at[i];
    }
}

/* what angular accelerations add to n . (that of the spot) */
static void turn_row(const Spot *spot, V n, double sign, double *row)
{
    for (int i = 0; i < 3 && spot->body != GROUND; i++)
        row[6 * spot->body + 3 + i] += sign * n.at[i];
}

static int tie_count(const Tie *tie)
{
    return tie->kind == TIE_BALL ? 3 : 1;
}

/* rows of a tie on accelerations, and their right-hand sides */
static void tie_rows(const FreeBodies *s, const Tie *tie, double row[3][MOST_SIZE], double right[3])
{
    const SpotMotion tail = spot_motion(s, &tie->tail), tip = spot_motion(s, &tie->tip);
    const V apart = plus(tip.r, -1, tail.r), v = plus(tip.v, -1, tail.v);
    const V rest =
        plus(cross(tip.w, cross(tip.w, tip.way)), -1, cross(tail.w, cross(tail.w, tail.way)));
    const V z = {{0, 0, 1}}, far = apply(&tip.turn, z), near = apply(&tail.turn, z);
    const V w = plus(tip.w, -1, tail.w), bisector = plus(far, 1, near);

    for (int k = 0; k < tie_count(tie); k++) {
        V n = {{k == 0, k == 1, k == 2}};

        memset(row[k], 0, sizeof row[k]);
        if (tie->kind == TIE_SPIN) {
            turn_row(&tie->tip, bisector, 1, row[k]);
            turn_row(&tie->tail, bisector, -1, row[k]);
            right[k] = -dot(w, plus(cross(tip.w, far), 1, cross(tail.w, near)));
            continue;
        }
        if (tie->kind == TIE_ROD)
            n = plus(zero_vector(), 1 / tie->length, apart);
        spot_row(&tie->tip, tip.way, n, 1, row[k]);
        spot_row(&tie->tail, tail.way, n, -1, row[k]);
        right[k] = -dot(n, rest) - (tie->kind == TIE_ROD ? dot(v, v) / tie->length : 0);
    }
}

/* a x = b by elimination with pivots; x over b */
static void eliminate(double a[MOST_SIZE][MOST_SIZE], double *b, int size)
{
    for (int p = 0; p < size; p++) {
        int best = p;

        for (int i = p + 1; i < size; i++)
            if (fabs(a[i][p]) > fabs(a[best][p]))
                best = i;
        for (int j = 0; j < size; j++) {
            const double moved = a[p][j];

            a[p][j] = a[best][j];
            a[best][j] = moved;
        }
        const double moved = b[p];

        b[p] = b[best];
        b[best] = moved;
        for (int i = p + 1; i < size; i++) {
            const double factor = a[i][p] / a[p][p];

            for (int j = p; j < size; j++)
                a[i][j] -= factor * a[p][j];
            b[i] -= factor * b[p];
        }
    }
    for (int i = size - 1; i >= 0; i--) {
        for (int j = i + 1; j < size; j++)
            b[i] -= a[i][j] * b[j];
        b[i] /= a[i][i];
    }
}

/* Accelerations (6 a body) and the forces of rods; returns the energy. *largest: the largest angle
 * of a bushing. */
static double free_rates(FreeBodies *s, double *rate, double *largest)
{
    static double a[MOST_SIZE][MOST_SIZE];
    double b[MOST_SIZE] = {0}, energy = 0;
    int size = 6 * s->count;

    *largest = 0;
    memset(a, 0, sizeof a);
    for (int i = 0; i < s->bushes; i++)
        energy += bush_push(s, &s->bush[i], b, largest);
    for (int i = 0; i < s->struts; i++)
        energy += strut_push(s, &s->strut[i], b);
    for (int i = 0; i < s->count; i++) {
        const FreeBody *body = &s->body[i];
        const M turn = matrix_of(body->q);
        const V own = apply_back(&turn, body->w);
        const V momentum =
            apply(&turn, (V){{body->inertia[0] * own.at[0], body->inertia[1] * own.at[1],
                              body->inertia[2] * own.at[2]}});
        const V gyro = cross(body->w, momentum);

        energy += (body->mass * dot(body->v, body->v) + dot(body->w, momentum)) / 2 -
                  body->mass * dot(s->gravity, body->c);
        for (int k = 0; k < 3; k++) {
            a[6 * i + k][6 * i + k] = body->mass;
            b[6 * i + k] += body->mass * s->gravity.at[k] + body->push.at[k];
            b[6 * i + 3 + k] -= gyro.at[k];
            for (int j = 0; j < 3; j++)
                for (int l = 0; l < 3; l++)
                    a[6 * i + 3 + k][6 * i + 3 + j] +=
                        turn.at[k][l] * body->inertia[l] * turn.at[j][l];
        }
    }
    for (int i = 0; i < s->ties; i++) {
        double row[3][MOST_SIZE], right[3];

        tie_rows(s, &s->tie[i], row, right);
        for (int k = 0; k < tie_count(&s->tie[i]); k++, size++) {
            for (int j = 0; j < 6 * s->count; j++)
                a[size][j] = a[j][size] = row[k][j];
            b[size] = right[k];
        }
    }
    eliminate(a, b, size);
    memcpy(rate, b, (size_t)(6 * s->count) * sizeof *rate);
    for (int i = 0, at = 6 * s->count; i < s->ties; i++) {
        s->tie[i].force = -b[at];
        at += tie_count(&s->tie[i]);
    }
    return energy;
}

/* the state after a time at these rates: a second state gives velocities, `rate` accelerations */
static void free_move(FreeBodies *s, const FreeBodies *at, const double *rate, double time)
{
    for (int i = 0; i < s->count; i++) {
        FreeBody *body = &s->body[i];
        const FreeBody *from = &at->body[i];
        const double *q = from->q;
        const V w = from->w;
        const double q_rate[4] = {-q[1] * w.at[0] - q[2] * w.at[1] - q[3] * w.at[2],
                                  q[0] * w.at[0] + q[3] * w.at[1] - q[2] * w.at[2],
                                  q[0] * w.at[1] - q[3] * w.at[0] + q[1] * w.at[2],
                                  q[0] * w.at[2] + q[2] * w.at[0] - q[1] * w.at[1]};

        for (int k = 0; k < 4; k++)
            body->q[k] += time / 2 * q_rate[k];
        body->c = plus(body->c, time, from->v);
        body->v = plus(body->v, time, (V){{rate[6 * i], rate[6 * i + 1], rate[6 * i + 2]}});
        body->w = plus(body->w, time, (V){{rate[6 * i + 3], rate[6 * i + 4], rate[6 * i + 5]}});
    }
}

/* fixed steps of Runge and Kutta; returns the energy, and the largest angle of a bushing on the way
 */
static double free_run(FreeBodies *s, double time, int steps, double *largest)
{
    const double h = time / steps, part[4] = {0, h / 2, h / 2, h},
                 weight[4] = {h / 6, h / 3, h / 3, h / 6};
    double rate[6 * MOST_BODIES], angle, energy;

    *largest = 0;
    for (int i = 0; i < steps; i++) {
        const FreeBodies start = *s;
        FreeBodies before = start;

        for (int k = 0; k < 4; k++) {
            FreeBodies trial = start;

            if (k > 0)
                free_move(&trial, &before, rate, part[k]);
            (void)free_rates(&trial, rate, &angle);
            *largest = fmax(*largest, angle);
            free_move(s, &trial, rate, weight[k]);
            before = trial;
        }
        for (int b = 0; b < s->count; b++) {
            double norm = 0;

            for (int k = 0; k < 4; k++)
                norm += s->body[b].q[k] * s->body[b].q[k];
            for (int k = 0; k < 4; k++)
                s->body[b].q[k] /= sqrt(norm);
        }
    }
    energy = free_rates(s, rate, &angle);
    return energy;
}

#endif
