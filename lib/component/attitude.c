/* attitude.c: unrestrained rotation: Euler parameters, or a sequence of turns
 *
 * Bodies, free and spherical joints have it. A sequence names the axes of three turns, each about
 * an axis of the frame after the turns before it: zxz turns about z, about the new x, about the
 * newest z. Neighbouring axes differ, which leaves twelve sequences. */
#include "component/component_rows.h"

#include <string.h>

const CoordinateRow free_coords[FREE_COORDS] = {
    {"x", COORDINATE_LENGTH, false},    {"y", COORDINATE_LENGTH, false},
    {"z", COORDINATE_LENGTH, false},    {"q0", COORDINATE_PARAMETER, true},
    {"q1", COORDINATE_PARAMETER, true}, {"q2", COORDINATE_PARAMETER, true},
    {"q3", COORDINATE_PARAMETER, true},
};

const CoordinateRow free_coords_planar[FREE_COORDS_PLANAR] = {
    {"x", COORDINATE_LENGTH, false},
    {"y", COORDINATE_LENGTH, false},
    {"theta", COORDINATE_ANGLE, true},
};

static const CoordinateRow free_coords_turns[] = {
    {"x", COORDINATE_LENGTH, false}, {"y", COORDINATE_LENGTH, false},
    {"z", COORDINATE_LENGTH, false}, {"a1", COORDINATE_ANGLE, true},
    {"a2", COORDINATE_ANGLE, true},  {"a3", COORDINATE_ANGLE, true},
};

/* the axes' letters; NULL: Euler parameters */
static const char *sequence_of(const Instance *instance)
{
    const char *word = instance_value(instance, "euler")->word;

    return word == NULL || strlen(word) != 3 ? NULL : word;
}

const CoordinateRow *free_coords_of(const Instance *instance, int *count)
{
    bool turns = sequence_of(instance) != NULL;

    *count = turns ? COUNT(free_coords_turns) : FREE_COORDS;
    return turns ? free_coords_turns : free_coords;
}

const CoordinateRow *spherical_coords_of(const Instance *instance, int *count)
{
    const CoordinateRow *rows = free_coords_of(instance, count);

    *count -= FREE_SHIFTS;
    return rows + FREE_SHIFTS;
}

void attitude_steps(const Instance *instance, Arena *arena, int first, Steps *out)
{
    const char *axes = sequence_of(instance);

    out->quaternion = axes == NULL;
    out->first_parameter = axes == NULL ? first : 0;
    for (int i = 0; axes != NULL && i < 3; i++) {
        Expr axis[3];

        for (int k = 0; k < 3; k++)
            axis[k] = expr_int(arena, axes[i] == 'x' + k);
        steps_turn(arena, out, axis, first + i);
    }
}

void free_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    Expr zero = expr_int(arena, 0);
    Expr one = expr_int(arena, 1);

    steps_none(arena, out);
    for (int i = 0; i < (planar ? 2 : FREE_SHIFTS); i++) {
        Expr axis[3] = {zero, zero, zero};

        axis[i] = one;
        steps_shift(arena, out, axis, i);
    }
    if (planar)
        steps_turn(arena, out, (Expr[3]){zero, zero, one}, 2);
    else
        attitude_steps(instance, arena, FREE_SHIFTS, out);
}

Status attitude_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    Status status;

    (void)arena;
    if (!planar || sequence_of(instance) == NULL)
        return OK;
    status = diag_set(diag, E_VALUE, "%s turns about z alone: a plane has no sequence of turns",
                      instance->name);
    diag_hint(diag, "leave out euler=; it is for spatial scenes");
    diag_about(diag, "euler");
    return status;
}
