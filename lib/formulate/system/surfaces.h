/* surfaces.h: surfaces on which the equations jump, and the equations on a side of them or between
 *
 * f = f+ where h > 0, f- where h < 0. Where both lead to h = 0 the motion slides along this surface
 * (Filippov 1988). What jumps there has a value between its two: the sign of h is an unknown
 * between -1 and 1 (Utkin's equivalent control), such that h remains 0. Of stick(h, r), which
 * static friction is, it is between -r and r: such a surface is another one than that of sign(h).
 *
 * Of direction(v, n, r) the surface is that where n, the norm of a vector of two or three
 * components, is 0. Off it the equations are smooth; on it the motion is at rest, and each
 * component has a sign, with r a bound on the norm of theirs. Sign 1 of the surface itself is off
 * it, 0 on it.
 *
 * Of coulomb(v, n, b) it is an effort, or the components of one, of size up to b: on a side of the
 * surface n = 0 the equations have b with that sign. b may contain the effort of a unilateral
 * surface, the load: friction of a contact, which is idle while the contact is open.
 *
 * Of unilateral(h, e) it is the effort itself, 0 where h < 0 and 0 or more where h = 0, such that
 * h is never positive. What meets h = 0 with h' > 0 has an impact there: h' after it is -e times
 * what it was. */
#ifndef COTREE_FORMULATE_SYSTEM_SURFACES_H
#define COTREE_FORMULATE_SYSTEM_SURFACES_H

#include "expr/expr.h"
#include "expr/jumps.h" /* IWYU pragma: export */

enum { SURFACE_PARTS = 3 }; /* components of a vector */

/* the law of a surface, by which surfaces with one condition differ */
typedef struct SurfaceLaw {
    Expr ratio;         /* r; NULL: 1; of unilateral() its coefficient of restitution */
    Expr bound, hold;   /* b of coulomb() where it slips, and at rest; NULL: there is none */
    bool is_unilateral; /* h is never positive */
    bool is_norm;       /* h is the norm of a vector */
} SurfaceLaw;

typedef struct Surface {
    int number;     /* of system_surface(); -1: of none */
    Expr condition; /* h, as system_surface() returns it */
    SurfaceLaw law;
    bool may_slide;   /* the sign may be between -1 and 1 */
    Expr sign;        /* symbol of the sign of h */
    Expr measure;     /* h, with the surfaces' signs substituted */
    Expr bound, hold; /* those of the law, likewise */
    int load;         /* index of the unilateral surface whose effort is in b; -1: none */
    int part_count;   /* of direction() and coulomb(): components, each with a symbol; 0: none */
    Expr part[SURFACE_PARTS], part_sign[SURFACE_PARTS];
} Surface;

/* The law of a call that jumps. Where b is if(n == 0, x, y), x holds at rest. */
SurfaceLaw surface_law(Arena *arena, Expr call);
bool surface_law_is(const SurfaceLaw *law, const SurfaceLaw *other);

/* h of a condition, whatever its scale; *way -1: with the opposite sign */
Expr surface_of(Arena *arena, Expr condition, int *way);
/* Whether another condition is 0 on the same surface: their quotient is the same at POINTS random
 * points, where their terms are written differently, as a velocity in other axes. *way as above.
 * O(nodes). */
bool surface_is_same(Expr surface, Expr condition, int *way);
/* whether a coefficient of restitution is the one of a surface whose impacts an event has */
bool surface_rests(Expr ratio);
/* the component that direction() and coulomb() have; NULL: it is another call */
Expr surface_part(Expr call);
/* h of a call that jumps, as surface_of(); of unilateral() with its own sign: *way is 1. NULL: it
 * is a number. */
Expr surface_of_call(Arena *arena, Expr call, int *way);
/* whether a call jumps where its condition is 0 */
bool switch_jumps(Expr e);
/* whether anything in e jumps with symbols of these kinds (bits as of expr_kinds()); O(nodes) */
bool switch_jumps_over(Arena *arena, Expr e, unsigned kinds);
/* e with the signs of these surfaces substituted for what jumps on them. O(nodes). */
Expr surfaces_substitute(Arena *arena, Expr e, const Surface *surfaces, int count);

#endif
