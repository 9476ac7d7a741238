/* integration.h: a forward run from start to end: steps, rows of the output grid, switches, events
 *
 * Rows are at multiples of the output step and at the end; they are interpolated in steps and
 * projected, and never limit a step. Switches do: a zero crossing of a condition in t alone is
 * found beforehand, and a step ends at the last floating-point number before it and the next starts
 * at the first one after it; a condition in the state is located on the interpolant, and the step
 * is shortened to it. Conditions of events are located likewise, to the last two units of
 * the time (reach_zero() of integration_meet.c). There is a row at the instant of
 * an event, or two of equal time where it sets new values: before and after.
 *
 * Ideal switches divide a run into segments: at each switch, event or jump, the caller of the run
 * determines which equations hold afterwards. */
#ifndef COTREE_SIMULATE_RUN_INTEGRATION_H
#define COTREE_SIMULATE_RUN_INTEGRATION_H

#include "base/call_monitor.h"
#include "simulate/equations/remark.h"
#include "simulate/run/crossings.h"
#include "simulate/run/events.h"
#include "simulate/run/grid.h"
#include "simulate/run/onset.h"
#include "simulate/run/pace.h"
#include "simulate/run/samples.h"

/* equations, and the data that belong to them */
typedef struct Segment {
    int phase; /* number of the phase: stored in rows */
    const Equations *equations;
    Motion *motion;
    Events *events;        /* NULL: none */
    Samples *samples;      /* NULL: none */
    Onset *onset;          /* NULL: no short pulses */
    const Method *stiff;   /* used where plan.method is NULL; */
    const Method *coupled; /* used where that can't continue; NULL: none */
} Segment;

/* what bounds the search for the next mode */
typedef struct Nearness {
    double last;  /* s: length of the last step; 0: there was none */
    double ahead; /* s: where a margin ends at t, time after which its sign is certain; 0 */
} Nearness;

/* Returns the segment that continues from (t, y), where y is of `segment`. `behind` is the instant
 * just after t, where sources have jumped; `near` bounds the search. Another one is stored in
 * *segment and its y in *out, borrowed until the next call; otherwise both are unchanged. Fails
 * where there is none. */
typedef Status (*NextSegment)(void *context, double t, double behind, Nearness near,
                              const double *y, Segment *segment, const double **out, Diag *diag);

/* A surface that the run is on, or on whose side it remains. */
typedef struct Meeting {
    int surface;
    int side;     /* to which its sign has changed: the motion leaves there; 0: not known */
    bool far;     /* it is not on the surface but on that side */
    bool ends;    /* its sign has reached its bound on `side` */
    bool settles; /* it crosses so often that it counts as at rest on it */
    double rest;  /* of a vector: its norm where it counts as 0 */
    int load;     /* 1 + the surface whose effort bounds what acts on it; 0: none */
} Meeting;

/* what was chosen */
typedef struct SurfaceChoice {
    bool entered; /* another segment goes on */
    bool jumps;   /* y is another one: there was an impact, */
    bool moved;   /* or it was moved by next to nothing */
} SurfaceChoice;

/* Returns the segment that continues from (t, y), on surfaces on which its equations jump: across
 * them, off them or along them, and after impacts on them, which change y. `low` and `high` bound
 * the time that rates use. Where it is another one, it is stored in *segment. Fails where none
 * continues. */
typedef Status (*Choose)(void *context, double t, double low, double high, double *y,
                         const Meeting *at, int count, Segment *segment, SurfaceChoice *out,
                         Diag *diag);

/* s: between two successive floating-point numbers (or around one at which a condition is 0) */
typedef struct Jump {
    double before, behind;
    bool samples; /* a sampling instant, with the same conditions on both sides */
} Jump;
typedef LIST(Jump) Jumps;

/* Add to the diag why the stepper of that segment could take no step; *is_rounding: whether
 * rounding alone is the cause, as far as is known. */
typedef void (*Explain)(void *context, const Segment *segment, Stepper *stepper, bool *is_rounding,
                        Diag *diag);

/* The method with which a segment starts at (t, y), where the user requested *method (NULL: none).
 * Fails where that would give wrong results. */
typedef Status (*ChooseMethod)(void *context, const Segment *segment, double t, const double *y,
                               const Method **method, Diag *diag);

typedef struct IntegrationPlan {
    Segment segment;         /* the first one */
    NextSegment mode_switch; /* NULL: it continues to the end */
    Choose choose;           /* used where equations jump on surfaces */
    Explain explain;         /* NULL: no explanation */
    /* called after each row; returns whether to stop there. NULL: not called */
    bool (*see)(void *context, int phase, double t, const double *y);
    void *context; /* of all callbacks */
    /* describes a condition, for messages */
    void (*tell)(void *context, const Segment *segment, int condition, Text *out);
    const Equations
        *in_time; /* whose conditions of t alone are those of all segments; NULL: segment's */
    const Method *method; /* NULL: dop853 until it finds the problem stiff, then segment.stiff, */
    ChooseMethod first;   /* unless this chooses another at the start; NULL: it doesn't */
    Control control;
    double from, to;     /* s */
    double every;        /* output step, s */
    const double *times; /* rows at these ascending times after `from` instead; NULL */
    int time_count;
    const Jumps *jumps; /* zero crossings of conditions of t alone; NULL: they are computed */
    double span;        /* of the whole run, of which this repeats a part, s; 0: it is the whole */
    bool asks;          /* the tolerance was given: fixed steps report any miss */
    bool skip_first;    /* the row at `from` exists already */
    bool is_sampled;    /* samples that are due at `from` have been taken */
    Grid *corners; /* rows where one segment ends and the next begins, two each; NULL: not stored */
    Crossings *crossings; /* appended to; NULL: not stored */
    Pace *pace;           /* real-time pacing; NULL: as fast as possible */
    const CallMonitor *watch;
} IntegrationPlan;

typedef struct IntegrationReport {
    Counts counts;
    const Method *method; /* that is in use at the end */
    Events *events;       /* of the last segment */
    double reached;
    double position_residual, velocity_residual; /* largest over the rows */
    Jumps jumps;                                 /* all, up to the end of the run */
    Remarks remarks;
} IntegrationReport;

/* Appends rows to `grid` and fills the report, also on failure: E_SOLVER, E_STOPPED. The caller
 * frees remarks and jumps. */
MUST_USE Status integrate(const IntegrationPlan *plan, const double *start, Grid *grid,
                          IntegrationReport *out, Diag *diag);

#endif
