/* groups.h: nodes that no speed moves against one another, taken together as one rigid body
 *
 * Each group but the first, which is the datum, is joined to one before it by one speed: a turn at
 * its origin, or a shift of it. Joints of several speeds have groups without mass between. */
#ifndef COTREE_FORMULATE_REDUCED_GROUPS_H
#define COTREE_FORMULATE_REDUCED_GROUPS_H

#include "base/memory.h"
#include "formulate/system/system.h"
#include "formulate/system/vector.h"

typedef struct Group {
    int parent;  /* -1: the datum */
    int chain;   /* in whose axes its vectors stand */
    int speed;   /* that joins it */
    bool slides; /* it shifts the origin; else it turns about that */
    Vec axis;    /* per unit of the speed, the same in the parent's axes and in its own */
    Vec way;     /* from the parent's origin, in the axes of the parent's chain */
    Expr mass;   /* about the origin */
    Vec moment;
    Rotation inertia;
    /* Whatever the turns beyond: all the mass that the speed moves, and what moments of inertia of
     * that about the origin are never above. */
    Expr carried, spread;
    int height; /* groups beyond, one after the other */
} Group;

typedef struct Groups {
    LIST(Group) all; /* outward */
} Groups;

/* Free with groups_free(). NULL: something deforms, turns freely, or one speed both turns and
 * shifts. */
Groups *groups_new(const System *system);
void groups_free(Groups *groups); /* NULL is fine */
/* Of what a turn moves, let the group before carry what the turn doesn't change: mass, first moment
 * along the axis, and one of the moments of inertia across it (Gautier and Khalil 1990). */
void groups_move_inertia(Arena *arena, Groups *groups);

#endif
