/* composite_mass.c: which loads are passed on towards the datum, and at which places */
#include "formulate/dynamics/composite_mass.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/identity.h"

#include "formulate/dynamics/composite.h"
#include "formulate/kinematics/isomorphic.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

/* speeds up to which the expanded M is cheaper, as it omits zeros and ones */
enum { FEW_SPEEDS = 16 };

/* both trees reach every node by the same edge, and every speed moves one body */
static bool moves_in_composites(const System *system)
{
    const Tree *translation = system->origin->trees[TREE_TRANSLATION];
    const Tree *rotation = system->origin->trees[TREE_ROTATION];
    int nodes;
    const int *order = tree_nodes(translation, &nodes);

    for (int i = 1; i < nodes; i++)
        if (tree_parent_edge(translation, order[i]) != tree_parent_edge(rotation, order[i]))
            return false;
    for (int j = 0; j < system->kinematics->u.count; j++)
        if (!speed_shift_is_fixed(system, j))
            return false;
    return true;
}

static int need(CompositeMass *mass, const Expr *entries, int count)
{
    const int first = mass->needs.count;

    for (int i = 0; i < count; i++)
        LIST_PUSH(mass->needs, entries[i]);
    return first;
}

/* --- places --- */

/* its columns are the axes of `from` in those of `to` */
static Rotation rotation_between(const System *system, int from, int to)
{
    Arena *arena = system->arena;
    Rotation rotation;

    for (int i = 0; i < 3; i++) {
        Vec axis = vec_zero(arena);

        axis.at[i] = expr_int(arena, 1);
        axis = vec_carry(system, axis, from, to);
        for (int k = 0; k < 3; k++)
            rotation.at[3 * k + i] = axis.at[k];
    }
    return rotation;
}

/* as cosine and sine for a turn about one of the axes; otherwise row by row */
static void add_rotation(const System *system, CompositeMass *mass, int from, int to,
                         MassPlace *place)
{
    const Rotation R = rotation_between(system, from, to);

    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        if (expr_is(R.at[4 * i], 1) && expr_is_zero(R.at[3 * i + j]) &&
            expr_is_zero(R.at[3 * i + k]) && expr_is_zero(R.at[3 * j + i]) &&
            expr_is_zero(R.at[3 * k + i]) && R.at[4 * j] == R.at[4 * k] &&
            R.at[3 * j + k] == expr_neg(system->arena, R.at[3 * k + j])) {
            place->axis = i;
            place->rotation = need(mass, (Expr[]){R.at[4 * j], R.at[3 * k + j]}, 2);
            return;
        }
    }
    place->axis = AXIS_ANY;
    place->rotation = need(mass, R.at, 9);
}

/* Nodes between that no speed moves have the axes of the place's parent: their shifts are one
 * vector. */
static MassPlace place_of(const System *system, CompositeMass *mass, int node, const int *at)
{
    const Frame *frames = system->kinematics->frames;
    const int inner = frames[node].parent, axes = node_axes(system, node),
              onto = node_axes(system, inner);
    MassPlace place = {.is_turned = axes != onto};
    Vec way = place.is_turned ? vec_zero(system->arena) : frames[node].step;
    int parent = inner;

    for (; parent >= 0 && at[parent] < 0; parent = frames[parent].parent)
        if (frames[parent].parent >= 0)
            way = vec_add(system->arena, way, frames[parent].step);
    place.parent = parent >= 0 ? at[parent] : -1;
    if (place.parent < 0)
        return (MassPlace){.parent = -1};
    place.has_step = place.is_turned && !vec_is_zero(frames[node].step);
    if (place.has_step)
        place.step = need(mass, frames[node].step.at, 3);
    if (place.is_turned)
        add_rotation(system, mass, axes, onto, &place);
    way = vec_hold(system->arena, way);
    place.has_way = !vec_is_zero(way);
    if (place.has_way)
        place.way = need(mass, way.at, 3);
    return place;
}

/* nodes that speeds move, outward; at[node] is the place of each, -1 where it has none */
static void add_places(System *system, CompositeMass *mass, int *at)
{
    int nodes;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    bool *moves = NEW_ARRAY(bool, graph_node_count(system->origin->graph));

    for (int j = 0; j < system->kinematics->u.count; j++)
        moves[speed_node(system, j)] = true;
    mass->places = pool_alloc(system->pool, (size_t)nodes * sizeof *mass->places);
    for (int i = 0; i < nodes; i++)
        at[order[i]] = -1;
    for (int i = 1; i < nodes; i++)
        if (moves[order[i]]) {
            mass->places[mass->place_count] = place_of(system, mass, order[i], at);
            at[order[i]] = mass->place_count++;
        }
    mem_free(moves);
}

/* --- speeds --- */

static MassSpeed speed_of(const System *system, CompositeMass *mass, int j, int place)
{
    const int axes = node_axes(system, speed_node(system, j));
    const Vec turn = system->kinematics->speeds[j].chain >= 0 ? speed_axis(system, j, axes)
                                                              : vec_zero(system->arena),
              slide = speed_slide(system, j, axes);

    return (MassSpeed){.place = place,
                       .turns = !vec_is_zero(turn),
                       .slides = !vec_is_zero(slide),
                       .turn = need(mass, turn.at, 3),
                       .slide = need(mass, slide.at, 3)};
}

/* its speeds, place by place */
static void list_speeds(System *system, CompositeMass *mass)
{
    int filled = 0;

    mass->speed_at = pool_alloc(system->pool, (size_t)mass->speed_count * sizeof *mass->speed_at);
    for (int j = 0; j < mass->speed_count; j++)
        mass->places[mass->speeds[j].place].count++;
    for (int p = 0; p < mass->place_count; p++) {
        mass->places[p].first = filled;
        filled += mass->places[p].count;
        mass->places[p].count = 0;
    }
    for (int j = 0; j < mass->speed_count; j++) {
        MassPlace *place = &mass->places[mass->speeds[j].place];

        mass->speed_at[place->first + place->count++] = j;
    }
}

static void add_speeds(System *system, CompositeMass *mass, const int *at)
{
    mass->speed_count = system->kinematics->u.count;
    mass->speeds = pool_alloc(system->pool, (size_t)mass->speed_count * sizeof *mass->speeds);
    for (int j = 0; j < mass->speed_count; j++)
        mass->speeds[j] = speed_of(system, mass, j, at[speed_node(system, j)]);
    list_speeds(system, mass);
}

/* adds the body that moves with each place as one rigid body */
static void add_bodies(System *system, CompositeMass *mass, const int *at)
{
    int nodes;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    const Composites bodies = composites_new(system, at);

    mass->first_body = mass->needs.count;
    for (int i = 1; i < nodes; i++) {
        Composite body;

        if (at[order[i]] < 0)
            continue;
        body = composite_at(system, &bodies, order[i]);
        (void)need(mass, &body.mass, 1);
        (void)need(mass, body.moment.at, 3);
        (void)need(mass, body.inertia.at, 9);
    }
}

bool composite_mass_build(System *system)
{
    CompositeMass *mass;
    int *at;

    if (system->kinematics->u.count <= FEW_SPEEDS || !moves_in_composites(system))
        return false;
    mass = NEW(CompositeMass);
    at = NEW_ARRAY(int, graph_node_count(system->origin->graph));
    mass->planar = system->origin->planar;
    add_places(system, mass, at);
    add_speeds(system, mass, at);
    add_bodies(system, mass, at);
    mem_free(at);
    system->dynamics->composite_mass = mass;
    return true;
}

void composite_mass_free(CompositeMass *mass)
{
    if (mass == NULL)
        return;
    LIST_FREE(mass->needs);
    mem_free(mass);
}

/* --- operation count --- */

static OpCount times(OpCount a, int64_t n)
{
    return (OpCount){n * a.add, n * a.mul, n * a.fun};
}

/* Passing on needs a cross product for a shift and a matrix product for the turn of each vector.
 * Meeting a speed needs a dot product. In a plane both need less. */
static OpCount passing(const CompositeMass *mass, const MassPlace *place)
{
    const OpCount cross = mass->planar ? (OpCount){2, 2, 0} : (OpCount){6, 6, 0};
    const OpCount turned = place->axis == AXIS_ANY ? (OpCount){12, 18, 0} : (OpCount){4, 8, 0};
    OpCount sum = {0};

    for (int i = place->first; i < place->first + place->count; i++) {
        const MassSpeed *speed = &mass->speeds[mass->speed_at[i]];

        sum = op_count_plus(
            sum, times(mass->planar ? (OpCount){0, 1, 0} : (OpCount){2, 3, 0}, speed->turns));
        sum = op_count_plus(
            sum, times(mass->planar ? (OpCount){1, 2, 0} : (OpCount){2, 3, 0}, speed->slides));
    }
    sum = op_count_plus(sum, times(cross, place->has_step + place->has_way));
    return op_count_plus(sum, times(turned, place->is_turned));
}

/* The inertia of all beyond a place, moved, turned and added to that of its parent: for each shift
 * the first moment and the six entries of a symmetric tensor, three vectors twice for its turn. */
static OpCount gathering(const CompositeMass *mass, const MassPlace *place)
{
    const OpCount shift = mass->planar ? (OpCount){6, 4, 0} : (OpCount){23, 18, 0};
    const OpCount turned = place->axis == AXIS_ANY ? (OpCount){42, 63, 0} : (OpCount){14, 28, 0};
    const OpCount sum = op_count_plus(times(shift, place->has_step + place->has_way),
                                      times(turned, place->is_turned));

    return op_count_plus(sum, (OpCount){mass->planar ? 4 : 10, 0, 0});
}

/* the force and moment that one unit of a speed needs: S x slide + J turn, m slide + turn x S */
static OpCount loading(const CompositeMass *mass, const MassSpeed *speed)
{
    return op_count_plus(
        times(mass->planar ? (OpCount){0, 3, 0} : (OpCount){9, 15, 0}, speed->turns),
        times(mass->planar ? (OpCount){4, 4, 0} : (OpCount){9, 9, 0}, speed->slides));
}

OpCount composite_mass_passing(const CompositeMass *mass)
{
    OpCount sum = {0};

    for (int p = 0; p < mass->place_count; p++)
        if (mass->places[p].parent >= 0)
            sum = op_count_plus(sum, gathering(mass, &mass->places[p]));
    for (int k = 0; k < mass->speed_count; k++) {
        sum = op_count_plus(sum, loading(mass, &mass->speeds[k]));
        for (int p = mass->speeds[k].place; p >= 0; p = mass->places[p].parent)
            sum = op_count_plus(sum, passing(mass, &mass->places[p]));
    }
    return sum;
}

const CompositeMass *system_composite_mass(const System *system)
{
    return system->dynamics->composite_mass;
}

const Entry *system_mass_share(const System *system, int i)
{
    return i < system->dynamics->shares.count ? &system->dynamics->shares.at[i] : NULL;
}
