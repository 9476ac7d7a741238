/* rotation_vector.h: rotation vector of one frame against another, and moments along its components
 *
 * phi = theta a (rad), a turn by theta about the unit vector a. It is smooth for theta below pi. At
 * pi it jumps to the opposite vector, and is not defined there. */
#ifndef COTREE_FORMULATE_KINEMATICS_ROTATION_VECTOR_H
#define COTREE_FORMULATE_KINEMATICS_ROTATION_VECTOR_H

#include "formulate/system/vector.h"

typedef struct RotationVector {
    Vec at;        /* phi, in axes of the tail, which are those of the head too */
    Expr half_cos; /* cos(theta/2), 0 at theta = pi */
    Rotation turn; /* R, from axes of the head to those of the tail */
    Vec sine;      /* sin(theta) a */
    Expr ratio;    /* theta/sin(theta), */
    Expr slope;    /* and its derivative by cos(theta) */
} RotationVector;

/* phi of a rotation matrix: over its entries, as named temporaries */
void rotation_vector_of(Arena *arena, const Expr turn[9], RotationVector *out);
/* phi', from the angular velocity of the head against the tail in axes of the tail */
Vec rotation_vector_rate(Arena *arena, const RotationVector *phi, Vec w);
/* the moment T in axes of the tail with T . w = effort . phi' for every w */
Vec rotation_vector_moment(Arena *arena, const RotationVector *phi, Vec effort);

#endif
