/* inverse_steps.h: Newton's steps of an inverse run, of the unknowns that a row solves for
 *
 * Each step solves J d = right. Where J is square its factors are sparse: each leg of a robot by
 * itself, then what joins them, so that the cost is proportional to the number of legs. Otherwise,
 * and where columns are nearly dependent, it is a dense least-squares problem. */
#ifndef COTREE_SIMULATE_RUN_INVERSE_STEPS_H
#define COTREE_SIMULATE_RUN_INVERSE_STEPS_H

#include "compile/residual.h"

#include <stdbool.h>

typedef struct InverseSteps InverseSteps;

/* New; inverse_steps_free(). Borrows the residual, which has `unknowns` unknowns. */
InverseSteps *inverse_steps_new(const Residual *residual, int unknowns);
void inverse_steps_free(InverseSteps *steps); /* NULL is fine */
/* The step d that minimises |J d - right|, with J from the values of all roots: for unknowns in
 * use, 0 for the others. False, with `out` unchanged: they are dependent. */
bool inverse_step(InverseSteps *steps, const double *values, const bool *in_use,
                  const double *right, double *out);

#endif
