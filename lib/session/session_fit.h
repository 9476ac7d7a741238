/* session_fit.h: parameters that make runs match data */
#ifndef COTREE_SESSION_SESSION_FIT_H
#define COTREE_SESSION_SESSION_FIT_H

#include "session/session_parameter_search.h"

#include "expr/curve.h"
#include "simulate/fit/fit_result.h"
#include "simulate/fit/fit_solve.h"

/* what is measured, and what it is compared with */
typedef struct FitTarget {
    const Syntax *to, *by;
    const Curve *curve; /* of to=; NULL: that is a number */
    double sigma;       /* 0: not given */
    double spread;      /* standard deviation of the data, or the size of a number; never 0 */
    int count;          /* of data within the runs */
    double *times, *data;
} FitTarget;

typedef struct FitPlan {
    LIST(FitTarget) targets;
    Loss loss;
    bool has_sigma;
} FitPlan;

/* of a statement; *out needs fit_plan_free() even after a failure */
MUST_USE Status fit_plan(ct_session *session, const Statement *statement, FitPlan *out, Diag *diag);
void fit_plan_free(FitPlan *plan);
/* The data within the last run, after it; E_VALUE: there are none. *left: how many lie outside. */
MUST_USE Status fit_plan_data(ct_session *session, FitPlan *plan, int *left, Diag *diag);

#endif
