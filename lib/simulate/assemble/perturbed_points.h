/* perturbed_points.h: poses of frames a little to both sides of a position, along a speed */
#ifndef COTREE_SIMULATE_ASSEMBLE_PERTURBED_POINTS_H
#define COTREE_SIMULATE_ASSEMBLE_PERTURBED_POINTS_H

#include "simulate/assemble/kinematic_tree.h"

typedef struct PerturbedPoints PerturbedPoints;

/* At coordinates q, `step` (m, rad) to each side. New; perturbed_points_free(). Borrows the
 * kinematic tree and the equations, whose map is that at q. */
PerturbedPoints *perturbed_points_new(const KinematicTree *kinematic_tree,
                                      const Equations *equations, const double *q, double step);
void perturbed_points_free(PerturbedPoints *sides); /* NULL is fine */
/* Perturb along speed j. O(nodes), where those that it moves cost most. */
void perturbed_points_find(PerturbedPoints *sides, int j);
/* Poses of all nodes there; borrowed, until the next perturbation. */
const Pose *perturbed_points_low(const PerturbedPoints *sides);
const Pose *perturbed_points_high(const PerturbedPoints *sides);
/* whether the relative pose of a link's frames is the same as without the speed: neither moves, or
 * the link places them and the speed doesn't move its coordinates */
bool perturbed_points_stores(const PerturbedPoints *sides, int link);

#endif
