/* causes.h: why equations have no solution at a place, in words of the user's parts */
#ifndef COTREE_SIMULATE_EQUATIONS_CAUSES_H
#define COTREE_SIMULATE_EQUATIONS_CAUSES_H

#include "simulate/equations/numbers.h"

/* Set message (`what` and the cause) and hint where a cause is found at y: a part whose two frames
 * stand at the same point, a coordinate that moves nothing of mass. Borrows all. */
bool cause_tell(const Layout *layout, Parameters *parameters, double t, const double *y,
                const char *what, Diag *diag);
/* the first of these causes alone */
bool cause_meeting(const Layout *layout, Parameters *parameters, double t, const double *y,
                   const char *what, Diag *diag);

/* Likewise a part whose two frames come together within `time` at the rates of y. */
bool cause_closing(const Layout *layout, Parameters *parameters, double t, const double *y,
                   const double *rate, double time, const char *what, Diag *diag);

/* How much of a driver's row the other constraint rows don't say, in its own unit: it vanishes
 * where the driver comes to the end of its loop. Equations as they are at the place. */
double cause_own_part(const Layout *layout, const Equations *equations, int driver);
/* Set message and hint: which joints that driver leads too far. */
void cause_leading(const Layout *layout, const Equations *equations, int driver, const char *what,
                   Diag *diag);

#endif
