/* composite.c: composite rigid bodies beyond each node
 *
 * Where both trees have the same nodes beyond a branch, one unit of its speed moves these nodes as
 * one rigid body. The branches nearer to the datum depend only on its mass m (kg), first moment S
 * (kg m, 3 x 1) and inertia J (kg m^2, 3 x 3) about the node's origin (Walker and Orin 1982, here
 * on a linear graph). */
#include "formulate/dynamics/composite.h"
#include "formulate/dynamics/loads.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/identity.h"
#include "formulate/kinematics/isomorphic.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

/* it doesn't turn with the nodes beyond the branch, and none of them bends */
bool speed_shift_is_fixed(const System *system, int speed)
{
    const int node = speed_node(system, speed);
    const int slide_node = system->kinematics->speeds[speed].slide_node;
    const Frame *frame = &system->kinematics->frames[node];

    return system->dynamics->elastics.count == 0 && (slide_node < 0 || slide_node == node) &&
           (frame->base != node || vec_is_zero(frame->step));
}

bool speed_moves_as_one(const System *system, int speed)
{
    const Tree *translation = system->origin->trees[TREE_TRANSLATION];
    const Tree *rotation = system->origin->trees[TREE_ROTATION];
    const int node = speed_node(system, speed), branch = tree_parent_edge(translation, node);
    int carried, turned;
    const int *beyond;

    if (branch != tree_parent_edge(rotation, node) || !speed_shift_is_fixed(system, speed))
        return false;
    (void)tree_nodes_beyond(rotation, branch, &turned);
    beyond = tree_nodes_beyond(translation, branch, &carried);
    for (int i = 0; i < carried; i++)
        if (!tree_is_beyond(rotation, branch, beyond[i]))
            return false;
    return carried == turned;
}

/* inertia of a mass m with first moment S, shifted by r: (2 r.S + m r.r) 1 - r S' - S r' - m r
 * r'; in a plane its last entry alone */
static Rotation shifted(const System *system, const Composite *part, Vec r)
{
    Arena *arena = system->arena;
    Expr two = expr_int(arena, 2);
    Expr round = expr_add(arena, expr_mul(arena, two, vec_dot(arena, r, part->moment)),
                          expr_mul(arena, part->mass, vec_dot(arena, r, r)));
    Rotation inertia = part->inertia;

    for (int i = system->origin->planar ? 2 : 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            Expr terms[5] = {
                inertia.at[3 * i + j],
                i == j ? round : expr_int(arena, 0),
                expr_neg(arena, expr_mul(arena, r.at[i], part->moment.at[j])),
                expr_neg(arena, expr_mul(arena, part->moment.at[i], r.at[j])),
                expr_neg(arena, expr_product(arena, (Expr[]){part->mass, r.at[i], r.at[j]}, 3)),
            };

            inertia.at[3 * i + j] = inertia.at[3 * j + i] = expr_sum(arena, terms, 5);
        }
    return inertia;
}

/* a tensor in other axes: its columns, then its rows */
static Rotation tensor_express(const System *system, Rotation tensor, int from, int to)
{
    for (int pass = 0; pass < 2 && from != to; pass++) {
        Rotation turned;

        for (int j = 0; j < 3; j++) {
            Vec column = {{tensor.at[j], tensor.at[3 + j], tensor.at[6 + j]}};

            column = vec_carry(system, column, from, to);
            for (int i = 0; i < 3; i++)
                turned.at[3 * j + i] = column.at[i]; /* transposed, so that rows are next */
        }
        tensor = turned;
    }
    return tensor;
}

/* the instance whose composite equals that of the first instance, when that instance is all there
 * is */
static const Follower *follows_whole(const System *system, int node, int *first)
{
    const Follower *follower = isomorphic_node(system, node, first);

    return follower != NULL && isomorphic_ends(follower) ? follower : NULL;
}

Composite composite_at(const System *system, const Composites *all, int node)
{
    int first;
    const Follower *follower = all->is_known[node] ? NULL : follows_whole(system, node, &first);
    Composite own;

    if (follower == NULL)
        return all->at[node];
    /* the first may follow another one, nested as deep as the definitions are */
    own = composite_at(system, all, first);
    own.mass = isomorphic_take(follower, own.mass);
    own.moment = isomorphic_vec(follower, own.moment);
    for (int k = 0; k < 9; k++)
        own.inertia.at[k] = isomorphic_take(follower, own.inertia.at[k]);
    all->at[node] = own;
    all->is_known[node] = true;
    return own;
}

static bool is_nothing(const Composite *part)
{
    for (int k = 0; k < 9; k++)
        if (!expr_is_zero(part->inertia.at[k]))
            return false;
    return expr_is_zero(part->mass) && vec_is_zero(part->moment);
}

/* composites of the masses alone, and their keys */
static void place_masses(const System *system, Composites *all)
{
    Arena *arena = system->arena;
    int nodes;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    Rotation none;

    for (int i = 0; i < 9; i++)
        none.at[i] = expr_int(arena, 0);
    for (int i = 0; i < nodes; i++)
        all->at[order[i]] = (Composite){expr_int(arena, 0), vec_zero(arena), none};
    for (int i = 0; i < system->dynamics->masses.count; i++) {
        const Mass *mass = &system->dynamics->masses.at[i];
        const Frame *frame = &system->kinematics->frames[mass->node];
        Composite *own = &all->at[mass->node];
        Key key = key_of(system->kinematics->chains.at[0].identity);
        int first;

        own->mass = expr_add(arena, own->mass, mass->mass);
        own->inertia =
            tensor_express(system, mass->inertia, frame->chain, node_axes(system, mass->node));
        key_add(&key, own, sizeof *own);
        if (isomorphic_node(system, mass->node, &first) != NULL)
            key_add(&key, &system->kinematics->frames[first].identity, sizeof(Expr));
        all->key[mass->node] = key_end(system, &key);
    }
}

/* what is passed on inward from the nodes, and to which node */
typedef struct Passing {
    const int *place;
    bool *moves; /* a node */
    int *inward, count;
} Passing;

/* what is fixed to the datum moves nothing */
static bool passes_on(const System *system, const Passing *passing, int node)
{
    return passing->moves[system->kinematics->frames[node].parent] &&
           (passing->place == NULL || passing->place[node] < 0);
}

static void recall_composites(const System *system, const Passing *passing, Composites *all)
{
    int first;

    for (int i = 0; i < passing->count; i++) {
        const int node = passing->inward[i], parent = system->kinematics->frames[node].parent;

        all->is_known[node] = follows_whole(system, node, &first) == NULL &&
                              derived_recall(system, all->key[node], DERIVED_COMPOSITE,
                                             &all->at[node], sizeof all->at[node]);
        if (passes_on(system, passing, node))
            all->key[parent] =
                key_join(system, system->kinematics->chains.at[0].identity, all->key[parent],
                         PASSED_WHOLE, key_passed(system, node, all->key[node]));
    }
}

/* adds the composite at the node to that of its parent */
static void pass_on(const System *system, Composites *all, int node)
{
    Arena *arena = system->arena;
    const Frame *frame = &system->kinematics->frames[node];
    const int axes = node_axes(system, node), onto = node_axes(system, frame->parent);
    Composite part = composite_at(system, all, node), *whole = &all->at[frame->parent];

    if (is_nothing(&part))
        return;
    part.inertia = shifted(system, &part, frame->step);
    part.moment = vec_add(arena, part.moment, vec_scale(arena, part.mass, frame->step));
    part.moment = vec_carry(system, part.moment, axes, onto);
    part.inertia = tensor_express(system, part.inertia, axes, onto);
    whole->mass = expr_name_temporary(arena, expr_add(arena, whole->mass, part.mass));
    whole->moment = vec_hold(arena, vec_add(arena, whole->moment, part.moment));
    for (int k = 0; k < 9; k++)
        whole->inertia.at[k] =
            expr_name_temporary(arena, expr_add(arena, whole->inertia.at[k], part.inertia.at[k]));
}

Composites composites_new(const System *system, const int *place)
{
    const size_t count = (size_t)graph_node_count(system->origin->graph);
    Composites all = {.at = pool_alloc(system->pool, count * sizeof *all.at),
                      .key = pool_alloc(system->pool, count * sizeof *all.key),
                      .is_known = pool_alloc(system->pool, count * sizeof *all.is_known)};
    Passing passing = {.place = place, .moves = frames_moving(system)};
    int first;

    passing.inward = isomorphic_inward(system, TREE_TRANSLATION, &passing.count);
    place_masses(system, &all);
    recall_composites(system, &passing, &all);
    for (int i = 0; i < passing.count; i++) {
        const int node = passing.inward[i], parent = system->kinematics->frames[node].parent;
        const bool follows = follows_whole(system, node, &first) != NULL;

        if (!all.is_known[node] && !follows) {
            all.is_known[node] = true;
            derived_store(system, all.key[node], DERIVED_COMPOSITE, &all.at[node],
                          sizeof all.at[node]);
        }
        if (passes_on(system, &passing, node) && !all.is_known[parent] &&
            !(follows && follows_whole(system, parent, &first) != NULL))
            pass_on(system, &all, node);
    }
    MEM_FREE(passing.inward, passing.moves);
    return all;
}

void composite_loads(const System *system, Composite composite, int speed, Loads *loads)
{
    Arena *arena = system->arena;
    int node = speed_node(system, speed);
    int axes = node_axes(system, node);
    Vec slide = speed_slide(system, speed, axes);
    Vec force = vec_scale(arena, composite.mass, slide);
    Vec torque = vec_cross(arena, composite.moment, slide);

    if (system->kinematics->speeds[speed].chain >= 0) {
        Vec axis = speed_axis(system, speed, axes);

        force = vec_add(arena, force, vec_cross(arena, axis, composite.moment));
        torque = vec_add(arena, torque, rotation_apply(arena, &composite.inertia, axis));
    }
    loads->force[node] = force;
    loads->torque[node] = torque;
}
