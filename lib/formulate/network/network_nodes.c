/* network_nodes.c: long sums of Kirchhoff's two laws, from node to node
 *
 * The across variable of a chord is a sum over a path of branches, the through variable of a branch
 * a sum over a cutset of chords: n^2 terms in a cascade of n switches, as in a multiplier. Where
 * their sides are numbers of a run nobody reads the equations. Then both are summed from node to
 * node, with one more unknown for each node or branch,
 *
 *     p(node) = p(parent) + v of the branch between,   i of a branch = what else meets at its far
 * node
 *
 * (of one that stores the unknown is its rate), so that all rows are short and their factors remain
 * sparse. p is the across variable against the datum up to its sign. */
#include "formulate/formulate_limits.h"
#include "formulate/network/network_impl.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/rates.h"
#include "formulate/system/system_impl.h"

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
    const char *name = system_retain(system, "#%s.%s",
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

/* p, an unknown with its equation; so is p of every node on the path from the datum */
Expr network_nodes_potential(System *system, const Tree *tree, int node)
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

    if (path <= NETWORK_LONG_SUM || system->network->form != NETWORK_STATE ||
        !is_between_resistances(chord))
        return false;
    *out = expr_sub(system->arena, network_nodes_potential(system, tree, edge->head),
                    network_nodes_potential(system, tree, edge->tail));
    return true;
}

bool network_nodes_through(System *system, Branchlike *branch, Expr *out)
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
    if (terms <= NETWORK_LONG_SUM)
        return false;
    branch->is_balanced = kind == RELATION_CAPACITIVE;
    if (!branch->is_balanced)
        *out = new_unknown(system, branch, NODE_BALANCE, "through");
    return true;
}
