/* sets.h: disjoint sets of 0 .. count-1, for spanning trees and connected parts
 *
 * Union by size and path halving (Tarjan, van Leeuwen 1984): n operations cost almost O(n). */
#ifndef COTREE_GRAPH_SETS_H
#define COTREE_GRAPH_SETS_H

#include <stdbool.h>

typedef struct Sets Sets;

Sets *sets_new(int count);             /* new; each member is a set of its own */
void sets_free(Sets *sets);            /* NULL is fine */
int sets_find(Sets *sets, int member); /* the representative of its set */
/* Unites two sets; false when they were the same set before. */
bool sets_join(Sets *sets, int a, int b);

#endif
