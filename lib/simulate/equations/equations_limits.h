/* equations_limits.h: tolerances and limits of lib/simulate/equations, by file
 *
 * Relative and without unit where none is stated. */
#ifndef COTREE_SIMULATE_EQUATIONS_EQUATIONS_LIMITS_H
#define COTREE_SIMULATE_EQUATIONS_EQUATIONS_LIMITS_H

/* --- articulated.c --- */

/* inertia of an axis before elimination over the one after it, D: with more, D is rounding error */
#define ARTICULATED_MOST_EXCESS 1e12

/* --- compiled_rates.c --- */

/* diagonal entry before elimination over the pivot: with more, the pivot is rounding error */
#define PIVOT_MOST_EXCESS 1e12

/* --- factors.c --- */

/* unknowns up to which dense factors are used from the start */
#define FACTORS_DENSE 40

/* least pivot over largest of sparse factors below which dense ones are used */
#define FACTORS_ILL_CONDITIONED 1e-12

/* --- failure_diagnosis.c --- */

/* m; frames that are closer are at the same point, as closely as positions are solved for */
#define FAILURE_SAME_POINT 1e-12

/* of the largest part in a driver's row: less is rounding error */
#define FAILURE_TAKES_PART 1e-3

/* of the largest diagonal entry of the mass matrix: a smaller one is rounding error, and isn't
 * scaled to 1 */
#define FAILURE_NO_MASS 1e-13

/* of a column of the scaled mass matrix: what remains of a dependent one */
#define FAILURE_SINGULAR 1e-9

/* of the time within which frames meet: the difference quotient of their distance */
#define FAILURE_DIFFERENCE 1e-6

/* --- mode_forms.c --- */

/* bytes; memory of the equations of all modes that a run retains */
#define MODE_FORMS_MOST_BYTES 64e6

/* --- motion.c --- */

/* solutions with the same factors in a projection of speeds, at most */
#define PROJECTION_SWEEPS 8

/* independence of rows (smallest pivot ratio of their groups) below which a singular position is
 * near */
#define MOTION_NEAR 0.1

/* the same above which it is far for the whole step */
#define MOTION_FAR 0.2

/* least size by which a row of Phi_u is divided, in the units of its entries */
#define MOTION_LEAST_ROW 1e-6

/* --- motion_impl.h --- */

/* of the condition when independent speeds were chosen: below it others are chosen */
#define MOTION_WORN 0.1

/* --- motion_renew.c --- */

/* of the pivot ratio when rows were chosen: below it others are chosen, since it falls to 0 within
 * a few steps */
#define ROWS_WORN 0.5

/* cost of a product in sparse factors over that of one in straight-line code */
#define ELIMINATION_COST 4

/* pivot ratio of the chosen rows below which others may be better */
#define ROWS_POOR 1e-2

/* --- motion_solve.c --- */

/* iterations of the fixed point of motion and network, at most */
#define TOGETHER_ITERATIONS 50

/* iterations that don't halve the least change so far, from which on rounding is considered */
#define TOGETHER_STALLED 3

/* a change, of the size of unknowns, that may then be rounding error */
#define TOGETHER_ROUNDING 1e-11

/* least size of an unknown, in its unit */
#define TOGETHER_LEAST 1e-15

/* pivot ratio of Phi_d above which no singular position is near */
#define PARTITIONING_SUSPECT 1e-2

/* --- motion_surfaces.c --- */

/* Newton steps of a projection onto the surfaces of sliding, at most */
#define SURFACE_SWEEPS 4

/* --- netsolve.c --- */

/* solutions retained with the same factors: the end of a step is evaluated several times */
#define NETSOLVE_RETAINED 4

/* of Newton's method, at most */
#define NETSOLVE_ITERATIONS 100

/* Newton step, of the scale of unknowns, that is the last. The error after it is about its square.
 */
#define NETSOLVE_CONVERGED 1e-9

/* least scale of an unknown, V or A */
#define NETSOLVE_LEAST_SCALE 1e-3

/* ratio of an unknown's scale, its largest value in the search, to its value from which on the
 * scale is out of date */
#define NETSOLVE_STALE_SCALE 1e3

/* Newton step that may be rounding error where no damped step reduces it */
#define NETSOLVE_ROUNDING 1e-7

/* iterations before it is tested whether residuals are rounding errors */
#define NETSOLVE_PATIENCE 4

/* random perturbations of all unknowns that estimate the rounding errors of residuals */
#define NETSOLVE_PERTURBATIONS 3

/* units in the last place; size of these perturbations, at most */
#define NETSOLVE_ULPS 4

/* least share of a Newton step, damped so that corrections decrease */
#define NETSOLVE_LEAST_DAMPING 1e-4

/* largest multiple of a Newton step, along an exponential */
#define NETSOLVE_MOST_STRETCH 4096

/* undamped Newton steps, from one linear piece to the next, after which shares of steps are tried
 * to leave a cycle */
#define NETSOLVE_UNDAMPED 20

/* least share of a Newton step, damped so that residuals decrease, across nonsmooth points */
#define NETSOLVE_LEAST_SHARE 1e-14

/* Newton steps to a solution of source stepping, from the last one */
#define NETSOLVE_CONTINUATION_STEPS 12

/* the Newton step that ends these: close enough for the next one */
#define NETSOLVE_CONTINUATION 1e-3

/* of an unknown's scale: how far it is moved where a derivative is infinite */
#define NETSOLVE_PERTURBATION 1e-6

/* source stepping: the first share of the sources */
#define SOURCES_FIRST 1e-16

/* largest factor from share to share */
#define SOURCES_FACTOR 4.0

/* least factor; where it is reached, source stepping fails */
#define SOURCES_LEAST_FACTOR 1.01

/* --- redundant.c --- */

/* coefficient of a row of unit size in a linear combination: less is rounding error */
#define REDUNDANT_PART 1e-6

/* --- rows.c --- */

/* pivot over the largest one in a least-squares solution: a smaller one counts as 0 */
#define ROWS_RANK 1e-12

/* --- signs.c: values of sign() on sliding surfaces, in [-1, 1] --- */

/* of Newton's method, at most */
#define SIGNS_ITERATIONS 30

/* perturbation of difference quotients */
#define SIGNS_DIFFERENCE 1e-4

/* Newton step that is the last */
#define SIGNS_CONVERGED 1e-11

/* the same with factors of an earlier search, whose last step is not taken */
#define SIGNS_ROUNDING 4e-16

/* a step over the one before it, with factors of an earlier search; more than that: they are
 * renewed */
#define SIGNS_CONTRACTION 0.1

/* least pivot over largest below which the least-squares solution is used */
#define SIGNS_SINGULAR 1e-11

/* of the largest entry's square: added to the diagonal of A^T A */
#define SIGNS_DAMPING 1e-10

/* refinements of that solution, which remove the effect of the damping */
#define SIGNS_REFINEMENTS 4

/* a Newton step beyond it leads neither into the interval nor soon outside */
#define SIGNS_FAR 100

/* distance outside the interval at which the motion leaves the surface; less is rounding error */
#define SIGNS_OUTSIDE 1e-6

/* the value that stands for a surface that is left */
#define SIGNS_LEFT 2

/* bisections of the interval */
#define SIGNS_BISECTIONS 40

/* rounds of bisections, one value after the other, at most */
#define SIGNS_ROUNDS 10

/* --- stiff_elements.c --- */

/* exponent from which on a power is stiff */
#define STIFF_LEAST_POWER 8

/* perturbation of an element's input, in its unit: with it the smallest saturation current has an
 * effect */
#define STIFF_PERTURBATION 1e6

/* --- stiff_elements_ranges.c --- */

/* subintervals of a run in which the ranges of sources are found */
#define STIFF_SUBINTERVALS 64

#endif
