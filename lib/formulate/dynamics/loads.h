/* loads.h: forces of one pass over the trees, and their sums inward */
#ifndef COTREE_FORMULATE_DYNAMICS_LOADS_H
#define COTREE_FORMULATE_DYNAMICS_LOADS_H

#include "formulate/system/system.h"
#include "formulate/system/vector.h"

/* forces of one pass over the trees: at nodes, in the axes of resolve(chain of the node) */
typedef struct Loads {
    Vec *force;  /* one a node */
    Vec *torque; /* one a node */
    Expr *own;   /* one a speed: on shapes, which no frame stands for */
    Expr *tied;  /* one an instance: torques on screws that are chords; NULL: there are none */
} Loads;

/* what hangs beyond each node: sums of Loads inward */
typedef struct Sums {
    Vec *force;  /* of everything beyond in the translation tree, a node each */
    Vec *torque; /* of everything beyond in the rotation tree, arms included */
    const Expr *own, *tied;
} Sums;

/* who asks for sums */
typedef enum SumsFor {
    SUMS_FOR_SPEEDS, /* at nodes that no speed moves they are none */
    SUMS_FOR_JOINTS  /* what holds them still, too */
} SumsFor;

/* sums inward over both trees of what acts on nodes; new arrays in the system's pool */
Sums *loads_sum(const System *system, const Loads *loads, SumsFor whom);
Loads loads_new(const System *system);
/* m (g - a) and -(I alpha + w x I w) of every mass, and what deforms, with u' or (NULL) without */
void loads_add_inertia(const System *system, Loads *loads, const Vec *alpha, const Vec *a,
                       const Expr *accelerations);
void loads_add_force(const System *system, Loads *loads, int node, Vec force, int chain);
void loads_add_torque(const System *system, Loads *loads, int node, Vec torque, int chain);
/* A force or torque `effort` along a coordinate of an instance, on its head and reversed on its
 * tail. Along that of a screw which is a chord it is the force on the shift that does the same
 * work, as in the rows of motion, where the shift tells the coordinate: the two differ by what the
 * tie carries, and loads->tied has the torque (chord_reaction()). */
void loads_add_effort(System *system, Loads *loads, const Instance *owner, int coordinate,
                      Expr effort);

#endif
