/* result.h: what a run leaves, and the parts that runs share */
#ifndef COTREE_SIMULATE_RESULT_H
#define COTREE_SIMULATE_RESULT_H

#include "simulate/events.h"
#include "simulate/march.h"
#include "simulate/netdae.h"
#include "simulate/numbers.h"
#include "simulate/start.h"

/* What is known at the rows of a driven run beside (q, u, x), one block a row: x', z, u', lambda,
 * efforts. */
typedef struct Driven {
    int length;
    double *values; /* rows x length; NULL: rows are solved when asked for */
} Driven;

struct Result {
    RunKind kind;
    System *system;
    Layout *layout;
    Parameters parameters;
    Numbers *numbers;
    Motion *motion;
    NetDae *network; /* NULL where there is mechanics */
    Assembled start;
    Grid grid; /* of (q, u, x, work) */
    Driven driven;
    Events *events;   /* NULL: none */
    Samples *samples; /* NULL: none */
    RunReport report;
    Text remarks;
};

/* A new result of no rows: programs compiled, start found, motion ready. */
MUST_USE Status result_open(RunKind kind, System *system, const Setting *setting, Result **out,
                            Diag *diag);
/* the same, started where another one ended */
MUST_USE Status result_reopen(const Result *old, const Setting *setting, Result **out, Diag *diag);
/* E_MODEL where a driver's motion is supplied by another effort (by=): for inverse runs alone */
MUST_USE Status result_refuse_by(const Result *result, Diag *diag);
/* New, or NULL where there are none: the setting's events at the result's start, going on with what
 * happened in `earlier` (NULL: nothing). */
MUST_USE Status result_make_events(Result *result, const Events *earlier, const Setting *setting,
                                   Events **out, Diag *diag);
/* Everything at (t, y); `driven` the row's block, or NULL to solve. False: no solution. */
bool result_row(Result *result, double t, const double *y, const double *driven, RowValues *out);
/* Energy balance over the rows, into the report. */
MUST_USE Status result_balance(Result *result, Diag *diag);
/* (q, u, x, work) between two rows, projected; false outside the run */
bool result_between(Result *result, double t, double *y);

#endif
