/* network_build.h: building a network: first its unknowns, then, after the dynamics, its rows */
#ifndef COTREE_FORMULATE_NETWORK_NETWORK_BUILD_H
#define COTREE_FORMULATE_NETWORK_NETWORK_BUILD_H

#include "formulate/system/network.h"

MUST_USE Status network_build(System *system, Diag *diag);
/* replaces the user's tree in state form (network_tree.c) */
MUST_USE Status network_normal_tree(System *system, TreeKind kind, Diag *diag);
/* residuals and their Jacobian, after the dynamics are built (network_rows.c) */
MUST_USE Status network_rows(System *system, Diag *diag);

#endif
