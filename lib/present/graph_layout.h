/* graph_layout.h: places on paper for nodes of a graph */
#ifndef COTREE_PRESENT_GRAPH_LAYOUT_H
#define COTREE_PRESENT_GRAPH_LAYOUT_H

#include "base/call_monitor.h"
#include "graph/graph.h"
#include "present/picture.h"

enum { LAYOUT_MOST = 1500 }; /* nodes: more would be no picture */

/* Positions, px, of `nodes`, in an array with one entry for each node of the graph; distances are
 * about proportional to the lengths of paths. `size` holds all of them. Fails with E_STOPPED, and
 * with E_VALUE beyond LAYOUT_MOST. O(nodes^2). */
MUST_USE Status graph_layout(const Graph *graph, const int *nodes, int count,
                             const CallMonitor *watch, Point *places, Point *size, Diag *diag);

#endif
