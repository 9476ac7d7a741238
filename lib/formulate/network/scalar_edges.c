/* scalar_edges.c: the edges of scalar domains: their parts, trees and names */
#include "formulate/network/scalar_edges.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

const Instance *branch_owner(const System *system, const Branchlike *branch)
{
    return &system->origin->instances[branch->instance];
}

Branchlike *scalar_branch(System *system, const Instance *instance, int which)
{
    return &system->network->branches
                .at[system->network->scalar_of_edge[instance->scalar_edges[which]]];
}

const char *branch_member(const System *system, const Branchlike *branch, bool through)
{
    const Edge *edge = graph_edge(system->origin->graph, branch->edge);

    return system_retain(system, "%s.%s", edge->name,
                         through ? domain_through(edge->domain) : domain_across(edge->domain));
}

TreeKind branch_tree(const System *system, const Branchlike *branch)
{
    Domain domain = graph_edge(system->origin->graph, branch->edge)->domain;
    TreeKind kind = TREE_ELECTRICAL;

    while (tree_kind_domain(kind) != domain)
        kind++;
    return kind;
}

const char *network_company(const System *system, const Branchlike *branch)
{
    const Tree *tree = system->origin->trees[branch_tree(system, branch)];
    SignMatrix *matrix = branch->branch ? tree_cutsets(tree) : tree_circuits(tree);
    const int *edges = branch->branch ? tree_branches(tree) : tree_chords(tree);
    Text names = {0};
    const char *kept;

    for (int r = 0; r < matrix->rows; r++)
        for (int i = matrix->start[r]; edges[r] == branch->edge && i < matrix->start[r + 1]; i++)
            text_addf(&names, "%s%s", i > matrix->start[r] ? " " : "",
                      graph_edge(system->origin->graph, matrix->column[i])->name);
    kept = system_retain(system, "%s", names.at != NULL ? names.at : "");
    text_free(&names);
    sign_matrix_free(matrix);
    return kept;
}
