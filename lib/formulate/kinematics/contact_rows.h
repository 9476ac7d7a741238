/* contact_rows.h: rows of motion between two frames at a point: wheels, blades */
#ifndef COTREE_FORMULATE_KINEMATICS_CONTACT_ROWS_H
#define COTREE_FORMULATE_KINEMATICS_CONTACT_ROWS_H

#include "formulate/system/constraints.h"

/* The part's rows and its point of contact, over q, in axes of the tail's frame. */
void contact_of(System *system, const Instance *part, Contact *out);
/* Adds the part's rows: phi, rate, n and point of each. E_MODEL: its frames are fixed to each
 * other. */
MUST_USE Status contact_rows_push(System *system, const Instance *part, Diag *diag);
/* the point of contact in ground axes */
Vec contact_point(System *system, const Instance *part);

#endif
