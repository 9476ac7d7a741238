/* dynamics.h: masses, and what else M and F are made of */
#ifndef COTREE_FORMULATE_SYSTEM_DYNAMICS_H
#define COTREE_FORMULATE_SYSTEM_DYNAMICS_H

#include "base/memory.h"
#include "formulate/system/system.h"
#include "formulate/system/vector.h"

/* a mass at a node */
typedef struct Mass {
    int instance;
    int node;
    Expr mass;
    Rotation inertia; /* zero-position axes of the node's chain */
    bool has_inertia;
} Mass;

struct Elastic;
struct CompositeMass;

typedef struct Dynamics {
    LIST(Mass) masses;
    LIST(struct Elastic) elastics;
    bool writes_out;    /* false: entries of M and F are too long, and are shown as definitions */
    LIST(Entry) shares; /* of parts in M, beside what the masses make it */
    bool has_inertial_laws; /* some hold u': what is linear in it is among the shares */
    Expr *pushes;           /* in F, of parts on coordinates, one a speed */
    struct CompositeMass *composite_mass; /* NULL: M is run as it is written */
} Dynamics;

#endif
