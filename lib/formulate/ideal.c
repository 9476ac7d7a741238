/* ideal.c: switches and diodes without resistance
 *
 * A system with both sides of each in one equation is for looking at, and for operating points:
 *
 *     diode    i = max(0, i + g (v - least)), g = 1 S; any g > 0 has the same solutions
 *     switch   v = on i while it is closed, v = off i or i = 0 while it is open
 *
 * In a mode each is on one side. A closed one is a source of across, an open one a source of
 * through variables, of nothing: so the normal tree is another one, and with it what is a state.
 * theory 8. */
#include "formulate/ideal.h"
#include "formulate/network.h"
#include "formulate/origin.h"
#include "formulate/system_impl.h"
#include "graph/sets.h"

/* --- relations --- */

static Expr both_sides(System *system, const Ideal *ideal, Expr v, Expr i)
{
    Arena *arena = system->arena;
    Expr closed = expr_sub(arena, expr_sub(arena, v, ideal->least), expr_mul(arena, ideal->on, i));
    Expr open = i;

    if (ideal->when == NULL)
        return expr_sub(arena, i,
                        expr_call2(arena, OP_MAX, expr_int(arena, 0), expr_add(arena, i, closed)));
    if (ideal->off != NULL)
        open = expr_sub(arena, v, expr_mul(arena, ideal->off, i));
    return expr_if(arena, ideal->when, closed, open);
}

/* Where the side is a number of the run, as between two resistances, the equation of both is this
 * one, which gives neither v nor i: a large resistance times a current, and a voltage over a small
 * one, would tell little but rounding.
 *
 *     closed = 1: v = on (i - least/off) + least, closed = 0: v/off = i
 *
 * Without `off` 1/off is 0. */
static Expr either_side(System *system, Expr closed, const Ideal *ideal, Expr v, Expr i)
{
    Arena *arena = system->arena;
    Expr one = expr_int(arena, 1);
    Expr leak = ideal->off != NULL ? expr_div(arena, one, ideal->off) : expr_int(arena, 0);
    Expr meets =
        expr_mul(arena, ideal->least, expr_sub(arena, one, expr_mul(arena, ideal->on, leak)));

    return expr_add(
        arena,
        expr_mul(arena, closed,
                 expr_sub(arena, expr_sub(arena, v, meets), expr_mul(arena, ideal->on, i))),
        expr_mul(arena, expr_sub(arena, one, closed),
                 expr_sub(arena, expr_mul(arena, v, leak), i)));
}

/* one side, as the relation of a source or a resistor */
static void one_side(System *system, bool closed, Relation *relation)
{
    const Ideal *ideal = &relation->ideal;
    Expr zero = expr_int(system->arena, 0);

    relation->rest = zero;
    if (closed && expr_is_zero(ideal->on)) {
        relation->kind = RELATION_ACROSS;
        relation->value = ideal->least;
    } else if (closed) {
        relation->kind = RELATION_RESISTIVE;
        relation->value = ideal->on;
        relation->rest = ideal->least;
    } else if (ideal->off != NULL) {
        relation->kind = RELATION_RESISTIVE;
        relation->value = ideal->off;
    } else {
        relation->kind = RELATION_THROUGH;
        relation->value = zero;
    }
}

void ideal_take_side(System *system, Branchlike *branch)
{
    const Instance *instance = &system->origin->instances[branch->instance];
    const char *name = graph_edge(system->origin->graph, branch->edge)->name;
    Relation *relation = &branch->relation;
    Expr v = instance_across(instance, system->arena, branch->which);
    Expr i = instance_through(instance, system->arena, branch->which);

    branch->ideal = system->network->ideals.count;
    LIST_PUSH(system->network->ideals, (int)(branch - system->network->branches.at));
    if (relation->switches ? system->network->takes_sides
                           : relation->kind == RELATION_IDEAL && system->network->takes_all) {
        branch->closed =
            expr_symbol(system->arena, system_keep(system, "#%s.closed", name), SYMBOL_PARAMETER);
        relation->kind = RELATION_IDEAL;
        relation->value = either_side(system, branch->closed, &relation->ideal, v, i);
    } else if (relation->kind == RELATION_IDEAL && system->network->closed != NULL) {
        one_side(system, system->network->closed[branch->ideal], relation);
    } else if (relation->kind == RELATION_IDEAL) {
        relation->value = both_sides(system, &relation->ideal, v, i);
    }
}

/* --- modes that keep states --- */

static bool is_of_time(Expr e)
{
    return e == NULL || (expr_kinds(e) & ~(1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER)) == 0;
}

/* what an edge is to the states: a source of across or of through variables (or what stores as
 * such), or neither; *known: its relation tells */
static RelationKind state_kind(const Branchlike *branch, const bool *closed, bool *known)
{
    const Relation *relation = &branch->relation;

    if (relation->switches)
        return RELATION_RESISTIVE;
    *known = is_of_time(relation->rest); /* else it may hold what other edges carry */
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

/* No circuit of what gives across variables, no cutset of what gives through variables. */
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

/* --- looking --- */

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
