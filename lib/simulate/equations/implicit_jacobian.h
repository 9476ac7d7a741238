/* implicit_jacobian.h: derivatives of a motion's implicit equations, exactly
 *
 * F(t, w, w') with w = (y, L, M), L' = lambda, M' = mu (motion_implicit.c): dF/dw + c dF/dw', in
 * the entries that may not be 0. One program of all rows computes the derivatives by forward
 * differentiation (compile/jacobian.h). G = 0 determines the network's [x'; z] from the rest:
 * entries that come through it need one factorisation of dG/d[x'; z] and one solution for each
 * unknown that G reads. Two groups of entries are omitted: derivatives of work', which no other
 * equation reads, and derivatives of the factor of mu, since mu is 0 within errors. */
#ifndef COTREE_SIMULATE_EQUATIONS_IMPLICIT_JACOBIAN_H
#define COTREE_SIMULATE_EQUATIONS_IMPLICIT_JACOBIAN_H

#include "simulate/equations/motion.h"
#include "simulate/equations/parameters.h"
#include "simulate/equations/variable_index.h"

typedef struct ImplicitSlopes ImplicitSlopes;

/* New; free with implicit_jacobian_free(). Borrows all. */
ImplicitSlopes *implicit_jacobian_new(const VariableIndex *layout, Parameters *parameters,
                                      Motion *motion);
void implicit_jacobian_free(ImplicitSlopes *jacobian); /* NULL is fine */
/* Pattern as of a motion's ImplicitJacobian. The count is -1, and there is no Jacobian, where the
 * motion slides along surfaces, where a network reads multipliers of redundant rows, and where the
 * program would become too large. O(instructions times colours / batch size), networks aside. */
int implicit_jacobian_pattern(void *context, const int **row, const int **column);
bool implicit_jacobian_at(void *context, double t, double c, const double *w, const double *w_rate,
                          double *out);

#endif
