/* jointed.h: joints of all kinds as poses, with quaternions (scalar first)
 *
 * The pose of a joint's head against its tail follows from its coordinates alone, here by
 * quaternions and the joints' definitions in the manual; cotree has no part in it. */
#ifndef COTREE_TESTS_JOINTED_H
#define COTREE_TESTS_JOINTED_H

#include "family.h"

#include <math.h>

/* --- quaternions --- */

typedef struct Pose {
    double q[4], r[3];
} Pose;

static const Pose here = {{1, 0, 0, 0}, {0, 0, 0}};

static inline void multiply(const double a[4], const double b[4], double out[4])
{
    const double c[4] = {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                         a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                         a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
                         a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};

    memcpy(out, c, sizeof c);
}

static inline void carry(const double q[4], const double v[3], double out[3])
{
    const double pure[4] = {0, v[0], v[1], v[2]}, back[4] = {q[0], -q[1], -q[2], -q[3]};
    double t[4];

    multiply(q, pure, t);
    multiply(t, back, t);
    memcpy(out, t + 1, 3 * sizeof(double));
}

static inline Pose compose(Pose a, Pose b)
{
    Pose c;

    multiply(a.q, b.q, c.q);
    carry(a.q, b.r, c.r);
    for (int i = 0; i < 3; i++)
        c.r[i] += a.r[i];
    return c;
}

static inline Pose inverse(Pose a)
{
    Pose b = {{a.q[0], -a.q[1], -a.q[2], -a.q[3]}, {0, 0, 0}};

    carry(b.q, a.r, b.r);
    for (int i = 0; i < 3; i++)
        b.r[i] = -b.r[i];
    return b;
}

static inline Pose turned(const double u[3], double angle)
{
    const double s = sin(angle / 2);

    return (Pose){{cos(angle / 2), s * u[0], s * u[1], s * u[2]}, {0, 0, 0}};
}

static inline Pose shifted(const double u[3], double by)
{
    return (Pose){{1, 0, 0, 0}, {by * u[0], by * u[1], by * u[2]}};
}

/* the larger difference of two attitudes' parameters, of which q and -q are one */
static inline double attitude_off(const double a[4], const double b[4])
{
    double same = 0, opposite = 0;

    for (int i = 0; i < 4; i++) {
        same = fmax(same, fabs(a[i] - b[i]));
        opposite = fmax(opposite, fabs(a[i] + b[i]));
    }
    return isnan(a[0] + b[0]) ? NAN : fmin(same, opposite);
}

static inline double place_off(const double a[3], const double b[3])
{
    double off = 0;

    for (int i = 0; i < 3; i++)
        off = isnan(a[i] - b[i]) ? NAN : fmax(off, fabs(a[i] - b[i]));
    return off;
}

/* --- numbers at random --- */

static inline int pick(Member *m, int count)
{
    return (int)(test_random(&m->random) % (uint64_t)count);
}

static inline double between(Member *m, double low, double high)
{
    return test_uniform(&m->random, low, high);
}

/* a turn, now and then with whole turns more */
static inline double random_angle(Member *m)
{
    const double angle = between(m, -3.1, 3.1);

    return pick(m, 4) == 0 ? angle + 2 * M_PI * (pick(m, 5) - 2) : angle;
}

/* an attitude, now and then about one axis of the frame */
static inline void random_attitude(Member *m, double q[4])
{
    const int alone = pick(m, 8);
    double size = 0;

    for (int i = 0; i < 4; i++) {
        q[i] = alone < 3 && i != 0 && i != alone + 1 ? 0 : between(m, -1, 1);
        size += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++)
        q[i] /= sqrt(size);
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
enum { PLANE_KINDS = CYLINDRICAL, MOST_COORDINATES = 7 };

typedef struct Joint {
    Kind kind;
    bool is_virtual, in_plane;
    int tail_body, head_body; /* -1: ground */
    Pose tail, head;          /* of its frames in those */
    double u[3], u2[3];
    char axis[2][80], sequence[4]; /* as written */
    double pitch;
    double c[MOST_COORDINATES]; /* coordinates */
    int count;
} Joint;

static const char *const kind_words[KINDS] = {"revolute",    "prismatic",  "weld",      "free",
                                              "cylindrical", "screw",      "universal", "spherical",
                                              "spherical",   "planarjoint"};

/* the end of a coordinate's name: ".s"; "": the joint's own */
static inline const char *coordinate_name(const Joint *j, int k)
{
    static const char *const several[KINDS][MOST_COORDINATES] = {
        [REVOLUTE] = {""},
        [PRISMATIC] = {""},
        [FREE] = {".x", ".y", ".z", ".q0", ".q1", ".q2", ".q3"},
        [CYLINDRICAL] = {".s", ".theta"},
        [SCREW] = {""},
        [UNIVERSAL] = {".a1", ".a2"},
        [SPHERICAL] = {".q0", ".q1", ".q2", ".q3"},
        [SPHERICAL_ANGLES] = {".a1", ".a2", ".a3"},
        [PLANARJOINT] = {".s1", ".s2", ".theta"}};

    return j->kind == FREE && j->in_plane && k == 2 ? ".theta" : several[j->kind][k];
}

/* the first of four Euler parameters; -1: it has none */
static inline int first_parameter(const Joint *j)
{
    return j->kind == SPHERICAL ? 0 : j->kind == FREE && !j->in_plane ? 3 : -1;
}

static inline bool is_parameter(const Joint *j, int k)
{
    return first_parameter(j) >= 0 && k >= first_parameter(j);
}

static inline bool is_angle(const Joint *j, int k)
{
    return j->kind == REVOLUTE || j->kind == UNIVERSAL || j->kind == SPHERICAL_ANGLES ||
           (j->kind == CYLINDRICAL && k == 1) || (j->kind == PLANARJOINT && k == 2) ||
           (j->kind == FREE && j->in_plane && k == 2);
}

/* a virtual joint says nothing of what its coordinates leave out */
static inline bool tells_place(const Joint *j)
{
    return !j->is_virtual || j->kind == FREE;
}

/* the next axes of the circle x y z, as planar joints have them */
static inline void across(const double u[3], double n1[3], double n2[3])
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

static inline Pose of_parameters(const double *q)
{
    const double size = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);

    return (Pose){{q[0] / size, q[1] / size, q[2] / size, q[3] / size}, {0, 0, 0}};
}

/* where coordinates put the head against the tail */
static inline Pose joint_pose(const Joint *j, const double *c)
{
    static const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    const double *const axes[] = {x, y, z};
    double n1[3], n2[3];
    Pose p = here;

    switch (j->kind) {
    case REVOLUTE:
        return turned(j->u, c[0]);
    case PRISMATIC:
        return shifted(j->u, c[0]);
    case CYLINDRICAL:
        return compose(shifted(j->u, c[0]), turned(j->u, c[1]));
    case SCREW:
        return compose(shifted(j->u, j->pitch * c[0] / (2 * M_PI)), turned(j->u, c[0]));
    case UNIVERSAL:
        return compose(turned(j->u, c[0]), turned(j->u2, c[1]));
    case SPHERICAL:
        return of_parameters(c);
    case SPHERICAL_ANGLES:
        for (int i = 0; i < 3; i++)
            p = compose(p, turned(axes[j->sequence[i] - 'x'], c[i]));
        return p;
    case PLANARJOINT:
        across(j->u, n1, n2);
        return compose(compose(shifted(n1, c[0]), shifted(n2, c[1])), turned(j->u, c[2]));
    case FREE:
        p = compose(shifted(x, c[0]), shifted(y, c[1]));
        return compose(j->in_plane ? p : compose(p, shifted(z, c[2])),
                       j->in_plane ? turned(z, c[2]) : of_parameters(c + 3));
    default:
        return p; /* a weld */
    }
}

/* an axis and how it is written; along_z: no other */
static inline void random_axis(Member *m, bool along_z, bool along_frame, double u[3], char *text)
{
    static const char letters[] = "xyz";
    double size;

    memset(u, 0, 3 * sizeof(double));
    if (along_z || along_frame || pick(m, 2) == 0) {
        const int k = along_z ? 2 : pick(m, 3);
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

static inline void random_axes(Member *m, bool along_z, Joint *j)
{
    static const char *const sequences[] = {"xyz", "zyx", "zxz", "yxy", "xzy", "yzx"};
    static const char *const in_plane[] = {"x", "y", "-x"};

    random_axis(m, along_z, j->kind == UNIVERSAL || j->kind == PLANARJOINT, j->u, j->axis[0]);
    do
        random_axis(m, false, true, j->u2, j->axis[1]);
    while (j->kind == UNIVERSAL &&
           fabs(j->u[0] * j->u2[0] + j->u[1] * j->u2[1] + j->u[2] * j->u2[2]) > 0.5);
    strcpy(j->sequence, sequences[pick(m, 6)]);
    j->pitch = between(m, 0.1, 0.5) * (pick(m, 2) ? 1 : -1);
    if (j->kind == PRISMATIC && j->in_plane) {
        const int k = pick(m, 3);

        strcpy(j->axis[0], in_plane[k]);
        j->u[0] = k == 0 ? 1 : k == 2 ? -1 : 0;
        j->u[1] = k == 1;
        j->u[2] = 0;
    }
}

/* coordinates that the joint may have */
static inline void draw_coordinates(Member *m, const Joint *j, double *c)
{
    for (int k = 0; k < j->count; k++)
        c[k] = is_angle(j, k) ? random_angle(m)
               /* its shift knows all turns */
               : j->kind == SCREW ? between(m, -9, 9)
                                  : between(m, -1, 1);
    if (first_parameter(j) >= 0)
        random_attitude(m, c + first_parameter(j));
    if (j->kind == SPHERICAL_ANGLES) {
        /* the two sets of angles are told apart by the one between */
        const bool returns = j->sequence[0] == j->sequence[2];

        c[0] = between(m, -1.4, 1.4);
        c[1] = returns ? between(m, 0.2, 1.4) : between(m, -1.2, 1.2);
        c[2] = between(m, -1.4, 1.4);
    }
}

/* axes and coordinates of a joint whose kind is chosen */
static inline void draw_joint(Member *m, bool along_z, Joint *j)
{
    static const int counts[KINDS] = {[REVOLUTE] = 1,    [PRISMATIC] = 1, [CYLINDRICAL] = 2,
                                      [SCREW] = 1,       [UNIVERSAL] = 2, [SPHERICAL] = 4,
                                      [PLANARJOINT] = 3, [FREE] = 7,      [SPHERICAL_ANGLES] = 3};

    random_axes(m, along_z, j);
    j->count = j->kind == FREE && j->in_plane ? 3 : counts[j->kind];
    draw_coordinates(m, j, j->c);
}

#endif
