/* integration_impl.h: declarations shared by the files of a forward run: one Integration, from
 * start to end */
#ifndef COTREE_SIMULATE_RUN_INTEGRATION_IMPL_H
#define COTREE_SIMULATE_RUN_INTEGRATION_IMPL_H

#include "base/memory.h"
#include "simulate/integrate/stagnation.h"
#include "simulate/run/integration.h"

#define NEAREST_TIME 4e-16 /* of t: no zero is located more closely */

/* state of the surfaces at a point where a run continues */
enum MetSurface { ROOT_ANY = -1, ROOT_NONE = -2 };

/* repeated crossings of a surface by the motion */
typedef struct Chatter {
    int count;     /* number in succession */
    double last;   /* s: time of the last one; */
    double first;  /* s: first interval between two, */
    double recent; /* s: and longest of the last intervals */
    bool settles;  /* so short that the motion counts as at rest on it */
} Chatter;

typedef struct Integration {
    const IntegrationPlan *plan;
    Segment segment;
    const Equations *eq; /* of the segment */
    Events *ev;
    int count;  /* conditions: those of the equations, then those of events */
    int length; /* of y in this segment */
    Grid *grid;
    IntegrationReport *out;
    Stepper *stepper;
    Control control; /* requested */
    Counts earlier;  /* of discarded steppers */
    StagnationMonitor stagnation;
    Jumps jumps;
    double low, high;             /* bounds of the time that rates use */
    double *y, *slope;            /* one y, one y'; with room for those of plan->in_time */
    double *conditions, *largest; /* current values, and largest absolute values so far */
    int *mode;                    /* sign of each condition until its next switch */
    int *looked_at, looked_count; /* conditions that steps evaluate; their number */
    double *rest;                 /* norms of vectors that count as 0; of others 0 */
    double *band;                 /* sizes without a reliable sign, after a switch, */
    double *noise;                /* and anywhere: of margins */
    double *band_ends;            /* s: time from which on `noise` applies; INFINITY */
    double *depth, *depth_low, *depth_high; /* of conditions times modes, while a zero is located */
    double depths_at; /* s: where depth_high is known: the end of the last step; NAN */
    int next_row, rows;
    double scanned;        /* time in the last step up to which conditions are followed */
    double *reach;         /* largest absolute value of each surface's measure in the segment, */
    Chatter *chatters;     /* crossings of each of them, */
    int surfaces;          /* number of surfaces */
    int root;              /* condition whose surface is reached; or a MetSurface */
    double ahead;          /* s: time after which the reached margin's sign is certain; 0 */
    bool has_restarted;    /* the stepper, after a jump */
    bool has_new_row;      /* the last row is of integration_add_new_row() */
    int switches;          /* in quick succession */
    double switched_since; /* s: time of the first of them */
    int slow_switches;     /* the same for a longer part of the run */
    double slow_since;
    double missed;       /* largest estimated error of a fixed step, in tolerances */
    double missed_at;    /* s */
    bool is_stopped;     /* by the receiver of rows */
    bool is_over;        /* an event has ended the run */
    bool is_crossing;    /* the last crossing of the plan is open */
    bool needs_restart;  /* the last step was shortened, and its method has to start anew */
    bool after_event;    /* no step has been taken since a switch, */
    double initial_step; /* s: a step of this length may follow it; 0: not known */
} Integration;

/* --- rows (integration_rows.c) --- */

bool integration_add_row(Integration *m, double t);
/* The same of new values, which hold though they may leave what the motion slides along. Its phase
 * is the one that is entered next. */
void integration_add_new_row(Integration *m, double t);
void integration_enter_row(Integration *m);
/* whether the last row is at t within rounding */
bool integration_has_row(const Integration *m, double t);
/* add rows of the output grid up to the stepper's time */
MUST_USE Status integration_add_rows(Integration *m, Diag *diag);
/* and those just after it within rounding, before a jump there */
MUST_USE Status integration_add_rows_before(Integration *m, Diag *diag);
/* End the last step at t, inside it, with the interpolated state: rows before are added, and the
 * stepper has to be restarted. */
MUST_USE Status integration_cut(Integration *m, double t, Diag *diag);
/* --- segments (integration_segment.c) --- */

Stepper *integration_new_stepper(Integration *m, const Method *method);
void integration_discard_stepper(Integration *m); /* its counts are added */
/* the data of its equations, which hold from t on */
void integration_open_segment(Integration *m, const Segment *segment, double t);
void integration_close_segment(Integration *m);
/* Choose the segment that continues from the stepper's state: another one where that is on surfaces
 * (*entered). */
MUST_USE Status integration_settle_surfaces(Integration *m, bool *entered, Diag *diag);
/* Restart the stepper at (t, y), in another segment where ideal switches change state
 * (*entered). */
MUST_USE Status integration_go_on(Integration *m, double t, const double *y, bool *entered,
                                  Diag *diag);

/* --- crossings (integration_crossings.c) --- */

/* Record (t, y) as the state before a crossing; does nothing while one is open. */
void integration_open_crossing(Integration *m, CrossingKind kind, int condition, double t,
                               const double *y);
Crossing *integration_crossing(const Integration *m); /* the open one; NULL: there is none */
void integration_close_crossing(Integration *m);      /* the stepper's state is that after it */

/* --- surfaces (integration_slide.c) --- */

/* whether a surface's measure is 0 within rounding */
double integration_on_surface(const Integration *m, int condition);
/* the norm below which the vector of such a condition counts as 0, by what it has been */
double integration_rest(const Integration *m, int condition);
/* The end of the next step, at most `end`: a vector whose norm falls is followed down to rest. */
double integration_end_of_step(Integration *m, double end);
/* set conditions' modes on surfaces, and their largest values */
void integration_begin_surfaces(Integration *m);
void integration_reach(Integration *m);

/* --- surfaces that a motion crosses ever faster (integration_chatter.c) --- */

/* Record that condition i, and with it its surface, is reached at t, and whether the motion settles
 * there. */
void integration_note_chatter(Integration *m, int i, double t);
/* report that the motion settles: call while its state is unchanged */
void integration_report_settling(Integration *m, int i);

/* --- conditions of t alone (integration_jumps.c) --- */

/* in order of time, into m->jumps; E_SOLVER: there are too many to separate */
MUST_USE Status integration_find_jumps(Integration *m, Diag *diag);

/* --- conditions of the state (integration_switches.c) --- */

bool integration_is_of_event(const Integration *m, int condition);
int integration_state_conditions(const Integration *m); /* their number */
/* values of all conditions at (t, y), into m->conditions */
void integration_evaluate(Integration *m, double t, const double *y);
/* choose the conditions that steps evaluate, in a new segment */
void integration_choose_conditions(Integration *m);
/* whether a condition that depends on more than t has a sign at (t, y) that differs from the run's;
 * the Turns of an Onset */
bool integration_turns(void *integration, double t, const double *y);
/* set the signs of the equations' conditions at the stepper's state; those of events are
 * unchanged */
void integration_begin_modes(Integration *m);
/* The first switch in the last step that hasn't been handled: its condition, and a time just after
 * it; -1: none. */
int integration_find_switch(Integration *m, double *when);
/* g of a condition at the stepper's end, and its rate along the motion */
double integration_condition_rate(Integration *m, int condition, double *value);
/* a margin: the segment is the right one as long as it is positive */
bool integration_is_margin(const Integration *m, int condition);
double
integration_largest_margin(const Integration *m);    /* largest size of all of them until now, */
double integration_rounding(const Integration *m);   /* rounding error of any of them, */
double integration_most_noise(const Integration *m); /* and the largest value that is noise */
/* values of all conditions at t in the stepper's interpolant; y there goes into m->y */
void integration_conditions_at(Integration *m, double t);
/* Ignore margins that are still negative at the start of a segment, but increasing, as long as they
 * don't decrease further. */
void integration_let_margins_rise(Integration *m);

/* --- events (integration_events.c) --- */

/* Handle the current sides of events' conditions at t and y; *changed: new values were set. The
 * stepper is moved there and has to be restarted. */
MUST_USE Status integration_take_events(Integration *m, double t, int *sides, bool *changed,
                                        Diag *diag);

/* evaluate conditions at the start, where some may become true */
MUST_USE Status integration_begin_events(Integration *m, Diag *diag);
/* the same in a segment that starts from the stepper's state; *changed: y has new values */
MUST_USE Status integration_resume_events(Integration *m, bool *changed, Diag *diag);
/* whether an event becomes true as the condition changes; if not, the change is recorded */
bool integration_matters(Integration *m, int condition);
/* the same where only conditions in time change, between two intervals */
MUST_USE Status integration_meet_time(Integration *m, Jump jump, Diag *diag);

/* --- reaching and crossing (integration_meet.c) --- */

/* End the last step at the switch, cross it, and restart after it. *again: the shortened step has
 * passed others, which come first: search for them. It is only checked where *again is true on
 * entry. */
MUST_USE Status integration_meet_switch(Integration *m, int condition, double when, bool *again,
                                        Diag *diag);
/* End the last step at a zero of an event's condition, and continue from there; likewise. */
MUST_USE Status integration_meet_event(Integration *m, int condition, double when, bool *again,
                                       Diag *diag);

#endif
