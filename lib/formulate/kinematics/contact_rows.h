/* contact_rows.h: rows of motion between two frames at a point: wheels, blades */
#ifndef COTREE_FORMULATE_KINEMATICS_CONTACT_ROWS_H
#define COTREE_FORMULATE_KINEMATICS_CONTACT_ROWS_H

#include "formulate/system/constraints.h"

/* how far the head of a part between two frames is from its tail */
void frames_apart(System *system, const Instance *part, FramesApart *out);
/* The rate of FramesApart.way, and the angular velocity of the head against the tail, in axes of
 * the tail's frame. Fails as system_rate_of(). */
MUST_USE Status frames_rate(System *system, const Instance *part, Vec *rate, Vec *turn_rate,
                            Diag *diag);
/* The part's rows and its point of contact, over q, in axes of the tail's frame. */
void contact_of(System *system, const Instance *part, Contact *out);
/* Of a point, rho in ground axes from the head's origin, its velocity against the tail's (m/s), in
 * ground axes. E_MODEL: the part's frames are fixed to each other. */
MUST_USE Status contact_slip(System *system, const Instance *part, Vec point, Vec *out, Diag *diag);
/* Adds the part's rows: phi, rate, n and point of each. E_MODEL: its frames are fixed to each
 * other. */
MUST_USE Status contact_rows_push(System *system, const Instance *part, Diag *diag);
/* the point of contact in ground axes */
Vec contact_point(System *system, const Instance *part);

#endif
