/* equilibrium_residual.h: the equations of rest in numbers
 *
 *     F(q, 0, x, z) - Phi_u^T lambda = 0,   Phi(q) = 0,   G([0; z], q, 0, x) = 0
 *
 * for v = (q, x, lambda, z, references of angles that count turns), with sources and drivers as
 * they are at t = 0. A search moves in w = (s, x, lambda, z), of which there are as many as
 * equations: from a base v0 it is
 *
 *     q = q0 + N(q0) s,   each four Euler parameters brought to unit length.
 *
 * The equations are those of a system of its own, in whose components t is a number and the loads
 * are multiplied by a parameter, so that derivatives of sources vanish too.
 *
 * Relative equilibrium keeps the rates of what is driven, u_d and u_d' of the drivers at an
 * instant: F(q, u_d, x, z) - M u_d' in the place of F(q, 0, x, z). */
#ifndef COTREE_SIMULATE_ANALYSE_EQUILIBRIUM_RESIDUAL_H
#define COTREE_SIMULATE_ANALYSE_EQUILIBRIUM_RESIDUAL_H

#include "simulate/run/active_run.h"

typedef struct EquilibriumResidual EquilibriumResidual;

/* New; free with equilibrium_free(). Sources and drivers are as at `at` (s), whose rates `keeps`
 * keeps. The base is the assembled start of `start`, a run of the
 * system of the user, which is borrowed: its parameters are asked for. Fails as system_new() and
 * probe_new() do. O(symbols in the equations) derivatives. */
MUST_USE Status equilibrium_new(const Scene *scene, ActiveRun *start, const CallMonitor *watch,
                                bool keeps, double at, EquilibriumResidual **out, Diag *diag);
void equilibrium_free(EquilibriumResidual *equilibrium); /* NULL is fine */

/* u_d; NULL: everything rests */
const double *equilibrium_speeds(const EquilibriumResidual *equilibrium);
const VariableIndex *equilibrium_layout(const EquilibriumResidual *equilibrium);
int equilibrium_length(const EquilibriumResidual *equilibrium);      /* of v */
int equilibrium_count(const EquilibriumResidual *equilibrium);       /* of equations, and of w */
bool equilibrium_is_network(const EquilibriumResidual *equilibrium); /* there is no mechanics */

/* The share of gravity, forces and sources that is on (1 at first), and the conductance beside
 * every part whose current is an expression of its voltage (S; 0 at first). False: no equation
 * holds one. */
bool equilibrium_step_sources(EquilibriumResidual *equilibrium, double load);
bool equilibrium_step_gmin(EquilibriumResidual *equilibrium, double gmin);

/* --- places --- */

double *
equilibrium_base(EquilibriumResidual *equilibrium); /* v0; after writing: equilibrium_rebase() */
void equilibrium_rebase(EquilibriumResidual *equilibrium); /* the base is new, or the knobs are */
/* w of the base: s is 0 */
void equilibrium_begin(const EquilibriumResidual *equilibrium, double *w);
/* angles in the turn that they had at the last place whose numbers were asked for */
void equilibrium_place(const EquilibriumResidual *equilibrium, const double *w, double *v);

/* --- numbers at w; borrowed, until the next place --- */

const double *equilibrium_residual(EquilibriumResidual *equilibrium, const double *w);
/* Entries of the Jacobian by w, where equilibrium_pattern() tells. */
const double *equilibrium_jacobian(EquilibriumResidual *equilibrium, const double *w);
/* Of the entries of column c, start[c] up to start[c + 1], the rows: each place once. Those of
 * equilibrium_add_inertia() have a place too. */
void equilibrium_pattern(const EquilibriumResidual *equilibrium, const int **start,
                         const int **row);
/* For each equation the sum of its terms in size, an unknown step or state taken as 1 at least.
 * After equilibrium_jacobian(). */
void equilibrium_sizes(const EquilibriumResidual *equilibrium, const double *w, double *size);

/* Hold the mechanics: where s and lambda stand stay as they are, whatever the forces. Its residuals
 * become 0; its rows and columns of the Jacobian those of 1. Either may be NULL. */
void equilibrium_hold(const EquilibriumResidual *equilibrium, double *residual, double *jacobian);

/* Add `share` times the mass matrix (by s) and the storage elements' part of A (by x) at w to
 * entries of the Jacobian. */
void equilibrium_add_inertia(EquilibriumResidual *equilibrium, const double *w, double share,
                             double *jacobian);

#endif
