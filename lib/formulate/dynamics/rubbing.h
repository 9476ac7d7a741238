/* rubbing.h: dry friction in two or three directions with one bound on the norm of its force, and
 * contacts that open
 *
 * Friction acts against the sliding of one frame along a plane of another, or against every turn of
 * one against the other. A contact pushes along its normal besides, at its point. */
#ifndef COTREE_FORMULATE_DYNAMICS_RUBBING_H
#define COTREE_FORMULATE_DYNAMICS_RUBBING_H

#include "formulate/dynamics/loads.h"

typedef struct FrictionLoad {
    int count; /* directions in which there is a motion, at most 3; each with */
    int first; /* the first of those against which friction acts; before it is a contact's normal */
    Expr rate[3], effort[3];
    Vec axis[3]; /* in the axes of the tail; of turns in those of the head's orientation class */
    bool turns;
    Expr speed; /* the norm of the rates, from `first` on, */
    Expr norm;  /* of the efforts, likewise, */
    Expr power; /* and what all efforts do, W */
    Expr lost;  /* and what friction takes, W: never negative */
    Expr gap;   /* of a contact (m); otherwise NULL */
    Vec point;  /* of a contact, from the head's origin, in the axes of the tail's chain */
} FrictionLoad;

/* of a part whose row has `rub` */
MUST_USE Status rubbing_of(System *system, const Instance *instance, int take, FrictionLoad *out,
                           Diag *diag);
/* the load on its two frames */
MUST_USE Status rubbing_add(System *system, const Instance *instance, Loads *loads, int take,
                            Diag *diag);

#endif
