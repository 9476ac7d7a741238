/* shapes.h: local blocks of flexible parts, on the root and on the shapes (theory 9) */
#ifndef COTREE_FORMULATE_DYNAMICS_SHAPES_H
#define COTREE_FORMULATE_DYNAMICS_SHAPES_H

#include "formulate/dynamics/loads.h"
#include "formulate/kinematics/section_frames.h"

/* a flexible part, at the node of its root */
typedef struct Elastic {
    int instance, node;
    int first; /* index of its first speed */
    int load_powers;
    ShapeInertia block;
} Elastic;

/* builds the local blocks, after the motions */
void elastics_build(System *system);

/* forces of one motion of the root (a, alpha in the axes of its node) and of u' (NULL: none) */
void elastic_add_motion(const System *system, const Elastic *elastic, Loads *loads, Vec a,
                        Vec alpha, const Expr *accelerations, int sign);
/* the same part beyond the place `from` alone, with what it exerts on its root */
Elastic elastic_beyond(const System *system, const Elastic *elastic, Expr from);
/* inertia and weight, for accelerations of its root and of its speeds */
void elastic_add_inertia(const System *system, const Elastic *elastic, Loads *loads,
                         const Vec *alpha, const Vec *a, const Expr *accelerations);
/* adds the loads of its load= */
MUST_USE Status elastic_add_load(System *system, const Elastic *elastic, int take, Loads *loads,
                                 Diag *diag);
Expr elastic_kinetic(const System *system, const Elastic *elastic);
/* a vector of the root's frame, in the axes of the root's orientation class */
Vec elastic_vector(const System *system, const Elastic *elastic, const Expr in_root[3]);
Rotation elastic_inertia(const System *system, const Elastic *elastic);

#endif
