/* rates.h: unknowns of the network and their rates, which may be unknowns themselves */
#ifndef COTREE_FORMULATE_SYSTEM_RATES_H
#define COTREE_FORMULATE_SYSTEM_RATES_H

#include "formulate/system/network.h"

/* the number of a new unknown, whose symbol has that name and kind */
int network_new_unknown(System *system, Unknown unknown, const char *name, SymbolKind kind);
/* adds one more rate of an unknown, as a symbol */
Expr network_add_rate(System *system, int unknown, SymbolKind kind);
/* `symbol` is the rate of that order of an unknown */
void network_know(System *system, Expr symbol, int unknown, int order);
/* A potential, or a rate of one, that the equations need at a terminal to which nothing is
 * connected. */
Expr network_open(System *system, const char *name);

#endif
