/* perturbed_points.c: poses on both sides of a position, recomputed from what a speed moves */
#include "simulate/assemble/perturbed_points.h"

#include "algebra/matrix3.h"
#include "base/memory.h"

#include <string.h>

/* Poses of one side. Only what the speed moves is recomputed, from its links on. */
typedef struct Side {
    double *c;       /* links x POSE_COORDS */
    Pose *steps;     /* of links */
    Pose *poses;     /* of nodes */
    bool *is_turned; /* per node: the speed changes its rotation, */
    bool *is_moved;
} Side;

struct PerturbedPoints {
    const KinematicTree *s;
    const Equations *eq;
    double step;
    int *place;       /* index of each coordinate of the system in c; -1: of no link */
    Side here;        /* at the position */
    Side low, high;   /* and on both sides of it */
    int *changed;     /* links whose coordinates the speed moves, `count` of them */
    int count;        /* number of these links */
    bool *is_changed; /* per link: whether it is one of them */
};

static Side side_new(const KinematicTree *s)
{
    return (Side){.c = NEW_ARRAY(double, s->link_count *POSE_COORDS),
                  .steps = NEW_ARRAY(Pose, s->link_count),
                  .poses = NEW_ARRAY(Pose, s->node_count),
                  .is_turned = NEW_ARRAY(bool, s->node_count),
                  .is_moved = NEW_ARRAY(bool, s->node_count)};
}

static void side_free(Side *side)
{
    MEM_FREE(side->c, side->steps, side->poses, side->is_turned, side->is_moved);
}

static int place_of(int link, int k)
{
    return link * POSE_COORDS + k;
}

static void begin_side(const PerturbedPoints *sides, Side *side)
{
    const size_t links = (size_t)sides->s->link_count;

    memcpy(side->c, sides->here.c, links * POSE_COORDS * sizeof(double));
    memcpy(side->steps, sides->here.steps, links * sizeof(Pose));
}

PerturbedPoints *perturbed_points_new(const KinematicTree *s, const Equations *eq, const double *q,
                                      double step)
{
    PerturbedPoints *out = NEW(PerturbedPoints);
    Pose *poses = kinematic_tree_poses_at(s, q);

    *out = (PerturbedPoints){.s = s,
                             .eq = eq,
                             .step = step,
                             .place = NEW_ARRAY(int, eq->n),
                             .here = side_new(s),
                             .low = side_new(s),
                             .high = side_new(s),
                             .changed = NEW_ARRAY(int, s->link_count),
                             .is_changed = NEW_ARRAY(bool, s->link_count)};
    for (int i = 0; i < eq->n; i++)
        out->place[i] = -1;
    for (int i = 0; i < s->link_count; i++) {
        for (int k = 0; k < s->links[i].instance->pose_count; k++) {
            const int place = system_coordinate(s->system, s->links[i].instance, k);

            out->here.c[place_of(i, k)] = place >= 0 ? q[place] : 0;
            if (place >= 0)
                out->place[place] = place_of(i, k);
        }
        link_pose(&s->links[i], out->here.c + place_of(i, 0), &out->here.steps[i]);
    }
    memcpy(out->here.poses, poses, (size_t)s->node_count * sizeof *poses);
    mem_free(poses);
    begin_side(out, &out->low);
    begin_side(out, &out->high);
    return out;
}

void perturbed_points_free(PerturbedPoints *sides)
{
    if (sides == NULL)
        return;
    side_free(&sides->here);
    side_free(&sides->low);
    side_free(&sides->high);
    MEM_FREE(sides->place, sides->changed, sides->is_changed, sides);
}

/* the links that a speed moves the coordinates of */
static void choose_changed(PerturbedPoints *sides, int j)
{
    const Equations *eq = sides->eq;

    for (int k = 0; k < sides->count; k++)
        sides->is_changed[sides->changed[k]] = false;
    sides->count = 0;
    for (int i = eq->map == NULL ? j : 0; i < (eq->map == NULL ? j + 1 : eq->n); i++) {
        const int link = sides->place[i] / POSE_COORDS;

        if (sides->place[i] >= 0 && !sides->is_changed[link] &&
            (eq->map == NULL || pattern_at(eq->maps, eq->map, j, i) != 0)) {
            sides->changed[sides->count++] = link;
            sides->is_changed[link] = true;
        }
    }
}

/* set coordinates of these links, `by` along the speed */
static void step_links(const PerturbedPoints *sides, Side *side, int j, double by)
{
    const Equations *eq = sides->eq;
    const KinematicTree *s = sides->s;

    for (int k = 0; k < sides->count; k++) {
        const int link = sides->changed[k];

        for (int i = 0; i < s->links[link].instance->pose_count; i++) {
            const int q = system_coordinate(s->system, s->links[link].instance, i);
            const int at = place_of(link, i);

            side->c[at] = sides->here.c[at];
            if (q >= 0)
                side->c[at] +=
                    by * (eq->map != NULL ? pattern_at(eq->maps, eq->map, j, q) : q == j);
        }
        link_pose(&s->links[link], side->c + place_of(link, 0), &side->steps[link]);
    }
}

/* poses as from kinematic_tree_poses(), where a link or the node before has changed */
static void turn_nodes(const PerturbedPoints *sides, Side *side)
{
    const KinematicTree *s = sides->s;
    const Tree *tree = system_tree(s->system, TREE_ROTATION);
    int count;
    const int *nodes = tree_nodes(tree, &count);

    side->is_turned[s->datum] = false;
    memcpy(side->poses[s->datum].R, sides->here.poses[s->datum].R, sizeof(double[9]));
    for (int i = 1; i < count; i++) {
        const int node = nodes[i], parent = tree_parent(tree, node);
        const int at = s->link_at[tree_parent_edge(tree, node)];
        double step[9];

        side->is_turned[node] = side->is_turned[parent] || sides->is_changed[at];
        if (!side->is_turned[node]) {
            memcpy(side->poses[node].R, sides->here.poses[node].R, sizeof(double[9]));
            continue;
        }
        memcpy(step, side->steps[at].R, sizeof step);
        if (!tree_is_forward(tree, node))
            matrix3_transpose(step, step);
        matrix3_times(side->poses[parent].R, step, side->poses[node].R);
    }
}

static void shift_nodes(const PerturbedPoints *sides, Side *side)
{
    const KinematicTree *s = sides->s;
    const Tree *tree = system_tree(s->system, TREE_TRANSLATION);
    int count;
    const int *nodes = tree_nodes(tree, &count);

    side->is_moved[s->datum] = false;
    memcpy(side->poses[s->datum].p, sides->here.poses[s->datum].p, sizeof(double[3]));
    for (int i = 1; i < count; i++) {
        const int node = nodes[i], parent = tree_parent(tree, node);
        const int at = s->link_at[tree_parent_edge(tree, node)], tail = s->links[at].tail;
        const double sense = tree_is_forward(tree, node) ? 1 : -1;
        double d[3];

        side->is_moved[node] =
            side->is_moved[parent] || side->is_turned[tail] || sides->is_changed[at];
        if (!side->is_moved[node]) {
            memcpy(side->poses[node].p, sides->here.poses[node].p, sizeof(double[3]));
            continue;
        }
        matrix3_apply(side->poses[tail].R, side->steps[at].p, d);
        for (int k = 0; k < 3; k++)
            side->poses[node].p[k] = side->poses[parent].p[k] + sense * d[k];
    }
}

/* restore everything to the position, after a speed */
static void put_back(const PerturbedPoints *sides, Side *side)
{
    for (int k = 0; k < sides->count; k++) {
        const int link = sides->changed[k];

        memcpy(side->c + place_of(link, 0), sides->here.c + place_of(link, 0),
               POSE_COORDS * sizeof(double));
        side->steps[link] = sides->here.steps[link];
    }
}

void perturbed_points_find(PerturbedPoints *sides, int j)
{
    put_back(sides, &sides->low);
    put_back(sides, &sides->high);
    choose_changed(sides, j);
    step_links(sides, &sides->low, j, -sides->step);
    step_links(sides, &sides->high, j, sides->step);
    turn_nodes(sides, &sides->low);
    turn_nodes(sides, &sides->high);
    shift_nodes(sides, &sides->low);
    shift_nodes(sides, &sides->high);
}

const Pose *perturbed_points_low(const PerturbedPoints *sides)
{
    return sides->low.poses;
}

const Pose *perturbed_points_high(const PerturbedPoints *sides)
{
    return sides->high.poses;
}

bool perturbed_points_stores(const PerturbedPoints *sides, int link)
{
    const System *system = sides->s->system;
    const Link *l = &sides->s->links[link];
    const Side *side = &sides->high;
    const bool is_branch = tree_has(system_tree(system, TREE_ROTATION), l->edge) &&
                           tree_has(system_tree(system, TREE_TRANSLATION), l->edge);

    return (is_branch && !sides->is_changed[link]) ||
           !(side->is_turned[l->tail] || side->is_moved[l->tail] || side->is_turned[l->head] ||
             side->is_moved[l->head]);
}
