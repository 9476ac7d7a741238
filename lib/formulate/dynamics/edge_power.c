/* edge_power.c: through times across variables of mechanical edges
 *
 * An edge acts with F on its head, with T about its head's origin, and with -F and -T - r x F on
 * its tail. Its power is that of these loads on the moving frames (W): F.v, the sum over the graph
 * of translation, and T.w with the moment of F, the sum over the graph of rotation. As the loads of
 * all edges on a node add up to 0, each of the two sums over all edges is 0 (Tellegen's theorem,
 * theory 1). What loads do on shapes of flexible parts is a third sum. */
#include "formulate/dynamics/edge_power.h"
#include "formulate/dynamics/efforts.h"
#include "formulate/dynamics/laws.h"
#include "formulate/dynamics/reactions.h"
#include "formulate/dynamics/shapes.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <string.h>

typedef struct EdgePowers {
    Expr translation, rotation, deformation;
} EdgePowers;

static const char lead[] = "power";

bool edge_power_is_named(const Instance *part, const char *member)
{
    const size_t length = sizeof lead - 1;

    if (strncmp(member, lead, length) != 0 || part->row->family == FAMILY_SCALAR)
        return false;
    member += length;
    return *member == '\0'
               ? component_acts_on_frames(part->row)
               : strcmp(member, ".translation") == 0 || strcmp(member, ".rotation") == 0 ||
                     strcmp(member, ".deformation") == 0;
}

/* d'Alembert's forces and the weight of a body */
static Status add_body(System *system, const Instance *body, Loads *loads, Diag *diag)
{
    const Vec *alpha = system->shown->actual_alpha, *a = system->shown->actual_a;

    for (int i = 0; i < system->dynamics->masses.count; i++)
        if (system->dynamics->masses.at[i].instance == body->number)
            loads_add_mass(system, loads, &system->dynamics->masses.at[i], alpha, a);
    for (int i = 0; i < system->dynamics->elastics.count; i++) {
        const Elastic *elastic = &system->dynamics->elastics.at[i];

        if (elastic->instance != body->number)
            continue;
        elastic_add_inertia(system, elastic, loads, alpha, a, system->kinematics->accelerations);
        TRY(elastic_add_load(system, elastic, TAKE_ALL, loads, diag));
    }
    return OK;
}

/* the reaction of a joint or an arm, on the head and reversed on the tail */
static void add_reaction(System *system, const Instance *part, Loads *loads)
{
    Arena *arena = system->arena;
    const Vec way =
        vec_sub(arena, node_position(system, part->head), node_position(system, part->tail));
    int chain;
    Vec force = rigid_reaction(system, part, false, &chain);
    Vec torque;

    force = vec_express(system, force, chain, 0);
    torque = rigid_reaction(system, part, true, &chain);
    torque = vec_express(system, torque, chain, 0);
    loads_add_force(system, loads, part->head, force, 0);
    loads_add_torque(system, loads, part->head, torque, 0);
    loads_add_force(system, loads, part->tail, vec_neg(arena, force), 0);
    loads_add_torque(system, loads, part->tail,
                     vec_neg(arena, vec_add(arena, torque, vec_cross(arena, way, force))), 0);
}

/* the load of a driver or a coupler, by the multipliers of its rows */
static void add_rows(System *system, const Instance *part, Loads *loads)
{
    const Constraints *constraints = system->constraints;

    for (int k = 0; k < constraints->rows.count; k++)
        if (constraints->rows.at[k].reported.instance == part->number)
            loads_add_row(system, loads, &constraints->rows.at[k], constraints->multipliers[k]);
    for (int k = 0; k < constraints->redundant_rows.count; k++)
        if (constraints->redundant_rows.at[k].reported.instance == part->number)
            loads_add_row(system, loads, &constraints->redundant_rows.at[k],
                          system->shown->recovery->multipliers[k]);
    for (int i = 0; i < constraints->drives.count; i++)
        if (constraints->drives.at[i].instance == part->number)
            drive_add(system, &constraints->drives.at[i], loads);
}

static Status add_loads(System *system, const Instance *part, Loads *loads, Diag *diag)
{
    switch (part->row->family) {
    case FAMILY_BODY:
        return add_body(system, part, loads, diag);
    case FAMILY_ARM:
    case FAMILY_JOINT:
        if (!part->is_virtual)
            add_reaction(system, part, loads);
        return OK;
    case FAMILY_DRIVER:
    case FAMILY_COUPLER:
    case FAMILY_CONTACT:
        add_rows(system, part, loads);
        return OK;
    case FAMILY_FORCE:
    case FAMILY_TRANSDUCER:
        TRY(effort_add(system, part, loads, TAKE_ALL, diag));
        return rotor_add(system, part, loads, diag);
    case FAMILY_SCALAR:
        break;
    }
    return OK;
}

static EdgePowers powers_of(const System *system, const Loads *loads)
{
    const Kinematics *kinematics = system->kinematics;
    Arena *arena = system->arena;
    const Expr zero = expr_int(arena, 0);
    EdgePowers out = {zero, zero, zero};

    for (int n = 0; n < graph_node_count(system->origin->graph); n++) {
        const Frame *frame = &kinematics->frames[n];

        if (!vec_is_zero(loads->force[n]))
            out.translation =
                expr_add(arena, out.translation, vec_dot(arena, loads->force[n], frame->v));
        if (!vec_is_zero(loads->torque[n]))
            out.rotation =
                expr_add(arena, out.rotation,
                         vec_dot(arena, loads->torque[n], kinematics->motions[frame->chain].w));
    }
    for (int j = 0; j < kinematics->u.count; j++)
        if (!expr_is_zero(loads->own[j]))
            out.deformation = expr_add(arena, out.deformation,
                                       expr_mul(arena, loads->own[j], kinematics->u.at[j].symbol));
    return out;
}

Status edge_power(System *system, const Instance *part, const char *member, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    EdgePowers powers;
    Loads loads;

    TRY(actual_build(system, diag));
    loads = loads_new(system);
    TRY(add_loads(system, part, &loads, diag));
    powers = powers_of(system, &loads);
    /* an arm rests on its section, and gives to the shapes what it takes from the frames */
    if (part->row->family == FAMILY_ARM && system->dynamics->elastics.count > 0)
        powers.deformation = expr_neg(arena, expr_add(arena, powers.translation, powers.rotation));
    member += sizeof lead - 1;
    if (strcmp(member, ".translation") == 0)
        *out = powers.translation;
    else if (strcmp(member, ".rotation") == 0)
        *out = powers.rotation;
    else if (strcmp(member, ".deformation") == 0)
        *out = powers.deformation;
    else
        *out =
            expr_sum(arena, (Expr[]){powers.translation, powers.rotation, powers.deformation}, 3);
    return OK;
}
