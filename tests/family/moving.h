/* moving.h: scenes that are told where and how fast they begin, and where jointed.h has them later
 */
#ifndef COTREE_TESTS_MOVING_H
#define COTREE_TESTS_MOVING_H

#include "standing.h"

/* --- poses --- */

static inline void report_poses(const Scene *s, Scene *out)
{
    for (int i = 0; i < s->bodies; i++) {
        const Pose *p = &s->body[i];

        for (int k = 0; k < (s->planar ? 2 : 3); k++)
            write(out, "init b%d.%c = %.17g\n", i, 'x' + k, p->r[k]);
        if (s->planar)
            write(out, "init b%d.theta = %.17g\n", i, 2 * atan2(p->q[3], p->q[0]));
        for (int k = 0; k < 4 && !s->planar; k++)
            write(out, "init b%d.q%d = %.17g\n", i, k, p->q[k]);
    }
}

/* Where the bodies of a scene without loops stand once joint i has coordinates c[i]. */
static inline void stand(const Scene *s, double (*c)[MOST_COORDINATES], Pose *bodies)
{
    for (int i = 0; i < s->bodies; i++) {
        const Joint *j = &s->joint[i];
        const Pose way = joint_pose(j, c[i]);
        const int other = j->head_body == i ? j->tail_body : j->head_body;
        const Pose base = other < 0 ? here : bodies[other];

        bodies[i] = j->head_body == i
                        ? compose(compose(compose(base, j->tail), way), inverse(j->head))
                        : compose(compose(compose(base, j->head), inverse(way)), inverse(j->tail));
    }
}

/* --- speeds --- */

typedef struct Speeds {            /* of a joint */
    double rate[MOST_COORDINATES]; /* of coordinates that aren't told as an angular speed; */
    double W[3];                   /* that, in the tip's axes */
    bool told;
} Speeds;

/* an attitude by parameters or by three angles, which a chord has no names for */
static inline bool is_lifted(const Joint *j, int k)
{
    return is_parameter(j, k) || j->kind == SPHERICAL_ANGLES;
}

static inline void draw_speeds(Member *m, const Joint *j, Speeds *speeds)
{
    memset(speeds, 0, sizeof *speeds);
    speeds->told = true;
    for (int k = 0; k < j->count; k++)
        speeds->rate[k] = is_lifted(j, k) ? 0 : between(m, -2, 2);
    for (int k = 0; k < 3 && j->count > 0 && is_lifted(j, j->count - 1); k++)
        speeds->W[k] = between(m, -2, 2);
}

static inline void report_speeds(const Joint *j, int number, const Speeds *speeds, Scene *out)
{
    for (int k = 0; k < j->count; k++)
        if (!is_lifted(j, k))
            write(out, "init j%d%s' = %.17g\n", number, coordinate_name(j, k), speeds->rate[k]);
    for (int k = 0; k < 3 && j->count > 0 && is_lifted(j, j->count - 1); k++)
        write(out, "init j%d.W%c = %.17g\n", number, 'x' + k, speeds->W[k]);
}

/* the bodies of a scene without loops after a moment of such speeds */
static inline void go_on(const Scene *s, const Speeds *speeds, double moment, Pose *bodies)
{
    for (int i = 0; i < s->bodies; i++) {
        const Joint *j = &s->joint[i];
        const double *W = speeds[i].W, size = sqrt(W[0] * W[0] + W[1] * W[1] + W[2] * W[2]);
        const double axis[3] = {size > 0 ? W[0] / size : 1, size > 0 ? W[1] / size : 0,
                                size > 0 ? W[2] / size : 0};
        const int other = j->head_body == i ? j->tail_body : j->head_body;
        const Pose base = other < 0 ? here : bodies[other];
        double c[MOST_COORDINATES] = {0};
        Pose way;

        for (int k = 0; k < j->count; k++)
            c[k] = j->c[k] + moment * speeds[i].rate[k];
        way = compose(joint_pose(j, c), turned(axis, moment * size));
        bodies[i] = j->head_body == i
                        ? compose(compose(compose(base, j->tail), way), inverse(j->head))
                        : compose(compose(compose(base, j->head), inverse(way)), inverse(j->tail));
    }
}

static inline void read_speeds(Kit *kit, const Scene *s, int body, double out[6])
{
    static const char *const names[] = {".vx", ".vy", ".vz", ".wx", ".wy", ".wz"};

    for (int k = 0; k < 6; k++)
        out[k] = s->planar && k > 1 && k < 5 ? 0 : value(kit, "b", body, names[k]);
}

#endif
