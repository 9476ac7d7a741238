/* stiff_elements_impl.h: what the files of Steep share */
#ifndef COTREE_SIMULATE_EQUATIONS_STIFF_ELEMENTS_IMPL_H
#define COTREE_SIMULATE_EQUATIONS_STIFF_ELEMENTS_IMPL_H

#include "algebra/sparse.h"
#include "base/memory.h"
#include "simulate/equations/stiff_elements.h"

typedef LIST(Expr) StiffElementRoots;

typedef struct StiffElement {
    Expr call;
    Expr argument;
    Op op; /* OP_HOLD: a power */
    double exponent;
    bool is_bent; /* the argument isn't affine in variables */
    int inputs;   /* places of n, s and a0 in the layout */
} StiffElement;

typedef struct Source {
    Expr function;
    int input;
    double size;        /* its range in a run, s; 0: not known */
    bool is_continuous; /* its derivative tells how far it goes */
    int corner;         /* what makes that derivative jump: the first of `corners`, */
    int corners;        /* and how many */
} Source;

struct StiffElements {
    const VariableIndex *l;
    Parameters *parameters;
    Motion *motion;
    const Equations *eq;
    LIST(StiffElement) elements;
    LIST(Source) sources;
    Ranges *values, *slopes, *bends;
    Ranges *corners;      /* one varies where a derivative jumps */
    Range *closer;        /* of sources */
    Range *bent;          /* likewise, corners with them */
    double *reach;        /* likewise: how far each gets from the middle of an interval */
    VariableIndex inputs; /* the layout, and the inputs of elements and sources */
    Probe *probe;         /* G, F, gamma, arguments, A; NULL: not made yet */
    bool has_failed;
    int force, gamma, argument, matrix, root_count; /* places of the roots, and how many */
    Sparse *network;
    double *here;                   /* roots at the point */
    double *w, *moved, *answer, *y; /* w there; w moved, change of w, y moved */
    double t;
};

/* how many things make e jump; added to `corners`, unless that is NULL: what varies where they do,
 * and is constant elsewhere */
int stiff_elements_add_corners(StiffElementRoots *corners, Expr e);
/* what tells the ranges of all sources, once these are known */
void stiff_elements_find_ranges(StiffElements *s);

#endif
