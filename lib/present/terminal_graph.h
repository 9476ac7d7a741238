/* terminal_graph.h: the linear graph with each instance of a subsystem as the edges of its ports
 *
 * The inside of an instance is omitted; a port is an edge, named leg1.B, to the node where it
 * attaches. If the inside determines its motion or voltage, it is a branch wherever the path to it
 * leads through the inside, from the node where that path enters. Any other port is a chord from
 * the datum. */
#ifndef COTREE_PRESENT_TERMINAL_GRAPH_H
#define COTREE_PRESENT_TERMINAL_GRAPH_H

#include "graph/tree.h"
#include "model/model.h"

typedef struct TerminalPort {
    int use, node;    /* of the new graph; a datum too */
    const char *name; /* "B"; the model's */
    bool gives;       /* the inside determines its motion or voltage, */
    bool takes;       /* from outside; of a frame the place can do one and the attitude the other */
} TerminalPort;

typedef struct TerminalGraph {
    Graph *graph;
    Tree *trees[TREE_KINDS]; /* NULL: no edge is of that kind */
    LIST(int) of;            /* by edge: the model's edge, or -1 - use of a port */
    LIST(TerminalPort) ports;
} TerminalGraph;

/* Fill what is zeroed; terminal_graph_free() in any case. Fails as model_trees() does. */
MUST_USE Status terminal_graph_make(const Model *model, TerminalGraph *out, Diag *diag);
void terminal_graph_free(TerminalGraph *terminal);

#endif
