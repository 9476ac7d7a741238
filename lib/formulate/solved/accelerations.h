/* accelerations.h: M u' = F solved in symbols, where a run's program does that */
#ifndef COTREE_FORMULATE_SOLVED_ACCELERATIONS_H
#define COTREE_FORMULATE_SOLVED_ACCELERATIONS_H

#include "formulate/system/system.h"

typedef enum Told {
    TOLD_NOT,         /* a speed moves nothing that has mass, or there is too much of it */
    TOLD_BY_MASS,     /* from M and F */
    TOLD_ALONG,       /* along the trees: neither M nor F is needed */
    TOLD_CONSTRAINED, /* with the multipliers of rows in use (constrained.h): they aren't needed */
    TOLD_PRESCRIBED,  /* by rows of constraints (prescribed.h): neither is needed either */
} Told;

/* u'[j] for these F, of which `pushes` is what neither inertia nor gravity makes, and excess[j]:
 * over the j-th pivot of M, what it is the rest of. That is large where a speed has next to no
 * inertia of its own. Arrays of nu. The ways there are are counted, and the cheapest is told. */
Told system_accelerations(System *view, const Expr *force, const Expr *pushes, Expr *acceleration,
                          Expr *excess);
#endif
