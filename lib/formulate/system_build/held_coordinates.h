/* held_coordinates.h: what stays where an event sets positions, as far as that leaves it a choice
 *
 * In any tree the same: coordinates of the joints that are there and of what deforms, and where
 * chains float, joined to ground by no joint, those of their bodies and of frames that the event
 * names. */
#ifndef COTREE_FORMULATE_SYSTEM_BUILD_HELD_COORDINATES_H
#define COTREE_FORMULATE_SYSTEM_BUILD_HELD_COORDINATES_H

#include "formulate/system/system.h"

typedef struct HeldCoordinate {
    char *name;       /* as a user asks for it; NULL: by no name of its own */
    const char *part; /* whose it is; borrowed */
    Expr value, rate; /* a position, and its derivative */
    int node;         /* of a frame of a floating chain; -1: of a joint, or a shape */
    bool is_body;     /* that frame is a body's; else the event names it alone */
    int attitude;     /* that it is an Euler parameter of, 0, 1 ...; -1 */
} HeldCoordinate;

/* In order of making, joints first; *out is new, held_coordinates_free(). `named` (count):
 * variables that events set. Returns how many. */
int system_held_coordinates(System *system, const char *const *named, int count,
                            HeldCoordinate **out);
void held_coordinates_free(HeldCoordinate *held, int count);

/* of a variable that an event gives */
typedef struct Named {
    int node;     /* of the frame whose position or attitude it is; -1 */
    int attitude; /* that it is an Euler parameter of, other numbers than of stays; -1 */
    Expr rate;    /* of a position, where speeds tell it; NULL */
    Expr turning; /* of the first three of an attitude: a component of its angular velocity; NULL */
} Named;
void system_named(System *system, const char *name, Named *out);

#endif
