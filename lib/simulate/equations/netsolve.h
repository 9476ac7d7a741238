/* netsolve.h: x' and z of the network from G([x'; z], ...) = 0
 *
 * A linear network is solved directly, A w = r, w = [x'; z] (nx + nz), and a constant matrix is
 * factored once. Others are solved by Newton's method from the last solution, damped by the natural
 * monotonicity test (Deuflhard 1974), which is invariant to scaling of the equations. Where that
 * stagnates, damping is by the decrease of the residual; last comes source stepping. */
#ifndef COTREE_SIMULATE_EQUATIONS_NETSOLVE_H
#define COTREE_SIMULATE_EQUATIONS_NETSOLVE_H

#include "simulate/equations/motion.h"

typedef struct NetSolve NetSolve;

NetSolve *netsolve_new(const Equations *equations); /* new; borrows; free with netsolve_free() */
void netsolve_free(NetSolve *solve);                /* NULL is fine */
/* Solve at the state of the last position() and velocity(). False: no solution was found. */
bool netsolve_find(NetSolve *solve);
/* [x'; z] of the last netsolve_find(); an initial guess for the next one may be written here */
double *netsolve_values(NetSolve *solve);
/* Refine the solution of a linear network with the current factors: subtract A^-1 times its
 * `network_residual`, which is rounding error. */
void netsolve_refine(NetSolve *solve);
/* after a failure: an unknown, counted in [x'; z], that no equation determines; -1: not known */
int netsolve_undetermined(const NetSolve *solve);

#endif
