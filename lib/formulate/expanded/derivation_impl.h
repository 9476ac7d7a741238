/* derivation_impl.h: shared by the expanded form and its derivation */
#ifndef COTREE_FORMULATE_EXPANDED_DERIVATION_IMPL_H
#define COTREE_FORMULATE_EXPANDED_DERIVATION_IMPL_H

#include "formulate/dynamics/shapes.h"
#include "formulate/expanded/derivation.h"
#include "formulate/kinematics/framesum.h"

/* the terms of an entry, before simplification */
typedef Status TermsFunction(System *system, int row, int column, Terms *out, Diag *diag);
MUST_USE Status constraint_terms(System *system, int k, int column, Terms *out, Diag *diag);
MUST_USE Status jacobian_terms(System *system, int k, int j, Terms *out, Diag *diag);

/* --- partial.c --- */

/* the velocity of a node per unit of speed j */
FrameSum partial_velocity(const System *system, int node, int speed);
/* angular velocity of an orientation class per unit of speed j, in its own axes; 0 where j does not
 * turn it */
Vec partial_turn(const System *system, int chain, int speed);
/* angular velocity w of an orientation class in its own axes, and its rate at u' = 0 */
void orientation_motion(const System *system, int chain, Vec *w, Vec *alpha);
/* acceleration of a node at u' = 0 */
FrameSum rest_acceleration(const System *system, int node);

/* --- expanded_shapes.c: summands of an entry of M, of F --- */

typedef LIST(Expr) Summands;
void elastic_mass_terms(const System *system, const Elastic *elastic, int j, int k,
                        Summands *terms);
void elastic_force_terms(const System *system, const Elastic *elastic, int j, Summands *terms);
MUST_USE Status elastic_load_terms(System *system, const Elastic *elastic, int j, int take,
                                   Summands *terms, Diag *diag);

#endif
