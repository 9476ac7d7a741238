/* shapes.c: local blocks of flexible parts (theory 9)
 *
 * For the acceleration a (m/s^2) and angular acceleration alpha (rad/s^2) of the root and the shape
 * coordinates q, in the axes of the root, the inertia loads are
 *
 *     force   m a + alpha x s + sum_i h_i q_i''
 *     torque  s x a + J alpha + sum_i t_i q_i''
 *     on q_j  h_j.a + t_j.alpha + sum_i B_ji q_i''
 *
 * with mass m, first moment s (3 x 1), inertia J (3 x 3), coupling vectors h_i and t_i (3 x 1) and
 * the block B (shapes x shapes); terms at zero acceleration are added separately. */
#include "formulate/dynamics/shapes.h"
#include "formulate/dynamics/laws.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <string.h>

static Expr *new_array(const System *system, int count)
{
    return pool_alloc(system->pool, (size_t)count * sizeof(Expr));
}

/* --- local blocks --- */

static void hold_all(const System *system, Expr *at, int count)
{
    for (int i = 0; i < count; i++)
        at[i] = expr_name_temporary(system->arena, at[i]);
}

Vec elastic_vector(const System *system, const Elastic *elastic, const Expr in_root[3])
{
    return frame_vector(system, elastic->node, (Vec){{in_root[0], in_root[1], in_root[2]}});
}

/* components in the root's frame of a vector in the node's axes */
static Vec to_root(const System *system, const Elastic *elastic, Vec v)
{
    const Frame *frame = &system->kinematics->frames[elastic->node];
    const int resolve = system->kinematics->chains.at[frame->chain].resolve;
    const Rotation back = rotation_transpose(&frame->zero);

    v = vec_express(system, v, resolve, frame->chain);
    return vec_hold(system->arena, rotation_apply(system->arena, &back, v));
}

Rotation elastic_inertia(const System *system, const Elastic *elastic)
{
    const Rotation *zero = &system->kinematics->frames[elastic->node].zero;
    const Rotation back = rotation_transpose(zero);
    Rotation inertia;

    for (int i = 0; i < 9; i++)
        inertia.at[i] = elastic->block.inertia[i];
    inertia = rotation_product(system->arena, zero, &inertia);
    return rotation_product(system->arena, &inertia, &back);
}

Elastic elastic_beyond(const System *system, const Elastic *elastic, Expr from)
{
    const Instance *part = &system->origin->instances[elastic->instance];
    const int count = shapes_of(part), powers = elastic->load_powers;
    Elastic out = *elastic;
    ShapeInertia *block = &out.block;
    ShapeState state = shapes_state(system, part);
    const Vec w =
        to_root(system, elastic,
                system->kinematics->motions[system->kinematics->frames[part->head].chain].w);

    for (int k = 0; k < 3; k++)
        state.w[k] = w.at[k];
#define NEW_ROW(name, entries) block->name = new_array(system, entries);
    SHAPE_ARRAYS_OF_SHAPES(NEW_ROW)
    SHAPE_ARRAYS_OF_LOAD(NEW_ROW)
    NEW_ROW(load, 3 * powers)
    part->row->deforming->inertia(part, system->arena, system->origin->planar, from, &state, block);
#define HOLD_ROW(name, entries) hold_all(system, block->name, entries);
    SHAPE_ARRAYS_OF_ROOT(HOLD_ROW)
    SHAPE_ARRAYS_OF_SHAPES(HOLD_ROW)
    SHAPE_ARRAYS_OF_LOAD(HOLD_ROW)
    return out;
}

void elastics_build(System *system)
{
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *part = &system->origin->instances[i];
        Elastic elastic = {.instance = i, .node = part->head};

        if (part->row->deforming == NULL)
            continue;
        elastic.load_powers = part->row->deforming->load_powers(part, system->arena);
        elastic.first = shapes_first(system, part);
        elastic = elastic_beyond(system, &elastic, expr_int(system->arena, 0));
        LIST_PUSH(system->dynamics->elastics, elastic);
    }
}

static Vec vector_at(const Expr *at)
{
    return (Vec){{at[0], at[1], at[2]}};
}

/* adds a force and torque on the node, given in the root's frame, with a sign */
static void put(const System *system, const Elastic *elastic, Loads *loads, Vec force, Vec torque,
                int sign)
{
    const int chain = system->kinematics->frames[elastic->node].chain;
    const Expr scale = expr_int(system->arena, sign);

    force = elastic_vector(system, elastic, force.at);
    torque = elastic_vector(system, elastic, torque.at);
    loads_add_force(system, loads, elastic->node, vec_scale(system->arena, scale, force), chain);
    loads_add_torque(system, loads, elastic->node, vec_scale(system->arena, scale, torque), chain);
}

static void put_own(const System *system, const Elastic *elastic, Loads *loads, int i, Expr value,
                    int sign)
{
    Expr *own = &loads->own[elastic->first + i];

    *own = sign > 0 ? expr_add(system->arena, *own, value) : expr_sub(system->arena, *own, value);
}

void elastic_add_motion(const System *system, const Elastic *elastic, Loads *loads, Vec a,
                        Vec alpha, const Expr *accelerations, int sign)
{
    Arena *arena = system->arena;
    const ShapeInertia *b = &elastic->block;
    const int count = shapes_of(&system->origin->instances[elastic->instance]);
    const Vec moment = vector_at(b->moment);
    Rotation inertia;
    Vec force, torque;

    a = to_root(system, elastic, a);
    alpha = to_root(system, elastic, alpha);
    for (int i = 0; i < 9; i++)
        inertia.at[i] = b->inertia[i];
    force = vec_add(arena, vec_scale(arena, b->mass, a), vec_cross(arena, alpha, moment));
    torque = vec_add(arena, vec_cross(arena, moment, a), rotation_apply(arena, &inertia, alpha));
    for (int i = 0; i < count; i++) {
        const Vec shift = vector_at(b->with_shift + (ptrdiff_t)3 * i);
        const Vec turn = vector_at(b->with_turn + (ptrdiff_t)3 * i);
        const Expr own = accelerations != NULL ? accelerations[elastic->first + i] : NULL;

        put_own(system, elastic, loads, i,
                expr_add(arena, vec_dot(arena, shift, a), vec_dot(arena, turn, alpha)), sign);
        if (own == NULL || expr_is_zero(own))
            continue;
        force = vec_add(arena, force, vec_scale(arena, own, shift));
        torque = vec_add(arena, torque, vec_scale(arena, own, turn));
        for (int j = 0; j < count; j++)
            put_own(system, elastic, loads, j, expr_mul(arena, b->block[j * count + i], own), sign);
    }
    put(system, elastic, loads, force, torque, sign);
}

/* terms at zero acceleration, and applied loads */
static void add_rest(const System *system, const Elastic *elastic, Loads *loads)
{
    const ShapeInertia *b = &elastic->block;
    const int count = shapes_of(&system->origin->instances[elastic->instance]);

    put(system, elastic, loads, vector_at(b->bias_force), vector_at(b->bias_torque), -1);
    for (int i = 0; i < count; i++)
        put_own(system, elastic, loads, i, expr_sub(system->arena, b->push[i], b->bias[i]), 1);
}

void elastic_add_inertia(const System *system, const Elastic *elastic, Loads *loads,
                         const Vec *alpha, const Vec *a, const Expr *accelerations)
{
    const int chain = system->kinematics->frames[elastic->node].chain;
    const Vec g = vec_express(system, system->origin->gravity, 0, node_axes(system, elastic->node));

    elastic_add_motion(system, elastic, loads, vec_sub(system->arena, a[elastic->node], g),
                       alpha[chain], accelerations, -1);
    add_rest(system, elastic, loads);
}

Status elastic_add_load(System *system, const Elastic *elastic, int take, Loads *loads, Diag *diag)
{
    const Instance *instance = &system->origin->instances[elastic->instance];
    Arena *arena = system->arena;
    const ShapeInertia *b = &elastic->block;
    const int count = shapes_of(instance);
    const Frame *frame = &system->kinematics->frames[elastic->node];
    const Rotation back = rotation_transpose(&frame->zero);

    for (int i = 0; i < count; i++) {
        Expr drive;

        TRY(law_read(system, instance, b->drive[i], &drive, diag));
        TRY(law_add(system, instance, take, &drive, diag));
        put_own(system, elastic, loads, i, drive, 1);
    }
    for (int p = 0; p < elastic->load_powers; p++) {
        const Vec spread = vector_at(b->spread + (ptrdiff_t)3 * p);
        Vec load = vector_at(b->load + (ptrdiff_t)3 * p);

        for (int k = 0; k < 3; k++) {
            TRY(law_read(system, instance, load.at[k], &load.at[k], diag));
            TRY(law_add(system, instance, take, &load.at[k], diag));
        }
        load = vec_express(system, load, 0, frame->chain);
        load = vec_hold(arena, rotation_apply(arena, &back, load));
        put(system, elastic, loads, vec_scale(arena, b->extent[p], load),
            vec_cross(arena, spread, load), 1);
        for (int i = 0; i < count; i++)
            put_own(
                system, elastic, loads, i,
                vec_dot(arena, vector_at(b->spread_shift + (ptrdiff_t)3 * (p * count + i)), load),
                1);
    }
    return OK;
}

bool system_axis_point(System *system, const Instance *part, Expr fraction, Expr point[3])
{
    const Instance *own = &system->origin->instances[part->number];
    Vec at;

    if (!instance_bends(own))
        return false;
    system_touch(system);
    at = vector_at(
        shapes_point(system, own, expr_mul(system->arena, fraction, instance_scalar(own, "length")))
            ->position);
    at = vec_express(system, frame_vector(system, own->head, at),
                     system->kinematics->frames[own->head].chain, 0);
    at = vec_add(system->arena, node_position(system, own->head), at);
    memcpy(point, at.at, sizeof at.at);
    return true;
}

Expr elastic_kinetic(const System *system, const Elastic *elastic)
{
    Arena *arena = system->arena;
    const int node = elastic->node, count = system->kinematics->u.count;
    const int shapes = shapes_of(&system->origin->instances[elastic->instance]);
    const Vec v = system->kinematics->frames[node].v;
    const Vec w = system->kinematics->motions[system->kinematics->frames[node].chain].w;
    Loads momentum = loads_new(system);
    Expr *rates = NEW_ARRAY(Expr, count);
    Expr twice;

    for (int j = 0; j < count; j++)
        rates[j] = system->kinematics->u.at[j].symbol;
    elastic_add_motion(system, elastic, &momentum, v, w, rates, 1);
    mem_free(rates);
    twice = expr_add(arena, vec_dot(arena, momentum.force[node], v),
                     vec_dot(arena, momentum.torque[node], w));
    for (int i = elastic->first; i < elastic->first + shapes; i++)
        twice = expr_add(arena, twice,
                         expr_mul(arena, momentum.own[i], system->kinematics->u.at[i].symbol));
    return expr_mul(arena, expr_rational(arena, 1, 2), twice);
}
