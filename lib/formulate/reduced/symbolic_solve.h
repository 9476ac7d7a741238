/* symbolic_solve.h: a linear system with several right sides, solved in symbols */
#ifndef COTREE_FORMULATE_REDUCED_SYMBOLIC_SOLVE_H
#define COTREE_FORMULATE_REDUCED_SYMBOLIC_SOLVE_H

#include "expr/expr.h"

/* A x = b by blocks (Duff and Reid 1978): small ones by Cramer's rule, so that no fractions cancel,
 * larger ones by elimination, whose intermediate results become named temporaries.
 *
 * a        n x n, row by row; x, b: n x columns
 * units    Euler parameters: of each four symbols the squares add up to 1
 * unknown  set where the matrix is singular for any numbers: one that it leaves undetermined
 *
 * Fails with E_SINGULAR, without a message, and E_STOPPED. */
MUST_USE Status symbolic_solve(Arena *arena, const Expr *a, const Expr *b, int n, int columns,
                               const Expr *units, int unit_count, const CallMonitor *watch, Expr *x,
                               int *unknown);
/* The number in the place of each sum that is 0, 1 or -1 for such `units`. */
void symbolic_fold_units(Arena *arena, Expr *e, int count, const Expr *units, int unit_count);
/* The same value as one fraction where it is short: multiplied out, folded and collected. */
Expr symbolic_tidy(Arena *arena, Expr e);

#endif
