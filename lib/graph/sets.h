/* sets.h: disjoint sets of 0 .. count-1, for spanning trees and connected parts
 *
 * Union by size and path halving (Tarjan, van Leeuwen 1984): n operations cost
 * hardly more than O(n). */
#ifndef COTREE_GRAPH_SETS_H
#define COTREE_GRAPH_SETS_H

#include <stdbool.h>

typedef struct Sets Sets;

Sets *sets_new(int count);             /* new; each member alone in its set */
void sets_free(Sets *sets);            /* NULL is fine */
int sets_find(Sets *sets, int member); /* the one that stands for its set */
/* Unite two sets; false when they were one before. */
bool sets_join(Sets *sets, int a, int b);

#endif
