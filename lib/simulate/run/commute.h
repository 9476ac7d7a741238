/* commute.h: results of models with ideal switches: from one phase to the next */
#ifndef COTREE_SIMULATE_RUN_COMMUTE_H
#define COTREE_SIMULATE_RUN_COMMUTE_H

#include "simulate/run/result.h"

/* The phase that a result starts in, and `begin`, from `start`, which is of the whole. Fails where
 * the ideal switches have no sides at the start, and where the network has no solution. */
MUST_USE Status commute_begin(Result *result, const Setting *setting, Diag *diag);

/* The phase of these sides, one an ideal switch; made where it is met first. */
MUST_USE Status commute_phase(Result *result, const Setting *setting, const bool *closed,
                              Phase **out, Diag *diag);

/* The phase that differs from another one by the sides of surfaces that it stays on. */
MUST_USE Status commute_phase_on(Result *result, const Setting *setting, const Phase *like,
                                 const OnSurface *on, int count, Phase **out, Diag *diag);
/* `events`, which go on in another phase; NULL: there are none */
MUST_USE Status commute_events(Result *result, const Phase *now, const Phase *next,
                               const Setting *setting, Events **events, Diag *diag);

typedef struct Commuting {
    Result *result;
    const Setting *setting;
    double span;  /* of the run, s */
    double stuck; /* where it was looked at last; NAN */
    bool changed; /* whether something changed there, */
    double again; /* and how much further it was looked */
    double *y;    /* of the last phase that was entered; free it with commuting_free() */
} Commuting;
void commuting_free(Commuting *commuting);
/* the Commute of a plan; `context` is a Commuting */
MUST_USE Status commute(void *context, double t, double behind, double last, const double *y,
                        Leg *leg, const double **out, Diag *diag);
/* the leg of a phase */
Leg commute_leg(const Result *result, const Phase *phase, Events *events);

#endif
