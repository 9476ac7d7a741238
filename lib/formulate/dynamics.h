/* dynamics.h: masses, and the equations of motion in both readings */
#ifndef COTREE_FORMULATE_DYNAMICS_H
#define COTREE_FORMULATE_DYNAMICS_H

#include "base/memory.h"
#include "formulate/system.h"
#include "formulate/vector.h"

/* a mass at a node */
typedef struct Mass {
    int instance;
    int node;
    Expr mass;
    Rotation inertia; /* zero-position axes of the node's chain */
    bool has_inertia;
} Mass;

typedef struct Dynamics {
    LIST(Mass) masses;
    bool writes_out; /* false: entries of M and F are too long, and are shown as definitions */
} Dynamics;

void dynamics_free(Dynamics *dynamics); /* NULL is fine */
MUST_USE Status dynamics_build(System *system, Diag *diag);
/* which form a run takes: the recursive, or the expanded where that is shorter (reading.c) */
MUST_USE Status reading_choose(System *system, Diag *diag);

#endif
