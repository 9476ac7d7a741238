/* assemble_limits.h: tolerances and limits of lib/simulate/assemble, by file
 *
 * Relative and without unit where none is stated. Residuals of positions are scaled: rows of
 * lengths in m, of angles in rad. Those of mode search and reinitialisation stand in the files of
 * these. */
#ifndef COTREE_SIMULATE_ASSEMBLE_ASSEMBLE_LIMITS_H
#define COTREE_SIMULATE_ASSEMBLE_ASSEMBLE_LIMITS_H

/* --- initial.c: positions along the coordinates --- */

/* scaled residual of the coordinates that are aligned with given poses */
#define ALIGN_TOLERANCE 1e-12

/* further initial guesses where the first doesn't converge */
#define COORDINATES_TRIES 24

/* rad or m; larger moves of dependent coordinates are reported */
#define COORDINATES_FAR 2.0

/* pivot over the largest one of the constraint rows at the assembled position: a smaller one
 * counts as 0 */
#define ASSEMBLED_RANK 1e-9

/* least sine by which the rates of three angles are divided */
#define CRITICAL_ANGLES 1e-12

/* --- initial_given.c --- */

/* largest deviation from 1 of the length of four given Euler parameters: they are rounded values
 * and are scaled to unit length */
#define EULER_PARAMETERS_OFF 1e-2

/* the same for fewer than four: those not given may be small, but not as small as this */
#define EULER_PARAMETERS_OTHERS 1e-5

/* --- initial_guesses.c: assembly of least distance from guesses --- */

/* factor from one weight of guesses, against loops, to the next */
#define GUESS_WEIGHT_FACTOR 0.1

/* the last weight; its square is the relative error of the least distance */
#define GUESS_LEAST_WEIGHT 1e-3

/* scaled distance at which all guesses are met */
#define GUESSES_MET 1e-9

/* scaled distance by which another assembly has to be nearer */
#define GUESSES_NEARER 1e-6

/* rad, or of the size of the mechanism; farther guesses are reported */
#define GUESS_FAR 0.5

/* rad, or of the size; random distance of columns from their guesses, in one half of the initial
 * points, */
#define GUESS_SPREAD 0.1

/* and in the other half */
#define GUESS_WIDE_SPREAD 0.3

/* rad, or of the size; random step that leaves points where a derivative is 0 by chance */
#define GUESS_PROBE 0.3

/* initial points without other columns */
#define GUESS_POINTS 16

/* further ones for each column that takes part and has no guess */
#define GUESS_POINTS_PER_COLUMN 16

/* initial points at most */
#define GUESS_MOST_POINTS 64

/* initial points times columns cubed, at most: what they cost */
#define GUESS_WORK 4e6

/* --- initial_place.c --- */

/* rad or m; larger moves of coordinates without given values are reported */
#define PLACE_FAR 2.0

/* --- initial_place_impl.h --- */

/* scaled residual at which guesses are met */
#define PLACE_APPROACHED 1e-12

/* --- initial_problem.c --- */

/* scaled residual at which the search ends */
#define INITIAL_TOLERANCE 1e-12

/* m or rad; a residual that isn't larger is rounding error */
#define INITIAL_CLOSED 1e-13

/* m or rad; a smaller residual isn't reported next to larger ones */
#define INITIAL_LEAST_REPORTED 1e-9

/* --- initial_search.c: positions along the joints: further initial guesses --- */

/* at the first distance, and at the second, */
#define SEARCH_AT_ONE_DISTANCE 8

/* in all, with those at larger distances, */
#define SEARCH_TRIES 24

/* at most, for few unknowns, which cost little: */
#define SEARCH_MOST_TRIES 56

/* as many as give this product with the number of unknowns */
#define SEARCH_WORK 1680

/* --- initial_speed.c --- */

/* m or rad; perturbation of central differences, whose error is about its square */
#define SPEED_DIFFERENCE 1e-5

/* multiple to which such differences are rounded, above their error: 0 and 1 are exact */
#define SPEED_RATE_GRID 0x1p-30

/* scaled residual at which speeds are solved for */
#define SPEED_TOLERANCE 1e-11

/* pivot over the largest one of the rows of speeds: a smaller one counts as 0 */
#define SPEED_RANK 1e-9

/* --- kinematic_tree_rows.c --- */

/* rad; rows of a joint that are larger mean that it is assembled reversed: more than the error of
 * any assembled joint */
#define JOINT_REVERSED 1.0

#endif
