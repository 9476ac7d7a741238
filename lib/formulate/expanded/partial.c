/* partial.c: velocities per unit of a speed, and accelerations at u' = 0, for the expanded form */
#include "formulate/expanded/derivation_impl.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/section_frames.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

/* --- partial velocities --- */

/* the part of the vector from ground to a node whose change is due to speed j itself */
static FrameSum own_velocity(const System *system, int node, int speed)
{
    Expr one = expr_int(system->arena, 1);
    const Speed *own = &system->kinematics->speeds[speed];
    FrameSum sum = {NULL, 0};
    FrameSum slid = {NULL, 0};

    for (; system->kinematics->frames[node].parent >= 0;
         node = system->kinematics->frames[node].parent) {
        const Frame *frame = &system->kinematics->frames[node];

        if (own->chain >= 0 && orientation_is_beyond(system, frame->step_chain, own->chain))
            sum = framesum_add(system, sum, one,
                               framesum_of(system, frame->step_chain, frame->shift));
        if (node == own->slide_node)
            slid = framesum_of(system, frame->step_chain,
                               speed_slide(system, speed, frame->step_chain));
    }
    if (own->chain < 0)
        return slid;
    return framesum_add(system, slid, one, framesum_cross(system, own->axis, own->axis_chain, sum));
}

static Vec own_turn(const System *system, int chain, int speed)
{
    int turned = system->kinematics->speeds[speed].chain;

    if (turned < 0 || !orientation_is_beyond(system, chain, turned))
        return vec_zero(system->arena);
    return speed_axis(system, speed, chain);
}

/* the factor of speed j in a dependent speed; NULL: the dependent speed does not follow from it */
static Expr factor_of(const System *system, int dependent, int j)
{
    const Dependent *own = &system->kinematics->dependents.at[dependent];
    const int i = j - own->first;

    return i >= 0 && i < own->count && !expr_is_zero(own->factor[i]) ? own->factor[i] : NULL;
}

FrameSum partial_velocity(const System *system, int node, int speed)
{
    FrameSum sum = own_velocity(system, node, speed);

    for (int d = 0; d < system->kinematics->dependents.count; d++) {
        const Expr factor = factor_of(system, d, speed);

        if (factor != NULL)
            sum = framesum_add(system, sum, factor,
                               own_velocity(system, node, system->kinematics->u.count + d));
    }
    return sum;
}

Vec partial_turn(const System *system, int chain, int speed)
{
    Vec sum = own_turn(system, chain, speed);

    for (int d = 0; d < system->kinematics->dependents.count; d++) {
        const Expr factor = factor_of(system, d, speed);

        if (factor != NULL)
            sum = vec_add(system->arena, sum,
                          vec_scale(system->arena, factor,
                                    own_turn(system, chain, system->kinematics->u.count + d)));
    }
    return sum;
}

/* --- velocity products --- */

void orientation_motion(const System *system, int chain, Vec *w, Vec *alpha)
{
    Arena *arena = system->arena;
    const OrientationClass *turn = &system->kinematics->chains.at[chain];
    Vec spin;

    *w = *alpha = vec_zero(arena);
    if (turn->parent < 0)
        return;
    orientation_motion(system, turn->parent, w, alpha);
    *w = vec_express(system, *w, turn->parent, chain);
    *alpha = vec_express(system, *alpha, turn->parent, chain);
    spin = vec_zero(arena);
    for (int j = turn->speed; j < turn->speed + turn->speed_count; j++) {
        const Vec axis = speed_axis(system, j, chain);

        spin = vec_add(arena, spin, vec_scale(arena, speed_rate(system, j), axis));
        *alpha =
            vec_add(arena, *alpha, vec_scale(arena, speed_acceleration(system, j, NULL), axis));
    }
    *alpha = vec_add(arena, *alpha, vec_cross(arena, *w, spin));
    *w = vec_add(arena, *w, spin);
}

FrameSum rest_acceleration(const System *system, int node)
{
    Arena *arena = system->arena;
    FrameSum sum = {NULL, 0};

    for (; system->kinematics->frames[node].parent >= 0;
         node = system->kinematics->frames[node].parent) {
        const Frame *frame = &system->kinematics->frames[node];
        Vec slid = vec_zero(arena);
        Vec rest = vec_zero(arena);
        Vec w;
        Vec alpha;
        Vec a;

        if (vec_is_zero(frame->shift))
            continue;
        orientation_motion(system, frame->step_chain, &w, &alpha);
        for (int k = 0; k < frame->slide_count; k++) {
            const Slide *slide = &frame->slide[k];

            slid = vec_add(arena, slid,
                           vec_scale(arena, speed_rate(system, slide->speed), slide->axis));
            rest = vec_add(
                arena, rest,
                vec_scale(arena, speed_acceleration(system, slide->speed, NULL), slide->axis));
        }
        a = vec_add(arena, vec_cross(arena, alpha, frame->shift),
                    vec_cross(arena, w, vec_cross(arena, w, frame->shift)));
        a = vec_add(arena, a, vec_scale(arena, expr_int(arena, 2), vec_cross(arena, w, slid)));
        a = vec_add(arena, a, rest);
        sum = framesum_add(system, sum, expr_int(arena, 1),
                           framesum_of(system, frame->step_chain, a));
    }
    return sum;
}
