/* shifted.h: the linear systems of implicit one-step methods, (s - J) d = b with J = df/dy
 *
 * Dense, in a Hessenberg form where the equations are linear, J as the problem tells it or by
 * differences; or, of a network that offers its equations F(t, w, w') = 0 with a sparse dF/dw + c
 * dF/dw', by those: y' = J y solves the linearised equations, so that d is the part of w in (dF/dw
 * + s dF/dw') w = dF/dw' b, and J, where there are few states, what they give y' by each. A complex
 * s is a real system of twice the size.
 */
#ifndef COTREE_SIMULATE_INTEGRATE_SHIFTED_H
#define COTREE_SIMULATE_INTEGRATE_SHIFTED_H

#include "simulate/integrate/ode.h"

typedef struct Shifted Shifted;

/* New; borrows; free with shifted_free(). `counts` gets the evaluations that it makes. */
Shifted *shifted_new(const Ode *ode, Counts *counts);
void shifted_free(Shifted *shifted); /* NULL is fine */
/* J at (t, y), where `rate` is y'. False: f is undefined nearby. */
bool shifted_differentiate(Shifted *shifted, double t, const double *y, const double *rate);
/* J at (t, y) into out, rows of y' by n, which stays the caller's: what was differentiated and
 * factored before stays. False: f is undefined nearby, or J isn't dense. */
bool shifted_jacobian(Shifted *shifted, double t, const double *y, const double *rate, double *out);
/* whether that is J at any later time, too, until a restart, and f(t, y) = J y + f(t, 0) */
bool shifted_is_linear(const Shifted *shifted);
/* Factor for a real shift, and for alpha - i beta. False: singular. */
bool shifted_factor(Shifted *shifted, double shift, double alpha, double beta);
/* The first n of b become the solution; of the complex system b + i c. */
void shifted_solve(Shifted *shifted, double *b);
void shifted_solve_pair(Shifted *shifted, double *b, double *c);

#endif
