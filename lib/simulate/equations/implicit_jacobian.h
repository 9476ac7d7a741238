/* implicit_jacobian.h: derivatives of a motion's implicit equations, exactly
 *
 * F(t, w, w') with w = (y, L, M), L' = lambda, M' = mu (motion_implicit.c): dF/dw + c dF/dw', in
 * the entries that may not be 0. Derivatives are carried through one program of all rows
 * (compile/jacobian.h). A network follows from the rest as G = 0 tells it: entries that come
 * through it are found by one factorisation of its own, and a solution for each unknown that it
 * reads. Left out are what work follows from, which steers nothing, and what mu, which is 0 but for
 * errors, is multiplied by. */
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
/* As of a motion's ImplicitJacobian. The pattern is -1, and there is no Jacobian, where surfaces
 * are slid along, where a network reads multipliers of redundant rows, and where the program would
 * become too large. O(instructions times colours / lanes), networks aside. */
int implicit_jacobian_pattern(void *jacobian, const int **row, const int **column);
bool implicit_jacobian_at(void *jacobian, double t, double c, const double *w, const double *w_rate,
                          double *values);

#endif
