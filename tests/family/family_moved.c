/* family_moved.c: what events set, what drivers drive and what was told of speeds, in any trees
 *
 * Random scenes of scenes.h stand still, as nothing pulls on them. An event puts all joints
 * elsewhere at once, or one of them with loops to follow; poses after it come from jointed.h. */
#include "standing.h"

static void tell_poses(const Scene *s, Scene *out)
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

/* --- events --- */

/* Where the bodies of a scene without loops stand once joint i has coordinates c[i]. */
static void stand(const Scene *s, double (*c)[MOST_COORDINATES], Pose *bodies)
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

/* three angles of a chord can't be set: their body's attitude is */
static void set_joint(const Scene *s, int number, const double *c, const Pose *body, Scene *out)
{
    const Joint *j = &s->joint[number];

    for (int k = 0; k < j->count && j->kind != SPHERICAL_ANGLES; k++)
        write(out, " j%d%s=%.17g", number, coordinate_name(j, k), c[k]);
    for (int k = 0; k < 4 && j->kind == SPHERICAL_ANGLES; k++)
        write(out, " b%d.q%d=%.17g", number, k, body->q[k]);
}

static Verdict all_set_member(Member *m)
{
    static Scene s, out;
    double c[BODIES][MOST_COORDINATES], off;
    Pose now[BODIES], bodies[BODIES];
    Kit kit = kit_new();

    make_scene(m, &s, false, false);
    for (int i = 0; i < s.bodies; i++)
        draw_coordinates(m, &s.joint[i], c[i]);
    stand(&s, c, now);
    out.length = 0;
    write(&out, "%s", s.text);
    write_trees(m, &s, pick(m, 4), &out);
    tell_poses(&s, &out);
    write(&out, "event e when=t>0.5");
    for (int i = 0; i < s.bodies; i++)
        set_joint(&s, i, c[i], &now[i], &out);
    write(&out, "\nsimulate 1\n");
    off = kit_do(&kit, out.text) == CT_OK ? 0 : NAN;
    if (isnan(off))
        tell(m, "%s\n", kit.error.message);
    for (int i = 0; i < s.bodies && !isnan(off); i++)
        bodies[i] = read_body(&kit, &s, i);
    if (!isnan(off)) {
        off = off_bodies(m, &s, bodies, now);
        off = worst(off, off_consistent(m, &kit, &s, bodies));
    }
    kit_free(&kit);
    if (!(off < NEAR) || m->told)
        tell(m, "%s", out.text);
    return off < NEAR ? AGREES : isnan(off) ? REFUSED : DISAGREES;
}

static const Family families[] = {
    {"an_event_puts_all_joints_where_it_says", 20, 0.15, 0, all_set_member},
};

int main(int argc, char **argv)
{
    (void)test_faults;
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
