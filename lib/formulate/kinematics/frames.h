/* frames.h: orientation classes and joint primitives along the trees, and vectors in their axes */
#ifndef COTREE_FORMULATE_KINEMATICS_FRAMES_H
#define COTREE_FORMULATE_KINEMATICS_FRAMES_H

#include "formulate/system/kinematics.h"

/* builds orientation classes, frames and joint primitives from the trees; masses. */
void frames_build(System *system);

typedef struct Turn {
    Vec axis;
    Expr angle;
    const Rotation *matrix; /* of a free rotation; NULL: a turn about the axis */
    bool back;              /* the matrix is passed from head to tail */
} Turn;
typedef LIST(Turn) Turns;

/* the turns from one orientation class to another, neighbours about one axis merged: R_from_to */
void turns_between(const System *system, int from, int to, Turns *turns);
/* components of v in the axes of orientation class `to`, from those in class `from` */
Vec vec_express(const System *system, Vec v, int from, int to);
/* likewise, but a turn about an oblique axis is applied as a matrix that many vectors share */
Vec vec_carry(const System *system, Vec v, int from, int to);
Vec vec_carry_held(const System *system, Vec v, int from, int to);
/* a vector fixed in the datum, in the axes of every orientation class whose vectors are computed
 * there */
void vec_express_outward(const System *system, Vec v, Vec *out);
/* likewise, in the axes of the orientation classes that are needed */
typedef struct Outward {
    Vec *at;
    bool *is_known;
} Outward;
Outward outward_new(const System *system, Vec v);
Vec outward_at(const System *system, Outward *outward, int chain);
void outward_free(Outward *outward);
/* the orientation class in whose axes the recursive form has the vectors of a node */
int node_axes(const System *system, int node);
/* axis of a speed's turn, in the axes of an orientation class */
Vec speed_axis(const System *system, int speed, int axes);
/* direction in which it slides its node, per unit, in the axes of an orientation class; 0 if it is
 * no slide */
Vec speed_slide(const System *system, int speed, int axes);
/* the nearest node to the datum that the speed moves */
int speed_node(const System *system, int speed);
bool orientation_is_beyond(const System *system, int chain, int turn); /* or the same */
/* angle of a constant rotation about an axis */
Expr rotation_angle(Arena *arena, const Rotation *rotation, Vec axis);
/* axes of the frame of a joint's tail to zero-position components */
Vec frame_vector(const System *system, int node, Vec in_frame);
/* the joint primitives of an instance's type */
void instance_steps(const System *system, const Instance *instance, Steps *steps);
/* frames that some speed moves, one flag for each node: new, mem_free() */
bool *frames_moving(const System *system);

#endif
