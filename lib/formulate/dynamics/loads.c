/* loads.c: forces and moments of one pass, summed inward over both trees
 *
 * Each is resolved in the axes of its chain's `resolve` chain and held, so that a program computes
 * it once. */
#include "formulate/dynamics/loads.h"
#include "formulate/kinematics/alike.h"
#include "formulate/kinematics/frames.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

Loads loads_new(const System *system)
{
    int count = graph_node_count(system->origin->graph);
    const int speeds = system->kinematics->u.count;
    Loads loads = {pool_alloc(system->pool, (size_t)count * sizeof(Vec)),
                   pool_alloc(system->pool, (size_t)count * sizeof(Vec)),
                   pool_alloc(system->pool, (size_t)speeds * sizeof(Expr))};

    for (int i = 0; i < count; i++)
        loads.force[i] = loads.torque[i] = vec_zero(system->arena);
    for (int j = 0; j < speeds; j++)
        loads.own[j] = expr_int(system->arena, 0);
    return loads;
}

void loads_add_force(const System *system, Loads *loads, int node, Vec force, int chain)
{
    force = vec_carry(system, force, chain, node_axes(system, node));
    loads->force[node] = vec_add(system->arena, loads->force[node], force);
}

void loads_add_torque(const System *system, Loads *loads, int node, Vec torque, int chain)
{
    torque = vec_carry(system, torque, chain, node_axes(system, node));
    loads->torque[node] = vec_add(system->arena, loads->torque[node], torque);
}

/* Nodes of instances whose loads are those of the first: so are their sums. New, mem_free(). */
static bool *summed_alike(const System *system, const Loads *loads)
{
    const int count = graph_node_count(system->origin->graph);
    bool *alike = NEW_ARRAY(bool, count);

    for (int n = 0; n < count; n++) {
        int first;
        const Follower *follower = alike_node(system, n, &first);

        alike[n] = follower != NULL && alike_ends(follower) &&
                   vec_same(alike_vec(follower, loads->force[first]), loads->force[n]) &&
                   vec_same(alike_vec(follower, loads->torque[first]), loads->torque[n]);
    }
    /* all of an instance, or none of it */
    for (int n = 0; n < count; n++) {
        int first, members;
        const Follower *follower = alike_node(system, n, &first);
        const int *member = follower != NULL ? alike_members(follower, &members) : NULL;

        for (int k = 0; member != NULL && !alike[n] && k < members; k++)
            alike[member[k]] = false;
    }
    return alike;
}

/* what a node's is, given the first's */
static Vec as_first(const System *system, int node, const Vec *of)
{
    int first;
    const Follower *follower = alike_node(system, node, &first);

    return alike_vec(follower, of[first]);
}

Sums *loads_sum(const System *system, const Loads *loads)
{
    Arena *arena = system->arena;
    const Tree *rotation = system->origin->trees[TREE_ROTATION];
    size_t size = (size_t)graph_node_count(system->origin->graph) * sizeof(Vec);
    Sums *sums = pool_alloc(system->pool, sizeof *sums);
    int nodes;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    const int datum = order[0]; /* no branch leads there */
    bool *alike = summed_alike(system, loads);
    int *inward;

    sums->own = loads->own;
    sums->force = pool_alloc(system->pool, size);
    sums->torque = pool_alloc(system->pool, size);
    for (int i = 0; i < nodes; i++) {
        sums->force[order[i]] = loads->force[order[i]];
        sums->torque[order[i]] = loads->torque[order[i]];
    }
    inward = alike_inward(system, TREE_TRANSLATION, &nodes);
    for (int i = 0; i < nodes; i++) {
        int n = inward[i];
        const Frame *frame = &system->kinematics->frames[n];
        int axes = node_axes(system, n);

        if (alike[n])
            sums->force[n] = as_first(system, n, sums->force);
        if (alike[n] && alike[frame->parent])
            continue;
        /* most loads of a motion of few bodies are none */
        if (vec_is_zero(sums->force[n]))
            continue;

        Vec force = sums->force[n] = vec_hold(arena, sums->force[n]);
        Vec moment = vec_cross(arena, frame->step, force);

        if (frame->parent != datum) {
            force = vec_carry_held(system, force, axes, node_axes(system, frame->parent));
            sums->force[frame->parent] = vec_add(arena, sums->force[frame->parent], force);
        }
        /* a shift passes on the moment of what it carries to the frame that it is fixed in */
        if (frame->base == datum)
            continue;
        moment = vec_carry_held(system, moment, axes, node_axes(system, frame->base));
        sums->torque[frame->base] = vec_add(arena, sums->torque[frame->base], moment);
    }
    mem_free(inward);
    inward = alike_inward(system, TREE_ROTATION, &nodes);
    for (int i = 0; i < nodes; i++) {
        int n = inward[i];
        int parent = tree_parent(rotation, n);

        if (alike[n])
            sums->torque[n] = as_first(system, n, sums->torque);
        if (alike[n] && alike[parent])
            continue;
        if (vec_is_zero(sums->torque[n]))
            continue;

        Vec torque = sums->torque[n] = vec_hold(arena, sums->torque[n]);

        if (parent == datum)
            continue;
        torque = vec_carry_held(system, torque, node_axes(system, n), node_axes(system, parent));
        sums->torque[parent] = vec_add(arena, sums->torque[parent], torque);
    }
    MEM_FREE(inward, alike);
    return sums;
}
