/* terminal_graph.c: ports as edges, and the trees that the model's trees leave of them */
#include "present/terminal_graph.h"

#include <string.h>

typedef struct Collapse {
    const Model *model;
    const Graph *graph;
    const Tree *trees[TREE_KINDS];
    int *use_of;  /* by node: the outermost instance that it lies in; -1 */
    int *node_of; /* by node: in the new graph; -1: it is left out */
    TerminalGraph *out;
    LIST(int) branches[TREE_KINDS];
} Collapse;

/* "B" of leg1.B; NULL: the name is none of that use */
static const char *inner_name(const Use *use, const char *name)
{
    const size_t length = strlen(use->name);

    return strncmp(name, use->name, length) == 0 && name[length] == '.' ? name + length + 1 : NULL;
}

static const Port *port_of_node(const Collapse *c, int node)
{
    const Use *use = model_use(c->model, c->use_of[node]);
    const char *inner = inner_name(use, graph_node(c->graph, node)->name);

    for (int p = 0; inner != NULL && p < use->subsystem->port_count; p++)
        if (strcmp(use->subsystem->ports[p].name, inner) == 0)
            return &use->subsystem->ports[p];
    return NULL;
}

static void take_nodes(Collapse *c)
{
    for (int n = 0; n < graph_node_count(c->graph); n++) {
        const Node *node = graph_node(c->graph, n);

        c->use_of[n] = node->datum ? -1 : model_use_around(c->model, node->name);
        c->node_of[n] = c->use_of[n] < 0 || port_of_node(c, n) != NULL
                            ? graph_add_node(c->out->graph, node->name, node->domain, node->datum)
                            : -1;
    }
}

static int use_of_edge(const Collapse *c, int edge)
{
    return model_use_around(c->model, graph_edge(c->graph, edge)->name);
}

static void take_edges(Collapse *c)
{
    for (int e = 0; e < graph_edge_count(c->graph); e++) {
        Edge edge = *graph_edge(c->graph, e);
        int made;

        if (use_of_edge(c, e) >= 0)
            continue;
        edge.tail = c->node_of[edge.tail];
        edge.head = c->node_of[edge.head];
        made = graph_add_edge(c->out->graph, &edge);
        LIST_PUSH(c->out->of, e);
        for (int k = 0; k < TREE_KINDS; k++)
            if (c->trees[k] != NULL && graph_edge_in(c->graph, e, (TreeKind)k) &&
                tree_has(c->trees[k], e))
                LIST_PUSH(c->branches[k], made);
    }
}

/* Where the path from the datum to a port enters the inside; -1: it reaches the port from
 * outside. */
static int entry_of(const Collapse *c, const Tree *tree, int use, int node)
{
    int edge = tree_parent_edge(tree, node);

    if (edge < 0 || use_of_edge(c, edge) != use)
        return -1;
    do {
        node = tree_parent(tree, node);
        edge = tree_parent_edge(tree, node);
    } while (c->node_of[node] < 0 && edge >= 0);
    return node;
}

static int datum_of(const Graph *graph, Domain domain)
{
    for (int n = 0; n < graph_node_count(graph); n++)
        if (graph_node(graph, n)->datum && graph_node(graph, n)->domain == domain)
            return n;
    return -1;
}

/* One edge for the trees where the way enters at the same node; a mixed port has two. */
static void add_port_edges(Collapse *c, int use, const char *name, int node,
                           const int entries[TREE_KINDS])
{
    const Domain domain = graph_node(c->graph, node)->domain;
    int made = -1;

    for (int k = 0; k < TREE_KINDS; k++) {
        const bool is_second = k == TREE_ROTATION && made >= 0;
        Edge edge = {
            .name = name, .domain = domain, .component = -1, .branching = {BRANCH_MAY, BRANCH_MAY}};

        if (tree_kind_domain((TreeKind)k) != domain)
            continue;
        edge.tail = entries[k] >= 0 ? entries[k] : datum_of(c->graph, domain);
        edge.head = node;
        if (edge.tail == node)
            continue;
        if (!is_second || entries[TREE_TRANSLATION] != entries[TREE_ROTATION]) {
            /* v = v(port): scalar edges point to the datum */
            if (domain != DOMAIN_MECHANICAL) {
                edge.head = edge.tail;
                edge.tail = node;
            }
            edge.tail = c->node_of[edge.tail];
            edge.head = c->node_of[edge.head];
            made = graph_add_edge(c->out->graph, &edge);
            LIST_PUSH(c->out->of, -1 - use);
        }
        if (entries[k] >= 0)
            LIST_PUSH(c->branches[k], made);
    }
}

/* `edge` is called leg1.B where `name` is B */
static void add_port(Collapse *c, int use, const char *name, const char *edge, int node)
{
    const Node *at = graph_node(c->graph, node);
    TerminalPort port = {.use = use, .node = c->node_of[node], .name = name};
    int entries[TREE_KINDS];

    for (int k = 0; k < TREE_KINDS; k++) {
        const bool is_spanned = c->trees[k] != NULL && tree_kind_domain((TreeKind)k) == at->domain;

        entries[k] = is_spanned ? entry_of(c, c->trees[k], use, node) : -1;
        port.gives |= entries[k] >= 0;
        port.takes |= is_spanned && entries[k] < 0;
    }
    LIST_PUSH(c->out->ports, port);
    if (!at->datum)
        add_port_edges(c, use, edge, node, entries);
}

static void add_ports(Collapse *c)
{
    for (int u = 0; u < model_use_count(c->model); u++) {
        const Use *use = model_use(c->model, u);

        for (int p = 0; use->outer < 0 && p < use->subsystem->port_count; p++) {
            const Port *port = &use->subsystem->ports[p];
            Text name = {0};
            int node;

            text_addf(&name, "%s.%s", use->name, port->name);
            node = graph_find_node(c->graph, name.at);
            if (node < 0 && use->bound != NULL && use->bound[p] != NULL)
                node = graph_find_node(c->graph, use->bound[p]);
            if (node >= 0)
                add_port(c, u, port->name, name.at, node);
            text_free(&name);
        }
    }
}

Status terminal_graph_make(const Model *model, TerminalGraph *out, Diag *diag)
{
    Collapse c = {.model = model, .graph = model_graph(model), .out = out};
    const int nodes = graph_node_count(c.graph);
    Status status;

    CHECK(model_trees(model, c.trees, diag));
    out->graph = graph_new();
    c.use_of = NEW_ARRAY(int, nodes);
    c.node_of = NEW_ARRAY(int, nodes);
    take_nodes(&c);
    take_edges(&c);
    add_ports(&c);
    for (int k = 0; k < TREE_KINDS; k++) {
        const TreeChoice choice = {.branches = c.branches[k].at,
                                   .branch_count = c.branches[k].count};

        if (c.trees[k] != NULL)
            CHECK(tree_complete(out->graph, (TreeKind)k, &choice, true, &out->trees[k], diag));
    }
done:
    for (int k = 0; k < TREE_KINDS; k++)
        LIST_FREE(c.branches[k]);
    MEM_FREE(c.use_of, c.node_of);
    return status;
}

void terminal_graph_free(TerminalGraph *terminal)
{
    for (int k = 0; k < TREE_KINDS; k++)
        tree_free(terminal->trees[k]);
    graph_free(terminal->graph);
    LIST_FREE(terminal->of);
    LIST_FREE(terminal->ports);
}
