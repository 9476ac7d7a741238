/* search.h: Newton's method for the equations of static equilibrium
 *
 * KINSOL searches in w from the base (line search on the residuals, each over the size of its terms
 * at the start of a round; Hindmarsh and others 2005). The base then moves: a round ends after some
 * steps, before small rotations have become large. Steps come from sparse LU factors; where the
 * matrix is small or nearly singular, from full factors of as many columns as are independent, so
 * that redundant constraints and unconstrained freedoms do no harm. */
#ifndef COTREE_SIMULATE_ANALYSE_SEARCH_H
#define COTREE_SIMULATE_ANALYSE_SEARCH_H

#include "simulate/analyse/equilibrium_residual.h"

typedef struct EquilibriumSearch EquilibriumSearch;

/* New, or NULL where SUNDIALS can't be started; free with search_free(). Borrows. */
EquilibriumSearch *search_new(EquilibriumResidual *equations, const CallMonitor *watch);
void search_free(EquilibriumSearch *search); /* NULL is fine */

/* From the base to a point where every equation holds, which becomes the base. False: none was
 * found, or the watch requested a stop; the base is unchanged. */
bool search_run(EquilibriumSearch *search);

/* The same with the mechanics held (equilibrium_hold()): only the network settles. */
bool search_settle(EquilibriumSearch *search);

/* --- at the base --- */

/* the largest residual at w, with the weights at the base; INFINITY: undefined */
double search_growth(EquilibriumSearch *search, const double *w);

/* whether equation i holds; *missed becomes its residual */
bool search_holds(EquilibriumSearch *search, int i, double *missed);
/* number of unknowns that the equations determine there; -1: singular, and too large to compute */
int search_rank(EquilibriumSearch *search);
/* index in w of an unknown that no equation determines; -1: not known. O(n^3) where n is small. */
int search_undetermined(EquilibriumSearch *search);
/* whether full matrices are small enough */
bool search_may_be_full(const EquilibriumSearch *search);

#endif
