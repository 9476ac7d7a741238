/* kinematic_tree.c: links as numbers, and poses of frames along trees of them */
#include "simulate/assemble/kinematic_tree.h"

#include "algebra/matrix3.h"
#include "base/memory.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* --- construction --- */

static void number_vector(Parameters *parameters, const Expr e[3], double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = parameters_evaluate(parameters, e[i]);
}

static void number_step(Parameters *parameters, const Step *step, LinkStep *out)
{
    number_vector(parameters, step->axis, out->axis);
    out->scale = parameters_evaluate(parameters, step->scale);
    out->coordinate = step->coordinate;
}

static void make_link(const System *system, Parameters *parameters, const Instance *instance,
                      Link *out)
{
    Steps steps;

    system_steps(system, instance, &steps);
    assert(instance->pose_count <= POSE_COORDS);
    *out = (Link){.instance = instance,
                  .edge = instance->edge,
                  .tail = instance->tail,
                  .head = instance->head,
                  .holds = instance->row->family == FAMILY_JOINT && !instance->is_virtual,
                  .shift_count = steps.shift_count,
                  .turn_count = steps.turn_count,
                  .has_parameters = steps.quaternion,
                  .first_parameter = steps.first_parameter};
    for (int k = 0; k < steps.shift_count; k++)
        number_step(parameters, &steps.shift[k], &out->shift[k]);
    for (int k = 0; k < steps.turn_count; k++)
        number_step(parameters, &steps.turn[k], &out->turn[k]);
    out->is_tied = steps.shift_count == 1 && steps.turn_count == 1 &&
                   steps.shift[0].coordinate == steps.turn[0].coordinate;
    number_vector(parameters, steps.constant, out->constant);
    for (int i = 0; i < 9; i++)
        out->R0[i] = parameters_evaluate(parameters, steps.rotation[i]);
}

/* a frame relative to the datum, with the coordinates of a free body */
static Link free_link(bool planar, int datum)
{
    const int shifts = planar ? 2 : 3;
    Link link = {.edge = -1, .tail = datum, .head = datum, .shift_count = shifts};

    for (int k = 0; k < shifts; k++) {
        link.shift[k] = (LinkStep){.scale = 1, .coordinate = k};
        link.shift[k].axis[k] = 1;
    }
    link.has_parameters = !planar;
    link.first_parameter = shifts;
    link.turn_count = planar ? 1 : 0;
    link.turn[0] = (LinkStep){.axis = {0, 0, 1}, .scale = 1, .coordinate = shifts};
    matrix3_one(link.R0);
    return link;
}

static int datum_of(const Graph *graph)
{
    int node = 0;

    while (graph_node(graph, node)->domain != DOMAIN_MECHANICAL || !graph_node(graph, node)->datum)
        node++;
    return node;
}

/* Find frames on flexible bodies without a length, and the frames beyond them. */
static void find_moved(KinematicTree *s)
{
    int count;
    const Tree *tree = system_tree(s->system, TREE_ROTATION);
    const int *nodes = tree_nodes(tree, &count);

    s->is_moved = NEW_ARRAY(bool, s->node_count);
    for (int i = 1; i < count; i++) {
        const Link *link = &s->links[s->link_at[tree_parent_edge(tree, nodes[i])]];

        s->is_moved[nodes[i]] =
            s->is_moved[tree_parent(tree, nodes[i])] ||
            (link->instance->row->deforming != NULL && !instance_bends(link->instance));
    }
}

KinematicTree *kinematic_tree_new(const VariableIndex *layout, Parameters *parameters)
{
    const System *system = layout->system;
    KinematicTree *s;

    if (system_tree(system, TREE_ROTATION) == NULL)
        return NULL;
    s = NEW(KinematicTree);
    s->system = system;
    s->node_count = graph_node_count(system_graph(system));
    s->datum = datum_of(system_graph(system));
    s->links = NEW_ARRAY(Link, system_instance_count(system));
    s->link_at = NEW_ARRAY(int, graph_edge_count(system_graph(system)));
    for (int i = 0; i < system_instance_count(system); i++) {
        const Instance *instance = system_instance(system, i);

        if (instance->row->steps == NULL || instance->edge < 0)
            continue;
        s->link_at[instance->edge] = s->link_count;
        make_link(system, parameters, instance, &s->links[s->link_count++]);
    }
    find_moved(s);
    s->frame = free_link(system_is_planar(system), s->datum);
    return s;
}

void kinematic_tree_free(KinematicTree *s)
{
    if (s == NULL)
        return;
    MEM_FREE(s->links, s->link_at, s->is_moved, s);
}

/* --- from coordinates to poses --- */

void link_attitude(const Link *link, const double *c, double E[9])
{
    double turn[9];

    matrix3_one(E);
    if (link->has_parameters)
        matrix3_of_parameters(c + link->first_parameter, E);
    for (int k = 0; k < link->turn_count; k++) {
        matrix3_turn(link->turn[k].axis, c[link->turn[k].coordinate], turn);
        matrix3_times(E, turn, E);
    }
}

void link_pose(const Link *link, const double *c, Pose *out)
{
    link_attitude(link, c, out->R);
    matrix3_times(out->R, link->R0, out->R);
    memcpy(out->p, link->constant, sizeof out->p);
    for (int k = 0; k < link->shift_count; k++)
        for (int i = 0; i < 3; i++)
            out->p[i] +=
                link->shift[k].scale * c[link->shift[k].coordinate] * link->shift[k].axis[i];
}

void pose_between(const Pose *tail, const Pose *head, Pose *out)
{
    double back[9], d[3];

    matrix3_transpose(tail->R, back);
    for (int i = 0; i < 3; i++)
        d[i] = head->p[i] - tail->p[i];
    matrix3_times(back, head->R, out->R);
    matrix3_apply(back, d, out->p);
}

void kinematic_tree_poses(const KinematicTree *s, const Tree *rotation, const Tree *translation,
                          const double *c, Pose *poses)
{
    int count;
    const int *nodes = tree_nodes(rotation, &count);

    matrix3_one(poses[s->datum].R);
    memset(poses[s->datum].p, 0, sizeof poses[s->datum].p);
    for (int i = 1; i < count; i++) {
        const int at = s->link_at[tree_parent_edge(rotation, nodes[i])];
        const double *parent = poses[tree_parent(rotation, nodes[i])].R;
        Pose step;

        link_pose(&s->links[at], c + (ptrdiff_t)at * POSE_COORDS, &step);
        if (!tree_is_forward(rotation, nodes[i]))
            matrix3_transpose(step.R, step.R);
        matrix3_times(parent, step.R, poses[nodes[i]].R);
    }
    nodes = tree_nodes(translation, &count);
    for (int i = 1; i < count; i++) {
        const int at = s->link_at[tree_parent_edge(translation, nodes[i])];
        const double *parent = poses[tree_parent(translation, nodes[i])].p;
        const double sense = tree_is_forward(translation, nodes[i]) ? 1 : -1;
        double d[3];
        Pose step;

        link_pose(&s->links[at], c + (ptrdiff_t)at * POSE_COORDS, &step);
        matrix3_apply(poses[s->links[at].tail].R, step.p, d);
        for (int k = 0; k < 3; k++)
            poses[nodes[i]].p[k] = parent[k] + sense * d[k];
    }
}

void link_turn_axis(const Link *link, const double *c, const double *R_tail, int k, double *out)
{
    double R[9], turn[9];

    memcpy(R, R_tail, sizeof R);
    for (int i = 0; i < k; i++) {
        matrix3_turn(link->turn[i].axis, c[link->turn[i].coordinate], turn);
        matrix3_times(R, turn, R);
    }
    matrix3_apply(R, link->turn[k].axis, out);
}

/* --- from poses to coordinates --- */

/* E: R without the constant rotation after the joint's own */
static void undo_constant(const Link *link, const double R[9], double E[9])
{
    double back[9];

    matrix3_transpose(link->R0, back);
    matrix3_times(R, back, E);
}

static double nearest_turn(double angle, double near)
{
    return angle + 2 * M_PI * round((near - angle) / (2 * M_PI));
}

/* angle of the rotation about u that is nearest to E */
static double turn_about(const double *u, const double E[9])
{
    const double twice[3] = {E[7] - E[5], E[2] - E[6], E[3] - E[1]};
    double far[3];

    matrix3_apply(E, u, far);
    return atan2(vector3_dot(u, twice), E[0] + E[4] + E[8] - vector3_dot(u, far));
}

/* of T(u1, a1) T(u2, a2), u1 and u2 perpendicular (theory 2, coordinate of a chord) */
static void read_two(const Link *link, const double E[9], double angle[3])
{
    const double *u1 = link->turn[0].axis, *u2 = link->turn[1].axis;
    double far1[3], far2[3], side[3];

    matrix3_apply(E, u1, far1);
    matrix3_apply(E, u2, far2);
    vector3_cross(u1, u2, side);
    angle[0] = atan2(vector3_dot(far2, side), vector3_dot(far2, u2));
    vector3_cross(u1, far2, side);
    angle[1] = atan2(-vector3_dot(far1, side), vector3_dot(far1, u1));
}

/* The two angle sequences of T(u1, a1) T(u2, a2) T(u3, a3), neighbours perpendicular: from the
 * direction of the third axis, and the remaining rotation. Where first and last axis are parallel
 * the first angle is the previous one. */
static void read_three(const Link *link, const double E[9], double near, double sets[2][3])
{
    const double singular = 1e-9;
    const double *u1 = link->turn[0].axis, *u2 = link->turn[1].axis, *u3 = link->turn[2].axis;
    const bool returns = fabs(vector3_dot(u1, u3)) > 0.5;
    double far3[3], side[3], along, up, first;

    matrix3_apply(E, u3, far3);
    vector3_cross(u2, u1, side);
    /* far3 = along u1 + across (cos a1 side' + sin a1 u2'), with the signs of the sequence */
    along = vector3_dot(far3, u1);
    up = hypot(vector3_dot(far3, u2), vector3_dot(far3, side));
    if (returns) {
        first = atan2(vector3_dot(far3, u2), vector3_dot(far3, side));
        sets[0][1] = atan2(up, along);
        sets[1][1] = -sets[0][1];
    } else {
        const double sense = -vector3_dot(u3, side); /* u3 = sense u1 x u2 */

        first = atan2(-sense * vector3_dot(far3, u2), -sense * vector3_dot(far3, side));
        sets[0][1] = atan2(sense * along, up);
        sets[1][1] = M_PI - sets[0][1];
    }
    sets[0][0] = up < singular ? near : first;
    sets[1][0] = up < singular ? near : first + M_PI;
    for (int which = 0; which < 2; which++) {
        double turn[9], rest[9], axis[3], x[3];

        matrix3_turn(u1, -sets[which][0], turn);
        matrix3_times(turn, E, rest);
        matrix3_turn(u2, -sets[which][1], turn);
        matrix3_times(turn, rest, rest);
        matrix3_apply(rest, u2, x);
        vector3_cross(u3, u2, axis);
        sets[which][2] = atan2(vector3_dot(x, axis), vector3_dot(x, u2));
    }
}

static void read_turns(const Link *link, const double E[9], double *c)
{
    double sets[2][3], off[2] = {0, 0};
    int best;

    if (link->turn_count == 0)
        return;
    if (link->turn_count == 1) {
        sets[0][0] = turn_about(link->turn[0].axis, E);
    } else if (link->turn_count == 2) {
        read_two(link, E, sets[0]);
    } else {
        read_three(link, E, c[link->turn[0].coordinate], sets);
    }
    for (int which = 0; which < (link->turn_count == 3 ? 2 : 1); which++)
        for (int k = 0; k < link->turn_count; k++) {
            const double near = c[link->turn[k].coordinate];

            sets[which][k] = nearest_turn(sets[which][k], near);
            off[which] += fabs(sets[which][k] - near);
        }
    best = link->turn_count == 3 && off[1] < off[0] ? 1 : 0;
    for (int k = 0; k < link->turn_count; k++)
        c[link->turn[k].coordinate] = sets[best][k];
}

static void read_attitude(const Link *link, const double E[9], double *c)
{
    double *p = c + link->first_parameter, old[4], sum = 0;

    if (!link->has_parameters) {
        read_turns(link, E, c);
        return;
    }
    memcpy(old, p, sizeof old);
    matrix3_parameters(E, p);
    for (int i = 0; i < 4; i++)
        sum += old[i] * p[i];
    for (int i = 0; i < 4 && sum < 0; i++)
        p[i] = 0 - p[i]; /* avoids -0 */
}

void link_read(const Link *link, const Pose *relative, double *c)
{
    double E[9], d[3];

    undo_constant(link, relative->R, E);
    for (int i = 0; i < 3; i++)
        d[i] = relative->p[i] - link->constant[i];
    read_attitude(link, E, c);
    /* the shift determines a screw's coordinate, over any number of turns */
    for (int k = 0; k < link->shift_count; k++)
        c[link->shift[k].coordinate] = vector3_dot(link->shift[k].axis, d) / link->shift[k].scale;
}

void link_turn_by(const Link *link, double *c, const double d[3])
{
    double E[9], turn[9], axis[3];
    const double angle = sqrt(vector3_dot(d, d));

    if (!(angle > 0))
        return;
    for (int i = 0; i < 3; i++)
        axis[i] = d[i] / angle;
    link_attitude(link, c, E);
    matrix3_turn(axis, angle, turn);
    matrix3_times(E, turn, E);
    read_attitude(link, E, c);
}
