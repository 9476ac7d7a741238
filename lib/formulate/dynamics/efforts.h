/* efforts.h: efforts of springs, motors and forces */
#ifndef COTREE_FORMULATE_DYNAMICS_EFFORTS_H
#define COTREE_FORMULATE_DYNAMICS_EFFORTS_H

#include "formulate/dynamics/loads.h"
#include "formulate/system/constraints.h"

typedef struct Effort {
    const Instance *instance;
    Expr displacement, rate, value; /* along the line or of the joint's coordinate */
    Vec direction;                  /* line: from tail to head, ground axes */
    bool is_line;
} Effort;

MUST_USE Status effort_of(System *system, const Instance *instance, Effort *out, Diag *diag);
/* The coordinate at which an inverse run computes the effort of a drive, if that is another one;
 * otherwise NULL. */
MUST_USE Status drive_coordinate(System *system, int drive, Expr *out, Diag *diag);
/* wrench of force and torque components, in the axes of *chain */
MUST_USE Status wrench_of(System *system, const Instance *instance, int take, Vec *force,
                          Vec *torque, int *chain, Diag *diag);
/* the applied loads of one part; a load on a joint's coordinate only with TAKE_ALL */
MUST_USE Status effort_add(System *system, const Instance *instance, Loads *loads, int take,
                           Diag *diag);
/* all applied loads, without inertia and multipliers; loads on joints' coordinates only with
 * TAKE_ALL */
MUST_USE Status efforts_add(System *system, Loads *loads, int take, Diag *diag);
/* load of a constraint row on its two ends: -lambda along its direction */
void loads_add_row(System *system, Loads *loads, const Row *row, Expr lambda);

#endif
