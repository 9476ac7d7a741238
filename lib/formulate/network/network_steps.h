/* network_steps.h: what an equation of a scalar domain was followed along */
#ifndef COTREE_FORMULATE_NETWORK_NETWORK_STEPS_H
#define COTREE_FORMULATE_NETWORK_NETWORK_STEPS_H

#include "formulate/system/system.h"

/* A step in following what an equation of a scalar domain needs: an edge, the law that tells its
 * across (or through) variable, and what the law needs of the graph. */
typedef struct NetworkStep {
    int edge;
    bool is_first;    /* whose law is the equation */
    bool is_across;   /* what is told of it */
    bool is_rate;     /* of a state of the part's own: left' = right */
    bool is_unknown;  /* nothing follows it: it stands in the equation */
    Expr left, right; /* its law over the user's variables; NULL: none */
    bool is_summed; /* what is told follows from the graph: a circuit where is_across, else a cutset
                     */
    int first, count; /* of NetworkSteps.signed_edges: minus the rest of the circuit or cutset */
} NetworkStep;
typedef struct SignedEdge {
    int edge;
    int sign;
} SignedEdge;
typedef struct NetworkSteps {
    LIST(NetworkStep) steps;
    LIST(SignedEdge) signed_edges;
} NetworkSteps;
/* of the equation that is numbered so by system_network_equation() */
void system_network_steps(System *view, int equation, NetworkSteps *out);
void network_steps_free(NetworkSteps *steps);

#endif
