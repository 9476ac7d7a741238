/* netdae.h: a network without mechanics as implicit equations, with a sparse Jacobian
 *
 *     G([x'; z], x, t) = 0,   work' = power    in w = (x, work, z)
 *
 * Derivatives are formed in symbols, and compiled when a solver starts with them first. */
#ifndef COTREE_SIMULATE_EQUATIONS_NETDAE_H
#define COTREE_SIMULATE_EQUATIONS_NETDAE_H

#include "simulate/equations/numbers.h"

typedef struct NetDae NetDae;

/* New; free with netdae_free(). Borrows all. NULL where there is mechanics, or no state. */
NetDae *netdae_new(const Layout *layout, Parameters *parameters, Motion *motion);
void netdae_free(NetDae *dae); /* NULL is fine */
const Dae *netdae_equations(const NetDae *dae);

/* G by x, x' and z: the entries of a row that aren't 0 */
typedef struct Slopes {
    int count; /* the first `rates` are by x' and z, as in the system's A; the others by x */
    int rates;
    int *row, *column; /* column in [x'; z], or in x */
    Expr *value;
} Slopes;
/* new arrays, for slopes_free(). O(symbols in G) */
Slopes slopes_of(const Layout *layout);
void slopes_free(Slopes *slopes);

#endif
