/* shifted.h: the linear systems of implicit one-step methods, (s - J) d = b with J = df/dy (n x n)
 *
 * Three cases. Dense, with J from the problem or by differences. In Hessenberg form, where the
 * equations are linear. Or with the equations F(t, w, w') = 0 of a network that supplies a sparse
 * dF/dw + c dF/dw': y' = J y solves the linearised equations, so that d is the part of w in (dF/dw
 * + s dF/dw') w = dF/dw' b; where there are few states, J is computed from them. A complex s is a
 * real system of twice the size. */
#ifndef COTREE_SIMULATE_INTEGRATE_SHIFTED_H
#define COTREE_SIMULATE_INTEGRATE_SHIFTED_H

#include "simulate/integrate/ode.h"

typedef struct Shifted Shifted;

/* New; borrows; free with shifted_free(). Its evaluations are added to `counts`. */
Shifted *shifted_new(const Ode *ode, Counts *counts);
void shifted_free(Shifted *shifted); /* NULL is fine */
/* J at (t, y), where `rate` is y'. False: f is undefined nearby. */
bool shifted_differentiate(Shifted *shifted, double t, const double *y, const double *rate);
/* J at (t, y) into out, rows of y' by n. The J of shifted_differentiate() and its factors are
 * unchanged. False: f is undefined nearby, or J isn't dense. */
bool shifted_jacobian(Shifted *shifted, double t, const double *y, const double *rate, double *out);
/* whether J is the same at any later time until a restart, and f(t, y) = J y + f(t, 0) */
bool shifted_is_linear(const Shifted *shifted);
/* Factor for a real shift, and for alpha - i beta. False: singular. */
bool shifted_factor(Shifted *shifted, double shift, double alpha, double beta);
/* The first n of b become the solution; the second solves the complex system b + i c. */
void shifted_solve(Shifted *shifted, double *b);
void shifted_solve_pair(Shifted *shifted, double *b, double *c);

#endif
