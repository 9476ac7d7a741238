/* reinitialise.h: new values for some variables in the middle of a run
 *
 * Coordinates, speeds and network states are put in place as they are; any other variable that is
 * a function of them is one more equation. Then the constraints are met again while what was set is
 * held. Positions: joints stay that what is given doesn't need, in whatever tree, and then keep
 * their rates, as what is given does (reinitialise_stay.c); speeds by the least change in the mass
 * metric, as impulsive reactions would. The energy that this brings counts as work done on the
 * system. */
#ifndef COTREE_SIMULATE_ASSEMBLE_REINITIALISE_H
#define COTREE_SIMULATE_ASSEMBLE_REINITIALISE_H

#include "base/text.h"
#include "simulate/equations/compiled_equations.h"

typedef struct Reinit Reinit;

typedef struct ReinitPlan {
    const VariableIndex *layout;
    Parameters *parameters;
    const Equations *equations;
    const int *rows; /* constraint rows in use; borrowed, as all here, while the Reinit lives */
    int row_count;
} ReinitPlan;

Reinit *reinit_new(const ReinitPlan *plan); /* new; reinit_free() */
void reinit_free(Reinit *reinit);           /* NULL is fine */
/* One more variable; they count from 0. Fails with E_VALUE where it follows from forces or from
 * what a circuit solves for, the errors of system_variable(). */
MUST_USE Status reinit_add(Reinit *reinit, const char *name, int primes, Diag *diag);
/* after the last of them; O(variables * unknowns) expressions */
MUST_USE Status reinit_compile(Reinit *reinit, Diag *diag);
/* Give values (NAN: leave) to the variables at (t, y); y is (q, u, x, references, work). Fails with
 * E_SOLVER, `events` named, and y is as it was: where there are no such positions, speeds or states
 * (a joint may close with its axis reversed alone, which is told), where neither what is given nor
 * what would stay decides on a position, and where rates that stay leave others open. */
MUST_USE Status reinit_apply(Reinit *reinit, double t, const double *values, const char *events,
                             double *y, Diag *diag);

#endif
