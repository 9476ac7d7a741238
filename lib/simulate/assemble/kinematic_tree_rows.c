/* kinematic_tree_rows.c: conditions of joints on the poses of their frames, with the sense of
 * directions
 *
 * Residuals of directions are rotation vectors, along the axis and with the size of the angle:
 * minus the one that would bring the head to the required direction. They are 0 for the required
 * sense only, and increase up to half a turn away from it. */
#include "simulate/assemble/kinematic_tree.h"

#include "algebra/elementary.h"
#include "algebra/matrix3.h"
#include "base/memory.h"
#include "simulate/assemble/assemble_limits.h"

#include <math.h>
#include <string.h>

static void undo_constant(const Link *link, const double R[9], double E[9])
{
    double back[9];

    matrix3_transpose(link->R0, back);
    matrix3_times(R, back, E);
}

/* --- positions --- */

/* directions of the tail without a slide along them; returns how many */
static int held_directions(const Link *link, double n[3][3])
{
    memset(n, 0, 9 * sizeof(double));
    if (link->shift_count == 0)
        for (int i = 0; i < 3; i++)
            n[i][i] = 1;
    if (link->shift_count == 1) {
        vector3_across(link->shift[0].axis, n[0]);
        vector3_cross(link->shift[0].axis, n[0], n[1]);
    }
    if (link->shift_count == 2)
        vector3_cross(link->shift[0].axis, link->shift[1].axis, n[0]);
    return 3 - link->shift_count;
}

int link_shift_rows(const Link *link, const Pose *relative, LinkRow *rows)
{
    double n[3][3];
    const int count = held_directions(link, n);

    for (int k = 0; k < count; k++) {
        rows[k] =
            (LinkRow){.value = vector3_dot(n[k], relative->p) - vector3_dot(n[k], link->constant)};
        memcpy(rows[k].by_shift, n[k], sizeof n[k]);
    }
    return count;
}

/* --- directions --- */

/* log(exp(d) E) = r + d - r x d/2 + c r x (r x d) to first order in d */
static void log_slopes(const double r[3], LinkRow *rows)
{
    const double size = sqrt(vector3_dot(r, r)), half = size / 2;
    const double c =
        size < 1e-3
            ? 1.0 / 12
            : (1 - half * elementary_cos(half) / fmax(elementary_sin(half), 1e-9)) / (size * size);

    for (int j = 0; j < 3; j++) {
        double d[3] = {0}, once[3], twice[3];

        d[j] = 1;
        vector3_cross(r, d, once);
        vector3_cross(r, once, twice);
        for (int i = 0; i < 3; i++)
            rows[i].by_turn[j] = d[i] - once[i] / 2 + c * twice[i];
    }
}

static int weld_rows(const double E[9], LinkRow *rows)
{
    double r[3];

    matrix3_log(E, r);
    for (int i = 0; i < 3; i++)
        rows[i] = (LinkRow){.value = r[i]};
    log_slopes(r, rows);
    return 3;
}

/* rotation vector from the axis to its direction in the head: two components, perpendicular to the
 * axis */
static int axis_rows(const double *u, const double E[9], LinkRow *rows)
{
    const double least = 0.1; /* of the sine in the denominator of a derivative, near half a turn */
    double n[2][3], far[3], w[3], side[3], across[3], sine, angle;

    vector3_across(u, n[0]);
    vector3_cross(u, n[0], n[1]);
    matrix3_apply(E, u, far);
    vector3_cross(u, far, w);
    sine = sqrt(vector3_dot(w, w));
    angle = atan2(sine, vector3_dot(u, far));
    for (int i = 0; i < 3; i++)
        w[i] = sine > 0 ? w[i] / sine : n[0][i];
    vector3_cross(u, w, side);
    vector3_cross(far, w, across);
    for (int k = 0; k < 2; k++) {
        const double along = vector3_dot(n[k], w), across_part = vector3_dot(n[k], side);
        const double ratio = angle < 1e-6       ? 1
                             : angle < M_PI / 2 ? angle / sine
                                                : angle / fmax(sine, least);

        rows[k] = (LinkRow){.value = angle * along};
        for (int j = 0; j < 3; j++)
            rows[k].by_turn[j] = along * w[j] + across_part * ratio * across[j];
    }
    return 2;
}

/* the second axis of a universal joint is perpendicular to the first */
static int cross_rows(const Link *link, const double E[9], LinkRow *rows)
{
    const double *u1 = link->turn[0].axis;
    double far[3];

    matrix3_apply(E, link->turn[1].axis, far);
    rows[0] = (LinkRow){.value = vector3_dot(u1, far)};
    vector3_cross(far, u1, rows[0].by_turn);
    return 1;
}

int link_turn_rows(const Link *link, const Pose *relative, LinkRow *rows)
{
    double E[9];

    undo_constant(link, relative->R, E);
    if (link->has_parameters || link->turn_count == 3)
        return 0;
    return link->turn_count == 0   ? weld_rows(E, rows)
           : link->turn_count == 1 ? axis_rows(link->turn[0].axis, E, rows)
                                   : cross_rows(link, E, rows);
}

/* --- values --- */

static double value_off(const Link *link, const Pose *relative, const double *near, int k,
                        double value)
{
    double c[POSE_COORDS];

    memcpy(c, near, sizeof c);
    link_read(link, relative, c);
    return c[k] - value;
}

/* the pose with its head turned or shifted a little, in the axes of the tail */
static Pose displaced(const Pose *pose, int direction, double by)
{
    Pose moved = *pose;
    double axis[3] = {0}, turn[9];

    if (direction >= 3) {
        moved.p[direction - 3] += by;
        return moved;
    }
    axis[direction] = 1;
    matrix3_turn(axis, by, turn);
    matrix3_times(turn, moved.R, moved.R);
    return moved;
}

static void difference_row(const Link *link, const Pose *relative, const double *near, int k,
                           double value, LinkRow *row)
{
    const double step = 1e-5; /* the error of a central difference is about its square */

    *row = (LinkRow){.value = value_off(link, relative, near, k, value)};
    for (int i = 0; i < 6; i++) {
        const Pose up = displaced(relative, i, step), down = displaced(relative, i, -step);
        const double slope =
            (value_off(link, &up, near, k, value) - value_off(link, &down, near, k, value)) /
            (2 * step);

        (i < 3 ? row->by_turn : row->by_shift)[i % 3] = slope;
    }
}

void link_value_row(const Link *link, const Pose *relative, const double *near, int k, double value,
                    LinkRow *row)
{
    double here[POSE_COORDS];

    /* for differences on the same side of a half turn, with the same sign of Euler parameters */
    memcpy(here, near, sizeof here);
    link_read(link, relative, here);
    difference_row(link, relative, here, k, value, row);
}

void link_tie_row(const Link *link, const Pose *relative, LinkRow *row)
{
    const double *u = link->turn[0].axis;
    Link loose = *link;
    double c[POSE_COORDS] = {0};

    /* as a cylindrical joint: the turn nearest to the one that belongs to the shift */
    loose.shift[0].scale = 1;
    loose.shift[0].coordinate = 1;
    loose.turn[0].coordinate = 0;
    link_read(&loose, relative, c);
    c[0] = c[1] / link->shift[0].scale;
    link_read(&loose, relative, c);
    *row = (LinkRow){.value = c[1] - link->shift[0].scale * c[0]};
    for (int i = 0; i < 3; i++) {
        row->by_shift[i] = u[i];
        row->by_turn[i] = -link->shift[0].scale * u[i];
    }
}

static Reversal find_reversal(const KinematicTree *s, const Pose *poses)
{
    for (int i = 0; i < s->link_count; i++) {
        const Link *link = &s->links[i];
        LinkRow rows[LINK_ROWS];
        Reversal found = {.link = link};
        Pose relative;
        double size = 0;
        int count;

        if (!link->holds || s->is_moved[link->tail] || s->is_moved[link->head])
            continue;
        pose_between(&poses[link->tail], &poses[link->head], &relative);
        count = link_turn_rows(link, &relative, rows);
        for (int k = 0; k < count; k++) {
            size = hypot(size, rows[k].value);
            found.about[k] = rows[k].value; /* of a joint without any rotation */
        }
        if (size > JOINT_REVERSED)
            return found;
        if (link->is_tied) {
            link_tie_row(link, &relative, rows);
            found.is_twisted = fabs(rows[0].value) > JOINT_REVERSED * fabs(link->shift[0].scale);
        }
        if (found.is_twisted)
            return found;
    }
    return (Reversal){.link = NULL};
}

Pose *kinematic_tree_poses_at(const KinematicTree *s, const double *q)
{
    Pose *poses = NEW_ARRAY(Pose, s->node_count);
    double *c = NEW_ARRAY(double, s->link_count *POSE_COORDS);

    for (int i = 0; i < s->link_count; i++)
        for (int k = 0; k < s->links[i].instance->pose_count; k++) {
            const int place = system_coordinate(s->system, s->links[i].instance, k);

            c[i * POSE_COORDS + k] = place >= 0 ? q[place] : 0;
        }
    kinematic_tree_poses(s, system_tree(s->system, TREE_ROTATION),
                         system_tree(s->system, TREE_TRANSLATION), c, poses);
    mem_free(c);
    return poses;
}

Reversal kinematic_tree_reversal(const KinematicTree *s, const double *q)
{
    Reversal found = {.link = NULL};

    if (s != NULL) {
        Pose *poses = kinematic_tree_poses_at(s, q);

        found = find_reversal(s, poses);
        mem_free(poses);
    }
    return found;
}

/* of the two senses of a half turn choose the one whose largest component is positive */
static void choose_sense(double u[3])
{
    double largest = 0;

    for (int k = 0; k < 3; k++)
        if (fabs(u[k]) > fabs(largest))
            largest = u[k];
    for (int k = 0; k < 3; k++)
        u[k] *= largest < 0 ? -1 : 1;
}

/* -y, or [0.6, 0.8, 0] */
static void add_axis(const double *u, Text *out)
{
    const double rounding = 1e-6;

    for (int k = 0; k < 3; k++)
        if (fabs(u[k]) > (1 - rounding) * sqrt(vector3_dot(u, u))) {
            text_addf(out, "%s%c", u[k] < 0 ? "-" : "", "xyz"[k]);
            return;
        }
    text_addf(out, "[%.6g, %.6g, %.6g]", u[0], u[1], u[2]);
}

void reversal_report(const KinematicTree *s, const Reversal *reversal, Text *out)
{
    const Graph *graph = system_graph(s->system);
    const Link *link = reversal->link;
    const char *tail = graph_node(graph, link->tail)->name;
    const char *head = graph_node(graph, link->head)->name;
    double u[3];

    if (reversal->is_twisted) {
        text_addf(out, "its turn half a turn off: %s against %s is not turned as its shift asks",
                  head, tail);
        return;
    }
    text_addf(out, "its %s reversed: ", link->turn_count > 0 ? "axis" : "tip");
    if (link->turn_count > 0) {
        add_axis(link->turn[0].axis, out);
        text_addf(out, " of %s and ", tail);
        add_axis(link->turn[0].axis, out);
        text_addf(out, " of %s point opposite ways", head);
        return;
    }
    memcpy(u, reversal->about, sizeof u);
    choose_sense(u);
    text_addf(out, "%s is turned against %s by half a turn about ", head, tail);
    add_axis(u, out);
    text_addf(out, " of %s", tail);
}

double kinematic_tree_value(const KinematicTree *s, const double *q, const Instance *instance,
                            int k, const double near[POSE_COORDS])
{
    const Link *link = &s->links[s->link_at[instance->edge]];
    Pose *poses = kinematic_tree_poses_at(s, q);
    double c[POSE_COORDS];
    Pose relative;

    memcpy(c, near, sizeof c);
    pose_between(&poses[link->tail], &poses[link->head], &relative);
    link_read(link, &relative, c);
    mem_free(poses);
    return c[k];
}
