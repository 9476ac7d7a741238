/* energy.c: energies, and the power of sources and losses
 *
 * For masses: T = sum (m v.v + w.I w)/2 and V = -sum m g.r (J), with the velocity v of the mass
 * centre, its position r, and gravity g. Rotors, flexible parts and elements that store energy add
 * their own terms. The power P (W) of sources minus losses satisfies d/dt(T + V) = P. */
#include "formulate/dynamics/bushings.h"
#include "formulate/dynamics/efforts.h"
#include "formulate/dynamics/laws.h"
#include "formulate/dynamics/rubbing.h"
#include "formulate/dynamics/shapes.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

enum { SHORT = 4 }; /* terms; a longer sum is worth avoiding */

typedef LIST(Expr) EnergyTerms;

static Expr half(Arena *arena)
{
    return expr_rational(arena, 1, 2);
}

static void push(const System *system, EnergyTerms *terms, Expr scale, Expr a, Expr b)
{
    LIST_PUSH(*terms, expr_product(system->arena, (Expr[]){scale, a, b}, 3));
}

/* energy stored in a scalar edge; 0 where it is unknown */
static Expr stored_field(System *system, const Branchlike *branch)
{
    Expr stored = expr_int(system->arena, 0);

    if (branch->relation.stored != NULL &&
        variables_resolve(system, branch->relation.stored, &stored, NULL) != OK)
        stored = expr_int(system->arena, 0);
    return stored;
}

/* flywheels and slugs store kinetic energy, as does the liquid of an inertance */
static bool is_of_motion(const System *system, const Branchlike *branch)
{
    Domain domain = graph_edge(system->origin->graph, branch->edge)->domain;

    if (domain == DOMAIN_HYDRAULIC)
        return branch->relation.kind == RELATION_INDUCTIVE;
    return (domain == DOMAIN_SHAFT || domain == DOMAIN_SLIDE) &&
           branch->relation.kind == RELATION_CAPACITIVE;
}

static void push_stored(System *system, EnergyTerms *terms, bool of_motion)
{
    for (int i = 0; i < system->network->branches.count; i++)
        if (is_of_motion(system, &system->network->branches.at[i]) == of_motion)
            LIST_PUSH(*terms, stored_field(system, &system->network->branches.at[i]));
}

Expr system_kinetic(System *system)
{
    system_touch(system);
    Arena *arena = system->arena;
    EnergyTerms terms = {0};
    Expr sum;

    for (int i = 0; i < system->dynamics->masses.count; i++) {
        const Mass *mass = &system->dynamics->masses.at[i];
        Vec v = system->kinematics->frames[mass->node].v;
        Vec w = system->kinematics->motions[system->kinematics->frames[mass->node].chain].w;

        push(system, &terms, half(arena), mass->mass, vec_dot(arena, v, v));
        if (mass->has_inertia)
            push(system, &terms, half(arena), expr_int(arena, 1),
                 vec_dot(arena, w, rotation_apply(arena, &mass->inertia, w)));
    }
    for (int i = 0; i < system->dynamics->elastics.count; i++)
        LIST_PUSH(terms, elastic_kinetic(system, &system->dynamics->elastics.at[i]));
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];
        Expr rate;

        if (instance->row->rotor == NULL || instance->joint < 0 ||
            coordinate_value(system, &system->origin->instances[instance->joint],
                             instance->joint_coordinate, 1, &rate, NULL) != OK)
            continue;
        push(system, &terms, half(arena), instance->row->rotor(instance, arena),
             expr_square(arena, rate));
    }
    push_stored(system, &terms, true);
    sum = expr_sum(arena, terms.at, terms.count);
    LIST_FREE(terms);
    return sum;
}

/* energy of a spring at a displacement */
static bool stored_in(System *system, const Effort *effort, Expr displacement, Expr *out)
{
    Expr zero = expr_int(system->arena, 0);
    Motion1 motion = {displacement, effort->rate, zero, zero};
    Expr stored = effort->instance->row->potential(effort->instance, system->arena, &motion);

    return variables_resolve(system, stored, out, NULL) == OK;
}

/* Distance of each node along gravity times gravity, shift by shift: positions in the axes of
 * the datum would rotate each shift by all the turns before it. New, mem_free(). */
static Expr *falls_of(const System *system, const Vec *gravity)
{
    Arena *arena = system->arena;
    Expr *falls = NEW_ARRAY(Expr, graph_node_count(system->origin->graph));
    int nodes;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);

    falls[order[0]] = expr_int(arena, 0);
    for (int i = 1; i < nodes; i++) {
        const Frame *frame = &system->kinematics->frames[order[i]];
        const int axes = system->kinematics->chains.at[frame->step_chain].resolve;
        const Vec step = vec_carry_held(system, frame->shift, frame->step_chain, axes);
        const Expr further = vec_dot(arena, gravity[axes], step);

        falls[order[i]] =
            expr_name_temporary(arena, expr_add(arena, falls[frame->parent], further));
    }
    return falls;
}

static void push_weights(const System *system, EnergyTerms *terms)
{
    Arena *arena = system->arena;
    Vec *gravity;
    Expr *falls;

    if (system->origin->trees[TREE_TRANSLATION] == NULL)
        return;
    gravity = NEW_ARRAY(Vec, system->kinematics->chains.count);
    vec_express_outward(system, system->origin->gravity, gravity);
    falls = falls_of(system, gravity);
    for (int i = 0; i < system->dynamics->masses.count; i++) {
        const Mass *mass = &system->dynamics->masses.at[i];

        push(system, terms, expr_int(arena, -1), mass->mass, falls[mass->node]);
    }
    for (int i = 0; i < system->dynamics->elastics.count; i++) {
        const Elastic *elastic = &system->dynamics->elastics.at[i];
        const ShapeInertia *b = &elastic->block;
        const int axes = node_axes(system, elastic->node);
        const Vec moment = vec_express(system, elastic_vector(system, elastic, b->moment),
                                       system->kinematics->frames[elastic->node].chain, axes);

        push(system, terms, expr_int(arena, -1), b->mass, falls[elastic->node]);
        LIST_PUSH(*terms, expr_neg(arena, vec_dot(arena, gravity[axes], moment)));
    }
    MEM_FREE(gravity, falls);
}

Expr system_potential(System *system)
{
    system_touch(system);
    Arena *arena = system->arena;
    EnergyTerms terms = {0};
    Expr sum;

    push_weights(system, &terms);
    for (int i = 0; i < system->dynamics->elastics.count; i++)
        LIST_PUSH(terms, system->dynamics->elastics.at[i].block.stored);
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];
        BushingLoad bushing;
        Effort effort;
        Expr stored;

        if (instance->row->potential != NULL && effort_of(system, instance, &effort, NULL) == OK &&
            stored_in(system, &effort, effort.displacement, &stored))
            LIST_PUSH(terms, stored);
        if (instance->row->restore != NULL && bushing_of(system, instance, &bushing, NULL) == OK)
            LIST_PUSH(terms, bushing.stored);
    }
    push_stored(system, &terms, false);
    sum = expr_sum(arena, terms.at, terms.count);
    LIST_FREE(terms);
    return sum;
}

/* the part of an effort that does not derive from a potential */
static Expr lost_effort(System *system, const Effort *effort)
{
    Arena *arena = system->arena;
    Expr at = expr_symbol(arena, "displacement", SYMBOL_ARGUMENT);
    Expr stored;

    if (effort->instance->row->potential == NULL || !stored_in(system, effort, at, &stored))
        return effort->value;
    stored = expr_diff(arena, stored, at);
    stored = expr_substitute(arena, stored, &at, &effort->displacement, 1);
    return expr_add(arena, effort->value, stored);
}

static void push_wrench(System *system, EnergyTerms *terms, const Instance *instance)
{
    Arena *arena = system->arena;
    const Frame *frame = &system->kinematics->frames[instance->head];
    int resolve_chain = system->kinematics->chains.at[frame->chain].resolve;
    Expr one = expr_int(arena, 1);
    Vec force;
    Vec torque;
    int chain;

    if (wrench_of(system, instance, TAKE_ALL, &force, &torque, &chain, NULL) != OK)
        return;
    force = vec_express(system, force, chain, resolve_chain);
    torque = vec_express(system, torque, chain, resolve_chain);
    push(system, terms, one, one, vec_dot(arena, force, frame->v));
    push(system, terms, one, one,
         vec_dot(arena, torque, system->kinematics->motions[frame->chain].w));
}

/* whether a sum along the tree has few terms: then it is written out, so that terms of two edges
 * may cancel */
static bool is_short(Expr e)
{
    return expr_kind(e) != EXPR_SUM || expr_arg_count(e) <= SHORT;
}

/* v and i of a scalar edge: their product is the power into it. Where the rate of a state times a
 * number is a sum over many edges along the tree, it follows from that rate. */
static void power_of(System *system, const Branchlike *branch, Expr *v, Expr *i)
{
    const RelationKind kind = branch->relation.kind;
    const bool is_state = (kind == RELATION_CAPACITIVE && branch->branch) ||
                          (kind == RELATION_INDUCTIVE && !branch->branch);
    Expr *derived = kind == RELATION_CAPACITIVE ? i : v;
    Expr rate;

    *v = branch->v;
    *i = branch->i;
    if (is_state && system->network->form == NETWORK_STATE && !is_short(*derived) &&
        network_stored_rate(system, branch, &rate, NULL) == OK)
        *derived = rate;
}

/* Subtracts the power that scalar edges absorb and do not store. Heat flow is a power by itself,
 * and the balance excludes it. */
static void push_network(System *system, EnergyTerms *terms)
{
    Arena *arena = system->arena;

    for (int i = 0; i < system->network->branches.count; i++) {
        const Branchlike *branch = &system->network->branches.at[i];
        Expr v, through, rate;

        if (graph_edge(system->origin->graph, branch->edge)->domain == DOMAIN_THERMAL)
            continue;
        if (system_rate_of(system, stored_field(system, branch), &rate, NULL) == OK)
            LIST_PUSH(*terms, rate);
        else if (expr_is_zero(branch->relation.rest))
            continue; /* all power into it is stored */
        power_of(system, branch, &v, &through);
        push(system, terms, expr_int(arena, -1), v, through);
    }
}

/* of drivers, and -lambda n of couplers of rates that follow time */
static void push_drives(System *system, EnergyTerms *terms)
{
    Arena *arena = system->arena;
    Expr rate;

    for (int k = 0; k < system->constraints->rows.count; k++) {
        const Row *row = &system->constraints->rows.at[k];

        if (row->kind == ROW_DRIVER &&
            coordinate_value(system, &system->origin->instances[row->owner], row->coordinate, 1,
                             &rate, NULL) == OK)
            push(system, terms, expr_int(arena, -1), system->constraints->multipliers[k], rate);
        if (row->reported.is_rate)
            push(system, terms, expr_int(arena, -1), system->constraints->multipliers[k],
                 system->definitions.nu[k]);
    }
}

/* damping and applied load */
static void push_elastic(System *system, const Elastic *elastic, EnergyTerms *terms)
{
    Arena *arena = system->arena;
    const ShapeInertia *b = &elastic->block;
    const Instance *part = &system->origin->instances[elastic->instance];
    const int node = elastic->node, chain = system->kinematics->frames[node].chain;
    Loads loads = loads_new(system);

    for (int i = 0; i < part->coord_count - part->pose_count; i++)
        LIST_PUSH(*terms, expr_mul(arena, expr_sub(arena, b->push[i], b->stress[i]),
                                   system->kinematics->u.at[elastic->first + i].symbol));
    if (elastic_add_load(system, elastic, TAKE_ALL, &loads, NULL) != OK)
        return;
    LIST_PUSH(*terms, vec_dot(arena, loads.force[node], system->kinematics->frames[node].v));
    LIST_PUSH(*terms, vec_dot(arena, loads.torque[node], system->kinematics->motions[chain].w));
    for (int i = 0; i < part->coord_count - part->pose_count; i++)
        LIST_PUSH(*terms, expr_mul(arena, loads.own[elastic->first + i],
                                   system->kinematics->u.at[elastic->first + i].symbol));
}

Expr system_power(System *system)
{
    system_touch(system);
    Arena *arena = system->arena;
    EnergyTerms terms = {0};
    Expr *sum = &system->shown->power;

    if (*sum != NULL)
        return *sum;
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];
        Effort effort;
        FrictionLoad rubbing;
        BushingLoad bushing;

        if (instance->row->wrench != NULL)
            push_wrench(system, &terms, instance);
        if (instance->row->effort != NULL && effort_of(system, instance, &effort, NULL) == OK)
            push(system, &terms, expr_int(arena, 1), lost_effort(system, &effort), effort.rate);
        if (instance->row->rub != NULL &&
            rubbing_of(system, instance, TAKE_ALL, &rubbing, NULL) == OK)
            LIST_PUSH(terms, rubbing.power);
        if (instance->row->restore != NULL && bushing_of(system, instance, &bushing, NULL) == OK)
            LIST_PUSH(terms, bushing.power);
    }
    for (int i = 0; i < system->dynamics->elastics.count; i++)
        push_elastic(system, &system->dynamics->elastics.at[i], &terms);
    push_network(system, &terms);
    push_drives(system, &terms);
    *sum = expr_sum(arena, terms.at, terms.count);
    LIST_FREE(terms);
    return *sum;
}
