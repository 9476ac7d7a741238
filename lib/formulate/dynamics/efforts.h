/* efforts.h: what springs, motors and forces exert */
#ifndef COTREE_FORMULATE_DYNAMICS_EFFORTS_H
#define COTREE_FORMULATE_DYNAMICS_EFFORTS_H

#include "formulate/dynamics/loads.h"
#include "formulate/system/constraints.h"

typedef struct Effort {
    const Instance *instance;
    Expr displacement, rate, value; /* along the line or the joint's coordinate */
    Vec direction;                  /* line: from tail to head, ground axes */
    bool is_line;
} Effort;

MUST_USE Status effort_of(System *system, const Instance *instance, Effort *out, Diag *diag);
/* Where an inverse run finds the effort of a drive, if that is another coordinate; else NULL. */
MUST_USE Status drive_coordinate(System *system, int drive, Expr *out, Diag *diag);
/* wrench of force and torque components: in axes of *chain */
MUST_USE Status wrench_of(System *system, const Instance *instance, int take, Vec *force,
                          Vec *torque, int *chain, Diag *diag);
/* everything that pushes, without inertia and multipliers; what pushes on joints' coordinates with
 * TAKE_ALL alone */
MUST_USE Status efforts_add(System *system, Loads *loads, int take, Diag *diag);
/* what a constraint row puts on its two ends: -lambda along its direction */
void loads_add_row(System *system, Loads *loads, const Row *row, Expr lambda);

#endif
