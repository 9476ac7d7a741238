/* loads.h: forces of one pass over the trees, and their sums inward */
#ifndef COTREE_FORMULATE_DYNAMICS_LOADS_H
#define COTREE_FORMULATE_DYNAMICS_LOADS_H

#include "formulate/system/system.h"
#include "formulate/system/vector.h"

/* forces of one pass over the trees: at nodes, in the axes of resolve(orientation class of the
 * node) */
typedef struct Loads {
    Vec *force;  /* one for each node */
    Vec *torque; /* one for each node */
    Expr *own;   /* one for each speed: loads on shapes, which have no frame */
    /* one for each instance: torques on screws that are chords; NULL: there are none */
    Expr *tied;
} Loads;

/* loads beyond each node: sums of Loads inward */
typedef struct Sums {
    Vec *force;  /* of everything beyond in the translation tree, one for each node */
    Vec *torque; /* of everything beyond in the rotation tree, moment arms included */
    const Expr *own, *tied;
} Sums;

/* what the sums are for */
typedef enum SumsFor {
    SUMS_FOR_SPEEDS, /* at nodes that no speed moves they are 0 */
    SUMS_FOR_JOINTS  /* also where no speed moves the node */
} SumsFor;

/* sums inward over both trees of the loads on nodes; new arrays in the system's pool */
Sums *loads_sum(const System *system, const Loads *loads, SumsFor whom);
Loads loads_new(const System *system);
/* m (g - a) and -(I alpha + w x I w) of every mass, and of flexible parts, with u' or (NULL)
 * without */
void loads_add_inertia(const System *system, Loads *loads, const Vec *alpha, const Vec *a,
                       const Expr *accelerations);
struct Mass;
/* the same of one mass, with u' */
void loads_add_mass(const System *system, Loads *loads, const struct Mass *mass, const Vec *alpha,
                    const Vec *a);
void loads_add_force(const System *system, Loads *loads, int node, Vec force, int chain);
void loads_add_torque(const System *system, Loads *loads, int node, Vec torque, int chain);
/* Adds a force and a torque on a part's head, in the axes of its tail's chain, and both reversed on
 * its tail, the force at the head's origin. */
void loads_add_between(System *system, Loads *loads, const Instance *owner, Vec force, Vec torque);
/* Adds a force along an axis of a part's tail, on its head, and reversed on its tail at that point.
 */
void loads_add_shift(System *system, Loads *loads, const Instance *owner, const Step *shift,
                     Expr effort);
/* Adds a force or torque `effort` along a coordinate of an instance: on its head, and reversed on
 * its tail. Along the coordinate of a screw that is a chord, it is the force on the shift that does
 * the same work. The motion rows do the same, as the shift determines the coordinate there. The two
 * differ by what the screw's tie carries, and loads->tied has the torque (chord_reaction()). */
void loads_add_effort(System *system, Loads *loads, const Instance *owner, int coordinate,
                      Expr effort);

#endif
