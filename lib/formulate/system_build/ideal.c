/* ideal.c: switches of a network, and which modes have the states of the hybrid system */
#include "formulate/system_build/ideal.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"
#include "graph/sets.h"

static bool is_of_time(Expr e)
{
    return e == NULL || (expr_kinds(e) & ~(1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER)) == 0;
}

/* role of an edge for the states: a source of across or of through variables (or an element that
 * stores these), or neither; *known: its relation determines it */
static RelationKind state_kind(const Branchlike *branch, const bool *closed, bool *known)
{
    const Relation *relation = &branch->relation;

    if (relation->switches)
        return RELATION_RESISTIVE;
    *known = is_of_time(relation->rest); /* otherwise it may contain variables of other edges */
    switch (relation->kind) {
    case RELATION_ACROSS:
    case RELATION_THROUGH:
        *known = *known && is_of_time(relation->value);
        return relation->kind;
    case RELATION_CAPACITIVE:
        return RELATION_ACROSS;
    case RELATION_INDUCTIVE:
        return RELATION_THROUGH;
    case RELATION_IDEAL:
        if (closed[branch->ideal])
            return expr_is_zero(relation->ideal.on) ? RELATION_ACROSS : RELATION_RESISTIVE;
        return relation->ideal.off == NULL ? RELATION_THROUGH : RELATION_RESISTIVE;
    default:
        *known = *known && relation->kind == RELATION_RESISTIVE && is_of_time(relation->value);
        return RELATION_RESISTIVE;
    }
}

/* No circuit of sources of across variables, no cutset of sources of through variables. */
bool ideal_keeps_states(const System *system, const bool *closed)
{
    const Network *network = system->network;
    const int nodes = graph_node_count(system->origin->graph);
    Sets *across = sets_new(nodes), *joined = sets_new(nodes);
    bool keeps = network->form == NETWORK_STATE;

    for (int i = 0; i < network->branches.count && keeps; i++) {
        const Branchlike *branch = &network->branches.at[i];
        const Edge *edge = graph_edge(system->origin->graph, branch->edge);
        const RelationKind kind = state_kind(branch, closed, &keeps);

        if (kind == RELATION_ACROSS)
            keeps = keeps && sets_join(across, edge->tail, edge->head);
        if (kind != RELATION_THROUGH)
            (void)sets_join(joined, edge->tail, edge->head);
    }
    for (int i = 0; i < network->branches.count && keeps; i++) {
        const Edge *edge = graph_edge(system->origin->graph, network->branches.at[i].edge);

        keeps = sets_find(joined, edge->tail) == sets_find(joined, edge->head);
    }
    sets_free(across);
    sets_free(joined);
    return keeps;
}

/* --- queries --- */

int system_scalar_count(const System *system)
{
    return system->network->branches.count;
}

int system_ideal_count(const System *system)
{
    return system->network->ideals.count;
}

static const Branchlike *switching(const System *system, int i)
{
    return &system->network->branches.at[system->network->ideals.at[i]];
}

bool system_is_ideal(const System *system, int i)
{
    return !switching(system, i)->relation.switches;
}

int system_truly_ideal_count(const System *system)
{
    int count = 0;

    for (int i = 0; i < system->network->ideals.count; i++)
        count += system_is_ideal(system, i);
    return count;
}

Expr system_side(const System *system, int i)
{
    return switching(system, i)->closed;
}

bool system_has_modes(const System *system)
{
    if (system->network->ideals.count == 0)
        return false;
    return system_truly_ideal_count(system) > 0 ||
           (system->network->form == system->network->asked_form &&
            (system->network->form == NETWORK_STATE || !system->network->leaves_trees));
}
