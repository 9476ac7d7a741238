/* reset.h: new values for some variables in the middle of a run
 *
 * Coordinates, speeds and network states are put in place as they are; any other variable that is
 * a function of them is one more equation. Then the constraints are met again while what was set is
 * held: positions by the least move, speeds by the least change in the mass metric, as impulsive
 * reactions would. The energy that this brings counts as work done on the system. */
#ifndef COTREE_SIMULATE_ASSEMBLE_RESET_H
#define COTREE_SIMULATE_ASSEMBLE_RESET_H

#include "base/text.h"
#include "simulate/equations/numbers.h"

typedef struct Reset Reset;

typedef struct ResetPlan {
    const Layout *layout;
    Parameters *parameters;
    const Equations *equations;
    const int *rows; /* constraint rows in use; borrowed, as all here, while the Reset lives */
    int row_count;
} ResetPlan;

Reset *reset_new(const ResetPlan *plan); /* new; reset_free() */
void reset_free(Reset *reset);           /* NULL is fine */
/* One more variable; they count from 0. Fails with E_VALUE where it follows from forces or from
 * what a circuit solves for, the errors of system_variable(). */
MUST_USE Status reset_add(Reset *reset, const char *name, int primes, Diag *diag);
/* after the last of them; O(variables * unknowns) expressions */
MUST_USE Status reset_compile(Reset *reset, Diag *diag);
/* Give values (NAN: leave) to the variables at (t, y); y is (q, u, x, work). False: there are no
 * such positions, speeds or states, and y is as it was; where a joint would close with its axis
 * reversed alone, `why` tells. */
bool reset_apply(Reset *reset, double t, const double *values, double *y, Text *why);

#endif
