/* network_build.c: reads the relations of a scalar domain, chooses its trees and lists its
 * unknowns */
#include "formulate/network/network_build.h"
#include "formulate/network/ideal_sides.h"
#include "formulate/network/network_impl.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/constraints.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/rates.h"
#include "formulate/system/resolve.h"
#include "formulate/system/smooth.h"
#include "formulate/system/system_impl.h"

#include <string.h>

/* --- relations --- */

/* a source whose value an inverse run computes: an unknown replaces the value */
static void found_value(System *system, Instance *source)
{
    int param = component_source(source->row);

    for (int i = 0; i < system->constraints->drives.count; i++) {
        const Drive *drive = &system->constraints->drives.at[i];

        if (!drive->by_source || system->origin->instances[drive->instance].by != source->number)
            continue;
        source->values = values_copy(system->pool, source->values, source->row->param_count);
        source->values[param].at[0] = drive->effort;
    }
}

static void add_gmin(System *system, Expr across, Relation *relation)
{
    if (relation->kind != RELATION_CONDUCTIVE && relation->kind != RELATION_THROUGH)
        return;
    if (!expr_is_zero(expr_diff(system->arena, relation->value, across)))
        relation->value = expr_add(system->arena, relation->value,
                                   expr_mul(system->arena, system->network->gmin, across));
}

/* i = value(v, i) determines i only by an equation: i - value = 0 */
static void read_own_current(System *system, const Motion1 *motion, Relation *relation)
{
    if ((relation->kind != RELATION_CONDUCTIVE && relation->kind != RELATION_THROUGH) ||
        !expr_depends(relation->value, motion->through))
        return;
    relation->value = expr_sub(system->arena, motion->through, relation->value);
    relation->kind = RELATION_IMPLICIT;
}

static void read_relation(System *system, Branchlike *branch)
{
    const Instance *instance = branch_owner(system, branch);
    Instance source;
    Arena *arena = system->arena;
    Expr zero = expr_int(arena, 0);
    Motion1 motion = {zero, zero, instance_across(instance, arena, branch->which),
                      instance_through(instance, arena, branch->which)};

    if (instance->joint >= 0) {
        const Instance *joint = &system->origin->instances[instance->joint];

        motion.displacement = instance_coordinate(instance, joint, arena, 0);
        motion.rate = instance_coordinate(instance, joint, arena, 1);
    }
    source = *instance;
    found_value(system, &source);
    instance->row->relation(&source, arena, branch->which, &motion, &branch->relation);
    /* a source of current that follows its own voltage is a resistor */
    if (branch->relation.kind == RELATION_THROUGH &&
        !expr_is_zero(expr_diff(arena, branch->relation.value, motion.across)))
        branch->relation.kind = RELATION_CONDUCTIVE;
    read_own_current(system, &motion, &branch->relation);
    if (system->network->gmin != NULL)
        add_gmin(system, motion.across, &branch->relation);
    if (branch->relation.kind == RELATION_IDEAL || branch->relation.switches)
        ideal_set_side(system, branch);
}

/* adds the terms of couplings to the relations of two parts */
static void couple(System *system)
{
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];
        const Instance *parts[2];

        if (instance->row->couple == NULL)
            continue;
        for (int k = 0; k < 2; k++)
            parts[k] = &system->origin->instances[instance->parts[k]];
        for (int k = 0; k < 2; k++)
            instance->row->couple(instance, system->arena, parts, k,
                                  &scalar_branch(system, parts[k], 0)->relation);
    }
}

/* an expression that a relation differentiates must not jump */
static Status check_smooth(System *system, Diag *diag)
{
    Expr e;

    for (int i = 0; i < system->network->branches.count; i++) {
        const Branchlike *branch = &system->network->branches.at[i];

        if (branch->relation.smooth == NULL)
            continue;
        TRY(variables_resolve(system, branch->relation.smooth, &e, diag));
        if (system_need_smooth(system, branch_owner(system, branch)->name, e, NULL) == OK)
            continue;
        (void)diag_set(diag, E_MODEL, "%s takes the derivative of something that jumps",
                       branch_owner(system, branch)->name);
        diag_hint(diag, "filter= smooths it, or give the source a rise time");
        return E_MODEL;
    }
    return OK;
}

static void find_cutsets(System *system, TreeKind kind)
{
    const Tree *tree = system->origin->trees[kind];

    system->network->cutsets[kind] = tree_cutsets(tree);
    for (int r = 0; r < tree_branch_count(tree); r++) {
        Branchlike *branch =
            &system->network->branches.at[system->network->scalar_of_edge[tree_branches(tree)[r]]];

        branch->branch = true;
        branch->cutset = r;
    }
}

/* A start sets what elements store. In the user's tree that must not depend on accelerations, which
 * are computed later. */
static Status check_stored(const System *system, Diag *diag)
{
    const unsigned late = 1U << SYMBOL_ACCELERATION | 1U << SYMBOL_MULTIPLIER;

    for (int i = 0; i < system->network->branches.count; i++) {
        const Branchlike *branch = &system->network->branches.at[i];
        const RelationKind kind = branch->relation.kind;
        const Expr stored = kind == RELATION_CAPACITIVE  ? branch->v
                            : kind == RELATION_INDUCTIVE ? branch->i
                                                         : NULL;

        if (stored != NULL && (expr_kinds(stored) & late) != 0)
            return network_no_rate(system, graph_edge(system->origin->graph, branch->edge)->name,
                                   E_MISSING, diag);
    }
    return OK;
}

/* --- building --- */

static int add_state(System *system, Unknown unknown, const char *name)
{
    int k = network_new_unknown(system, unknown, name, SYMBOL_STATE);

    if (system->network->form == NETWORK_STATE)
        (void)network_add_rate(system, k, SYMBOL_STATE_RATE);
    return k;
}

static void add_states(System *system)
{
    for (int b = 0; b < system->network->branches.count; b++) {
        Branchlike *branch = &system->network->branches.at[b];
        RelationKind kind = branch->relation.kind;

        if ((kind == RELATION_CAPACITIVE && branch->branch) ||
            (kind == RELATION_INDUCTIVE && !branch->branch))
            branch->unknown = add_state(system, network_unknown_of_branch(system, branch),
                                        branch_member(system, branch, !branch->branch));
        if (branch->which > 0 || branch_owner(system, branch)->row->own_state_count == NULL)
            continue;
        for (int k = 0;
             k < branch_owner(system, branch)->row->own_state_count(branch_owner(system, branch));
             k++) {
            const Instance *owner = branch_owner(system, branch);
            OwnState own;

            owner->row->own_state(owner, system->arena, k, &own);
            (void)add_state(
                system,
                (Unknown){.branchlike = -1, .own = k, .instance = branch->instance, .derives = -1},
                system_retain(system, "%s%s%s", owner->name, own.member[0] != '\0' ? "." : "",
                              own.member));
        }
    }
}

static void add_branches(System *system)
{
    int count = graph_edge_count(system->origin->graph);

    system->network->scalar_of_edge = pool_alloc(system->pool, (size_t)count * sizeof(int));
    for (int e = 0; e < count; e++)
        system->network->scalar_of_edge[e] = -1;
    for (int i = 0; i < system->origin->instance_count; i++)
        for (int k = 0; k < system->origin->instances[i].scalar_count; k++) {
            int edge = system->origin->instances[i].scalar_edges[k];

            system->network->scalar_of_edge[edge] = system->network->branches.count;
            LIST_PUSH(
                system->network->branches,
                (Branchlike){.edge = edge, .instance = i, .which = k, .unknown = -1, .ideal = -1});
        }
}

Status network_build(System *system, Diag *diag)
{
    Expr value;

    system->network->is_open = true;
    add_branches(system);
    for (int i = 0; i < system->network->branches.count; i++)
        read_relation(system, &system->network->branches.at[i]);
    couple(system);
    for (TreeKind kind = TREE_ELECTRICAL; kind < TREE_KINDS; kind++) {
        if (system->origin->trees[kind] == NULL)
            continue;
        TRY(network_normal_tree(system, kind, diag));
        find_cutsets(system, kind);
    }
    add_states(system);
    /* chords first: their currents are preferred as unknowns */
    for (int i = 0; i < system->network->branches.count; i++)
        if (!system->network->branches.at[i].branch)
            TRY(network_through(system, &system->network->branches.at[i], &value, diag));
    for (int i = 0; i < system->network->branches.count; i++) {
        TRY(network_across(system, &system->network->branches.at[i], &value, diag));
        TRY(network_through(system, &system->network->branches.at[i], &value, diag));
        TRY(monitor_poll(system->watch));
    }
    TRY(check_smooth(system, diag));
    if (system->network->form == NETWORK_TREE) {
        TRY(network_bring_order(system, diag));
        TRY(check_stored(system, diag));
    }
    network_list(system);
    return OK;
}
