/* active_run.h: a run while it proceeds: its result, and the data that produce it */
#ifndef COTREE_SIMULATE_RUN_ACTIVE_RUN_H
#define COTREE_SIMULATE_RUN_ACTIVE_RUN_H

#include "simulate/assemble/mode_search.h"
#include "simulate/run/phases.h"
#include "simulate/run/result_impl.h"

typedef struct Shares Shares;

typedef struct ActiveRun {
    RunKind kind;
    System *system; /* of the whole model */
    Result *result; /* the rows and the report so far */
    Phases *phases;
    Phase *phase;            /* the phase of the start */
    double *begin;           /* y there */
    Events *events;          /* NULL: none */
    ModeSearch *mode_search; /* NULL: there are no ideal switches */
    Probe *energies;         /* made before the run; NULL: not yet, or used up */
    const Phase *energies_of;
    Shares *shares; /* of stored energy, where switches connect parts; NULL: none yet */
} ActiveRun;

/* New: an empty result, no phases yet. */
ActiveRun *active_run_new(RunKind kind, System *system, const SimulationInput *setting);
void active_run_free(ActiveRun *run); /* NULL is fine */
/* The finished result, and a reader with the phases (NULL: not wanted); frees the rest. */
void active_run_finish(ActiveRun *run, Result **out, ResultReader **reader);

/* Make the solvers of a phase's equations, for the start and the setting; fails as phases_open()
 * does. */
MUST_USE Status active_run_open_phase(ActiveRun *run, Phase *phase, const SimulationInput *setting,
                                      Diag *diag);
/* New: the setting's events in the equations of a phase, which continue earlier records. NULL where
 * there are none. */
MUST_USE Status active_run_events(ActiveRun *run, const Phase *phase, const EventRecord *earlier,
                                  int earlier_count, const SimulationInput *setting, Events **out,
                                  Diag *diag);
/* add a row of the phase of the start */
void active_run_add_row(ActiveRun *run, double t, const double *y);
/* Compile the energy balance of the first phase before the run, so that a cancelled run has it. */
MUST_USE Status active_run_prepare(ActiveRun *run, Diag *diag);
/* Compute the energy balance over the rows, into the report. */
MUST_USE Status active_run_balance(ActiveRun *run, Diag *diag);

#endif
