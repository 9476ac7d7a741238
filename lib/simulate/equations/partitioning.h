/* partitioning.h: the embedded form: independent accelerations without multipliers
 *
 * With u = (u_d, u_i), G = [J; 1], J = -Phi_d^-1 Phi_i: Phi_u G = 0, and [G^T M; Phi_u] u' = [G^T
 * F; gamma] is solved as a system in u_i' (nu - m) alone. Phi_d is m x m, J m x (nu - m). */
#ifndef COTREE_SIMULATE_EQUATIONS_PARTITIONING_H
#define COTREE_SIMULATE_EQUATIONS_PARTITIONING_H

#include <stdbool.h>

typedef struct Partitioning Partitioning;

Partitioning *partitioning_new(int nu, int m);      /* new; free with partitioning_free() */
void partitioning_free(Partitioning *partitioning); /* NULL is fine */
/* Choose dependent speeds by elimination with full pivoting of the rows of phi_u; the `wanted` ones
 * become independent as far as the rows allow. False, and nothing has changed, when the rows are
 * dependent. */
bool partitioning_choose(Partitioning *partitioning, const double *phi_u, const int *rows,
                         const int *wanted, int wanted_count);
const int *partitioning_independent(const Partitioning *partitioning); /* nu - m, rising */
/* Factor at these numbers; false when Phi_d or G^T M G is singular. */
bool partitioning_factor(Partitioning *partitioning, const double *mass, const double *phi_u,
                         const int *rows);
double partitioning_condition(
    const Partitioning *partitioning); /* pivot ratio of Phi_d, over that at its choice */
double partitioning_pivots(const Partitioning *partitioning); /* the ratio itself */
void partitioning_solve(Partitioning *partitioning, const double *force, const double *gamma,
                        double *du);

#endif
