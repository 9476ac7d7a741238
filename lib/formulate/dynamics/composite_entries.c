/* composite_entries.c: M by the recursion of composite_mass.h, in symbols
 *
 * What a place passes on to the next is a named temporary, which all speeds further inward
 * share. */
#include "formulate/dynamics/composite.h"
#include "formulate/dynamics/composite_mass.h"
#include "formulate/kinematics/frames.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

static Vec vec_at(const CompositeMass *mass, int first)
{
    Vec v;

    for (int i = 0; i < 3; i++)
        v.at[i] = mass->needs.at[first + i];
    return v;
}

/* in the axes of the place's parent */
static Vec turn_onto(Arena *arena, const CompositeMass *mass, const MassPlace *place, Vec v)
{
    const Expr *R = mass->needs.at + place->rotation;
    Vec out = v;
    Rotation whole;

    if (place->axis != AXIS_ANY) {
        const int j = (place->axis + 1) % 3, k = (place->axis + 2) % 3;

        out.at[j] = expr_sub(arena, expr_mul(arena, R[0], v.at[j]), expr_mul(arena, R[1], v.at[k]));
        out.at[k] = expr_add(arena, expr_mul(arena, R[1], v.at[j]), expr_mul(arena, R[0], v.at[k]));
        return vec_hold(arena, out);
    }
    for (int i = 0; i < 9; i++)
        whole.at[i] = R[i];
    return vec_hold(arena, rotation_apply(arena, &whole, v));
}

/* passes a force and a moment on the place to its parent */
static void pass_on(Arena *arena, const CompositeMass *mass, const MassPlace *place, Vec *force,
                    Vec *torque)
{
    if (place->has_step)
        *torque = vec_add(arena, *torque, vec_cross(arena, vec_at(mass, place->step), *force));
    *torque = vec_hold(arena, *torque);
    if (place->is_turned) {
        *force = turn_onto(arena, mass, place, *force);
        *torque = turn_onto(arena, mass, place, *torque);
    }
    if (place->has_way)
        *torque = vec_hold(
            arena, vec_add(arena, *torque, vec_cross(arena, vec_at(mass, place->way), *force)));
}

static void add_entry(Arena *arena, const CompositeMass *mass, int row, int column, Vec force,
                      Vec torque, MassEntries *out)
{
    const MassSpeed *met = &mass->speeds[row];
    Expr sum = expr_int(arena, 0);

    if (met->turns)
        sum = expr_add(arena, sum, vec_dot(arena, vec_at(mass, met->turn), torque));
    if (met->slides)
        sum = expr_add(arena, sum, vec_dot(arena, vec_at(mass, met->slide), force));
    if (!expr_is_zero(sum))
        LIST_PUSH(*out, (Entry){row, column, expr_name_temporary(arena, sum)});
}

static void add_column(Arena *arena, const CompositeMass *mass, int k, Vec force, Vec torque,
                       MassEntries *out)
{
    const MassSpeed *own = &mass->speeds[k];

    for (int p = own->place; p >= 0; p = mass->places[p].parent) {
        const MassPlace *place = &mass->places[p];

        /* entries of one place are in the column of the later speed */
        for (int i = place->first; i < place->first + place->count; i++)
            if (p != own->place || mass->speed_at[i] <= k)
                add_entry(arena, mass, mass->speed_at[i], k, force, torque, out);
        if (place->parent >= 0)
            pass_on(arena, mass, place, &force, &torque);
    }
}

int64_t composite_mass_pairs(const CompositeMass *mass)
{
    int64_t pairs = 0;

    for (int k = 0; k < mass->speed_count; k++)
        for (int p = mass->speeds[k].place; p >= 0; p = mass->places[p].parent)
            pairs += mass->places[p].count;
    return pairs;
}

void composite_mass_entries(const System *system, MassEntries *out)
{
    const CompositeMass *mass = system_composite_mass(system);
    const PoolMark mark = pool_mark(system->pool);
    const Composites composites = composites_new(system, NULL);
    Loads loads = loads_new(system);
    const Entry *share;

    for (int k = 0; k < mass->speed_count; k++) {
        const int node = speed_node(system, k);

        composite_loads(system, composite_at(system, &composites, node), k, &loads);
        add_column(system->arena, mass, k, loads.force[node], loads.torque[node], out);
    }
    pool_release(system->pool, mark);
    for (int i = 0; (share = system_mass_share(system, i)) != NULL; i++)
        if (share->row <= share->column)
            LIST_PUSH(*out, *share);
}
