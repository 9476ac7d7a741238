/* impact.h: impacts on unilateral surfaces: stops, one-way clutches */
#ifndef COTREE_SIMULATE_RUN_IMPACT_H
#define COTREE_SIMULATE_RUN_IMPACT_H

#include "simulate/run/integration.h"
#include "simulate/run/phase.h"

/* the impacts of a part in a run */
typedef struct ImpactTally {
    char *part; /* or its condition */
    int count;
    int together; /* of them: while others had one, too */
    double lost;  /* J, of impacts that it took part in */
    double rests; /* s: when it came to rest last, after ever shorter flights; NAN */
} ImpactTally;
typedef LIST(ImpactTally) ImpactTallies;

typedef struct ImpactAt {
    Phase *phase; /* that slides along all surfaces that are met, and is entered */
    double t, span;
    const Meeting *at; /* these surfaces, in the order of its signs */
    int count;
} ImpactAt;

/* Let what meets unilateral surfaces at (t, y) with h' > 0 have an impact: y is then after it.
 * *any: there was one. E_SOLVER where none is found. O(surfaces) solutions of the equations. */
MUST_USE Status impact_take(const ImpactAt *here, double *y, ImpactTallies *tallies, bool *any,
                            Diag *diag);
void impact_tallies_report(const ImpactTallies *tallies, Remarks *out);
void impact_tallies_free(ImpactTallies *tallies);

#endif
