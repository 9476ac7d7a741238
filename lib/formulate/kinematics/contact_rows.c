/* contact_rows.c: velocity of one frame's point against another's, projected on directions, or the
 * angular velocity of one frame against another
 *
 * With the way d (m) from the tail's origin to the head's and rho (m) from there to the point,
 *
 *     n . (v_h + w_h x rho - v_t - w_t x (d + rho)) = 0
 *
 * is a row in the speeds (m/s). Where n . d has a rate that equals it, as along the normal of a
 * contact, the row has a position too. theory 14. */
#include "formulate/kinematics/contact_rows.h"

#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/system_impl.h"

#include <string.h>

/* the angle of the head against the tail in a planar scene: a sum of turns */
static Expr angle_between(System *system, const Instance *part)
{
    Arena *arena = system->arena;
    const Frame *tail = &system->kinematics->frames[part->tail],
                *head = &system->kinematics->frames[part->head];
    const Rotation back = rotation_transpose(&tail->zero);
    const Rotation constant = rotation_product(arena, &back, &head->zero);
    const Vec out_of_plane = {{expr_int(arena, 0), expr_int(arena, 0), expr_int(arena, 1)}};
    Expr sum = rotation_angle(arena, &constant, out_of_plane);
    Turns turns = {0};

    turns_between(system, tail->chain, head->chain, &turns);
    for (int i = 0; i < turns.count; i++)
        sum = expr_add(arena, sum, expr_mul(arena, turns.at[i].axis.at[2], turns.at[i].angle));
    LIST_FREE(turns);
    return sum;
}

/* a vector of ground axes in those of a node's frame */
static Vec in_frame(const System *system, int node, Vec v)
{
    const Frame *frame = &system->kinematics->frames[node];
    const Rotation back = rotation_transpose(&frame->zero);

    return rotation_apply(system->arena, &back, vec_express(system, v, 0, frame->chain));
}

void frames_apart(System *system, const Instance *part, FramesApart *out)
{
    Arena *arena = system->arena;
    const int tail = system->kinematics->frames[part->tail].chain;
    const int head = system->kinematics->frames[part->head].chain;
    const Rotation back = rotation_transpose(&system->kinematics->frames[part->tail].zero);
    const Vec way =
        vec_hold(arena, in_frame(system, part->tail, node_way(system, part->tail, part->head)));

    *out = (FramesApart){0};
    memcpy(out->way, way.at, sizeof way.at);
    for (int i = 0; i < 3; i++) {
        Vec axis = vec_zero(arena);

        axis.at[i] = expr_int(arena, 1);
        axis = vec_express(system, frame_vector(system, part->head, axis), head, tail);
        axis = vec_hold(arena, rotation_apply(arena, &back, axis));
        for (int k = 0; k < 3; k++)
            out->turn[3 * k + i] = axis.at[k];
    }
    if (system->origin->planar)
        out->angle = angle_between(system, part);
}

void contact_of(System *system, const Instance *part, Contact *out)
{
    FramesApart apart;

    frames_apart(system, part, &apart);
    part->row->contact(part, system->arena, system->origin->planar, &apart, out);
}

/* whether only constant shifts and turns are between two frames */
static bool is_fixed_to(const System *system, int a, int b)
{
    const Frame *frames = system->kinematics->frames;
    int ends[2] = {a, b};

    for (int i = 0; i < 2; i++)
        while (frames[ends[i]].parent >= 0 && frames[ends[i]].slide_count == 0 &&
               frames[ends[i]].step_chain == frames[a].chain)
            ends[i] = frames[ends[i]].parent;
    return frames[a].chain == frames[b].chain && ends[0] == ends[1];
}

/* The velocity of the head's point against the tail's, all in ground axes. It begins with the rate
 * of d: velocities of the recursive form would be turned to and fro. */
static Status slip_of(System *system, const Instance *part, Vec point, Vec *out, Diag *diag)
{
    Arena *arena = system->arena;
    const Vec way = node_way(system, part->tail, part->head);
    const Vec of_head = vec_cross(arena, node_turn_rate(system, part->head, 0), point);
    const Vec of_tail =
        vec_cross(arena, node_turn_rate(system, part->tail, 0), vec_add(arena, way, point));
    Vec v;

    for (int i = 0; i < 3; i++)
        TRY(system_rate_of(system, way.at[i], &v.at[i], diag));
    *out = vec_hold(arena, vec_add(arena, v, vec_sub(arena, of_head, of_tail)));
    return OK;
}

Status contact_slip(System *system, const Instance *part, Vec point, Vec *out, Diag *diag)
{
    if (is_fixed_to(system, part->tail, part->head)) {
        (void)diag_set(diag, E_MODEL, "the frames of %s, %s and %s, do not move against each other",
                       part->name, graph_node(system->origin->graph, part->tail)->name,
                       graph_node(system->origin->graph, part->head)->name);
        diag_hint(diag, "the tail belongs to what is rolled on, as ground, the tip to what rolls");
        return E_MODEL;
    }
    return slip_of(system, part, point, out, diag);
}

Status frames_rate(System *system, const Instance *part, Vec *rate, Vec *turn_rate, Diag *diag)
{
    Arena *arena = system->arena;
    Vec v;

    TRY(slip_of(system, part, vec_zero(arena), &v, diag));
    *rate = vec_hold(arena, in_frame(system, part->tail, v));
    v = vec_sub(arena, node_turn_rate(system, part->head, 0),
                node_turn_rate(system, part->tail, 0));
    *turn_rate = vec_hold(arena, in_frame(system, part->tail, v));
    return OK;
}

Status contact_rows_push(System *system, const Instance *part, Diag *diag)
{
    Arena *arena = system->arena;
    const int tail = system->kinematics->frames[part->tail].chain;
    Contact contact;
    Vec point, slip, turning;

    contact_of(system, part, &contact);
    point = vec_hold(arena,
                     frame_vector(system, part->tail,
                                  (Vec){{contact.point[0], contact.point[1], contact.point[2]}}));
    TRY(contact_slip(system, part, vec_express(system, point, tail, 0), &slip, diag));
    turning = vec_sub(arena, node_turn_rate(system, part->head, 0),
                      node_turn_rate(system, part->tail, 0));
    for (int i = 0; i < contact.count; i++) {
        const ContactRow *own = &contact.row[i];
        const Vec along = {{own->along[0], own->along[1], own->along[2]}};
        Row row = {.kind = ROW_CONTACT, .tail = part->tail, .head = part->head, .point = point};

        row.n = vec_hold(arena, frame_vector(system, part->tail, along));
        row.rate = expr_name_temporary(arena, vec_dot(arena, vec_express(system, row.n, tail, 0),
                                                      own->turns ? turning : slip));
        row.phi = own->gap != NULL ? own->gap : expr_int(arena, 0);
        row.reported = (ConstraintRow){.edge = part->edge,
                                       .instance = part->number,
                                       .is_rate = own->gap == NULL,
                                       .rotation = own->turns};
        (void)strncpy(row.reported.direction, own->direction, sizeof row.reported.direction - 1);
        LIST_PUSH(system->constraints->rows, row);
    }
    return OK;
}

Vec contact_point(System *system, const Instance *part)
{
    Contact contact;
    Vec point;

    contact_of(system, part, &contact);
    point = frame_vector(system, part->tail,
                         (Vec){{contact.point[0], contact.point[1], contact.point[2]}});
    point = vec_express(system, point, system->kinematics->frames[part->tail].chain, 0);
    return vec_add(system->arena, node_position(system, part->head), point);
}
