/* composite.h: all that is beyond a node, as one rigid body */
#ifndef COTREE_FORMULATE_DYNAMICS_COMPOSITE_H
#define COTREE_FORMULATE_DYNAMICS_COMPOSITE_H

#include "formulate/dynamics/loads.h"

typedef struct Composite { /* about the node's origin, in its axes */
    Expr mass;
    Vec moment;
    Rotation inertia;
} Composite;

/* one for every node, in the system's pool */
typedef struct Composites {
    Composite *at; /* read by composite_at() */
    /* identity of the composite (identity.h); NULL: no composite, or unknown identity */
    Expr *key;
    bool *is_known; /* it was recalled, or derived from its parts */
} Composites;

/* Nodes that have a place (NULL: none has) pass nothing on: the nodes inward of them omit what is
 * beyond. */
Composites composites_new(const System *system, const int *place);
Composite composite_at(const System *system, const Composites *all, int node);
/* one unit of the speed moves everything beyond its branch as one rigid body */
bool speed_moves_as_one(const System *system, int speed);
/* the same where both trees reach every node by the same edge; O(1) */
bool speed_shift_is_fixed(const System *system, int speed);
/* the loads of the composite on its branch, per unit of u', with everything else at rest */
void composite_loads(const System *system, Composite composite, int speed, Loads *loads);

#endif
