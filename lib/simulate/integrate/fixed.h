/* fixed.h: shared by methods with fixed steps: the step loop and the error report
 *
 * Errors are not controlled. The ratio of a step's error to the tolerance is estimated and
 * reported. A step is shortened where its driver requests it, at switches, where an element begins
 * to act briefly, and where equations are undefined, but not step after step. */
#ifndef COTREE_SIMULATE_INTEGRATE_FIXED_H
#define COTREE_SIMULATE_INTEGRATE_FIXED_H

#include "simulate/integrate/ode.h"

typedef struct FixedStepper FixedStepper;
struct FixedStepper {
    Stepper base;
    int all;                /* entries of y */
    double *old, *old_rate; /* y and y' at the start of the last step */
    double *rate;           /* y' at its end */
    double step_before;     /* length of the step before, s; 0: there was none */
    const char *reason;     /* why advance() failed, if known */
    int cuts;               /* steps in succession that had to be shorter */
    /* One step h from old at base.before: sets y at `end`, projected, base.t and rate. False: it
     * can't. */
    bool (*advance)(FixedStepper *f, double h, double end);
    /* the error of y_i in the last step, of length h */
    double (*error)(const FixedStepper *f, double h, int i);
    /* stores what the next step needs of the last one; NULL: nothing more */
    void (*keep)(FixedStepper *f);
};

/* called first by a method's create(), which then sets the functions */
void fixed_init(FixedStepper *f, const Method *method, const Ode *ode, const Control *control);

/* functions for rows of Method */
MUST_USE Status fixed_start(Stepper *stepper, double t, const double *y, Diag *diag);
MUST_USE Status fixed_step(Stepper *stepper, double end, Diag *diag);
MUST_USE Status fixed_shorten(Stepper *stepper, double t, Diag *diag);
bool fixed_slope(Stepper *stepper, double *rate);

#endif
