/* network.h: equations of the scalar domains: edges, unknowns and their rows */
#ifndef COTREE_FORMULATE_SYSTEM_NETWORK_H
#define COTREE_FORMULATE_SYSTEM_NETWORK_H

#include "base/memory.h"
#include "component/component.h"
#include "formulate/system/system.h"

enum { NETWORK_ORDER = 8 }; /* the highest order of an equation */

typedef struct Branchlike { /* a scalar edge */
    int edge;
    int instance;
    int which;         /* number among the instance's scalar edges */
    Relation relation; /* over the user's variables */
    bool branch;
    int cutset;    /* of a branch: its row among its tree's cutsets */
    int unknown;   /* the unknown that its v or i is; -1 */
    bool busy;     /* its v or i is being followed */
    bool is_stiff; /* a chord whose v is the unknown and determines i */
    /* its i follows from its rate, and its equation is the balance of a node (network_nodes.c) */
    bool is_balanced;
    int ideal; /* its index in `ideals`; -1: it is no switch */
    /* of a switch between two resistances: 1 or 0, a number of the run; NULL: it is no such switch,
     * or both sides are in its equation */
    Expr closed;
    Expr v, i; /* NULL until known */
} Branchlike;

/* laws of a node, as equations of unknowns of their own (network_nodes.c) */
typedef enum NodeLaw { NODE_NONE, NODE_POTENTIAL, NODE_BALANCE } NodeLaw;

/* A network unknown and the equation that belongs to it: a state (with a rate), or algebraic. */
typedef struct Unknown {
    int branchlike; /* the edge whose v (branch) or i (chord) it is, with its relation; -1 */
    NodeLaw law;    /* kind of its equation, at the far node of the branch `towards` */
    int towards;    /* index of that branch in `branches` */
    int own;        /* the instance whose own state it is; -1 */
    int instance;
    int derives; /* its equation is the derivative of this unknown's; -1 */
    Expr symbol; /* y */
    Expr *rates; /* y', y'' ... as far as they occur; in the system's pool */
    int known;   /* number of these rates */
    int order;   /* of the highest rate that is no expression of others */
    bool has_row;
    Expr left, right; /* its equation */
    Expr lack;        /* left - right without named temporaries */
    Expr residual;    /* the run solves this instead; NULL: it solves `lack` */
} Unknown;

typedef struct NetworkEquation { /* as printed */
    Expr left, right;
    int edge; /* the edge whose relation it is */
} NetworkEquation;

typedef struct Network {
    LIST(Variable) x;
    LIST(Variable) z;
    LIST(Expr) rates;                /* of x, x' */
    SignMatrix *cutsets[TREE_KINDS]; /* of scalar trees */
    NetworkForm form;
    NetworkForm asked_form; /* the user's form, where that exists */
    bool has_no_states;     /* a state form needs ever more derivatives */
    /* S, in parallel to parts whose current is an expression of their voltage; NULL: none */
    Expr gmin;
    LIST(int) ideals;   /* branches that are switches, */
    const bool *closed; /* and the side of each ideal switch; NULL: both are in one equation */
    bool takes_sides;   /* the sides of switches between two resistances are numbers of the run, */
    bool takes_all;     /* and so are those of ideal switches */
    LIST(Branchlike) branches;
    int *scalar_of_edge; /* edge of the graph -> branches, or -1 */
    Expr *potentials;    /* of nodes that have an unknown, otherwise NULL; NULL: none has */
    LIST(Unknown) unknowns;
    int listed;           /* number of unknowns that are in x or z already */
    LIST(int) unknown_of; /* by expr_symbol_number(): the unknown, and which rate of it, */
    LIST(int) rate_of;    /* as 1 + unknown and 0, 1, ...; 0: neither */
    int follow_depth;     /* number of v and i being followed */
    bool leaves_trees;    /* the scalar trees in use aren't those of the user */
    bool is_open;         /* unknowns may still be added */
    bool met_loop;        /* following a chord led to a branch that is being followed itself */
    LIST(NetworkEquation) equations;
    LIST(OwnSample) samples;
    /* in the form of the user's tree: names of the states of state form */
    LIST(const char *) at_rest;
    LIST(Expr) invariants; /* expressions that are always 0: rows that were differentiated */
    LIST(Expr) open;       /* potentials needed at terminals to which nothing is connected */
    struct NetworkIsomorphism
        *alike; /* while it is built: rows that needn't be derived; NULL: none */
} Network;

#endif
