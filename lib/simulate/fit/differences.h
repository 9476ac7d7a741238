/* differences.h: derivatives of a vector of values between bounds, by central difference quotients
 *
 * A quotient is one-sided where the other side is beyond a bound or has no values. All points are
 * evaluated in at most two calls, so that the function may share them among processes. */
#ifndef COTREE_SIMULATE_FIT_DIFFERENCES_H
#define COTREE_SIMULATE_FIT_DIFFERENCES_H

#include "base/diag.h"

/* Values at each of `count` points, one after another in `points` and `out`; NAN in the first of a
 * point: there are none. Any other status than OK ends the search. */
typedef Status PointsFunction(void *context, int count, const double *points, double *out,
                              Diag *diag);

typedef struct Differences {
    int unknowns, values;
    const double *low, *high; /* infinite: no bound */
    const double *steps;      /* of each unknown */
    PointsFunction *function;
    void *context;
} Differences;

/* Derivatives at x, where the values are `at`, into `out` (values x unknowns). *evaluations
 * increases by the points. E_SOLVER: there are values on neither side of x. */
MUST_USE Status differences_find(const Differences *differences, const double *x, const double *at,
                                 double *out, int *evaluations, Diag *diag);

#endif
