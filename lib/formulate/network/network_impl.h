/* network_impl.h: shared by the files of the network */
#ifndef COTREE_FORMULATE_NETWORK_NETWORK_IMPL_H
#define COTREE_FORMULATE_NETWORK_NETWORK_IMPL_H

#include "formulate/system/network.h"

/* the equation of an unknown, left = right */
MUST_USE Status network_row(System *system, int unknown, Diag *diag);
/* an unknown whose equation is the relation of that edge; it has no symbol yet */
Unknown network_unknown_of_branch(const System *system, const Branchlike *branch);
/* adds the unknowns to the states x and algebraic z of the System: new ones after the old */
void network_list(System *system);
/* for the form of the user's tree: which rates are states, and which are solved for
 * (network_order.c) */
MUST_USE Status network_bring_order(System *system, Diag *diag);
/* For long sums that nobody reads: v of a chord whose path has so many branches, or i of a branch
 * that does not follow from its rate, by unknowns at nodes (network_nodes.c). False: they remain
 * sums. */
bool network_nodes_across(System *system, const Branchlike *chord, int path, Expr *out);
bool network_nodes_through(System *system, Branchlike *branch, Expr *out);
/* i of a branch, from the balance of the other edges at its far node */
MUST_USE Status network_nodes_balance(System *system, const Branchlike *branch, Expr *out,
                                      Diag *diag);
/* the potential of a node of that tree, an unknown with its equation */
Expr network_nodes_potential(System *system, const Tree *tree, int node);
/* the equation of such an unknown, left = right */
MUST_USE Status network_nodes_row(System *system, Unknown *y, Diag *diag);
/* v of a chord along its circuit */
MUST_USE Status circuit_across(System *system, Branchlike *branch, Expr *out, Diag *diag);
/* Whether an edge of a port determines its own variable (v of a branch, i of a chord) by the other
 * edge. Where it doesn't, its equation is the other of the two. */
bool port_gives_own(System *system, const Branchlike *branch);

#endif
