/* operating.h: where a network alone rests
 *
 *     G([0; z], x) = 0    for v = (x, z)
 *
 * KINSOL's Newton method with line search on a sparse Jacobian; where it fails sources grow from
 * nothing, and then a conductance beside every part whose current is an expression of voltages
 * shrinks to nothing, each in steps as long as Newton's method follows. */
#ifndef COTREE_SIMULATE_OPERATING_H
#define COTREE_SIMULATE_OPERATING_H

#include "simulate/netdae.h"

/* what the parameters' callback hands out while the search goes on */
typedef struct Knobs {
    double load; /* share of the sources that is on */
    double leak; /* S, beside nonlinear parts */
} Knobs;

typedef struct Operating {
    const Layout *l;
    Parameters *parameters; /* asked anew whenever a knob is turned */
    Knobs *knobs;
    const Watch *watch;
    double *v;    /* nx + nz: where the search begins, and what it found */
    int singular; /* a place in v that no equation determines; -1: none known */
} Operating;

/* *found tells whether. E_STOPPED, and the errors of compilation. */
MUST_USE Status operating_find(Operating *operating, bool *found, Diag *diag);

#endif
