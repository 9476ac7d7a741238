/* network_isomorphic.h: rows of a network that needn't be derived
 *
 * What an earlier System derived from the same relation, v, i and variables is recalled. Else,
 * where all of these are those of another instance of the same definition in other names, so is the
 * row: it is taken over by renaming, with its slopes. */
#ifndef COTREE_FORMULATE_NETWORK_NETWORK_ISOMORPHIC_H
#define COTREE_FORMULATE_NETWORK_NETWORK_ISOMORPHIC_H

#include "formulate/system/network.h"

typedef struct NetworkIsomorphism NetworkIsomorphism;

void network_isomorphic_free(NetworkIsomorphism *alike); /* NULL is fine */

/* Before the row of an unknown is derived: *found, and its left, right and lack in *y. */
MUST_USE Status network_isomorphic_find(System *system, int unknown, Unknown *y, bool *found,
                                        Diag *diag);
/* behind that, where it wasn't found and was derived */
void network_isomorphic_keep(System *system, int unknown, const Unknown *y);

/* d residual by one of the unknowns, and -residual without all of them */
typedef struct NetworkSlopes {
    LIST(Expr) symbols;
    LIST(Expr) values;
    Expr rest;
    bool is_nonlinear;
} NetworkSlopes;
/* of left - right; false: they are to be derived */
bool network_isomorphic_slopes(System *system, int unknown, NetworkSlopes *slopes);
void network_isomorphic_keep_slopes(System *system, int unknown, const NetworkSlopes *slopes);

#endif
