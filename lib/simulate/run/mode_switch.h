/* mode_switch.h: runs of models with ideal switches: from one phase to the next */
#ifndef COTREE_SIMULATE_RUN_MODE_SWITCH_H
#define COTREE_SIMULATE_RUN_MODE_SWITCH_H

#include "simulate/run/active_run.h"
#include "simulate/run/impact.h"

typedef struct ModeSwitching {
    ActiveRun *run;
    const SimulationInput *setting;
    Control control; /* of the run, with its span */
    double stuck;    /* where it was looked at last; NAN */
    bool changed;    /* whether something changed there, */
    double again;    /* how much further it was looked there, */
    double told;     /* and past what was told */
    ImpactTallies impacts;
    double *y; /* of the last phase that was entered; free it with mode_switching_free() */
} ModeSwitching;
void mode_switching_free(ModeSwitching *switching);
/* the NextSegment of a plan; `context` is a ModeSwitching */
MUST_USE Status mode_switch(void *context, double t, double behind, Nearness near, const double *y,
                            Segment *segment, const double **out, Diag *diag);

#endif
