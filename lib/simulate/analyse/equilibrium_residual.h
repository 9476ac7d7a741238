/* equilibrium_residual.h: the equations of static equilibrium in numbers
 *
 *     F(q, 0, x, z) - Phi_u^T lambda = 0,   Phi(q) = 0,   G([0; z], q, 0, x) = 0
 *
 * for v = (q, x, lambda, z, references of multi-turn angles), with sources and drivers at their
 * values at t = 0. The unknowns of a search are w = (s, x, lambda, z), as many as equations. From a
 * base v0 they give
 *
 *     q = q0 + N(q0) s,   each four Euler parameters scaled to unit length.
 *
 * The equations are those of a system of its own, in whose components t is a number and the loads
 * are multiplied by a parameter, so that derivatives of sources vanish too.
 *
 * Relative equilibrium has the rates of what is driven, u_d and u_d' of the drivers at an instant:
 * F(q, u_d, x, z) - M u_d' replaces F(q, 0, x, z). */
#ifndef COTREE_SIMULATE_ANALYSE_EQUILIBRIUM_RESIDUAL_H
#define COTREE_SIMULATE_ANALYSE_EQUILIBRIUM_RESIDUAL_H

#include "simulate/run/active_run.h"

typedef struct EquilibriumResidual EquilibriumResidual;

/* New; free with equilibrium_free(). Sources and drivers have their values at `at` (s); `keeps`:
 * drivers have their rates there too. The base is the assembled initial state of `start`, a run of
 * the user's system, which is borrowed, as it supplies the parameters. Fails as system_new() and
 * probe_new() do. O(symbols in the equations) derivatives. */
MUST_USE Status equilibrium_new(const Scene *scene, ActiveRun *start, const CallMonitor *watch,
                                bool keeps, double at, EquilibriumResidual **out, Diag *diag);
void equilibrium_free(EquilibriumResidual *equilibrium); /* NULL is fine */

/* u_d; NULL: everything is at rest */
const double *equilibrium_speeds(const EquilibriumResidual *equilibrium);
const VariableIndex *equilibrium_layout(const EquilibriumResidual *equilibrium);
int equilibrium_length(const EquilibriumResidual *equilibrium);      /* of v */
int equilibrium_count(const EquilibriumResidual *equilibrium);       /* of equations, and of w */
bool equilibrium_is_network(const EquilibriumResidual *equilibrium); /* there is no mechanics */

/* Set the fraction of gravity, forces and sources (1 at first), and the conductance in parallel
 * with every part whose current is an expression of its voltage (S; 0 at first). False: no equation
 * contains one. */
bool equilibrium_step_sources(EquilibriumResidual *equilibrium, double load);
bool equilibrium_step_gmin(EquilibriumResidual *equilibrium, double gmin);

/* The efforts of unilateral surfaces: of which size they may be, by what is missed at the base.
 * Then, where the others are in equilibrium, what they become; true: they have changed. */
void equilibrium_begin_efforts(EquilibriumResidual *equilibrium);
bool equilibrium_renew_efforts(EquilibriumResidual *equilibrium);

/* --- base and states --- */

double *
equilibrium_base(EquilibriumResidual *equilibrium); /* v0; after writing: equilibrium_rebase() */
void equilibrium_rebase(EquilibriumResidual *equilibrium); /* the base is new, or the knobs are */
/* w of the base, where s is 0 */
void equilibrium_begin(const EquilibriumResidual *equilibrium, double *w);
/* v at w, with angles in the turns of the last evaluation */
void equilibrium_place(const EquilibriumResidual *equilibrium, const double *w, double *v);

/* --- values at w; borrowed, until the next one --- */

const double *equilibrium_residual(EquilibriumResidual *equilibrium, const double *w);
/* Entries of the Jacobian by w, at the positions of equilibrium_pattern(). */
const double *equilibrium_jacobian(EquilibriumResidual *equilibrium, const double *w);
/* The pattern: the rows of column c are row[start[c]] up to before row[start[c + 1]], each once. It
 * contains those of equilibrium_add_inertia(). */
void equilibrium_pattern(const EquilibriumResidual *equilibrium, const int **start,
                         const int **row);
/* For each equation the sum of the absolute values of its terms, where an unknown step or state
 * counts as 1 at least. After equilibrium_jacobian(). */
void equilibrium_sizes(const EquilibriumResidual *equilibrium, const double *w, double *size);

/* Hold the mechanics: s and lambda are constant, whatever the forces. Its residuals become 0; its
 * rows and columns of the Jacobian those of the identity. Either may be NULL. */
void equilibrium_hold(const EquilibriumResidual *equilibrium, double *residual, double *jacobian);

/* Add `share` times the mass matrix (by s) and the storage elements' part of A (by x) at w to
 * entries of the Jacobian. */
void equilibrium_add_inertia(EquilibriumResidual *equilibrium, const double *w, double share,
                             double *jacobian);

#endif
