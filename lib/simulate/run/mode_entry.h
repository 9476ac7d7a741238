/* mode_entry.h: a phase is entered: what is carried there from the one before
 *
 * Over an instant are carried coordinates, speeds, and the states of the whole: every mode tells
 * those, and its own states are some of them. */
#ifndef COTREE_SIMULATE_RUN_MODE_ENTRY_H
#define COTREE_SIMULATE_RUN_MODE_ENTRY_H

#include "simulate/run/active_run.h"

/* where a phase is entered, as its sides were found */
typedef struct Entering {
    double t, step;
    const bool *before; /* the sides that were */
    bool may_share;     /* else no state may jump: nothing was stored before */
    bool shared;        /* and that was done */
} Entering;

/* y of a phase (its length), `out`, from (q, u), states of the whole x, references of angles and
 * work, J */
void mode_entry(const Phase *phase, const double *y, const double *x, const double *references,
                double work, double *out);

/* What the states of the whole have to be in the phase that begins at (t, y), against x, what they
 * were: none may jump but those that share what they store, which y and x are set to. Fails with
 * E_SOLVER, naming the state that would. */
MUST_USE Status mode_entry_check(ActiveRun *run, Phase *phase, Entering *entry, double *y,
                                 double *x, Diag *diag);

/* whether the phase that begins at (t, y) can't have the states x of the whole */
bool mode_entry_jumps(const ActiveRun *run, Phase *phase, double t, double *y, const double *x);

#endif
