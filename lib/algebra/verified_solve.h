/* verified_solve.h: square systems B x = b with badly scaled rows and columns
 *
 * Solved in numbers of twice the digits (double_double.h), block by block of the block triangular
 * form, so that structural zeros of x are exactly 0, with an error bound for every number. B (n x
 * n) is stored row by row. */
#ifndef COTREE_ALGEBRA_VERIFIED_SOLVE_H
#define COTREE_ALGEBRA_VERIFIED_SOLVE_H

#include <stdbool.h>

typedef struct VerifiedSolve VerifiedSolve;

/* New; free with verified_solve_free(). Borrows both, n x n; an entry of the matrix may be off by
 * its `error`, and is certainly 0 where both are. O(n^3), less where blocks are small. */
VerifiedSolve *verified_solve_new(const double *matrix, const double *error, int n);
void verified_solve_free(VerifiedSolve *solve); /* NULL is fine */
/* no matrix within the errors is singular */
bool verified_solve_is_regular(const VerifiedSolve *solve);
/* The solution, and how far it may be off with a right side that may be off itself. An error may be
 * NULL: none. O(n^2). Of a regular one only. */
void verified_solve_solution(const VerifiedSolve *solve, const double *right,
                             const double *right_error, double *out, double *out_error);

#endif
