/* sensitivity_impl.h: a pass along a run, shared by the files of sensitivities */
#ifndef COTREE_SIMULATE_SENSITIVITY_SENSITIVITY_IMPL_H
#define COTREE_SIMULATE_SENSITIVITY_SENSITIVITY_IMPL_H

#include "simulate/run/result_reader_impl.h"
#include "simulate/sensitivity/item_slopes.h"
#include "simulate/sensitivity/sensitivity.h"

typedef struct SensitivityPass {
    ResultReader *reader;
    const SensitivityOrder *order;
    const Expr *items; /* over variables */
    int item_count;
    const double *times;
    int time_count, next; /* the next of them */
    double *out;
    Phase *phase; /* of the present segment */
    Variational *variational;
    ItemSlopes *slopes;
    double t;
    double *unknowns; /* y, then S times sizes */
} SensitivityPass;

/* Open the phase of that number, with room for its unknowns. */
MUST_USE Status sensitivity_open(SensitivityPass *pass, int phase, Diag *diag);
void sensitivity_close(SensitivityPass *pass);
/* The state just before a crossing. */
typedef struct CrossingPoint {
    double t;
    int n;                  /* of y without work */
    const double *unknowns; /* y-, S- times sizes, column by column */
    const double *rate;     /* f- */
    const double *instants; /* derivatives of t*, times sizes */
} CrossingPoint;

/* Derivatives of the state after an event's new values along each parameter, times sizes: n x
 * parameters, column by column. `after` is that state in the run. E_MODEL where it has none. */
MUST_USE Status sensitivity_new_values(SensitivityPass *pass, const CrossingPoint *at,
                                       const double *after, double *out, Diag *diag);
/* Continue after a crossing: S from before it, which the pass has reached. */
MUST_USE Status sensitivity_jump(SensitivityPass *pass, int crossing, Diag *diag);

#endif
