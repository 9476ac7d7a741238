/* session_limits.h: tolerances and limits of lib/session, by file
 *
 * Relative and without unit where none is stated. */
#ifndef COTREE_SESSION_SESSION_LIMITS_H
#define COTREE_SESSION_SESSION_LIMITS_H

/* --- session_bounds.c --- */

/* of the measure's initial value: an event ends the run there, where results are still finite */
#define LAW_BOUND 1e-6

/* --- session_evaluator.c --- */

/* pivot over the largest one below which equations are singular */
#define EVALUATOR_SINGULAR 1e-14

/* independence of a constraint row below which it repeats others */
#define EVALUATOR_RANK 1e-10

/* of the sum of the sizes of its terms: derivative of a value along a free direction. If it is
 * larger, constraints do not determine the value. */
#define EVALUATOR_UNDETERMINED 1e-7

/* of the unknowns: a Newton step after which convergence is quadratic */
#define EVALUATOR_NEAR 1e-9

/* residual of constraints, in their units, that is rounding error */
#define EVALUATOR_CLOSED 1e-13

/* --- session_figures.c and _course.c: means, extremes and periods of a formula over a run --- */

/* of a piece: distance of the last sample from its end, where a formula may jump */
#define FIGURES_END 1e-9

/* of the distance between two rows: what evenly spaced rows differ by at most */
#define FIGURES_EVEN 1e-6

/* of second differences of rows: fourth ones that are no larger show that rows resolve a formula */
#define FIGURES_RESOLVED 0.5

/* of the run: instants as near as that are the same */
#define FIGURES_INSTANT 1e-14

/* of the tolerance of the run: an extreme that is known as well as that isn't searched further */
#define FIGURES_FOUND 1e-2

/* of the mean size: the two halves of a piece that differ by less agree */
#define FIGURES_AGREE 1e-12

/* of their size: the same for halves that contain no kink, jump or pole */
#define FIGURES_ROUGH 1e-6

/* of their least sum so far: what halves at a pole add up to, however short they are, */
#define FIGURES_POLE 0.4

/* of the whole integral: what they also have to add up to, */
#define FIGURES_POLE_SIZE 1e-3

/* of the span: what they have to lie within, all three for a pole */
#define FIGURES_POLE_SPAN 1e-2

/* of the span: short pieces that disagree in more than this are those of rounding errors of a
 * value that is 0 */
#define FIGURES_NOISE 0.25

/* factor by which an extreme grows in each pass towards a pole */
#define FIGURES_GROWTH 2

/* of the interval next to it: a shorter one spans a corner */
#define FIGURES_CORNER 1e-6

/* of the mean period: crossings whose intervals differ by more determine no period */
#define FIGURES_IRREGULAR 0.1

/* --- session_linear.c --- */

/* names of freedoms in a remark */
#define MOST_NAMES 6

/* --- session_sweep.c --- */

/* s: sweeps that take no longer are not shared among processes, unless jobs is given */
#define SWEEP_WORKERS 0.02

/* --- session_trees.c --- */

/* s; duration of a search for trees, after which the best one found is reported */
#define TREE_SEARCH_TIME 10.0

/* --- session_value.c --- */

/* of the time from one row to the next: an instant that is nearer to a row is the instant of that
 * row */
#define ROW_TIME 1e-9

/* of the instant, likewise */
#define TIME_ROUNDING 1e-14

/* in the unit shown; larger values aren't compared with their rounding error, whose bound takes a
 * program */
#define NOISE_LARGEST 1e-6

/* rounding errors: a value of no more has no significant digit */
#define NOISE_ROUNDINGS 8

/* --- sensitivities --- */

/* of a parameter's size: the largest step of difference quotients of the start. Their errors are
 * some 1e-15 of this, and what an assembly leaves, 1e-14, over it. */
#define SENSITIVITY_STEP 0x1p-8

#endif
