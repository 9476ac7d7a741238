/* scenes.h: bodies at random that hang on each other by joints of all kinds
 *
 * Frames stand in any attitude; a joint's tail is on either side; loops are closed where the frames
 * stand. The poses of the bodies follow from coordinates drawn at random, by jointed.h. */
#ifndef COTREE_TESTS_SCENES_H
#define COTREE_TESTS_SCENES_H

#include "jointed.h"

#include <stdarg.h>

enum { BODIES = 6, LOOPS = 3, VIRTUALS = 2, JOINTS = BODIES + LOOPS + VIRTUALS, ROOM = 40000 };

/* `tree` counts the operations of equations that have up to so many edges, which takes ten times as
 * long as assembly: members have more, forces of 0 among them. */
enum { UNCOUNTED = 40 };

typedef struct Scene {
    bool planar, parallel; /* all axes one way */
    Kind only;             /* joints of one kind; KINDS: of any */
    bool is_driven;        /* none whose attitude has four parameters, or angles of no chord */
    bool is_chain;
    int bodies, joints; /* these make trees and loops; */
    int all;            /* virtual ones behind them */
    Joint joint[JOINTS];
    Pose body[BODIES];
    char text[ROOM];
    size_t length;
} Scene;

__attribute__((format(printf, 2, 3))) static void write(Scene *s, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    s->length += (size_t)vsnprintf(s->text + s->length, ROOM - s->length, format, arguments);
    va_end(arguments);
}

static inline Pose body_pose(const Scene *s, int body)
{
    return body < 0 ? here : s->body[body];
}

/* --- writing --- */

/* R = Rz Ry Rx. Near y = pi/2 rounding leaves much of the angle about z, but what follows from it
 * makes up for that. */
static inline void three_angles(Pose p, double angles[3])
{
    static const double z[3] = {0, 0, 1};
    const double *q = p.q;
    Pose rest;

    angles[0] = atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
    rest = compose(turned(z, -angles[0]), p);
    q = rest.q;
    angles[1] = atan2(2 * (q[0] * q[2] - q[1] * q[3]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
    angles[2] = atan2(2 * (q[0] * q[1] - q[2] * q[3]), 1 - 2 * (q[1] * q[1] + q[3] * q[3]));
}

/* an arm of that pose */
static inline void write_arm(Scene *s, const char *name, const char *from, const Pose *p)
{
    double angles[3];

    if (s->planar) {
        write(s, "arm %s %s [%.17g, %.17g] rotation=z(%.17g)\n", name, from, p->r[0], p->r[1],
              2 * atan2(p->q[3], p->q[0]));
        return;
    }
    three_angles(*p, angles);
    write(s, "arm %s %s [%.17g, %.17g, %.17g] rotation=z(%.17g)*y(%.17g)*x(%.17g)\n", name, from,
          p->r[0], p->r[1], p->r[2], angles[0], angles[1], angles[2]);
}

static inline bool is_here(const Pose *pose)
{
    bool same = true;

    for (int i = 0; i < 3; i++)
        same = same && pose->r[i] == here.r[i];
    for (int i = 0; i < 4; i++)
        same = same && pose->q[i] == here.q[i];
    return same;
}

/* the name of a joint's frame, an arm's or that of the body itself */
static inline void write_frame(Scene *s, int number, bool tail, char out[16])
{
    const Joint *j = &s->joint[number];
    const int body = tail ? j->tail_body : j->head_body;
    const Pose *frame = tail ? &j->tail : &j->head;
    char name[16];

    snprintf(name, sizeof name, body < 0 ? "ground" : "b%d", body);
    if (is_here(frame)) {
        strcpy(out, name);
        return;
    }
    snprintf(out, 16, "%c%d", tail ? 't' : 'h', number);
    write_arm(s, out, name, frame);
}

static inline void write_joint(Scene *s, int number)
{
    const Joint *j = &s->joint[number];
    char tail[16], head[16];

    write_frame(s, number, true, tail);
    write_frame(s, number, false, head);
    write(s, "%s%s j%d %s %s", j->is_virtual ? "virtual " : "", kind_words[j->kind], number, tail,
          head);
    if (j->kind == REVOLUTE || j->kind == PRISMATIC || j->kind == CYLINDRICAL || j->kind == SCREW)
        write(s, " axis=%s", j->axis[0]);
    if (j->kind == SCREW)
        write(s, " pitch=%.17g", j->pitch);
    if (j->kind == UNIVERSAL)
        write(s, " axes=[%s, %s]", j->axis[0], j->axis[1]);
    if (j->kind == PLANARJOINT)
        write(s, " normal=%s", j->axis[0]);
    if (j->kind == SPHERICAL_ANGLES)
        write(s, " euler=%s", j->sequence);
    write(s, "\n");
}

/* --- scenes --- */

static inline Pose random_frame(Member *m, const Scene *s)
{
    static const double z[3] = {0, 0, 1};
    Pose p = here;

    if (pick(m, 6) == 0)
        return p;
    for (int i = 0; i < (s->planar ? 2 : 3); i++)
        p.r[i] = between(m, -0.6, 0.6);
    if (s->planar || s->parallel)
        multiply(p.q, turned(z, pick(m, 2) ? between(m, -3, 3) : 0).q, p.q);
    else
        random_attitude(m, p.q);
    return p;
}

static inline Kind random_kind(Member *m, const Scene *s)
{
    static const Kind driven[] = {REVOLUTE, PRISMATIC, WELD,       CYLINDRICAL,
                                  SCREW,    UNIVERSAL, PLANARJOINT};
    static const Kind parallel[] = {REVOLUTE, REVOLUTE, PRISMATIC, CYLINDRICAL, WELD, SCREW};

    if (s->only != KINDS)
        return s->only;
    return s->planar      ? (Kind)pick(m, PLANE_KINDS)
           : s->parallel  ? parallel[pick(m, (int)(sizeof parallel / sizeof parallel[0]))]
           : s->is_driven ? driven[pick(m, (int)(sizeof driven / sizeof driven[0]))]
                          : (Kind)pick(m, KINDS);
}

static inline void write_bodies(Member *m, Scene *s)
{
    static const char *const euler[] = {"", "", " euler=zyx", " euler=xyz"};

    if (s->planar)
        write(s, "scene planar\n");
    for (int i = 0; i < s->bodies; i++)
        if (s->planar)
            write(s, "body b%d mass=%.3g inertia=1\n", i, between(m, 1, 3));
        else
            write(s, "body b%d mass=%.3g inertia=[1, 2, 2.5]%s\n", i, between(m, 1, 3),
                  euler[pick(m, 4)]);
    for (int i = 0; i < UNCOUNTED; i++)
        write(s, "force F%d b0 [0, 0%s]\n", i, s->planar ? "" : ", 0");
}

/* A new body's joint, or one that closes a loop, its tail on either side. */
static inline void hang(Member *m, Scene *s, int number)
{
    Joint *j = &s->joint[number];
    const bool closes = number >= s->bodies;
    const int body = closes ? pick(m, s->bodies) : number;
    int other;
    Pose way;

    j->kind = random_kind(m, s);
    j->in_plane = s->planar;
    do
        other = s->is_chain ? body - 1 : pick(m, (closes ? s->bodies : number) + 1) - 1;
    while (other == body);
    j->tail = random_frame(m, s);
    j->head = random_frame(m, s);
    draw_joint(m, s->planar || s->parallel, j);
    way = joint_pose(j, j->c);
    if (pick(m, 2) == 0) { /* tail on the other */
        j->tail_body = other;
        j->head_body = body;
    } else {
        j->tail_body = body;
        j->head_body = other;
    }
    if (closes)
        j->head = compose(inverse(body_pose(s, j->head_body)),
                          compose(compose(body_pose(s, j->tail_body), j->tail), way));
    else if (j->head_body == body)
        s->body[body] =
            compose(compose(compose(body_pose(s, other), j->tail), way), inverse(j->head));
    else
        s->body[body] =
            compose(compose(compose(body_pose(s, other), j->head), inverse(way)), inverse(j->tail));
}

/* A virtual joint that its frames' motion never leaves: its coordinates are where they stand. */
static inline void look(Member *m, Scene *s, int number)
{
    Joint *j = &s->joint[number];
    Pose way;

    j->is_virtual = true;
    j->in_plane = s->planar;
    j->kind = s->planar || s->parallel ? (pick(m, 2)  ? REVOLUTE
                                          : s->planar ? FREE
                                                      : SPHERICAL)
                                       : (pick(m, 2) ? FREE : SPHERICAL);
    j->head_body = pick(m, s->bodies);
    do
        j->tail_body = pick(m, s->bodies + 1) - 1;
    while (j->tail_body == j->head_body);
    j->tail = random_frame(m, s);
    j->head = random_frame(m, s);
    draw_joint(m, s->planar || s->parallel, j);
    way = compose(inverse(compose(body_pose(s, j->tail_body), j->tail)),
                  compose(body_pose(s, j->head_body), j->head));
    for (int k = 0; k < j->count; k++)
        if (is_angle(j, k))
            j->c[k] = 2 * atan2(way.q[3], way.q[0]) * (j->kind == REVOLUTE ? j->u[2] : 1);
        else
            j->c[k] = is_parameter(j, k) ? way.q[k - first_parameter(j)] : way.r[k];
}

typedef enum Extent { TREES = 0, WITH_LOOPS = 1, WITH_VIRTUALS = 2, DRIVEN = 4 } Extent;

static inline void make_scene(Member *m, Scene *s, int extent)
{
    memset(s, 0, sizeof *s);
    s->only = KINDS;
    s->is_driven = (extent & DRIVEN) != 0;
    s->planar = pick(m, 4) == 0;
    s->bodies = 1 + pick(m, BODIES);
    s->parallel = !s->planar && pick(m, 4) == 0;
    s->joints = s->bodies + ((extent & WITH_LOOPS) != 0 && s->bodies > 1 ? pick(m, LOOPS + 1) : 0);
    s->all =
        s->joints + ((extent & WITH_VIRTUALS) != 0 && pick(m, 3) == 0 ? pick(m, VIRTUALS + 1) : 0);
    for (int i = 0; i < s->all; i++)
        if (i < s->joints)
            hang(m, s, i);
        else
            look(m, s, i);
    write_bodies(m, s);
    for (int i = 0; i < s->all; i++)
        write_joint(s, i);
}

/* a chain of joints of one kind */
static inline void make_chain(Member *m, Scene *s, Kind kind, int count)
{
    memset(s, 0, sizeof *s);
    s->only = kind;
    s->is_chain = true;
    s->bodies = s->joints = s->all = count;
    for (int i = 0; i < count; i++)
        hang(m, s, i);
    write_bodies(m, s);
    for (int i = 0; i < count; i++)
        write_joint(s, i);
}

/* All axes one way, and one more joint whose tip is turned by half a turn across them: it can be
 * closed with its axis reversed alone. */
static inline void make_reversed(Member *m, Scene *s)
{
    static const Kind kinds[] = {REVOLUTE, CYLINDRICAL, PRISMATIC, WELD};
    static const double x[3] = {1, 0, 0};
    Joint *j;

    memset(s, 0, sizeof *s);
    s->only = KINDS;
    s->parallel = true;
    s->bodies = 2 + pick(m, BODIES - 1);
    s->joints = s->all = s->bodies + 1;
    for (int i = 0; i < s->bodies; i++)
        hang(m, s, i);
    s->only = kinds[pick(m, 4)];
    hang(m, s, s->bodies);
    j = &s->joint[s->bodies];
    j->head = compose(j->head, turned(x, M_PI));
    write_bodies(m, s);
    for (int i = 0; i < s->joints; i++)
        write_joint(s, i);
}

/* --- trees --- */

typedef struct Edge {
    char name[16];
    int ends[2]; /* bodies, ground last */
    int halves;  /* bit of translation, of rotation */
    bool is_screw;
    uint64_t order;
} Edge;

static inline int by_order(const void *a, const void *b)
{
    const Edge *left = a, *right = b;

    if (left->is_screw != right->is_screw)
        return left->is_screw ? -1 : 1;
    return (left->order > right->order) - (left->order < right->order);
}

static inline int list_edges(Member *m, const Scene *s, Edge *edges)
{
    int count = 0;

    for (int i = 0; i < s->bodies; i++, count++)
        edges[count] = (Edge){.ends = {i, s->bodies}, .halves = 3};
    for (int i = 0; i < s->all; i++, count++) {
        const Joint *j = &s->joint[i];

        edges[count] = (Edge){.ends = {j->tail_body < 0 ? s->bodies : j->tail_body,
                                       j->head_body < 0 ? s->bodies : j->head_body},
                              .halves = tells_place(j) ? 3 : 2,
                              .is_screw = j->kind == SCREW,
                              .order = test_random(&m->random)};
    }
    for (int i = 0; i < count; i++)
        snprintf(edges[i].name, sizeof edges[i].name, i < s->bodies ? "b%d" : "j%d",
                 i < s->bodies ? i : i - s->bodies);
    return count;
}

static inline void write_random_trees(Member *m, const Scene *s, Scene *out)
{
    Edge edges[BODIES + JOINTS];
    const int count = list_edges(m, s, edges);

    for (int half = 0; half < 2; half++) {
        int root[BODIES + 1];

        /* screws first, in one order: branches of both or of none */
        for (int i = 0; i < count; i++)
            if (!edges[i].is_screw)
                edges[i].order = test_random(&m->random);
        qsort(edges, (size_t)count, sizeof edges[0], by_order);
        for (int i = 0; i <= s->bodies; i++)
            root[i] = i;
        write(out, "tree %s", half == 0 ? "translation" : "rotation");
        for (int i = 0; i < count; i++) {
            const int a = root[edges[i].ends[0]], b = root[edges[i].ends[1]];

            if (a == b || (edges[i].halves & 1 << half) == 0)
                continue;
            for (int k = 0; k <= s->bodies; k++)
                root[k] = root[k] == a ? b : root[k];
            write(out, " %s", edges[i].name);
        }
        write(out, "\n");
    }
}

/* 0: of joints, 1: of bodies, else at random */
static inline void write_trees(Member *m, const Scene *s, int choice, Scene *out)
{
    if (choice < 2)
        write(out, choice == 0 ? "tree joint\n" : "tree absolute\n");
    else
        write_random_trees(m, s, out);
}

#endif
