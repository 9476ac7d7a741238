/* graph.h: the linear graph: nodes, edges, domains
 *
 * A node is a frame (mechanical) or a terminal (scalar domains); an edge is one physical effect
 * between two nodes, directed from tail to head. Both are numbers, 0, 1, 2 ... in the order of
 * making. The graph is owned by its creator; names are copied. */
#ifndef COTREE_GRAPH_GRAPH_H
#define COTREE_GRAPH_GRAPH_H

#include "base/diag.h"
#include "base/memory.h"

/* one row for each domain: id, name, across variable, through variable, unit of each */
#define DOMAINS(X)                                                                                 \
    X(MECHANICAL, "mechanical", "motion", "force", "m", "N")                                       \
    X(ELECTRICAL, "electrical", "voltage", "current", "V", "A")                                    \
    X(HYDRAULIC, "hydraulic", "pressure", "flow", "Pa", "m^3/s")                                   \
    X(SHAFT, "shaft", "rate", "torque", "rad/s", "N*m")                                            \
    X(SLIDE, "slide", "velocity", "force", "m/s", "N")                                             \
    X(THERMAL, "thermal", "temperature", "heat", "K", "W")                                         \
    X(LOAD, "load", "load", "", "N", "")

typedef enum Domain {
#define X(id, ...) DOMAIN_##id,
    DOMAINS(X)
#undef X
        DOMAIN_COUNT
} Domain;

/* A mechanical piece has two trees over the same nodes and edges; each scalar domain has one. */
typedef enum TreeKind {
    TREE_TRANSLATION,
    TREE_ROTATION,
    TREE_ELECTRICAL,
    TREE_HYDRAULIC,
    TREE_SHAFT,
    TREE_SLIDE,
    TREE_THERMAL,
    TREE_LOAD,
    TREE_KINDS
} TreeKind;

const char *domain_name(Domain domain);
const char *tree_kind_name(TreeKind kind); /* "translation", "rotation", "electrical" ... */
Domain tree_kind_domain(TreeKind kind);

/* Role of an edge in a tree of a kind: */
typedef enum Branching {
    BRANCH_NEVER,    /* no across relation: forces, springs, motors in the mechanical domain */
    BRANCH_UNCHOSEN, /* only when the user chooses it: virtual joints without that freedom */
    BRANCH_MAY,
    BRANCH_ALWAYS /* rigid arms */
} Branching;

typedef struct Node {
    const char *name;
    Domain domain;
    bool datum; /* ground; 0 */
} Node;

typedef struct Edge {
    const char *name;
    int tail;
    int head;
    Domain domain;
    int component;          /* the model's number of the owner; graph code only stores it */
    Branching branching[2]; /* mechanical: [0] translation, [1] rotation; scalar: [0] */
    /* for completion: lower first; at equal preference first edges near the datum (scalar domains),
     * then in order of making */
    int preference[2];
} Edge;

typedef struct Graph Graph;

Graph *graph_new(void);
Graph *graph_copy(const Graph *from); /* new, with the same numbers */
void graph_free(Graph *graph);        /* NULL is fine */
int graph_add_node(Graph *graph, const char *name, Domain domain, bool datum);
/* Copies `edge`, including its name; tail and head must be nodes of the edge's domain (assert). */
int graph_add_edge(Graph *graph, const Edge *edge);
/* State to return to: removes the nodes and edges made since then. */
typedef struct GraphMark {
    int nodes, edges;
    PoolMark texts;
} GraphMark;
GraphMark graph_mark(const Graph *graph);
void graph_trim(Graph *graph, const GraphMark *mark);
int graph_node_count(const Graph *graph);
int graph_edge_count(const Graph *graph);
const Node *graph_node(const Graph *graph, int node); /* borrowed until the graph grows */
const Edge *graph_edge(const Graph *graph, int edge);
int graph_find_node(const Graph *graph, const char *name); /* -1: none */
int graph_find_edge(const Graph *graph, const char *name); /* the first with that name; -1: none */
Branching graph_branching(const Graph *graph, int edge, TreeKind kind); /* NEVER in other domains */
/* the edge belongs to the graph that `kind` spans */
bool graph_edge_in(const Graph *graph, int edge, TreeKind kind);
/* every edge at a node, in order of making: count, and *edges borrowed until the graph grows */
int graph_edges_at(const Graph *graph, int node, const int **edges);

/* Connected parts of a domain: part[node] = 0, 1, ... for its nodes, -1 for others; returns the
 * number of parts. `part` has one entry for each node. O(V + E). */
int graph_parts(const Graph *graph, Domain domain, int *part);

#endif
