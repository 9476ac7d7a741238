/* accelerations.h: M u' = F solved in symbols, where a run's program does that */
#ifndef COTREE_FORMULATE_REDUCED_ACCELERATIONS_H
#define COTREE_FORMULATE_REDUCED_ACCELERATIONS_H

#include "formulate/system/system.h"

typedef enum EliminatedBy {
    ELIMINATED_NOT,         /* a speed moves nothing that has mass, or there is too much of it */
    ELIMINATED_BY_MASS,     /* from M and F */
    ELIMINATED_ALONG_TREES, /* along the trees: neither M nor F is needed */
    ELIMINATED_CONSTRAINED, /* with the multipliers of rows in use (constrained.h): they aren't
                               needed */
    ELIMINATED_PRESCRIBED,  /* by rows of constraints (prescribed.h): neither is needed either */
} EliminatedBy;

/* u'[j] for these F, of which `pushes` is what neither inertia nor gravity makes, and excess[j]:
 * over the j-th pivot of M, what it is the rest of. That is large where a speed has next to no
 * inertia of its own. Arrays of nu. The ways there are are counted, and the cheapest is told. */
EliminatedBy system_accelerations(System *view, const Expr *force, const Expr *pushes,
                                  Expr *acceleration, Expr *excess);
#endif
