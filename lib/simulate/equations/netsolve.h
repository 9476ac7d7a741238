/* netsolve.h: x' and z of the network from G([x'; z], ...) = 0
 *
 * A linear network is solved at once, and a matrix that is constant is factored once. Others are
 * solved by Newton's method from the last solution, damped by the natural monotonicity test, which
 * no scaling of the equations changes; where that gets stuck, by the fall of the residual. */
#ifndef COTREE_SIMULATE_EQUATIONS_NETSOLVE_H
#define COTREE_SIMULATE_EQUATIONS_NETSOLVE_H

#include "simulate/equations/motion.h"

typedef struct NetSolve NetSolve;

NetSolve *netsolve_new(const Equations *equations); /* new; borrows; free with netsolve_free() */
void netsolve_free(NetSolve *solve);                /* NULL is fine */
/* At what position() and velocity() were told last. False: no solution was found. */
bool netsolve_find(NetSolve *solve);
/* [x'; z] of the last netsolve_find(); a start for the next one may be written here */
double *netsolve_values(NetSolve *solve);
/* The same solution of a linear network, less what `network_residual` at it says that rounding
 * left, by the factors there are. */
void netsolve_refine(NetSolve *solve);
/* after a failure: an unknown, counted in [x'; z], that no equation determines; -1: not known */
int netsolve_undetermined(const NetSolve *solve);

#endif
