/* scalar_edges.h: edges of scalar domains, and their across and through variables */
#ifndef COTREE_FORMULATE_NETWORK_SCALAR_EDGES_H
#define COTREE_FORMULATE_NETWORK_SCALAR_EDGES_H

#include "formulate/system/network.h"

const Instance *branch_owner(const System *system, const Branchlike *branch);
Branchlike *scalar_branch(System *system, const Instance *instance, int which);
/* its member names: "i", or for an edge with a suffix "s.i" */
const char *branch_member(const System *system, const Branchlike *branch, bool through);
TreeKind branch_tree(const System *system, const Branchlike *branch);
/* The status of a derivative that an edge needs. Where that does not exist in the form of the
 * user's tree, E_MODEL with the edge. */
Status network_no_rate(const System *system, const char *edge, Status status, Diag *diag);
/* content' + rest: i of an edge that stores v, v of an edge that stores i */
MUST_USE Status network_stored_rate(System *system, const Branchlike *branch, Expr *out,
                                    Diag *diag);
/* names of the edges in the circuit of a chord or the cutset of a branch; in the pool */
const char *network_company(const System *system, const Branchlike *branch);
/* voltage and current of a scalar edge */
MUST_USE Status network_across(System *system, Branchlike *branch, Expr *out, Diag *diag);
MUST_USE Status network_through(System *system, Branchlike *branch, Expr *out, Diag *diag);

#endif
