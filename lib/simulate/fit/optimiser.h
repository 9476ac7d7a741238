/* optimiser.h: parameters that minimise a value between bounds, subject to constraints on others
 *
 * NLopt's sequential quadratic programming (Kraft 1994) with gradients of difference quotients;
 * where that finds no minimum, as at the kink of a largest value, its linear approximations
 * (COBYLA, Powell 1994) go on from the best point. A point at which the model has no values is
 * avoided. */
#ifndef COTREE_SIMULATE_FIT_OPTIMISER_H
#define COTREE_SIMULATE_FIT_OPTIMISER_H

#include "simulate/fit/differences.h"

#include <stdbool.h>

typedef enum OptimiserMethod {
    OPTIMISER_BOTH, /* the first, and the second where it finds no minimum */
    OPTIMISER_SLSQP,
    OPTIMISER_COBYLA,
    OPTIMISER_METHODS
} OptimiserMethod;
const char *optimiser_name(OptimiserMethod method); /* never NULL */

typedef struct OptimiserProblem {
    int unknowns, constraints;
    const double *start;
    const double *low, *high; /* infinite: no bound */
    const bool *is_equality;  /* of each constraint: its value is 0; else 0 at most */
    const double *scales;     /* of the value to be minimised, then of each constraint; above 0 */
    double step;              /* of difference quotients, relative */
    double tolerance;         /* of constraints, in their scales */
    int most_evaluations;
    OptimiserMethod method;
    PointsFunction *function; /* 1 + constraints values at each point */
    void *context;
} OptimiserProblem;

typedef struct OptimiserSolution {
    double *x, *values; /* the best point; what is there, not divided by scales */
    double violation;   /* the largest of its constraints, in their scales; 0: none */
    int worst;          /* that constraint; -1: none */
    int evaluations;
    bool is_converged;
} OptimiserSolution;

/* New. E_STOPPED and other failures of the function after the start also leave the best point so
 * far; else *out is NULL on failure. */
MUST_USE Status optimiser_solve(const OptimiserProblem *problem, OptimiserSolution **out,
                                Diag *diag);
void optimiser_solution_free(OptimiserSolution *solution); /* NULL is fine */

#endif
