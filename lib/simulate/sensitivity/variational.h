/* variational.h: the variational equations of a phase, as an Ode
 *
 *     y' = f(t, y, p),   S' = f_y S + f_p,   S = dy/dp
 *
 * y is integrated together with S, whose columns are in the error test: one for each parameter,
 * multiplied by the parameter's size, so that an entry has the unit and about the size of its y.
 * The derivatives of f are exact (rate_jacobian.h). Constraints hold for S as they do for y:
 *
 *     Phi_q S_q + Phi_p = 0,   (Phi_u u - nu)_q S_q + Phi_u S_u + (Phi_u u - nu)_p = 0 */
#ifndef COTREE_SIMULATE_SENSITIVITY_VARIATIONAL_H
#define COTREE_SIMULATE_SENSITIVITY_VARIATIONAL_H

#include "simulate/run/phase.h"

/* The parameters that a user differentiates by, and what they move. Borrowed. */
typedef struct SensitivityParameters {
    int count;
    const double *sizes; /* count: a change of each that counts as 1, in its unit */
    int symbol_count;
    const Expr *symbols;   /* parameters of the equations that depend on them */
    const double *weights; /* symbol_count x count: derivative of each by each */
} SensitivityParameters;

typedef struct Variational Variational;

/* New; borrows the phase, which is entered and open, and the parameters; variational_free(). */
MUST_USE Status variational_new(Phase *phase, Parameters *parameters,
                                const SensitivityParameters *by, Variational **out, Diag *diag);
void variational_free(Variational *variational); /* NULL is fine */
/* Its unknowns: y without work (variational_states()), then S times sizes, column by column. */
const Ode *variational_ode(const Variational *variational);
int variational_states(const Variational *variational);
/* y', its length that of y; false: undefined there */
bool variational_rate(Variational *variational, double t, const double *unknowns, double *rate);
/* The derivatives of what the state determines, (u', lambda, x', z): unknowns x count, times sizes.
 * Borrowed, until the next call. NULL: not available there. */
const double *variational_solved(Variational *variational, double t, const double *unknowns);
/* Move S onto the constraints. */
bool variational_project(Variational *variational, double t, double *unknowns);

#endif
