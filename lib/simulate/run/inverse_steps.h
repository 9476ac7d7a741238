/* inverse_steps.h: Newton's steps of an inverse run, of those unknowns that a row solves for
 *
 * Where these are as many as the rows, factors are sparse: the legs of a robot each for itself,
 * then what joins them, so that the work rises as the number of legs. Elsewhere, and where they are
 * nearly dependent, it is least squares in full. */
#ifndef COTREE_SIMULATE_RUN_INVERSE_STEPS_H
#define COTREE_SIMULATE_RUN_INVERSE_STEPS_H

#include "compile/residual.h"

#include <stdbool.h>

typedef struct InverseSteps InverseSteps;

/* New; inverse_steps_free(). Borrows the residual, which has so many unknowns. */
InverseSteps *inverse_steps_new(const Residual *residual, int unknowns);
void inverse_steps_free(InverseSteps *steps); /* NULL is fine */
/* The step d by which J d comes nearest to `right`, J from the values of all roots: of unknowns in
 * use, 0 of the others. False, and `out` as it was: they are dependent. */
bool inverse_step(InverseSteps *steps, const double *values, const bool *in_use,
                  const double *right, double *out);

#endif
