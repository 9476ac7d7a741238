/* draw.c: the linear graph on a terminal and for graphviz */
#include "present/info.h"

#include <string.h>

typedef struct GraphDrawing {
    const View *view;
    const Graph *graph;
    const Tree *tree;
    Text *out;
    Text stem; /* text left of the branches of the present node */
} GraphDrawing;

static bool hangs_from(const Tree *tree, int child, int node)
{
    return tree_parent(tree, child) == node;
}

enum { DEEPEST = 400 }; /* branches in a row that are drawn */

/* the branches that leave a node outward, and below each what hangs from it */
static void draw_below(GraphDrawing *drawing, int node)
{
    const bool unicode = drawing->view->page.unicode;
    int count, last = -1;
    const int *nodes = tree_nodes(drawing->tree, &count);

    for (int i = 0; i < count; i++)
        if (hangs_from(drawing->tree, nodes[i], node))
            last = nodes[i];
    for (int i = 0; i < count; i++) {
        const int child = nodes[i];
        const size_t stem = drawing->stem.length;
        int edge;

        if (!hangs_from(drawing->tree, child, node))
            continue;
        edge = tree_parent_edge(drawing->tree, child);
        if (drawing->stem.length > 0)
            text_add(drawing->out, drawing->stem.at);
        text_add(drawing->out,
                 unicode ? (child == last ? "└─ " : "├─ ") : (child == last ? "`- " : "|- "));
        text_addf(drawing->out, "%s (%s) %s %s\n", graph_edge(drawing->graph, edge)->name,
                  view_edge_type(drawing->view, edge),
                  tree_is_forward(drawing->tree, child) ? "->" : "<-",
                  graph_node(drawing->graph, child)->name);
        text_add(&drawing->stem, child == last ? "   " : unicode ? "│  " : "|  ");
        if (tree_depth(drawing->tree, child) < DEEPEST)
            draw_below(drawing, child);
        else
            text_addf(drawing->out, "%s...\n", drawing->stem.at);
        drawing->stem.length = stem;
        drawing->stem.at[stem] = '\0';
    }
}

static void draw_chords(GraphDrawing *drawing)
{
    const int *chords = tree_chords(drawing->tree);

    if (tree_chord_count(drawing->tree) > 0)
        text_add(drawing->out, "chords\n");
    for (int i = 0; i < tree_chord_count(drawing->tree); i++) {
        const Edge *edge = graph_edge(drawing->graph, chords[i]);

        text_addf(drawing->out, "   %s (%s): %s -> %s\n", edge->name,
                  view_edge_type(drawing->view, chords[i]),
                  graph_node(drawing->graph, edge->tail)->name,
                  graph_node(drawing->graph, edge->head)->name);
    }
}

Status draw_text(const View *view, Text *out, Diag *diag)
{
    const Tree *trees[TREE_KINDS] = {NULL};
    const Graph *graph = view_graph(view);
    bool both;

    TRY(view_trees(view, trees, diag));
    both = trees[TREE_TRANSLATION] != NULL && trees[TREE_ROTATION] != NULL &&
           tree_has_branches_of(trees[TREE_TRANSLATION], trees[TREE_ROTATION]);
    for (int k = 0; k < TREE_KINDS; k++) {
        GraphDrawing drawing = {
            .view = view, .graph = graph, .tree = trees[k], .out = out, .stem = {0}};
        int count;

        if (trees[k] == NULL || (both && k == TREE_ROTATION))
            continue;
        text_addf(out, "%s tree\n",
                  both && k == TREE_TRANSLATION ? "mechanical" : tree_kind_name((TreeKind)k));
        text_addf(out, "%s\n", graph_node(graph, tree_nodes(trees[k], &count)[0])->name);
        draw_below(&drawing, tree_nodes(trees[k], &count)[0]);
        draw_chords(&drawing);
        text_free(&drawing.stem);
    }
    if (graph_edge_count(graph) == 0)
        text_add(out, "no edges yet\n");
    return OK;
}

/* --- dot --- */

/* branches are drawn solid, chords dashed; an edge that is a branch of only one mechanical tree is
 * bold, with the name of that tree */
static void dot_edge(const View *view, const Tree *const trees[TREE_KINDS], int edge, Text *out)
{
    const Graph *graph = view_graph(view);
    const Edge *e = graph_edge(graph, edge);
    bool branch = false, chord = false;
    const char *only = "";

    for (int k = 0; k < TREE_KINDS; k++) {
        if (trees[k] == NULL || !graph_edge_in(graph, edge, (TreeKind)k))
            continue;
        if (tree_has(trees[k], edge)) {
            branch = true;
            only = tree_kind_name((TreeKind)k);
        } else {
            chord = true;
        }
    }
    text_addf(out, "  n%d -> n%d [label=\"%s%s%s%s\", style=%s];\n", e->tail, e->head, e->name,
              branch && chord ? " (" : "", branch && chord ? only : "", branch && chord ? ")" : "",
              branch ? (chord ? "bold" : "solid") : "dashed");
}

/* whether an edge or a port is there: what has neither isn't drawn */
static bool is_met(const View *view, int node)
{
    const int *edges;

    for (int p = 0; view->terminal != NULL && p < view->terminal->ports.count; p++)
        if (view->terminal->ports.at[p].node == node)
            return true;
    return graph_edges_at(view_graph(view), node, &edges) > 0;
}

/* An instance is a box with the names of its ports at its border; an arrow shows the direction of a
 * port's motion or voltage. */
static void dot_boxes(const View *view, const TerminalGraph *terminal, Text *out)
{
    static const char *const ways[2][2] = {{"none", "back"}, {"forward", "both"}};
    int last = -1;

    for (int p = 0; p < terminal->ports.count; p++) {
        const TerminalPort *port = &terminal->ports.at[p];

        if (port->use != last)
            text_addf(out, "  u%d [label=\"%s\", shape=box, penwidth=3];\n", port->use,
                      model_use(view->model, port->use)->name);
        last = port->use;
        text_addf(out, "  u%d -> n%d [taillabel=\"%s\", dir=%s, style=dotted];\n", port->use,
                  port->node, port->name, ways[port->gives][port->takes]);
    }
}

void draw_dot(const View *view, Text *out)
{
    const Graph *graph = view_graph(view);
    const Tree *trees[TREE_KINDS] = {NULL};
    Diag ignored;

    /* a graph without a tree is drawn all the same */
    if (view_trees(view, trees, &ignored) != OK)
        memset(trees, 0, sizeof trees);
    text_add(out, "digraph model {\n  node [shape=circle];\n");
    for (int n = 0; n < graph_node_count(graph); n++) {
        if (is_met(view, n))
            text_addf(out, "  n%d [label=\"%s\"%s];\n", n, graph_node(graph, n)->name,
                      graph_node(graph, n)->datum ? ", shape=doublecircle" : "");
    }
    for (int e = 0; e < graph_edge_count(graph); e++)
        dot_edge(view, trees, e, out);
    if (view->terminal != NULL)
        dot_boxes(view, view->terminal, out);
    text_add(out, "}\n");
}
