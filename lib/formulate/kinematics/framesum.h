/* framesum.h: vectors as sums over chains, for the expanded form */
#ifndef COTREE_FORMULATE_KINEMATICS_FRAMESUM_H
#define COTREE_FORMULATE_KINEMATICS_FRAMESUM_H

#include "formulate/system/system.h"
#include "formulate/system/vector.h"

typedef struct Part {
    int chain;
    Vec v; /* zero-position axes of the chain */
} Part;

typedef struct FrameSum {
    Part *parts; /* in the system's pool, by chain */
    int count;
} FrameSum;

FrameSum framesum_add(const System *system, FrameSum a, Expr scale, FrameSum b);
FrameSum framesum_of(const System *system, int chain, Vec v);
/* k of chain `turn` crossed with each part */
FrameSum framesum_cross(const System *system, Vec axis, int chain, FrameSum b);
Expr framesum_dot(const System *system, FrameSum a, FrameSum b);
/* the way from one node to another along the translation tree */
FrameSum framesum_way(const System *system, int from, int to);

#endif
