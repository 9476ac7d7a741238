/* network.c: scalar domains: unknowns by the tree, every other variable along it
 *
 * Initially the through variable of every chord and the across variable of every branch is an
 * unknown, with its own relation as equation. Such a pair is eliminated where the relation gives
 * the unknown, unless following it leads back to the unknown. Other variables follow from the tree:
 * a chord's v from its circuit, a branch's i from its cutset.
 *
 * In state form the tree is a normal tree: capacitors in it and inductors out of it are the states.
 * If an equation needs the rate of an algebraic variable, this rate becomes one more unknown, and
 * the variable's equation is differentiated. In the form of the user's tree any rate of an unknown
 * may occur, and the equations are solved for the highest ones. theory 8. */
#include "formulate/system/network.h"
#include "formulate/network/network_impl.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/rates.h"
#include "formulate/system/resolve.h"
#include "formulate/system/smooth.h"
#include "formulate/system/system_impl.h"

#define DEEP                                                                                       \
    30 /* followed edges, from which on variables stay unknown: variables_resolve() goes to 40 */

/* --- unknowns --- */

Unknown network_unknown_of_branch(const System *system, const Branchlike *branch)
{
    return (Unknown){.branchlike = (int)(branch - system->network->branches.at),
                     .own = -1,
                     .instance = branch->instance,
                     .derives = -1};
}

/* a chord whose current is a stiff function of its voltage, as a diode's */
static bool is_stiff(const System *system, const Branchlike *branch)
{
    const Relation *relation = &branch->relation;

    return !branch->branch &&
           (relation->kind == RELATION_CONDUCTIVE || relation->kind == RELATION_THROUGH) &&
           expr_depends(relation->value, instance_across(branch_owner(system, branch),
                                                         system->arena, branch->which));
}

/* The edge's own variable remains unknown, with its relation as equation. For a stiff chord it is
 * the voltage, from which Newton's method finds the current; the reverse fails. The equation of a
 * stiff chord is its circuit. */
static Status keep_unknown(System *system, Branchlike *branch, Diag *diag)
{
    bool stiff_elements = is_stiff(system, branch);
    const char *name = branch_member(system, branch, !branch->branch && !stiff_elements);
    bool state_form = system->network->form == NETWORK_STATE;

    if (branch->unknown >= 0)
        return OK;
    branch->unknown = network_new_unknown(system, network_unknown_of_branch(system, branch), name,
                                          state_form ? SYMBOL_ALGEBRAIC : SYMBOL_STATE);
    if (!stiff_elements)
        return OK;
    branch->is_stiff = true;
    branch->v = system->network->unknowns.at[branch->unknown].symbol;
    TRY(variables_resolve(system, branch->relation.value, &branch->i, diag));
    branch->i = expr_name_temporary(system->arena, branch->i);
    return OK;
}

/* --- across and through variables --- */

/* sum of across variables along the tree path from tail to head */
Status circuit_across(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    const Edge *edge = graph_edge(system->origin->graph, branch->edge);
    const Tree *tree = system->origin->trees[branch_tree(system, branch)];
    int room = tree_depth(tree, edge->tail) + tree_depth(tree, edge->head);
    int *edges = NEW_ARRAY(int, room);
    int *signs = NEW_ARRAY(int, room);
    Expr *terms = NEW_ARRAY(Expr, room);
    int count = tree_path(tree, edge->tail, edge->head, edges, signs);
    Status status = OK;

    if (network_nodes_across(system, branch, count, out))
        goto done;
    for (int i = 0; i < count; i++) {
        Branchlike *other =
            &system->network->branches.at[system->network->scalar_of_edge[edges[i]]];
        Expr v;

        if (branch->busy && other->busy && other->unknown < 0) {
            /* a loop: then the chord remains unknown, as a mesh current */
            system->network->met_loop = true;
            CHECK(diag_set(diag, E_MISSING, "%s leads back to itself", edge->name));
        }
        CHECK(network_across(system, other, &v, diag));
        terms[i] = signs[i] > 0 ? v : expr_neg(system->arena, v);
    }
    *out = expr_sum(system->arena, terms, count);
done:
    MEM_FREE(edges, signs, terms);
    return status;
}

/* minus the sum of the chords' through variables in the cutset */
static Status cutset_through(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    const SignMatrix *cutsets = system->network->cutsets[branch_tree(system, branch)];
    LIST(Expr) terms = {0};
    Status status = OK;

    if (network_nodes_through(system, branch, out))
        return branch->is_balanced ? network_stored_rate(system, branch, out, diag) : OK;
    for (int k = cutsets->start[branch->cutset]; k < cutsets->start[branch->cutset + 1]; k++) {
        Branchlike *chord =
            &system->network->branches.at[system->network->scalar_of_edge[cutsets->column[k]]];
        Expr i;

        if (chord == branch)
            continue;
        CHECK(network_through(system, chord, &i, diag));
        LIST_PUSH(terms, cutsets->entry[k] < 0 ? i : expr_neg(system->arena, i));
    }
    *out = expr_sum(system->arena, terms.at, terms.count);
done:
    LIST_FREE(terms);
    return status;
}

Status network_no_rate(const System *system, const char *edge, Status status, Diag *diag)
{
    if (status != E_MISSING || system->network->form != NETWORK_TREE)
        return status;
    (void)diag_set(diag, E_MODEL,
                   "in this tree %s follows from accelerations or reactions, or from their rates",
                   edge);
    diag_hint(diag, "take capacitors and their kin into the tree and inductors out of it, or set "
                    "network state");
    return E_MODEL;
}

Status network_stored_rate(System *system, const Branchlike *branch, Expr *out, Diag *diag)
{
    const Relation *relation = &branch->relation;
    Expr rest;

    TRY(variables_resolve(system, relation->content, out, diag));
    TRY(system_need_smooth(system, graph_edge(system->origin->graph, branch->edge)->name, *out,
                           diag));
    TRY(network_no_rate(system, graph_edge(system->origin->graph, branch->edge)->name,
                        system_rate_of(system, *out, out, diag), diag));
    TRY(variables_resolve(system, relation->rest, &rest, diag));
    *out = expr_add(system->arena, *out, rest);
    return OK;
}

/* v = value * i + rest, or i = (v - rest) / value */
static Status resistive(System *system, Branchlike *branch, bool *given, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    Expr other;
    Expr value;
    Expr rest;

    if (!branch->branch && branch->relation.inverse != NULL)
        return variables_resolve(system, branch->relation.inverse, out, diag);
    TRY(branch->branch ? network_through(system, branch, &other, diag)
                       : network_across(system, branch, &other, diag));
    TRY(variables_resolve(system, branch->relation.value, &value, diag));
    TRY(variables_resolve(system, branch->relation.rest, &rest, diag));
    *given = branch->branch || !expr_is_zero(value);
    if (branch->branch)
        *out = expr_add(arena, expr_mul(arena, value, other), rest);
    else if (*given)
        *out = expr_div(arena, expr_sub(arena, other, rest), value);
    return OK;
}

bool port_gives_own(System *system, const Branchlike *branch)
{
    return branch->which == 0 ||
           scalar_branch(system, branch_owner(system, branch), 0)->branch != branch->branch;
}

/* v of a branch or i of a chord where its relation gives it; otherwise *given is false */
static Status by_relation(System *system, Branchlike *branch, bool *given, Expr *out, Diag *diag)
{
    const Relation *relation = &branch->relation;

    *given = true;
    switch (relation->kind) {
    case RELATION_RESISTIVE:
        return resistive(system, branch, given, out, diag);
    case RELATION_ACROSS:
        if (branch->branch)
            return variables_resolve(system, relation->value, out, diag);
        break;
    case RELATION_INDUCTIVE:
        if (branch->branch)
            return network_stored_rate(system, branch, out, diag);
        break;
    case RELATION_THROUGH:
    case RELATION_CONDUCTIVE:
        if (!branch->branch)
            return variables_resolve(system, relation->value, out, diag);
        break;
    case RELATION_CAPACITIVE:
        if (!branch->branch)
            return network_stored_rate(system, branch, out, diag);
        break;
    case RELATION_PORT:
        if (port_gives_own(system, branch))
            return variables_resolve(system, branch->branch ? relation->value : relation->inverse,
                                     out, diag);
        break;
    case RELATION_FREE:
    case RELATION_IMPLICIT:
    case RELATION_IDEAL:
        break;
    }
    *given = false;
    return OK;
}

/* The edge's own variable, v of a branch or i of a chord: given by its relation, or unknown. */
static Status own_variable(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    bool given = false;
    Diag before = diag != NULL ? *diag : (Diag){0};
    Status status = OK;

    *out = NULL;
    if (branch->unknown < 0 && !branch->busy && system->network->follow_depth < DEEP) {
        branch->busy = true;
        system->network->follow_depth++;
        system->asked_early = false;
        status = by_relation(system, branch, &given, out, diag);
        system->network->follow_depth--;
        branch->busy = false;
        if (status != OK &&
            (system->asked_early || (!branch->branch && system->network->met_loop))) {
            /* it depends on forces, and waits until those are built; or there is a loop */
            system->network->met_loop = false;
            given = false;
            status = OK;
            if (diag != NULL)
                *diag = before;
        }
        CHECK(status);
    }
    /* it was met again while being followed, or no relation gives it */
    if (!given)
        CHECK(keep_unknown(system, branch, diag));
    if (branch->is_stiff)
        *out = branch->i;
    else if (branch->unknown >= 0)
        *out = system->network->unknowns.at[branch->unknown].symbol;
done:
    return status;
}

Status network_across(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    if (branch->v == NULL) {
        if (branch->branch)
            TRY(own_variable(system, branch, out, diag));
        else
            TRY(circuit_across(system, branch, out, diag));
        if (!branch->is_stiff)
            branch->v = expr_name_temporary(system->arena, *out);
    }
    *out = branch->v;
    return OK;
}

Status network_through(System *system, Branchlike *branch, Expr *out, Diag *diag)
{
    if (branch->i == NULL) {
        if (branch->branch)
            TRY(cutset_through(system, branch, out, diag));
        else
            TRY(own_variable(system, branch, out, diag));
        if (!branch->is_stiff)
            branch->i = expr_name_temporary(system->arena, *out);
    }
    *out = branch->i;
    return OK;
}
