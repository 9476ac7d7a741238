/* section_frames.c: dependent speeds of frames on flexible parts */
#include "formulate/kinematics/section_frames.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

enum { SHIFTS = 3 };

static int turns_of(const System *system)
{
    return system->origin->planar ? 1 : 3;
}

static Expr *new_array(const System *system, int count)
{
    return pool_alloc(system->pool, (size_t)count * sizeof(Expr));
}

/* the flexible part that an arm with at= belongs to; NULL: it is an arm of a body */
static const Instance *part_under(const System *system, const Instance *arm)
{
    if (arm->row->family != FAMILY_ARM || !instance_value(arm, "at")->given)
        return NULL;
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *part = &system->origin->instances[i];

        if (part->row->deforming != NULL && part->head == arm->tail)
            return part;
    }
    return NULL;
}

int shapes_first(const System *system, const Instance *part)
{
    return part->coord_count > part->pose_count
               ? system->kinematics->speed[part->number][part->pose_count]
               : 0;
}

int shapes_of(const Instance *part)
{
    return part->coord_count - part->pose_count;
}

ShapeState shapes_state(const System *system, const Instance *part)
{
    const int count = shapes_of(part), first = shapes_first(system, part);
    Expr *q = new_array(system, count), *rate = new_array(system, count);
    const Expr zero = expr_int(system->arena, 0);

    for (int i = 0; i < count; i++) {
        const int place = system->kinematics->coordinate[part->number][part->pose_count + i];

        q[i] = system->kinematics->q.at[place].symbol;
        rate[i] = system->kinematics->u.at[first + i].symbol;
    }
    return (ShapeState){q, rate, {zero, zero, zero}};
}

/* --- section frames --- */

static Dependent dependent(const System *system, int first, int count, const Expr *factor,
                           Expr rest)
{
    Arena *arena = system->arena;
    Dependent d = {first, count, new_array(system, count), expr_int(arena, 0), rest};

    for (int i = 0; i < count; i++) {
        d.factor[i] = factor[(ptrdiff_t)SHIFTS * i];
        d.rate = expr_add(arena, d.rate,
                          expr_mul(arena, d.factor[i], system->kinematics->u.at[first + i].symbol));
    }
    d.rate = expr_name_temporary(arena, d.rate);
    return d;
}

static SectionFrame *new_point(const System *system, const Instance *part, Expr at)
{
    const int count = shapes_of(part);
    const ShapeState state = shapes_state(system, part);
    SectionFrame *station = pool_alloc(system->pool, sizeof *station);

    station->shift = new_array(system, SHIFTS * count);
    station->turn = new_array(system, SHIFTS * count);
    part->row->deforming->station(part, system->arena, system->origin->planar, at, &state, station);
    return station;
}

const SectionFrame *shapes_point(const System *system, const Instance *part, Expr at)
{
    return new_point(system, part, at);
}

static void add_section_frame(System *system, const Instance *arm, const Instance *part)
{
    Arena *arena = system->arena;
    Kinematics *k = system->kinematics;
    const int count = shapes_of(part), first = shapes_first(system, part);
    SectionFrame *station = new_point(system, part, instance_scalar(arm, "at"));

    k->stations[arm->number] = station;
    k->section_frame_speeds[arm->number] = k->u.count + k->dependents.count;
    for (int i = 0; i < SHIFTS; i++) {
        station->position[i] = expr_name_temporary(arena, station->position[i]);
        LIST_PUSH(k->dependents, dependent(system, first, count, station->shift + i,
                                           expr_name_temporary(arena, station->bend[i])));
    }
    for (int i = 0; i < turns_of(system); i++) {
        station->angle[i] = expr_name_temporary(arena, station->angle[i]);
        LIST_PUSH(k->dependents, dependent(system, first, count, station->turn + i,
                                           expr_name_temporary(arena, station->twist[i])));
    }
}

void section_frames_build(System *system)
{
    Kinematics *k = system->kinematics;
    const int count = system->origin->instance_count;

    k->stations = pool_alloc(system->pool, (size_t)count * sizeof *k->stations);
    k->section_frame_speeds =
        pool_alloc(system->pool, (size_t)count * sizeof *k->section_frame_speeds);
    for (int i = 0; i < count; i++) {
        const Instance *arm = &system->origin->instances[i];
        const Instance *part = part_under(system, arm);

        if (part != NULL)
            add_section_frame(system, arm, part);
    }
    k->speed_count = k->u.count + k->dependents.count;
    k->speeds = pool_alloc(system->pool, (size_t)k->speed_count * sizeof *k->speeds);
    for (int j = 0; j < k->speed_count; j++)
        k->speeds[j].chain = k->speeds[j].slide_node = -1;
    for (int i = 0; i < count; i++) {
        const Instance *part = &system->origin->instances[i];

        for (int c = part->pose_count; part->row->deforming != NULL && c < part->coord_count; c++)
            k->speeds[k->speed[i][c]].shape_node = part->head;
    }
}

const SectionFrame *section_frame_of(const System *system, const Instance *arm, int *speed)
{
    *speed = system->kinematics->section_frame_speeds[arm->number];
    return system->kinematics->stations[arm->number];
}

Expr speed_rate(const System *system, int speed)
{
    const Kinematics *k = system->kinematics;

    return speed < k->u.count ? k->u.at[speed].symbol : k->dependents.at[speed - k->u.count].rate;
}

Expr speed_acceleration(const System *system, int speed, const Expr *accelerations)
{
    Arena *arena = system->arena;
    const Kinematics *k = system->kinematics;
    const Dependent *own;
    Expr sum;

    if (speed < k->u.count)
        return accelerations != NULL ? accelerations[speed] : expr_int(arena, 0);
    own = &k->dependents.at[speed - k->u.count];
    sum = own->rest;
    for (int i = 0; accelerations != NULL && i < own->count; i++)
        sum = expr_add(arena, sum, expr_mul(arena, own->factor[i], accelerations[own->first + i]));
    return sum;
}
