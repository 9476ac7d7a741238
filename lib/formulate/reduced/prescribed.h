/* prescribed.h: drivers' multipliers of a completely prescribed motion
 *
 * Where each speed has a row of its own that determines its acceleration, no system has to be
 * solved: u' is gamma, and M u' + Phi_u^T lambda = F gives each multiplier by itself. */
#ifndef COTREE_FORMULATE_REDUCED_PRESCRIBED_H
#define COTREE_FORMULATE_REDUCED_PRESCRIBED_H

#include "formulate/system/system.h"

/* u' (nu) and lambda (m), by the cheapest method: by M, by one pass along the trees, or by one over
 * groups of bodies (along_trees.h). False: some speed has no row of its own, or there are other
 * constraints. */
bool system_prescribed(System *view, Expr *acceleration, Expr *multiplier);

#endif
