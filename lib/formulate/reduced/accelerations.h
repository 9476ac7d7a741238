/* accelerations.h: M u' = F solved in symbols, for the program of a run */
#ifndef COTREE_FORMULATE_REDUCED_ACCELERATIONS_H
#define COTREE_FORMULATE_REDUCED_ACCELERATIONS_H

#include "formulate/system/system.h"

typedef enum EliminatedBy {
    ELIMINATED_NOT,         /* a speed moves no mass, or the expressions are too large */
    ELIMINATED_BY_MASS,     /* from M and F */
    ELIMINATED_ALONG_TREES, /* along the trees: needs neither M nor F */
    /* with the multipliers of rows in use (constrained.h), which then aren't needed */
    ELIMINATED_CONSTRAINED,
    ELIMINATED_PRESCRIBED, /* by constraint rows (prescribed.h): needs neither */
} EliminatedBy;

/* u'[j] for this F, where `pushes` is the part due to neither inertia nor gravity. excess[j] is the
 * entry of M from which elimination leaves the j-th pivot, divided by this pivot. It is large where
 * a speed has next to no inertia of its own. Arrays of nu. Counts the cost of all methods, and
 * returns the cheapest. */
EliminatedBy system_accelerations(System *view, const Expr *force, const Expr *pushes,
                                  Expr *acceleration, Expr *excess);
#endif
