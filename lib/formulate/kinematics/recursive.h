/* recursive.h: motion of the recursive form, outward along the trees */
#ifndef COTREE_FORMULATE_KINEMATICS_RECURSIVE_H
#define COTREE_FORMULATE_KINEMATICS_RECURSIVE_H

#include "formulate/system/kinematics.h"

void motion_build(System *system);
/* angular accelerations of orientation classes and accelerations of nodes, with u' or (NULL)
 * without */
void accelerations_build(const System *system, const Expr *accelerations, Vec *alpha, Vec *a);
/* a node's own motion, anew, in a copy where the shift to it differs */
void node_moved(System *shadow, int node);
/* position of a node in ground axes, a named temporary; formed at the first call */
Vec node_position(System *system, int node);
/* from one node to another, ground axes */
Vec node_way(System *system, int from, int to);
/* angular velocity of a node's frame in the axes of an orientation class */
Vec node_turn_rate(const System *system, int node, int axes);

#endif
