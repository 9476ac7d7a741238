/* graph_layout.c: stress majorization (Gansner, Koren, North 2004)
 *
 * Minimises sum w_ij (|p_i - p_j| - d_ij)^2 over pairs of nodes, where d_ij is the length of the
 * shortest path between them and w_ij = 1/d_ij^2. Each sweep moves each node to the weighted mean
 * of the positions that its pairs, one by one, would give it. */
#include "present/graph_layout.h"

#include <math.h>

#define EDGE_LENGTH 105.0 /* px */
#define BORDER      56.0  /* px: around the nodes, for names */

typedef struct GraphLayout {
    const Graph *graph;
    const int *nodes;
    int count;
    int *number;   /* of a node among `nodes`; -1 */
    double *apart; /* count x count: edges between them */
    Point *at;
} GraphLayout;

/* Initial positions: depth first around a circle, so that the nodes aren't all on one line. */
static void begin_on_circle(GraphLayout *layout)
{
    const double radius = EDGE_LENGTH * layout->count / (2 * M_PI);

    for (int i = 0; i < layout->count; i++) {
        const double angle = 2 * M_PI * i / layout->count;

        layout->at[i].x = radius * sin(angle);
        layout->at[i].y = -radius * cos(angle);
    }
}

/* edges from one node to all others, breadth first */
static void find_distances(GraphLayout *layout, int from, int *queue)
{
    double *row = layout->apart + (size_t)from * (size_t)layout->count;
    int first = 0, last = 0;

    for (int i = 0; i < layout->count; i++)
        row[i] = -1;
    row[from] = 0;
    queue[last++] = from;
    while (first < last) {
        const int i = queue[first++], *edges;
        const int count = graph_edges_at(layout->graph, layout->nodes[i], &edges);

        for (int k = 0; k < count; k++) {
            const Edge *edge = graph_edge(layout->graph, edges[k]);
            const int other =
                layout->number[edge->tail == layout->nodes[i] ? edge->head : edge->tail];

            if (other >= 0 && row[other] < 0) {
                row[other] = row[i] + 1;
                queue[last++] = other;
            }
        }
    }
}

/* distance between unconnected parts: the largest within a connected one */
static void part_pieces(GraphLayout *layout)
{
    const int pairs = layout->count * layout->count;
    double most = 1;

    for (int i = 0; i < pairs; i++)
        most = fmax(most, layout->apart[i]);
    for (int i = 0; i < pairs; i++)
        if (layout->apart[i] < 0)
            layout->apart[i] = most;
}

static void sweep(GraphLayout *layout)
{
    for (int i = 0; i < layout->count; i++) {
        Point sum = {0, 0};
        double weight = 0;

        for (int j = 0; j < layout->count; j++) {
            const double d =
                layout->apart[(size_t)i * (size_t)layout->count + (size_t)j] * EDGE_LENGTH;
            const double dx = layout->at[i].x - layout->at[j].x;
            const double dy = layout->at[i].y - layout->at[j].y;
            const double length = fmax(hypot(dx, dy), 1e-3);

            if (!(d > 0))
                continue;
            sum.x += (layout->at[j].x + d * dx / length) / (d * d);
            sum.y += (layout->at[j].y + d * dy / length) / (d * d);
            weight += 1 / (d * d);
        }
        if (weight > 0)
            layout->at[i] = (Point){sum.x / weight, sum.y / weight};
    }
}

/* how much longer edges are where many meet at few nodes, or are parallel: their names need room */
static double stretch(const GraphLayout *layout)
{
    static const double AT_EASE = 1.4, MOST = 1.8; /* edges a node; of the length */
    int edges = 0;

    for (int i = 0; i < layout->count; i++) {
        const int *at;
        const int count = graph_edges_at(layout->graph, layout->nodes[i], &at);

        for (int k = 0; k < count; k++)
            edges += layout->number[graph_edge(layout->graph, at[k])->tail] == i;
    }
    return fmax(1, fmin(MOST, edges / (AT_EASE * layout->count)));
}

/* into the corner of the sheet */
static Point settle(GraphLayout *layout)
{
    const double longer = stretch(layout);
    Point low = {INFINITY, INFINITY}, high = {-INFINITY, -INFINITY};

    for (int i = 0; i < layout->count; i++) {
        layout->at[i] = (Point){longer * layout->at[i].x, longer * layout->at[i].y};
        low = (Point){fmin(low.x, layout->at[i].x), fmin(low.y, layout->at[i].y)};
        high = (Point){fmax(high.x, layout->at[i].x), fmax(high.y, layout->at[i].y)};
    }
    for (int i = 0; i < layout->count; i++) {
        layout->at[i].x += BORDER - low.x;
        layout->at[i].y += BORDER - low.y;
    }
    return (Point){high.x - low.x + 2 * BORDER, high.y - low.y + 2 * BORDER};
}

Status graph_layout(const Graph *graph, const int *nodes, int count, const CallMonitor *watch,
                    Point *places, Point *size, Diag *diag)
{
    enum { MOST_SWEEPS = 300, LEAST_SWEEPS = 20 };
    static const double WORK = 3e7; /* pairs in all sweeps: some tenths of a second */
    GraphLayout layout = {.graph = graph, .nodes = nodes, .count = count};
    const int all = graph_node_count(graph);
    int *queue = NULL;
    Status status = OK;

    if (layout.count > LAYOUT_MOST) {
        (void)diag_set(diag, E_VALUE, "a graph of %d nodes makes no picture", layout.count);
        diag_hint(diag, "draw it as text, or write it as dot and let Graphviz try");
        return E_VALUE;
    }
    layout.number = NEW_ARRAY(int, all);
    layout.apart = mem_array((size_t)layout.count * (size_t)layout.count, sizeof *layout.apart);
    layout.at = NEW_ARRAY(Point, layout.count);
    queue = NEW_ARRAY(int, layout.count);
    for (int n = 0; n < all; n++)
        layout.number[n] = -1;
    for (int i = 0; i < layout.count; i++)
        layout.number[layout.nodes[i]] = i;
    begin_on_circle(&layout);
    for (int i = 0; i < layout.count; i++)
        find_distances(&layout, i, queue);
    part_pieces(&layout);

    const double pairs = (double)layout.count * layout.count;
    const int sweeps = (int)fmax(LEAST_SWEEPS, fmin(MOST_SWEEPS, WORK / pairs));

    for (int i = 0; i < sweeps; i++) {
        CHECK(monitor_poll(watch));
        monitor_report(watch, "laying out", (double)i / sweeps);
        sweep(&layout);
    }
    *size = settle(&layout);
    for (int i = 0; i < layout.count; i++)
        places[layout.nodes[i]] = layout.at[i];
done:
    MEM_FREE(layout.number, layout.apart, layout.at, queue);
    return status;
}
