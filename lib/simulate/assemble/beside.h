/* beside.h: where frames stand a little to both sides of a position along a speed */
#ifndef COTREE_SIMULATE_ASSEMBLE_BESIDE_H
#define COTREE_SIMULATE_ASSEMBLE_BESIDE_H

#include "simulate/assemble/skeleton.h"

typedef struct Sides Sides;

/* At coordinates q, `step` (m, rad) to each side. New; sides_free(). Borrows the skeleton and the
 * equations, whose map is that at q. */
Sides *sides_new(const Skeleton *skeleton, const Equations *equations, const double *q,
                 double step);
void sides_free(Sides *sides); /* NULL is fine */
/* Look along speed j. O(nodes), of which those that it moves count. */
void sides_look(Sides *sides, int j);
/* Poses of all nodes there; borrowed, until it looks again. */
const Pose *sides_low(const Sides *sides);
const Pose *sides_high(const Sides *sides);
/* whether a link's frames stand to each other as without the speed: neither moves, or they are
 * placed by the link, whose coordinates it doesn't move */
bool sides_keep(const Sides *sides, int link);

#endif
