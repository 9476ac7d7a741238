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
/* Continue behind a crossing: S from before it, which the pass has reached. */
MUST_USE Status sensitivity_jump(SensitivityPass *pass, int crossing, Diag *diag);

#endif
