/* prescribed.h: what drives a motion that is prescribed throughout
 *
 * Where each speed has a row of its own, which tells its acceleration, nothing has to be solved:
 * u' is gamma, and M u' + Phi_u^T lambda = F tells each multiplier by itself. */
#ifndef COTREE_FORMULATE_REDUCED_PRESCRIBED_H
#define COTREE_FORMULATE_REDUCED_PRESCRIBED_H

#include "formulate/system/system.h"

/* u' (nu) and lambda (m), in the cheapest of the ways there are: by M, by one pass along the trees,
 * or by one over groups of bodies (along_trees.h). False: some speed has no row of its own, or
 * something else holds. */
bool system_prescribed(System *view, Expr *acceleration, Expr *multiplier);

#endif
