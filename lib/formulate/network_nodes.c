/* network_nodes.c: long sums of a network's two laws, from node to node
 *
 * Across a chord is a path of branches, through a branch a cutset of chords: in a chain of n
 * switches, as of a multiplier, n^2 terms. Where their sides are numbers of a run nobody reads the
 * equations, and both are summed on the way, with an unknown a node or a branch more,
 *
 *     p(node) = p(parent) + v of the branch between,   i of a branch = what else meets at its far
 * node
 *
 * so that all rows are short and factors of them stay sparse. p is the across variable against the
 * datum up to its sign. */
#include "formulate/network.h"
#include "formulate/origin.h"
#include "formulate/system_impl.h"

#define LONG 8 /* terms, up to which a sum stays one */

static bool is_between_resistances(const Branchlike *branch)
{
    return branch->closed != NULL;
}

static Expr new_unknown(System *system, const Branchlike *branch, NodeLaw law, const char *member)
{
    const Unknown unknown = {.branchlike = -1,
                             .own = -1,
                             .instance = branch->instance,
                             .derives = -1,
                             .law = law,
                             .towards = (int)(branch - system->network->branches.at)};
    const char *name = system_keep(system, "#%s.%s",
                                   graph_edge(system->origin->graph, branch->edge)->name, member);
    const int k = network_new_unknown(system, unknown, name, SYMBOL_ALGEBRAIC);

    return system->network->unknowns.at[k].symbol;
}

/* the branch that leads to a node from its parent */
static Branchlike *branch_to(System *system, const Tree *tree, int node)
{
    return &system->network->branches
                .at[system->network->scalar_of_edge[tree_parent_edge(tree, node)]];
}

/* p, an unknown with its equation; all those on the way from the datum are such, too */
static Expr potential(System *system, const Tree *tree, int node)
{
    const int count = graph_node_count(system->origin->graph);

    if (tree_parent(tree, node) < 0)
        return expr_int(system->arena, 0);
    if (system->network->potentials == NULL)
        system->network->potentials = pool_alloc(system->pool, (size_t)count * sizeof(Expr));
    for (int at = node; tree_parent(tree, at) >= 0 && system->network->potentials[at] == NULL;
         at = tree_parent(tree, at))
        system->network->potentials[at] =
            new_unknown(system, branch_to(system, tree, at), NODE_POTENTIAL, "beyond");
    return system->network->potentials[node];
}

bool network_nodes_across(System *system, const Branchlike *chord, int path, Expr *out)
{
    const Edge *edge = graph_edge(system->origin->graph, chord->edge);
    const Tree *tree = system->origin->trees[branch_tree(system, chord)];

    if (path <= LONG || system->network->form != NETWORK_STATE || !is_between_resistances(chord))
        return false;
    *out = expr_sub(system->arena, potential(system, tree, edge->head),
                    potential(system, tree, edge->tail));
    return true;
}

bool network_nodes_through(System *system, const Branchlike *branch, Expr *out)
{
    const SignMatrix *cutsets = system->network->cutsets[branch_tree(system, branch)];
    const RelationKind kind = branch->relation.kind;
    int terms = 0;

    if (system->network->form != NETWORK_STATE ||
        (kind != RELATION_CAPACITIVE && kind != RELATION_RESISTIVE && kind != RELATION_ACROSS))
        return false;
    for (int c = cutsets->start[branch->cutset]; c < cutsets->start[branch->cutset + 1]; c++)
        terms += is_between_resistances(
            &system->network->branches.at[system->network->scalar_of_edge[cutsets->column[c]]]);
    if (terms <= LONG)
        return false;
    *out = new_unknown(system, branch, NODE_BALANCE, "through");
    return true;
}

/* what of a balance at a node the edge brings: what it takes away */
static Status taken_by(System *system, int edge, int node, Expr *out, Diag *diag)
{
    const Edge *e = graph_edge(system->origin->graph, edge);
    Status status = OK;

    CHECK(network_through(
        system, &system->network->branches.at[system->network->scalar_of_edge[edge]], out, diag));
    if (e->tail == e->head)
        *out = expr_int(system->arena, 0);
    else if (e->head == node)
        *out = expr_neg(system->arena, *out);
done:
    return status;
}

static Status balance_row(System *system, const Branchlike *branch, int node, Unknown *y,
                          Diag *diag)
{
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
    y->right = expr_sum(system->arena, terms.at, terms.count);
done:
    LIST_FREE(terms);
    return status;
}

static Status potential_row(System *system, Branchlike *branch, int node, Unknown *y, Diag *diag)
{
    const Tree *tree = system->origin->trees[branch_tree(system, branch)];
    const Expr before = potential(system, tree, tree_parent(tree, node));
    Expr v;
    Status status = OK;

    CHECK(network_across(system, branch, &v, diag));
    y->right = tree_is_forward(tree, node) ? expr_add(system->arena, before, v)
                                           : expr_sub(system->arena, before, v);
done:
    return status;
}

Status network_nodes_row(System *system, Unknown *y, Diag *diag)
{
    Branchlike *branch = &system->network->branches.at[y->towards];
    const int node =
        tree_far_node(system->origin->trees[branch_tree(system, branch)], branch->edge);

    y->left = y->symbol;
    return y->law == NODE_BALANCE ? balance_row(system, branch, node, y, diag)
                                  : potential_row(system, branch, node, y, diag);
}
