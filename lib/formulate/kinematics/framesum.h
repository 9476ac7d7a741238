/* framesum.h: vectors as sums over orientation classes, for the expanded form */
#ifndef COTREE_FORMULATE_KINEMATICS_FRAMESUM_H
#define COTREE_FORMULATE_KINEMATICS_FRAMESUM_H

#include "formulate/system/system.h"
#include "formulate/system/vector.h"

typedef struct Part {
    int chain;
    Vec v; /* axes of the orientation class at the zero position */
} Part;

typedef struct FrameSum {
    Part *parts; /* in the system's pool, by orientation class */
    int count;
} FrameSum;

FrameSum framesum_add(const System *system, FrameSum a, Expr scale, FrameSum b);
FrameSum framesum_of(const System *system, int chain, Vec v);
/* k of orientation class `turn` crossed with each part */
FrameSum framesum_cross(const System *system, Vec axis, int chain, FrameSum b);
Expr framesum_dot(const System *system, FrameSum a, FrameSum b);
/* the vector from one node to another along the translation tree */
FrameSum framesum_way(const System *system, int from, int to);

#endif
