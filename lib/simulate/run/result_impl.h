/* result_impl.h: a result, as a run fills it and a reader reads it */
#ifndef COTREE_SIMULATE_RUN_RESULT_IMPL_H
#define COTREE_SIMULATE_RUN_RESULT_IMPL_H

#include "base/memory.h"
#include "simulate/assemble/initial.h"
#include "simulate/run/integration.h"
#include "simulate/run/phases.h"
#include "simulate/run/result.h"

/* identifies the equations of some of its rows: a run that resumes has the same phases */
typedef struct PhaseKey {
    System *system; /* of the mode: borrowed, like that of the result */
    bool *closed;   /* states of the switches of the whole model; NULL: without modes */
    OnSurface *on;
    int on_count;
} PhaseKey;

struct Result {
    RunKind kind;
    System *system;        /* of the whole model */
    Parameters parameters; /* of the run; later queries may add others */
    LIST(PhaseKey) phases; /* in the order of the run's */
    int first;             /* number of the phase of the start */
    int freedoms;
    Assembled start; /* of the whole model */
    Grid grid;       /* ends and starts of phases, two rows each */
    Grid corners;    /* times at which its equations change by time alone */
    Crossings crossings;
    Jumps jumps; /* where its equations change at times of their own */
    Driven driven;
    LIST(EventRecord) events;
    Pool *pool; /* of names and times in these; NULL: none */
    RunReport monitor_report;
    Remarks remarks;
};

#endif
