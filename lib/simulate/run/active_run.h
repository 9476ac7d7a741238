/* active_run.h: a run as long as it goes: the result that it fills, and what fills it */
#ifndef COTREE_SIMULATE_RUN_ACTIVE_RUN_H
#define COTREE_SIMULATE_RUN_ACTIVE_RUN_H

#include "simulate/assemble/mode_search.h"
#include "simulate/run/phases.h"
#include "simulate/run/result_impl.h"

typedef struct Shares Shares;

typedef struct ActiveRun {
    RunKind kind;
    System *system; /* the whole */
    Result *result; /* what it has found so far */
    Phases *phases;
    Phase *phase;            /* in which it starts */
    double *begin;           /* y there */
    Events *events;          /* NULL: none */
    ModeSearch *mode_search; /* NULL: there are no ideal switches */
    Probe *energies;         /* made before it goes; NULL: not yet, or no more */
    const Phase *energies_of;
    Shares *shares; /* of what is stored, where switches join parts; NULL: none yet */
} ActiveRun;

/* New: a result of nothing, no phases yet. */
ActiveRun *active_run_new(RunKind kind, System *system, const SimulationInput *setting);
void active_run_free(ActiveRun *run); /* NULL is fine */
/* The result, finished, and a reader with the phases (NULL: nobody reads); frees the rest. */
void active_run_finish(ActiveRun *run, const SimulationInput *setting, Result **out,
                       ResultReader **reader);

/* What solves the equations of a phase, as the start and the setting ask for; fails as
 * phases_open() does. */
MUST_USE Status active_run_open_phase(ActiveRun *run, Phase *phase, const SimulationInput *setting,
                                      Diag *diag);
/* New, or NULL where there are none: the setting's events in the equations of a phase, going on
 * with what is recorded of earlier ones. */
MUST_USE Status active_run_events(ActiveRun *run, const Phase *phase, const EventRecord *earlier,
                                  int earlier_count, const SimulationInput *setting, Events **out,
                                  Diag *diag);
/* a row of the phase that it starts in */
void active_run_add_row(ActiveRun *run, double t, const double *y);
/* Before it goes, what its energy balance needs of the first phase: a run that is stopped has it.
 */
MUST_USE Status active_run_prepare(ActiveRun *run, Diag *diag);
/* Energy balance over the rows, into the report. */
MUST_USE Status active_run_balance(ActiveRun *run, Diag *diag);

#endif
