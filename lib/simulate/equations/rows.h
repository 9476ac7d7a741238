/* rows.h: the equations as residuals in symbols, and steps from them
 *
 *     balance        M u' + Phi_u^T lambda - F = 0
 *     acceleration   Phi_u u' - gamma = 0
 *     velocity       Phi_u u - nu = 0
 *     network        A [x'; z] - r = 0 */
#ifndef COTREE_SIMULATE_EQUATIONS_ROWS_H
#define COTREE_SIMULATE_EQUATIONS_ROWS_H

#include "simulate/equations/variable_index.h"

Expr row_balance(const VariableIndex *layout, int speed);
/* All nu of these; without M where a run does without. Fails with E_MEMORY. */
MUST_USE Status rows_balance(const VariableIndex *layout, Expr *out, Diag *diag);
/* q', then the rates of references (n, multi_turns). Fails with E_MEMORY. */
MUST_USE Status rows_kinematic(const VariableIndex *layout, Expr *out, Diag *diag);
Expr row_acceleration(const VariableIndex *layout, int constraint);
Expr row_velocity(const VariableIndex *layout, int constraint);
Expr row_network(const VariableIndex *layout, int equation);

/* the coordinate of which a speed is the rate; -1: a component of angular velocity */
int speed_coordinate(const System *system, int speed);

/* The step d that brings matrix * d nearest to right (rows x columns), by QR with pivoting of rows
 * and columns brought to like size. The rank, where less than `columns` a step of few entries; -1
 * where a number isn't finite. O(rows columns^2). */
int rows_solve(const double *matrix, int rows, int columns, const double *right, double *out);

#endif
