/* network_tree.c: the normal tree of a scalar domain, by a greedy choice of edges: first sources of
 * across variables, then elements that store these, resistive edges, elements that store through
 * variables, and sources of those last */
#include "formulate/network/network_build.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

#include "graph/sets.h"

#include <stdlib.h>

#define BEFORE_OUTPUTS 12 /* capacitors whose voltage an amplifier leaves free, */
#define OUTPUTS        13

static int normal_order(const System *system, const Branchlike *branch)
{
    switch (branch->relation.kind) {
    case RELATION_ACROSS: /* closed switches are left out before sources are, */
        return branch->ideal < 0 ? 10 : 11;
    case RELATION_CAPACITIVE:
        return 20;
    case RELATION_PORT:
        return 25;
    case RELATION_RESISTIVE:
    case RELATION_IMPLICIT:
        return 30;
    case RELATION_CONDUCTIVE: /* nodes that diodes isolate are joined before */
        return 35;
    case RELATION_INDUCTIVE:
        return 40;
    case RELATION_THROUGH: /* and open switches are added before sources */
        return branch->ideal < 0 ? 50 : 49;
    case RELATION_FREE:
        return OUTPUTS;
    case RELATION_IDEAL:
        break;
    }
    return graph_edge(system->origin->graph, branch->edge)->preference[0];
}

/* The order in which edges are added to the normal tree where there are ports. */
typedef struct Taking {
    System *system;
    TreeKind kind;
    Sets *nodes;     /* joined by the edges added so far */
    int *preference; /* one for each edge of the graph */
    int taken;
} Taking;

static void take(Taking *taking, const Branchlike *branch)
{
    const Edge *edge = graph_edge(taking->system->origin->graph, branch->edge);

    if (sets_join(taking->nodes, edge->tail, edge->head))
        taking->preference[branch->edge] = taking->taken++;
}

static bool is_taken(const Taking *taking, const Branchlike *branch)
{
    return taking->preference[branch->edge] < graph_edge_count(taking->system->origin->graph);
}

static bool is_closed(const Taking *taking, const Branchlike *branch)
{
    const Edge *edge = graph_edge(taking->system->origin->graph, branch->edge);

    return sets_find(taking->nodes, edge->tail) == sets_find(taking->nodes, edge->head);
}

/* The v of one side of a port determines that of the other: where other edges close a circuit with
 * one side, the other side is next. */
static void take_through_ports(Taking *taking)
{
    System *system = taking->system;

    for (int i = 0; i < system->network->branches.count; i++) {
        const Branchlike *p = &system->network->branches.at[i];
        const Branchlike *s = p + 1;

        if (p->relation.kind != RELATION_PORT || p->which > 0 ||
            branch_tree(system, p) != taking->kind || is_taken(taking, p) || is_taken(taking, s) ||
            is_closed(taking, p) == is_closed(taking, s))
            continue;
        take(taking, is_closed(taking, p) ? s : p);
        i = -1; /* it may have closed another circuit */
    }
}

/* --- amplifiers --- */

static void join(const System *system, Sets *nodes, const Branchlike *branch)
{
    const Edge *edge = graph_edge(system->origin->graph, branch->edge);

    (void)sets_join(nodes, edge->tail, edge->head);
}

/* For voltages a nullor's input joins its nodes, for currents its output does. A capacitor that
 * closes a circuit with either has no voltage of its own. The other capacitors come before outputs,
 * which then follow from them. One flag for each branch; NULL where there is no amplifier. */
static bool *find_leading(const System *system, TreeKind kind)
{
    Sets *voltages = sets_new(graph_node_count(system->origin->graph));
    Sets *currents = sets_new(graph_node_count(system->origin->graph));
    bool *leads = NULL;

    for (int i = 0; i < system->network->branches.count; i++) {
        const Branchlike *branch = &system->network->branches.at[i];

        if (branch_tree(system, branch) != kind)
            continue;
        if (branch->relation.kind == RELATION_ACROSS) {
            join(system, voltages, branch);
            join(system, currents, branch);
        } else if (branch->relation.kind == RELATION_FREE) {
            if (leads == NULL)
                leads = NEW_ARRAY(bool, system->network->branches.count);
            join(system, currents, branch);
            join(system, voltages, branch - branch->which); /* its input is its first edge */
        }
    }
    for (int i = 0; i < system->network->branches.count && leads != NULL; i++) {
        const Branchlike *branch = &system->network->branches.at[i];
        const Edge *edge = graph_edge(system->origin->graph, branch->edge);

        if (branch->relation.kind != RELATION_CAPACITIVE || branch_tree(system, branch) != kind ||
            sets_find(voltages, edge->tail) == sets_find(voltages, edge->head) ||
            sets_find(currents, edge->tail) == sets_find(currents, edge->head))
            continue;
        leads[i] = true;
        join(system, voltages, branch);
        join(system, currents, branch);
    }
    sets_free(voltages);
    sets_free(currents);
    return leads;
}

/* --- order of edges --- */

/* the user's branches come before others of their kind */
static int rank_of(const System *system, TreeKind kind, const bool *leads, int branch)
{
    const Branchlike *one = &system->network->branches.at[branch];
    const int order = leads != NULL && leads[branch] ? BEFORE_OUTPUTS : normal_order(system, one);

    return 2 * order + !tree_has(system->origin->trees[kind], one->edge);
}

typedef struct BranchRank {
    int order;
    int branch;
} BranchRank;

static int compare_ranks(const void *a, const void *b)
{
    const BranchRank *x = a;
    const BranchRank *y = b;

    return x->order != y->order ? (x->order > y->order) - (x->order < y->order)
                                : x->branch - y->branch;
}

static void choose_order(Taking *taking, const bool *leads)
{
    System *system = taking->system;
    LIST(BranchRank) ranks = {0};

    for (int i = 0; i < system->network->branches.count; i++) {
        const Branchlike *branch = &system->network->branches.at[i];

        if (branch_tree(system, branch) != taking->kind)
            continue;
        LIST_PUSH(ranks, (BranchRank){rank_of(system, taking->kind, leads, i), i});
    }
    if (ranks.count > 0)
        qsort(ranks.at, (size_t)ranks.count, sizeof(BranchRank), compare_ranks);
    for (int k = 0; k < ranks.count; k++) {
        take(taking, &system->network->branches.at[ranks.at[k].branch]);
        take_through_ports(taking);
    }
    LIST_FREE(ranks);
}

static bool has_ports(const System *system, TreeKind kind)
{
    for (int i = 0; i < system->network->branches.count; i++)
        if (system->network->branches.at[i].relation.kind == RELATION_PORT &&
            branch_tree(system, &system->network->branches.at[i]) == kind)
            return true;
    return false;
}

/* storage elements that are states by the tree */
static void list_states(System *system, const Tree *tree, TreeKind kind)
{
    for (int i = 0; i < system->network->branches.count; i++) {
        const Branchlike *branch = &system->network->branches.at[i];
        bool in_tree = tree_has(tree, branch->edge);

        if (branch_tree(system, branch) == kind &&
            branch->relation.kind == (in_tree ? RELATION_CAPACITIVE : RELATION_INDUCTIVE))
            LIST_PUSH(system->network->at_rest, branch_member(system, branch, !in_tree));
    }
}

/* The user's tree where it is a normal tree; otherwise as much of it as a normal tree can contain.
 * In the form of the user's tree that tree is kept, and the normal tree here determines which
 * variables are 0 at the start. */
Status network_normal_tree(System *system, TreeKind kind, Diag *diag)
{
    int count = graph_edge_count(system->origin->graph);
    Taking taking = {.system = system,
                     .kind = kind,
                     .nodes = sets_new(graph_node_count(system->origin->graph)),
                     .preference = NEW_ARRAY(int, count)};
    TreeChoice choice = {.preference = taking.preference};
    bool *leads = find_leading(system, kind);
    Tree *tree = NULL;
    Status status = OK;

    for (int e = 0; e < count; e++)
        taking.preference[e] = count;
    if (has_ports(system, kind))
        choose_order(&taking, leads);
    for (int i = 0; i < system->network->branches.count && taking.taken == 0; i++)
        taking.preference[system->network->branches.at[i].edge] = rank_of(system, kind, leads, i);
    CHECK(tree_complete(system->origin->graph, kind, &choice, false, &tree, diag));
    for (int i = 0; i < tree_branch_count(tree); i++)
        if (!tree_has(system->origin->trees[kind], tree_branches(tree)[i]))
            system->network->leaves_trees = true;
    if (system->network->form == NETWORK_TREE) {
        list_states(system, tree, kind);
        tree_free(tree);
    } else {
        tree_free(system->origin->trees[kind]);
        system->origin->trees[kind] = tree;
    }
done:
    sets_free(taking.nodes);
    MEM_FREE(leads, taking.preference);
    return status;
}
