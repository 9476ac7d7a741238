/* complementarity.h: linear complementarity problems with bounds
 *
 * Given M (n x n, row by row), q, l <= u, find z and w = M z + q such that for each i one holds:
 *
 *     BETWEEN  w_i = 0 and l_i <= z_i <= u_i
 *     AT_LOW   z_i = l_i and w_i >= 0
 *     AT_HIGH  z_i = u_i and w_i <= 0
 *
 * u_i may be INFINITY. Of dry friction z is the effort against the motion in parts of its bound and
 * -w the acceleration: BETWEEN it sticks. Where M is positive semidefinite there is a solution; it
 * is the only one where M is positive definite. Freestanding: no allocation, no library but math.
 *
 * Sources: Murty, Linear Complementarity (1988); Judice and Pires, Comput. Oper. Res. 21 (1994) for
 * the exchange of blocks; Lemke, Management Science 11 (1965), with the lexicographic rule. */
#ifndef COTREE_ALGEBRA_COMPLEMENTARITY_H
#define COTREE_ALGEBRA_COMPLEMENTARITY_H

#include <stdbool.h>
#include <stddef.h>

typedef enum BoundSide { AT_LOW = -1, BETWEEN = 0, AT_HIGH = 1 } BoundSide;

typedef struct Complementarity {
    int n;
    const double *matrix;     /* n x n */
    const double *q;          /* n */
    const double *low, *high; /* n; low finite */
} Complementarity;

/* numbers of workspace for n unknowns */
#define COMPLEMENTARITY_ROOM(n) ((n) * (10 * (n) + 14))

/* Solves A x = b by elimination with row exchanges (A: n x n): x replaces b, and A is lost. False:
 * a pivot is no more than `regular` times the largest of `least` and its column. O(n^3). */
bool complementarity_eliminate(double *a, int n, double *b, double regular, double least);
/* Solves the problem: `side` (n, a BoundSide each) are first guesses and become the sides of the
 * solution, z becomes its values. Unknowns BETWEEN have independent rows: M restricted to them is
 * regular, and no unknown
 * with w_i = 0 could be added to them. An unknown with M_ii < 0 is never BETWEEN: it would not
 * remain there. Tries the exchange of blocks from the first guesses, then Lemke's method, then for
 * n <= 9 all sides, those nearest to the guesses first. False: none was found; then `side` and z
 * have no meaning. O(n^3) an exchange; mostly 2 to 7 of them, up to 2 n pivots of O(n^2) for
 * Lemke's method. */
bool complementarity_solve(const Complementarity *problem, int *side, double *z, double *room);

/* The same where some unknowns are bounded by another one, their load: |z_i| <= c_i z_k, with
 * z_k >= 0 by its own bounds. Of dry friction in a contact z_k is the normal force. */
typedef struct LoadComplementarity {
    Complementarity box; /* of a row with a load low and high aren't read */
    const int *load;     /* n: the k of each row; -1: it has none */
    const double *share; /* n: c */
} LoadComplementarity;

/* numbers and integers of workspace for n unknowns */
#define LOAD_COMPLEMENTARITY_ROOM(n)     (COMPLEMENTARITY_ROOM(2 * (n)) + 4 * (n) * (n) + 9 * (n))
#define LOAD_COMPLEMENTARITY_INTEGERS(n) (4 * (n))

/* Solves it by complementarity_solve() in z_i + c_i z_k >= 0 and the part of w_i that is below 0,
 * which doubles those rows; arguments, result and cost are as there. M needn't be symmetric in
 * effect: there may be several solutions, or none (Painleve). */
bool load_complementarity_solve(const LoadComplementarity *problem, int *side, double *z,
                                double *room, int *integers);

#endif
