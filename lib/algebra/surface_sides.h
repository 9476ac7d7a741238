/* surface_sides.h: sides on the surfaces that a motion stands on
 *
 *     slip = a + B s,  -r <= s <= r, or where it is unilateral 0 <= s
 *
 * s: signs of the surfaces h = 0 in the equations; slip: how each is left, h' or what of it signs
 * affect. s = r: it is left to h > 0, slip >= 0; s = -r: to h < 0, slip <= 0; otherwise the motion
 * slides along it, slip = 0. With M = -B and q = -a that is a complementarity problem with bounds
 * (complementarity.h). M is positive semidefinite where what jumps pushes back, as dry friction
 * does. Where B_ii > 0 what jumps pushes away, and nothing slides there.
 *
 * r is above 1 where static friction is larger than kinetic: a surface that is left then has the
 * sign +-1, and the others are solved for again; so is one that was left where those turn it back.
 * At most as many rounds as surfaces. Where a surface is unilateral s is the effort that keeps h
 * from being positive: 0 where it is left to h < 0.
 *
 * A surface may have a load, the effort of a unilateral one: then s is an effort too, of size up to
 * r times the load while the motion slides along it, and the kinetic share of the load where it is
 * left.
 *
 * Surfaces in a row may be a cone, as friction in a plane is: r bounds the norm of their signs, and
 * they are all slid along or all left, with slip = c s, c >= 0, |s| = r. The side of what is left
 * is 1, and s the direction (norm_complementarity.h).
 *
 * Freestanding: no allocation, no library but math. The file is also part of FMUs. */
#ifndef COTREE_ALGEBRA_SURFACE_SIDES_H
#define COTREE_ALGEBRA_SURFACE_SIDES_H

#include "algebra/norm_complementarity.h"

#include <stdbool.h>

/* a surface that the motion stands on */
typedef struct SurfaceSide {
    double bound; /* r; of what is unilateral no number */
    double left;  /* the size of s where it is left: 1; with a load its kinetic share */
    int load;     /* the surface whose effort is the load; -1: none */
    bool is_unilateral;
    int cone;   /* at the first surface of a cone how many it has; -1: at its others; 0: of none */
    double off; /* h where slip is h', or h' where it is h'': 0 if the motion stands on it */
    int side;   /* given: to which it is left, 0 where that is not known; found: 0: slid along */
    bool ends;  /* given: its sign has reached its bound on that side */
    bool settles;            /* given: the motion counts as at rest on it, however far it is off */
    bool is_known, is_fixed; /* within the search: its side is, beforehand or by now; */
    bool leaves, is_left;    /* and a cone is left in a direction that is to be found, likewise */
    bool held;  /* found: on a side, while those that are slid along keep it on its surface */
    bool rests; /* found, with a load: held, and others hold it without its effort: its sign is 0 */
    bool is_unaffected; /* found: no sign changes how it is left: its side is left to the equations
                         */
    double sign;        /* found; of a cone with a load that is left its direction, of norm 1 */
} SurfaceSide;

/* slip of all surfaces with these signs; false: it can't be evaluated there */
typedef bool (*SurfaceSlip)(void *context, const double *signs, double *slip);

/* room in numbers and in integers for n surfaces */
#define SURFACE_SIDES_ROOM(n)     (LOAD_COMPLEMENTARITY_ROOM(n) + 2 * (n) * (n) + 11 * (n))
#define SURFACE_SIDES_INTEGERS(n) (6 * (n) + LOAD_COMPLEMENTARITY_INTEGERS(n))

/* Finds sides, signs, and what is held or loose. insists: a sign that has reached its bound leaves
 * there, whatever the problem's solution is; size: of the state, by which `off` is judged. False:
 * no motion leads on. */
bool surface_sides_find(SurfaceSide *at, int n, SurfaceSlip slip, void *context, bool insists,
                        double size, double *room, int *integers);

#endif
