/* item_slopes.h: derivatives of expressions along the columns of S */
#ifndef COTREE_SIMULATE_SENSITIVITY_ITEM_SLOPES_H
#define COTREE_SIMULATE_SENSITIVITY_ITEM_SLOPES_H

#include "simulate/sensitivity/variational.h"

typedef struct ItemSlopes ItemSlopes;

/* New; borrows the phase and the parameters; item_slopes_free(). The roots are over the symbols of
 * the phase's layout. Fails as probe_new() does. */
MUST_USE Status item_slopes_new(Phase *phase, Parameters *parameters,
                                const SensitivityParameters *by, const Expr *roots, int count,
                                ItemSlopes **out, Diag *diag);
void item_slopes_free(ItemSlopes *slopes); /* NULL is fine */
/* Derivatives of the roots by the parameters at the unknowns of the Variational, count x
 * parameters, in their units. NAN where they are not known. */
void item_slopes_at(ItemSlopes *slopes, Variational *variational, double t, const double *unknowns,
                    double *out);

#endif
