/* freedoms.h: whether a virtual joint that is a branch covers what its frames can do
 *
 * As a branch it claims that its coordinates tell every motion that the real joints leave to its
 * frames. Where they don't, freedoms are lost that no equation speaks of. */
#ifndef COTREE_SIMULATE_ANALYSE_FREEDOMS_H
#define COTREE_SIMULATE_ANALYSE_FREEDOMS_H

#include "simulate/run/result_reader.h"

/* Compare the freedoms nu - rank(Phi_u) of two assembled starts of one model: `real` in trees of
 * real edges, `with` in trees with the virtual joints whose instances are listed. Fails with
 * E_BRANCH where freedoms are lost, naming the joint and the turn that it leaves out. O(nu^2 m). */
MUST_USE Status freedoms_compare(ResultReader *real, ResultReader *with,
                                 const Instance *const *joints, const char *const (*frames)[2],
                                 int count, Diag *diag);

#endif
