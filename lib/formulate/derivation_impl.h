/* derivation_impl.h: what the expanded form and its derivation share */
#ifndef COTREE_FORMULATE_DERIVATION_IMPL_H
#define COTREE_FORMULATE_DERIVATION_IMPL_H

#include "formulate/derivation.h"
#include "formulate/framesum.h"

/* the terms of an entry as they are before they are tidied */
typedef Status TermsFunction(System *system, int row, int column, Terms *out, Diag *diag);
MUST_USE TermsFunction constraint_terms, jacobian_terms;

/* the part of the way from ground to a node that speed j moves */
FrameSum partial_velocity(const System *system, int node, int speed);
/* angular velocity of a chain per unit of speed j, in its own axes; zero where it doesn't turn it
 */
Vec partial_turn(const System *system, int chain, int speed);

#endif
