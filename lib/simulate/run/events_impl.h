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
} Course;

typedef struct EventItem {
    const char *name, *condition;
    EventAction action;
    bool is_bound; /* it watches where the law of a part ends */
    bool is_live;  /* the model has it still */
    Expr when;     /* over the layout's symbols */
    Expr formula;  /* over the symbols of conditions */
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

const char *events_store(Events *events, const char *text); /* a copy in the pool */

#endif
