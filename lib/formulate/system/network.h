/* network.h: equations of the scalar domains: edges, unknowns and the rows that belong to them */
#ifndef COTREE_FORMULATE_SYSTEM_NETWORK_H
#define COTREE_FORMULATE_SYSTEM_NETWORK_H

#include "base/memory.h"
#include "component/component.h"
#include "formulate/system/system.h"

enum { NETWORK_ORDER = 8 }; /* the highest of an equation */

typedef struct Branchlike { /* a scalar edge */
    int edge;
    int instance;
    int which;         /* of the instance's scalar edges */
    Relation relation; /* over the user's variables */
    bool branch;
    int cutset;       /* of a branch: its row among its tree's cutsets */
    int unknown;      /* its v or i is one; -1 */
    bool busy;        /* its v or i is being followed */
    bool is_stiff;    /* a chord whose v is the unknown, i following from it */
    bool is_balanced; /* its i follows from its rate, its equation is a node's (network_nodes.c) */
    int ideal;        /* which of the switches it is; -1 */
    Expr closed; /* of one between two resistances: 1 or 0, a number of the run; NULL: it is none,
                    or both sides are in its equation */
    Expr v, i;   /* once known */
} Branchlike;

/* laws of a node, as equations of unknowns of their own (network_nodes.c) */
typedef enum NodeLaw { NODE_NONE, NODE_POTENTIAL, NODE_BALANCE } NodeLaw;

/* A network unknown and the equation that belongs to it: a state (with a rate), or algebraic. */
typedef struct Unknown {
    int branchlike; /* whose v (branch) or i (chord) it is, with its relation; -1 */
    NodeLaw law;    /* its equation, of the far node of the branch `towards` */
    int towards;    /* among the branches */
    int own;        /* a state of that instance's own; -1 */
    int instance;
    int derives; /* its equation is that of this unknown, differentiated; -1 */
    Expr symbol; /* y */
    Expr *rates; /* y', y'' ... as far as they are met; in the system's pool */
    int known;   /* how many */
    int order;   /* of the highest that is no expression of others */
    bool has_row;
    Expr left, right; /* its equation */
    Expr lack;        /* left - right without holds */
    Expr residual;    /* what a run solves instead; NULL: that */
} Unknown;

typedef struct NetworkEquation { /* as printed */
    Expr left, right;
    int edge; /* whose relation it is */
} NetworkEquation;

typedef struct Network {
    LIST(Variable) x;
    LIST(Variable) z;
    LIST(Expr) rates;                /* of x, x' */
    SignMatrix *cutsets[TREE_KINDS]; /* of scalar trees */
    NetworkForm form;
    NetworkForm asked_form; /* the same, where that exists */
    bool has_no_states;     /* a state form needs ever more derivatives */
    Expr gmin; /* S, beside parts whose current is an expression of their voltage; NULL: none */
    LIST(int) ideals;   /* branches that switch, */
    const bool *closed; /* and the side that each ideal one is on; NULL: both are in one equation */
    bool takes_sides;   /* those between two resistances: their sides are numbers of the run, */
    bool takes_all;     /* and those of ideal ones */
    LIST(Branchlike) branches;
    int *scalar_of_edge; /* edge of the graph -> branches, or -1 */
    Expr *potentials;    /* of nodes that have an unknown, else NULL; NULL: none has */
    LIST(Unknown) unknowns;
    int listed;           /* unknowns that stand in x or z already */
    LIST(int) unknown_of; /* by expr_symbol_number(): unknown, and which rate of it, */
    LIST(int) rate_of;    /* as 1 + unknown and 0, 1, ...; 0: neither */
    int follow_depth;     /* of v and i being followed */
    bool leaves_trees;    /* the scalar trees in use aren't those of the user */
    bool is_open;         /* unknowns may still be added */
    bool met_loop;        /* following a chord led to a branch that is being followed */
    LIST(NetworkEquation) equations;
    LIST(OwnSample) samples;
    LIST(const char *) at_rest; /* in the form of the user's tree: states of state form, by name */
    LIST(Expr) invariants;      /* 0 throughout: rows that were differentiated */
    LIST(Expr) open;            /* potentials asked for of terminals on which nothing stands */
    struct NetworkIsomorphism
        *alike; /* while it is made: rows that needn't be derived; NULL: none */
} Network;

#endif
