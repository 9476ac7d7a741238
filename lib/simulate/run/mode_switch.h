/* mode_switch.h: runs of models with ideal switches: from one phase to the next */
#ifndef COTREE_SIMULATE_RUN_MODE_SWITCH_H
#define COTREE_SIMULATE_RUN_MODE_SWITCH_H

#include "simulate/run/active_run.h"

/* The phase that a run starts in, and `begin`, from the start of its result, which is of the whole.
 * Fails where the ideal switches have no mode at the start, and where the network has no solution.
 */
MUST_USE Status mode_switch_begin(ActiveRun *run, const Setting *setting, Diag *diag);

/* The phase of this mode, a side an ideal switch; made where it is met first. */
MUST_USE Status mode_switch_phase(ActiveRun *run, const Setting *setting, const bool *closed,
                                  Phase **out, Diag *diag);

/* The phase of a system in this mode of its switches (NULL: in none), that stays on sides of
 * surfaces. */
MUST_USE Status mode_switch_phase_on(ActiveRun *run, const Setting *setting, System *system,
                                     const bool *closed, const OnSurface *on, int count,
                                     Phase **out, Diag *diag);
/* `events`, which go on in another phase; NULL: there are none */
MUST_USE Status mode_switch_events(ActiveRun *run, const Phase *now, const Phase *next,
                                   const Setting *setting, Events **events, Diag *diag);

typedef struct ModeSwitching {
    ActiveRun *run;
    const Setting *setting;
    Control control; /* of the run, with its span */
    double stuck;    /* where it was looked at last; NAN */
    bool changed;    /* whether something changed there, */
    double again;    /* how much further it was looked there, */
    double told;     /* and past what was told */
    double *y;       /* of the last phase that was entered; free it with mode_switching_free() */
} ModeSwitching;
void mode_switching_free(ModeSwitching *switching);
/* the NextSegment of a plan; `context` is a ModeSwitching */
MUST_USE Status mode_switch(void *context, double t, double behind, Nearness near, const double *y,
                            Segment *segment, const double **out, Diag *diag);

#endif
