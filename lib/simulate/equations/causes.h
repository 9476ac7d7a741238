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

#endif
