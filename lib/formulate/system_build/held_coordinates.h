/* held_coordinates.h: coordinates that do not change when an event sets positions, as far as
 * possible
 *
 * The same in any tree: coordinates of the existing joints and of flexible parts. Where assemblies
 * float, without a joint to ground, also those of their bodies and of frames that the event
 * names. */
#ifndef COTREE_FORMULATE_SYSTEM_BUILD_HELD_COORDINATES_H
#define COTREE_FORMULATE_SYSTEM_BUILD_HELD_COORDINATES_H

#include "formulate/system/system.h"

typedef struct HeldCoordinate {
    char *name;       /* as a user writes it; NULL: it has no name of its own */
    const char *part; /* the part that it belongs to; borrowed */
    Expr value, rate; /* a position, and its derivative */
    int node;         /* of a frame of a floating assembly; -1: of a joint, or a shape */
    bool is_body;     /* that frame is a body's; otherwise it is only named by the event */
    int attitude;     /* number of the attitude that has it as Euler parameter, 0, 1 ...; -1 */
} HeldCoordinate;

/* In order of making, joints first; *out is new, held_coordinates_free(). `named` (count):
 * variables that events set. Returns their number. */
int system_held_coordinates(System *system, const char *const *named, int count,
                            HeldCoordinate **out);
void held_coordinates_free(HeldCoordinate *held, int count);

/* of a variable that an event sets */
typedef struct Named {
    int node; /* the frame whose position or attitude it is; -1 */
    /* number of the attitude that has it as Euler parameter, distinct from those of held
     * coordinates; -1 */
    int attitude;
    Expr rate; /* of a position, where it follows from speeds; NULL */
    /* for the first three of an attitude: a component of its angular velocity; NULL */
    Expr turning;
} Named;
void system_named(System *system, const char *name, Named *out);

#endif
