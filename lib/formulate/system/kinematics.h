/* kinematics.h: how the frames move: turns and shifts along the trees, coordinates and speeds
 *
 * Turns. The orientation of a frame is a product of turns along the rotation tree,
 * each about an axis that is constant in the position where every coordinate is 0,
 * and a constant rotation: R_0n = exp(k1 a1) exp(k2 a2) ... Z_n. Frames that differ by
 * constant rotations only share a *chain*: the last turn on their way. A vector fixed
 * in a frame is kept as (chain, Z_n r): neighbours about one axis merge because
 * their k are the same three expressions.
 *
 * Steps. Along the translation tree every node stands one constant or sliding shift
 * from its parent, a vector of one chain.
 *
 * Symbols: k axis of a turn, c a chain, n a node, r a shift, w angular velocity,
 * a0 acceleration that is left at u' = 0 (alpha0 likewise). */
#ifndef COTREE_FORMULATE_SYSTEM_KINEMATICS_H
#define COTREE_FORMULATE_SYSTEM_KINEMATICS_H

#include "base/memory.h"
#include "formulate/system/system.h"
#include "formulate/system/vector.h"

/* one turn of the rotation tree, or one free rotation by Euler parameters */
typedef struct OrientationClass {
    int parent; /* -1: ground's own */
    int depth;
    int first; /* what hangs beyond it has the numbers first..last */
    int last;
    int resolve; /* chain in whose axes vectors of this one are computed by the recursive form */
    int speed;   /* the first of its speeds */
    int speed_count; /* 1, or 3 where it is free */
    bool is_free;
    bool is_askew; /* a turn about none of the axes */
    Vec axis;      /* turn: zero-position axes, the same components before and after */
    Expr angle;    /* turn: the coordinate, or its negative where the branch is passed backwards */
    int run;       /* the first of the chains up to this one that turn about one line */
    Expr turned;   /* by all of these, about the axis of the first */
    Rotation matrix;   /* free or askew: zero-position components after it to those before it */
    Expr parameter[4]; /* free: Euler parameters of that matrix */
    Expr identity;     /* as identity.h tells it; NULL: not told */
} OrientationClass;

/* a speed: what it moves, and along what */
typedef struct Speed {
    int chain;     /* that it turns; -1: none */
    int turn_node; /* that its branch of the rotation tree leads to */
    Vec axis;      /* of the turn, zero-position axes of `axis_chain` */
    int axis_chain;
    int shape_node; /* of a shape, which moves stations by dependent speeds: the root */
    int slide_node; /* that its branch of the translation tree leads to; -1: it doesn't slide */
    Vec turn;       /* the axis in the axes of turn_node */
    Vec slide;      /* motion per unit in the axes of slide_node; both may be: a screw */
} Speed;

/* how a coordinate's rate follows from speeds */
typedef struct CoordinateRate {
    int count;
    int *speed;
    Expr *entry; /* of N */
} CoordinateRate;

/* a shift coordinate in a step */
typedef struct Slide {
    int speed;
    Vec axis; /* of the step's chain, sign included */
} Slide;

typedef struct Frame { /* a mechanical node */
    int chain;
    Rotation zero; /* Z_n */
    /* step from the translation tree's parent; shift and slides point from it to this node */
    int parent; /* node; -1: ground */
    int base;   /* node in whose frame the shift is fixed: the edge's tail */
    int step_chain;
    Vec shift;
    int slide_count;
    Slide *slide;
    /* quantities of the recursive form, in the axes of resolve(chain) */
    Vec step; /* the shift */
    Vec v;
    Vec product;   /* velocity products of the step's acceleration */
    Expr identity; /* as identity.h tells it; NULL: not told */
} Frame;

typedef struct OrientationMotion { /* in the axes of its resolve chain */
    Vec w;
    Vec product; /* velocity products of the turn's angular acceleration */
} OrientationMotion;

struct Dependent;

typedef struct Kinematics {
    LIST(Variable) q;
    LIST(Variable) u;
    Expr *accelerations; /* symbols of u' */
    int **coordinate;    /* of an instance's coordinates: their places in q, or -1 */
    int **speed;         /* and in u, or -1 */
    Speed *speeds;       /* those of u, then those that follow from shapes (shapes.h) */
    int speed_count;
    LIST(struct Dependent) dependents;
    SectionFrame **stations;   /* of instances; NULL: it is none */
    int *section_frame_speeds; /* the first of its dependent speeds */
    CoordinateRate *coordinate_rates;
    LIST(int) quaternions; /* the first of each four parameters */
    LIST(OrientationClass) chains;
    Frame *frames; /* one a node of the graph; scalar nodes unused */
    OrientationMotion *motions;
    Vec *alpha0; /* of chains, in the axes of their resolve chain */
    Vec *a0;     /* of nodes */
} Kinematics;

#endif
