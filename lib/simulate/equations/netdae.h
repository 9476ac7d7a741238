/* netdae.h: a network without mechanics as implicit equations, with a sparse Jacobian
 *
 *     G([x'; z], x, t) = 0,   work' = power    in w = (x, work, z)
 *
 * Derivatives are symbolic, and are compiled when a solver first needs them. */
#ifndef COTREE_SIMULATE_EQUATIONS_NETDAE_H
#define COTREE_SIMULATE_EQUATIONS_NETDAE_H

#include "simulate/equations/compiled_equations.h"

typedef struct NetDae NetDae;

/* New; free with netdae_free(). Borrows all. NULL where there is mechanics, or no state. */
NetDae *netdae_new(const VariableIndex *layout, Parameters *parameters, Motion *motion);
void netdae_free(NetDae *dae); /* NULL is fine */
const Dae *netdae_equations(const NetDae *dae);

#endif
