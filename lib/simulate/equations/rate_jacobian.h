/* rate_jacobian.h: derivatives of a motion's rates by its state, exactly
 *
 * A state w = (q, u, x) determines e = (u', lambda, x', z) by the equations E(w, e) = 0 (rows.h).
 * Hence E_e de = -E_w dw: one sparse factorisation, and one solution for each entry of w. The
 * program of E computes its derivatives by forward differentiation (compile/jacobian.h); it is made
 * when they are first needed. */
#ifndef COTREE_SIMULATE_EQUATIONS_RATE_JACOBIAN_H
#define COTREE_SIMULATE_EQUATIONS_RATE_JACOBIAN_H

#include "simulate/equations/motion.h"
#include "simulate/equations/parameters.h"
#include "simulate/equations/variable_index.h"

typedef struct RateJacobian RateJacobian;

/* New; free with rate_jacobian_free(). Borrows all. */
RateJacobian *rate_jacobian_new(const VariableIndex *layout, Parameters *parameters,
                                Motion *motion);
/* The same, also by these `count` symbols, which are parameters or the time; copied. It belongs to
 * the layout's mode: signs of surfaces that the motion slides along are unknowns too, after those
 * of e, and slip is one more equation each. */
RateJacobian *rate_jacobian_new_by(const VariableIndex *layout, Parameters *parameters,
                                   Motion *motion, const Expr *others, int count);
void rate_jacobian_free(RateJacobian *jacobian);          /* NULL is fine */
int rate_jacobian_unknowns(const RateJacobian *jacobian); /* number of entries of e */
/* As of an Ode: derivatives of all rates at (t, y), also of quadratures. False where they are not
 * available: on a surface that the motion slides along, near a singular position, where a network
 * reads multipliers of redundant rows. O((states + unknowns) times instructions / batch size), and
 * one solution per state. The context is the RateJacobian. */
bool rate_jacobian_at(void *context, double t, const double *y, double *out);
/* The same, by the n entries of y that rates are of and then by the other symbols: `out` has n + 1
 * rows of n + count. `follow`, unless it is NULL, gets the derivatives of e: as many columns. */
bool rate_jacobian_by_others(RateJacobian *jacobian, double t, const double *y, double *out,
                             double *follow);

#endif
