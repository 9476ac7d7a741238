/* network_node_rows.c: the equations of the unknowns that replace long sums (network_nodes.c) */
#include "formulate/network/network_impl.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

/* share of an edge in the balance at a node: the through variable that it draws */
static Status taken_by(System *system, int edge, int node, Expr *out, Diag *diag)
{
    const Edge *e = graph_edge(system->origin->graph, edge);

    TRY(network_through(
        system, &system->network->branches.at[system->network->scalar_of_edge[edge]], out, diag));
    if (e->tail == e->head)
        *out = expr_int(system->arena, 0);
    else if (e->head == node)
        *out = expr_neg(system->arena, *out);
    return OK;
}

Status network_nodes_balance(System *system, const Branchlike *branch, Expr *out, Diag *diag)
{
    const int node =
        tree_far_node(system->origin->trees[branch_tree(system, branch)], branch->edge);
    const bool leads_here = graph_edge(system->origin->graph, branch->edge)->head == node;
    const int *edges;
    const int count = graph_edges_at(system->origin->graph, node, &edges);
    LIST(Expr) terms = {0};
    Status status = OK;

    for (int i = 0; i < count; i++) {
        Expr taken;

        if (edges[i] == branch->edge || system->network->scalar_of_edge[edges[i]] < 0)
            continue;
        CHECK(taken_by(system, edges[i], node, &taken, diag));
        LIST_PUSH(terms, leads_here ? taken : expr_neg(system->arena, taken));
    }
    *out = expr_sum(system->arena, terms.at, terms.count);
done:
    LIST_FREE(terms);
    return status;
}

static Status potential_row(System *system, Branchlike *branch, int node, Unknown *y, Diag *diag)
{
    const Tree *tree = system->origin->trees[branch_tree(system, branch)];
    const Expr before = network_nodes_potential(system, tree, tree_parent(tree, node));
    Expr v;

    TRY(network_across(system, branch, &v, diag));
    y->right = tree_is_forward(tree, node) ? expr_add(system->arena, before, v)
                                           : expr_sub(system->arena, before, v);
    return OK;
}

Status network_nodes_row(System *system, Unknown *y, Diag *diag)
{
    Branchlike *branch = &system->network->branches.at[y->towards];
    const int node =
        tree_far_node(system->origin->trees[branch_tree(system, branch)], branch->edge);

    y->left = y->symbol;
    return y->law == NODE_BALANCE ? network_nodes_balance(system, branch, &y->right, diag)
                                  : potential_row(system, branch, node, y, diag);
}
