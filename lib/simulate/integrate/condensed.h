/* condensed.h: solves (s - J) x = b, dense n x n, by its Schur complement
 *
 * D are unknowns whose rates depend on none of D; R are the others. Then R determines D: s x_D =
 * b_D + J_DR x_R, as speeds determine positions. It remains (s - J_RR - J_RD J_DR / s) x_R = b_R +
 * J_RD b_D / s, for a mechanism half the size. A complex s is a real system of twice the size. */
#ifndef COTREE_SIMULATE_INTEGRATE_CONDENSED_H
#define COTREE_SIMULATE_INTEGRATE_CONDENSED_H

#include <stdbool.h>

typedef struct Condensed Condensed;

Condensed *condensed_new(int n);           /* new; free with condensed_free() */
void condensed_free(Condensed *condensed); /* NULL is fine */
/* Set J (n x n, row by row), copied. Factors of an earlier one become invalid. O(n^2 + entries of
 * J_DR times R). */
void condensed_set(Condensed *condensed, const double *jacobian);
/* Factor for a real s other than 0, and for alpha - i beta. False: singular. O(R^3) */
bool condensed_factor(Condensed *condensed, double s, double alpha, double beta);
bool condensed_factor_real(Condensed *condensed, double s); /* for the real one alone */
/* Replace b by the solution; the second solves the complex system with right-hand side b + i
 * other. */
void condensed_solve(Condensed *condensed, double *b);
void condensed_solve_pair(Condensed *condensed, double *b, double *other);

#endif
