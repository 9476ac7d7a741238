/* standing.h: where cotree has the bodies of a scene, held against where they belong */
#ifndef COTREE_TESTS_STANDING_H
#define COTREE_TESTS_STANDING_H

#include "../unit/session_kit.h"
#include "scenes.h"

#define NEAR 1e-8 /* m, rad: numbers are written to the last digit */

static inline double value(Kit *kit, const char *head, int number, const char *member)
{
    char name[40];

    snprintf(name, sizeof name, "%s%d%s", head, number, member);
    return kit_value(kit, name);
}

/* where a body stands; in a plane its angle stands for the parameters */
static inline Pose read_body(Kit *kit, const Scene *s, int body)
{
    static const char *const places[] = {".x", ".y", ".z"};
    static const char *const parameters[] = {".q0", ".q1", ".q2", ".q3"};
    static const double z[3] = {0, 0, 1};
    Pose p = here;

    if (s->planar)
        p = turned(z, value(kit, "b", body, ".theta"));
    for (int i = 0; i < 4 && !s->planar; i++)
        p.q[i] = value(kit, "b", body, parameters[i]);
    for (int i = 0; i < (s->planar ? 2 : 3); i++)
        p.r[i] = value(kit, "b", body, places[i]);
    return p;
}

static inline void read_joint(Kit *kit, const Scene *s, int number, double *c)
{
    for (int k = 0; k < s->joint[number].count; k++)
        c[k] = value(kit, "j", number, coordinate_name(&s->joint[number], k));
}

static inline double worst(double a, double b)
{
    return isnan(a) || isnan(b) ? NAN : fmax(a, b);
}

/* How far the coordinates that are reported are from those that follow from where the bodies
 * stand; three angles of a chord can't be determined. */
static inline double off_consistent(Member *m, Kit *kit, const Scene *s, const Pose *bodies)
{
    static const double nothing[MOST_COORDINATES];
    double off = 0;

    for (int i = 0; i < s->all; i++) {
        const Joint *j = &s->joint[i];
        double c[MOST_COORDINATES] = {0}, wrong;
        Pose stands, says;
        bool silent;

        read_joint(kit, s, i, c);
        stands = compose(inverse(compose(j->tail_body < 0 ? here : bodies[j->tail_body], j->tail)),
                         compose(j->head_body < 0 ? here : bodies[j->head_body], j->head));
        silent = j->kind == SPHERICAL_ANGLES && isnan(c[0]);
        says = joint_pose(j, silent ? nothing : c);
        wrong = tells_place(j) ? place_off(stands.r, says.r) : 0;
        if (!silent)
            wrong = worst(wrong, attitude_off(stands.q, says.q));
        if (!(wrong < NEAR))
            tell(m, "j%d is off by %.3g from where its bodies stand\n", i, wrong);
        off = worst(off, wrong);
    }
    return off;
}

static inline double off_bodies(Member *m, const Scene *s, const Pose *are, const Pose *belong)
{
    double off = 0;

    for (int i = 0; i < s->bodies; i++) {
        const double wrong =
            worst(place_off(are[i].r, belong[i].r), attitude_off(are[i].q, belong[i].q));

        if (!(wrong < NEAR))
            tell(m, "b%d is off by %.3g\n", i, wrong);
        off = worst(off, wrong);
    }
    return off;
}

#endif
