/* groups.c: the bodies that a speed moves as one, group by group outward along the trees */
#include "formulate/reduced/groups.h"

#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

/* position of a node: its group, and the vector from the group's origin in the axes of its class */
typedef struct GroupDirection {
    int group;
    Vec way;
} GroupDirection;

/* whether both trees reach every node by the same edge, every speed is that of a turn or of a
 * shift, and each share of parts in M belongs to one speed */
static bool applies(const System *system)
{
    const Kinematics *kin = system->kinematics;
    const Tree *translation = system->origin->trees[TREE_TRANSLATION];
    const Tree *rotation = system->origin->trees[TREE_ROTATION];
    int nodes;
    const int *order;

    if (translation == NULL || rotation == NULL || system->dynamics->elastics.count > 0 ||
        kin->speed_count != kin->u.count || kin->u.count == 0)
        return false;
    order = tree_nodes(translation, &nodes);
    for (int i = 1; i < nodes; i++)
        if (tree_parent_edge(translation, order[i]) != tree_parent_edge(rotation, order[i]))
            return false;
    for (int j = 0; j < kin->u.count; j++)
        if ((kin->speeds[j].chain >= 0) == (kin->speeds[j].slide_node >= 0) ||
            (kin->speeds[j].chain >= 0 && kin->chains.at[kin->speeds[j].chain].is_free))
            return false;
    for (int i = 0; i < system->dynamics->shares.count; i++)
        if (system->dynamics->shares.at[i].row != system->dynamics->shares.at[i].column)
            return false;
    return true;
}

static Group massless(Arena *arena, int parent, int chain)
{
    Group group = {.parent = parent, .chain = chain, .speed = -1};

    group.axis = group.way = group.moment = vec_zero(arena);
    group.mass = expr_int(arena, 0);
    for (int i = 0; i < 9; i++)
        group.inertia.at[i] = expr_int(arena, 0);
    return group;
}

/* adds the orientation classes that the branch to a node turns, outward from its parent's; beyond
 * `at` */
static GroupDirection turn(const System *system, Groups *groups, int node, GroupDirection at)
{
    const Kinematics *kin = system->kinematics;
    const int from = kin->frames[kin->frames[node].parent].chain;
    LIST(int) way = {0};

    for (int c = kin->frames[node].chain; c != from; c = kin->chains.at[c].parent)
        LIST_PUSH(way, c);
    for (int k = way.count - 1; k >= 0; k--) {
        const int speed = kin->chains.at[way.at[k]].speed;
        Group group = massless(system->arena, at.group, way.at[k]);

        group.speed = speed;
        group.axis = kin->speeds[speed].axis;
        group.way = at.way;
        LIST_PUSH(groups->all, group);
        at = (GroupDirection){groups->all.count - 1, vec_zero(system->arena)};
    }
    LIST_FREE(way);
    return at;
}

static GroupDirection shift(const System *system, Groups *groups, int node, GroupDirection at)
{
    const Frame *frame = &system->kinematics->frames[node];

    at.way = vec_hold(system->arena, vec_add(system->arena, at.way, frame->shift));
    for (int k = 0; k < frame->slide_count; k++) {
        Group group = massless(system->arena, at.group, frame->step_chain);

        group.speed = frame->slide[k].speed;
        group.slides = true;
        group.axis = frame->slide[k].axis;
        group.way = at.way;
        LIST_PUSH(groups->all, group);
        at = (GroupDirection){groups->all.count - 1, vec_zero(system->arena)};
    }
    return at;
}

/* adds m, S and J of `part`, whose origin is at `way` from that of `whole`, in the same axes */
static void carry(Arena *arena, Group *whole, const Group *part, Vec way)
{
    const Expr m = part->mass;
    const Vec S = part->moment;
    const Expr round = expr_add(arena, expr_mul(arena, expr_int(arena, 2), vec_dot(arena, way, S)),
                                expr_mul(arena, m, vec_dot(arena, way, way)));

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            Expr terms[6] = {
                whole->inertia.at[3 * i + j],
                part->inertia.at[3 * i + j],
                i == j ? round : expr_int(arena, 0),
                expr_neg(arena, expr_mul(arena, way.at[i], S.at[j])),
                expr_neg(arena, expr_mul(arena, S.at[i], way.at[j])),
                expr_neg(arena, expr_product(arena, (Expr[]){m, way.at[i], way.at[j]}, 3)),
            };

            whole->inertia.at[3 * i + j] = expr_name_temporary(arena, expr_sum(arena, terms, 6));
        }
    whole->moment =
        vec_hold(arena, vec_add(arena, whole->moment, vec_add(arena, S, vec_scale(arena, m, way))));
    whole->mass = expr_name_temporary(arena, expr_add(arena, whole->mass, m));
}

static void add_masses(const System *system, Groups *groups, const GroupDirection *places)
{
    for (int i = 0; i < system->dynamics->masses.count; i++) {
        const Mass *mass = &system->dynamics->masses.at[i];
        const GroupDirection *place = &places[mass->node];
        Group part = massless(system->arena, -1, 0);

        part.mass = mass->mass;
        part.inertia = mass->inertia;
        carry(system->arena, &groups->all.at[place->group], &part, place->way);
    }
}

/* By |a + b|^2 <= (1 + 1/k) |a|^2 + (1 + k) |b|^2, where k is the number of groups beyond, the
 * bound grows by no more than that number. */
static void bound_spreads(Arena *arena, Groups *groups)
{
    for (int g = groups->all.count - 1; g >= 0; g--) {
        Group *group = &groups->all.at[g];
        const Expr *J = group->inertia.at;
        group->carried = group->mass;
        group->spread = expr_name_temporary(arena, expr_sum(arena, (Expr[]){J[0], J[4], J[8]}, 3));
    }
    for (int g = groups->all.count - 1; g > 0; g--) {
        const Group *part = &groups->all.at[g];
        Group *whole = &groups->all.at[part->parent];
        const int k = part->height + 1;
        const Expr near = expr_mul(arena, expr_rational(arena, k + 1, k), part->spread);
        const Expr far = expr_product(
            arena,
            (Expr[]){expr_int(arena, k + 1), part->carried, vec_dot(arena, part->way, part->way)},
            3);

        whole->height = whole->height > k ? whole->height : k;
        whole->carried = expr_name_temporary(arena, expr_add(arena, whole->carried, part->carried));
        whole->spread = expr_name_temporary(
            arena,
            expr_sum(arena, (Expr[]){whole->spread, near, expr_name_temporary(arena, far)}, 3));
    }
}

Groups *groups_new(const System *system)
{
    Groups *groups;
    GroupDirection *places;
    int nodes;
    const int *order;

    if (!applies(system))
        return NULL;
    groups = NEW(Groups);
    places = NEW_ARRAY(GroupDirection, graph_node_count(system->origin->graph));
    order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    LIST_PUSH(groups->all, massless(system->arena, -1, 0));
    places[order[0]] = (GroupDirection){0, vec_zero(system->arena)};
    for (int i = 1; i < nodes; i++) {
        const Frame *frame = &system->kinematics->frames[order[i]];
        GroupDirection at = places[frame->parent];

        /* a shift is fixed in the frame of the edge's tail */
        if (frame->base == frame->parent)
            at = turn(system, groups, order[i], shift(system, groups, order[i], at));
        else
            at = shift(system, groups, order[i], turn(system, groups, order[i], at));
        places[order[i]] = at;
    }
    add_masses(system, groups, places);
    bound_spreads(system->arena, groups);
    mem_free(places);
    return groups;
}

void groups_free(Groups *groups)
{
    if (groups == NULL)
        return;
    LIST_FREE(groups->all);
    mem_free(groups);
}

/* --- what a turn doesn't change --- */

static int axis_number(Vec axis)
{
    int found = -1;

    for (int i = 0; i < 3; i++)
        if (!expr_is_zero(axis.at[i])) {
            if (found >= 0)
                return -1;
            found = i;
        }
    return found;
}

void groups_move_inertia(Arena *arena, Groups *groups)
{
    for (int g = groups->all.count - 1; g > 0; g--) {
        Group *group = &groups->all.at[g], part = massless(arena, -1, 0);
        const int k = axis_number(group->axis);

        if (group->slides) {
            part.inertia = group->inertia;
            for (int i = 0; i < 9; i++)
                group->inertia.at[i] = expr_int(arena, 0);
            carry(arena, &groups->all.at[group->parent], &part, vec_zero(arena));
            continue;
        }
        part.mass = group->mass;
        group->mass = expr_int(arena, 0);
        if (k >= 0) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            const Expr across = group->inertia.at[4 * j];

            part.moment.at[k] = group->moment.at[k];
            part.inertia.at[4 * i] = part.inertia.at[4 * j] = across;
            group->moment.at[k] = group->inertia.at[4 * j] = expr_int(arena, 0);
            group->inertia.at[4 * i] =
                expr_name_temporary(arena, expr_sub(arena, group->inertia.at[4 * i], across));
        }
        carry(arena, &groups->all.at[group->parent], &part, group->way);
    }
}
