/* bushings.h: loads of parts that resist every motion of one frame against another
 *
 * Their coordinates x are those of the head in axes of the tail: its position (m), and its rotation
 * vector phi (rad); in a planar scene x, y and the angle. */
#ifndef COTREE_FORMULATE_DYNAMICS_BUSHINGS_H
#define COTREE_FORMULATE_DYNAMICS_BUSHINGS_H

#include "formulate/dynamics/loads.h"

typedef struct BushingLoad {
    int count; /* of coordinates: 6, or 3 in a planar scene; each with its */
    Expr x[MOST_RELATIVE], rate[MOST_RELATIVE], effort[MOST_RELATIVE];
    /* on the head, at its origin, in axes of the tail's frame, and the motions along which they
     * act: the rate of its position, and its angular velocity against the tail */
    Vec force, torque, motion, turning;
    Expr stored; /* energy (J), */
    Expr power;  /* and what dampers do (W): never positive */
} BushingLoad;

/* of a part whose row has `restore` */
MUST_USE Status bushing_of(System *system, const Instance *part, BushingLoad *out, Diag *diag);
/* the load on its two frames */
MUST_USE Status bushing_add(System *system, const Instance *part, Loads *loads, Diag *diag);
/* a member: Fx .. Tz in axes of the tail, fx .. tz in ground axes */
MUST_USE Status bushing_variable(System *system, const Instance *part, const char *member,
                                 Expr *out, Diag *diag);

#endif
