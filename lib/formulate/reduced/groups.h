/* groups.h: nodes that no speed moves relative to each other, combined into one rigid body
 *
 * The first group is the datum. Each other group is joined to one before it by one speed: a turn at
 * its origin, or a shift of it. Joints of several speeds have groups without mass in between. */
#ifndef COTREE_FORMULATE_REDUCED_GROUPS_H
#define COTREE_FORMULATE_REDUCED_GROUPS_H

#include "base/memory.h"
#include "formulate/system/system.h"
#include "formulate/system/vector.h"

typedef struct Group {
    int parent;  /* -1: the datum */
    int chain;   /* orientation class in whose axes its vectors are */
    int speed;   /* the speed that joins it to the parent */
    bool slides; /* it shifts the origin; otherwise it turns about the origin */
    Vec axis;    /* per unit of the speed, the same in the parent's axes and in its own */
    Vec way;     /* from the parent's origin, in the axes of the parent's orientation class */
    Expr mass;   /* about the origin */
    Vec moment;
    Rotation inertia;
    /* For any turns beyond: all the mass that the speed moves, and an upper bound of its moments of
     * inertia about the origin. */
    Expr carried, spread;
    int height; /* length of the longest sequence of groups beyond */
} Group;

typedef struct Groups {
    LIST(Group) all; /* outward */
} Groups;

/* Free with groups_free(). NULL: a part is flexible or turns freely, or one speed both turns and
 * shifts. */
Groups *groups_new(const System *system);
void groups_free(Groups *groups); /* NULL is fine */
/* Moves those inertia parameters of what a turn moves that the turn doesn't change to the group
 * before: mass, first moment along the axis, and one of the moments of inertia across it (Gautier
 * and Khalil 1990). */
void groups_move_inertia(Arena *arena, Groups *groups);

#endif
