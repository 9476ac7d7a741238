/* expanded_shapes.c: what flexible parts add to entries of the expanded form */
#include "formulate/dynamics/shapes.h"
#include "formulate/expanded/derivation_impl.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

/* the index of speed j among the shapes of a part; -1: it is none of them */
static int shape_of(const System *system, const Elastic *elastic, int j)
{
    const Instance *part = &system->origin->instances[elastic->instance];
    const int i = j - elastic->first;

    return i >= 0 && i < part->coord_count - part->pose_count ? i : -1;
}

/* Adds the terms of M_jk of an elastic part: with v, w the partial velocity of its root and its
 * partial angular velocity, v_j . m v_k + v_j . (w_k x S) + v_k . (w_j x S) + w_j . J w_k, and
 * those of shapes where j or k is the speed of one. */
void elastic_mass_terms(const System *system, const Elastic *elastic, int j, int k, Summands *terms)
{
    Arena *arena = system->arena;
    const ShapeInertia *b = &elastic->block;
    const int chain = system->kinematics->frames[elastic->node].chain;
    const FrameSum v_j = partial_velocity(system, elastic->node, j),
                   v_k = partial_velocity(system, elastic->node, k);
    const Vec w_j = partial_turn(system, chain, j), w_k = partial_turn(system, chain, k);
    const Vec moment = elastic_vector(system, elastic, b->moment);
    const Rotation inertia = elastic_inertia(system, elastic);
    const int own[2] = {shape_of(system, elastic, j), shape_of(system, elastic, k)};
    const FrameSum *other[2] = {&v_k, &v_j};
    const Vec *turned[2] = {&w_k, &w_j};

    LIST_PUSH(*terms, expr_mul(arena, b->mass, framesum_dot(system, v_j, v_k)));
    LIST_PUSH(*terms,
              framesum_dot(system, v_j, framesum_of(system, chain, vec_cross(arena, w_k, moment))));
    LIST_PUSH(*terms,
              framesum_dot(system, v_k, framesum_of(system, chain, vec_cross(arena, w_j, moment))));
    LIST_PUSH(*terms, vec_dot(arena, w_j, rotation_apply(arena, &inertia, w_k)));
    for (int s = 0; s < 2; s++) {
        if (own[s] < 0)
            continue;
        LIST_PUSH(*terms,
                  framesum_dot(system, *other[s],
                               framesum_of(system, chain,
                                           elastic_vector(system, elastic,
                                                          b->with_shift + (ptrdiff_t)3 * own[s]))));
        LIST_PUSH(*terms,
                  vec_dot(arena, *turned[s],
                          elastic_vector(system, elastic, b->with_turn + (ptrdiff_t)3 * own[s])));
    }
    if (own[0] >= 0 && own[1] >= 0) {
        const Instance *part = &system->origin->instances[elastic->instance];

        LIST_PUSH(*terms, b->block[own[0] * (part->coord_count - part->pose_count) + own[1]]);
    }
}

/* inertia at u' = 0, weight, elasticity and damping */
void elastic_force_terms(const System *system, const Elastic *elastic, int j, Summands *terms)
{
    Arena *arena = system->arena;
    const ShapeInertia *b = &elastic->block;
    const int chain = system->kinematics->frames[elastic->node].chain;
    const int own = shape_of(system, elastic, j);
    const FrameSum v_j = partial_velocity(system, elastic->node, j);
    const FrameSum rest =
        framesum_add(system, framesum_of(system, 0, system->origin->gravity), expr_int(arena, -1),
                     rest_acceleration(system, elastic->node));
    const Vec moment = elastic_vector(system, elastic, b->moment);
    const Vec turned = partial_turn(system, chain, j);
    const Rotation inertia = elastic_inertia(system, elastic);
    Vec w, alpha, torque, force;

    orientation_motion(system, chain, &w, &alpha);
    force = vec_add(arena, vec_cross(arena, alpha, moment),
                    elastic_vector(system, elastic, b->bias_force));
    torque = vec_add(arena, rotation_apply(arena, &inertia, alpha),
                     elastic_vector(system, elastic, b->bias_torque));
    LIST_PUSH(*terms, expr_mul(arena, b->mass, framesum_dot(system, v_j, rest)));
    LIST_PUSH(*terms,
              expr_neg(arena, framesum_dot(system, v_j, framesum_of(system, chain, force))));
    LIST_PUSH(
        *terms,
        framesum_dot(system, framesum_of(system, chain, vec_cross(arena, turned, moment)), rest));
    LIST_PUSH(*terms, expr_neg(arena, vec_dot(arena, turned, torque)));
    if (own < 0)
        return;
    LIST_PUSH(*terms, framesum_dot(system,
                                   framesum_of(system, chain,
                                               elastic_vector(system, elastic,
                                                              b->with_shift + (ptrdiff_t)3 * own)),
                                   rest));
    LIST_PUSH(*terms, expr_neg(arena, vec_dot(arena,
                                              elastic_vector(system, elastic,
                                                             b->with_turn + (ptrdiff_t)3 * own),
                                              alpha)));
    LIST_PUSH(*terms, expr_sub(arena, b->push[own], b->bias[own]));
}

Status elastic_load_terms(System *system, const Elastic *elastic, int j, int take, Summands *terms,
                          Diag *diag)
{
    const int node = elastic->node, chain = system->kinematics->frames[node].chain;
    const int resolve = system->kinematics->chains.at[chain].resolve;
    Loads loads = loads_new(system);

    TRY(elastic_add_load(system, elastic, take, &loads, diag));
    LIST_PUSH(*terms, framesum_dot(system, framesum_of(system, resolve, loads.force[node]),
                                   partial_velocity(system, node, j)));
    LIST_PUSH(*terms, framesum_dot(system, framesum_of(system, resolve, loads.torque[node]),
                                   framesum_of(system, chain, partial_turn(system, chain, j))));
    LIST_PUSH(*terms, loads.own[j]);
    return OK;
}
