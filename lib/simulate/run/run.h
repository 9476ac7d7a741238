/* run.h: runs of a system: assembly, forward dynamics, kinematics, inverse; results
 *
 * A Result holds coordinates, speeds and network states on an output grid, and borrows its
 * System, which the session keeps as long as a result names it. Every other variable is
 * computed from them when somebody asks (result_values). */
#ifndef COTREE_SIMULATE_RUN_RUN_H
#define COTREE_SIMULATE_RUN_RUN_H

#include "simulate/equations/setting.h"

typedef enum RunKind { RUN_START, RUN_SIMULATE, RUN_KINEMATICS, RUN_INVERSE } RunKind;

typedef struct RunOptions {
    double duration;    /* s */
    double every;       /* output step, s; 0: duration / 500 */
    double rtol;        /* 0: 1e-8 */
    double atol;        /* times 1 m, 1 rad, 1 m/s, 1 A; 0: as rtol */
    double step;        /* fixed or largest step, s; 0: free */
    double most;        /* largest step, s, of all methods; 0: free */
    const char *method; /* a row of methods.def; NULL: auto */
    bool check;         /* run again at a tenth of the tolerance and report the global error */
} RunOptions;

typedef struct RunReport {
    const char *method; /* that ran */
    double rtol, atol;
    int64_t steps, rejected;
    int64_t evaluations; /* of the right-hand side */
    int64_t factorisations;
    int64_t jacobians;
    int64_t regularised;      /* factorisations near a singular configuration */
    double singular_time;     /* first of these; NAN: none */
    double position_residual; /* largest |Phi| on the output grid */
    double velocity_residual; /* largest |Phi_u u - nu| */
    double energy_drift;      /* largest |E - E0 - work|; NAN: no number holds it */
    double energy_swing;      /* largest kinetic energy less the smallest: scale of the above */
    double global_error;      /* of check=on, estimated, largest over grid and coordinates; NAN: not
                                 asked, or not known */
    bool is_unresolved;       /* check=on found another motion */
    double wall;              /* s */
    double reached;           /* last time */
    double every;             /* output step, s; 0: there is none */
    double step;              /* fixed or largest step that was asked for, s; 0: none */
    double most;              /* largest step that was asked for, s; 0: none */
    bool stopped;             /* by Ctrl-C */
} RunReport;

/* How an event of the model fared in a run. */
typedef struct EventRecord {
    const char *name;
    const char *condition; /* as written */
    EventAction action;
    bool from_start;     /* held at the start already */
    bool holds;          /* at the end */
    bool ended;          /* the run */
    int count;           /* how often it happened */
    const double *times; /* count, rising */
} EventRecord;

/* Solve Phi = 0 and the velocity constraints from initial values and guesses (any variables, in
 * whatever tree), network states and algebraic unknowns too: a result of one row at t = 0. Text
 * about what was solved for, redundant constraints by joint, singular starts: result_remarks().
 * Fails with E_ASSEMBLE: the residual of each equation that can't be met, by joint and given value.
 */
MUST_USE Status run_assemble(System *system, const Setting *setting, Result **out, Diag *diag);

/* Where everything rests, with sources and drivers as at t = 0: a result of one row like that of
 * run_assemble(), from whose start the search goes out. Fails with E_SOLVER, telling what stays out
 * of balance by part, and as run_assemble() does. */
MUST_USE Status run_equilibrium(System *system, const Setting *setting, Result **out, Diag *diag);

/* Forward dynamics from the assembled start. E_STOPPED and E_SOLVER still hand out what was
 * computed (*out is NULL only when nothing was). */
MUST_USE Status run_simulate(System *system, const Setting *setting, const RunOptions *options,
                             Result **out, Diag *diag);
/* Driven motion: positions, speeds, accelerations. E_MODEL when drivers leave freedoms (said how
 * many). */
MUST_USE Status run_kinematics(System *system, const Setting *setting, const RunOptions *options,
                               Result **out, Diag *diag);
/* Kinematics, and the efforts (or sources) that the drivers need. */
MUST_USE Status run_inverse(System *system, const Setting *setting, const RunOptions *options,
                            Result **out, Diag *diag);
/* Go on from the end of a run; the rows are appended to a new result with all the old ones. */
MUST_USE Status run_resume(const Result *old, const Setting *setting, const RunOptions *options,
                           Result **out, Diag *diag);

void result_free(Result *result); /* NULL is fine */
RunKind result_kind(const Result *result);
System *result_system(const Result *result);
const RunReport *result_report(const Result *result);
/* speeds less independent constraints, at the start of it */
int result_freedoms(const Result *result);
const char *result_remarks(const Result *result); /* lines for the user; may be "" */
/* events of the model when the run was made, and earlier ones that happened before it went on */
int result_event_count(const Result *result);
EventRecord result_event(const Result *result, int i);
int result_rows(const Result *result);
const double *result_times(const Result *result);
/* Values of expressions over variables (SYMBOL_VARIABLEs; system_resolve() is done here) at every
 * row: out is rows x count. `t` is the row's time. */
MUST_USE Status result_values(Result *result, const Expr *items, int count, double *out,
                              Diag *diag);
/* What is asked for next are these instants, rising: found in one go. Where that fails, or there is
 * no such instant, asking for it tells. Fails with E_STOPPED. */
MUST_USE Status result_prepare(Result *result, const double *times, int count, const Watch *watch,
                               Diag *diag);
/* The same as result_values() at one instant of the run. Between rows that part of the run is taken
 * again, with its own steps and tolerance. E_VALUE outside the run. */
MUST_USE Status result_values_at(Result *result, const Expr *items, int count, double at,
                                 double *out, Diag *diag);

/* the rows of methods.def, for help and completion: name and one line; NULL at the end */
const char *run_method(int i, const char **brief);

#endif
