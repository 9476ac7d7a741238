/* sections.c: forces and moments in the sections of a beam, by a cut (theory 9)
 *
 * The loads on the part beyond the cut are in equilibrium with its inertia: the section loads, its
 * weight, the applied load there, and the loads on its frames, including those at the cut. */
#include "formulate/dynamics/sections.h"
#include "formulate/dynamics/laws.h"
#include "formulate/dynamics/reactions.h"
#include "formulate/dynamics/shapes.h"
#include "formulate/kinematics/frames.h"
#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

/* force, and moment about the root's origin; axes of the root's orientation class */
typedef struct Wrench {
    Vec force, moment;
} Wrench;

static const Elastic *elastic_of(const System *system, const Instance *part)
{
    const Elastic *elastic = system->dynamics->elastics.at;

    while (elastic->instance != part->number)
        elastic++;
    return elastic;
}

/* 1 where a frame is beyond the cut or at it, otherwise 0 */
static Expr is_beyond(const System *system, const Instance *part, const Instance *frame, Expr at)
{
    static const double rounding = 1e-12; /* of the length */
    Arena *arena = system->arena;
    const Expr error_floor =
        expr_mul(arena, expr_real(arena, rounding), instance_scalar(part, "length"));
    const Expr way =
        expr_add(arena, expr_sub(arena, instance_scalar(frame, "at"), at), error_floor);

    return expr_is_number(way) ? expr_int(arena, expr_value(way) >= 0)
                               : expr_if(arena, expr_call2(arena, OP_LT, way, expr_int(arena, 0)),
                                         expr_int(arena, 0), expr_int(arena, 1));
}

/* loads of the frames beyond the cut on the beam */
static void add_frames(const System *system, const Instance *part, Expr at, const Sums *sums,
                       Wrench *to)
{
    Arena *arena = system->arena;
    const int root = system->kinematics->frames[part->head].chain;

    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *frame = &system->origin->instances[i];
        const SectionFrame *station;
        int speed, chain;
        Wrench own;
        Expr share;
        Vec place;

        if (frame->row->family != FAMILY_ARM || frame->tail != part->head)
            continue;
        station = section_frame_of(system, frame, &speed);
        if (station == NULL)
            continue;
        share = expr_neg(arena, is_beyond(system, part, frame, at));
        own.force = branch_reaction(system, frame, sums, false, &chain);
        own.force = vec_scale(arena, share, vec_express(system, own.force, chain, root));
        own.moment = branch_reaction(system, frame, sums, true, &chain);
        own.moment = vec_scale(arena, share, vec_express(system, own.moment, chain, root));
        place =
            frame_vector(system, part->head,
                         (Vec){{station->position[0], station->position[1], station->position[2]}});
        to->force = vec_add(arena, to->force, own.force);
        to->moment = vec_add(arena, to->moment,
                             vec_add(arena, own.moment, vec_cross(arena, place, own.force)));
    }
}

/* loads on the beam itself */
static Status add_beam(System *system, const Instance *part, Expr at, Wrench *to, Diag *diag)
{
    const Elastic beyond = elastic_beyond(system, elastic_of(system, part), at);
    const int axes = node_axes(system, part->head);
    const int root = system->kinematics->frames[part->head].chain;
    Loads loads = loads_new(system);

    elastic_add_inertia(system, &beyond, &loads, system->shown->actual_alpha,
                        system->shown->actual_a, system->kinematics->accelerations);
    TRY(elastic_add_load(system, &beyond, TAKE_ALL, &loads, diag));
    to->force =
        vec_add(system->arena, to->force, vec_express(system, loads.force[part->head], axes, root));
    to->moment = vec_add(system->arena, to->moment,
                         vec_express(system, loads.torque[part->head], axes, root));
    return OK;
}

/* back by the turns of the section: about z, then the new y, then the newest x */
static Vec in_section(Arena *arena, const SectionFrame *section, Vec v)
{
    for (int k = 0; k < 3; k++) {
        const int i = k == 0 ? 0 : k == 1 ? 2 : 1, j = k == 0 ? 1 : k == 1 ? 0 : 2;
        const Expr c = expr_cos(arena, section->angle[k]), s = expr_sin(arena, section->angle[k]);
        const Expr first = v.at[i], second = v.at[j];

        v.at[i] = expr_add(arena, expr_mul(arena, c, first), expr_mul(arena, s, second));
        v.at[j] = expr_sub(arena, expr_mul(arena, c, second), expr_mul(arena, s, first));
    }
    return v;
}

static Expr component(System *system, const Instance *part, const SectionPart *wanted, Expr at,
                      Wrench beyond)
{
    Arena *arena = system->arena;
    const SectionFrame *section = shapes_point(system, part, at);
    const Rotation back = rotation_transpose(&system->kinematics->frames[part->head].zero);
    const Vec place = {{section->position[0], section->position[1], section->position[2]}};
    const Vec force = rotation_apply(arena, &back, beyond.force);
    const Vec moment =
        vec_sub(arena, rotation_apply(arena, &back, beyond.moment), vec_cross(arena, place, force));

    return in_section(arena, section, wanted->moment ? moment : force).at[wanted->axis];
}

typedef struct SectionQuery {
    const SectionPart *part;
    Expr at;
} SectionQuery;

/* per unit of the multiplier of a redundant row */
static Expr share_of(System *system, const Instance *part, const void *wanted, int redundant)
{
    const SectionQuery *section = wanted;
    Wrench own = {vec_zero(system->arena), vec_zero(system->arena)};

    add_frames(system, part, section->at, system->shown->recovery->sums[redundant], &own);
    return component(system, part, section->part, section->at, own);
}

Status section_force(System *system, const Instance *part, const SectionPart *wanted, Expr at,
                     Expr *out, Diag *diag)
{
    Wrench beyond = {vec_zero(system->arena), vec_zero(system->arena)};
    const Row *open;

    TRY(actual_build(system, diag));
    open = reaction_open_row(system, part, share_of, &(SectionQuery){wanted, at});
    if (open != NULL) {
        (void)diag_set(diag, E_MISSING, "what the sections of %s carry isn't determined",
                       part->name);
        diag_hint(diag,
                  "an equation of %s repeats others in every position, so how they share the load "
                  "is open",
                  system->origin->instances[open->reported.instance].name);
        return E_MISSING;
    }
    add_frames(system, part, at, system->shown->actual, &beyond);
    TRY(add_beam(system, part, at, &beyond, diag));
    *out = component(system, part, wanted, at, beyond);
    return OK;
}
