/* rubbing.c: dry friction in two or three directions, and contacts that open
 *
 * Sliding along the axes n_k of a plane of the tail: rates n_k.(v_head - v_tail - w_tail x d) with
 * d from tail to head, or of a joint the rates of its shifts. Turning: the components of w_head -
 * w_tail, in the axes of the head, where those of a joint that is a branch are its speeds. At a
 * contact the rates are the components of its point's velocity, along the normal and the tangents:
 * normal force P, friction with a bound of mu P. */
#include "formulate/dynamics/rubbing.h"

#include "formulate/dynamics/laws.h"
#include "formulate/kinematics/contact_rows.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

static int resolve_class(const System *system, int node)
{
    return system->kinematics->chains.at[system->kinematics->frames[node].chain].resolve;
}

static Vec velocity(const System *system, int node)
{
    return vec_express(system, system->kinematics->frames[node].v, resolve_class(system, node), 0);
}

static void add_direction(FrictionLoad *r, Vec axis, Expr rate)
{
    if (expr_is_zero(rate))
        return;
    r->axis[r->count] = axis;
    r->rate[r->count++] = rate;
}

static void find_turns(const System *system, const Instance *instance, FrictionLoad *r)
{
    Arena *arena = system->arena;
    const int own = resolve_class(system, instance->head);
    const Vec w = vec_sub(arena, node_turn_rate(system, instance->head, own),
                          node_turn_rate(system, instance->tail, own));

    r->turns = true;
    for (int k = 0; k < 3; k++) {
        Vec axis = vec_zero(arena);

        axis.at[k] = expr_int(arena, 1);
        add_direction(r, axis, expr_name_temporary(arena, w.at[k]));
    }
}

/* along the plane with that normal, in the axes of the tail */
static void find_slides(System *system, const Instance *instance, const Expr *normal,
                        FrictionLoad *r)
{
    Arena *arena = system->arena;
    const Vec way = node_way(system, instance->tail, instance->head);
    const Vec carried = vec_cross(arena, node_turn_rate(system, instance->tail, 0), way);
    const Vec v = vec_sub(
        arena, vec_sub(arena, velocity(system, instance->head), velocity(system, instance->tail)),
        carried);
    const int chain = system->kinematics->frames[instance->tail].chain;
    Vec axis[2];

    axis_complement(arena, normal, axis[0].at, axis[1].at);
    for (int k = 0; k < 2; k++) {
        const Vec seen =
            vec_express(system, frame_vector(system, instance->tail, axis[k]), chain, 0);

        add_direction(r, axis[k], expr_name_temporary(arena, vec_dot(arena, seen, v)));
    }
}

/* the shifts of a joint, or its turns */
static Status find_joint(System *system, const Instance *instance, FrictionLoad *r, Diag *diag)
{
    const Instance *joint = &system->origin->instances[instance->rubbed];
    Steps steps;

    instance_steps(system, joint, &steps);
    if (steps.shift_count == 0) {
        find_turns(system, instance, r);
        return OK;
    }
    for (int k = 0; k < steps.shift_count; k++) {
        const Expr *along = steps.shift[k].axis;
        Expr rate;

        TRY(coordinate_value(system, joint, steps.shift[k].coordinate, 1, &rate, diag));
        add_direction(r, (Vec){{along[0], along[1], along[2]}}, rate);
    }
    return OK;
}

/* the normal and, where there is friction, the tangents */
static Status find_contact(System *system, const Instance *instance, FrictionLoad *r, Diag *diag)
{
    Arena *arena = system->arena;
    const int chain = system->kinematics->frames[instance->tail].chain;
    Contact contact;
    Vec slip;

    contact_of(system, instance, &contact);
    r->gap = contact.row[0].gap;
    r->point = vec_hold(
        arena, frame_vector(system, instance->tail,
                            (Vec){{contact.point[0], contact.point[1], contact.point[2]}}));
    TRY(contact_slip(system, instance, vec_express(system, r->point, chain, 0), &slip, diag));
    r->first = 1;
    r->count = instance_value(instance, "mu")->given ? contact.count : 1;
    for (int k = 0; k < r->count; k++) {
        const Expr *along = contact.row[k].along;
        Vec seen;

        r->axis[k] = (Vec){{along[0], along[1], along[2]}};
        seen = vec_express(system, frame_vector(system, instance->tail, r->axis[k]), chain, 0);
        r->rate[k] = expr_name_temporary(arena, vec_dot(arena, seen, slip));
    }
    return OK;
}

/* Squares of differences would be multiplied out, and lose what is left of them near 0. */
static Expr norm_of(Arena *arena, const Expr *v, int count)
{
    Expr norm = count > 0 ? v[0] : expr_int(arena, 0);

    if (count == 1)
        return expr_call1(arena, OP_ABS, norm);
    for (int k = 1; k < count; k++)
        norm = expr_call2(arena, OP_HYPOT, norm, v[k]);
    return norm;
}

static Status find_effort(System *system, const Instance *instance, int take, FrictionLoad *r,
                          int k, Diag *diag)
{
    Arena *arena = system->arena;
    const Component *row = instance->row;
    const Expr speed = r->count - r->first > 1 ? r->speed : NULL;
    const Expr load = r->first > 0 && k > 0 ? r->effort[0] : NULL;
    Expr effort;

    effort = row->press != NULL && k == 0 ? row->press(instance, arena, r->gap, r->rate[0])
                                          : row->rub(instance, arena, r->rate[k], speed, load);
    TRY(law_read(system, instance, effort, &r->effort[k], diag));
    return law_add(system, instance, take, &r->effort[k], diag);
}

Status rubbing_of(System *system, const Instance *instance, int take, FrictionLoad *out, Diag *diag)
{
    Arena *arena = system->arena;
    FrictionLoad r = {.power = expr_int(arena, 0), .lost = expr_int(arena, 0)};

    if (instance->row->press != NULL)
        TRY(find_contact(system, instance, &r, diag));
    else if (instance->rubbed >= 0)
        TRY(find_joint(system, instance, &r, diag));
    else
        find_slides(system, instance, instance_value(instance, "normal")->at, &r);
    r.speed = norm_of(arena, r.rate + r.first, r.count - r.first);
    for (int k = 0; k < r.count; k++) {
        Expr power;

        TRY(find_effort(system, instance, take, &r, k, diag));
        power = expr_mul(arena, r.effort[k], r.rate[k]);
        r.power = expr_add(arena, r.power, power);
        if (k >= r.first)
            r.lost = expr_sub(arena, r.lost, power);
    }
    r.norm = norm_of(arena, r.effort + r.first, r.count - r.first);
    *out = r;
    return OK;
}

/* a contact's force acts at its point */
static void add_contact(System *system, const Instance *instance, const FrictionLoad *r,
                        Loads *loads)
{
    Arena *arena = system->arena;
    Vec force = vec_zero(arena);

    for (int k = 0; k < r->count; k++)
        force = vec_add(arena, force, vec_scale(arena, r->effort[k], r->axis[k]));
    force = vec_hold(arena, frame_vector(system, instance->tail, force));
    loads_add_between(system, loads, instance, force,
                      vec_hold(arena, vec_cross(arena, r->point, force)));
}

Status rubbing_add(System *system, const Instance *instance, Loads *loads, int take, Diag *diag)
{
    Arena *arena = system->arena;
    const int own = resolve_class(system, instance->head);
    Vec torque = vec_zero(arena);
    FrictionLoad r;

    TRY(rubbing_of(system, instance, take, &r, diag));
    if (r.gap != NULL) {
        add_contact(system, instance, &r, loads);
        return OK;
    }
    for (int k = 0; k < r.count; k++) {
        const Step along = {.axis = {r.axis[k].at[0], r.axis[k].at[1], r.axis[k].at[2]}};

        if (r.turns)
            torque = vec_add(arena, torque, vec_scale(arena, r.effort[k], r.axis[k]));
        else
            loads_add_shift(system, loads, instance, &along, r.effort[k]);
    }
    if (r.turns) {
        loads_add_torque(system, loads, instance->head, torque, own);
        loads_add_torque(system, loads, instance->tail, vec_neg(arena, torque), own);
    }
    return OK;
}
