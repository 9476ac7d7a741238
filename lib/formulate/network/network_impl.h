/* network_impl.h: what the files of the network share */
#ifndef COTREE_FORMULATE_NETWORK_NETWORK_IMPL_H
#define COTREE_FORMULATE_NETWORK_NETWORK_IMPL_H

#include "formulate/system/network.h"

/* the equation of an unknown, left = right */
MUST_USE Status network_row(System *system, int unknown, Diag *diag);
/* one whose equation is the relation of that edge, without symbol yet */
Unknown network_unknown_of_branch(const System *system, const Branchlike *branch);
/* the unknowns as states x and algebraic z of the System: new ones behind the old */
void network_list(System *system);
/* in the form of the user's tree: which rates are states, which is solved for (network_order.c) */
MUST_USE Status network_bring_order(System *system, Diag *diag);
/* Where sums are long and nobody reads them: v of a chord whose path has so many branches, i of a
 * branch, by what stands at nodes (network_nodes.c), where it doesn't follow from its rate. False:
 * they stay sums. */
bool network_nodes_across(System *system, const Branchlike *chord, int path, Expr *out);
bool network_nodes_through(System *system, Branchlike *branch, Expr *out);
/* what else meets at the far node of a branch: its i */
MUST_USE Status network_nodes_balance(System *system, const Branchlike *branch, Expr *out,
                                      Diag *diag);
/* the potential of a node of that tree, an unknown with its equation */
Expr network_nodes_potential(System *system, const Tree *tree, int node);
/* the equation of such an unknown, left = right */
MUST_USE Status network_nodes_row(System *system, Unknown *y, Diag *diag);
/* v of a chord along its circuit */
MUST_USE Status circuit_across(System *system, Branchlike *branch, Expr *out, Diag *diag);
/* Whether an edge of a port gives its own variable (v of a branch, i of a chord) by the other edge;
 * where it doesn't its equation is the other of the two. */
bool port_gives_own(System *system, const Branchlike *branch);

#endif
