/* result.h: what a run leaves, and the parts that runs share */
#ifndef COTREE_SIMULATE_RUN_RESULT_H
#define COTREE_SIMULATE_RUN_RESULT_H

#include "simulate/assemble/mode_search.h"
#include "simulate/run/integration.h"
#include "simulate/run/phase.h"
#include "simulate/run/run.h"

/* What is known at the rows of a driven run beside (q, u, x), one block a row: x', z, u', lambda,
 * efforts. */
typedef struct Driven {
    int length;
    double *values; /* rows x length; NULL: rows are solved when asked for */
} Driven;

typedef struct Shares Shares;

struct Result {
    RunKind kind;
    System *system; /* the whole */
    Parameters parameters;
    LIST(Phase *)
    phases;            /* the first is of the whole, and where there are ideal switches no row's */
    Phase *phase;      /* in which it starts */
    ModeSearch *sides; /* NULL: there are no ideal switches */
    Shares *shares;    /* of what is stored, where switches join parts; NULL: none yet */
    Assembled start;   /* of the whole */
    double *begin;     /* y of the phase in which it starts */
    double tolerance;  /* of the run: bounds what a projection may leave */
    Grid grid;         /* rows of y */
    Grid corners;      /* where phases end and begin, two rows each */
    Jumps jumps;       /* where its equations change at times of their own */
    Driven driven;
    Grid asked; /* rows between those, where they were asked for last, */
    Driven asked_driven;
    Events *events; /* NULL: none */
    RunReport report;
    Text remarks;
};

/* A new result of no rows: programs compiled, start found, motion ready. */
MUST_USE Status result_open(RunKind kind, System *system, const Setting *setting, Result **out,
                            Diag *diag);
/* The same with the rows of another one, to go on where that ended. `old` and its system are
 * unchanged but for modes that it comes to. */
MUST_USE Status result_reopen(const Result *old, const Setting *setting, Result **out, Diag *diag);
/* E_MODEL where a driver's motion is supplied by another effort (by=): for inverse runs alone */
MUST_USE Status result_refuse_by(const Result *result, Diag *diag);
/* What solves the equations of a phase, as the result's start and the setting ask for. Fails with
 * E_NAME for an independent coordinate that the trees don't have, and as phase_open() does. */
MUST_USE Status result_open_phase(Result *result, Phase *phase, const Setting *setting, Diag *diag);
/* New, or NULL where there are none: the setting's events in the equations of a phase, going on
 * with what happened in `earlier` (NULL: nothing). */
MUST_USE Status result_make_events(Result *result, const Phase *phase, const Events *earlier,
                                   const Setting *setting, Events **out, Diag *diag);
/* The phase that it starts in and `begin`, from `start`. */
MUST_USE Status result_begin(Result *result, const Setting *setting, Diag *diag);
/* Energy balance over the rows, into the report. */
MUST_USE Status result_balance(Result *result, Diag *diag);
/* a row of the phase that it starts in */
void result_add_row(Result *result, double t, const double *y);
/* for all phases, also those that a run comes to later */
void result_tolerance(Result *result, double tolerance);
/* the phase of the whole: the only one where there are no ideal switches */
Phase *result_whole(const Result *result);
int result_phase_number(const Result *result, const Phase *phase); /* as rows bear it */
/* the phase of a row */
Phase *result_phase(const Result *result, int row);
/* a row's block of a driven run; NULL: the equations are to be solved */
const double *result_driven(const Result *result, int row);
/* Everything at (t, y) of a phase; `driven` is the row's block, or NULL to solve. False: no
 * solution. */
bool result_solve_row(Phase *phase, double t, const double *y, const double *driven,
                      RowValues *out);
/* A probe of a phase for expressions over user's variables, and its values at (t, y), `count` of
 * them: NAN where the equations have no solution. */
MUST_USE Status result_probe(Result *result, const Phase *phase, const Expr *items, int count,
                             Probe **out, Diag *diag);
void result_probe_at(Phase *phase, Probe *probe, double t, const double *y, const double *driven,
                     int count, double *out);
/* What the run was at t: y, its phase, and the block of a driven run (NULL: the equations are to be
 * solved), all borrowed until the next call. Between rows, that part of the run is taken again.
 * Fails with E_VALUE outside the run, and with E_SOLVER where the equations have no solution. */
MUST_USE Status result_at(Result *result, double t, Phase **phase, const double **y,
                          const double **driven, Diag *diag);

#endif
