/* bushings.c: force and moment of a bushing
 *
 * The efforts e = -K x - D x' act along the coordinates x of the head in axes of the tail. Those
 * along the position are the force F on the head's origin; the others have the moment T with
 * T . w = e . phi' for every angular velocity w of the head against the tail. So the power of F and
 * T is e . x', and the energy stored is x . K x/2. */
#include "formulate/dynamics/bushings.h"

#include "formulate/dynamics/laws.h"
#include "formulate/kinematics/contact_rows.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/kinematics/rotation_vector.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

#include <string.h>

enum { PLANAR = 3, SPATIAL = 6 };

static int count_of(const System *system)
{
    return system->origin->planar ? PLANAR : SPATIAL;
}

/* e, the energy stored and the power of dampers, over x and x' */
static Status restore(System *system, const Instance *part, BushingLoad *b, Diag *diag)
{
    Arena *arena = system->arena;
    Expr lost[MOST_RELATIVE];

    for (int i = 0; i < b->count; i++)
        b->effort[i] = lost[i] = expr_int(arena, 0);
    b->stored = part->row->restore(part, arena, b->count, b->x, b->rate, b->effort, lost);
    b->power = expr_int(arena, 0);
    for (int i = 0; i < b->count; i++) {
        TRY(law_read(system, part, b->effort[i], &b->effort[i], diag));
        TRY(law_read(system, part, lost[i], &lost[i], diag));
        b->power = expr_add(arena, b->power, expr_mul(arena, lost[i], b->rate[i]));
    }
    return law_read(system, part, b->stored, &b->stored, diag);
}

/* x, and in space the rotation vector */
static void place(System *system, const Instance *part, BushingLoad *b, RotationVector *phi)
{
    FramesApart apart;

    *b = (BushingLoad){.count = count_of(system)};
    frames_apart(system, part, &apart);
    if (b->count == PLANAR) {
        b->x[0] = apart.way[0];
        b->x[1] = apart.way[1];
        b->x[2] = apart.angle;
        return;
    }
    rotation_vector_of(system->arena, apart.turn, phi);
    for (int i = 0; i < 3; i++) {
        b->x[i] = apart.way[i];
        b->x[3 + i] = phi->at.at[i];
    }
}

Status bushing_of(System *system, const Instance *part, BushingLoad *out, Diag *diag)
{
    Arena *arena = system->arena;
    const Expr zero = expr_int(arena, 0);
    RotationVector phi;
    Vec rate;

    place(system, part, out, &phi);
    TRY(frames_rate(system, part, &out->motion, &out->turning, diag));
    if (out->count == PLANAR) {
        out->rate[0] = out->motion.at[0];
        out->rate[1] = out->motion.at[1];
        out->rate[2] = out->turning.at[2];
        TRY(restore(system, part, out, diag));
        out->force = (Vec){{out->effort[0], out->effort[1], zero}};
        out->torque = (Vec){{zero, zero, out->effort[2]}};
        return OK;
    }
    rate = rotation_vector_rate(arena, &phi, out->turning);
    for (int i = 0; i < 3; i++) {
        out->rate[i] = out->motion.at[i];
        out->rate[3 + i] = rate.at[i];
    }
    TRY(restore(system, part, out, diag));
    memcpy(out->force.at, out->effort, sizeof out->force.at);
    memcpy(out->torque.at, out->effort + 3, sizeof out->torque.at);
    out->torque = rotation_vector_moment(arena, &phi, vec_hold(arena, out->torque));
    return OK;
}

Status bushing_add(System *system, const Instance *part, Loads *loads, Diag *diag)
{
    Arena *arena = system->arena;
    BushingLoad b;

    TRY(bushing_of(system, part, &b, diag));
    loads_add_between(system, loads, part,
                      vec_hold(arena, frame_vector(system, part->tail, b.force)),
                      vec_hold(arena, frame_vector(system, part->tail, b.torque)));
    return OK;
}

Status bushing_variable(System *system, const Instance *part, const char *member, Expr *out,
                        Diag *diag)
{
    const bool moment = member[0] == 't' || member[0] == 'T';
    const bool own = member[0] == 'F' || member[0] == 'T';
    BushingLoad b;
    Vec load;

    TRY(bushing_of(system, part, &b, diag));
    load = moment ? b.torque : b.force;
    if (!own)
        load = vec_express(system, frame_vector(system, part->tail, load),
                           system->kinematics->frames[part->tail].chain, 0);
    *out = load.at[member[1] - 'x'];
    return OK;
}
