/* freedoms.h: whether a virtual joint that is a branch allows every motion of its frames
 *
 * As a branch it assumes that its coordinates describe every motion that the real joints allow its
 * frames. Where they don't, freedoms are lost without any equation that constrains them. */
#ifndef COTREE_SIMULATE_ANALYSE_FREEDOMS_H
#define COTREE_SIMULATE_ANALYSE_FREEDOMS_H

#include "simulate/run/result_reader.h"

/* Compare the freedoms nu - rank(Phi_u) of two assembled initial states of one model: `real` with
 * trees of real edges, `with` with trees that contain the listed virtual joints. Fails with
 * E_BRANCH where freedoms are lost, naming the joint and the rotation that it can't represent.
 * O(nu^2 m). */
MUST_USE Status freedoms_compare(ResultReader *real, ResultReader *with,
                                 const Instance *const *joints, const char *const (*frames)[2],
                                 int count, Diag *diag);

#endif
