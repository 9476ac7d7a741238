/* loads.c: forces and moments of one pass, summed inward over both trees
 *
 * Each is resolved in the axes of its orientation class's `resolve` class, as a named temporary: a
 * program computes it once. */
#include "formulate/dynamics/loads.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/identity.h"
#include "formulate/kinematics/isomorphic.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

Loads loads_new(const System *system)
{
    int count = graph_node_count(system->origin->graph);
    const int speeds = system->kinematics->u.count;
    Loads loads = {.force = pool_alloc(system->pool, (size_t)count * sizeof(Vec)),
                   .torque = pool_alloc(system->pool, (size_t)count * sizeof(Vec)),
                   .own = pool_alloc(system->pool, (size_t)speeds * sizeof(Expr))};

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

/* --- sums --- */

typedef struct Summing {
    const System *system;
    Sums *sums;
    int *forces, *torques; /* inward order of the nodes in each tree, without the datum */
    int force_count, torque_count;
    /* one for each node */
    bool *asks_force, *asks_torque; /* the sum is needed */
    /* identity of the sum at a node; NULL: no load, or unknown identity */
    Expr *force_key, *torque_key;
    bool *knows_force, *knows_torque; /* the sum was recalled, or is 0 */
    bool *alike;                      /* the sums equal those of the first instance */
} Summing;

enum { FORCE, TORQUE };

static Expr load_key(const Summing *s, int node, int what, Vec load)
{
    const System *system = s->system;
    const Expr of[] = {expr_int(system->arena, what), expr_int(system->arena, s->alike[node])};
    Key key = key_of(system->kinematics->frames[node].identity);

    key_add(&key, of, sizeof of);
    key_add(&key, &load, sizeof load);
    return vec_is_zero(load) ? NULL : key_end(system, &key);
}

static bool recall_sum(const System *system, int node, Expr key, Derived which, Vec *sum)
{
    if (system->kinematics->frames[node].identity == NULL)
        return false;
    return key == NULL || derived_recall(system, key, which, sum, sizeof *sum);
}

static void recall_forces(Summing *s)
{
    const System *system = s->system;
    const Frame *frames = system->kinematics->frames;

    for (int i = 0; i < s->force_count; i++) {
        const int n = s->forces[i], parent = frames[n].parent, base = frames[n].base;

        if (!s->asks_force[n])
            continue;
        s->knows_force[n] = !s->alike[n] && recall_sum(system, n, s->force_key[n], DERIVED_FORCE,
                                                       &s->sums->force[n]);
        if (s->asks_force[parent])
            s->force_key[parent] = key_join(system, frames[parent].identity, s->force_key[parent],
                                            PASSED_FORCE, s->force_key[n]);
        if (s->asks_torque[base])
            s->torque_key[base] = key_join(system, frames[base].identity, s->torque_key[base],
                                           PASSED_MOMENT, s->force_key[n]);
    }
}

static void recall_torques(Summing *s)
{
    const System *system = s->system;

    for (int i = 0; i < s->torque_count; i++) {
        const int n = s->torques[i], parent = tree_parent(system->origin->trees[TREE_ROTATION], n);

        if (!s->asks_torque[n])
            continue;
        s->knows_torque[n] = !s->alike[n] && recall_sum(system, n, s->torque_key[n], DERIVED_TORQUE,
                                                        &s->sums->torque[n]);
        if (s->asks_torque[parent])
            s->torque_key[parent] =
                key_join(system, system->kinematics->frames[parent].identity, s->torque_key[parent],
                         PASSED_TORQUE, s->torque_key[n]);
    }
}

/* the loads on all of an instance equal those of the first */
static bool loaded_alike(const System *system, const Follower *follower, const Loads *loads)
{
    int count, first;
    const int *members = isomorphic_members(follower, &count);
    bool alike = isomorphic_ends(follower);

    for (int k = 0; alike && k < count; k++) {
        (void)isomorphic_node(system, members[k], &first);
        alike = vec_same(isomorphic_vec(follower, loads->force[first]), loads->force[members[k]]) &&
                vec_same(isomorphic_vec(follower, loads->torque[first]), loads->torque[members[k]]);
    }
    return alike;
}

/* Finds instances whose sums equal those of the first, at all or none of their nodes: these are
 * renamed and not recalled, as in a System without an earlier one. */
static void find_alike(const Summing *s, const Loads *loads)
{
    const int count = graph_node_count(s->system->origin->graph);
    bool *asked = NEW_ARRAY(bool, count), alike;

    for (int n = 0; n < count; n++) {
        int first, members;
        const Follower *follower = isomorphic_node(s->system, n, &first);
        const int *member;

        if (follower == NULL || asked[n] || !(s->asks_force[n] || s->asks_torque[n]))
            continue;
        member = isomorphic_members(follower, &members);
        for (int k = 0; k < members; k++)
            asked[member[k]] = true;
        alike = loaded_alike(s->system, follower, loads);
        for (int k = 0; k < members; k++)
            s->alike[member[k]] = alike;
    }
    mem_free(asked);
}

typedef struct Carried {
    Vec force, moment; /* in the axes of the parent and of the base */
} Carried;

/* a shift transfers the moment of all loads beyond it to the frame that it is fixed in */
static void pass_force(const Summing *s, int n)
{
    const System *system = s->system;
    const Frame *frame = &system->kinematics->frames[n];
    const Vec force = s->sums->force[n];
    const int axes = node_axes(system, n);
    Vec *onto = &s->sums->force[frame->parent], *about = &s->sums->torque[frame->base];
    const bool adds = s->asks_force[frame->parent] && !s->knows_force[frame->parent];
    const bool turns = s->asks_torque[frame->base] && !s->knows_torque[frame->base];
    Carried passed;

    if (!adds && !turns)
        return;
    if (!derived_recall(system, s->force_key[n], DERIVED_PASSED, &passed, sizeof passed)) {
        passed.force = vec_carry_held(system, force, axes, node_axes(system, frame->parent));
        passed.moment = vec_carry_held(system, vec_cross(system->arena, frame->step, force), axes,
                                       node_axes(system, frame->base));
        derived_store(system, s->force_key[n], DERIVED_PASSED, &passed, sizeof passed);
    }
    if (adds)
        *onto = vec_add(system->arena, *onto, passed.force);
    if (turns)
        *about = vec_add(system->arena, *about, passed.moment);
}

static void pass_torque(const Summing *s, int n, int parent)
{
    const System *system = s->system;
    Vec passed;

    if (!s->asks_torque[parent] || s->knows_torque[parent])
        return;
    if (!derived_recall(system, s->torque_key[n], DERIVED_TURNED, &passed, sizeof passed)) {
        passed = vec_carry_held(system, s->sums->torque[n], node_axes(system, n),
                                node_axes(system, parent));
        derived_store(system, s->torque_key[n], DERIVED_TURNED, &passed, sizeof passed);
    }
    s->sums->torque[parent] = vec_add(system->arena, s->sums->torque[parent], passed);
}

/* completes the sum at a node after all loads beyond have been added, unless it is known */
static void end_sum(const Summing *s, int n, bool is_known, Expr key, Derived which, Vec *of)
{
    if (is_known)
        return;
    if (s->alike[n]) {
        int first;
        const Follower *follower = isomorphic_node(s->system, n, &first);

        of[n] = isomorphic_vec(follower, of[first]);
        return;
    }
    of[n] = vec_hold(s->system->arena, of[n]);
    derived_store(s->system, key, which, &of[n], sizeof of[n]);
}

static void sum_forces(const Summing *s)
{
    for (int i = 0; i < s->force_count; i++) {
        const int n = s->forces[i], parent = s->system->kinematics->frames[n].parent;

        if (!s->asks_force[n])
            continue;
        end_sum(s, n, s->knows_force[n], s->force_key[n], DERIVED_FORCE, s->sums->force);
        /* for a motion of few bodies most loads are 0 */
        if (!(s->alike[n] && s->alike[parent]) && !vec_is_zero(s->sums->force[n]))
            pass_force(s, n);
    }
}

static void sum_torques(const Summing *s)
{
    for (int i = 0; i < s->torque_count; i++) {
        const int n = s->torques[i],
                  parent = tree_parent(s->system->origin->trees[TREE_ROTATION], n);

        if (!s->asks_torque[n])
            continue;
        end_sum(s, n, s->knows_torque[n], s->torque_key[n], DERIVED_TORQUE, s->sums->torque);
        if (!(s->alike[n] && s->alike[parent]) && !vec_is_zero(s->sums->torque[n]))
            pass_torque(s, n, parent);
    }
}

/* no joint leads to the datum; a turn belongs to the orientation class, whatever its nodes */
static void find_asked(Summing *s, SumsFor whom)
{
    const System *system = s->system;
    const int *order;
    int nodes;

    s->asks_force = frames_moving(system);
    s->asks_torque = NEW_ARRAY(bool, graph_node_count(system->origin->graph));
    order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    for (int i = 1; i < nodes; i++) {
        const int n = order[i];

        s->asks_force[n] = s->asks_force[n] || whom == SUMS_FOR_JOINTS;
        s->asks_torque[n] = whom == SUMS_FOR_JOINTS || system->kinematics->frames[n].chain != 0;
    }
}

Sums *loads_sum(const System *system, const Loads *loads, SumsFor whom)
{
    const int count = graph_node_count(system->origin->graph);
    const size_t size = (size_t)count * sizeof(Vec);
    Sums *sums = pool_alloc(system->pool, sizeof *sums);
    int nodes;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    Summing s = {.system = system,
                 .sums = sums,
                 .force_key = NEW_ARRAY(Expr, count),
                 .torque_key = NEW_ARRAY(Expr, count),
                 .knows_force = NEW_ARRAY(bool, count),
                 .knows_torque = NEW_ARRAY(bool, count),
                 .alike = NEW_ARRAY(bool, count)};

    find_asked(&s, whom);
    find_alike(&s, loads);
    sums->own = loads->own;
    sums->tied = loads->tied;
    sums->force = pool_alloc(system->pool, size);
    sums->torque = pool_alloc(system->pool, size);
    for (int i = 0; i < nodes; i++) {
        const int n = order[i];

        sums->force[n] = loads->force[n];
        sums->torque[n] = loads->torque[n];
        if (s.asks_force[n])
            s.force_key[n] = load_key(&s, n, FORCE, loads->force[n]);
        if (s.asks_torque[n])
            s.torque_key[n] = load_key(&s, n, TORQUE, loads->torque[n]);
    }
    s.forces = isomorphic_inward(system, TREE_TRANSLATION, &s.force_count);
    s.torques = isomorphic_inward(system, TREE_ROTATION, &s.torque_count);
    recall_forces(&s);
    recall_torques(&s);
    sum_forces(&s);
    sum_torques(&s);
    MEM_FREE(s.asks_force, s.asks_torque, s.forces, s.torques, s.force_key, s.torque_key,
             s.knows_force, s.knows_torque, s.alike);
    return sums;
}

void loads_add_between(System *system, Loads *loads, const Instance *owner, Vec force, Vec torque)
{
    Arena *arena = system->arena;
    const int chain = system->kinematics->frames[owner->tail].chain;
    const Vec way = node_way(system, owner->tail, owner->head);

    loads_add_force(system, loads, owner->head, force, chain);
    loads_add_force(system, loads, owner->tail, vec_neg(arena, force), chain);
    if (!vec_is_zero(torque)) {
        loads_add_torque(system, loads, owner->head, torque, chain);
        loads_add_torque(system, loads, owner->tail, vec_neg(arena, torque), chain);
    }
    /* the force on the tail acts at the head's position */
    force = vec_express(system, force, chain, 0);
    loads_add_torque(system, loads, owner->tail, vec_neg(arena, vec_cross(arena, way, force)), 0);
}

void loads_add_shift(System *system, Loads *loads, const Instance *owner, const Step *shift,
                     Expr effort)
{
    const Vec along = {{shift->axis[0], shift->axis[1], shift->axis[2]}};

    loads_add_between(system, loads, owner,
                      vec_scale(system->arena, effort, frame_vector(system, owner->tail, along)),
                      vec_zero(system->arena));
}
