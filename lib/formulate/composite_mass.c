/* composite_mass.c: what is passed on towards the datum, and where */
#include "formulate/composite_mass.h"

#include "formulate/composite.h"
#include "formulate/dynamics.h"
#include "formulate/kinematics.h"
#include "formulate/origin.h"
#include "formulate/system_impl.h"
#include "formulate/vector.h"

/* speeds up to which M written out is run faster, zeros and ones of its terms left out */
enum { FEW_SPEEDS = 16 };

static int axes_of(const System *system, int node)
{
    return system->kinematics->chains.at[system->kinematics->frames[node].chain].resolve;
}

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
        if (!speed_moves_as_one(system, j))
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
        axis = vec_express(system, axis, from, to);
        for (int k = 0; k < 3; k++)
            rotation.at[3 * k + i] = axis.at[k];
    }
    return rotation;
}

static MassPlace place_of(const System *system, CompositeMass *mass, int node, int parent)
{
    const Frame *frame = &system->kinematics->frames[node];
    const int axes = axes_of(system, node), onto = axes_of(system, frame->parent);
    MassPlace place = {.parent = parent,
                       .has_step = !vec_is_zero(frame->step),
                       .is_inner = frame->base == node,
                       .is_turned = parent >= 0 && axes != onto};

    if (place.has_step)
        place.step = need(mass, frame->step.at, 3);
    if (place.is_turned)
        place.rotation = need(mass, rotation_between(system, axes, onto).at, 9);
    return place;
}

/* nodes that speeds move, outward; at[node] is the place of each, -1 where it has none */
static void add_places(System *system, CompositeMass *mass, int *at)
{
    const Kinematics *kinematics = system->kinematics;
    int nodes;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    bool *moves = NEW_ARRAY(bool, graph_node_count(system->origin->graph));

    for (int j = 0; j < kinematics->u.count; j++)
        moves[speed_node(system, j)] = true;
    mass->places = pool_alloc(system->pool, (size_t)nodes * sizeof *mass->places);
    at[order[0]] = -1;
    for (int i = 1; i < nodes; i++) {
        const int parent = kinematics->frames[order[i]].parent;

        at[order[i]] = -1;
        if (at[parent] < 0 && !moves[order[i]])
            continue;
        mass->places[mass->place_count] = place_of(system, mass, order[i], at[parent]);
        at[order[i]] = mass->place_count++;
    }
    mem_free(moves);
}

/* --- speeds --- */

static void add_speeds(System *system, CompositeMass *mass, const int *at)
{
    const Composite *composites = composites_new(system);
    Loads loads = loads_new(system);
    const int count = system->kinematics->u.count;
    int filled = 0;

    mass->speed_count = count;
    mass->speeds = pool_alloc(system->pool, (size_t)count * sizeof *mass->speeds);
    mass->speed_at = pool_alloc(system->pool, (size_t)count * sizeof *mass->speed_at);
    for (int j = 0; j < count; j++) {
        const int node = speed_node(system, j), axes = axes_of(system, node);
        const bool turns = system->kinematics->speeds[j].chain >= 0;
        const Vec turn = turns ? speed_axis(system, j, axes) : vec_zero(system->arena);
        const Vec slide = speed_slide(system, j, axes);

        composite_loads(system, &composites[node], j, &loads);
        mass->speeds[j] = (MassSpeed){.place = at[node],
                                      .turn = need(mass, turn.at, 3),
                                      .slide = need(mass, slide.at, 3),
                                      .force = need(mass, loads.force[node].at, 3),
                                      .torque = need(mass, loads.torque[node].at, 3)};
        mass->places[at[node]].count++;
    }
    for (int p = 0; p < mass->place_count; p++) {
        mass->places[p].first = filled;
        filled += mass->places[p].count;
        mass->places[p].count = 0;
    }
    for (int j = 0; j < count; j++) {
        MassPlace *place = &mass->places[mass->speeds[j].place];

        mass->speed_at[place->first + place->count++] = j;
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

/* --- its price --- */

/* Passing on takes a cross product for a step and two products with a matrix for a turn, meeting a
 * speed two dot products; in a plane less. */
OpCount composite_mass_passing(const CompositeMass *mass)
{
    const OpCount step = mass->planar ? (OpCount){2, 2, 0} : (OpCount){6, 6, 0};
    const OpCount turned = {12, 18, 0};
    const OpCount met = mass->planar ? (OpCount){2, 3, 0} : (OpCount){5, 6, 0};
    OpCount sum = {0};

    for (int k = 0; k < mass->speed_count; k++)
        for (int p = mass->speeds[k].place; p >= 0; p = mass->places[p].parent) {
            if (mass->places[p].has_step)
                sum = op_count_plus(sum, step);
            if (mass->places[p].is_turned)
                sum = op_count_plus(sum, turned);
            for (int i = 0; i < mass->places[p].count; i++)
                sum = op_count_plus(sum, met);
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
