/* rate_jacobian.h: derivatives of a motion's rates by its state, exactly
 *
 * What follows from a state w = (q, u, x), e = (u', lambda, x', z), solves the equations E(w, e) =
 * 0 (rows.h), so that a deviation gives E_e de = -E_w dw: one sparse factorisation, and a column
 * for each entry of w. Derivatives are carried through the program of E (compile/jacobian.h), which
 * is made when they are asked for first. */
#ifndef COTREE_SIMULATE_EQUATIONS_RATE_JACOBIAN_H
#define COTREE_SIMULATE_EQUATIONS_RATE_JACOBIAN_H

#include "simulate/equations/motion.h"
#include "simulate/equations/parameters.h"
#include "simulate/equations/variable_index.h"

typedef struct RateJacobian RateJacobian;

/* New; free with rate_jacobian_free(). Borrows all. */
RateJacobian *rate_jacobian_new(const VariableIndex *layout, Parameters *parameters,
                                Motion *motion);
void rate_jacobian_free(RateJacobian *jacobian); /* NULL is fine */
/* As of an Ode: derivatives of all rates at (t, y), those of quadratures too. False where it can't
 * tell them: on a surface that is slid along, near a singular position, where a network reads
 * multipliers of redundant rows. O((states + unknowns) times
 * instructions / lanes), and a solution a state. */
bool rate_jacobian_at(void *jacobian, double t, const double *y, double *out);

#endif
