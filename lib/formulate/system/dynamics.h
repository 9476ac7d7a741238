/* dynamics.h: masses, and the other terms of M and F */
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
    Rotation inertia; /* zero-position axes of the node's orientation class */
    bool has_inertia;
} Mass;

struct Elastic;
struct CompositeMass;

typedef struct Dynamics {
    LIST(Mass) masses;
    LIST(struct Elastic) elastics;
    bool writes_out;    /* false: entries of M and F are too long, and are shown by definitions */
    LIST(Entry) shares; /* of parts in M, in addition to the masses */
    bool has_inertial_laws; /* some contain u': the shares include their linear part */
    Expr *pushes;           /* in F, of parts on coordinates, one for each speed */
    struct CompositeMass *composite_mass; /* NULL: M is evaluated as an expression */
} Dynamics;

#endif
