/* events_impl.h: what the files of events share */
#ifndef COTREE_SIMULATE_RUN_EVENTS_IMPL_H
#define COTREE_SIMULATE_RUN_EVENTS_IMPL_H

#include "base/memory.h"
#include "base/text.h"
#include "simulate/assemble/reinitialise.h"
#include "simulate/run/events.h"

/* one comparison a < b: its difference, and what stands for it in a formula */
typedef struct Condition {
    Expr comparison;
    Expr difference;
    Expr symbol;
    double largest;
} Condition;

/* how an event has fared */
typedef struct Course {
    bool is_known; /* whether it holds: it was looked at */
    bool from_start, holds, ended;
    bool is_resumed; /* an earlier run told how it began */
    LIST(double) times;
    int earlier;               /* times that an earlier run brought */
    double last, gap, longest; /* of times, and pauses between them */
    int faster, packed;
    bool accumulates; /* ever faster, and its guard could be held */
    bool settles;     /* it has come to the limit: its guard is to be held from here on, */
    bool is_held;     /* or is held, and it can't happen */
    int rests;        /* number of times that it came to rest, */
    double rest;      /* s: the last time, */
    double left;      /* and until then; INFINITY */
} Course;

typedef struct EventItem {
    const char *name, *condition;
    EventAction action;
    bool is_bound; /* it watches where the law of a part ends */
    bool is_live;  /* the model has it still */
    Expr when;     /* over the layout's symbols */
    Expr formula;  /* over the symbols of conditions */
    Expr guard;    /* what its series may come to rest on (system_rest_guard()); NULL */
    int surface;   /* on which the equations hold that; -1: none */
    int first_value, value_count;
    const char
        *refused; /* why ideal switches, as they are, let no values be given; NULL: they do */
    Course course;
} EventItem;

struct Events {
    EventsPlan plan;
    Pool *pool;
    LIST(EventItem) items;
    LIST(Condition) conditions; /* time-only ones first, once all are read */
    int time_only;
    bool follows_time; /* whether any other changes with t alone */
    LIST(Expr) values; /* right-hand sides, in order of the items */
    double *targets;   /* one a value; NAN: leave */
    Reinit *reinit;
    Probe *time, *state; /* differences */
    Probe *holding;      /* conditions of items as they stand */
    Probe *right;        /* values */
    bool solved;         /* whether any of these needs accelerations or the network's unknowns */
    double *y[3];        /* places to look ahead */
    double *rate;
    double *here[3];
};

/* (events_series.c) The event's series ends at t: it settles there, or E_SOLVER. */
MUST_USE Status events_end_series(EventItem *item, double t, Diag *diag);
/* It happens at t: ever sooner, so that it settles, or that its instants add up to one, or without
 * a pause at all, in a run of `span`: E_SOLVER. */
MUST_USE Status events_note_pace(EventItem *item, double t, double span, Diag *diag);
/* whether its pauses have become so short that rounding may decide where its values lead */
bool events_is_at_rounding(const EventItem *item);

const char *events_store(Events *events, const char *text); /* a copy in the pool */

#endif
