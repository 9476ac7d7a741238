/* black_boxes.h: instances of subsystems as boxes with their ports at the border, in the graph of
 * the other elements
 *
 * The picture shows one graph of all domains. Its nodes are those of the terminal graph and one for
 * each box; its edges are those outside and one from each box to each node to which a port
 * attaches. */
#ifndef COTREE_PRESENT_BLACK_BOXES_H
#define COTREE_PRESENT_BLACK_BOXES_H

#include "present/picture.h"
#include "present/view.h"

typedef struct BlackBox {
    int use;
    Point half; /* of its width and height, px */
    Point free; /* of the part of the border for ports, away from the corners */
} BlackBox;

typedef struct BlackBoxes {
    const TerminalGraph *terminal;
    Graph *graph;    /* nodes: the terminal graph's, then the boxes; knows one domain only */
    LIST(int) nodes; /* boxes, and the nodes that any edge meets */
    LIST(int) of;    /* by edge: the terminal graph's, or -1 - port */
    int first;       /* node of the first box */
    LIST(BlackBox) boxes;
    Point *pins; /* by port: where it is at the border, from the middle of its box */
} BlackBoxes;

/* The port of an edge of `graph`; NULL: an edge outside. */
const TerminalPort *black_boxes_port(const BlackBoxes *boxes, int edge);
Domain black_boxes_domain(const BlackBoxes *boxes, int edge);

/* Fills what is zeroed of a view with a terminal graph; black_boxes_free(). */
void black_boxes_make(const View *view, BlackBoxes *boxes);
void black_boxes_free(BlackBoxes *boxes);
/* Scale distances between places by one factor, until no box covers another or a node. */
void black_boxes_part(const BlackBoxes *boxes, Point *places, Point *size);
/* Ports are placed where the border faces their nodes, each with room for its name. `places` are
 * those of the nodes. */
void black_boxes_set_pins(BlackBoxes *boxes, const Point *places);
/* where an edge of a port leaves its box, whose middle is `at` */
Point black_boxes_pin(const BlackBoxes *boxes, int edge, Point at);
void black_boxes_draw(const BlackBoxes *boxes, const View *view, int node, Point at, Picture *out);

#endif
