/* network.h: equations of the scalar domains: edges, unknowns and the rows that belong to them */
#ifndef COTREE_FORMULATE_NETWORK_H
#define COTREE_FORMULATE_NETWORK_H

#include "base/memory.h"
#include "component/component.h"
#include "formulate/system.h"

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
    bool is_steep;    /* a chord whose v is the unknown, i following from it */
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
    Expr residual;    /* what a run solves instead of left - right; NULL: that */
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
} Network;

void network_free(Network *network); /* NULL is fine */

MUST_USE Status network_build(System *system, Diag *diag);
/* in state form in the place of the user's tree (network_tree.c) */
MUST_USE Status network_normal_tree(System *system, TreeKind kind, Diag *diag);
/* residuals and their Jacobian, once dynamics is there (network_rows.c) */
MUST_USE Status network_rows(System *system, Diag *diag);
/* the equation of an unknown, left = right */
MUST_USE Status network_row(System *system, int unknown, Diag *diag);
const Instance *branch_owner(const System *system, const Branchlike *branch);
Branchlike *scalar_branch(System *system, const Instance *instance, int which);
/* its member names: "i", or of an edge with a suffix "s.i" */
const char *branch_member(const System *system, const Branchlike *branch, bool through);
TreeKind branch_tree(const System *system, const Branchlike *branch);
/* the number of a new unknown, whose symbol is of that name and kind */
int network_new_unknown(System *system, Unknown unknown, const char *name, SymbolKind kind);
/* one rate more of an unknown, as a symbol */
Expr network_add_rate(System *system, int unknown, SymbolKind kind);
/* one whose equation is the relation of that edge, without symbol yet */
Unknown network_unknown_of_branch(const System *system, const Branchlike *branch);
/* `symbol` is the rate of that order of an unknown */
void network_know(System *system, Expr symbol, int unknown, int order);
/* the unknowns as states x and algebraic z of the System: new ones behind the old */
void network_list(System *system);
/* in the form of the user's tree: which rates are states, which is solved for (network_order.c) */
MUST_USE Status network_bring_order(System *system, Diag *diag);
/* what an expression is where all its symbols have values that the seed chooses, 0.7 to 1.3 */
double expr_value_somewhere(Expr e, uint32_t seed);
/* Where sums are long and nobody reads them: v of a chord whose path has so many branches, i of a
 * branch, by what stands at nodes (network_nodes.c), where it doesn't follow from its rate. False:
 * they stay sums. */
bool network_nodes_across(System *system, const Branchlike *chord, int path, Expr *out);
bool network_nodes_through(System *system, Branchlike *branch, Expr *out);
/* what else meets at the far node of a branch: its i */
MUST_USE Status network_nodes_balance(System *system, const Branchlike *branch, Expr *out,
                                      Diag *diag);
/* the potential of a node of that tree, an unknown with its equation */
Expr network_nodes_potential(System *system, const Tree *tree, int node);
/* the equation of such an unknown, left = right */
MUST_USE Status network_nodes_row(System *system, Unknown *y, Diag *diag);
/* content' + rest: i of what stores v, v of what stores i */
MUST_USE Status network_stored_rate(System *system, const Branchlike *branch, Expr *out,
                                    Diag *diag);
/* v of a chord along its circuit */
MUST_USE Status circuit_across(System *system, Branchlike *branch, Expr *out, Diag *diag);
/* A potential, or a rate of one, that the equations need of a terminal on which nothing stands. */
Expr network_open(System *system, const char *name);
bool network_is_open(const System *system, Expr symbol);
/* names of the edges in the circuit of a chord or the cutset of a branch; in the pool */
const char *network_company(const System *system, const Branchlike *branch);
/* Whether an edge of a port gives its own variable (v of a branch, i of a chord) by the other edge;
 * where it doesn't its equation is the other of the two. */
bool port_gives_own(System *system, const Branchlike *branch);
/* voltage and current of a scalar edge */
MUST_USE Status network_across(System *system, Branchlike *branch, Expr *out, Diag *diag);
MUST_USE Status network_through(System *system, Branchlike *branch, Expr *out, Diag *diag);

#endif
