/* constrained.h: M u' + G^T lambda = F, G u' = gamma solved in symbols, where a run's program does
 * that: G are the constraint rows in use */
#ifndef COTREE_FORMULATE_REDUCED_CONSTRAINED_H
#define COTREE_FORMULATE_REDUCED_CONSTRAINED_H

#include "formulate/system/system.h"

/* Where the arrays of Constrained begin in one: accelerations, then multipliers, and so on as they
 * stand there; what is from `step` on reads the symbols of multipliers, what is before doesn't. */
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

/* Arrays in one, which the first begins. */
typedef struct Constrained {
    Expr *acceleration; /* nu: u' */
    Expr *multiplier;   /* rows: lambda */
    Expr *excess;       /* nu: of pivots of M (accelerations.h) */
    /* looked_at: pivot d of a multiplier, its sign reversed, and p, of which that is the rest. Of
     * all rows; or of none, where they are independent whatever the position (substituted.h). */
    Expr *pivot, *taken;
    int looked_at;
    Expr *left; /* of speeds that wait for the rows: what is left of their pivots */
    int left_count;
    Expr *step; /* nu: du of M du + G^T mu = 0, G du = s, where s_k is the multiplier's symbol */
    ConstrainedPlaces places;
} Constrained;

/* With these F, and gamma of all m rows. New; constrained_free(). NULL: some M has no pivot, rows
 * are dependent whatever the numbers, elimination takes more than `most` products (INFINITY: as
 * many as it likes), or it is more than a straight line is worth; the arena is as sound as before.
 */
Constrained *constrained_new(System *view, const int *rows, int row_count, const Expr *force,
                             const Expr *gamma, double most);
void constrained_free(Constrained *constrained); /* NULL is fine */

#endif
