/* tree.c: a finished tree, numbered in depth-first order
 *
 * place[node] is the number of nodes before it. The nodes beyond a node follow it immediately, and
 * end before beyond[node]. So "beyond" is two comparisons. */
#include "graph/tree.h"

#include "graph/tree_draft.h"

#include <assert.h>
#include <string.h>

struct Tree {
    const Graph *graph;
    TreeKind kind;
    unsigned char *standing; /* a Standing for each edge of the graph */
    int node_count;          /* all arrays below have an entry for each node or for each edge */
    int chord_count;
    int *nodes;
    int *branches;
    int *chords;
    int *parent;
    int *parent_edge;
    int *depth;
    int *place;
    int *beyond;
    int *far; /* by edge: its node away from the datum; -1: no branch */
};

static Tree *tree_new(const Graph *graph, TreeKind kind)
{
    Tree *tree = NEW(Tree);
    int nodes = graph_node_count(graph);
    int edges = graph_edge_count(graph);

    tree->graph = graph;
    tree->kind = kind;
    tree->nodes = NEW_ARRAY(int, nodes);
    tree->branches = NEW_ARRAY(int, nodes);
    tree->chords = NEW_ARRAY(int, edges);
    tree->parent = NEW_ARRAY(int, nodes);
    tree->parent_edge = NEW_ARRAY(int, nodes);
    tree->depth = NEW_ARRAY(int, nodes);
    tree->place = NEW_ARRAY(int, nodes);
    tree->beyond = NEW_ARRAY(int, nodes);
    tree->far = NEW_ARRAY(int, edges);
    for (int i = 0; i < nodes; i++)
        tree->parent[i] = tree->parent_edge[i] = tree->depth[i] = tree->place[i] = -1;
    for (int e = 0; e < edges; e++)
        tree->far[e] = -1;
    return tree;
}

void tree_free(Tree *tree)
{
    if (tree == NULL)
        return;
    MEM_FREE(tree->standing, tree->nodes, tree->branches, tree->chords, tree->parent,
             tree->parent_edge, tree->depth, tree->place, tree->beyond, tree->far, tree);
}

/* numbers a node and pushes the edges at it, the first made on top */
static int visit(Tree *tree, int node, int *stack, int top)
{
    const int *edges;
    int degree = graph_edges_at(tree->graph, node, &edges);

    tree->place[node] = tree->node_count;
    tree->nodes[tree->node_count++] = node;
    for (int k = degree - 1; k >= 0; k--) {
        const Edge *edge = graph_edge(tree->graph, edges[k]);
        int next = edge->tail == node ? edge->head : edge->tail;

        if (tree->standing[edges[k]] == STANDING_CHORD || edges[k] == tree->parent_edge[node])
            continue;
        tree->parent[next] = node;
        tree->parent_edge[next] = edges[k];
        tree->depth[next] = tree->depth[node] + 1;
        tree->far[edges[k]] = next;
        stack[top++] = next;
    }
    return top;
}

static void grow(Tree *tree, int datum)
{
    int *stack = NEW_ARRAY(int, graph_node_count(tree->graph));
    int top = 0;

    tree->depth[datum] = 0;
    stack[top++] = datum;
    while (top > 0) {
        int node = stack[--top];

        top = visit(tree, node, stack, top);
    }
    mem_free(stack);

    /* children come after their parents, so the ends of children are known first */
    for (int i = 0; i < tree->node_count; i++)
        tree->beyond[tree->nodes[i]] = i + 1;
    for (int i = tree->node_count - 1; i > 0; i--) {
        int node = tree->nodes[i];
        int parent = tree->parent[node];

        tree->branches[i - 1] = tree->parent_edge[node];
        if (tree->beyond[parent] < tree->beyond[node])
            tree->beyond[parent] = tree->beyond[node];
    }
}

Status tree_complete(const Graph *graph, TreeKind kind, const TreeChoice *choice, bool exact,
                     Tree **out, Diag *diag)
{
    static const TreeChoice nothing = {0};
    Status status = OK;
    Draft draft = {.graph = graph, .kind = kind, .choice = choice != NULL ? choice : &nothing};
    Tree *tree;

    CHECK(draft_make(&draft, exact, diag));

    tree = tree_new(graph, kind);
    tree->standing = draft.standing;
    draft.standing = NULL;
    if (draft.datum >= 0)
        grow(tree, draft.datum);
    for (int e = 0; e < graph_edge_count(graph); e++) {
        if (graph_edge_in(graph, e, kind) && tree->standing[e] == STANDING_CHORD)
            tree->chords[tree->chord_count++] = e;
    }
    *out = tree;
done:
    draft_free(&draft);
    return status;
}

static int *numbers(const int *from, int count)
{
    int *copy = NEW_ARRAY(int, count);

    if (count > 0)
        memcpy(copy, from, (size_t)count * sizeof *copy);
    return copy;
}

Tree *tree_copy(const Tree *from, const Graph *graph)
{
    const int nodes = graph_node_count(graph), edges = graph_edge_count(graph);
    Tree *tree = NEW(Tree);

    *tree = *from;
    tree->graph = graph;
    tree->standing = NEW_ARRAY(unsigned char, edges);
    for (int e = 0; e < edges; e++)
        tree->standing[e] =
            from->standing[e] == STANDING_COMPLETED ? STANDING_CHOSEN : from->standing[e];
    tree->nodes = numbers(from->nodes, nodes);
    tree->branches = numbers(from->branches, nodes);
    tree->chords = numbers(from->chords, edges);
    tree->parent = numbers(from->parent, nodes);
    tree->parent_edge = numbers(from->parent_edge, nodes);
    tree->depth = numbers(from->depth, nodes);
    tree->place = numbers(from->place, nodes);
    tree->beyond = numbers(from->beyond, nodes);
    tree->far = numbers(from->far, edges);
    return tree;
}

TreeKind tree_kind(const Tree *tree)
{
    return tree->kind;
}

const Graph *tree_graph(const Tree *tree)
{
    return tree->graph;
}

bool tree_has(const Tree *tree, int edge)
{
    return tree->standing[edge] != STANDING_CHORD;
}

bool tree_has_branches_of(const Tree *tree, const Tree *other)
{
    for (int e = 0; e < graph_edge_count(tree->graph); e++)
        if (tree_has(tree, e) != tree_has(other, e))
            return false;
    return true;
}

bool tree_was_completed(const Tree *tree, int edge)
{
    return tree->standing[edge] == STANDING_COMPLETED;
}

int tree_branch_count(const Tree *tree)
{
    return tree->node_count > 0 ? tree->node_count - 1 : 0;
}

const int *tree_branches(const Tree *tree)
{
    return tree->branches;
}

int tree_chord_count(const Tree *tree)
{
    return tree->chord_count;
}

const int *tree_chords(const Tree *tree)
{
    return tree->chords;
}

const int *tree_nodes(const Tree *tree, int *count)
{
    *count = tree->node_count;
    return tree->nodes;
}

int tree_parent(const Tree *tree, int node)
{
    return tree->parent[node];
}

int tree_parent_edge(const Tree *tree, int node)
{
    return tree->parent_edge[node];
}

bool tree_is_forward(const Tree *tree, int node)
{
    int edge = tree->parent_edge[node];

    return edge >= 0 && graph_edge(tree->graph, edge)->head == node;
}

int tree_depth(const Tree *tree, int node)
{
    return tree->depth[node];
}

bool tree_is_beyond(const Tree *tree, int branch, int node)
{
    int far = tree->far[branch];

    assert(far >= 0);
    return tree->place[node] >= tree->place[far] && tree->place[node] < tree->beyond[far];
}

const int *tree_nodes_beyond(const Tree *tree, int branch, int *count)
{
    const int far = tree->far[branch];

    assert(far >= 0);
    *count = tree->beyond[far] - tree->place[far];
    return tree->nodes + tree->place[far];
}

int tree_far_node(const Tree *tree, int branch)
{
    return tree->far[branch];
}

int tree_path(const Tree *tree, int from, int to, int *edges, int *signs)
{
    int count = 0;
    int back = 0; /* length of the path up from `to`, stored in reverse from the end of the array */
    int end = tree->depth[from] + tree->depth[to];

    while (from != to) {
        if (tree->depth[from] >= tree->depth[to]) {
            edges[count] = tree->parent_edge[from];
            signs[count++] = tree_is_forward(tree, from) ? -1 : 1;
            from = tree->parent[from];
        } else {
            back++;
            edges[end - back] = tree->parent_edge[to];
            signs[end - back] = tree_is_forward(tree, to) ? 1 : -1;
            to = tree->parent[to];
        }
    }
    memmove(edges + count, edges + end - back, (size_t)back * sizeof *edges);
    memmove(signs + count, signs + end - back, (size_t)back * sizeof *signs);
    return count + back;
}
