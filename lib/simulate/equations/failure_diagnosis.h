/* failure_diagnosis.h: why equations have no solution at a state, in terms of the user's parts */
#ifndef COTREE_SIMULATE_EQUATIONS_FAILURE_DIAGNOSIS_H
#define COTREE_SIMULATE_EQUATIONS_FAILURE_DIAGNOSIS_H

#include "simulate/equations/compiled_equations.h"

/* Find a cause at y: what is beyond a limit, a part whose two frames coincide, or a coordinate that
 * moves no mass. Where there is one, set the message (`what` and the cause) and the hint. Borrows
 * all. */
bool failure_diagnose(const VariableIndex *layout, Parameters *parameters, double t,
                      const double *y, const char *what, Diag *diag);
/* A unilateral part beyond its limit at y: it has no effort there. */
bool failure_beyond(const VariableIndex *layout, Parameters *parameters, double t, const double *y,
                    const char *what, Diag *diag);
/* only the first of these causes */
bool failure_meeting(const VariableIndex *layout, Parameters *parameters, double t, const double *y,
                     const char *what, Diag *diag);

/* Likewise for a part whose two frames come together within `time` at the rates of y. */
bool failure_closing(const VariableIndex *layout, Parameters *parameters, double t, const double *y,
                     const double *rate, double time, const char *what, Diag *diag);

/* The part of a driver's row that is linearly independent of the other constraint rows, in the
 * row's own unit: it vanishes where the driver comes to the end of its range. The equations have to
 * be up to date at the place. */
double failure_own_part(const VariableIndex *layout, const Equations *equations, int driver);
/* Set message and hint: which joints that driver moves too far. */
void failure_leading(const VariableIndex *layout, const Equations *equations, int driver,
                     const char *what, Diag *diag);

#endif
