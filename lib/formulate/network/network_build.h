/* network_build.h: a network is made: its unknowns, and with dynamics there its rows */
#ifndef COTREE_FORMULATE_NETWORK_NETWORK_BUILD_H
#define COTREE_FORMULATE_NETWORK_NETWORK_BUILD_H

#include "formulate/system/network.h"

MUST_USE Status network_build(System *system, Diag *diag);
/* in state form in the place of the user's tree (network_tree.c) */
MUST_USE Status network_normal_tree(System *system, TreeKind kind, Diag *diag);
/* residuals and their Jacobian, once dynamics is there (network_rows.c) */
MUST_USE Status network_rows(System *system, Diag *diag);

#endif
