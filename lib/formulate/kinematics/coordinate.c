/* coordinate.c: values of coordinates, also of chords; derivatives along the motion */
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/framesum.h"
#include "formulate/kinematics/multi_turn.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

Expr speed_partial(const System *system, Expr e, int speed)
{
    Arena *arena = system->arena;
    Expr sum = expr_int(arena, 0);

    for (int i = 0; i < system->kinematics->q.count; i++) {
        const CoordinateRate *rate = &system->kinematics->coordinate_rates[i];

        for (int k = 0; k < rate->count; k++)
            if (rate->speed[k] == speed) {
                Expr slope = expr_diff(arena, e, system->kinematics->q.at[i].symbol);

                sum = expr_add(arena, sum, expr_mul(arena, slope, rate->entry[k]));
            }
    }
    return sum;
}

bool steps_are_tied(const Steps *steps)
{
    return steps->shift_count == 1 && steps->turn_count == 1 &&
           steps->shift[0].coordinate == steps->turn[0].coordinate;
}

/* a slide of a chord: the component along the axis of the vector from tail to head */
Expr slide_value(const System *system, const Instance *owner, const Step *slide)
{
    Vec axis =
        frame_vector(system, owner->tail, (Vec){{slide->axis[0], slide->axis[1], slide->axis[2]}});
    FrameSum along = framesum_of(system, system->kinematics->frames[owner->tail].chain, axis);

    return framesum_dot(system, along, framesum_way(system, owner->tail, owner->head));
}

Rotation chord_constant(const System *system, const Instance *joint, const Steps *steps)
{
    Rotation constant;
    Rotation back = rotation_transpose(&system->kinematics->frames[joint->tail].zero);

    for (int i = 0; i < 9; i++)
        constant.at[i] = steps->rotation[i];
    constant = rotation_transpose(&constant);
    constant =
        rotation_product(system->arena, &system->kinematics->frames[joint->head].zero, &constant);
    return rotation_product(system->arena, &constant, &back);
}

static Vec turn_axis(const Step *turn)
{
    return (Vec){{turn->axis[0], turn->axis[1], turn->axis[2]}};
}

/* an axis of the tail after the joint's turns: fixed in the head, in components of the tail */
static Vec far_axis(const System *system, const Instance *owner, const Rotation *constant, Vec axis)
{
    axis = rotation_apply(system->arena, constant, frame_vector(system, owner->tail, axis));
    return vec_express(system, axis, system->kinematics->frames[owner->head].chain,
                       system->kinematics->frames[owner->tail].chain);
}

/* first or second of two turns u1, u2 (theory 2, coordinate of a chord) */
static void universal_turn(const System *system, const Instance *owner, const Steps *steps,
                           int which, ChordTurn *out)
{
    Arena *arena = system->arena;
    Rotation constant = chord_constant(system, owner, steps);
    Vec u1 = frame_vector(system, owner->tail, turn_axis(&steps->turn[0]));
    Vec u2 = frame_vector(system, owner->tail, turn_axis(&steps->turn[1]));
    Vec far1 = far_axis(system, owner, &constant, turn_axis(&steps->turn[0]));
    Vec far2 = far_axis(system, owner, &constant, turn_axis(&steps->turn[1]));

    out->sine = which == 0 ? vec_dot(arena, far2, vec_cross(arena, u1, u2))
                           : expr_neg(arena, vec_dot(arena, far1, vec_cross(arena, u1, far2)));
    out->cosine = which == 0 ? vec_dot(arena, far2, u2) : vec_dot(arena, far1, u1);
}

void chord_turn(const System *system, const Instance *owner, const Steps *steps, int which,
                ChordTurn *out)
{
    Arena *arena = system->arena;
    Vec axis = frame_vector(system, owner->tail, turn_axis(&steps->turn[which]));
    Rotation constant = chord_constant(system, owner, steps);
    Turns turns = {0};
    Expr rest = rotation_angle(arena, &constant, axis);
    Vec n1 = vec_zero(arena);
    Vec n2 = n1;

    *out = (ChordTurn){0};
    turns_between(system, system->kinematics->frames[owner->tail].chain,
                  system->kinematics->frames[owner->head].chain, &turns);
    if (steps->turn_count > 1)
        universal_turn(system, owner, steps, which, out);
    else if (turns.count == 0)
        out->angle = rest;
    else if (turns.count == 1 && turns.at[0].matrix == NULL && vec_same(turns.at[0].axis, axis))
        out->angle = expr_add(arena, turns.at[0].angle, rest);
    else if (turns.count == 1 && turns.at[0].matrix == NULL &&
             vec_same(turns.at[0].axis, vec_neg(arena, axis)))
        out->angle = expr_sub(arena, rest, turns.at[0].angle);
    else {
        axis_complement(arena, steps->turn[which].axis, n1.at, n2.at);
        axis = far_axis(system, owner, &constant, n1);
        out->sine = vec_dot(arena, frame_vector(system, owner->tail, n2), axis);
        out->cosine = vec_dot(arena, frame_vector(system, owner->tail, n1), axis);
    }
    /* an angle that is constant in these trees has full turns like any other */
    if (out->angle == NULL &&
        ((expr_kinds(out->sine) | expr_kinds(out->cosine)) & 1U << SYMBOL_COORDINATE) == 0)
        out->angle = expr_call2(arena, OP_ATAN2, out->sine, out->cosine);
    LIST_FREE(turns);
}

Vec joint_axis(const System *system, const Instance *owner, const Steps *steps, int which,
               int *chain)
{
    int speed = system->kinematics->speed[owner->number][steps->turn[which].coordinate];

    if (which == 0) {
        *chain = system->kinematics->frames[owner->tail].chain;
        return frame_vector(system, owner->tail, turn_axis(&steps->turn[0]));
    }
    if (which == steps->turn_count - 1) {
        Rotation constant = chord_constant(system, owner, steps);

        *chain = system->kinematics->frames[owner->head].chain;
        return rotation_apply(system->arena, &constant,
                              frame_vector(system, owner->tail, turn_axis(&steps->turn[which])));
    }
    /* a turn between two others has no coordinate unless it is a branch */
    *chain = system->kinematics->speeds[speed].axis_chain;
    return system->kinematics->speeds[speed].axis;
}

/* Three turns u1, u2, u3, each axis orthogonal to the one before, R = R1 R2 R3. With n = u1 x u2, w
 * = R u3 in the tail:
 *
 *     u3 = s n, s = 1 or -1   s (w.u1) = sin a2,  s (-w.u2, w.n) = cos a2 (sin a1, cos a1)
 *                             (-s u1.R u2, u1.R u1) = cos a2 (sin a3, cos a3)
 *     u3 = u1                 w.u1 = cos a2,  (w.u2, -w.n) = sin a2 (sin a1, cos a1)
 *                             (u1.R u2, u1.R n) = sin a2 (sin a3, cos a3)
 *
 * The middle turn is within a quarter turn of 0, or of 0 to half a turn; where a1 and a3 turn about
 * one line they have no value. theory 2. */
static Expr euler_angle(const System *system, const Instance *owner, const Steps *steps, int which)
{
    Arena *arena = system->arena;
    const Rotation constant = chord_constant(system, owner, steps);
    const Vec a1 = turn_axis(&steps->turn[0]), a2 = turn_axis(&steps->turn[1]);
    const Vec a3 = turn_axis(&steps->turn[2]), side = vec_cross(arena, a1, a2);
    const Expr sense = vec_dot(arena, a3, side); /* 0: the first axis returns */
    const bool returns = expr_is_zero(sense);
    const Vec u1 = frame_vector(system, owner->tail, a1),
              u2 = frame_vector(system, owner->tail, a2);
    const Vec n = frame_vector(system, owner->tail, side);
    const Vec far = far_axis(system, owner, &constant, a3);
    Expr sine, cosine, size;

    if (which == 2) {
        sine = vec_dot(arena, u1, far_axis(system, owner, &constant, a2));
        cosine = vec_dot(arena, u1, far_axis(system, owner, &constant, returns ? side : a1));
    } else {
        sine = vec_dot(arena, far, u2);
        cosine = vec_dot(arena, far, n);
    }
    size = expr_add(arena, expr_square(arena, sine), expr_square(arena, cosine));
    if (which == 1 && returns)
        return expr_call2(arena, OP_ATAN2, expr_sqrt(arena, size), vec_dot(arena, far, u1));
    if (which == 1)
        return expr_call2(arena, OP_ATAN2, expr_mul(arena, sense, vec_dot(arena, far, u1)),
                          expr_sqrt(arena, size));
    if (!returns)
        sine = expr_neg(arena, expr_mul(arena, sense, sine));
    if (which == 0)
        cosine = expr_mul(arena, returns ? expr_int(arena, -1) : sense, cosine);
    /* undefined where both are 0 */
    return expr_call2(arena, OP_ATAN2, expr_div(arena, sine, size), expr_div(arena, cosine, size));
}

/* difference in depth of two nodes up to which the vector between them is written out */
enum { FAR_APART = 20 };

/* The same by positions, from node to node. A written-out vector past many turns would rotate each
 * of its shifts through all of them. */
static Expr far_slide(System *system, const Instance *owner, const Step *slide)
{
    Arena *arena = system->arena;
    Vec axis =
        frame_vector(system, owner->tail, (Vec){{slide->axis[0], slide->axis[1], slide->axis[2]}});

    axis = vec_express(system, axis, system->kinematics->frames[owner->tail].chain, 0);
    return vec_dot(
        arena, axis,
        vec_sub(arena, node_position(system, owner->head), node_position(system, owner->tail)));
}

static Expr shown_slide(System *system, const Instance *owner, const Step *slide)
{
    const Tree *tree = system->origin->trees[TREE_TRANSLATION];
    const int apart = tree_depth(tree, owner->head) - tree_depth(tree, owner->tail);

    return apart > FAR_APART || apart < -FAR_APART ? far_slide(system, owner, slide)
                                                   : slide_value(system, owner, slide);
}

static Status chord_value(System *system, const Instance *owner, int coordinate, Expr *out,
                          Diag *diag)
{
    Steps steps;

    instance_steps(system, owner, &steps);
    for (int k = 0; k < steps.shift_count && !steps_are_tied(&steps); k++)
        if (steps.shift[k].coordinate == coordinate) {
            *out = shown_slide(system, owner, &steps.shift[k]);
            return OK;
        }
    for (int k = 0; k < steps.turn_count && steps.turn_count < 3; k++) {
        ChordTurn turn;

        if (steps.turn[k].coordinate != coordinate)
            continue;
        /* its shift determines full turns too */
        if (steps_are_tied(&steps) && !owner->is_virtual) {
            *out = expr_div(system->arena, shown_slide(system, owner, &steps.shift[0]),
                            steps.shift[0].scale);
            return OK;
        }
        *out = multi_turn_angle(system, owner->number, coordinate);
        if (*out != NULL)
            return OK;
        chord_turn(system, owner, &steps, k, &turn);
        *out = turn.angle != NULL ? expr_add(system->arena, turn.angle,
                                             multi_turn_whole(system, owner->number, coordinate))
                                  : expr_call2(system->arena, OP_ATAN2, turn.sine, turn.cosine);
        return OK;
    }
    if (steps.quaternion && coordinate >= steps.first_parameter) {
        Expr p[4];

        relative_parameters(system, owner->tail, owner->head, p);
        *out = p[coordinate - steps.first_parameter];
        return OK;
    }
    (void)diag_set(diag, E_MISSING,
                   "%s: can't be determined while %s is a chord of the rotation tree",
                   owner->coord[coordinate], owner->name);
    diag_hint(diag, "tree rotation + %s - EDGE makes it a branch", owner->name);
    return E_MISSING;
}

Status coordinate_value(System *system, const Instance *owner, int coordinate, int primes,
                        Expr *out, Diag *diag)
{
    int place = system->kinematics->coordinate[owner->number][coordinate];

    if (primes > 2)
        return diag_set(diag, E_MISSING, "%s: no more than two derivatives",
                        owner->coord[coordinate]);
    if (place >= 0) {
        int speed = system->kinematics->speed[owner->number][coordinate];

        *out = primes == 0 ? system->kinematics->q.at[place].symbol : system_q_rate(system, place);
        if (primes == 2 && speed >= 0 && system->kinematics->coordinate_rates[place].count == 1)
            *out = system->kinematics->accelerations[speed];
        else if (primes == 2)
            return system_rate_of(system, *out, out, diag);
        return OK;
    }
    TRY(chord_value(system, owner, coordinate, out, diag));
    for (; primes > 0; primes--)
        TRY(system_rate_of(system, *out, out, diag));
    return OK;
}

Status coordinate_shown(System *system, const Instance *owner, int coordinate, int primes,
                        Expr *out, Diag *diag)
{
    Steps steps;

    instance_steps(system, owner, &steps);
    if (system->kinematics->coordinate[owner->number][coordinate] < 0 && primes <= 2 &&
        steps.turn_count == 3)
        for (int k = 0; k < 3; k++)
            if (steps.turn[k].coordinate == coordinate) {
                *out = euler_angle(system, owner, &steps, k);
                for (; primes > 0; primes--)
                    TRY(system_rate_of(system, *out, out, diag));
                return OK;
            }
    return coordinate_value(system, owner, coordinate, primes, out, diag);
}
