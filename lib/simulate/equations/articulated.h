/* articulated.h: solves M u' = F for a long tree without forming M, in a time proportional to its
 * length
 *
 * The input is the description of composite_mass.h: the bodies, the places and the speeds. */
#ifndef COTREE_SIMULATE_EQUATIONS_ARTICULATED_H
#define COTREE_SIMULATE_EQUATIONS_ARTICULATED_H

#include "formulate/dynamics/composite_mass.h"

typedef struct Articulated Articulated;

/* New; borrows from the system. NULL: M has symbolic entries, or other parts couple two speeds. */
Articulated *articulated_new(const System *system);
void articulated_free(Articulated *articulated); /* NULL is fine */
/* the expressions that it is made from */
const Expr *articulated_needs(const Articulated *articulated, int *count);
/* Eliminate for these values of the needs, which are borrowed until the next call. False where the
 * inertia that M leaves to a speed is rounding error. O(places). */
bool articulated_factor(Articulated *articulated, const double *numbers);
void articulated_solve(Articulated *articulated, const double *force, double *du); /* O(places) */

#endif
