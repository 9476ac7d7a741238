/* analyse_limits.h: tolerances and limits of lib/simulate/analyse, by file
 *
 * Relative and without unit where none is stated. The test in brackets fails when the value is ten
 * times as large. */
#ifndef COTREE_SIMULATE_ANALYSE_ANALYSE_LIMITS_H
#define COTREE_SIMULATE_ANALYSE_ANALYSE_LIMITS_H

/* --- equilibrium.c --- */

/* steps of pseudo-transient continuation, at most */
#define CREEP_STEPS 500

/* rad or m; largest step of it */
#define CREEP_STEP 0.3

/* largest factor by which residuals may grow in a step */
#define CREEP_GROWTH 100

/* least step of source or gmin stepping, on a path from 0 to 1, and least share of a step of
 * continuation */
#define LEAST_SHARE 1e-4

/* S; conductance across each element at the start of gmin stepping */
#define GMIN 1e-1

/* S; its last value before 0 [test_equilibrium] */
#define LEAST_GMIN 1e-14

/* --- equilibrium_residual.c --- */

/* 1/m or 1/rad; stiffness of a unilateral surface for a force of 1, at first, */
#define EFFORT_STIFFNESS 1e4

/* and how often it grows by what factor where the effort changes by more than a part of the last
 * change */
#define EFFORT_SLOW    0.1
#define EFFORT_STIFFER 10

/* change of the effort that is none; how often it is found at most */
#define EFFORT_CHANGE 1e-13
#define EFFORT_ROUNDS 60

/* --- freedoms.c --- */

/* rad/s per unit of speed: a smaller rotation is rounding error */
#define FREEDOM_LOST 1e-6

/* --- gain.c --- */

/* products below this lose digits, as they are near the least double; it bounds their error */
#define GAIN_LEAST 1e-290

/* --- linearize.c --- */

/* value of a condition, in its own unit, at which its law jumps */
#define LINEARIZE_ON_JUMP 1e-10

/* --- linearize_point.c --- */

/* rad; the state is compared after the time in which the fastest oscillation moves by this angle */
#define LINEAR_AHEAD 0.1

/* pivot over the largest one of rows of positions: a smaller one counts as 0 */
#define LINEARIZE_RANK 1e-9

/* of a row's largest coefficient: change over that time with which a row counts as constant */
#define LINEAR_CONSTANT 1e-5

/* relative perturbation of coefficients that shows which of their digits are rounding error */
#define LINEAR_PERTURBATION 0x1p-52

/* --- linearize_settle.c --- */

/* of the largest entry of a row: a smaller entry may be rounding error without a test */
#define LINEAR_ROUNDED 1e-12

/* largest difference of a true entry at perturbed points. One rounding error in 1e5 differs no
 * more at all of them. */
#define LINEAR_ALIKE 5e-2

/* --- modes.c --- */

/* difference of amplitudes, or of phases in rad, that count as equal */
#define MODE_SAME 1e-6

/* --- search.c: Newton's method for equilibria, by rounds of KINSOL --- */

/* residual over the terms of its row */
#define SEARCH_CONVERGED 1e-9

/* residual over the largest entry of its row: for unknowns of size 0 */
#define SEARCH_CONVERGED_ENTRY 1e-15

/* residual over its weight, after which no further round is needed */
#define SEARCH_FINE 1e-12

/* rounds, each with weights of its own */
#define SEARCH_ROUNDS 12

/* iterations in a round [test_equilibrium] */
#define SEARCH_ITERATIONS 20

/* ratio of residuals after a round: with more, it made no progress */
#define SEARCH_SLOW 0.99

/* residual over its weight that ends a round [test_equilibrium] */
#define SEARCH_ROUND_RESIDUAL 1e-15

/* relative step that ends a round */
#define SEARCH_ROUND_STEP 1e-15

/* least scale of a state, reaction or voltage, in its unit, for relative steps */
#define SEARCH_LEAST_SCALE 1e-6

/* of the largest force, or entry of a row: the least weight in the last round */
#define SEARCH_LEAST_WEIGHT 1e-9

/* rad or m; no coordinate moves further in a step [test_linear] */
#define SEARCH_LONGEST_STEP 1.0

/* fraction of a step at which the line search ends */
#define SEARCH_LEAST_STEP 1e-4

/* residual over its weight at points where it is undefined; also the length of a step that KINSOL
 * may not exceed, which then is no limit */
#define SEARCH_UNDEFINED 1e60

/* unknowns of a network up to which dense matrices are used [test_operating] */
#define SEARCH_MOST_DENSE 300

/* unknowns up to which a singular value decomposition finds the loosest one */
#define SEARCH_MOST_SVD 100

/* --- transfer.c --- */

/* distance of a frequency from a zero at which it counts as the zero */
#define TRANSFER_AT_ZERO 1e-13

/* error of a root: one with more isn't cancelled */
#define TRANSFER_KNOWN 1e-3

/* --- zeros.c --- */

/* largest Newton step, of the distance to the next zero */
#define ZERO_ALONE 0.1

/* error of a zero as an initial guess, of the distance to the next one: it needs no more digits */
#define ZERO_APART 1e-6

/* of its error: a value of H that counts as 0 */
#define ZERO_REACHED 1e-3

/* units of roundoff; error of a zero that double precision can represent no better */
#define ZERO_DOUBLE 4

/* largest error of a zero at which H is reliable */
#define ZERO_RELIABLE 1e-9

/* difference of responses that count as equal */
#define RESPONSE_SAME 1e-6

/* rad; angle of the points of the check from the positive real axis */
#define RESPONSE_ANGLE 0.6

/* distance by which equal zeros are separated; those nearer than its square are equal */
#define ZERO_SPLIT 1e-7

#endif
