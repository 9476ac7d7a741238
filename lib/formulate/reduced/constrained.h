/* constrained.h: M u' + G^T lambda = F, G u' = gamma solved in symbols, for the program of a run
 *
 * M is nu x nu; G are the constraint rows in use. */
#ifndef COTREE_FORMULATE_REDUCED_CONSTRAINED_H
#define COTREE_FORMULATE_REDUCED_CONSTRAINED_H

#include "formulate/system/system.h"

/* Indices at which the arrays of Constrained start in a single array: accelerations, then
 * multipliers, and so on in their order. Entries from `step` on read the symbols of multipliers,
 * those before don't. */
typedef struct ConstrainedPlaces {
    int multiplier, excess, pivot, taken, left, step;
    int count; /* all of them */
} ConstrainedPlaces;

static inline ConstrainedPlaces constrained_places(int nu, int rows, int looked_at, int waiting)
{
    ConstrainedPlaces p = {.multiplier = nu};

    p.excess = p.multiplier + rows;
    p.pivot = p.excess + nu;
    p.taken = p.pivot + looked_at;
    p.left = p.taken + looked_at;
    p.step = p.left + waiting;
    p.count = p.step + nu;
    return p;
}

/* Arrays in one allocation, which starts with the first. */
typedef struct Constrained {
    Expr *acceleration; /* nu: u' */
    Expr *multiplier;   /* rows: lambda */
    Expr *excess;       /* nu: of pivots of M (accelerations.h) */
    /* looked_at: pivot d of a multiplier, its sign reversed, and p, from which d remains. For all
     * rows; or for none, where the rows are independent in every position (substituted.h). */
    Expr *pivot, *taken;
    int looked_at;
    Expr *left; /* of speeds eliminated after the rows: what remains of their pivots */
    int left_count;
    Expr *step; /* nu: du of M du + G^T mu = 0, G du = s, where s_k is the multiplier's symbol */
    ConstrainedPlaces places;
} Constrained;

/* For this F, and gamma of all m rows. New; constrained_free(). NULL: M has no pivot for some
 * speed, rows are dependent whatever the numbers, elimination needs more than `most` products
 * (INFINITY: no limit), or straight-line code is not worth its size. The arena remains usable. */
Constrained *constrained_new(System *view, const int *rows, int row_count, const Expr *force,
                             const Expr *gamma, double most);
void constrained_free(Constrained *constrained); /* NULL is fine */

#endif
