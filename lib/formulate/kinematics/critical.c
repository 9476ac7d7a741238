/* critical.c: where three turns in a row lose a freedom
 *
 * Turns about u1, u2, u3 with u2 orthogonal to both span all rotations, except where the first and
 * the last axis are parallel: after a sequence such as zxz at u2's angle 0 or half a turn, after
 * one such as zyx at a quarter turn. */
#include "formulate/kinematics/frames.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

bool system_critical(const System *system, int i, Critical *out)
{
    Arena *arena = system->arena;

    for (int k = 0; k < system->origin->instance_count; k++) {
        const Instance *instance = &system->origin->instances[k];
        Steps steps;
        const Expr *first;
        const Expr *last;
        Expr middle;
        bool alike = true;

        if (instance->row->steps == NULL || instance->edge < 0)
            continue;
        instance_steps(system, instance, &steps);
        if (steps.turn_count != 3 ||
            system->kinematics->coordinate[k][steps.turn[1].coordinate] < 0 || i-- > 0)
            continue;
        first = steps.turn[0].axis;
        last = steps.turn[2].axis;
        for (int c = 0; c < 3; c++)
            alike = alike && first[c] == last[c];
        middle =
            system->kinematics->q.at[system->kinematics->coordinate[k][steps.turn[1].coordinate]]
                .symbol;
        *out = (Critical){.instance = instance->name,
                          .coordinate = instance->coord[steps.turn[1].coordinate],
                          .angles = alike ? "0 or 180 deg" : "90 or -90 deg",
                          .measure = alike ? expr_sin(arena, middle) : expr_cos(arena, middle)};
        return true;
    }
    return false;
}
