/* norm_complementarity.h: complementarity problems with bounds on norms
 *
 * The problem of complementarity.h, where some unknowns have one bound r together: of such a cone
 * of rows i .. i + k - 1, with |z| the norm of theirs, one holds:
 *
 *     BETWEEN  w = 0 and |z| <= r
 *     AT_HIGH  |z| = r and w = -c z with c >= 0
 *
 * Of dry friction in two or three directions z is the force against the motion in parts of its
 * bound, and -w the acceleration: it leaves along z. Where M is symmetric and positive
 * semidefinite, but for factors of its columns that are the same within a cone, there is a
 * solution.
 *
 * Solved block by block (Gauss and Seidel, where each block is solved exactly), then by Newton's
 * method on z = P(z - w), P the projection onto the bounds. Freestanding: no allocation, no library
 * but math.
 *
 * Source: Alart and Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991), for that form of the
 * law. */
#ifndef COTREE_ALGEBRA_NORM_COMPLEMENTARITY_H
#define COTREE_ALGEBRA_NORM_COMPLEMENTARITY_H

#include "algebra/complementarity.h"

enum { CONE_ROWS = 3 }; /* of a cone, at most */

typedef struct NormComplementarity {
    Complementarity box; /* of the first row of a cone `high` is r; its other bounds aren't read */
    const int *rows;     /* at the first row of a cone how many it has; 0: at its others; 1: none */
    const int *load;     /* at a row or the first one of a cone the row whose unknown times `share`
                            is its bound, in place of `low` and `high`; -1: none. NULL: there are
                            none */
    const double *share; /* likewise */
    const int *slips;    /* at the first row of a cone: not 0 where it is AT_HIGH, whatever c is */
} NormComplementarity;

/* numbers of workspace for n unknowns */
#define NORM_COMPLEMENTARITY_ROOM(n) ((n) * ((n) + 5))

/* Solves the problem: z are first guesses, and becomes the solution; `side` (n, of a cone at its
 * first row) its sides. False: none was found. O(n^2) a sweep, O(n^3) a step of Newton's method. */
bool norm_complementarity_solve(const NormComplementarity *problem, int *side, double *z,
                                double *room);

#endif
