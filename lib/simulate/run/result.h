/* result.h: the data that a run leaves: rows, its report, the history of its events
 *
 * A Result is const once it is returned, and outlives the integrator. It contains coordinates,
 * speeds and network states on an output grid, and borrows its System, which the session stores as
 * long as a result refers to it. The ResultReader of the run (result_reader.h) computes every
 * other variable from them on demand. */
#ifndef COTREE_SIMULATE_RUN_RESULT_H
#define COTREE_SIMULATE_RUN_RESULT_H

#include "simulate/equations/remark.h"
#include "simulate/equations/simulation_input.h"
#include "simulate/run/pace.h"

typedef enum RunKind { RUN_START, RUN_SIMULATE, RUN_KINEMATICS, RUN_INVERSE } RunKind;

typedef struct RunReport {
    const char *method; /* that was used */
    double rtol, atol;
    int64_t steps, rejected;
    int64_t evaluations; /* of the right-hand side */
    int64_t factorisations;
    int64_t jacobians;
    int64_t visits;           /* ranges of expressions computed in the look-ahead */
    int64_t regularised;      /* factorisations near a singular configuration */
    double singular_time;     /* first of these; NAN: none */
    double position_residual; /* largest |Phi| on the output grid */
    double velocity_residual; /* largest |Phi_u u - nu| */
    double energy_drift;      /* largest |E - E0 - work|; NAN: not a finite number */
    double energy_scale;      /* scale: largest kinetic or |potential| energy */
    double global_error;      /* of check=on, estimated, largest over grid and coordinates; NAN: not
                                 requested, or not known */
    bool is_unresolved;       /* check=on found another motion */
    double wall;              /* s */
    double reached;           /* last time */
    double every;             /* output step, s; 0: none */
    double step;              /* fixed or largest step that the user requested, s; 0: none */
    double most;              /* largest step that the user requested, s; 0: none */
    bool stopped;             /* by Ctrl-C */
    Pace pace;                /* step 0: not in real time */
} RunReport;

/* History of an event of the model in a run. */
typedef struct EventRecord {
    const char *name;
    const char *condition; /* as the user wrote it */
    EventAction action;
    bool is_bound;       /* it monitors the end of validity of a part's law */
    bool is_known;       /* `holds` is known: a run that continues needn't evaluate it */
    bool from_start;     /* it held at the start already */
    bool holds;          /* at the end */
    bool ended;          /* the run */
    bool accumulates;    /* it ended the run, as it happened ever faster; its guard may be held */
    bool is_held;        /* its guard is held at the end */
    int count;           /* number of times it happened */
    const double *times; /* s; count, ascending */
} EventRecord;

/* What becomes of a part that sticks (Component.sticks) in a run, or at an instant. */
typedef struct StickRecord {
    bool sticks;     /* at the end, or then */
    bool is_held;    /* then at its bound, while other parts hold it */
    bool is_open;    /* then beyond its limit, or out of contact: nothing acts */
    double stuck;    /* s: all in all, */
    int spans;       /* in so many spans of time, */
    double from, to; /* s: of which the last begins and ends then */
    int slips;       /* spans of time in which it slipped */
} StickRecord;

void result_free(Result *result); /* NULL is fine */
RunKind result_kind(const Result *result);
System *result_system(const Result *result);
const RunReport *result_report(const Result *result);
/* number of speeds minus independent constraints, at the start of it */
int result_freedoms(const Result *result);
/* full turns of a sum of angles in the run (system_whole_turns()): the i-th of its system; 0 where
 * the symbol is none of it */
int result_full_turns(const Result *result, Expr symbol);
const Remarks *result_remarks(const Result *result);
/* events of the model at the time of the run, and earlier ones that happened before it was
 * continued */
int result_event_count(const Result *result);
EventRecord result_event(const Result *result, int i);
/* False: the part rests on no surface of this run. O(corners). */
bool result_stick(const Result *result, const char *part, StickRecord *out);
/* The same at an instant, just after it: what holds then alone. */
bool result_stick_at(const Result *result, const char *part, double t, StickRecord *out);
int result_rows(const Result *result);
const double *result_times(const Result *result);
/* Number of steps that the integrator took to reach each row. Those of a run that continues another
 * are counted anew; all are 0 where nothing is integrated. */
const int *result_steps(const Result *result);
/* instants at which a jump or kink is possible, ascending, some of them twice */
int result_corner_count(const Result *result);
const double *result_corner_times(const Result *result);

#endif
