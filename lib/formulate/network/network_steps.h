/* network_steps.h: the derivation of an equation of a scalar domain, step by step */
#ifndef COTREE_FORMULATE_NETWORK_NETWORK_STEPS_H
#define COTREE_FORMULATE_NETWORK_NETWORK_STEPS_H

#include "formulate/system/system.h"

/* A step in deriving what an equation of a scalar domain needs: an edge, the law that determines
 * its across (or through) variable, and what the law needs of the graph. */
typedef struct NetworkStep {
    int edge;
    bool is_first;    /* the step whose law is the equation */
    bool is_across;   /* its variable is the across variable */
    bool is_rate;     /* a state of the part's own: left' = right */
    bool is_unknown;  /* nothing determines it: it remains in the equation */
    Expr left, right; /* its law over the user's variables; NULL: none */
    /* its variable follows from the graph: from a circuit if is_across, otherwise from a cutset */
    bool is_summed;
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
/* of the equation with that number in system_network_equation() */
void system_network_steps(System *view, int equation, NetworkSteps *out);
void network_steps_free(NetworkSteps *steps);

#endif
