/* perturbed_points.h: where frames stand a little to both sides of a position along a speed */
#ifndef COTREE_SIMULATE_ASSEMBLE_PERTURBED_POINTS_H
#define COTREE_SIMULATE_ASSEMBLE_PERTURBED_POINTS_H

#include "simulate/assemble/kinematic_tree.h"

typedef struct PerturbedPoints PerturbedPoints;

/* At coordinates q, `step` (m, rad) to each side. New; perturbed_points_free(). Borrows the
 * skeleton and the equations, whose map is that at q. */
PerturbedPoints *perturbed_points_new(const KinematicTree *kinematic_tree,
                                      const Equations *equations, const double *q, double step);
void perturbed_points_free(PerturbedPoints *sides); /* NULL is fine */
/* Look along speed j. O(nodes), of which those that it moves count. */
void perturbed_points_find(PerturbedPoints *sides, int j);
/* Poses of all nodes there; borrowed, until it looks again. */
const Pose *perturbed_points_low(const PerturbedPoints *sides);
const Pose *perturbed_points_high(const PerturbedPoints *sides);
/* whether a link's frames stand to each other as without the speed: neither moves, or they are
 * placed by the link, whose coordinates it doesn't move */
bool perturbed_points_stores(const PerturbedPoints *sides, int link);

#endif
