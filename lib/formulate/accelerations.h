/* accelerations.h: u' of a mechanism of few speeds that nothing constrains, in symbols */
#ifndef COTREE_FORMULATE_ACCELERATIONS_H
#define COTREE_FORMULATE_ACCELERATIONS_H

#include "formulate/system.h"

/* u'[j] for these F, and excess[j]: over the j-th pivot of M, what it is the rest of. That is large
 * where a speed has next to no inertia of its own. Arrays of nu. False where it can't be told so: a
 * speed moves nothing that has mass, or there are too many. */
bool system_accelerations(System *view, const Expr *force, Expr *acceleration, Expr *excess);

#endif
