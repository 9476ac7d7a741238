/* graph_layout.h: places on paper for nodes of a graph */
#ifndef COTREE_PRESENT_GRAPH_LAYOUT_H
#define COTREE_PRESENT_GRAPH_LAYOUT_H

#include "base/call_monitor.h"
#include "graph/graph.h"
#include "present/picture.h"

enum { LAYOUT_MOST = 1500 }; /* nodes: more would be no picture */

/* Places, px, of `nodes` in an array of one a node of the graph: as far apart as the graph's
 * paths are long. `size` holds all of them. Fails with E_STOPPED, and with E_VALUE beyond
 * LAYOUT_MOST. O(nodes^2). */
MUST_USE Status graph_layout(const Graph *graph, const int *nodes, int count,
                             const CallMonitor *watch, Point *places, Point *size, Diag *diag);

#endif
