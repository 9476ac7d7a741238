/* composite.h: what hangs beyond a node, taken together as one rigid body */
#ifndef COTREE_FORMULATE_DYNAMICS_COMPOSITE_H
#define COTREE_FORMULATE_DYNAMICS_COMPOSITE_H

#include "formulate/dynamics/loads.h"

typedef struct Composite { /* about the node's origin, in its axes */
    Expr mass;
    Vec moment;
    Rotation inertia;
} Composite;

/* of every node, in the system's pool */
typedef struct Composites {
    Composite *at;  /* to be read by composite_at() */
    Expr *key;      /* what hangs there, as identity.h tells it; NULL: nothing, or it isn't told */
    bool *is_known; /* it is recalled, or derived of its parts */
} Composites;

/* Of nodes that have a place (NULL: none has) nothing is handed on, those behind them stay without
 * what hangs beyond. */
Composites composites_new(const System *system, const int *place);
Composite composite_at(const System *system, const Composites *all, int node);
/* one unit of the speed moves everything beyond its branch as one rigid body */
bool speed_moves_as_one(const System *system, int speed);
/* what its branch feels of the composite beyond, per unit of u'; all else at rest */
void composite_loads(const System *system, Composite composite, int speed, Loads *loads);

#endif
