/* recursive.c: motion outward, for the recursive form
 *
 * Each quantity is resolved in the axes of its orientation class's `resolve` class, as a named
 * temporary: a program computes it once. From the parent p to the child, with the axis k of a turn,
 * a slide along s' (its rate u) and r from p to the child: w = w_p + k rate (rad/s) and v = v_p + w
 * x r + s' u (m/s), all 3 x 1. */
#include "formulate/kinematics/recursive.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/identity.h"
#include "formulate/kinematics/isomorphic.h"
#include "formulate/kinematics/section_frames.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <string.h>

enum { MANY_TURNS = 20 }; /* number of turns from the datum */

/* whether an orientation class turns as that of the first instance; outside it is the same class */
static bool turns_alike(const System *system, Follower *follower, int chain)
{
    const OrientationMotion *motion = &system->kinematics->motions[chain];
    int first;

    return isomorphic_chain(system, chain, &first) == follower
               ? isomorphic_moves(follower)
               : isomorphic_hangs(follower, motion->w, motion->w);
}

/* w = w_parent + k rate; its rate is alpha_parent + w_parent x k rate + k rate' */
static OrientationMotion turn_motion(const System *system, int c)
{
    Arena *arena = system->arena;
    const OrientationClass *chain = &system->kinematics->chains.at[c];
    int before = system->kinematics->chains.at[chain->parent].resolve;
    const OrientationMotion *motions = system->kinematics->motions;
    Vec turn = vec_zero(arena);
    Vec w;

    w = vec_carry_held(system, motions[chain->parent].w, before, chain->resolve);

    for (int j = chain->speed; j < chain->speed + chain->speed_count; j++)
        turn =
            vec_add(arena, turn,
                    vec_scale(arena, speed_rate(system, j), speed_axis(system, j, chain->resolve)));
    return (OrientationMotion){vec_hold(arena, vec_add(arena, w, turn)),
                               vec_hold(arena, vec_cross(arena, w, turn))};
}

/* From the first's, or recalled, or derived. */
static void find_turn_motion(const System *system, int c)
{
    const OrientationClass *chain = &system->kinematics->chains.at[c];
    OrientationMotion *motions = system->kinematics->motions;
    int first;
    Follower *follower = isomorphic_chain(system, c, &first);
    const bool is_alike = follower != NULL && turns_alike(system, follower, chain->parent);

    if (is_alike) {
        motions[c] = (OrientationMotion){isomorphic_vec(follower, motions[first].w),
                                         isomorphic_vec(follower, motions[first].product)};
        return;
    }
    if (derived_recall(system, chain->identity, DERIVED_TURN, &motions[c], sizeof motions[c]))
        return;
    motions[c] = turn_motion(system, c);
    derived_store(system, chain->identity, DERIVED_TURN, &motions[c], sizeof motions[c]);
}

/* whether a node moves as that of the first; its parent's motion and its own are known */
static bool moves_alike(const System *system, Follower *follower, int node, Vec from, Vec to)
{
    int first;

    if (follower == NULL)
        return false;
    if (isomorphic_node(system, system->kinematics->frames[node].parent, &first) == follower)
        return isomorphic_moves(follower);
    return isomorphic_hangs(follower, from, to);
}

typedef struct StepMotion { /* as in Frame */
    Vec step, v, product;
} StepMotion;

/* v = v_parent + w x r + s' u; the velocity products of its rate are w x (w x r) + 2 w x s' u */
static StepMotion step_motion(const System *system, int node)
{
    Arena *arena = system->arena;
    const Frame *frames = system->kinematics->frames, *frame = &frames[node];
    int axes = node_axes(system, node);
    int resolve = system->kinematics->chains.at[frame->step_chain].resolve;
    StepMotion motion;
    Vec slid = vec_zero(arena);
    Vec v, w, turned;

    v = vec_carry_held(system, frames[frame->parent].v, node_axes(system, frame->parent), axes);
    w = vec_carry_held(system, system->kinematics->motions[frame->step_chain].w, resolve, axes);
    motion.step = vec_carry_held(system, frame->shift, frame->step_chain, axes);
    turned = vec_cross(arena, w, motion.step);
    for (int k = 0; k < frame->slide_count; k++) {
        Vec axis = vec_express(system, frame->slide[k].axis, frame->step_chain, axes);
        Expr rate = speed_rate(system, frame->slide[k].speed);

        slid = vec_add(arena, slid, vec_scale(arena, rate, axis));
    }
    motion.v = vec_hold(arena, vec_add(arena, v, vec_add(arena, turned, slid)));
    motion.product = vec_add(arena, vec_cross(arena, w, turned),
                             vec_scale(arena, expr_int(arena, 2), vec_cross(arena, w, slid)));
    return motion;
}

static void find_step_motion(System *system, int node)
{
    Frame *frame = &system->kinematics->frames[node];
    int first = node;
    Follower *follower = isomorphic_node(system, node, &first);
    const Frame *frames = system->kinematics->frames, *like = &frames[first];
    const bool is_alike =
        follower != NULL && turns_alike(system, follower, frame->step_chain) &&
        moves_alike(system, follower, node, frames[like->parent].v, frames[frame->parent].v);
    StepMotion motion;

    if (is_alike) {
        motion =
            (StepMotion){isomorphic_vec(follower, like->step), isomorphic_vec(follower, like->v),
                         isomorphic_vec(follower, like->product)};
    } else if (!derived_recall(system, frame->identity, DERIVED_STEP, &motion, sizeof motion)) {
        motion = step_motion(system, node);
        derived_store(system, frame->identity, DERIVED_STEP, &motion, sizeof motion);
    }
    frame->step = motion.step;
    frame->v = motion.v;
    frame->product = motion.product;
}

/* a = a_parent + alpha x r + the velocity products + s' u' */
static Vec node_acceleration(const System *system, int n, const Expr *accelerations,
                             const Vec *alpha, const Vec *a)
{
    Arena *arena = system->arena;
    const Frame *frame = &system->kinematics->frames[n];
    int axes = node_axes(system, n);
    int resolve = system->kinematics->chains.at[frame->step_chain].resolve;
    Vec turn, own;

    turn = vec_carry_held(system, alpha[frame->step_chain], resolve, axes);
    own = vec_carry_held(system, a[frame->parent], node_axes(system, frame->parent), axes);
    own = vec_add(arena, own, vec_cross(arena, turn, frame->step));
    own = vec_add(arena, own, frame->product);
    for (int k = 0; k < frame->slide_count; k++) {
        Expr rate = speed_acceleration(system, frame->slide[k].speed, accelerations);

        if (!expr_is_zero(rate))
            own = vec_add(
                arena, own,
                vec_scale(arena, rate,
                          vec_express(system, frame->slide[k].axis, frame->step_chain, axes)));
    }
    return vec_hold(arena, own);
}

static Vec orientation_acceleration(const System *system, int c, const Expr *accelerations,
                                    const Vec *alpha)
{
    Arena *arena = system->arena;
    const OrientationClass *chain = &system->kinematics->chains.at[c];
    int before = system->kinematics->chains.at[chain->parent].resolve;
    Vec own = vec_add(arena, vec_carry_held(system, alpha[chain->parent], before, chain->resolve),
                      system->kinematics->motions[c].product);

    for (int j = chain->speed; j < chain->speed + chain->speed_count; j++)
        own = vec_add(arena, own,
                      vec_scale(arena, speed_acceleration(system, j, accelerations),
                                speed_axis(system, j, chain->resolve)));
    return vec_hold(arena, own);
}

/* angular acceleration of an orientation class at u' = 0: from the first's, recalled, or derived */
static Vec orientation_rest(const System *system, int c, const Vec *alpha)
{
    const OrientationClass *chain = &system->kinematics->chains.at[c];
    int first, around;
    Follower *follower = isomorphic_chain(system, c, &first);
    const bool is_alike =
        follower != NULL &&
        (isomorphic_chain(system, chain->parent, &around) == follower
             ? isomorphic_moves(follower)
             : isomorphic_hangs(follower, alpha[chain->parent], alpha[chain->parent]));
    Vec rest;

    if (is_alike) {
        rest = isomorphic_vec(follower, alpha[first]);
        return rest;
    }
    if (derived_recall(system, chain->identity, DERIVED_TURN_REST, &rest, sizeof rest))
        return rest;
    rest = orientation_acceleration(system, c, NULL, alpha);
    derived_store(system, chain->identity, DERIVED_TURN_REST, &rest, sizeof rest);
    return rest;
}

/* the same for a node */
static Vec node_rest(const System *system, int n, const Vec *alpha, const Vec *a)
{
    const Frame *frames = system->kinematics->frames, *frame = &frames[n];
    int first = n;
    Follower *follower = isomorphic_node(system, n, &first);
    const bool is_alike =
        moves_alike(system, follower, n, a[frames[first].parent], a[frame->parent]);
    Vec rest;

    if (is_alike) {
        rest = isomorphic_vec(follower, a[first]);
        return rest;
    }
    if (derived_recall(system, frame->identity, DERIVED_STEP_REST, &rest, sizeof rest))
        return rest;
    rest = node_acceleration(system, n, NULL, alpha, a);
    derived_store(system, frame->identity, DERIVED_STEP_REST, &rest, sizeof rest);
    return rest;
}

void accelerations_build(const System *system, const Expr *accelerations, Vec *alpha, Vec *a)
{
    int nodes;
    const int *order;

    alpha[0] = vec_zero(system->arena);
    for (int c = 1; c < system->kinematics->chains.count; c++)
        alpha[c] = accelerations == NULL
                       ? orientation_rest(system, c, alpha)
                       : orientation_acceleration(system, c, accelerations, alpha);
    if (system->origin->trees[TREE_TRANSLATION] == NULL)
        return;
    order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    a[order[0]] = vec_zero(system->arena);
    for (int i = 1; i < nodes; i++)
        a[order[i]] = accelerations == NULL
                          ? node_rest(system, order[i], alpha, a)
                          : node_acceleration(system, order[i], accelerations, alpha, a);
}

void node_moved(System *shadow, int node)
{
    /* it is no longer a frame of the model */
    shadow->kinematics->frames[node].identity = NULL;
    find_step_motion(shadow, node);
    shadow->kinematics->a0[node] =
        node_rest(shadow, node, shadow->kinematics->alpha0, shadow->kinematics->a0);
}

void motion_build(System *system)
{
    Arena *arena = system->arena;
    size_t chains = (size_t)system->kinematics->chains.count;
    int nodes;
    const int *order;

    system->kinematics->motions =
        pool_alloc(system->pool, chains * sizeof *system->kinematics->motions);
    system->kinematics->alpha0 = pool_alloc(system->pool, chains * sizeof(Vec));
    system->kinematics->a0 =
        pool_alloc(system->pool, (size_t)graph_node_count(system->origin->graph) * sizeof(Vec));
    system->kinematics->motions[0] = (OrientationMotion){vec_zero(arena), vec_zero(arena)};
    for (int c = 1; c < system->kinematics->chains.count; c++)
        find_turn_motion(system, c);
    if (system->origin->trees[TREE_TRANSLATION] == NULL)
        return;
    order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    for (int i = 0; i < nodes; i++) {
        Frame *frame = &system->kinematics->frames[order[i]];

        frame->step = frame->v = frame->product = vec_zero(arena);
        if (frame->parent >= 0)
            find_step_motion(system, order[i]);
    }
    accelerations_build(system, NULL, system->kinematics->alpha0, system->kinematics->a0);
}

/* those formed so far; a view starts with those that building the System needed */
static Vec *positions_of(System *system)
{
    Vec **positions = &system->shown->positions;
    const System *formed = system->formed;
    size_t count = (size_t)graph_node_count(system->origin->graph);

    mem_keep(*positions);
    if (*positions != NULL)
        return *positions;
    *positions = NEW_ARRAY(Vec, count);
    if (formed != NULL && formed->shown->positions != NULL)
        memcpy(*positions, formed->shown->positions, count * sizeof(Vec));
    return *positions;
}

/* x, y and z of the datum in the axes of every orientation class */
static const Vec *datum_axes(System *system)
{
    const int chains = system->kinematics->chains.count;
    Vec **axes = &system->shown->datum_axes;

    if (*axes != NULL)
        return *axes;
    *axes = NEW_ARRAY(Vec, 3 * chains);
    for (int k = 0; k < 3; k++) {
        Vec unit = vec_zero(system->arena);

        unit.at[k] = expr_int(system->arena, 1);
        vec_express_outward(system, unit, *axes + (ptrdiff_t)k * chains);
    }
    return *axes;
}

/* v in the axes of the datum. Beyond many turns it uses x, y and z of the datum in the axes there:
 * the result contains each turn once, and not once for each shift beyond it. */
static Vec in_datum(System *system, Vec v, int chain)
{
    const OrientationClass *chains = system->kinematics->chains.at;
    const Vec *axes;
    Vec out;

    if (chains[chain].depth < MANY_TURNS || chains[chain].resolve != chain)
        return vec_hold(system->arena, vec_express(system, v, chain, 0));
    axes = datum_axes(system) + chain;
    for (int k = 0; k < 3; k++)
        out.at[k] =
            vec_dot(system->arena, axes[(ptrdiff_t)k * system->kinematics->chains.count], v);
    return vec_hold(system->arena, out);
}

Vec node_position(System *system, int node)
{
    Arena *arena = system->arena;
    const Frame *frames = system->kinematics->frames;
    Vec *positions = positions_of(system);
    LIST(int) way = {0};
    Vec p;

    /* outward from the last node on the path whose position is known */
    while (frames[node].parent >= 0 && positions[node].at[0] == NULL) {
        LIST_PUSH(way, node);
        node = frames[node].parent;
    }
    p = frames[node].parent >= 0 ? positions[node] : vec_zero(arena);
    for (int k = way.count - 1; k >= 0; k--) {
        const Frame *frame = &frames[way.at[k]];

        p = vec_hold(arena, vec_add(arena, p, in_datum(system, frame->shift, frame->step_chain)));
        positions[way.at[k]] = p;
    }
    LIST_FREE(way);
    return p;
}

Vec node_way(System *system, int from, int to)
{
    return vec_sub(system->arena, node_position(system, to), node_position(system, from));
}

Vec node_turn_rate(const System *system, int node, int axes)
{
    const int chain = system->kinematics->frames[node].chain;

    return vec_express(system, system->kinematics->motions[chain].w,
                       system->kinematics->chains.at[chain].resolve, axes);
}
