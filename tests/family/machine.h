/* machine.h: machines of bodies, joints, forces and networks, in coordinates of each body of its
 * own
 *
 * An oracle that knows no trees, circuits or cutsets: a body has a place, an attitude and a twist,
 * a joint is rows with multipliers, a network is all potentials and currents, and at each instant
 * all of that is one linear system (sparse tableau, Hachtel, Brayton and Gustavson 1971, over the
 * equations of Newton and Euler). Coordinates of joints are integrals of their rates. */
#ifndef COTREE_TESTS_MACHINE_H
#define COTREE_TESTS_MACHINE_H

#include "extrapolated.h"

#include <stdbool.h>
#include <string.h>

enum {
    BODIES = 5,
    PLACES = 40,
    HINGES = 8,
    TURNS = 12,
    LOADS = 28,
    NODES = 20,
    ELEMENTS = 30,
    UNKNOWNS = 6 * BODIES + 5 * HINGES + NODES + 3 * ELEMENTS,
    STATES = 13 * BODIES + TURNS + 2 * ELEMENTS,
};

typedef struct Vector {
    double at[3];
} Vector;

typedef struct Turn { /* a rotation: columns are the axes of what is turned */
    double at[3][3];
} Turn;

/* low + size sin(pace t + phase) */
typedef struct Wave {
    double low, size, pace, phase;
} Wave;

/* a frame on a body, -1: ground */
typedef struct Place {
    int body;
    Vector r;
    Turn R;
    char name[16];
} Place;

typedef enum HingeKind {
    REVOLUTE,
    PRISMATIC,
    CYLINDRICAL,
    UNIVERSAL,
    SPHERICAL,
    SCREW,
    PLANE_ON_PLANE,
    WELD,
    HINGE_KINDS
} HingeKind;

typedef struct Hinge {
    HingeKind kind;
    int tail, tip;  /* places */
    Vector axis[3]; /* across each other, in axes of the tail; of a universal the second in the
                       tip's */
    double pitch;
    int coordinate, coordinates; /* the first of its coordinates, how many are followed */
    char name[16];
} Hinge;

/* a coordinate of a joint: a shift or a turn along an axis of it */
typedef struct Coordinate {
    int hinge, axis;
    bool shift;
    char name[24];
} Coordinate;

typedef enum LoadKind { PUSH, TWIST, LINE, ALONG } LoadKind;
typedef struct Load {
    LoadKind kind;
    int place, other; /* LINE: from that to this; ALONG: a coordinate */
    Wave wave[3];     /* of a push or a twist; of the others the first */
    bool own_axes;
    double k, rest, d, drag; /* drag: against the velocity, of a push in ground axes */
    char name[16];
} Load;

typedef enum ElementKind {
    RESISTANCE,
    CAPACITY,      /* value = C */
    INERTANCE,     /* value = L */
    ACROSS,        /* a source of its wave */
    THROUGH,       /* likewise; plus to minus inside */
    MOTOR,         /* R, L, K = Kt, Kv, J, B, ratio */
    COIL,          /* v = R i + L i' + K s', force K i */
    PLATE,         /* C = value (1 + bend sin(pace s)) */
    SOLENOID,      /* L likewise */
    PIEZO,         /* value = C, d, k, rest */
    PISTON,        /* through = K s', force K across */
    SPRING_DAMPER, /* through = k z + d across, z' = across */
    PD,
    PID,
    LAG,       /* of a coordinate */
    AMPLIFIER, /* across = K times the potential of node c */
    WINDINGS,  /* v1 = K v2, i2 = -K i1 */
    GYRATOR,
    WHEEL_ON_END, /* through = J s'' */
    HELD,         /* across = value, which a sampled block sets */
    SWITCH,       /* of resistance low when on, high when not; 0: ideal */
    DIODE,        /* likewise, from the voltage rest on; on its line through it */
} ElementKind;

typedef struct Element {
    ElementKind kind;
    int p, m, c, e; /* nodes; 0 is the datum; c, e: the second pair */
    double value, R, L, K, Kv, J, B, ratio, bend, pace, k, d, rest, Kp, Ki, Kd, T, low, high;
    Wave wave;
    int coordinate;
    int state,
        more; /* in the network's states; -1: none. One that shares a state isn't its first */
    bool first, limited, on;
    char name[16];
} Element;

typedef struct Machine {
    bool planar;
    Vector gravity;
    int bodies, places, hinges, coordinates, loads, nodes, elements, states;
    double mass[BODIES], inertia[BODIES][6]; /* xx yy zz xy xz yz */
    Place place[PLACES];
    Hinge hinge[HINGES];
    Coordinate coordinate[TURNS];
    Load load[LOADS];
    Element element[ELEMENTS];
    char node[NODES][16];
    int node_domain[NODES];
} Machine;

/* where things are at an instant */
typedef struct Instant {
    double t;
    Vector p[BODIES], v[BODIES], w[BODIES];
    Turn R[BODIES];
    double q[TURNS], rate[TURNS], z[2 * ELEMENTS];
    /* what the equations give */
    Vector a[BODIES], alpha[BODIES];
    double second[TURNS], dz[2 * ELEMENTS], potential[NODES], current[ELEMENTS], other[ELEMENTS];
    Vector force[HINGES], moment[HINGES]; /* on the tip, in its origin */
    double load[LOADS], acting[ELEMENTS]; /* forces along lines, forces of transducers */
} Instant;

/* --- vectors --- */

static inline Vector vec(double x, double y, double z)
{
    return (Vector){{x, y, z}};
}

static inline double dot(Vector a, Vector b)
{
    return a.at[0] * b.at[0] + a.at[1] * b.at[1] + a.at[2] * b.at[2];
}

static inline Vector cross(Vector a, Vector b)
{
    return vec(a.at[1] * b.at[2] - a.at[2] * b.at[1], a.at[2] * b.at[0] - a.at[0] * b.at[2],
               a.at[0] * b.at[1] - a.at[1] * b.at[0]);
}

/* a + s b */
static inline Vector add(Vector a, double s, Vector b)
{
    return vec(a.at[0] + s * b.at[0], a.at[1] + s * b.at[1], a.at[2] + s * b.at[2]);
}

static inline Vector turn(const Turn *R, Vector a)
{
    Vector out;

    for (int i = 0; i < 3; i++)
        out.at[i] = R->at[i][0] * a.at[0] + R->at[i][1] * a.at[1] + R->at[i][2] * a.at[2];
    return out;
}

static inline Vector turn_back(const Turn *R, Vector a)
{
    Vector out;

    for (int i = 0; i < 3; i++)
        out.at[i] = R->at[0][i] * a.at[0] + R->at[1][i] * a.at[1] + R->at[2][i] * a.at[2];
    return out;
}

static inline Turn turns(const Turn *A, const Turn *B)
{
    Turn out;

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            out.at[i][k] =
                A->at[i][0] * B->at[0][k] + A->at[i][1] * B->at[1][k] + A->at[i][2] * B->at[2][k];
    return out;
}

static inline Turn transposed(const Turn *A)
{
    Turn out;

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            out.at[i][k] = A->at[k][i];
    return out;
}

/* about a unit vector (Rodrigues) */
static inline Turn turn_about(Vector u, double angle)
{
    const double c = cos(angle), s = sin(angle);
    Turn out;

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            out.at[i][k] = (1 - c) * u.at[i] * u.at[k] + (i == k ? c : 0);
    out.at[0][1] -= s * u.at[2];
    out.at[1][0] += s * u.at[2];
    out.at[0][2] += s * u.at[1];
    out.at[2][0] -= s * u.at[1];
    out.at[1][2] -= s * u.at[0];
    out.at[2][1] += s * u.at[0];
    return out;
}

static inline double wave(const Wave *w, double t)
{
    return w->low + w->size * sin(w->pace * t + w->phase);
}

static inline double wave_rate(const Wave *w, double t)
{
    return w->size * w->pace * cos(w->pace * t + w->phase);
}

/* --- frames --- */

typedef struct Stand { /* of a place, in ground axes */
    Vector p, rho, v, w;
    Turn R;
    int body;
} Stand;

static inline Stand stand(const Machine *m, const Instant *now, int place)
{
    const Place *f = &m->place[place];
    Stand out = {.p = f->r, .R = f->R, .body = f->body};

    if (f->body >= 0) {
        out.rho = turn(&now->R[f->body], f->r);
        out.p = add(now->p[f->body], 1, out.rho);
        out.w = now->w[f->body];
        out.v = add(now->v[f->body], 1, cross(out.w, out.rho));
        out.R = turns(&now->R[f->body], &f->R);
    }
    return out;
}

/* A row over the twists of two bodies: its rate is `rate`, and its second derivative what the
 * accelerations make of it plus `bias`. What acts along it acts on both by the same numbers. */
typedef struct Row {
    int body[2];
    Vector linear[2], angular[2];
    double rate, bias;
} Row;

/* along n, which goes by `n_rate`, of the tip's way in the tail */
static inline Row way_row(const Stand *t, const Stand *h, Vector n, Vector n_rate)
{
    const Vector d = add(h->p, -1, t->p), dv = add(h->v, -1, t->v);
    const Vector relative = add(dv, -1, cross(t->w, d));
    Row row = {.body = {t->body, h->body}};

    row.linear[1] = n;
    row.angular[1] = cross(h->rho, n);
    row.linear[0] = vec(-n.at[0], -n.at[1], -n.at[2]);
    row.angular[0] = add(add(vec(0, 0, 0), -1, cross(t->rho, n)), -1, cross(d, n));
    row.rate = dot(n, relative);
    row.bias = dot(n, cross(h->w, cross(h->w, h->rho))) - dot(n, cross(t->w, cross(t->w, t->rho))) -
               dot(n, cross(t->w, dv)) + dot(n_rate, relative);
    return row;
}

/* along n of the tip's turning against the tail */
static inline Row turn_row(const Stand *t, const Stand *h, Vector n, Vector n_rate)
{
    const Vector w = add(h->w, -1, t->w);
    Row row = {.body = {t->body, h->body}};

    row.angular[1] = n;
    row.angular[0] = vec(-n.at[0], -n.at[1], -n.at[2]);
    row.rate = dot(n, w);
    row.bias = dot(n_rate, w);
    return row;
}

static inline Row coordinate_row(const Machine *m, const Instant *now, int number)
{
    const Coordinate *c = &m->coordinate[number];
    const Hinge *j = &m->hinge[c->hinge];
    const Stand t = stand(m, now, j->tail), h = stand(m, now, j->tip);
    const bool in_tip = j->kind == UNIVERSAL && c->axis == 1;
    const Vector n = turn(in_tip ? &h.R : &t.R, j->axis[c->axis]);
    const Vector n_rate = cross(in_tip ? h.w : t.w, n);

    return c->shift ? way_row(&t, &h, n, n_rate) : turn_row(&t, &h, n, n_rate);
}

/* the rows that a joint holds; *ways: how many of them, the first, are of ways */
static inline int hinge_rows(const Machine *m, const Instant *now, const Hinge *j, Row *rows,
                             int *ways)
{
    const Stand t = stand(m, now, j->tail), h = stand(m, now, j->tip);
    Vector n[3], rate[3];
    int count = 0;

    for (int k = 0; k < 3; k++) {
        n[k] = turn(&t.R, j->axis[k]);
        rate[k] = cross(t.w, n[k]);
    }
    for (int k = 0; k < 3; k++) {
        bool held = true;

        if (j->kind == PRISMATIC || j->kind == CYLINDRICAL || j->kind == SCREW)
            held = k != 0;
        if (j->kind == PLANE_ON_PLANE)
            held = k == 0;
        if (m->planar && fabs(n[k].at[2]) > 0.5)
            held = false;
        if (held)
            rows[count++] = way_row(&t, &h, n[k], rate[k]);
    }
    if (j->kind == SCREW) {
        const Row turned = turn_row(&t, &h, n[0], rate[0]);
        Row row = way_row(&t, &h, n[0], rate[0]);

        for (int k = 0; k < 2; k++)
            row.angular[k] = add(row.angular[k], -j->pitch / (2 * acos(-1)), turned.angular[k]);
        row.rate -= j->pitch / (2 * acos(-1)) * turned.rate;
        row.bias -= j->pitch / (2 * acos(-1)) * turned.bias;
        rows[count++] = row;
    }
    *ways = count;
    if (j->kind == UNIVERSAL) {
        const Vector u = turn(&h.R, j->axis[1]);

        rows[count++] =
            turn_row(&t, &h, cross(n[0], u), add(cross(rate[0], u), 1, cross(n[0], cross(h.w, u))));
    }
    for (int k = 0; k < 3 && j->kind != UNIVERSAL && j->kind != SPHERICAL; k++) {
        bool held = k != 0 || j->kind == PRISMATIC || j->kind == WELD;

        if (m->planar && fabs(n[k].at[2]) < 0.5)
            held = false;
        if (held)
            rows[count++] = turn_row(&t, &h, n[k], rate[k]);
    }
    return count;
}

#endif
