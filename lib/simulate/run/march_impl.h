/* march_impl.h: what the files of a forward run share: one March, from start to end */
#ifndef COTREE_SIMULATE_RUN_MARCH_IMPL_H
#define COTREE_SIMULATE_RUN_MARCH_IMPL_H

#include "base/memory.h"
#include "simulate/integrate/headway.h"
#include "simulate/run/march.h"

/* what is known of surfaces where a run goes on */
enum Root { ROOT_ANY = -1, ROOT_NONE = -2 };

/* how a motion goes to and fro through a surface */
typedef struct Chatter {
    int count;     /* times on end */
    double last;   /* s: the last one; */
    double first;  /* how long it was from one to the next at first, */
    double recent; /* and the longest of the last ones */
    bool settles;  /* it has become so fast that it rests there, for all that matters */
} Chatter;

typedef struct March {
    const MarchPlan *plan;
    Leg leg;
    const Equations *eq; /* of the leg */
    Events *ev;
    int count;  /* conditions: those of the equations, then those of events */
    int length; /* of y in this leg */
    Grid *grid;
    MarchReport *out;
    Stepper *stepper;
    Control control; /* as asked for */
    Counts earlier;  /* of steppers given up */
    Headway headway;
    Jumps jumps;
    double low, high;             /* the time that rates see stays between */
    double *y, *slope;            /* one y, one y'; room for those of plan->in_time */
    double *conditions, *largest; /* values and largest sizes of conditions */
    int *mode;                    /* sign of each condition on this side of its next switch */
    double *band;                 /* sizes too small to tell a sign from, behind a switch, */
    double *noise;                /* and anywhere: of margins */
    double *depth, *depth_low, *depth_high; /* of conditions in their modes, where one is located */
    int next_row, rows;
    double scanned;        /* of the last step, up to here conditions are followed */
    double *reach;         /* largest size of what is 0 on each surface of the leg, */
    Chatter *chatters;     /* through each of them; */
    int surfaces;          /* so many */
    int root;              /* condition whose surface is met; or one of Root */
    int switches;          /* close together */
    double switched_since; /* the first of them */
    double missed;         /* largest estimated error of a fixed step, in tolerances */
    double missed_at;      /* s */
    bool is_over;          /* an event has ended the run */
    bool is_taken_back;    /* the last step, and its method has to start anew */
} March;

/* --- rows (march_rows.c) --- */

bool march_add_row(March *m, double t);
/* whether the last row is at t, as far as rounding lets one tell */
bool march_has_row(const March *m, double t);
/* rows of the output grid up to the stepper's time */
MUST_USE Status march_add_rows(March *m, Diag *diag);
/* End the last step at t, inside it, as its interpolant has it there: with the rows before, and to
 * be started anew. */
MUST_USE Status march_cut(March *m, double t, Diag *diag);
/* --- legs (march_leg.c) --- */

Stepper *march_new_stepper(March *m, const Method *method);
void march_give_up_stepper(March *m);          /* its counts are kept */
void march_open_leg(March *m, const Leg *leg); /* what goes with its equations */
void march_close_leg(March *m);
/* The leg that goes on where the stepper stands: not the last one where that is on surfaces
 * (*entered). */
MUST_USE Status march_settle_surfaces(March *m, bool *entered, Diag *diag);
/* Start the stepper anew at (t, y): in another leg, where ideal switches go over to other sides
 * (*entered). */
MUST_USE Status march_go_on(March *m, double t, const double *y, bool *entered, Diag *diag);

/* From here on other equations hold, with y for a state; *changed: events gave it new values. */
MUST_USE Status march_enter(March *m, const Leg *leg, double t, const double *y, bool *changed,
                            Diag *diag);

/* --- surfaces (march_slide.c) --- */

/* what is 0 on a surface is so, as far as rounding lets one tell */
double march_on_surface(const March *m, int condition);
/* conditions' modes on surfaces, and how large they get */
void march_begin_surfaces(March *m);
void march_reach(March *m);

/* --- surfaces that a motion goes through ever faster (march_chatter.c) --- */

/* Condition i is met at t, and the surface that it tells of: whether that settles it is noted. */
void march_note_chatter(March *m, int i, double t);
/* what is said where it does: call where the motion is still as it was */
void march_tell_settling(March *m, int i);

/* --- conditions of t alone (march_jumps.c) --- */

/* in order of time, into m->jumps; E_SOLVER: there are too many to tell */
MUST_USE Status march_find_jumps(March *m, Diag *diag);

/* --- conditions of the state (march_switches.c) --- */

bool march_is_of_event(const March *m, int condition);
int march_state_conditions(const March *m); /* how many */
/* all conditions at (t, y), into m->conditions */
void march_evaluate(March *m, double t, const double *y);
/* whether one that isn't of t alone has another sign at (t, y) than the run; the Turns of an Onset
 */
bool march_turns(void *march, double t, const double *y);
/* signs of those of the equations where the stepper stands; those of events go on as they are */
void march_begin_modes(March *m);
/* The first switch in the last step that isn't followed yet: its condition, and a time just behind
 * it; -1: none. */
int march_find_switch(March *m, double *when);
/* g of a condition at the stepper's end, and how fast it changes along the motion */
double march_condition_rate(March *m, int condition, double *value);
/* what says that the leg is the right one, as long as it is positive, */
bool march_is_margin(const March *m, int condition);
double march_largest_margin(const March *m); /* its largest size so far, of all of them */
/* all conditions where the stepper's interpolant is at t, which goes into m->y */
void march_conditions_at(March *m, double t);
/* Margins that are still negative where a leg begins, on their way up, tell nothing as long as they
 * fall no deeper. */
void march_let_margins_rise(March *m);

/* --- events (march_events.c) --- */

/* What comes of the sides that events' conditions have now, at t and y; *changed: new values. The
 * stepper is brought there, to be started anew. */
MUST_USE Status march_take_events(March *m, double t, int *sides, bool *changed, Diag *diag);

/* conditions at the start, some of which may become true there */
MUST_USE Status march_begin_events(March *m, Diag *diag);
/* the same in a leg that begins where the stepper stands; *changed: y has new values */
MUST_USE Status march_resume_events(March *m, bool *changed, Diag *diag);
/* whether an event becomes true as the condition changes; if not, that is noted and no more */
bool march_matters(March *m, int condition);
/* the same where conditions in time alone change, between two stretches */
MUST_USE Status march_meet_time(March *m, Jump jump, Diag *diag);

/* --- met and crossed (march_meet.c) --- */

/* End the last step at the switch, cross it, and start anew behind it. */
MUST_USE Status march_meet_switch(March *m, int condition, double when, Diag *diag);
/* E_SOLVER where switches come without a pause; `condition` is the last of them */
MUST_USE Status march_check_pace(March *m, int condition, Diag *diag);
/* End the last step where a condition of an event is zero, and go on from there. */
MUST_USE Status march_meet_event(March *m, int condition, double when, Diag *diag);

#endif
