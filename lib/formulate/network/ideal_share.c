/* ideal_share.c: relations of ideal switches, and indeterminate circuits and cutsets of switches
 *
 * A circuit of closed switches alone leaves their currents undetermined, and a cutset of open
 * switches alone their voltages. They are distributed as by equal resistances, whatever their size.
 * theory 8. */
#include "formulate/network/ideal_sides.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/system_impl.h"

/* --- shares in indeterminate circuits and cutsets --- */

/* an ideal switch without resistance in that state */
static bool is_on_side(const Branchlike *branch, RelationKind kind)
{
    return branch->ideal >= 0 && !branch->relation.switches && branch->relation.kind == kind;
}

/* for a closed chord: i around the circuit. Where voltages remain there is none. */
static Status share_circuit(System *system, const Branchlike *branch, bool *shared, Expr *out,
                            Diag *diag)
{
    const Edge *edge = graph_edge(system->origin->graph, branch->edge);
    const Tree *tree = system->origin->trees[branch_tree(system, branch)];
    int room = tree_depth(tree, edge->tail) + tree_depth(tree, edge->head);
    int *edges = NEW_ARRAY(int, room);
    int *signs = NEW_ARRAY(int, room);
    int count = tree_path(tree, edge->tail, edge->head, edges, signs);
    Expr left = expr_neg(system->arena, branch->relation.value);
    Status status = OK;

    *shared = true;
    *out = branch->i;
    for (int k = 0; k < count && *shared; k++) {
        Branchlike *other =
            &system->network->branches.at[system->network->scalar_of_edge[edges[k]]];
        Expr sign = expr_int(system->arena, signs[k]);
        Expr i;

        *shared = is_on_side(other, RELATION_ACROSS);
        if (!*shared)
            break;
        CHECK(network_through(system, other, &i, diag));
        *out = expr_sub(system->arena, *out, expr_mul(system->arena, sign, i));
        left = expr_add(system->arena, left, expr_mul(system->arena, sign, other->relation.value));
    }
    *shared = *shared && expr_is_zero(expr_fold(system->arena, left));
done:
    MEM_FREE(edges, signs);
    return status;
}

/* for an open branch: v across the cutset */
static Status share_cutset(System *system, const Branchlike *branch, bool *shared, Expr *out,
                           Diag *diag)
{
    const SignMatrix *cutsets = system->network->cutsets[branch_tree(system, branch)];

    *shared = true;
    *out = branch->v;
    for (int k = cutsets->start[branch->cutset]; k < cutsets->start[branch->cutset + 1] && *shared;
         k++) {
        Branchlike *chord =
            &system->network->branches.at[system->network->scalar_of_edge[cutsets->column[k]]];
        Expr v;

        if (chord == branch)
            continue;
        *shared = is_on_side(chord, RELATION_THROUGH);
        TRY(network_across(system, chord, &v, diag));
        *out = cutsets->entry[k] < 0 ? expr_sub(system->arena, *out, v)
                                     : expr_add(system->arena, *out, v);
    }
    return OK;
}

Status ideal_share(System *system, const Branchlike *branch, bool *shared, Expr *out, Diag *diag)
{
    *shared = false;
    if (system->network->form != NETWORK_STATE)
        return OK;
    if (!branch->branch && branch->relation.kind == RELATION_ACROSS)
        return share_circuit(system, branch, shared, out, diag);
    if (branch->branch && branch->relation.kind == RELATION_THROUGH)
        return share_cutset(system, branch, shared, out, diag);
    return OK;
}

/* --- queries --- */

Status system_scalar(System *system, int i, ScalarPair *out, Diag *diag)
{
    system_touch(system);
    Branchlike *branch = &system->network->branches.at[i];
    ScalarPair pair = {.name = system->origin->instances[branch->instance].name,
                       .domain = graph_edge(system->origin->graph, branch->edge)->domain,
                       .gives_across = branch->relation.kind == RELATION_ACROSS,
                       .gives_through = branch->relation.kind == RELATION_THROUGH,
                       .stores = branch->relation.kind == RELATION_CAPACITIVE ||
                                 branch->relation.kind == RELATION_INDUCTIVE,
                       .switches = branch->ideal >= 0,
                       .gives_any = branch->relation.kind == RELATION_FREE,
                       .energy_known = branch->relation.stored != NULL};

    TRY(network_across(system, branch, &pair.across, diag));
    TRY(network_through(system, branch, &pair.through, diag));
    *out = pair;
    return OK;
}

/* the index in [x'; z] of the branch's unknown, and so of its equation */
static int row_of(const System *system, const Branchlike *branch)
{
    if (system->network->closed != NULL || branch->unknown < 0 || branch->relation.switches)
        return -1;
    for (int k = 0; k < system->network->z.count; k++)
        if (system->network->z.at[k].symbol == system->network->unknowns.at[branch->unknown].symbol)
            return system->network->x.count + k;
    return -1;
}

/* event function of a diode in a mode: the reverse voltage of an open one, the current of a closed
 * one */
static Expr margin_of(const System *system, int i, const IdealSwitch *diode)
{
    Arena *arena = system->arena;
    Expr backwards = expr_neg(arena, diode->across);

    if (diode->closed == NULL)
        return system->network->closed[i] ? diode->through : backwards;
    return expr_add(arena, expr_mul(arena, diode->closed, diode->through),
                    expr_mul(arena, expr_sub(arena, expr_int(arena, 1), diode->closed), backwards));
}

Status system_ideal(System *system, int i, IdealSwitch *out, Diag *diag)
{
    system_touch(system);
    Branchlike *branch = &system->network->branches.at[system->network->ideals.at[i]];
    const Ideal *ideal = &branch->relation.ideal;
    IdealSwitch found = {.name = system->origin->instances[branch->instance].name,
                         .domain = graph_edge(system->origin->graph, branch->edge)->domain,
                         .row = row_of(system, branch)};

    TRY(network_across(system, branch, &found.across, diag));
    TRY(network_through(system, branch, &found.through, diag));
    TRY(variables_resolve(system, ideal->least, &found.least, diag));
    TRY(variables_resolve(system, ideal->on, &found.on, diag));
    found.across = expr_sub(system->arena, found.across, found.least);
    found.closed = branch->closed;
    if (ideal->off != NULL)
        TRY(variables_resolve(system, ideal->off, &found.off, diag));
    if (ideal->when != NULL)
        TRY(variables_resolve(system, ideal->when, &found.when, diag));
    else if (ideal->off != NULL)
        found.through =
            expr_sub(system->arena, found.through, expr_div(system->arena, found.least, found.off));
    if (ideal->when == NULL && system->network->closed != NULL)
        found.margin = margin_of(system, i, &found);
    *out = found;
    return OK;
}
