/* graph.c: nodes and edges in arrays; each node has the list of its edges */
#include "graph/graph.h"

#include "base/memory.h"
#include "base/names.h"
#include "graph/sets.h"

#include <assert.h>
#include <string.h>

typedef struct Incident {
    LIST(int) edges;
} Incident;

typedef struct Register { /* nodes or edges by name */
    Names *names;
    LIST(int) first; /* by number of the name: the first one with it */
} Register;

struct Graph {
    LIST(Node) nodes;
    LIST(Incident) at; /* one for each node */
    LIST(Edge) edges;
    Register node_names, edge_names;
    Pool *texts;
};

static const struct {
    const char *name;
    Domain domain;
} tree_kinds[] = {
    [TREE_TRANSLATION] = {"translation", DOMAIN_MECHANICAL},
    [TREE_ROTATION] = {"rotation", DOMAIN_MECHANICAL},
    [TREE_ELECTRICAL] = {"electrical", DOMAIN_ELECTRICAL},
    [TREE_HYDRAULIC] = {"hydraulic", DOMAIN_HYDRAULIC},
    [TREE_SHAFT] = {"shaft", DOMAIN_SHAFT},
    [TREE_SLIDE] = {"slide", DOMAIN_SLIDE},
    [TREE_THERMAL] = {"thermal", DOMAIN_THERMAL},
    [TREE_LOAD] = {"load", DOMAIN_LOAD},
};

const char *domain_name(Domain domain)
{
    static const char *const names[] = {
#define X(id, name, ...) name,
        DOMAINS(X)
#undef X
    };
    return names[domain];
}

const char *tree_kind_name(TreeKind kind)
{
    return tree_kinds[kind].name;
}

Domain tree_kind_domain(TreeKind kind)
{
    return tree_kinds[kind].domain;
}

/* --- names --- */

static void enter(Register *out, const char *name, int bearer)
{
    if (names_add(out->names, name) == out->first.count)
        LIST_PUSH(out->first, bearer);
}

/* the first one with that name, or -1 */
static int look_up(const Register *in, const char *name)
{
    const int number = names_find(in->names, name);

    return number < 0 ? -1 : in->first.at[number];
}

/* Removes all entries from that one on. A name finds its first entry, so the name goes with its
 * last entry or not at all. */
static void forget(Register *out, int bearers)
{
    while (out->first.count > 0 && out->first.at[out->first.count - 1] >= bearers)
        out->first.count--;
    names_trim(out->names, out->first.count);
}

/* the same names, as the strings of the copy's own nodes or edges */
static void copy_register(const Register *from, const Graph *graph,
                          const char *(*name_of)(const Graph *graph, int bearer), Register *out)
{
    const char **names = NEW_ARRAY(const char *, from->first.count);

    LIST_ROOM(out->first, from->first.count);
    for (int i = 0; i < from->first.count; i++) {
        out->first.at[out->first.count++] = from->first.at[i];
        names[i] = name_of(graph, from->first.at[i]);
    }
    out->names = names_borrowing_from(from->names, names);
    mem_free(names);
}

static void register_free(Register *out)
{
    LIST_FREE(out->first);
    names_free(out->names);
}

/* --- nodes and edges --- */

Graph *graph_new(void)
{
    Graph *graph = NEW(Graph);

    graph->node_names.names = names_borrowing();
    graph->edge_names.names = names_borrowing();
    graph->texts = pool_new(0);
    return graph;
}

void graph_free(Graph *graph)
{
    if (graph == NULL)
        return;
    for (int i = 0; i < graph->at.count; i++)
        LIST_FREE(graph->at.at[i].edges);
    LIST_FREE(graph->nodes);
    LIST_FREE(graph->at);
    LIST_FREE(graph->edges);
    register_free(&graph->node_names);
    register_free(&graph->edge_names);
    pool_free(graph->texts);
    mem_free(graph);
}

static const char *copied_text(Graph *graph, const char *text)
{
    return pool_text(graph->texts, text, strlen(text));
}

/* call before the edges at a node change */
static void keep_incident(Graph *graph, int node)
{
    mem_keep_part(graph->at.at, &graph->at.at[node], sizeof *graph->at.at);
}

int graph_add_node(Graph *graph, const char *name, Domain domain, bool datum)
{
    mem_keep(graph);

    int node = graph->nodes.count;
    Node new_node = {copied_text(graph, name), domain, datum};

    enter(&graph->node_names, new_node.name, node);
    LIST_PUSH(graph->nodes, new_node);
    LIST_PUSH(graph->at, (Incident){.edges = {0}});
    return node;
}

int graph_add_edge(Graph *graph, const Edge *edge)
{
    const int number = graph->edges.count;
    Edge own = *edge;

    assert(edge->tail >= 0 && edge->tail < graph->nodes.count);
    assert(edge->head >= 0 && edge->head < graph->nodes.count);
    assert(graph->nodes.at[edge->tail].domain == edge->domain);
    assert(graph->nodes.at[edge->head].domain == edge->domain);

    mem_keep(graph);
    own.name = copied_text(graph, edge->name);
    enter(&graph->edge_names, own.name, number);
    LIST_PUSH(graph->edges, own);
    keep_incident(graph, edge->tail);
    LIST_PUSH(graph->at.at[edge->tail].edges, number);
    keep_incident(graph, edge->head);
    if (edge->head != edge->tail)
        LIST_PUSH(graph->at.at[edge->head].edges, number);
    return number;
}

static const char *node_name(const Graph *graph, int node)
{
    return graph->nodes.at[node].name;
}

static const char *edge_name(const Graph *graph, int edge)
{
    return graph->edges.at[edge].name;
}

static void copy_nodes(Graph *graph, const Graph *from)
{
    LIST_ROOM(graph->nodes, from->nodes.count);
    LIST_ROOM(graph->at, from->nodes.count);
    for (int i = 0; i < from->nodes.count; i++) {
        const Incident *at = &from->at.at[i];
        Node node = from->nodes.at[i];
        Incident own = {.edges = {0}};

        node.name = copied_text(graph, node.name);
        LIST_ROOM(own.edges, at->edges.count);
        for (int k = 0; k < at->edges.count; k++)
            own.edges.at[own.edges.count++] = at->edges.at[k];
        graph->nodes.at[graph->nodes.count++] = node;
        graph->at.at[graph->at.count++] = own;
    }
    copy_register(&from->node_names, graph, node_name, &graph->node_names);
}

static void copy_edges(Graph *graph, const Graph *from)
{
    LIST_ROOM(graph->edges, from->edges.count);
    for (int i = 0; i < from->edges.count; i++) {
        Edge edge = from->edges.at[i];

        edge.name = copied_text(graph, edge.name);
        graph->edges.at[graph->edges.count++] = edge;
    }
    copy_register(&from->edge_names, graph, edge_name, &graph->edge_names);
}

Graph *graph_copy(const Graph *from)
{
    Graph *graph = NEW(Graph);

    graph->texts = pool_new(0);
    copy_nodes(graph, from);
    copy_edges(graph, from);
    return graph;
}

GraphMark graph_mark(const Graph *graph)
{
    return (GraphMark){graph->nodes.count, graph->edges.count, pool_mark(graph->texts)};
}

void graph_trim(Graph *graph, const GraphMark *mark)
{
    mem_keep(graph);
    while (graph->edges.count > mark->edges) {
        const Edge *edge = &graph->edges.at[--graph->edges.count];

        keep_incident(graph, edge->tail);
        keep_incident(graph, edge->head);
        graph->at.at[edge->tail].edges.count--;
        if (edge->head != edge->tail)
            graph->at.at[edge->head].edges.count--;
    }
    while (graph->nodes.count > mark->nodes) {
        graph->nodes.count--;
        keep_incident(graph, graph->nodes.count);
        LIST_FREE(graph->at.at[graph->nodes.count].edges);
    }
    graph->at.count = graph->nodes.count;
    forget(&graph->node_names, mark->nodes);
    forget(&graph->edge_names, mark->edges);
    pool_release(graph->texts, mark->texts);
}

int graph_node_count(const Graph *graph)
{
    return graph->nodes.count;
}

int graph_edge_count(const Graph *graph)
{
    return graph->edges.count;
}

const Node *graph_node(const Graph *graph, int node)
{
    return &graph->nodes.at[node];
}

const Edge *graph_edge(const Graph *graph, int edge)
{
    return &graph->edges.at[edge];
}

int graph_find_node(const Graph *graph, const char *name)
{
    return look_up(&graph->node_names, name);
}

int graph_find_edge(const Graph *graph, const char *name)
{
    return look_up(&graph->edge_names, name);
}

bool graph_edge_in(const Graph *graph, int edge, TreeKind kind)
{
    return graph->edges.at[edge].domain == tree_kind_domain(kind);
}

Branching graph_branching(const Graph *graph, int edge, TreeKind kind)
{
    if (!graph_edge_in(graph, edge, kind))
        return BRANCH_NEVER;
    return graph->edges.at[edge].branching[kind == TREE_ROTATION];
}

int graph_edges_at(const Graph *graph, int node, const int **edges)
{
    *edges = graph->at.at[node].edges.at;
    return graph->at.at[node].edges.count;
}

int graph_parts(const Graph *graph, Domain domain, int *part)
{
    int nodes = graph->nodes.count;
    int *number = NEW_ARRAY(int, nodes); /* of a set's connected part, plus 1 */
    Sets *sets = sets_new(nodes);
    int parts = 0;

    for (int e = 0; e < graph->edges.count; e++) {
        if (graph->edges.at[e].domain == domain)
            (void)sets_join(sets, graph->edges.at[e].tail, graph->edges.at[e].head);
    }
    for (int i = 0; i < nodes; i++) {
        int root = sets_find(sets, i);

        part[i] = -1;
        if (graph->nodes.at[i].domain != domain)
            continue;
        if (number[root] == 0)
            number[root] = ++parts;
        part[i] = number[root] - 1;
    }
    sets_free(sets);
    mem_free(number);
    return parts;
}
