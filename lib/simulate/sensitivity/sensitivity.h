/* sensitivity.h: derivatives of variables along a run by parameters
 *
 * The run is integrated again with its variational equations (variational.h), from the derivative
 * of its start on. Where its equations or its state jump at an instant t* that depends on p, S
 * jumps (sensitivity_jump.c):
 *
 *     g(t*, y, p) = 0,   dt* / dp = -(g_y S + g_p) / (g_t + g_y f-)
 *     y+ = R(t*, y-, p):   S+ = R_y (S- + f- dt*) + R_p + R_t dt* - f+ dt*
 *
 * A driven run is not integrated: constraints alone determine S. */
#ifndef COTREE_SIMULATE_SENSITIVITY_SENSITIVITY_H
#define COTREE_SIMULATE_SENSITIVITY_SENSITIVITY_H

#include "simulate/run/result_reader.h"
#include "simulate/sensitivity/variational.h"

typedef struct SensitivityOrder {
    SensitivityParameters by;
    /* derivatives of (q, u, x, references) at the start by each parameter, times its size: column
     * by column */
    const double *start;
    const Event *const *events; /* of the run */
    int event_count;
    const CallMonitor *watch;
} SensitivityOrder;

/* the number of entries of (q, u, x, references) at the start, and these: borrowed */
int result_reader_start(const ResultReader *reader, const double **y);

/* Derivatives of expressions over variables at these instants, ascending: out is times x items x
 * parameters. Where an instant is there twice, the first is just before a jump there. E_VALUE
 * outside the run, E_MODEL where there are no such derivatives, naming why; E_SOLVER, E_STOPPED.
 * O(parameters) times the cost of the run up to the last instant. */
MUST_USE Status sensitivity_find(ResultReader *reader, const SensitivityOrder *order,
                                 const Expr *items, int item_count, const double *times,
                                 int time_count, double *out, Diag *diag);

#endif
