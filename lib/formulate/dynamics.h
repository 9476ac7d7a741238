/* dynamics.h: masses, and forces of one pass over the trees */
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

/* forces of one pass over the trees: at nodes, in the axes of resolve(chain of the node) */
typedef struct Loads {
    Vec *force;  /* one a node */
    Vec *torque; /* one a node */
} Loads;

/* what hangs beyond each node: sums of Loads inward */
typedef struct Sums {
    Vec *force;  /* of everything beyond in the translation tree, a node each */
    Vec *torque; /* of everything beyond in the rotation tree, arms included */
} Sums;

typedef struct Dynamics {
    LIST(Mass) masses;
} Dynamics;

void dynamics_free(Dynamics *dynamics); /* NULL is fine */
MUST_USE Status dynamics_build(System *system, Diag *diag);

/* --- loads (recursive.c) --- */

/* sums inward over both trees of what acts on nodes; new arrays in the system's pool */
Sums *loads_sum(System *system, const Loads *loads);
Loads loads_new(System *system);
/* m (g - a) and -(I alpha + w x I w) of every mass */
void loads_add_inertia(System *system, Loads *loads, const Vec *alpha, const Vec *a);
void loads_add_force(System *system, Loads *loads, int node, Vec force, int chain);
void loads_add_torque(System *system, Loads *loads, int node, Vec torque, int chain);
/* a force or torque `effort` along a coordinate of an instance, on its head and reversed on its
 * tail */
void loads_add_effort(System *system, Loads *loads, const Instance *owner, int coordinate,
                      Expr effort);

/* --- what hangs beyond a node, taken together (composite.c) --- */

typedef struct Composite { /* about the node's origin, in its axes */
    Expr mass;
    Vec moment;
    Rotation inertia;
} Composite;

/* of every node, in the system's pool */
Composite *composites_new(System *system);
/* one unit of the speed moves everything beyond its branch as one rigid body */
bool speed_moves_as_one(const System *system, int speed);
/* what its branch feels of the composite beyond, per unit of u'; all else at rest */
void composite_loads(System *system, const Composite *composite, int speed, Loads *loads);

/* --- efforts (efforts.c): springs, motors, forces --- */

typedef struct Effort {
    const Instance *instance;
    Expr displacement, rate, value; /* along the line or the joint's coordinate */
    Vec direction;                  /* line: from tail to head, ground axes */
    bool is_line;
} Effort;

MUST_USE Status effort_of(System *system, const Instance *instance, Effort *out, Diag *diag);
/* what an effort adds to M in the column of a speed, per unit of its coordinate, and what is left
 * of it at u' = 0. E_MODEL where it isn't linear in u'. */
MUST_USE Status effort_inertia(System *system, const Effort *effort, int speed, Expr *out,
                               Diag *diag);
Expr effort_at_rest(System *system, const Effort *effort);
/* wrench of force and torque components: in axes of *chain */
MUST_USE Status wrench_of(System *system, const Instance *instance, Vec *force, Vec *torque,
                          int *chain, Diag *diag);
/* everything that pushes, without inertia and multipliers: springs on joints left out unless
 * `joints` */
MUST_USE Status efforts_add(System *system, Loads *loads, bool joints, Diag *diag);

#endif
