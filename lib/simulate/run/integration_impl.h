/* integration_impl.h: what the files of a forward run share: one Integration, from start to end */
#ifndef COTREE_SIMULATE_RUN_INTEGRATION_IMPL_H
#define COTREE_SIMULATE_RUN_INTEGRATION_IMPL_H

#include "base/memory.h"
#include "simulate/integrate/stagnation.h"
#include "simulate/run/integration.h"

/* what is known of surfaces where a run goes on */
enum MetSurface { ROOT_ANY = -1, ROOT_NONE = -2 };

/* how a motion goes to and fro through a surface */
typedef struct Chatter {
    int count;     /* times on end */
    double last;   /* s: the last one; */
    double first;  /* how long it was from one to the next at first, */
    double recent; /* and the longest of the last ones */
    bool settles;  /* it has become so fast that it rests there, for all that matters */
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
    Control control; /* as asked for */
    Counts earlier;  /* of steppers given up */
    StagnationMonitor stagnation;
    Jumps jumps;
    double low, high;             /* the time that rates see stays between */
    double *y, *slope;            /* one y, one y'; room for those of plan->in_time */
    double *conditions, *largest; /* values and largest sizes of conditions */
    int *mode;                    /* sign of each condition on this side of its next switch */
    int *looked_at, looked_count; /* by steps: those that aren't left out */
    double *band;                 /* sizes too small to tell a sign from, behind a switch, */
    double *noise;                /* and anywhere: of margins */
    double *band_ends;            /* s: the time from which on they tell by their noise; INFINITY */
    double *depth, *depth_low, *depth_high; /* of conditions in their modes, where one is located */
    int next_row, rows;
    double scanned;        /* of the last step, up to here conditions are followed */
    double *reach;         /* largest size of what is 0 on each surface of the segment, */
    Chatter *chatters;     /* through each of them; */
    int surfaces;          /* so many */
    int root;              /* condition whose surface is met; or a MetSurface */
    double ahead;          /* s: so long behind the margin that is met, that shows; 0 */
    bool has_restarted;    /* the stepper, behind a jump */
    int switches;          /* close together */
    double switched_since; /* the first of them */
    double missed;         /* largest estimated error of a fixed step, in tolerances */
    double missed_at;      /* s */
    bool is_stopped;       /* by who sees the rows */
    bool is_over;          /* an event has ended the run */
    bool needs_restart;    /* the last step, and its method has to start anew */
    bool after_event;      /* no step has been taken since a switch, */
    double initial_step;   /* which one of this length may follow, s; 0: not known */
} Integration;

/* --- rows (integration_rows.c) --- */

bool integration_add_row(Integration *m, double t);
/* whether the last row is at t, as far as rounding lets one tell */
bool integration_has_row(const Integration *m, double t);
/* rows of the output grid up to the stepper's time */
MUST_USE Status integration_add_rows(Integration *m, Diag *diag);
/* and those that rounding alone puts behind it, before something jumps there */
MUST_USE Status integration_add_rows_before(Integration *m, Diag *diag);
/* End the last step at t, inside it, as its interpolant has it there: with the rows before, and to
 * be started anew. */
MUST_USE Status integration_cut(Integration *m, double t, Diag *diag);
/* --- segments (integration_segment.c) --- */

Stepper *integration_new_stepper(Integration *m, const Method *method);
void integration_discard_stepper(Integration *m); /* its counts are kept */
void integration_open_segment(Integration *m,
                              const Segment *segment); /* what goes with its equations */
void integration_close_segment(Integration *m);
/* The segment that goes on where the stepper stands: not the last one where that is on surfaces
 * (*entered). */
MUST_USE Status integration_settle_surfaces(Integration *m, bool *entered, Diag *diag);
/* Start the stepper anew at (t, y): in another segment, where ideal switches go over to other sides
 * (*entered). */
MUST_USE Status integration_go_on(Integration *m, double t, const double *y, bool *entered,
                                  Diag *diag);

/* --- surfaces (integration_slide.c) --- */

/* what is 0 on a surface is so, as far as rounding lets one tell */
double integration_on_surface(const Integration *m, int condition);
/* conditions' modes on surfaces, and how large they get */
void integration_begin_surfaces(Integration *m);
void integration_reach(Integration *m);

/* --- surfaces that a motion goes through ever faster (integration_chatter.c) --- */

/* Condition i is met at t, and the surface that it tells of: whether that settles it is noted. */
void integration_note_chatter(Integration *m, int i, double t);
/* what is said where it does: call where the motion is still as it was */
void integration_report_settling(Integration *m, int i);

/* --- conditions of t alone (integration_jumps.c) --- */

/* in order of time, into m->jumps; E_SOLVER: there are too many to tell */
MUST_USE Status integration_find_jumps(Integration *m, Diag *diag);

/* --- conditions of the state (integration_switches.c) --- */

bool integration_is_of_event(const Integration *m, int condition);
int integration_state_conditions(const Integration *m); /* how many */
/* all conditions at (t, y), into m->conditions */
void integration_evaluate(Integration *m, double t, const double *y);
/* which conditions a step looks at, in a new segment */
void integration_choose_conditions(Integration *m);
/* whether one that isn't of t alone has another sign at (t, y) than the run; the Turns of an Onset
 */
bool integration_turns(void *integration, double t, const double *y);
/* signs of those of the equations where the stepper stands; those of events go on as they are */
void integration_begin_modes(Integration *m);
/* The first switch in the last step that isn't followed yet: its condition, and a time just behind
 * it; -1: none. */
int integration_find_switch(Integration *m, double *when);
/* g of a condition at the stepper's end, and how fast it changes along the motion */
double integration_condition_rate(Integration *m, int condition, double *value);
/* what says that the segment is the right one, as long as it is positive, */
bool integration_is_margin(const Integration *m, int condition);
double
integration_largest_margin(const Integration *m);    /* its largest size so far, of all of them, */
double integration_rounding(const Integration *m);   /* what rounding does to any, */
double integration_most_noise(const Integration *m); /* and the most that is taken for noise */
/* all conditions where the stepper's interpolant is at t, which goes into m->y */
void integration_conditions_at(Integration *m, double t);
/* Margins that are still negative where a segment begins, on their way up, tell nothing as long as
 * they fall no deeper. */
void integration_let_margins_rise(Integration *m);

/* --- events (integration_events.c) --- */

/* What comes of the sides that events' conditions have now, at t and y; *changed: new values. The
 * stepper is brought there, to be started anew. */
MUST_USE Status integration_take_events(Integration *m, double t, int *sides, bool *changed,
                                        Diag *diag);

/* conditions at the start, some of which may become true there */
MUST_USE Status integration_begin_events(Integration *m, Diag *diag);
/* the same in a segment that begins where the stepper stands; *changed: y has new values */
MUST_USE Status integration_resume_events(Integration *m, bool *changed, Diag *diag);
/* whether an event becomes true as the condition changes; if not, that is noted and no more */
bool integration_matters(Integration *m, int condition);
/* the same where conditions in time alone change, between two intervals */
MUST_USE Status integration_meet_time(Integration *m, Jump jump, Diag *diag);

/* --- met and crossed (integration_meet.c) --- */

/* End the last step at the switch, cross it, and start anew behind it. *again: taken again to get
 * there, the step has gone over others, which are first: look for them. That is told where it is
 * asked for. */
MUST_USE Status integration_meet_switch(Integration *m, int condition, double when, bool *again,
                                        Diag *diag);
/* End the last step where a condition of an event is zero, and go on from there; likewise. */
MUST_USE Status integration_meet_event(Integration *m, int condition, double when, bool *again,
                                       Diag *diag);

#endif
