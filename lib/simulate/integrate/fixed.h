/* fixed.h: what methods of fixed steps share: the way from step to step, and what they tell
 *
 * No error is controlled; how far a step misses the tolerance is estimated, and told. A step is cut
 * where its driver asks for it, at switches, where something begins to act for a short time, and
 * where equations have no value: but not one after the other. */
#ifndef COTREE_SIMULATE_INTEGRATE_FIXED_H
#define COTREE_SIMULATE_INTEGRATE_FIXED_H

#include "simulate/integrate/ode.h"

typedef struct FixedStepper FixedStepper;
struct FixedStepper {
    Stepper base;
    int all;                /* entries of y */
    double *old, *old_rate; /* y and y' where the last step began */
    double *rate;           /* y' at its end */
    double last;            /* length of the step before, s; 0: there is none */
    const char *reason;     /* why advance() failed, if it knows */
    int cuts;               /* steps on end that had to be shorter */
    /* One step from old at base.before over h: leaves y at `end`, projected, base.t and rate.
     * false: it can't. */
    bool (*advance)(FixedStepper *f, double h, double end);
    /* the error of y_i in the last step, of length h */
    double (*error)(const FixedStepper *f, double h, int i);
    /* what the next step wants to know of the last one; NULL: nothing more */
    void (*keep)(FixedStepper *f);
};

/* what a method's create() begins with, behind which it sets the functions */
void fixed_init(FixedStepper *f, const Method *method, const Ode *ode, const Control *control);

/* rows of a Method */
MUST_USE Status fixed_start(Stepper *stepper, double t, const double *y, Diag *diag);
MUST_USE Status fixed_step(Stepper *stepper, double end, Diag *diag);
MUST_USE Status fixed_shorten(Stepper *stepper, double t, Diag *diag);
bool fixed_slope(Stepper *stepper, double *rate);

#endif
