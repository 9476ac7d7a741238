/* integrate_limits.h: tolerances and limits of lib/simulate/integrate, by file
 *
 * Relative and without unit where none is stated; "tolerances" are multiples of the requested
 * tolerance, and "of the run" means times its duration. Coefficients of methods stand in their
 * files. The test in brackets fails when the value is ten times as large. */
#ifndef COTREE_SIMULATE_INTEGRATE_INTEGRATE_LIMITS_H
#define COTREE_SIMULATE_INTEGRATE_INTEGRATE_LIMITS_H

/* --- ode.h: all methods --- */

/* the least relative tolerance that double precision allows */
#define LEAST_TOLERANCE 1e-13

/* tolerances; the tolerance of a step of a method with a history, for motion equations, whose
 * errors hardly decay */
#define MOTION_PART 0.1

/* the least relative tolerance to which that factor reduces */
#define MOTION_LEAST 1e-12

/* attempts in succession, with an undefined rate or a failed projection, after which a run ends */
#define MAX_REJECTIONS 10

/* factor of the step after such an attempt; the last is shorter by a factor of a million */
#define RETREAT 0.25

/* --- cvode.c --- */

/* of the tolerance of Newton's method: a first correction that is smaller ends the iteration,
 * without a rate of convergence */
#define CVODE_FIRST_CORRECTION 1e-2

/* ratio of successive corrections above which the iteration doesn't converge */
#define CVODE_SLOWEST 0.9

/* of the step before: a shorter one, cut at an end, has no reliable error estimate, and
 * integration restarts */
#define CVODE_SHORT_STEP 0.1

/* of the step before: the first step after a restart */
#define CVODE_RESTART 0.01

/* --- dop853.c --- */

/* factor of the step that the error estimate allows */
#define DOP853_SAFETY 0.9

/* times the root of the tolerance: the estimate of order 3 may be that large. It was 1 to 60 in
 * accurate steps; more means that the estimate of order 5 is small by chance. */
#define DOP853_THIRD_ORDER 60.0

/* the same where a stiff nonlinear element may stop conducting in the step */
#define DOP853_THIRD_ORDER_STIFF 2.0

/* least ratio of a step to the last one */
#define DOP853_SHRINK (1 / 3.0)

/* largest ratio of a step to the last one */
#define DOP853_GROW 6.0

/* tolerances; largest distance from a step's end to that of the parts of its dense output. A step
 * with more has a meaningless error estimate. */
#define DOP853_PARTS_AGREE 30.0

/* of the failed step: the longest one that is tried past a singular position */
#define DOP853_LEAP 1.2

/* of a step: the latest position in it of a singular position, between the last two stages
 * [test_integration] */
#define DOP853_LEAP_PAST 0.93

/* --- dop853_dense.c --- */

/* tolerances; distance of the last stage from the dense output below which its defect isn't
 * computed */
#define DENSE_NEAR 10.0

/* tolerances; h times the largest defect of the slope. The error of the dense output is about 1/15
 * of that. */
#define DENSE_DEFECT 100.0

/* divisions of a step in succession that don't halve the defect, after which it isn't divided
 * further */
#define DENSE_MISSED 2

/* of a step: the position at which the defect is computed */
#define DENSE_LOOK 0.71

/* rounding error of a stage, next to a singular position, from which on it is computed from the
 * slope */
#define DENSE_INACCURATE_STAGE 1e-10

/* --- dop853_stiff.c: h |L| of the largest eigenvalue L, see the file's head --- */

/* h |L| of steps that the stability limit bounds (Hairer and Wanner, Solving ODE II, IV.2) */
#define DOP853_STIFF_BOUNDARY 6.1

/* such steps, not in succession, from which on the equations are stiff */
#define DOP853_STIFF_COUNT 15

/* other steps in succession after which the count begins anew */
#define DOP853_CALM_COUNT 6

/* h |L| from which on a decayed component may limit the step by accuracy */
#define DOP853_FAST 1.0

/* sum of h |L| over such steps, the time in units of its decay, from which on the equations are
 * stiff */
#define DOP853_FAST_SUM 40

/* tolerances; a step with a smaller error isn't limited by accuracy */
#define DOP853_LIMITED 1e-2

/* times rtol^(1/4): largest relative change of y' in a step that radau would take longer. Measured
 * with a viscous knife edge. */
#define DOP853_SMOOTH 2.0

/* factor from step to step of the largest |y'| in recent steps */
#define DOP853_PEAK_DECAY 0.9

/* of y: perturbation of difference quotients */
#define DOP853_DIFFERENCE 1e-7

/* --- gauss.c --- */

/* tolerances; largest error of stages whose iteration no longer improves, as near singular
 * positions, where accelerations are noisy */
#define GAUSS_STALLED 0.1

/* of y: perturbation to either side by which the normal of the constraints is found; the
 * projection from there exceeds rounding error */
#define GAUSS_PROJECTION 1e-4

/* --- ida.c --- */

/* of the step before: the error estimate of a shorter one, at order 1, isn't reliable */
#define IDA_SHORT_STEP 0.1

/* of the step before: the first step after a restart */
#define IDA_RESTART 0.01

/* tolerances; the tolerance of unknowns without a rate */
#define IDA_ALGEBRAIC 1e-2

/* the least tolerance to which that factor reduces */
#define IDA_LEAST_ALGEBRAIC 1e-4

/* of the tolerance of Newton's method: a first correction that is smaller ends the iteration */
#define IDA_FIRST_CORRECTION 1e-2

/* ratio of successive corrections above which the iteration doesn't converge */
#define IDA_SLOWEST 0.9

/* --- radau.c --- */

/* of Newton's method, at most */
#define RADAU_ITERATIONS 10

/* unknowns up to which all stages are solved for together, with a Jacobian at each, where the
 * simplified Newton method fails */
#define RADAU_FULL 40

/* ratio of successive corrections; a slower convergence needs new Jacobians at the stages */
#define RADAU_REFRESH 1e-2

/* factor of the step that the error estimate allows */
#define RADAU_SAFETY 0.9

/* least ratio of a step to the last one */
#define RADAU_SHRINK 0.125

/* largest ratio of a step to the last one */
#define RADAU_GROW 5.0

/* ratio of successive corrections below which the Jacobian is used for the next step too */
#define RADAU_REUSE 1e-3

/* tolerances; largest error of the dense output, which isn't carried on to later steps */
#define RADAU_DENSE 30

/* of the run: transients shorter than this may be passed in one step */
#define RADAU_UNRESOLVED 1e-9

/* --- shifted.c --- */

/* states up to which dense factors of the states are faster than sparse ones of all unknowns of a
 * DAE */
#define SHIFTED_DENSE 100

/* --- stagnation.c --- */

/* steps between two checks */
#define STAGNATION_STEPS 5000

/* of the run: the least that these steps have to cover. With less the run would take a million. */
#define STAGNATION_PROGRESS 5e-3

/* tolerances; rounding error of rates, times the step, from which on rounding limits the steps */
#define STAGNATION_ROUNDING 0.01

/* of the run: steps whose sum is shorter are close to the resolution of time */
#define STAGNATION_SHORTEST 1e-9

/* points ahead at which rates are evaluated to find their rounding error */
#define STAGNATION_POINTS 64

/* of a step: the interval of these points, in which the motion is almost a straight line */
#define STAGNATION_AHEAD 0.06

/* order of the differences of these rates */
#define STAGNATION_ORDER 4

/* factor by which such differences amplify noise: the root of the sum of squares 1 + 16 + 36 + 16
 * + 1 */
#define STAGNATION_AMPLIFIED 8

/* steps of a run whose tolerance is attainable; the tolerance of a hint allows as many */
#define STAGNATION_ENOUGH_STEPS 1e4

/* a tolerance that rounding allows almost everywhere; below, the hint names a coarser one */
#define STAGNATION_FINE 1e-10

/* the coarsest tolerance that a hint names */
#define STAGNATION_COARSEST 1e-7

/* steps whose sum is compared with that of as many before, towards a singularity */
#define STAGNATION_WINDOW 200

/* comparisons in succession with a decrease */
#define STAGNATION_DECREASES 3

/* ratio of the sums that counts as a decrease. Steps of transients grow, and those at a stability
 * limit vary. */
#define STAGNATION_DECREASE 0.5

/* of the run: largest sum that counts */
#define STAGNATION_SHORT 1e-6

/* --- stepper.c --- */

/* steps in succession that end at the time at which they began, after which a run ends */
#define STEPPER_STUCK 10

/* --- sundials.h --- */

/* absolute tolerance that is never exceeded, where an entry is not in the error test */
#define SUNDIALS_ANY 1e20

/* internal steps in one call, which usually makes one; after more the call fails */
#define SUNDIALS_TRIES 100000

#endif
