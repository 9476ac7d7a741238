/* critical.c: where turns are singular: three in a row, and a rotation vector
 *
 * Turns about u1, u2, u3 with u2 orthogonal to both span all rotations, except where the first and
 * the last axis are parallel: after a sequence such as zxz at u2's angle 0 or half a turn, after
 * one such as zyx at a quarter turn.
 *
 * A rotation vector jumps to the opposite one at half a turn. */
#include "formulate/kinematics/contact_rows.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/rotation_vector.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

/* whether a part has three turns in a row that are coordinates */
static bool critical_turns(const System *system, const Instance *part, Critical *out)
{
    Arena *arena = system->arena;
    const int *coordinates = system->kinematics->coordinate[part->number];
    Steps steps;
    Expr middle;
    bool alike = true;

    if (part->row->steps == NULL || part->edge < 0)
        return false;
    instance_steps(system, part, &steps);
    if (steps.turn_count != 3 || coordinates[steps.turn[1].coordinate] < 0)
        return false;
    for (int c = 0; c < 3; c++)
        alike = alike && steps.turn[0].axis[c] == steps.turn[2].axis[c];
    middle = system->kinematics->q.at[coordinates[steps.turn[1].coordinate]].symbol;
    *out = (Critical){.instance = part->name,
                      .coordinate = part->coord[steps.turn[1].coordinate],
                      .angles = alike ? "0 or 180 deg" : "90 or -90 deg",
                      .effect = "three angles have no rates",
                      .remedy = "another sequence or Euler parameters avoid it",
                      .measure = alike ? expr_sin(arena, middle) : expr_cos(arena, middle)};
    return true;
}

/* whether a part acts by a rotation vector */
static bool critical_vector(System *system, const Instance *part, Critical *out)
{
    RotationVector phi;
    FramesApart apart;

    if (part->row->restore == NULL || system->origin->planar)
        return false;
    frames_apart(system, part, &apart);
    rotation_vector_of(system->arena, apart.turn, &phi);
    *out = (Critical){.instance = part->name,
                      .coordinate = "its angle",
                      .angles = "180 deg",
                      .effect = "its moment jumps to the opposite one",
                      .remedy = "a stiffer part or a stop avoids it",
                      .measure = phi.half_cos};
    return true;
}

bool system_critical(System *system, int i, Critical *out)
{
    system_touch(system);
    for (int k = 0; k < system->origin->instance_count; k++) {
        const Instance *part = &system->origin->instances[k];

        if ((critical_turns(system, part, out) || critical_vector(system, part, out)) && i-- == 0)
            return true;
    }
    return false;
}
