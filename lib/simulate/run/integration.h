/* integration.h: from start to end of a forward run: steps, rows of the output grid, switches,
 * events
 *
 * Rows lie at multiples of the output step and at the end; they are read from the steps'
 * interpolants and projected, and never force a step. Switches do: a condition in t alone is found
 * beforehand, and the step ends on the last number before it and starts again on the first behind
 * it; a condition in the state is located on the interpolant, and the step is taken again up to it.
 * Conditions of events are located likewise. The instant at which an event happens is a row, or two
 * of equal time where it gives new values: before and behind.
 *
 * What ideal switches do to the equations makes segments: at each instant where a switch was met,
 * an event or a jump, whoever ordered the run says which equations hold behind it. */
#ifndef COTREE_SIMULATE_RUN_INTEGRATION_H
#define COTREE_SIMULATE_RUN_INTEGRATION_H

#include "base/call_monitor.h"
#include "simulate/equations/remark.h"
#include "simulate/run/events.h"
#include "simulate/run/grid.h"
#include "simulate/run/onset.h"
#include "simulate/run/pace.h"
#include "simulate/run/samples.h"

/* equations, and what goes with them */
typedef struct Segment {
    int phase; /* its number: rows bear it */
    const Equations *equations;
    Motion *motion;
    Events *events;      /* NULL: none */
    Samples *samples;    /* NULL: none */
    Onset *onset;        /* NULL: nothing acts for a short time */
    const Method *stiff; /* where plan.method is NULL; */
    const Method *joint; /* where that gets no further; NULL: none may */
} Segment;

/* Which segment goes on from (t, y), where y is of `segment`; `behind` is the instant just behind
 * t, where sources have jumped, and `near` tells how far from it to look. Another one goes into
 * *segment, its y into *out, borrowed until the next call; where it is the same, both stay. Fails
 * where there is none. */
typedef struct Nearness {
    double last;  /* s: how long the last step was; 0: there was none */
    double ahead; /* s: where a margin ends at t, that long behind it this is beyond doubt; 0 */
} Nearness;
typedef Status (*NextSegment)(void *context, double t, double behind, Nearness near,
                              const double *y, Segment *segment, const double **out, Diag *diag);

/* A surface that the run stands on, or whose side it keeps. */
typedef struct Meeting {
    int surface;
    int side;     /* of it, that its sign has come to: the motion leaves it there; 0: not known */
    bool far;     /* it isn't on the surface but on that side */
    bool settles; /* it goes to and fro through it so fast that it rests there */
} Meeting;

/* Which segment goes on from (t, y), on surfaces that its equations jump on: across them, off them
 * or along them. `low` and `high` bound the time that rates see. Where it is another one, *entered,
 * it goes into *segment. Fails where none goes on. */
typedef Status (*Choose)(void *context, double t, double low, double high, const double *y,
                         const Meeting *at, int count, Segment *segment, bool *entered, Diag *diag);

/* s: between two numbers one behind another (or around one on which a condition is 0) */
typedef struct Jump {
    double before, behind;
    bool samples; /* a sampling instant, the same on either side */
} Jump;
typedef LIST(Jump) Jumps;

/* Add to the diag why the stepper, which is of that segment, could take no step; *is_rounding:
 * whether rounding alone is behind it, as far as is known. */
typedef void (*Explain)(void *context, const Segment *segment, Stepper *stepper, bool *is_rounding,
                        Diag *diag);

/* What a segment begins with at (t, y), where *method was asked for, NULL: none was. Fails where
 * that would go wrong. */
typedef Status (*ChooseMethod)(void *context, const Segment *segment, double t, const double *y,
                               const Method **method, Diag *diag);

typedef struct IntegrationPlan {
    Segment segment;         /* to begin with */
    NextSegment mode_switch; /* NULL: it goes on to the end */
    Choose choose;           /* where equations jump on surfaces */
    Explain explain;         /* NULL: nothing is known */
    /* a row was added; whether to stop there. NULL: nobody sees them */
    bool (*see)(void *context, int phase, double t, const double *y);
    void *context; /* of all of them */
    /* what a condition is about, for messages */
    void (*tell)(void *context, const Segment *segment, int condition, Text *out);
    const Equations
        *in_time; /* whose conditions of t alone are those of all segments; NULL: segment's */
    const Method *method; /* NULL: dop853 until it finds the problem stiff, then segment.stiff, */
    ChooseMethod first;   /* unless this says another to begin with; NULL: it doesn't */
    Control control;
    double from, to;     /* s */
    double every;        /* output step, s */
    const double *times; /* rows at these times instead, which rise, behind `from`; NULL */
    int time_count;
    const Jumps *jumps; /* where conditions of t alone change sign; NULL: it finds out */
    double span;        /* of the run that it goes over a part of, s; 0: it is the whole */
    bool asks;          /* the tolerance was given: fixed steps tell of any miss */
    bool skip_first;    /* the row at `from` is there already */
    bool is_sampled;    /* what is due at `from` has been sampled */
    Grid *corners; /* rows where one segment ends and the next begins, two each; NULL: not kept */
    Pace *pace;    /* of the clock, which it keeps up with; NULL: it goes as fast as it can */
    const CallMonitor *watch;
} IntegrationPlan;

typedef struct IntegrationReport {
    Counts counts;
    const Method *method; /* in use at the end */
    Events *events;       /* of the last segment */
    double reached;
    double position_residual, velocity_residual; /* largest over the rows */
    Jumps jumps;                                 /* that it met or would have met */
    Remarks remarks;
} IntegrationReport;

/* Rows are appended to `grid` and the report filled also when it fails: E_SOLVER, E_STOPPED. The
 * caller frees remarks and jumps. */
MUST_USE Status integrate(const IntegrationPlan *plan, const double *start, Grid *grid,
                          IntegrationReport *out, Diag *diag);

#endif
