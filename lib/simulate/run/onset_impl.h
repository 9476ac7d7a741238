/* onset_impl.h: the search for onsets as its files share it: onset.c asks before and behind a step,
 * onset_elements.c looks for what conducts, onset_sources.c for what sources do unseen, each by
 * halving intervals (onset_search.c)
 *
 * An element acts from u = ln(AIM / (h effect)) on, u = ln N its size: the logarithm makes a rough
 * effect good enough. */
#ifndef COTREE_SIMULATE_RUN_ONSET_IMPL_H
#define COTREE_SIMULATE_RUN_ONSET_IMPL_H

#include "simulate/run/onset.h"

#define ONSET_AIM       0.1  /* of the tolerance, in a step: that is to act */
#define ONSET_INTERVALS 2000 /* that a search may look at: where it ends a step has to end, too */

typedef struct Pulse {
    bool is_on;
    double from, first; /* it began here, with a step no longer than this, s; */
    double until;       /* it lasts to here, */
    double bound;       /* and steps are bounded so, s */
    double level;       /* of an element: its threshold then */
} Pulse;

struct Onset {
    StiffElements *stiff_elements;
    const Ode *ode;
    int elements, sources, length;
    /* about the start of a step */
    double t, h;
    bool is_open;    /* see onset_leave_open() */
    bool is_affine;  /* `at` is known there */
    bool is_first;   /* nothing has been looked at before */
    bool has_pulses; /* there are steep elements, or sources have bent within a step */
    Affine at;
    double *source_at; /* values of the sources */
    double *threshold, *effect;
    bool *conducts; /* elements over their thresholds, or nearly */
    double *leaks;  /* slopes of those that block; NAN: it has its own */
    double *slope, *scale;
    double *seen;    /* what the step's places see of each source, */
    double *seen_at; /* and where, s */
    double t_before; /* start of the step before; NAN: there is none */
    double clear;    /* up to here sources are straight enough for steps up to */
    double clear_step;
    double planned; /* no step that goes so far was cut short */
    double *onset;  /* where each source begins to act, foreseen; s */
    double *acting; /* by how much it does so there; INFINITY: nobody knows */
    double *rates;  /* two y' */
    Turns turns;
    void *context;
    int age;        /* of the effects, in steps */
    int64_t visits; /* of expressions, that are counted */
    Pulse *element_pulses, *source_pulses;
};

/* first time in (from, to] at which a quantity passes a level, upwards or downwards */
typedef struct OnsetSearch {
    Onset *o;
    /* above 0: it may have passed somewhere in the interval `over`; `sources` are all, or that one
     * which is searched for */
    double (*excess)(struct OnsetSearch *search, Range over, const Range *sources);
    double error_floor; /* this much below 0 is passed, at a point */
    int which;          /* element or source */
    double level, sign;
    int left;          /* intervals to go */
    bool is_of_source; /* `which` is one: nothing else is looked at */
} OnsetSearch;

/* Middles of what the sources are at t, in `source_at`. */
void onset_take_sources(Onset *onset, double t);

/* The first place in (from, to], halving from left to right, or INFINITY. Where intervals run out,
 * the end of the one that was being looked at: nothing has passed before it begins. */
double onset_first_place(OnsetSearch *search, double from, double to);

/* The pulse that begins at t and passes two levels until `end`: when it has risen, and when it is
 * over. */
Pulse onset_pulse(OnsetSearch *rise, OnsetSearch *fall, double t, double end, double steps);
/* One that outlasts what was foreseen goes on with twice the bound. */
void onset_pulse_prolong(Pulse *pulse, double t, double steps);
/* of steps from t on, by all that last there; INFINITY: none does */
double onset_pulse_bound(const Pulse *pulses, int count, double t);

/* Where the next element begins to conduct, at most `end`; *bound of the steps until then. */
double onset_next_conduction(Onset *onset, Stepper *stepper, double end, double *bound);
/* Whether elements have acted in the last step, on the way that led to where it is; *when. */
bool onset_has_conducted(Onset *onset, const Stepper *stepper, double *when);

/* Where the next source begins to do what no place of the step sees, at most `end`. */
double onset_next_unseen(Onset *onset, Stepper *stepper, double end);
/* A multistep or implicit method sees little of a source that turns within a step: how far it may
 * go, INFINITY where none bends so much. */
double onset_bend_bound(Onset *onset, double end);

#endif
