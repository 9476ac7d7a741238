/* family_assembly.c: the start is the one described, whatever the trees and however it is told
 *
 * Random bodies hang on each other by joints of all kinds, with frames in any attitude; some loops
 * are closed where the frames stand. The poses are computed here, with quaternions and from
 * coordinates drawn at random; cotree is told of them by joint coordinates, by body coordinates, or
 * by some of each, in trees of all kinds. */
#include "../unit/session_kit.h"
#include "family.h"

#include <math.h>

enum { BODIES = 3, LOOPS = 2, JOINTS = BODIES + LOOPS, ROOM = 24000 };

/* --- quaternions, scalar first --- */

typedef struct Pose {
    double q[4], r[3];
} Pose;

static const Pose here = {{1, 0, 0, 0}, {0, 0, 0}};

static void multiply(const double a[4], const double b[4], double out[4])
{
    const double c[4] = {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                         a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                         a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
                         a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};

    memcpy(out, c, sizeof c);
}

static void carry(const double q[4], const double v[3], double out[3])
{
    const double pure[4] = {0, v[0], v[1], v[2]}, back[4] = {q[0], -q[1], -q[2], -q[3]};
    double t[4];

    multiply(q, pure, t);
    multiply(t, back, t);
    memcpy(out, t + 1, 3 * sizeof(double));
}

static Pose compose(Pose a, Pose b)
{
    Pose c;

    multiply(a.q, b.q, c.q);
    carry(a.q, b.r, c.r);
    for (int i = 0; i < 3; i++)
        c.r[i] += a.r[i];
    return c;
}

static Pose inverse(Pose a)
{
    Pose b = {{a.q[0], -a.q[1], -a.q[2], -a.q[3]}, {0, 0, 0}};

    carry(b.q, a.r, b.r);
    for (int i = 0; i < 3; i++)
        b.r[i] = -b.r[i];
    return b;
}

static Pose turned(const double u[3], double angle)
{
    const double s = sin(angle / 2);

    return (Pose){{cos(angle / 2), s * u[0], s * u[1], s * u[2]}, {0, 0, 0}};
}

static Pose shifted(const double u[3], double by)
{
    return (Pose){{1, 0, 0, 0}, {by * u[0], by * u[1], by * u[2]}};
}

/* --- joints --- */

typedef enum Kind {
    REVOLUTE,
    PRISMATIC,
    WELD,
    FREE,
    CYLINDRICAL,
    SCREW,
    UNIVERSAL,
    SPHERICAL,
    SPHERICAL_ANGLES,
    PLANARJOINT,
    KINDS
} Kind;
enum { PLANE_KINDS = CYLINDRICAL };

typedef struct Coordinate {
    char member[24]; /* ".s", "" for the joint's own name */
    double value;    /* NAN: one of four parameters, told together */
    bool is_angle;
} Coordinate;

typedef struct Joint {
    Kind kind;
    int parent, child; /* bodies; -1: ground */
    Pose tail, head;   /* of its frames in those */
    double u[3], u2[3];
    char axis[3][80], sequence[4]; /* as written */
    double pitch;
    Coordinate c[7];
    int count;
} Joint;

typedef struct Scene {
    bool planar, parallel; /* all axes one way */
    int bodies, joints;
    Joint joint[JOINTS];
    Pose body[BODIES];
    const char *euler[BODIES]; /* "" or " euler=zyx" */
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

static int pick(Member *m, int count)
{
    return (int)(test_random(&m->random) % (uint64_t)count);
}

static double between(Member *m, double low, double high)
{
    return test_uniform(&m->random, low, high);
}

static void random_axis(Member *m, const Scene *s, bool along_frame, double u[3], char *text)
{
    static const char letters[] = "xyz";
    double size;

    memset(u, 0, 3 * sizeof(double));
    if (s->planar || s->parallel || along_frame || pick(m, 2) == 0) {
        const int k = s->planar || s->parallel ? 2 : pick(m, 3);
        const double sign = pick(m, 2) == 0 ? 1 : -1;

        u[k] = sign;
        sprintf(text, "%s%c", sign < 0 ? "-" : "", letters[k]);
        return;
    }
    for (int i = 0; i < 3; i++)
        u[i] = between(m, -1, 1);
    size = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    sprintf(text, "[%.17g, %.17g, %.17g]", u[0], u[1], u[2]);
    for (int i = 0; i < 3; i++)
        u[i] /= size;
}

static void add_coordinate(Joint *j, const char *member, double value, bool is_angle)
{
    snprintf(j->c[j->count].member, sizeof j->c[0].member, "%s", member);
    j->c[j->count].value = value;
    j->c[j->count++].is_angle = is_angle;
}

/* a turn, now and then with whole turns more */
static double random_angle(Member *m)
{
    const double angle = between(m, -3.1, 3.1);

    return pick(m, 4) == 0 ? angle + 2 * M_PI * (pick(m, 5) - 2) : angle;
}

static void random_unit4(Member *m, double q[4])
{
    double size = 0;

    for (int i = 0; i < 4; i++) {
        q[i] = between(m, -1, 1);
        size += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++)
        q[i] /= sqrt(size);
}

static void add_parameters(Joint *j, const double q[4])
{
    for (int i = 0; i < 4; i++) {
        char member[24];

        snprintf(member, sizeof member, ".q%d", i);
        add_coordinate(j, member, q[i], false);
    }
}

/* the next axes of the circle x y z, as planar joints have them */
static void across(const double u[3], double n1[3], double n2[3])
{
    int k = 0;

    while (u[k] == 0)
        k++;
    for (int i = 0; i < 3; i++)
        n1[i] = i == (k + 1) % 3;
    n2[0] = u[1] * n1[2] - u[2] * n1[1];
    n2[1] = u[2] * n1[0] - u[0] * n1[2];
    n2[2] = u[0] * n1[1] - u[1] * n1[0];
}

static Pose three_turns(Member *m, Joint *j)
{
    static const char *const sequences[] = {"xyz", "zyx", "zxz", "yxy", "xzy", "yzx"};
    Pose pose = here;

    strcpy(j->sequence, sequences[pick(m, 6)]);
    for (int i = 0; i < 3; i++) {
        double u[3] = {0};
        char member[24];
        /* the sets of angles are told apart by the sign of the one between */
        const bool returns = j->sequence[0] == j->sequence[2];
        const double angle = i != 1    ? between(m, -1.4, 1.4)
                             : returns ? between(m, 0.2, 1.4)
                                       : between(m, -1.2, 1.2);

        u[j->sequence[i] - 'x'] = 1;
        snprintf(member, sizeof member, ".a%d", i + 1);
        add_coordinate(j, member, angle, true);
        pose = compose(pose, turned(u, angle));
    }
    return pose;
}

/* coordinates at random, and the pose of the head that they make */
static Pose move_in_space(Member *m, Scene *s, Joint *j)
{
    Pose pose = here;
    double n1[3], n2[3];

    switch (j->kind) {
    case CYLINDRICAL:
        add_coordinate(j, ".s", between(m, -1, 1), false);
        add_coordinate(j, ".theta", random_angle(m), true);
        return compose(shifted(j->u, j->c[0].value), turned(j->u, j->c[1].value));
    case SCREW:
        j->pitch = between(m, 0.1, 0.5) * (pick(m, 2) ? 1 : -1);
        add_coordinate(j, "", between(m, -9, 9), false); /* its shift knows all turns */
        return compose(shifted(j->u, j->pitch * j->c[0].value / (2 * M_PI)),
                       turned(j->u, j->c[0].value));
    case UNIVERSAL:
        random_axis(m, s, true, j->u, j->axis[0]);
        do
            random_axis(m, &(Scene){0}, true, j->u2, j->axis[1]);
        while (fabs(j->u[0] * j->u2[0] + j->u[1] * j->u2[1] + j->u[2] * j->u2[2]) > 0.5);
        add_coordinate(j, ".a1", random_angle(m), true);
        add_coordinate(j, ".a2", random_angle(m), true);
        return compose(turned(j->u, j->c[0].value), turned(j->u2, j->c[1].value));
    case SPHERICAL:
        random_unit4(m, pose.q);
        add_parameters(j, pose.q);
        return pose;
    case SPHERICAL_ANGLES:
        return three_turns(m, j);
    case PLANARJOINT:
        random_axis(m, s, true, j->u, j->axis[0]);
        across(j->u, n1, n2);
        add_coordinate(j, ".s1", between(m, -1, 1), false);
        add_coordinate(j, ".s2", between(m, -1, 1), false);
        add_coordinate(j, ".theta", random_angle(m), true);
        pose = compose(shifted(n1, j->c[0].value), shifted(n2, j->c[1].value));
        return compose(pose, turned(j->u, j->c[2].value));
    default:
        return pose;
    }
}

static Pose move_free(Member *m, const Scene *s, Joint *j)
{
    static const double z[3] = {0, 0, 1};
    Pose pose = here;

    for (int i = 0; i < (s->planar ? 2 : 3); i++) {
        const char member[] = {'.', (char)('x' + i), '\0'};

        pose.r[i] = between(m, -1, 1);
        add_coordinate(j, member, pose.r[i], false);
    }
    if (s->planar) {
        add_coordinate(j, ".theta", random_angle(m), true);
        return compose(pose, turned(z, j->c[2].value));
    }
    random_unit4(m, pose.q);
    add_parameters(j, pose.q);
    return pose;
}

static Pose move_joint(Member *m, Scene *s, Joint *j)
{
    static const char *const in_plane[] = {"x", "y", "-x"};

    j->count = 0;
    random_axis(m, s, false, j->u, j->axis[0]);
    switch (j->kind) {
    case REVOLUTE:
        add_coordinate(j, "", random_angle(m), true);
        return turned(j->u, j->c[0].value);
    case PRISMATIC:
        if (s->planar) {
            const int k = pick(m, 3);

            strcpy(j->axis[0], in_plane[k]);
            j->u[0] = k == 0 ? 1 : k == 2 ? -1 : 0;
            j->u[1] = k == 1;
            j->u[2] = 0;
        }
        add_coordinate(j, "", between(m, -1, 1), false);
        return shifted(j->u, j->c[0].value);
    case WELD:
        return here;
    case FREE:
        return move_free(m, s, j);
    default:
        return move_in_space(m, s, j);
    }
}

/* --- scenes --- */

/* an arm of that pose: R = Rz Ry Rx */
static void write_arm(Scene *s, const char *name, const char *from, const Pose *p)
{
    const double *q = p->q;

    if (s->planar) {
        write(s, "arm %s %s [%.17g, %.17g] rotation=z(%.17g)\n", name, from, p->r[0], p->r[1],
              2 * atan2(q[3], q[0]));
        return;
    }
    write(s, "arm %s %s [%.17g, %.17g, %.17g] rotation=z(%.17g)*y(%.17g)*x(%.17g)\n", name, from,
          p->r[0], p->r[1], p->r[2],
          atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3])),
          asin(fmax(-1, fmin(1, 2 * (q[0] * q[2] - q[3] * q[1])))),
          atan2(2 * (q[0] * q[1] + q[2] * q[3]), 1 - 2 * (q[1] * q[1] + q[2] * q[2])));
}

static Pose random_frame(Member *m, const Scene *s)
{
    static const double z[3] = {0, 0, 1};
    Pose p = here;

    for (int i = 0; i < (s->planar ? 2 : 3); i++)
        p.r[i] = between(m, -0.6, 0.6);
    if (s->planar || s->parallel)
        multiply(p.q, turned(z, pick(m, 2) ? between(m, -3, 3) : 0).q, p.q);
    else
        random_unit4(m, p.q);
    return p;
}

static const char *body_name(int body, char out[12])
{
    snprintf(out, 12, body < 0 ? "ground" : "b%d", body);
    return out;
}

static void write_joint(Scene *s, int number)
{
    static const char *const names[KINDS] = {"revolute",    "prismatic",  "weld",      "free",
                                             "cylindrical", "screw",      "universal", "spherical",
                                             "spherical",   "planarjoint"};
    const Joint *j = &s->joint[number];
    char tail[24], head[24], name[12];

    snprintf(tail, sizeof tail, "t%d", number);
    snprintf(head, sizeof head, "h%d", number);
    write_arm(s, tail, body_name(j->parent, name), &j->tail);
    write_arm(s, head, body_name(j->child, name), &j->head);
    write(s, "%s j%d %s %s", names[j->kind], number, tail, head);
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

static Pose body_pose(const Scene *s, int body)
{
    return body < 0 ? here : s->body[body];
}

static Kind random_kind(Member *m, const Scene *s)
{
    static const Kind parallel[] = {REVOLUTE, REVOLUTE, PRISMATIC, CYLINDRICAL, WELD, SCREW};

    return s->planar     ? (Kind)pick(m, PLANE_KINDS)
           : s->parallel ? parallel[pick(m, (int)(sizeof parallel / sizeof parallel[0]))]
                         : (Kind)pick(m, KINDS);
}

static void make_scene(Member *m, Scene *s)
{
    static const char *const euler[] = {"", "", " euler=zyx", " euler=xyz"};

    *s = (Scene){.planar = pick(m, 4) == 0, .bodies = 1 + pick(m, BODIES)};
    s->parallel = !s->planar && pick(m, 4) == 0;
    s->joints = s->bodies + (s->bodies > 1 ? pick(m, LOOPS + 1) : 0);
    if (s->planar)
        write(s, "scene planar\n");
    for (int i = 0; i < s->bodies; i++) {
        s->euler[i] = s->planar ? "" : euler[pick(m, 4)];
        write(s, s->planar ? "body b%d mass=1 inertia=1\n" : "body b%d mass=1 inertia=[1, 2, 3%s\n",
              i, "]");
        if (s->euler[i][0] != '\0') {
            s->length--; /* the end of the line */
            write(s, "%s\n", s->euler[i]);
        }
    }
    for (int i = 0; i < s->joints; i++) {
        Joint *j = &s->joint[i];
        const bool closes = i >= s->bodies;
        Pose moved;

        j->kind = random_kind(m, s);
        j->child = closes ? pick(m, s->bodies) : i;
        do
            j->parent = pick(m, (closes ? s->bodies : i) + 1) - 1;
        while (j->parent == j->child);
        j->tail = random_frame(m, s);
        moved = compose(compose(body_pose(s, j->parent), j->tail), move_joint(m, s, j));
        if (closes) {
            j->head = compose(inverse(s->body[j->child]), moved);
        } else {
            j->head = random_frame(m, s);
            s->body[i] = compose(moved, inverse(j->head));
        }
        write_joint(s, i);
    }
}

/* --- trees --- */

typedef struct Edge {
    char name[12];
    int ends[2]; /* bodies, ground last */
    bool is_screw;
    uint64_t order;
} Edge;

static int by_order(const void *a, const void *b)
{
    const Edge *left = a, *right = b;

    if (left->is_screw != right->is_screw)
        return left->is_screw ? -1 : 1;
    return (left->order > right->order) - (left->order < right->order);
}

static void write_random_trees(Member *m, const Scene *s, Scene *out)
{
    Edge edges[BODIES + JOINTS];
    int count = 0;

    for (int i = 0; i < s->bodies; i++, count++)
        edges[count] = (Edge){.ends = {i, s->bodies}};
    for (int i = 0; i < s->joints; i++, count++)
        edges[count] = (Edge){
            .ends = {s->joint[i].parent < 0 ? s->bodies : s->joint[i].parent, s->joint[i].child},
            .is_screw = s->joint[i].kind == SCREW,
            .order = test_random(&m->random)};
    for (int i = 0; i < count; i++)
        snprintf(edges[i].name, sizeof edges[i].name, i < s->bodies ? "b%d" : "j%d",
                 i < s->bodies ? i : i - s->bodies);
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

            if (a == b)
                continue;
            for (int k = 0; k <= s->bodies; k++)
                root[k] = root[k] == a ? b : root[k];
            write(out, " %s", edges[i].name);
        }
        write(out, "\n");
    }
}

/* --- telling and comparing --- */

static void tell_joint(const Scene *s, int number, Scene *out)
{
    const Joint *j = &s->joint[number];

    for (int k = 0; k < j->count; k++)
        write(out, "init j%d%s = %.17g\n", number, j->c[k].member, j->c[k].value);
}

static void tell_body(Member *m, const Scene *s, int body, Scene *out)
{
    const Pose *p = &s->body[body];
    const double sign = pick(m, 2) ? 1 : -1; /* q and -q are one attitude */

    for (int i = 0; i < (s->planar ? 2 : 3); i++)
        write(out, "init b%d.%c = %.17g\n", body, 'x' + i, p->r[i]);
    if (s->planar)
        write(out, "init b%d.theta = %.17g\n", body,
              2 * atan2(p->q[3], p->q[0]) + 2 * M_PI * (pick(m, 3) - 1));
    for (int i = 0; i < 4 && !s->planar; i++)
        write(out, "init b%d.q%d = %.17g\n", body, i, sign * p->q[i]);
}

static double value(Kit *kit, const char *head, int number, const char *member)
{
    char name[40];

    snprintf(name, sizeof name, "%s%d%s", head, number, member);
    return kit_value(kit, name);
}

static double off_body(Kit *kit, const Scene *s, int body)
{
    static const char *const places[] = {".x", ".y", ".z"};
    static const char *const parameters[] = {".q0", ".q1", ".q2", ".q3"};
    const Pose *p = &s->body[body];
    double off = 0, plus = 0, minus = 0;

    for (int i = 0; i < (s->planar ? 2 : 3); i++)
        off = fmax(off, fabs(value(kit, "b", body, places[i]) - p->r[i]));
    if (s->planar)
        return fmax(off,
                    fabs(remainder(value(kit, "b", body, ".theta") - 2 * atan2(p->q[3], p->q[0]),
                                   2 * M_PI)));
    for (int i = 0; i < 4; i++) {
        const double got = value(kit, "b", body, parameters[i]);

        plus = fmax(plus, fabs(got - p->q[i]));
        minus = fmax(minus, fabs(got + p->q[i]));
    }
    return fmax(off, isnan(plus) ? NAN : fmin(plus, minus));
}

/* Told values as they were told; angles that nobody told the same but for whole turns, and within
 * half a turn of 0. */
static double off_joint(Member *m, Kit *kit, const Scene *s, int number, bool told)
{
    const Joint *j = &s->joint[number];
    double off = 0, plus = 0, minus = 0;

    for (int k = 0; k < j->count; k++) {
        const double got = value(kit, "j", number, j->c[k].member);
        const bool is_parameter = j->c[k].member[0] == '.' && j->c[k].member[1] == 'q';
        double wrong = got - j->c[k].value;

        if (is_parameter) {
            plus = fmax(plus, fabs(wrong));
            minus = fmax(minus, fabs(got + j->c[k].value));
            continue;
        }
        if (isnan(got) && j->kind == SPHERICAL_ANGLES)
            return off; /* of a chord they can't be told */
        if (j->c[k].is_angle && !told) {
            wrong = remainder(wrong, 2 * M_PI);
            if (fabs(got) > M_PI + 1e-9)
                wrong = got;
        }
        if (!(fabs(wrong) < 1e-8))
            tell(m, "j%d%s is %.12g, not %.12g\n", number, j->c[k].member, got, j->c[k].value);
        off = fmax(off, fabs(wrong));
    }
    return fmax(off, fmin(plus, minus));
}

/* one choice of trees, and one way of telling */
static bool start_agrees(Member *m, const Scene *s, int choice)
{
    static Scene out;
    const int way = pick(m, 3); /* joints, bodies, some of each */
    bool told[JOINTS] = {false};
    double off = 0;
    Kit kit = kit_new();

    out.length = 0;
    write(&out, "%s", s->text);
    if (choice < 2)
        write(&out, choice == 0 ? "tree joint\n" : "tree absolute\n");
    else
        write_random_trees(m, s, &out);
    for (int i = 0; i < s->bodies; i++) {
        told[i] = way == 0 || (way == 2 && pick(m, 2) == 0);
        if (told[i])
            tell_joint(s, i, &out);
        else
            tell_body(m, s, i, &out);
    }
    write(&out, "assemble\n");
    if (kit_do(&kit, out.text) != CT_OK) {
        off = NAN;
        tell(m, "%s\n", kit.error.message);
    }
    for (int i = 0; i < s->bodies && !isnan(off); i++) {
        const double wrong = off_body(&kit, s, i);

        if (!(wrong < 1e-8))
            tell(m, "b%d is off by %.3g\n", i, wrong);
        off = wrong > off || isnan(wrong) ? wrong : off;
    }
    for (int i = 0; i < s->joints && !isnan(off); i++) {
        const double wrong = off_joint(m, &kit, s, i, told[i]);

        off = wrong > off || isnan(wrong) ? wrong : off;
    }
    kit_free(&kit);
    if (!(off < 1e-8) || m->told)
        tell(m, "%s", out.text);
    return off < 1e-8;
}

static Verdict run_member(Member *m)
{
    static Scene s;
    bool agrees = true;

    make_scene(m, &s);
    for (int choice = 0; choice < 4 && agrees; choice++)
        agrees = start_agrees(m, &s, choice);
    return agrees ? AGREES : DISAGREES;
}

static const Family families[] = {
    {"starts_are_the_ones_described", 12, 0, 0, run_member},
};

int main(int argc, char **argv)
{
    (void)test_faults;
    return family_main(families, 1, argc, argv);
}
