/* cvode.c: SUNDIALS CVODE, BDF and Adams, on y' = f(t, y) */
#include "simulate/integrate/sundials.h"

#include "simulate/integrate/integrate_limits.h"

#include <cvode/cvode.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <sunnonlinsol/sunnonlinsol_newton.h>

static const SundialsCalls calls = {
    .free = CVodeFree,
    .set_stop_time = CVodeSetStopTime,
    .set_max_step = CVodeSetMaxStep,
    .set_first_step = CVodeSetInitStep,
    .get_steps = CVodeGetNumSteps,
    .get_failures = CVodeGetNumErrTestFails,
    .get_jacobians = CVodeGetNumJacEvals,
    .get_last_step = CVodeGetLastStep,
    .get_next_step = CVodeGetCurrentStep,
    .get_derivative = CVodeGetDky,
};

static int rate(realtype t, N_Vector y, N_Vector out, void *data)
{
    Sundials *c = data;

    if (!stepper_rate(&c->base, t, N_VGetArrayPointer(y), N_VGetArrayPointer(out)))
        return 1;
    for (int i = c->base.ode->n; i < c->all; i++)
        (void)sundials_quadrature_error(c, 0, NV_Ith_S(out, i));
    return 0;
}

/* --- 1 - gamma J --- */

/* J from the problem; false: not available */
static bool by_problem(Sundials *c, double t, N_Vector y)
{
    const OdeJacobian *offered = &c->base.ode->jacobian;

    if (offered->at == NULL)
        return false;
    c->base.counts.evaluations++;
    return offered->at(offered->context, t, N_VGetArrayPointer(y), c->jacobian);
}

/* The differences of CVODE itself perturb an unknown that is 0 by almost nothing where a first step
 * is short, and then see rounding error alone. */
static int by_differences(Sundials *c, double t, N_Vector y, N_Vector rate_there, N_Vector point,
                          N_Vector column)
{
    const int n = c->base.ode->n;

    N_VScale(1, y, point);
    for (int j = 0; j < n; j++) { /* nothing depends on quadratures */
        const double was = NV_Ith_S(point, j);
        double h;

        NV_Ith_S(point, j) = was + ode_increment(was);
        h = NV_Ith_S(point, j) - was;
        if (rate(t, point, column, c) != 0)
            return 1;
        NV_Ith_S(point, j) = was;
        for (int i = 0; i < c->all; i++)
            c->jacobian[i * n + j] = (NV_Ith_S(column, i) - NV_Ith_S(rate_there, i)) / h;
    }
    return 0;
}

/* CVODE would reuse the J of a failed step for the shorter ones that follow. A J from a stiff
 * region that these don't reach, as a wall, makes Newton's corrections small whatever the
 * residual. */
static int linear_system(realtype t, N_Vector y, N_Vector rate_there, SUNMatrix matrix,
                         booleantype may_keep, booleantype *is_new, realtype gamma, void *data,
                         N_Vector point, N_Vector column, N_Vector more)
{
    Sundials *c = data;

    (void)matrix, (void)more;
    *is_new = !may_keep || c->jacobian_at > t;
    if (*is_new) {
        c->jacobian_at = t;
        if (!by_problem(c, t, y) && by_differences(c, t, y, rate_there, point, column) != 0)
            return 1;
        condensed_set(c->condensed, c->jacobian);
    }
    c->gamma = gamma;
    return 0;
}

static SUNLinearSolver_Type type_of(SUNLinearSolver solver)
{
    (void)solver;
    return SUNLINEARSOLVER_DIRECT;
}

static int factor(SUNLinearSolver solver, SUNMatrix matrix)
{
    Sundials *c = solver->content;

    (void)matrix;
    c->becoming = 1;
    return condensed_factor_real(c->condensed, 1 / c->gamma) ? 0 : SUNLS_LUFACT_FAIL;
}

/* (1 - gamma J) x = b by (1/gamma - J) x = b/gamma; quadratures follow from the other unknowns */
static int solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, realtype finely)
{
    const Sundials *c = solver->content;
    const int n = c->base.ode->n;
    double *out = N_VGetArrayPointer(x);

    (void)matrix, (void)finely;
    N_VScale(1, b, x);
    for (int i = 0; i < n; i++)
        out[i] /= c->gamma;
    condensed_solve(c->condensed, out);
    for (int i = n; i < c->all; i++)
        for (int j = 0; j < n; j++)
            out[i] += c->gamma * c->jacobian[i * n + j] * out[j];
    return SUNLS_SUCCESS;
}

static int free_solver(SUNLinearSolver solver)
{
    SUNLinSolFreeEmpty(solver); /* its content is the stepper */
    return SUNLS_SUCCESS;
}

/* Newton's method with the factors of J; CVODE requires a matrix, which nothing reads. */
static int set_linear(Sundials *c)
{
    int code;

    c->jacobian = stepper_numbers(&c->base, c->all * c->base.ode->n);
    c->condensed = condensed_new(c->base.ode->n);
    c->matrix = MEM_GIVEN(SUNDenseMatrix(1, 1, c->context));
    c->linear = MEM_GIVEN(SUNLinSolNewEmpty(c->context));
    c->linear->content = c;
    c->linear->ops->gettype = type_of;
    c->linear->ops->setup = factor;
    c->linear->ops->solve = solve;
    c->linear->ops->free = free_solver;
    code = CVodeSetLinearSolver(c->memory, c->linear, c->matrix);
    return code == 0 ? CVodeSetLinSysFn(c->memory, linear_system) : code;
}

/* CVODE's own test: the rate at which corrections decrease, in earlier steps too. */
static int converges_as_before(Sundials *c, double size, double tolerance, int count)
{
    if (count > 0)
        c->becoming = fmax(0.3 * c->becoming, size / c->corrected);
    if (size * fmin(1, c->becoming) <= tolerance)
        return SUN_NLS_SUCCESS;
    if (count > 0 && size > 2 * c->corrected)
        return SUN_NLS_CONV_RECVR;
    return SUN_NLS_CONTINUE;
}

/* Convergence test of Newton's method. With stiff elements earlier steps are no guide: with the
 * tangent of a diode that blocked, a correction is small however strongly it conducts now. So
 * either the first correction is almost 0, or a second one is needed. */
static int converges(SUNNonlinearSolver solver, N_Vector w, N_Vector correction, realtype tolerance,
                     N_Vector weights, void *data)
{
    Sundials *c = data;
    const double size = N_VWrmsNorm(correction, weights), rate = size / c->corrected;
    int count = 0, code;

    (void)w;
    (void)SUNNonlinSolGetCurIter(solver, &count);
    if (!c->base.has_pulses)
        code = converges_as_before(c, size, tolerance, count);
    else if (count == 0)
        code = size <= CVODE_FIRST_CORRECTION * tolerance ? SUN_NLS_SUCCESS : SUN_NLS_CONTINUE;
    else if (!(rate <= CVODE_SLOWEST))
        code = SUN_NLS_CONV_RECVR;
    else
        code = fmax(1, rate / (1 - rate)) * size <= tolerance ? SUN_NLS_SUCCESS : SUN_NLS_CONTINUE;
    c->corrected = size;
    return code;
}

static int set_newton(Sundials *c)
{
    int code;

    c->nonlinear = MEM_GIVEN(SUNNonlinSol_Newton(c->w, c->context));
    code = CVodeSetNonlinearSolver(c->memory, c->nonlinear);
    return code == 0 ? SUNNonlinSolSetConvTestFn(c->nonlinear, converges, c) : code;
}

/* --- a stepper --- */

static Stepper *create(const Method *method, const Ode *ode, const Control *control)
{
    Sundials *c = NEW(Sundials);

    sundials_init(c, &calls, method, ode, control, ode->n + ode->quadratures);
    /* allocated and freed with the stepper: NOLINTNEXTLINE(clang-analyzer-osx.cocoa.RetainCount) */
    c->memory = MEM_GIVEN(CVodeCreate(method->suits_stiff ? CV_BDF : CV_ADAMS, c->context));
    return &c->base;
}

static void destroy(Stepper *stepper)
{
    if (stepper == NULL)
        return;
    condensed_free(((Sundials *)stepper)->condensed);
    sundials_destroy(stepper);
}

static Stepper *create_bdf(const Ode *ode, const Control *control)
{
    return create(&method_bdf, ode, control);
}

static Stepper *create_adams(const Ode *ode, const Control *control)
{
    return create(&method_adams, ode, control);
}

/* inverse of each unknown's error tolerance */
static int find_weights(N_Vector y, N_Vector weights, void *data)
{
    Sundials *c = data;
    const Control *control = &c->base.control;
    const double part = stepper_part(&c->base);

    for (int i = 0; i < c->all; i++) {
        const double value = NV_Ith_S(y, i), unit = ode_nominal(c->base.ode, i);

        NV_Ith_S(weights, i) =
            1 / (i < c->base.ode->n ? part * (control->rtol * fabs(value) + control->atol * unit)
                                    : sundials_quadrature_error(c, value, 0));
    }
    return 0;
}

static int first_start(Sundials *c, double t)
{
    int code = CVodeSetErrHandlerFn(c->memory, sundials_store_reason, c);

    if (code == 0)
        code = CVodeInit(c->memory, rate, t, c->w);
    if (code == 0)
        code = CVodeSetUserData(c->memory, c);
    if (code == 0)
        code = CVodeWFtolerances(c->memory, find_weights);
    if (code == 0)
        code = CVodeSetMaxNumSteps(c->memory, SUNDIALS_TRIES);
    if (code == 0)
        code = CVodeSetMaxStep(c->memory, control_largest(&c->base.control));
    if (code != 0)
        return code;
    if (c->base.method->suits_stiff) {
        code = set_newton(c);
        if (code == 0)
            code = set_linear(c);
        if (code == 0 && c->base.ode->stiffness_falls)
            code = CVodeSetLSetupFrequency(c->memory, 1);
        if (code == 0 && c->base.ode->stiffness_falls)
            code = CVodeSetJacEvalFrequency(c->memory, 1);
        return code;
    }
    c->nonlinear = MEM_GIVEN(SUNNonlinSol_FixedPoint(c->w, 0, c->context));
    return CVodeSetNonlinearSolver(c->memory, c->nonlinear);
}

static Status start(Stepper *stepper, double t, const double *y, Diag *diag)
{
    Sundials *c = (Sundials *)stepper;
    int code;

    sundials_place(c, t, y);
    code = c->linear == NULL && c->nonlinear == NULL ? first_start(c, t)
                                                     : CVodeReInit(c->memory, t, c->w);
    if (code == CV_MEM_FAIL)
        transaction_fail();
    return code == 0 ? OK : solver_failure(diag, t, c->reason);
}

/* one internal step of CVODE, at most to `end` */
static int advance(Sundials *c, double end, double *reached)
{
    int code = sundials_bound(c, end);

    stepper_begin(&c->base, c->base.t, c->base.y, c->base.next);
    if (code == 0)
        code = CVode(c->memory, end, c->w, reached, CV_ONE_STEP);
    sundials_count(c);
    return code;
}

/* Whether the error estimate of the step to `reached`, taken after one of length `last`, is
 * reliable. CVODE estimates the error from the difference between the step's end and the
 * extrapolated history, times a factor that decreases the longer the history is. Where failed steps
 * have left a step far shorter than those before, a solution that bends in this step alone, as in a
 * wall, appears to bend slowly. */
static bool knows_its_error(const Sundials *c, double end, double reached, double last)
{
    const double meant = fmin(fmin(last, c->base.next), stepper_stop(&c->base, end) - c->base.t);

    return !(reached - c->base.t < CVODE_SHORT_STEP * meant);
}

static Status step(Stepper *stepper, double end, Diag *diag)
{
    Sundials *c = (Sundials *)stepper;
    const double last = c->base.t - c->base.before;
    const int stuck = stepper->stuck;
    double reached = c->base.t;
    int code = advance(c, end, &reached);

    if (code >= 0 && !knows_its_error(c, end, reached, last)) {
        const double h = reached - c->base.t;

        TRY(start(stepper, c->base.t, c->base.y, diag));
        stepper->stuck = stuck;
        stepper->next = CVODE_RESTART * h;
        code = advance(c, end, &reached);
    }
    c->base.before = c->base.t;
    if (code == CV_MEM_FAIL)
        transaction_fail();
    if (code < 0)
        return sundials_failure(c, code, diag);
    return sundials_arrive(c, reached, diag);
}

#define CVODE_METHOD SUNDIALS_METHOD, .destroy = destroy, .start = start, .step = step

const Method method_bdf = {
    CVODE_METHOD,
    .name = "bdf",
    .short_part = 0.05,
    .brief = "CVODE, backward differentiation, for stiff equations; rows are projected",
    .create = create_bdf,
    .suits_stiff = true,
};

const Method method_adams = {
    CVODE_METHOD,           .name = "adams",
    .short_part = 0.1,      .brief = "CVODE, Adams-Moulton; rows are projected",
    .create = create_adams,
};
