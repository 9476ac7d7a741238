/* tree_fault.c: reports why a tree fails, in terms of the user's edges and nodes */
#include "graph/tree_draft.h"

#include "base/text.h"

#include <string.h>

/* limits of the names in one message: their number, and their total length */
enum { SHOWN_NAMES = 8, SHOWN_BYTES = 160 };

typedef LIST(int) FaultEdges;

static const char *edge_name(const Graph *graph, int edge)
{
    return graph_edge(graph, edge)->name;
}

static const char *node_name(const Graph *graph, int node)
{
    return graph_node(graph, node)->name;
}

/* "h8, h9, h10 and 12 more"; new string */
static char *list_names(const Draft *draft, const FaultEdges *numbers,
                        const char *(*name)(const Graph *, int), const char *between)
{
    Text text = {0};
    int shown = 0;

    while (shown < numbers->count && shown < SHOWN_NAMES) {
        const char *next = name(draft->graph, numbers->at[shown]);

        if (shown > 0 && text.length + strlen(next) > SHOWN_BYTES)
            break;
        if (shown > 0)
            text_add(&text, between);
        text_add(&text, next);
        shown++;
    }
    if (shown < numbers->count)
        text_addf(&text, " and %d more", numbers->count - shown);
    return text_done(&text);
}

Status draft_fault_branch(const Draft *draft, int edge, Diag *diag)
{
    const Graph *graph = draft->graph;
    const char *kind = tree_kind_name(draft->kind);

    if (!graph_edge_in(graph, edge, draft->kind)) {
        const char *domain = domain_name(graph_edge(graph, edge)->domain);

        (void)diag_set(diag, E_BRANCH, "edge %s is %s and no part of the %s tree",
                       edge_name(graph, edge), domain, kind);
        diag_hint(diag, "name %s edges only", domain_name(tree_kind_domain(draft->kind)));
    } else if (tree_kind_domain(draft->kind) != DOMAIN_MECHANICAL) {
        (void)diag_set(diag, E_BRANCH, "edge %s can only be a chord of the %s tree",
                       edge_name(graph, edge), kind);
        diag_hint(diag, "leave %s in the cotree", edge_name(graph, edge));
    } else {
        (void)diag_set(diag, E_BRANCH,
                       "edge %s has no across relation; only bodies, joints, arms, virtual "
                       "joints and drivers can be branches",
                       edge_name(graph, edge));
        diag_hint(diag, "leave %s in the cotree", edge_name(graph, edge));
    }
    return E_BRANCH;
}

Status draft_fault_arm(const Draft *draft, int edge, Diag *diag)
{
    (void)diag_set(diag, E_BRANCH, "arm %s cannot be kept out of the %s tree",
                   edge_name(draft->graph, edge), tree_kind_name(draft->kind));
    diag_hint(diag, "arms are branches of every tree; keep out a joint or a body");
    return E_BRANCH;
}

static int other_end(const Graph *graph, int edge, int node)
{
    const Edge *e = graph_edge(graph, edge);

    return e->tail == node ? e->head : e->tail;
}

/* For each node that branches connect to `from`, the last branch on the path to it; -1 for others
 * and for `from`. New array. */
static int *search_ways(const Draft *draft, int from)
{
    const Graph *graph = draft->graph;
    int nodes = graph_node_count(graph);
    int *way = NEW_ARRAY(int, nodes);
    int *queue = NEW_ARRAY(int, nodes);
    int count = 0;

    for (int i = 0; i < nodes; i++)
        way[i] = -1;
    queue[count++] = from;
    for (int done = 0; done < count; done++) {
        const int *edges;
        int degree = graph_edges_at(graph, queue[done], &edges);

        for (int k = 0; k < degree; k++) {
            int next = other_end(graph, edges[k], queue[done]);

            if (draft->standing[edges[k]] == STANDING_CHORD || next == from || way[next] >= 0)
                continue;
            way[next] = edges[k];
            queue[count++] = next;
        }
    }
    mem_free(queue);
    return way;
}

/* the closing edge from tail to head, and back to the tail by branches */
static FaultEdges find_circuit(const Draft *draft, int closing)
{
    const Edge *edge = graph_edge(draft->graph, closing);
    int *way = search_ways(draft, edge->tail);
    FaultEdges circuit = {0};

    LIST_PUSH(circuit, closing);
    for (int node = edge->head; node != edge->tail;) {
        int branch = way[node];

        LIST_PUSH(circuit, branch);
        node = other_end(draft->graph, branch, node);
    }
    mem_free(way);
    return circuit;
}

/* Which edge to drop: the last one by preference. Alternatives are added to `others`. -1: there are
 * only arms. */
static int find_drop(const Draft *draft, const FaultEdges *circuit, FaultEdges *others)
{
    int drop = -1;

    for (int i = 0; i < circuit->count; i++) {
        int edge = circuit->at[i];

        if (graph_branching(draft->graph, edge, draft->kind) != BRANCH_ALWAYS &&
            (drop < 0 || draft_preference(draft, edge) > draft_preference(draft, drop)))
            drop = edge;
    }
    for (int i = 0; i < circuit->count; i++) {
        int edge = circuit->at[i];

        if (graph_branching(draft->graph, edge, draft->kind) != BRANCH_ALWAYS && edge != drop)
            LIST_PUSH(*others, edge);
    }
    return drop;
}

Status draft_fault_circuit(const Draft *draft, int closing, Diag *diag)
{
    FaultEdges circuit = find_circuit(draft, closing);
    FaultEdges others = {0};
    int drop = find_drop(draft, &circuit, &others);
    char *names = list_names(draft, &circuit, edge_name, drop < 0 ? ", " : " ");
    char *rest = list_names(draft, &others, edge_name, ", ");

    if (drop < 0) {
        (void)diag_set(diag, E_CIRCUIT,
                       "arms %s form a closed loop; one is a weld that is redundant", names);
        diag_hint(diag, "delete one of these arms, or put a joint in its place");
    } else {
        const char *name = edge_name(draft->graph, drop);

        (void)diag_set(diag, E_CIRCUIT, "the %s tree contains the circuit %s",
                       tree_kind_name(draft->kind), names);
        if (others.count > 0)
            diag_hint(diag, "drop %s, or another that is no arm: %s", name, rest);
        else if (circuit.count > 1)
            diag_hint(diag, "drop %s: the others are arms, which are always branches", name);
        else
            diag_hint(diag, "drop %s: it begins and ends in one node", name);
    }
    MEM_FREE(names, rest);
    LIST_FREE(circuit);
    LIST_FREE(others);
    return E_CIRCUIT;
}

/* nodes of the domain that `sets` doesn't connect to the datum */
static FaultEdges find_unreached(const Draft *draft, Sets *sets)
{
    Domain domain = tree_kind_domain(draft->kind);
    FaultEdges nodes = {0};

    for (int i = 0; i < graph_node_count(draft->graph); i++) {
        if (graph_node(draft->graph, i)->domain == domain &&
            (draft->datum < 0 || sets_find(sets, i) != sets_find(sets, draft->datum)))
            LIST_PUSH(nodes, i);
    }
    return nodes;
}

/* Edges that would connect the separate parts: all possible ones where one is enough, otherwise as
 * many as are needed. Unites the sets in `sets`. */
static FaultEdges find_bridges(const Draft *draft, Sets *sets, bool *one_is_enough)
{
    const Graph *graph = draft->graph;
    FaultEdges bridges = {0};
    FaultEdges crossing = {0};
    int *edges;
    int count = draft_candidates(draft, true, &edges);

    for (int i = 0; i < count; i++) {
        const Edge *e = graph_edge(graph, edges[i]);

        if (sets_find(draft->sets, e->tail) != sets_find(draft->sets, e->head))
            LIST_PUSH(crossing, edges[i]);
        if (sets_join(sets, e->tail, e->head))
            LIST_PUSH(bridges, edges[i]);
    }
    mem_free(edges);
    *one_is_enough = bridges.count == 1;
    if (*one_is_enough) {
        LIST_FREE(bridges);
        return crossing;
    }
    LIST_FREE(crossing);
    return bridges;
}

static Sets *copy_sets(const Draft *draft)
{
    Sets *sets = sets_new(graph_node_count(draft->graph));

    for (int e = 0; e < graph_edge_count(draft->graph); e++) {
        const Edge *edge = graph_edge(draft->graph, e);

        if (draft->standing[e] != STANDING_CHORD)
            (void)sets_join(sets, edge->tail, edge->head);
    }
    return sets;
}

static void hint_bridges(const Draft *draft, Diag *diag)
{
    Sets *sets = copy_sets(draft);
    bool one_is_enough;
    FaultEdges bridges = find_bridges(draft, sets, &one_is_enough);
    FaultEdges left = find_unreached(draft, sets);
    char *edges = list_names(draft, &bridges, edge_name, ", ");
    char *nodes = list_names(draft, &left, node_name, ", ");

    if (left.count > 0 && tree_kind_domain(draft->kind) == DOMAIN_MECHANICAL)
        diag_hint(diag, "no edge that can be a branch leads to %s: add a body, a joint or an arm",
                  nodes);
    else if (left.count > 0)
        diag_hint(diag, "no edge that can be a branch leads to %s: connect %s to %s", nodes,
                  left.count == 1 ? "it" : "them", node_name(draft->graph, draft->datum));
    else if (one_is_enough && bridges.count > 1)
        diag_hint(diag, "add one of %s to the tree", edges);
    else
        diag_hint(diag, "add %s to the tree", edges);
    MEM_FREE(edges, nodes);
    LIST_FREE(bridges);
    LIST_FREE(left);
    sets_free(sets);
}

Status draft_fault_unreached(const Draft *draft, Diag *diag)
{
    FaultEdges nodes = find_unreached(draft, draft->sets);
    char *names = list_names(draft, &nodes, node_name, ", ");
    const char *kind = tree_kind_name(draft->kind);
    const char *noun = nodes.count == 1 ? "node" : "nodes";

    if (draft->datum < 0) {
        (void)diag_set(diag, E_UNREACHED,
                       "the %s tree does not span: %s %s cannot be reached, there is no datum",
                       kind, noun, names);
        diag_hint(diag, "connect %s to %s", nodes.count == 1 ? "it" : "one of them",
                  tree_kind_domain(draft->kind) == DOMAIN_MECHANICAL ? "ground" : "0");
    } else {
        (void)diag_set(diag, E_UNREACHED,
                       "the %s tree does not span: %s %s cannot be reached from %s", kind, noun,
                       names, node_name(draft->graph, draft->datum));
        hint_bridges(draft, diag);
    }
    mem_free(names);
    LIST_FREE(nodes);
    return E_UNREACHED;
}
