/* fit_solve.h: parameters that minimise the losses of residuals, and how well these determine them
 *
 * Levenberg and Marquardt's method (Marquardt 1963, with the damping of Nielsen 1999) between
 * bounds: unknowns at a bound from which the losses would decrease outwards are held. Derivatives
 * are those of the problem, or difference quotients (differences.h). Each residual is z = (model -
 * data)/sigma. A point at which the model has no values is as if its losses were infinite. */
#ifndef COTREE_SIMULATE_FIT_FIT_SOLVE_H
#define COTREE_SIMULATE_FIT_FIT_SOLVE_H

#include "simulate/fit/differences.h"
#include "simulate/fit/loss.h"

#include <stdbool.h>

/* Derivatives of the residuals at x: residuals x unknowns. *has: whether there are such; otherwise
 * they are difference quotients. */
typedef Status DerivativesFunction(void *context, const double *x, double *out, bool *has,
                                   Diag *diag);

typedef struct FitProblem {
    int unknowns, residuals;
    const double *start;
    const double *low, *high; /* infinite: no bound */
    Loss loss;
    bool sigma_is_known;              /* else the scale of the losses is that of the residuals */
    double step;                      /* of difference quotients, relative */
    double noise;                     /* of a residual, from the accuracy of the model */
    PointsFunction *function;         /* residuals */
    DerivativesFunction *derivatives; /* NULL: they are difference quotients */
    void *context;
} FitProblem;

typedef struct FitSolution {
    int unknowns, residuals;
    double *x, *z;      /* unknowns; residuals there */
    double *jacobian;   /* residuals x unknowns */
    bool *is_held;      /* at a bound */
    double *errors;     /* standard errors; NAN where the residuals determine none */
    double *covariance; /* unknowns x unknowns; NAN likewise */
    /* directions in which no residual changes: relative changes of the unknowns, the largest 1 */
    double *undetermined; /* undetermined_count x unknowns */
    int undetermined_count;
    double squares; /* sum of z^2 */
    double scale;   /* c of the losses; 0 for squares */
    int iterations, evaluations;
    bool is_converged;
} FitSolution;

/* The minimum near the start: new. E_STOPPED and other failures of the function after the start
 * also leave a solution, the best so far, without statistics; else *out is NULL on failure. */
MUST_USE Status fit_solve(const FitProblem *problem, FitSolution **out, Diag *diag);
void fit_solution_free(FitSolution *solution); /* NULL is fine */

/* (fit_statistics.c) Standard errors from the jacobian: s^2 (J^T J)^-1 with s^2 of the residuals;
 * for other losses than squares as Huber (1981), section 7.6. */
void fit_statistics(const FitProblem *problem, FitSolution *solution);
/* (also there) What a change of an unknown is compared with. */
double fit_size(const FitProblem *problem, const double *x, int unknown);
/* singular values of a matrix of max(rows, columns) x columns, falling; `a` becomes U */
void fit_singular_values(double *a, int rows, int columns, double *s, double *v);

#endif
