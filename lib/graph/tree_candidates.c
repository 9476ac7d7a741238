/* tree_candidates.c: edges that could be branches, in the order in which they are added to a
 * tree */
#include "graph/tree_draft.h"

#include <stdlib.h>

typedef struct Ranked {
    int edge;
    int preference;
    bool unchosen; /* BRANCH_UNCHOSEN: after all others */
    int distance;  /* from the datum, of both ends; mechanical trees: 0 */
} Ranked;

static int compare_ranked(const void *a, const void *b)
{
    const Ranked *x = a;
    const Ranked *y = b;

    if (x->unchosen != y->unchosen)
        return x->unchosen ? 1 : -1;
    if (x->preference != y->preference)
        return x->preference < y->preference ? -1 : 1;
    if (x->distance != y->distance)
        return x->distance < y->distance ? -1 : 1;
    return x->edge < y->edge ? -1 : x->edge > y->edge;
}

int draft_preference(const Draft *draft, int edge)
{
    if (draft->choice->preference != NULL)
        return draft->choice->preference[edge];
    return graph_edge(draft->graph, edge)->preference[draft->kind == TREE_ROTATION];
}

static bool is_candidate(const Draft *draft, int edge, bool open)
{
    Branching branching = graph_branching(draft->graph, edge, draft->kind);

    if (draft->standing[edge] != STANDING_CHORD)
        return false;
    if (open)
        return branching == BRANCH_MAY || branching == BRANCH_UNCHOSEN;
    return branching == BRANCH_MAY &&
           (draft->choice->excluded == NULL || !draft->choice->excluded[edge]);
}

/* Number of edges between the datum and each node of its domain, new array. Branches near the datum
 * make the circuits of large networks short. */
static int *distances(const Draft *draft)
{
    int nodes = graph_node_count(draft->graph);
    int *distance = NEW_ARRAY(int, nodes);
    int *queue = NEW_ARRAY(int, nodes);
    int count = 0;

    if (draft->datum >= 0 && tree_kind_domain(draft->kind) != DOMAIN_MECHANICAL)
        queue[count++] = draft->datum;
    for (int i = 0; i < count; i++) {
        const int *edges;
        int degree = graph_edges_at(draft->graph, queue[i], &edges);

        for (int k = 0; k < degree; k++) {
            const Edge *edge = graph_edge(draft->graph, edges[k]);
            int next = edge->tail == queue[i] ? edge->head : edge->tail;

            if (distance[next] > 0 || next == draft->datum)
                continue;
            distance[next] = distance[queue[i]] + 1;
            queue[count++] = next;
        }
    }
    mem_free(queue);
    return distance;
}

int draft_candidates(const Draft *draft, bool open, int **edges)
{
    LIST(Ranked) ranked = {0};
    int *distance = distances(draft);
    int count;

    for (int e = 0; e < graph_edge_count(draft->graph); e++) {
        if (is_candidate(draft, e, open)) {
            Branching branching = graph_branching(draft->graph, e, draft->kind);
            const Edge *edge = graph_edge(draft->graph, e);

            LIST_PUSH(ranked, (Ranked){.edge = e,
                                       .preference = draft_preference(draft, e),
                                       .unchosen = branching == BRANCH_UNCHOSEN,
                                       .distance = distance[edge->tail] + distance[edge->head]});
        }
    }
    count = ranked.count;
    if (count > 0)
        qsort(ranked.at, (size_t)count, sizeof *ranked.at, compare_ranked);

    *edges = NEW_ARRAY(int, count);
    for (int i = 0; i < count; i++)
        (*edges)[i] = ranked.at[i].edge;
    LIST_FREE(ranked);
    mem_free(distance);
    return count;
}
