/* graph_picture.c: nodes as rings, edges as arrows: branches bold, chords thin
 *
 * Each tree has a panel; if the mechanical ones differ they are side by side, with the same
 * positions of nodes. Each domain has its colour and dashes. Before the trees of a terminal graph
 * is a panel with the boxes and all domains outside of them. */
#include "present/graph_picture.h"

#include "present/black_boxes.h"
#include "present/graph_layout.h"

#include <math.h>
#include <string.h>

#define NODE_SIZE 7.0
#define NAME_TEXT 12.0 /* px: of edges, of nodes */
#define NODE_TEXT 13.0
#define CAPTION   34.0 /* px above a panel */
#define LEGEND    40.0 /* px below all of them */
#define SOFT      "#b5b5b5"
#define GLOW      "#ffd54a"

typedef struct Panel {
    const Graph *graph;
    const Tree *tree; /* NULL: boxes, of which no edge is a branch or a chord */
    TreeKind kind;
    const int *nodes;
    int node_count;
    const char *caption;
    Point corner, size;
    const Point *places; /* of nodes, in the panel */
} Panel;

typedef struct GraphPicture {
    const View *view;
    const Graph *graph;
    double widest; /* px: of panels side by side */
    Lit lit;
    int edge; /* that is lit; -1 */
    BlackBoxes boxes;
    Panel panels[TREE_KINDS + 1];
    int count;
    Point *places[TREE_KINDS + 1]; /* by panel; NULL: those of the panel before */
    LIST(Point) names;             /* low and high corners of those placed so far */
    Picture *out;
} GraphPicture;

static const Dash dashes[DOMAIN_COUNT] = {DASH_NONE,   DASH_LONG, DASH_DOTS,
                                          DASH_CENTRE, DASH_LONG, DASH_DOTS};

/* --- what is drawn --- */

static bool is_lit_in(const GraphPicture *picture, const Tree *tree)
{
    return picture->lit == LIT_NOTHING ||
           (graph_edge_in(picture->graph, picture->edge, tree_kind(tree)) &&
            tree_has(tree, picture->edge) == (picture->lit == LIT_CUTSET));
}

static bool edge_is_lit(const GraphPicture *picture, const Tree *tree, int e)
{
    const Edge *edge = graph_edge(picture->graph, e);
    const Edge *chord = graph_edge(picture->graph, picture->edge);

    if (e == picture->edge)
        return true;
    if (picture->lit == LIT_CUTSET)
        return tree_is_beyond(tree, picture->edge, edge->tail) !=
               tree_is_beyond(tree, picture->edge, edge->head);

    /* a branch is on the way between two nodes that it parts */
    return tree_has(tree, e) &&
           tree_is_beyond(tree, e, chord->tail) != tree_is_beyond(tree, e, chord->head);
}

static Status find_edge(GraphPicture *picture, const char *name, Diag *diag)
{
    Suggest suggest = suggest_for(name);

    picture->edge = graph_find_edge(picture->graph, name);
    if (picture->edge >= 0)
        return OK;
    for (int e = 0; e < graph_edge_count(picture->graph); e++)
        suggest_offer(&suggest, graph_edge(picture->graph, e)->name);
    (void)diag_set(diag, E_NAME, "there is no edge '%s'", name);
    suggest_hint(&suggest, diag);
    return E_NAME;
}

/* --- panels --- */

static Status lay_out(GraphPicture *picture, Panel *panel, Diag *diag)
{
    Point **places = &picture->places[picture->count];

    *places = NEW_ARRAY(Point, graph_node_count(panel->graph));
    panel->places = *places;
    return graph_layout(panel->graph, panel->nodes, panel->node_count, picture->view->watch,
                        *places, &panel->size, diag);
}

static Status add_boxes(GraphPicture *picture, Diag *diag)
{
    BlackBoxes *boxes = &picture->boxes;
    Panel *panel = &picture->panels[picture->count];

    if (picture->view->terminal == NULL || picture->view->terminal->ports.count == 0 ||
        picture->lit != LIT_NOTHING)
        return OK;
    black_boxes_make(picture->view, boxes);
    *panel = (Panel){.graph = boxes->graph,
                     .kind = TREE_TRANSLATION,
                     .nodes = boxes->nodes.at,
                     .node_count = boxes->nodes.count,
                     .caption = "instances as boxes"};
    TRY(lay_out(picture, panel, diag));
    black_boxes_part(boxes, picture->places[picture->count], &panel->size);
    black_boxes_set_pins(boxes, panel->places);
    picture->count++;
    return OK;
}

static Status add_panels(GraphPicture *picture, Diag *diag)
{
    const Tree *trees[TREE_KINDS] = {NULL};

    TRY(view_trees(picture->view, trees, diag));
    TRY(add_boxes(picture, diag));

    const bool both = trees[TREE_TRANSLATION] != NULL && trees[TREE_ROTATION] != NULL &&
                      tree_has_branches_of(trees[TREE_TRANSLATION], trees[TREE_ROTATION]);

    for (int k = 0; k < TREE_KINDS; k++) {
        Panel *panel = &picture->panels[picture->count];

        if (trees[k] == NULL || (both && k == TREE_ROTATION) || !is_lit_in(picture, trees[k]))
            continue;
        *panel = (Panel){.graph = picture->graph,
                         .tree = trees[k],
                         .kind = (TreeKind)k,
                         .caption = both && k == TREE_TRANSLATION ? "mechanical"
                                                                  : tree_kind_name((TreeKind)k)};
        panel->nodes = tree_nodes(trees[k], &panel->node_count);
        if (k == TREE_ROTATION && picture->count > 0 && panel[-1].kind == TREE_TRANSLATION &&
            panel[-1].tree != NULL) { /* nodes have the positions of the panel before */
            panel->places = panel[-1].places;
            panel->size = panel[-1].size;
        } else {
            TRY(lay_out(picture, panel, diag));
        }
        panel->size.x = fmax(panel->size.x, 170);
        picture->count++;
    }
    if (picture->count > 0)
        return OK;
    if (picture->lit == LIT_NOTHING)
        return diag_set(diag, E_MISSING, "there are no edges to draw");

    const char *name = graph_edge(picture->graph, picture->edge)->name;

    (void)diag_set(diag, E_BRANCH, "%s is a %s of its trees", name,
                   picture->lit == LIT_CIRCUIT ? "branch" : "chord");
    diag_hint(diag,
              picture->lit == LIT_CIRCUIT ? "a branch has a cutset: draw cutset %s"
                                          : "a chord has a circuit: draw circuit %s",
              name);
    return E_BRANCH;
}

/* side by side, in rows; returns the size of the sheet */
static Point place_panels(GraphPicture *picture)
{
    Point at = {0, 0}, size = {0, 0};
    double row = 0;

    for (int i = 0; i < picture->count; i++) {
        Panel *panel = &picture->panels[i];

        if (at.x > 0 && at.x + panel->size.x > picture->widest) {
            at = (Point){0, at.y + row};
            row = 0;
        }
        panel->corner = (Point){at.x, at.y + CAPTION};
        at.x += panel->size.x;
        row = fmax(row, panel->size.y + CAPTION);
        size = (Point){fmax(size.x, at.x), fmax(size.y, at.y + row)};
    }
    return (Point){fmax(size.x, 420), size.y + LEGEND};
}

/* --- edges --- */

enum { BEND = 16 }; /* lines of a curve */

static Point node_at(const Panel *panel, int node)
{
    return (Point){panel->corner.x + panel->places[node].x,
                   panel->corner.y + panel->places[node].y};
}

/* the curve between two points whose middle is `bend` px off the straight line */
static void make_curve(Point a, Point b, double bend, Point out[BEND + 1])
{
    const double length = fmax(hypot(b.x - a.x, b.y - a.y), 1e-6);
    const Point n = {-(b.y - a.y) / length, (b.x - a.x) / length};

    for (int i = 0; i <= BEND; i++) {
        const double s = (double)i / BEND, h = 4 * bend * s * (1 - s);

        out[i] = (Point){a.x + s * (b.x - a.x) + h * n.x, a.y + s * (b.y - a.y) + h * n.y};
    }
}

/* half the width and height of a node's shape: a ring or a box */
static Point half_of(const GraphPicture *picture, const Panel *panel, int node)
{
    return panel->tree == NULL && node >= picture->boxes.first
               ? picture->boxes.boxes.at[node - picture->boxes.first].half
               : (Point){NODE_SIZE, NODE_SIZE};
}

static bool passes_a_node(const GraphPicture *picture, const Panel *panel, const Edge *edge,
                          const Point curve[BEND + 1])
{
    for (int k = 0; k < panel->node_count; k++) {
        const Point p = node_at(panel, panel->nodes[k]);
        const Point half = half_of(picture, panel, panel->nodes[k]);

        if (panel->nodes[k] == edge->tail || panel->nodes[k] == edge->head)
            continue;
        for (int i = 1; i < BEND; i++)
            if (hypot(fmax(fabs(curve[i].x - p.x) - half.x, 0),
                      fmax(fabs(curve[i].y - p.y) - half.y, 0)) < NODE_SIZE)
                return true;
    }
    return false;
}

/* which of the edges between the same two nodes it is, and how many there are */
static int place_among(const Panel *panel, int e, int *count)
{
    const Edge *edge = graph_edge(panel->graph, e);
    const int *edges;
    const int all = graph_edges_at(panel->graph, edge->tail, &edges);
    int place = 0;

    *count = 0;
    for (int i = 0; i < all; i++) {
        const Edge *other = graph_edge(panel->graph, edges[i]);

        if (!graph_edge_in(panel->graph, edges[i], panel->kind) ||
            (other->tail != edge->head && other->head != edge->head))
            continue;
        if (edges[i] == e)
            place = *count;
        (*count)++;
    }
    return place;
}

static void find_curve(const GraphPicture *picture, const Panel *panel, int e,
                       Point curve[BEND + 1])
{
    static const double tries[] = {0, 26, -26, 52, -52, 80, -80, 110, -110};
    const Edge *edge = graph_edge(panel->graph, e);
    const Point a = node_at(panel, edge->tail), b = node_at(panel, edge->head);
    int count;
    const int place = place_among(panel, e, &count);

    if (count > 1) { /* turned, the other side of the line is meant */
        make_curve(a, b, (place - (count - 1) / 2.0) * 30 * (edge->tail < edge->head ? 1 : -1),
                   curve);
        return;
    }
    for (int i = 0; i < COUNT(tries); i++) {
        make_curve(a, b, tries[i], curve);
        if (!passes_a_node(picture, panel, edge, curve))
            return;
    }
    make_curve(a, b, 0, curve);
}

/* --- names --- */

/* overlap of a text centred there with those placed so far, px^2 */
static double covers(const GraphPicture *picture, Point low, Point high)
{
    double sum = 0;

    for (int i = 0; i < picture->names.count; i += 2) {
        const Point *box = picture->names.at + i;
        const double wide = fmin(high.x, box[1].x) - fmax(low.x, box[0].x);
        const double tall = fmin(high.y, box[1].y) - fmax(low.y, box[0].y);

        if (wide > 0 && tall > 0)
            sum += wide * tall;
    }
    return sum;
}

/* On its edge, as near to the middle as no other name is covered. */
static Point place_name(GraphPicture *picture, const Point curve[BEND + 1], const char *name)
{
    static const int places[] = {0, 1, -1, 2, -2, 3, -3, 4, -4}; /* from the middle */
    const double half = 0.3 * NAME_TEXT * text_width(name);
    double least = INFINITY;
    Point best = {0, 0}, low, high;

    for (int i = 0; i < COUNT(places); i++) {
        const Point at = curve[BEND / 2 + places[i]];

        low = (Point){at.x - half, at.y - 0.5 * NAME_TEXT};
        high = (Point){at.x + half, at.y + 0.5 * NAME_TEXT};

        const double covered = covers(picture, low, high);

        if (covered < least) {
            least = covered;
            best = at;
        }
    }
    LIST_PUSH(picture->names, ((Point){best.x - half, best.y - 0.5 * NAME_TEXT}));
    LIST_PUSH(picture->names, ((Point){best.x + half, best.y + 0.5 * NAME_TEXT}));
    return (Point){best.x, best.y + 4};
}

/* position of a node's name */
static Point node_name(const Panel *panel, int node)
{
    const Point at = node_at(panel, node);

    return (Point){at.x + NODE_SIZE + 3, at.y - NODE_SIZE - 1};
}

static void keep_node_names(GraphPicture *picture, const Panel *panel)
{
    picture->names.count = 0;
    for (int i = 0; i < panel->node_count; i++) {
        const int node = panel->nodes[i];
        const Point at = node_name(panel, node), ring = node_at(panel, node);
        const Point half = half_of(picture, panel, node);
        const int letters = text_width(graph_node(panel->graph, node)->name);

        LIST_PUSH(picture->names, ((Point){ring.x - half.x, ring.y - half.y}));
        LIST_PUSH(picture->names, ((Point){ring.x + half.x, ring.y + half.y}));
        if (half.x > NODE_SIZE) /* its name is inside it */
            continue;

        LIST_PUSH(picture->names, ((Point){at.x, at.y - 0.8 * NODE_TEXT}));
        LIST_PUSH(picture->names, ((Point){at.x + 0.6 * NODE_TEXT * letters, at.y}));
    }
}

/* --- edges and nodes on paper --- */

/* from its box to its node, or back: the direction of its motion or voltage */
static void draw_port(GraphPicture *picture, const Panel *panel, int e)
{
    const Edge *edge = graph_edge(panel->graph, e);
    const TerminalPort *port = black_boxes_port(&picture->boxes, e);
    const Domain domain = black_boxes_domain(&picture->boxes, e);
    const char *color = picture_color((int)domain);
    const Ink head = {.stroke = color, .width = 1.4};
    const Point pin = black_boxes_pin(&picture->boxes, e, node_at(panel, edge->tail));
    const Point node = node_at(panel, edge->head);
    const double length = fmax(hypot(node.x - pin.x, node.y - pin.y), 1e-6);
    const Point along = {(node.x - pin.x) / length, (node.y - pin.y) / length};
    const Point from = {pin.x + 4 * along.x, pin.y + 4 * along.y}; /* beside its dot */
    const Point to = {node.x - (NODE_SIZE + 1) * along.x, node.y - (NODE_SIZE + 1) * along.y};
    const Point foot = {12 * along.x, 12 * along.y};
    Text name = {0};

    text_addf(&name, "%s.%s", graph_node(panel->graph, edge->tail)->name, edge->name);
    picture_of(picture->out, "port", name.at);
    picture_line(picture->out, (Ink){.stroke = color, .width = 1.2, .dash = dashes[domain]},
                 (Point[]){from, to}, 2);
    if (port->gives)
        picture_arrow(picture->out, head, (Point){to.x - foot.x, to.y - foot.y}, to);
    if (port->takes)
        picture_arrow(picture->out, head, (Point){from.x + foot.x, from.y + foot.y}, from);
    text_free(&name);
}

static void draw_edge(GraphPicture *picture, const Panel *panel, int e)
{
    const Edge *edge = graph_edge(panel->graph, e);
    const bool branch = panel->tree != NULL && tree_has(panel->tree, e);
    const bool lit = picture->lit != LIT_NOTHING && edge_is_lit(picture, panel->tree, e);
    const bool soft = picture->lit != LIT_NOTHING && !lit;
    const Domain domain =
        panel->tree != NULL ? edge->domain : black_boxes_domain(&picture->boxes, e);
    const char *color = soft ? SOFT : picture_color((int)domain);
    const Ink ink = {.stroke = color, .width = branch ? 3.4 : 1.2, .dash = dashes[domain]};
    Point curve[BEND + 1];
    int last = BEND;

    find_curve(picture, panel, e, curve);
    picture_of(picture->out,
               panel->tree == NULL ? "outside"
               : branch            ? "branch"
                                   : "chord",
               edge->name);
    if (lit)
        picture_line(picture->out, (Ink){.stroke = GLOW, .width = 10}, curve, BEND + 1);

    /* the arrow ends at the ring */
    while (last > BEND / 2 &&
           hypot(curve[last].x - curve[BEND].x, curve[last].y - curve[BEND].y) < NODE_SIZE + 1)
        last--;
    picture_line(picture->out, ink, curve, last);
    picture_arrow(picture->out, (Ink){.stroke = color, .width = branch ? 3 : 1.4}, curve[last - 2],
                  curve[last]);
    picture_text(picture->out, soft ? "#999999" : "#222222", place_name(picture, curve, edge->name),
                 NAME_TEXT, ANCHOR_MIDDLE, edge->name);
}

static void draw_nodes(GraphPicture *picture, const Panel *panel)
{
    for (int i = 0; i < panel->node_count; i++) {
        const Node *node = graph_node(panel->graph, panel->nodes[i]);
        const Point at = node_at(panel, panel->nodes[i]);
        const Ink ring = {.stroke = "#222222", .fill = "#ffffff", .width = 1.5};

        if (panel->tree == NULL && panel->nodes[i] >= picture->boxes.first) {
            black_boxes_draw(&picture->boxes, picture->view, panel->nodes[i], at, picture->out);
            continue;
        }
        picture_of(picture->out, "node", node->name);
        picture_circle(picture->out, ring, at, NODE_SIZE);
        if (node->datum)
            picture_circle(picture->out, (Ink){.fill = "#222222"}, at, NODE_SIZE - 3);
        picture_text(picture->out, "#222222", node_name(panel, panel->nodes[i]), NODE_TEXT,
                     ANCHOR_START, node->name);
    }
}

static void draw_panel(GraphPicture *picture, const Panel *panel)
{
    Text caption = {0};

    text_addf(&caption, "%s%s", panel->caption, panel->tree != NULL ? " tree" : "");
    picture_of(picture->out, "caption", panel->caption);
    picture_text(picture->out, "#222222", (Point){panel->corner.x + 16, panel->corner.y - 10}, 15,
                 ANCHOR_START, caption.at);
    text_free(&caption);

    keep_node_names(picture, panel);
    /* chords first: branches lie over them */
    for (int pass = 0; pass < 2 && panel->tree != NULL; pass++)
        for (int e = 0; e < graph_edge_count(panel->graph); e++)
            if (graph_edge_in(panel->graph, e, panel->kind) &&
                tree_has(panel->tree, e) == (pass == 1))
                draw_edge(picture, panel, e);
    for (int e = 0; e < graph_edge_count(panel->graph) && panel->tree == NULL; e++)
        (black_boxes_port(&picture->boxes, e) != NULL ? draw_port : draw_edge)(picture, panel, e);
    draw_nodes(picture, panel);
}

/* --- the legend --- */

static double write_legend(GraphPicture *picture, double x, Ink ink, const char *text)
{
    const double y = picture->out->height - 16;

    picture_line(picture->out, ink, (Point[]){{x, y}, {x + 34, y}}, 2);
    picture_text(picture->out, "#222222", (Point){x + 40, y + 4}, 12, ANCHOR_START, text);
    return x + 40 + 7.0 * text_width(text) + 24;
}

static void draw_legend(GraphPicture *picture)
{
    const char *dark = "#222222";
    double x = 16;

    picture_of(picture->out, "legend", "of edges");
    x = write_legend(picture, x, (Ink){.stroke = dark, .width = 3.4}, "branch");
    x = write_legend(picture, x, (Ink){.stroke = dark, .width = 1.2}, "chord");
    if (picture->lit != LIT_NOTHING)
        x = write_legend(picture, x, (Ink){.stroke = GLOW, .width = 10},
                         picture->lit == LIT_CIRCUIT ? "circuit" : "cutset");
    if (picture->boxes.graph != NULL) {
        picture_arrow(picture->out, (Ink){.stroke = dark, .width = 1.4},
                      (Point){x, picture->out->height - 16},
                      (Point){x + 34, picture->out->height - 16});
        x = write_legend(picture, x, (Ink){.stroke = dark, .width = 1.2},
                         "way of a port's motion or voltage");
    }
    for (int i = 0; i < picture->count; i++) {
        const Domain domain = tree_kind_domain(picture->panels[i].kind);

        if (picture->panels[i].tree == NULL ||
            (i > 0 && picture->panels[i - 1].tree != NULL &&
             tree_kind_domain(picture->panels[i - 1].kind) == domain))
            continue;
        x = write_legend(
            picture, x,
            (Ink){.stroke = picture_color((int)domain), .width = 2, .dash = dashes[domain]},
            domain_name(domain));
    }
    picture->out->width = fmax(picture->out->width, x);
}

Status graph_picture(const View *view, double widest, Lit lit, const char *edge, Picture *out,
                     Diag *diag)
{
    GraphPicture picture = {.view = view,
                            .graph = view_graph(view),
                            .widest = widest,
                            .lit = lit,
                            .edge = -1,
                            .out = out};
    Point size;
    Status status = OK;

    if (lit != LIT_NOTHING)
        CHECK(find_edge(&picture, edge, diag));
    CHECK(add_panels(&picture, diag));
    size = place_panels(&picture);
    picture_open(out, size.x, size.y);
    for (int i = 0; i < picture.count; i++)
        draw_panel(&picture, &picture.panels[i]);
    draw_legend(&picture);
done:
    LIST_FREE(picture.names);
    black_boxes_free(&picture.boxes);
    for (int i = 0; i <= TREE_KINDS; i++)
        mem_free(picture.places[i]);
    return status;
}
