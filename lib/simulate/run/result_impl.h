/* result_impl.h: a result, as what integrates fills it and a reader reads it */
#ifndef COTREE_SIMULATE_RUN_RESULT_IMPL_H
#define COTREE_SIMULATE_RUN_RESULT_IMPL_H

#include "base/memory.h"
#include "simulate/assemble/initial.h"
#include "simulate/run/integration.h"
#include "simulate/run/phases.h"
#include "simulate/run/result.h"

/* the equations of some of its rows: phase_new_on() makes a phase of them again */
typedef struct PhaseKey {
    System *system; /* of the mode: borrowed, as that of the result is */
    bool *closed;   /* sides of the whole's switches; NULL: it is in no mode */
    OnSurface *on;
    int on_count;
    bool is_open; /* rows may be of it */
} PhaseKey;

struct Result {
    RunKind kind;
    System *system;        /* the whole */
    Parameters parameters; /* as the run had them; later questions may bring in others */
    LIST(PhaseKey) phases; /* as those of the run */
    int first;             /* phase in which it starts */
    int freedoms;
    Manner manner;   /* its arrays are the result's, but for the watch, which is NULL */
    Assembled start; /* of the whole */
    double tolerance;
    Grid grid;    /* rows of y */
    Grid corners; /* where phases end and begin, two rows each */
    Jumps jumps;  /* where its equations change at times of their own */
    Driven driven;
    LIST(EventRecord) events;
    Pool *pool; /* of names and times in these; NULL: there are none */
    RunReport monitor_report;
    Remarks remarks;
};

#endif
