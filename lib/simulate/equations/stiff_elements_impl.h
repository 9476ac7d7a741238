/* stiff_elements_impl.h: declarations shared by the files of StiffElements */
#ifndef COTREE_SIMULATE_EQUATIONS_STIFF_ELEMENTS_IMPL_H
#define COTREE_SIMULATE_EQUATIONS_STIFF_ELEMENTS_IMPL_H

#include "algebra/sparse.h"
#include "base/memory.h"
#include "simulate/equations/stiff_elements.h"

typedef LIST(Expr) StiffElementRoots;

typedef struct StiffElement {
    Expr call;
    Expr argument;
    Op op; /* OP_HOLD stands for a power */
    double exponent;
    bool is_bent; /* the argument is nonlinear in variables */
    int inputs;   /* indices of n, s and a0 in the variable index */
} StiffElement;

typedef struct Source {
    Expr function;
    int input;
    double size;        /* its range in a run, s; 0: not known */
    bool is_continuous; /* its derivative bounds its range */
    int corner;         /* of `corners`: the first that varies where that derivative jumps, */
    int corners;        /* and their number */
} Source;

struct StiffElements {
    const VariableIndex *l;
    Parameters *parameters;
    Motion *motion;
    const Equations *eq;
    LIST(StiffElement) elements;
    LIST(Source) sources;
    Ranges *values, *slopes, *bends;
    Ranges *corners;      /* one isn't constant where a derivative jumps */
    Range *closer;        /* tighter ones, of sources */
    Range *bent;          /* second derivatives, then corners */
    double *reach;        /* likewise: largest distance of each from the middle of an interval */
    VariableIndex inputs; /* the variable index, extended by inputs of elements and sources */
    Probe *probe;         /* computes G, F, gamma, arguments, A; NULL: not made yet */
    bool has_failed;
    int force, gamma, argument, matrix, root_count; /* first roots of the blocks; number of roots */
    Sparse *network;
    double *here;                   /* roots at the point */
    double *w, *moved, *answer, *y; /* w at the point; w perturbed, change of w, y perturbed */
    double t;
};

/* Number of corners of e. Adds to `corners`, unless that is NULL, expressions that aren't constant
 * where e jumps and are constant elsewhere. */
int stiff_elements_add_corners(StiffElementRoots *corners, Expr e);
/* Make the evaluation of ranges of all sources, once these are known. */
void stiff_elements_find_ranges(StiffElements *s);

#endif
