/* dynamics.h: masses, and the equations of motion in both readings */
#ifndef COTREE_FORMULATE_DYNAMICS_H
#define COTREE_FORMULATE_DYNAMICS_H

#include "base/memory.h"
#include "formulate/composite_mass.h"
#include "formulate/shapes.h"
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
    LIST(Elastic) elastics;
    bool writes_out;    /* false: entries of M and F are too long, and are shown as definitions */
    LIST(Entry) shares; /* of parts in M, beside what the masses make it */
    Expr *pushes;       /* in F, of parts on coordinates, one a speed */
    CompositeMass *composite_mass; /* NULL: M is run as it is written */
} Dynamics;

void dynamics_free(Dynamics *dynamics); /* NULL is fine */
MUST_USE Status dynamics_build(System *system, Diag *diag);
/* which form a run takes: the recursive, or the expanded where that is shorter (reading.c) */
MUST_USE Status reading_choose(System *system, Diag *diag);

/* composite_mass.c; true: it has been made, and M needn't be */
bool composite_mass_build(System *system);
void composite_mass_free(CompositeMass *mass);             /* NULL is fine */
OpCount composite_mass_passing(const CompositeMass *mass); /* of one evaluation, beside its needs */

#endif
