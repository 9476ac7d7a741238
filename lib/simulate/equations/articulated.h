/* articulated.h: M u' = F of a long tree, without M, in a time that grows with its length
 *
 * From what composite_mass.h tells: bodies, and what each place and each speed does. */
#ifndef COTREE_SIMULATE_EQUATIONS_ARTICULATED_H
#define COTREE_SIMULATE_EQUATIONS_ARTICULATED_H

#include "formulate/dynamics/composite_mass.h"

typedef struct Articulated Articulated;

/* New; borrows from the system. NULL: M is written out, or other parts tie two speeds together. */
Articulated *articulated_new(const System *system);
void articulated_free(Articulated *articulated); /* NULL is fine */
/* the expressions that it is made from */
const Expr *articulated_needs(const Articulated *articulated, int *count);
/* Eliminate, for the numbers of these, borrowed until the next call. False where M leaves a speed
 * no inertia but rounding. O(places). */
bool articulated_factor(Articulated *articulated, const double *numbers);
void articulated_solve(Articulated *articulated, const double *force, double *du); /* O(places) */

#endif
