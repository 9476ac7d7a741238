/* result.h: what a run leaves: rows, its report, how its events fared
 *
 * A Result is const once it is handed over, and outlives what integrated it. It holds coordinates,
 * speeds and network states on an output grid, and borrows its System, which the session keeps as
 * long as a result names it. Every other variable is computed from them when somebody asks, by a
 * ResultReader (result_reader.h). Several threads may have one each. */
#ifndef COTREE_SIMULATE_RUN_RESULT_H
#define COTREE_SIMULATE_RUN_RESULT_H

#include "simulate/equations/remark.h"
#include "simulate/equations/simulation_input.h"
#include "simulate/run/pace.h"

typedef enum RunKind { RUN_START, RUN_SIMULATE, RUN_KINEMATICS, RUN_INVERSE } RunKind;

typedef struct RunReport {
    const char *method; /* that ran */
    double rtol, atol;
    int64_t steps, rejected;
    int64_t evaluations; /* of the right-hand side */
    int64_t factorisations;
    int64_t jacobians;
    int64_t visits;           /* ranges of expressions that the look-ahead has found */
    int64_t regularised;      /* factorisations near a singular configuration */
    double singular_time;     /* first of these; NAN: none */
    double position_residual; /* largest |Phi| on the output grid */
    double velocity_residual; /* largest |Phi_u u - nu| */
    double energy_drift;      /* largest |E - E0 - work|; NAN: no number holds it */
    double energy_scale;      /* largest kinetic or |potential| energy, to compare */
    double global_error;      /* of check=on, estimated, largest over grid and coordinates; NAN: not
                                 asked, or not known */
    bool is_unresolved;       /* check=on found another motion */
    double wall;              /* s */
    double reached;           /* last time */
    double every;             /* output step, s; 0: there is none */
    double step;              /* fixed or largest step that was asked for, s; 0: none */
    double most;              /* largest step that was asked for, s; 0: none */
    bool stopped;             /* by Ctrl-C */
    Pace pace;                /* step 0: it went as fast as it could */
} RunReport;

/* How an event of the model fared in a run. */
typedef struct EventRecord {
    const char *name;
    const char *condition; /* as written */
    EventAction action;
    bool is_bound;       /* it watches where the law of a part ends */
    bool is_known;       /* whether it holds at the end: a run that goes on needn't look */
    bool from_start;     /* held at the start already */
    bool holds;          /* at the end */
    bool ended;          /* the run */
    int count;           /* how often it happened */
    const double *times; /* count, rising */
} EventRecord;

void result_free(Result *result); /* NULL is fine */
RunKind result_kind(const Result *result);
System *result_system(const Result *result);
const RunReport *result_report(const Result *result);
/* speeds less independent constraints, at the start of it */
int result_freedoms(const Result *result);
/* how many full turns a sum of angles has in the run (system_whole_turns()): i of its system's, 0
 * where it isn't of it */
int result_full_turns(const Result *result, Expr symbol);
const Remarks *result_remarks(const Result *result);
/* events of the model when the run was made, and earlier ones that happened before it went on */
int result_event_count(const Result *result);
EventRecord result_event(const Result *result, int i);
int result_rows(const Result *result);
const double *result_times(const Result *result);
/* instants at which it may jump or bend, rising, each maybe twice */
int result_corner_count(const Result *result);
const double *result_corner_times(const Result *result);

#endif
