/* rows.h: the equations as symbolic residuals, and steps from them
 *
 *     balance        M u' + Phi_u^T lambda - F = 0     (nu)
 *     acceleration   Phi_u u' - gamma = 0              (m)
 *     velocity       Phi_u u - nu = 0                  (m)
 *     network        A [x'; z] - r = 0                 (nx + nz) */
#ifndef COTREE_SIMULATE_EQUATIONS_ROWS_H
#define COTREE_SIMULATE_EQUATIONS_ROWS_H

#include "simulate/equations/variable_index.h"

Expr row_balance(const VariableIndex *layout, int speed);
/* All nu of these; without M where a run needs no M. Fails with E_MEMORY. */
MUST_USE Status rows_balance(const VariableIndex *layout, Expr *out, Diag *diag);
/* q', then the rates of references (n, multi_turns). Fails with E_MEMORY. */
MUST_USE Status rows_kinematic(const VariableIndex *layout, Expr *out, Diag *diag);
Expr row_acceleration(const VariableIndex *layout, int constraint);
Expr row_velocity(const VariableIndex *layout, int constraint);
Expr row_network(const VariableIndex *layout, int equation);

/* the coordinate of which a speed is the rate; -1: a component of angular velocity */
int speed_coordinate(const System *system, int speed);

/* The step d that minimises |matrix * d - right| (rows x columns), by QR with column pivoting after
 * rows and columns are scaled to equal size. Returns the rank. Where that is less than `columns`
 * the step has few nonzero entries; -1 where a number isn't finite. O(rows columns^2). */
int rows_solve(const double *matrix, int rows, int columns, const double *right, double *out);

#endif
