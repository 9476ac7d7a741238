/* efforts.c: applied loads: forces, springs, dampers, actuators, motors
 *
 * Along a line from tail to head, with d = r_head - r_tail (m, 3 x 1): displacement s = |d|,
 * direction n = d/s, rate s' = n.(v_head - v_tail). */
#include "formulate/dynamics/efforts.h"
#include "formulate/dynamics/bushings.h"
#include "formulate/dynamics/laws.h"
#include "formulate/dynamics/loads.h"
#include "formulate/dynamics/rubbing.h"
#include "formulate/dynamics/shapes.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <string.h>

/* displacement, rate and direction of an effort along the line between two frames */
static Status line_motion(System *system, const Instance *instance, Effort *effort, Diag *diag)
{
    Arena *arena = system->arena;
    Vec d = vec_hold(arena, node_way(system, instance->tail, instance->head));
    Expr length = expr_name_temporary(arena, expr_sqrt(arena, vec_dot(arena, d, d)));
    Vec v[2];
    const int ends[2] = {instance->tail, instance->head};

    if (expr_is_zero(length)) {
        (void)diag_set(diag, E_MODEL,
                       "the frames of %s, %s and %s, are always at the same point, where its line "
                       "has no direction",
                       instance->name, graph_node(system->origin->graph, instance->tail)->name,
                       graph_node(system->origin->graph, instance->head)->name);
        diag_hint(diag, "let one of them be an arm away from there, or let it act on a joint, "
                        "which has no line");
        return E_MODEL;
    }
    for (int i = 0; i < 2; i++) {
        const Frame *frame = &system->kinematics->frames[ends[i]];

        v[i] =
            vec_express(system, frame->v, system->kinematics->chains.at[frame->chain].resolve, 0);
    }
    effort->is_line = true;
    effort->direction =
        vec_hold(arena, vec_scale(arena, expr_div(arena, expr_int(arena, 1), length), d));
    effort->displacement = length;
    effort->rate =
        expr_name_temporary(arena, vec_dot(arena, effort->direction, vec_sub(arena, v[1], v[0])));
    return OK;
}

/* the motion of the first joint against the second */
static Status subtract_second(System *system, const Instance *instance, Effort *effort, Diag *diag)
{
    const Instance *joint = &system->origin->instances[instance->second_joint];
    Expr displacement, rate;

    TRY(coordinate_value(system, joint, instance->second_coordinate, 0, &displacement, diag));
    TRY(coordinate_value(system, joint, instance->second_coordinate, 1, &rate, diag));
    effort->displacement = expr_sub(system->arena, effort->displacement, displacement);
    effort->rate = expr_sub(system->arena, effort->rate, rate);
    return OK;
}

Status effort_of(System *system, const Instance *instance, Effort *out, Diag *diag)
{
    Effort effort = {.instance = instance};
    Motion1 motion = {.across = expr_int(system->arena, 0), .through = expr_int(system->arena, 0)};

    if (instance->joint < 0) {
        TRY(line_motion(system, instance, &effort, diag));
    } else {
        const Instance *joint = &system->origin->instances[instance->joint];
        int coordinate = instance->joint_coordinate;

        TRY(coordinate_value(system, joint, coordinate, 0, &effort.displacement, diag));
        TRY(coordinate_value(system, joint, coordinate, 1, &effort.rate, diag));
    }
    if (instance->second_joint >= 0)
        TRY(subtract_second(system, instance, &effort, diag));
    motion.displacement = effort.displacement;
    motion.rate = effort.rate;
    if (instance->scalar_count > 0) {
        Branchlike *branch = scalar_branch(system, instance, 0);

        TRY(network_through(system, branch, &motion.through, diag));
        TRY(network_across(system, branch, &motion.across, diag));
    }
    effort.value = instance->row->effort(instance, system->arena, &motion);
    TRY(law_read(system, instance, effort.value, &effort.value, diag));
    *out = effort;
    return OK;
}

bool system_line(System *system, int *next, FrameLine *out)
{
    system_touch(system);
    for (; *next < system->origin->instance_count; ++*next) {
        const Instance *instance = &system->origin->instances[*next];
        Effort effort;

        if (instance->row->effort == NULL || instance->joint >= 0 || instance->tail < 0 ||
            instance->head < 0 || effort_of(system, instance, &effort, NULL) != OK ||
            !effort.is_line)
            continue;
        *out = (FrameLine){instance->name, graph_node(system->origin->graph, instance->tail)->name,
                           graph_node(system->origin->graph, instance->head)->name,
                           effort.displacement};
        ++*next;
        return true;
    }
    return false;
}

Status wrench_of(System *system, const Instance *instance, int take, Vec *force, Vec *torque,
                 int *chain, Diag *diag)
{
    bool in_body = false;

    instance->row->wrench(instance, system->arena, system->origin->planar, force->at, torque->at,
                          &in_body);
    for (int i = 0; i < 3; i++) {
        TRY(law_read(system, instance, force->at[i], &force->at[i], diag));
        TRY(law_read(system, instance, torque->at[i], &torque->at[i], diag));
        TRY(law_add(system, instance, take, &force->at[i], diag));
        TRY(law_add(system, instance, take, &torque->at[i], diag));
    }
    *chain = 0;
    if (in_body) {
        *force = frame_vector(system, instance->head, *force);
        *torque = frame_vector(system, instance->head, *torque);
        *chain = system->kinematics->frames[instance->head].chain;
    }
    return OK;
}

static bool find_push(System *system, const Instance *instance, Pusher *out)
{
    Vec force, torque;
    Effort effort;
    FrictionLoad rubbing;
    BushingLoad bushing;
    int chain;

    *out = (Pusher){.name = instance->name};
    if (instance->row->wrench != NULL &&
        wrench_of(system, instance, TAKE_ALL, &force, &torque, &chain, NULL) == OK) {
        out->count = 6;
        memcpy(out->value, force.at, sizeof force.at);
        memcpy(out->value + 3, torque.at, sizeof torque.at);
    } else if (instance->row->rub != NULL &&
               rubbing_of(system, instance, TAKE_ALL, &rubbing, NULL) == OK) {
        out->count = rubbing.count;
        memcpy(out->value, rubbing.effort, sizeof rubbing.effort);
    } else if (instance->row->restore != NULL &&
               bushing_of(system, instance, &bushing, NULL) == OK) {
        out->count = bushing.count;
        memcpy(out->value, bushing.effort, sizeof bushing.effort);
    } else if (instance->row->effort != NULL && effort_of(system, instance, &effort, NULL) == OK) {
        out->count = 1;
        out->value[0] = effort.value;
    }
    return out->count > 0;
}

bool system_pusher(System *system, int *next, Pusher *out)
{
    system_touch(system);
    while (*next < system->origin->instance_count)
        if (find_push(system, &system->origin->instances[(*next)++], out))
            return true;
    return false;
}

/* a torque on a screw that is a chord */
static void add_tied(const System *system, Loads *loads, const Instance *screw, Expr torque)
{
    const int count = system->origin->instance_count;

    if (loads->tied == NULL) {
        loads->tied = pool_alloc(system->pool, (size_t)count * sizeof(Expr));
        for (int i = 0; i < count; i++)
            loads->tied[i] = expr_int(system->arena, 0);
    }
    loads->tied[screw->number] = expr_add(system->arena, loads->tied[screw->number], torque);
}

void loads_add_effort(System *system, Loads *loads, const Instance *owner, int coordinate,
                      Expr effort)
{
    Arena *arena = system->arena;
    Steps steps;

    if (coordinate >= owner->pose_count) {
        Expr *own = &loads->own[system->kinematics->speed[owner->number][coordinate]];

        *own = expr_add(arena, *own, effort);
        return;
    }
    instance_steps(system, owner, &steps);
    if (steps_are_tied(&steps) && !owner->is_virtual &&
        system->kinematics->coordinate[owner->number][coordinate] < 0) {
        add_tied(system, loads, owner, effort);
        loads_add_shift(system, loads, owner, &steps.shift[0],
                        expr_div(arena, effort, steps.shift[0].scale));
        return;
    }
    for (int k = 0; k < steps.turn_count; k++) {
        Vec torque;
        int about;

        if (steps.turn[k].coordinate != coordinate)
            continue;
        torque = vec_scale(arena, effort, joint_axis(system, owner, &steps, k, &about));
        loads_add_torque(system, loads, owner->head, torque, about);
        loads_add_torque(system, loads, owner->tail, vec_neg(arena, torque), about);
    }
    /* on a screw the coordinate is the angle, and the effort a torque */
    for (int k = 0; k < steps.shift_count && !steps_are_tied(&steps); k++)
        if (steps.shift[k].coordinate == coordinate)
            loads_add_shift(system, loads, owner, &steps.shift[k], effort);
}

Status effort_add(System *system, const Instance *instance, Loads *loads, int take, Diag *diag)
{
    Arena *arena = system->arena;
    Effort effort;
    Vec force;
    Vec torque;
    int chain;

    if (instance->row->wrench != NULL) {
        TRY(wrench_of(system, instance, take, &force, &torque, &chain, diag));
        loads_add_force(system, loads, instance->head, force, chain);
        loads_add_torque(system, loads, instance->head, torque, chain);
    }
    if (instance->row->rub != NULL)
        return rubbing_add(system, instance, loads, take, diag);
    if (instance->row->restore != NULL)
        return take < 0 ? bushing_add(system, instance, loads, diag) : OK;
    if (instance->row->effort == NULL || (instance->joint >= 0 && take != TAKE_ALL))
        return OK;
    TRY(effort_of(system, instance, &effort, diag));
    if (!effort.is_line) {
        loads_add_effort(system, loads, &system->origin->instances[instance->joint],
                         instance->joint_coordinate, effort.value);
        if (instance->second_joint >= 0)
            loads_add_effort(system, loads, &system->origin->instances[instance->second_joint],
                             instance->second_coordinate, expr_neg(arena, effort.value));
        return OK;
    }
    TRY(law_add(system, instance, take, &effort.value, diag));
    force = vec_hold(arena,
                     vec_scale(arena, expr_name_temporary(arena, effort.value), effort.direction));
    loads_add_force(system, loads, instance->head, force, 0);
    loads_add_force(system, loads, instance->tail, vec_neg(arena, force), 0);
    return OK;
}

Status efforts_add(System *system, Loads *loads, int take, Diag *diag)
{
    for (int i = 0; i < system->origin->instance_count; i++)
        TRY(effort_add(system, &system->origin->instances[i], loads, take, diag));
    for (int i = 0; i < system->dynamics->elastics.count; i++)
        TRY(elastic_add_load(system, &system->dynamics->elastics.at[i], take, loads, diag));
    return OK;
}

void loads_add_row(System *system, Loads *loads, const Row *row, Expr lambda)
{
    Arena *arena = system->arena;
    int tail = system->kinematics->frames[row->tail].chain;
    int chain = row->kind == ROW_DATUM ? 0 : tail;
    Expr push = expr_neg(arena, lambda);
    Vec along = row->n;

    if (row->kind == ROW_DRIVER) {
        loads_add_effort(system, loads, &system->origin->instances[row->owner], row->coordinate,
                         push);
        return;
    }
    if (row->kind == ROW_COUPLER) {
        loads_add_effort(system, loads, &system->origin->instances[row->owner], row->coordinate,
                         push);
        for (int i = 0; i < row->coupled_count; i++) {
            const Coupled *c = &row->coupled[i];

            loads_add_effort(system, loads, &system->origin->instances[c->owner], c->coordinate,
                             expr_mul(arena, lambda, c->slope));
        }
        return;
    }
    if (row->kind == ROW_DOT) {
        Vec b = vec_express(system, row->b, system->kinematics->frames[row->head].chain, tail);

        along = vec_hold(arena, vec_cross(arena, b, along));
    }
    along = vec_scale(arena, push, along);
    if (row->reported.rotation) {
        loads_add_torque(system, loads, row->head, along, chain);
        loads_add_torque(system, loads, row->tail, vec_neg(arena, along), chain);
        return;
    }
    loads_add_force(system, loads, row->head, along, chain);
    loads_add_force(system, loads, row->tail, vec_neg(arena, along), chain);
    if (row->kind == ROW_TIE) {
        Vec moment = vec_scale(arena, expr_neg(arena, row->pitch), along);

        loads_add_torque(system, loads, row->head, moment, chain);
        loads_add_torque(system, loads, row->tail, vec_neg(arena, moment), chain);
    }
    if (row->kind == ROW_CONTACT)
        loads_add_torque(system, loads, row->head, vec_cross(arena, row->point, along), chain);
    if (row->kind == ROW_TAIL || row->kind == ROW_TIE || row->kind == ROW_CONTACT) {
        Vec way = node_way(system, row->tail, row->head);
        Vec moment;

        if (row->kind == ROW_CONTACT)
            way = vec_add(arena, way, vec_express(system, row->point, chain, 0));
        moment = vec_cross(arena, way, vec_express(system, along, chain, 0));

        loads_add_torque(system, loads, row->tail, vec_neg(arena, moment), 0);
    }
}
