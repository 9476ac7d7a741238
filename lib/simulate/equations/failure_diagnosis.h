/* failure_diagnosis.h: why equations have no solution at a place, in words of the user's parts */
#ifndef COTREE_SIMULATE_EQUATIONS_FAILURE_DIAGNOSIS_H
#define COTREE_SIMULATE_EQUATIONS_FAILURE_DIAGNOSIS_H

#include "simulate/equations/compiled_equations.h"

/* Set message (`what` and the cause) and hint where a cause is found at y: a part whose two frames
 * stand at the same point, a coordinate that moves nothing of mass. Borrows all. */
bool failure_diagnose(const VariableIndex *layout, Parameters *parameters, double t,
                      const double *y, const char *what, Diag *diag);
/* the first of these causes alone */
bool failure_meeting(const VariableIndex *layout, Parameters *parameters, double t, const double *y,
                     const char *what, Diag *diag);

/* Likewise a part whose two frames come together within `time` at the rates of y. */
bool failure_closing(const VariableIndex *layout, Parameters *parameters, double t, const double *y,
                     const double *rate, double time, const char *what, Diag *diag);

/* How much of a driver's row the other constraint rows don't say, in its own unit: it vanishes
 * where the driver comes to the end of its loop. Equations as they are at the place. */
double failure_own_part(const VariableIndex *layout, const Equations *equations, int driver);
/* Set message and hint: which joints that driver leads too far. */
void failure_leading(const VariableIndex *layout, const Equations *equations, int driver,
                     const char *what, Diag *diag);

#endif
