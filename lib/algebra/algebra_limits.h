/* algebra_limits.h: tolerances and limits of lib/algebra, by file
 *
 * Relative and without unit where none is stated. Constants of a method's definition stand in its
 * file, and those of row_closure.h, complementarity.c and surface_sides.c there, since FMUs contain
 * these files. The test in brackets fails when the value is ten times as large. */
#ifndef COTREE_ALGEBRA_ALGEBRA_LIMITS_H
#define COTREE_ALGEBRA_ALGEBRA_LIMITS_H

/* rounding error of an operation in double precision, relative; an entry is no more accurate than
 * that */
#define UNIT_ROUNDOFF 0x1p-53

/* --- anderson.c --- */

/* of a difference's length: what remains orthogonal to the other differences and is shorter is
 * rounding error; the difference is left out */
#define ANDERSON_DEPENDENT 1e-10

/* --- independence.c --- */

/* times the rounding error of a Gram matrix: it is shifted by at least that much before the test
 * of definiteness, so that rounding can't simulate independence */
#define INDEPENDENCE_SHIFT 4

/* of the longest row: a shorter row consists of rounding error, and the test isn't applicable */
#define INDEPENDENCE_ZERO_ROW 1e-10

/* length of a row: its square, or that of its inverse, would lose digits or overflow */
#define INDEPENDENCE_LARGEST 1e100

/* --- kkt.c: d / p is the pivot of a row in K = [M G^T; G 0] over its reference, kkt_sizes.c --- */

/* pivot ratio of G G^T; below it a singular configuration is near, and answers have a larger
 * rounding error [test_simulate_linear] */
#define KKT_NEAR 1e-2

/* d / p; if all rows have more, no singular configuration is near. d / p was at most 1.7 times the
 * pivot ratio of G G^T. */
#define KKT_SUSPECT 2e-2

/* d / p; if all rows have more, no regularisation by epsilon is needed, and d / p replaces the
 * pivot ratio of G G^T, which takes another factorisation */
#define KKT_REGULAR 1e-3

/* the same as KKT_SUSPECT for factors with exchanged rows, least pivot over largest: a small pivot
 * p appears there as two of the size of sqrt(p) [test_simulate_linear] */
#define KKT_EXCHANGED 0.15

/* of the speeds, times 1 / pivot ratio: the rounding error of positions appears in answers near a
 * singular configuration */
#define KKT_ROUNDING 1e-14

/* largest value of that error; beyond it epsilon regularises */
#define KKT_MOST_ROUNDING 1e-8

/* d / p; below it one sweep of iterative refinement follows each solution */
#define KKT_INEXACT 1e-2

/* relative correction; a sweep that corrects more is followed by another */
#define KKT_SETTLED 1e-11

/* d / p; below it the pivot may be rounding error, and rows are exchanged */
#define KKT_LOST 1e-11

/* pivot of M over its diagonal entry; below it the pivot may be rounding error, and M counts as
 * singular */
#define KKT_NO_MASS 1e-12

/* least pivot over largest, with exchanged rows; below it K is singular */
#define KKT_UNSOLVABLE 1e-14

/* of the largest diagonal entry of M: a smaller one is replaced by that of speeds coupled to it,
 * when rows are scaled by masses */
#define KKT_LEAST_MASS 1e-9

/* iterative refinement with regularised factors: sweeps that are done in any case */
#define KKT_SWEEPS 2

/* sweeps at most */
#define KKT_MOST_SWEEPS 30

/* ratio of one correction to the last above which it ends: what converges more slowly is what
 * epsilon suppresses */
#define KKT_CONTRACTION 0.3

/* sweeps at most where rows determine all speeds, as drivers do, and nothing may be suppressed */
#define KKT_DRIVEN_SWEEPS 300

/* the ratio above which it ends there */
#define KKT_DRIVEN_CONTRACTION 0.9

/* relative correction below which it has converged */
#define KKT_CONVERGED 1e-15

/* pivot of G G^T over the norm of its row: below this, a row isn't eliminated with the speeds of
 * its own group. More than KKT_NEAR. */
#define KKT_DETERMINED 1.5e-2

/* the same when a new order is chosen, with a margin for the motion until the next
 * [test_kkt_border] */
#define KKT_FIRMLY_DETERMINED 4e-2

/* d / p that suffices for rows known to be independent by the pivots of their groups
 * [test_triangular] */
#define KKT_INDEPENDENT 1e-4

/* --- kkt_border.c --- */

/* rows of a speed in the border, more than: a speed with fewer is that of a body in pins, which
 * elimination in order handles well [test_kkt_border] */
#define KKT_BORDER_FEWEST_ROWS 4

/* with a border: that of K and that of the geometry G G^T [test_kkt_border] */
#define KKT_BORDER_FACTORISATIONS 2

/* unknowns; for fewer no border is sought [test_kkt_border] */
#define KKT_BORDER_LEAST_SIZE 8

/* --- kkt_sizes.c --- */

/* of the largest entry of a row: smaller ones are rounding error, and aren't in the row's group */
#define KKT_ZERO_ENTRY 1e-12

/* of the largest entry of all columns: a column whose entries are smaller is scaled by this, since
 * they are rounding error */
#define KKT_LEAST_REACH 1e-9

/* of the largest norm of scaled rows: the reference of a row is no smaller */
#define KKT_LEAST_NORM 1e-3

/* --- levenberg_marquardt.c --- */

/* at most */
#define LEVENBERG_MARQUARDT_ITERATIONS 200

/* rows from which on sparse factors are tried before dense ones */
#define LEVENBERG_MARQUARDT_SPARSE 64

/* of its diagonal entry: a larger pivot of the Gram matrix needs no exchange of rows */
#define LEVENBERG_MARQUARDT_SOUND_PIVOT 1e-8

/* of the largest diagonal entry of the Gram matrix: added to all, so that redundant rows can be
 * solved */
#define LEVENBERG_MARQUARDT_RIDGE 1e-15

/* --- modal.c --- */

/* the quotient that corrects an eigenvector to first order; a larger one isn't a small correction,
 * as for eigenvalues that are almost equal */
#define MODAL_SMALL 0.1

/* factor of bounds: covers the rounding of the computation of the bounds themselves */
#define MODAL_MARGIN 1.01

/* error of double-double sums of products, n^2 2^-104 up to n = 4000 */
#define MODAL_PRODUCTS 0x1p-95

/* --- rank.c --- */

/* pivot over the largest one, of least multipliers: a smaller one counts as 0 */
#define RANK_THRESHOLD 1e-9

/* of the longest row: a shorter row isn't scaled up to unit length, and isn't chosen before others
 */
#define RANK_LEAST_ROW 1e-3

/* rows from which on the independence of all is tested, without pivoting, before pivoted QR */
#define RANK_INDEPENDENCE_FIRST 64

/* of its square when computed afresh: an updated length that fell this far has lost half its
 * digits, and is computed anew */
#define RANK_STALE 1.5e-8

/* --- roots.c --- */

/* factor of error bounds of first order, for the terms of second order that they omit */
#define ROOT_SECOND_ORDER 2

/* times the rounding error of the method: a smaller root is an exact 0 */
#define ROOT_STRUCTURAL_ZERO 1e3

/* --- sparse.c --- */

/* unknowns up to which dense factors are faster (make bench: algebra.sparse_*) */
#define SPARSE_DENSE 12

/* of the reciprocal pivot growth when pivots were chosen: below it they are chosen anew */
#define SPARSE_LEAST_GROWTH 1e-3

/* solutions with the same factors from which on these are unpacked to arrays */
#define SPARSE_UNPACK 4

/* --- spectrum.c --- */

/* of the error due to the rounding of the entries: a smaller error of the method hardly adds to
 * it, and needs no refinement */
#define SPECTRUM_NEGLIGIBLE 0.1

#endif
