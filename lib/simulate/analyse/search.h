/* search.h: Newton's method for the equations of rest
 *
 * KINSOL searches in w from the base (line search on the residuals, each over the size of its terms
 * where a round begins; Hindmarsh and others 2005), and the base follows: a round ends after some
 * steps, before small turns have become large ones. Steps come from sparse factors; where these are
 * small or nearly singular from full ones of as many columns as are independent, so that redundant
 * constraints and freedoms that nothing holds do no harm. */
#ifndef COTREE_SIMULATE_ANALYSE_SEARCH_H
#define COTREE_SIMULATE_ANALYSE_SEARCH_H

#include "simulate/analyse/equilibrium_residual.h"

typedef struct EquilibriumSearch EquilibriumSearch;

/* New, or NULL where SUNDIALS can't be started; free with search_free(). Borrows. */
EquilibriumSearch *search_new(EquilibriumResidual *equations, const CallMonitor *watch);
void search_free(EquilibriumSearch *search); /* NULL is fine */

/* From the base to a place where every equation holds, which is the base then. False: none was
 * found, or the watch said stop; the base stays. */
bool search_run(EquilibriumSearch *search);

/* The same with the mechanics held where it is (equilibrium_hold()): the network settles beside it.
 */
bool search_settle(EquilibriumSearch *search);

/* --- about the base --- */

/* the largest residual at w, each over what it is measured by at the base; INFINITY: undefined */
double search_growth(EquilibriumSearch *search, const double *w);

/* whether equation i holds; *missed tells by how much it doesn't */
bool search_holds(EquilibriumSearch *search, int i, double *missed);
/* unknowns that the equations determine there; -1: singular, and too large to tell */
int search_rank(EquilibriumSearch *search);
/* a place in w of an unknown that nothing determines; -1: not known. O(n^3) where n is small. */
int search_undetermined(EquilibriumSearch *search);
/* whether full matrices are small enough */
bool search_may_be_full(const EquilibriumSearch *search);

#endif
