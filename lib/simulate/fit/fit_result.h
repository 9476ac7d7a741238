/* fit_result.h: what a fit found: parameters with their errors, and the signals beside the data */
#ifndef COTREE_SIMULATE_FIT_FIT_RESULT_H
#define COTREE_SIMULATE_FIT_FIT_RESULT_H

#include "base/memory.h"
#include "simulate/fit/loss.h"

#include <stdbool.h>

typedef struct FitParameter {
    char *name;
    char *unit; /* "" where it isn't known, or for a number */
    double start, value;
    double error; /* standard error; NAN: the data determine none */
    double half;  /* half of the interval of 95 % confidence; NAN likewise */
    bool is_at_bound;
} FitParameter;

typedef struct FitSignal {
    char *name;     /* by= as written */
    char *data;     /* to= as written */
    char *unit;     /* "" likewise */
    bool is_number; /* one number, not a function of time */
    int count;
    double *times;            /* s */
    double *measured, *model; /* at these */
    double sigma;             /* of one of the data, given or found; NAN: neither */
    double rms;               /* of model - measured */
} FitSignal;

typedef struct FitResult {
    LIST(FitParameter) parameters;
    LIST(FitSignal) signals;
    LIST(char *) notes;   /* what the data leave open, what was left out */
    double *correlations; /* parameters x parameters; NAN where not determined */
    Loss loss;
    int points;      /* of all signals */
    double residual; /* root mean square of all residuals, in what they are weighted by */
    int iterations, runs;
    bool is_converged, is_stopped;
    double wall; /* s */
} FitResult;

FitResult *fit_result_new(void);         /* new, empty */
void fit_result_free(FitResult *result); /* NULL is fine */
/* the parameter with that name; -1: there is none */
int fit_result_find(const FitResult *result, const char *name);

#endif
