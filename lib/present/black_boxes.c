/* black_boxes.c: the graph with boxes, and the positions of ports at their borders */
#include "present/black_boxes.h"

#include <math.h>

#define NAME_TEXT 14.0 /* px: of instances, of ports */
#define PORT_TEXT 12.0
#define LETTER    0.6  /* of a text's height */
#define MARGIN    10.0 /* px about a name */

const TerminalPort *black_boxes_port(const BlackBoxes *boxes, int edge)
{
    const int of = boxes->of.at[edge];

    return of < 0 ? &boxes->terminal->ports.at[-1 - of] : NULL;
}

Domain black_boxes_domain(const BlackBoxes *boxes, int edge)
{
    const TerminalPort *port = black_boxes_port(boxes, edge);
    const Graph *graph = boxes->terminal->graph;

    return port != NULL ? graph_node(graph, port->node)->domain
                        : graph_edge(graph, boxes->of.at[edge])->domain;
}

/* --- the graph --- */

/* Edges of all domains are treated equally here. */
static void add_edge(BlackBoxes *boxes, const char *name, int tail, int head, int of)
{
    const Edge edge = {.name = name, .tail = tail, .head = head, .component = -1};

    (void)graph_add_edge(boxes->graph, &edge);
    LIST_PUSH(boxes->of, of);
}

static int find_box(BlackBoxes *boxes, const View *view, int use)
{
    for (int i = 0; i < boxes->boxes.count; i++)
        if (boxes->boxes.at[i].use == use)
            return i;
    LIST_PUSH(boxes->boxes, ((BlackBox){.use = use}));
    (void)graph_add_node(boxes->graph, model_use(view->model, use)->name, DOMAIN_MECHANICAL, false);
    return boxes->boxes.count - 1;
}

static void take_outside(BlackBoxes *boxes)
{
    const Graph *graph = boxes->terminal->graph;

    for (int n = 0; n < graph_node_count(graph); n++)
        (void)graph_add_node(boxes->graph, graph_node(graph, n)->name, DOMAIN_MECHANICAL,
                             graph_node(graph, n)->datum);
    for (int e = 0; e < graph_edge_count(graph); e++) {
        const Edge *edge = graph_edge(graph, e);

        if (boxes->terminal->of.at[e] >= 0)
            add_edge(boxes, edge->name, edge->tail, edge->head, e);
    }
}

/* --- boxes --- */

static double widest_port(const BlackBoxes *boxes, int use, int *count)
{
    int letters = 1;

    *count = 0;
    for (int p = 0; p < boxes->terminal->ports.count; p++) {
        const TerminalPort *port = &boxes->terminal->ports.at[p];

        if (port->use != use)
            continue;
        (*count)++;
        if (text_width(port->name) > letters)
            letters = text_width(port->name);
    }
    return LETTER * PORT_TEXT * letters;
}

/* Its name has room between those of its ports, and these have room along the border. */
static void size_box(const BlackBoxes *boxes, BlackBox *box, const char *name)
{
    int count;
    const double port = widest_port(boxes, box->use, &count);
    const Point corner = {port / 2 + 6, 2 * PORT_TEXT};
    Point free = {LETTER * NAME_TEXT * text_width(name) / 2 + port / 2 + MARGIN, 8};
    const double missing = 1.3 * count * (port + MARGIN) / 4 - free.x - free.y;

    if (missing > 0)
        free = (Point){free.x + missing / 2, free.y + missing / 2};
    box->free = free;
    box->half = (Point){free.x + corner.x, free.y + corner.y};
}

void black_boxes_make(const View *view, BlackBoxes *boxes)
{
    const TerminalGraph *terminal = view->terminal;

    boxes->terminal = terminal;
    boxes->graph = graph_new();
    boxes->first = graph_node_count(terminal->graph);
    take_outside(boxes);
    for (int p = 0; p < terminal->ports.count; p++) {
        const TerminalPort *port = &terminal->ports.at[p];
        const int box = find_box(boxes, view, port->use);

        add_edge(boxes, port->name, boxes->first + box, port->node, -1 - p);
    }
    for (int i = 0; i < boxes->boxes.count; i++)
        size_box(boxes, &boxes->boxes.at[i], graph_node(boxes->graph, boxes->first + i)->name);
    for (int n = 0; n < graph_node_count(boxes->graph); n++) {
        const int *edges;

        if (graph_edges_at(boxes->graph, n, &edges) > 0)
            LIST_PUSH(boxes->nodes, n);
    }
    boxes->pins = NEW_ARRAY(Point, terminal->ports.count);
}

void black_boxes_free(BlackBoxes *boxes)
{
    graph_free(boxes->graph);
    LIST_FREE(boxes->nodes);
    LIST_FREE(boxes->of);
    LIST_FREE(boxes->boxes);
    mem_free(boxes->pins);
}

void black_boxes_part(const BlackBoxes *boxes, Point *places, Point *size)
{
    static const double GAP = 30, MOST = 4; /* px; nodes in one place don't make a sheet endless */
    double factor = 1;
    Point low = {0, 0}, high = {0, 0};

    for (int i = 0; i < boxes->boxes.count; i++)
        for (int k = 0; k < boxes->nodes.count; k++) {
            const int node = boxes->nodes.at[k], other = node - boxes->first;
            const Point a = places[boxes->first + i], b = places[node];
            Point room = boxes->boxes.at[i].half;

            if (other == i)
                continue;
            if (other >= 0) {
                room.x += boxes->boxes.at[other].half.x;
                room.y += boxes->boxes.at[other].half.y;
            } else if (b.x < a.x) { /* names of nodes are right of them */
                room.x += LETTER * NAME_TEXT * text_width(graph_node(boxes->graph, node)->name);
            }
            factor = fmax(factor, fmin((room.x + GAP) / fmax(fabs(a.x - b.x), 1e-6),
                                       (room.y + GAP) / fmax(fabs(a.y - b.y), 1e-6)));
        }
    factor = fmin(factor, MOST);
    for (int i = 0; i < boxes->boxes.count; i++) { /* a box hangs over no edge of the sheet */
        const Point at = places[boxes->first + i], half = boxes->boxes.at[i].half;

        low = (Point){fmin(low.x, factor * at.x - half.x - MARGIN),
                      fmin(low.y, factor * at.y - half.y - MARGIN)};
        high = (Point){fmax(high.x, factor * at.x + half.x + MARGIN),
                       fmax(high.y, factor * at.y + half.y + MARGIN)};
    }
    for (int k = 0; k < boxes->nodes.count; k++) {
        Point *at = &places[boxes->nodes.at[k]];

        *at = (Point){factor * at->x - low.x, factor * at->y - low.y};
    }
    *size = (Point){fmax(factor * size->x, high.x) - low.x, fmax(factor * size->y, high.y) - low.y};
}

/* --- the border --- */

/* A path along the free parts of the border, clockwise from the upper right corner. */
typedef struct LabelSide {
    double way;
    int port;
} LabelSide;

static double way_towards(const BlackBox *box, Point d)
{
    const Point half = box->half, free = box->free;
    const double reach = fmax(fmax(fabs(d.x) / half.x, fabs(d.y) / half.y), 1e-6);
    const Point p = {d.x / reach * free.x / half.x, d.y / reach * free.y / half.y};

    if (fabs(d.x) / half.x >= fabs(d.y) / half.y)
        return d.x > 0 ? free.y + p.y : 3 * free.y + 2 * free.x - p.y;
    return d.y > 0 ? 2 * free.y + free.x - p.x : 4 * free.y + 3 * free.x + p.x;
}

static Point place_of_way(const BlackBox *box, double way)
{
    const Point free = box->free;
    const double round = 4 * (free.x + free.y);

    way = fmod(fmod(way, round) + round, round);
    if (way < 2 * free.y)
        return (Point){box->half.x, way - free.y};
    way -= 2 * free.y;
    if (way < 2 * free.x)
        return (Point){free.x - way, box->half.y};
    way -= 2 * free.x;
    if (way < 2 * free.y)
        return (Point){-box->half.x, free.y - way};
    return (Point){way - 2 * free.y - free.x, -box->half.y};
}

/* in the order of their directions, neighbours at least `apart` from each other, around the whole
 * border */
static void spread(LabelSide *stands, int count, double round, double apart)
{
    enum { SWEEPS = 60 };

    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && stands[k].way < stands[k - 1].way; k--) {
            const LabelSide moved = stands[k];

            stands[k] = stands[k - 1];
            stands[k - 1] = moved;
        }
    for (int sweep = 0; sweep < SWEEPS && count > 1; sweep++)
        for (int i = 0; i < count; i++) {
            LabelSide *a = &stands[i], *b = &stands[(i + 1) % count];
            const double missing = apart - (b->way + (i + 1 == count ? round : 0) - a->way);

            if (missing > 0) {
                a->way -= missing / 2;
                b->way += missing / 2;
            }
        }
}

void black_boxes_set_pins(BlackBoxes *boxes, const Point *places)
{
    const TerminalGraph *terminal = boxes->terminal;
    LabelSide *stands = NEW_ARRAY(LabelSide, terminal->ports.count);

    for (int i = 0; i < boxes->boxes.count; i++) {
        const BlackBox *box = &boxes->boxes.at[i];
        const Point at = places[boxes->first + i], free = box->free;
        int count;
        const double port = widest_port(boxes, box->use, &count);

        count = 0;
        for (int p = 0; p < terminal->ports.count; p++) {
            const Point to = places[terminal->ports.at[p].node];

            if (terminal->ports.at[p].use == box->use)
                stands[count++] =
                    (LabelSide){way_towards(box, (Point){to.x - at.x, to.y - at.y}), p};
        }
        spread(stands, count, 4 * (free.x + free.y), port + MARGIN);
        for (int k = 0; k < count; k++)
            boxes->pins[stands[k].port] = place_of_way(box, stands[k].way);
    }
    mem_free(stands);
}

Point black_boxes_pin(const BlackBoxes *boxes, int edge, Point at)
{
    const Point pin = boxes->pins[-1 - boxes->of.at[edge]];

    return (Point){at.x + pin.x, at.y + pin.y};
}

/* --- on paper --- */

/* inside, next to its pin */
static void draw_port(const BlackBox *box, const char *name, Point at, Point pin, Picture *out)
{
    const Ink ink = {.stroke = "#222222", .fill = "#222222", .width = 1};
    Point text = {at.x + pin.x, at.y + pin.y + 4};
    Anchor anchor = ANCHOR_MIDDLE;

    picture_circle(out, ink, (Point){at.x + pin.x, at.y + pin.y}, 3);
    if (fabs(pin.x) >= box->half.x) {
        anchor = pin.x > 0 ? ANCHOR_END : ANCHOR_START;
        text.x += pin.x > 0 ? -7 : 7;
    } else {
        text.y += pin.y > 0 ? -11 : 11;
    }
    picture_text(out, "#222222", text, PORT_TEXT, anchor, name);
}

void black_boxes_draw(const BlackBoxes *boxes, const View *view, int node, Point at, Picture *out)
{
    const BlackBox *box = &boxes->boxes.at[node - boxes->first];
    const Point half = box->half;
    const char *name = model_use(view->model, box->use)->name;

    picture_of(out, "instance", name);
    picture_area(out, (Ink){.stroke = "#222222", .fill = "#ffffff", .width = 3},
                 (Point[]){{at.x - half.x, at.y - half.y},
                           {at.x + half.x, at.y - half.y},
                           {at.x + half.x, at.y + half.y},
                           {at.x - half.x, at.y + half.y}},
                 4);
    picture_text(out, "#222222", (Point){at.x, at.y + 5}, NAME_TEXT, ANCHOR_MIDDLE, name);
    for (int p = 0; p < boxes->terminal->ports.count; p++)
        if (boxes->terminal->ports.at[p].use == box->use)
            draw_port(box, boxes->terminal->ports.at[p].name, at, boxes->pins[p], out);
}
