/* network_isomorphic.h: rows of a network that needn't be derived
 *
 * A row that an earlier System derived from the same relation, v, i and variables is recalled.
 * Otherwise, where all of these equal those of another instance of the same definition after
 * renaming, so does the row: it is taken over by renaming, with its Jacobian entries. */
#ifndef COTREE_FORMULATE_NETWORK_NETWORK_ISOMORPHIC_H
#define COTREE_FORMULATE_NETWORK_NETWORK_ISOMORPHIC_H

#include "formulate/system/network.h"

typedef struct NetworkIsomorphism NetworkIsomorphism;

void network_isomorphic_free(NetworkIsomorphism *alike); /* NULL is fine */

/* Call before the row of an unknown is derived: *found, and its left, right and lack in *y. */
MUST_USE Status network_isomorphic_find(System *system, int unknown, Unknown *y, bool *found,
                                        Diag *diag);
/* call afterwards, for a row that was not found and so was derived */
void network_isomorphic_keep(System *system, int unknown, const Unknown *y);

/* derivatives of the residual by its unknowns, and -residual with all of them at 0 */
typedef struct NetworkSlopes {
    LIST(Expr) symbols;
    LIST(Expr) values;
    Expr rest;
    bool is_nonlinear;
} NetworkSlopes;
/* of left - right; false: they have to be derived */
bool network_isomorphic_slopes(System *system, int unknown, NetworkSlopes *slopes);
void network_isomorphic_keep_slopes(System *system, int unknown, const NetworkSlopes *slopes);

#endif
