/* run_limits.h: tolerances and limits of lib/simulate/run, by file
 *
 * Relative and without unit where none is stated. Those of mode switches, events and pulses stand
 * in the files of these. */
#ifndef COTREE_SIMULATE_RUN_RUN_LIMITS_H
#define COTREE_SIMULATE_RUN_RUN_LIMITS_H

/* --- active_run.c: energy balance --- */

/* of the stored energy: a larger error of the balance is reported, */
#define ENERGY_OPEN 0.03

/* where it exceeds so many times the energy that errors of the tolerance in the states have, */
#define ENERGY_ERRORS 100

/* and so many times their power over the time of the run */
#define WORK_ERRORS 10

/* of the error of the balance: the least work whose rounding may explain it */
#define WORK_ROUNDED 0.1

/* --- begin.c --- */

/* relative tolerance that locates mode switches until the options of the run are known */
#define START_TOLERANCE 1e-8

/* --- dense_output.c --- */

/* of the output interval: times that differ by less are equal */
#define SAME_TIME 1e-12

/* rad; largest change of a multi-turn angle in a part between two rows */
#define DENSE_TURN 0.25

/* m or rad; a projected point farther from the interpolated one may be on another branch of the
 * constraints */
#define DENSE_MISSED_BRANCH 0.1

/* further projections, each with its own factors, where the first doesn't converge */
#define DENSE_PROJECTIONS 4

/* --- global_error.c --- */

/* rad or m; runs that differ by more have different motions */
#define DIFFERENT_MOTION 0.3

/* ratio of a difference to its own error from which on it is reported as the error */
#define SURE_ERROR 4.0

/* tolerances of a finer run: its own error may be that large */
#define FINER_RUN_ERROR 30.0

/* largest tolerance from which that of the reference of a run with fixed steps is derived */
#define FIXED_STEP_REFERENCE 1e-8

/* ratio of the tolerances of a run and of its finer run */
#define FINER_RUN_TOLERANCE 100

/* factor of the difference from the finer run that gives the reported error, for one-step methods
 */
#define ONE_STEP_ERROR 2.0

/* the same for multistep methods */
#define MULTISTEP_ERROR 6.0

/* --- inverse.c --- */

/* of Newton's method for a driven position, at most */
#define DRIVEN_ITERATIONS 30

/* --- pace.c --- */

/* s; longest wait before the watch is asked whether to stop */
#define PACE_CHECK 0.02

/* of the step: a step that is shorter by more than rounding isn't waited for */
#define PACE_WHOLE_STEP 0.999

/* --- run.h --- */

/* the least relative tolerance that the user may request, between rounding error and the
 * resolution of doubles */
#define RUN_LEAST_RTOL 1e-13

/* --- samples.c --- */

/* samples in a run; more would take minutes */
#define SAMPLES_MOST 1e9

/* of the period: instants that differ by less are the same sample */
#define SAME_SAMPLE 1e-9

/* --- simulate.c --- */

/* rows of a result */
#define RESULT_MOST_ROWS 20000000

/* values in all rows of a result: 1.6 GB */
#define RESULT_MOST_VALUES 2e8

/* points from one row to the next of a driven run, at which events are checked */
#define DRIVEN_POINTS 4

/* rad; largest change of a multi-turn angle in a step of a driven run */
#define DRIVEN_TURN 2.0

/* rad; largest difference of such an angle from its linear prediction */
#define DRIVEN_MISSED 0.5

/* relative tolerance of runs without rtol= */
#define DEFAULT_RTOL 1e-8

/* --- termination.c --- */

/* of the characteristic time |y / y'|: how far the motion is extrapolated as a straight line */
#define TERMINATION_AHEAD 1e-3

/* of the run: the first instant ahead at which formulas are evaluated */
#define TERMINATION_FIRST 1e-16

/* of the characteristic time: a step that accuracy would allow */
#define TERMINATION_STEP 0.1

/* of the run: a cause that takes effect within that time ended it */
#define TERMINATION_IMMINENT 1e-6

/* of the independent part of a driver's row at the start: below it, the driver has reached its end
 */
#define TERMINATION_DRIVER 1e-2

/* of y: perturbation of difference quotients */
#define TERMINATION_DIFFERENCE 1e-6

/* fixed step times the fastest rate; the stability limit of explicit methods, about */
#define TERMINATION_STABLE 2.5

/* of the size at the start: no motion grows by so much */
#define TERMINATION_UNSTABLE 1e6

/* of the size at the start: a variable beyond it may grow without bound */
#define TERMINATION_BOUNDLESS 1e3

/* of an integral over the run: halves of a piece give the same within it */
#define INTEGRAL_AGREES 1e-11

/* the same, of the relative tolerance of the run */
#define INTEGRAL_TOLERANCE 1e-3

/* of an integral over the run: what polynomials of degree 3 and 5 may differ by between two rows;
 * the latter is off by far less */
#define INTEGRAL_SMOOTH 1e-9
/* of the run's energy: a difference that is rounding, as of the loss of what sticks */
#define INTEGRAL_ROUNDING 1e-14

/* of a matrix with unit diagonal: what is left of rows that depend on others */
#define SHARES_DEPENDENT 1e-9

#endif
