/* frames.h: chains of turns and steps along the trees, and vectors carried between them */
#ifndef COTREE_FORMULATE_KINEMATICS_FRAMES_H
#define COTREE_FORMULATE_KINEMATICS_FRAMES_H

#include "formulate/system/kinematics.h"

/* chains, frames and steps from the trees; masses. */
void frames_build(System *system);

typedef struct Turn {
    Vec axis;
    Expr angle;
    const Rotation *matrix; /* of a free rotation; NULL: a turn about the axis */
    bool back;              /* the matrix is passed backwards */
} Turn;
typedef LIST(Turn) Turns;

/* the turns that lead from one chain to another, neighbours about one axis merged: R_from_to */
void turns_between(const System *system, int from, int to, Turns *turns);
/* components of v in the axes of chain `to`, from those in chain `from` */
Vec vec_express(const System *system, Vec v, int from, int to);
/* likewise, one turn askew by its matrix: what many vectors pass is formed once */
Vec vec_carry(const System *system, Vec v, int from, int to);
Vec vec_carry_held(const System *system, Vec v, int from, int to);
/* what is fixed in the datum, in the axes of every chain whose vectors are computed there */
void vec_express_outward(const System *system, Vec v, Vec *out);
/* likewise, in those of the chains that are asked for */
typedef struct Outward {
    Vec *at;
    bool *is_known;
} Outward;
Outward outward_new(const System *system, Vec v);
Vec outward_at(const System *system, Outward *outward, int chain);
void outward_free(Outward *outward);
/* the chain in whose axes the recursive form has what belongs to a node */
int node_axes(const System *system, int node);
/* what a speed turns about, in the axes of a chain */
Vec speed_axis(const System *system, int speed, int axes);
/* where it slides its node, per unit, in the axes of a chain; zero where it doesn't */
Vec speed_slide(const System *system, int speed, int axes);
/* the node nearest to the datum that it moves */
int speed_node(const System *system, int speed);
bool orientation_is_beyond(const System *system, int chain, int turn); /* or the same */
/* angle of a constant rotation about an axis */
Expr rotation_angle(Arena *arena, const Rotation *rotation, Vec axis);
/* axes of the frame of a joint's tail to zero-position components */
Vec frame_vector(const System *system, int node, Vec in_frame);
/* the row's steps of an instance */
void instance_steps(const System *system, const Instance *instance, Steps *steps);
/* those that some speed moves, a flag a node: new, mem_free() */
bool *frames_moving(const System *system);

#endif
