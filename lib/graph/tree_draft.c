/* tree_draft.c: Kruskal's rule (1956), after arms and the user's choice */
#include "graph/tree_draft.h"

/* makes an edge a branch, unless its ends are connected already */
static bool join(Draft *draft, int edge, Standing standing)
{
    const Edge *e = graph_edge(draft->graph, edge);

    if (!sets_join(draft->sets, e->tail, e->head))
        return false;
    draft->standing[edge] = (unsigned char)standing;
    draft->joined++;
    return true;
}

static Status join_arms(Draft *draft, Diag *diag)
{
    for (int e = 0; e < graph_edge_count(draft->graph); e++) {
        if (graph_branching(draft->graph, e, draft->kind) != BRANCH_ALWAYS)
            continue;
        if (draft->choice->excluded != NULL && draft->choice->excluded[e])
            return draft_fault_arm(draft, e, diag);
        if (!join(draft, e, STANDING_ARM))
            return draft_fault_circuit(draft, e, diag);
    }
    return OK;
}

static Status join_chosen(Draft *draft, Diag *diag)
{
    for (int i = 0; i < draft->choice->branch_count; i++) {
        int edge = draft->choice->branches[i];

        if (graph_branching(draft->graph, edge, draft->kind) == BRANCH_NEVER)
            return draft_fault_branch(draft, edge, diag);
        /* an arm, or named twice */
        if (draft->standing[edge] != STANDING_CHORD)
            continue;
        if (!join(draft, edge, STANDING_CHOSEN))
            return draft_fault_circuit(draft, edge, diag);
    }
    return OK;
}

/* whether all nodes of the domain are connected, including terminals to which nothing is connected
 * yet */
static bool is_whole(const Draft *draft)
{
    const Domain domain = tree_kind_domain(draft->kind);
    int nodes = 0;

    for (int i = 0; i < graph_node_count(draft->graph); i++)
        nodes += graph_node(draft->graph, i)->domain == domain;
    return draft->joined + 1 >= nodes;
}

static void join_preferred(Draft *draft)
{
    int *edges, count;

    if (is_whole(draft))
        return;
    count = draft_candidates(draft, false, &edges);
    for (int i = 0; i < count; i++)
        (void)join(draft, edges[i], STANDING_COMPLETED);
    mem_free(edges);
}

static Status check_reach(const Draft *draft, Diag *diag)
{
    Domain domain = tree_kind_domain(draft->kind);

    for (int i = 0; i < graph_node_count(draft->graph); i++) {
        const int *edges;

        /* trees ignore a terminal that is only mentioned and to which nothing is connected yet */
        if (graph_node(draft->graph, i)->domain != domain ||
            (domain != DOMAIN_MECHANICAL && graph_edges_at(draft->graph, i, &edges) == 0))
            continue;
        if (draft->datum < 0 || sets_find(draft->sets, i) != sets_find(draft->sets, draft->datum))
            return draft_fault_unreached(draft, diag);
    }
    return OK;
}

static int find_datum(const Graph *graph, Domain domain)
{
    for (int i = 0; i < graph_node_count(graph); i++) {
        const Node *node = graph_node(graph, i);

        if (node->datum && node->domain == domain)
            return i;
    }
    return -1;
}

Status draft_make(Draft *draft, bool exact, Diag *diag)
{
    draft->datum = find_datum(draft->graph, tree_kind_domain(draft->kind));
    draft->standing = NEW_ARRAY(unsigned char, graph_edge_count(draft->graph));
    draft->sets = sets_new(graph_node_count(draft->graph));

    /* the user's choice comes first, whatever its preference */
    TRY(join_arms(draft, diag));
    TRY(join_chosen(draft, diag));
    if (!exact)
        join_preferred(draft);
    return check_reach(draft, diag);
}

void draft_free(Draft *draft)
{
    mem_free(draft->standing);
    sets_free(draft->sets);
}
