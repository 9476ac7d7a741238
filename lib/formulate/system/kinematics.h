/* kinematics.h: motion of the frames: turns and shifts along the trees, coordinates and speeds
 *
 * Turns. The orientation of a frame is a product of turns along the rotation tree, each about an
 * axis that is constant in the position where every coordinate is 0, and a constant rotation (3 x
 * 3): R_0n = exp(k1 a1) exp(k2 a2) ... Z_n. Frames that differ by constant rotations only share an
 * *orientation class* (field `chain`): the last turn on their path. A vector r fixed in a frame is
 * stored as (class, Z_n r). Neighbours about one axis merge because their k are the same three
 * expressions.
 *
 * Steps. Along the translation tree every node is one constant or sliding shift from its parent, a
 * vector of one orientation class.
 *
 * Symbols: k axis of a turn (unit vector), a its angle (rad), c an orientation class, n a node, r a
 * shift (m), w angular velocity (rad/s), a0 acceleration at u' = 0 (m/s^2; alpha0 likewise,
 * rad/s^2). */
#ifndef COTREE_FORMULATE_SYSTEM_KINEMATICS_H
#define COTREE_FORMULATE_SYSTEM_KINEMATICS_H

#include "base/memory.h"
#include "formulate/system/system.h"
#include "formulate/system/vector.h"

/* one turn of the rotation tree, or one free rotation by Euler parameters */
typedef struct OrientationClass {
    int parent; /* -1: ground's own */
    int depth;
    int first; /* all classes beyond it have the numbers first..last */
    int last;
    int resolve;     /* class in whose axes the recursive form computes the vectors of this one */
    int speed;       /* the first of its speeds */
    int speed_count; /* 1, or 3 where it is free */
    bool is_free;
    bool is_askew; /* a turn about an oblique axis, none of the frame's axes */
    Vec axis;      /* turn: zero-position axes, the same components before and after */
    Expr angle;    /* turn: the coordinate, or its negative where the branch is passed backwards */
    /* the first class of its coaxial group: those up to this one that turn about one line */
    int run;
    Expr turned;       /* sum of the angles in this group so far, about the axis of the first */
    Rotation matrix;   /* free or askew: zero-position components after it to those before it */
    Expr parameter[4]; /* free: Euler parameters of that matrix */
    Expr identity;     /* see identity.h; NULL: unknown */
} OrientationClass;

/* a speed: what it moves, and in which direction */
typedef struct Speed {
    int chain;     /* the orientation class that it turns; -1: none */
    int turn_node; /* the far node of its branch of the rotation tree */
    Vec axis;      /* of the turn, zero-position axes of `axis_chain` */
    int axis_chain;
    int shape_node; /* of a shape, which moves section frames by dependent speeds: the root */
    int slide_node; /* the far node of its branch of the translation tree; -1: it doesn't slide */
    Vec turn;       /* the axis in the axes of turn_node */
    Vec slide;      /* motion per unit in the axes of slide_node; a screw has both */
} Speed;

/* how a coordinate's rate follows from speeds */
typedef struct CoordinateRate {
    int count;
    int *speed;
    Expr *entry; /* of N */
} CoordinateRate;

/* a slide coordinate in the shift to a node */
typedef struct Slide {
    int speed;
    Vec axis; /* in the axes of the shift's orientation class, with its sign */
} Slide;

typedef struct Frame { /* a mechanical node */
    int chain;
    Rotation zero; /* Z_n */
    /* shift from the translation tree's parent; shift and slides point from the parent to this
     * node */
    int parent; /* node; -1: ground */
    int base;   /* node in whose frame the shift is fixed: the edge's tail */
    int step_chain;
    Vec shift;
    int slide_count;
    Slide *slide;
    /* quantities of the recursive form, in the axes of resolve(chain) */
    Vec step; /* the shift */
    Vec v;
    Vec product;   /* velocity products of the shift's acceleration */
    Expr identity; /* see identity.h; NULL: unknown */
} Frame;

typedef struct OrientationMotion { /* in the axes of its resolve class */
    Vec w;
    Vec product; /* velocity products of the turn's angular acceleration */
} OrientationMotion;

struct Dependent;

typedef struct Kinematics {
    LIST(Variable) q;
    LIST(Variable) u;
    Expr *accelerations; /* symbols of u' */
    int **coordinate;    /* indices in q of an instance's coordinates, or -1 */
    int **speed;         /* and in u, or -1 */
    /* those of u, then the dependent speeds that follow from shapes (section_frames.h) */
    Speed *speeds;
    int speed_count;
    LIST(struct Dependent) dependents;
    SectionFrame **stations;   /* of instances; NULL: the instance is no section frame */
    int *section_frame_speeds; /* the first of its dependent speeds */
    CoordinateRate *coordinate_rates;
    LIST(int) quaternions; /* the index of the first of each four parameters */
    LIST(OrientationClass) chains;
    Frame *frames; /* one for each node of the graph; scalar nodes unused */
    OrientationMotion *motions;
    Vec *alpha0; /* of orientation classes, in the axes of their resolve class */
    Vec *a0;     /* of nodes */
} Kinematics;

#endif
