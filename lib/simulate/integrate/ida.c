/* ida.c: SUNDIALS IDA on the implicit form F(t, w, w') = 0 that the problem supplies
 *
 * With multipliers that is the stabilised index-2 form of Gear, Gupta and Leimkuhler (1985).
 * Multipliers are derivatives of unknowns, which makes it index 1, and are excluded from the error
 * test. In the embedded form w' is the rates. A network alone is solved for its states and
 * algebraic unknowns together. The problem supplies sparse Jacobians, in the embedded form full
 * ones; differences replace them where it can't. The problem also supplies consistent initial
 * values; IDACalcIC isn't used. */
#include "simulate/integrate/sundials.h"

#include "simulate/integrate/integrate_limits.h"

#include <ida/ida.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <sunnonlinsol/sunnonlinsol_newton.h>

#include <string.h>

typedef struct Ida {
    Sundials s;
    /* of a sparse Jacobian: entries in the problem's order, and the index of each by columns */
    int entry_count;
    const int *row;
    int *place, *start;
    double *entries;
    double *last;     /* y at a restart */
    double share;     /* of tolerances: makes up for unknowns without error test in the norm */
    double corrected; /* norm of Newton's last correction, in tolerances */
    bool jumps;       /* unknowns without a rate may jump in the current step */
    bool has_jumped;  /* they did in the last one, whose history is no guide to the next */
} Ida;

static const SundialsCalls calls = {
    .free = IDAFree,
    .set_stop_time = IDASetStopTime,
    .set_max_step = IDASetMaxStep,
    .set_first_step = IDASetInitStep,
    .get_steps = IDAGetNumSteps,
    .get_failures = IDAGetNumErrTestFails,
    .get_jacobians = IDAGetNumJacEvals,
    .get_last_step = IDAGetLastStep,
    .get_next_step = IDAGetCurrentStep,
    .get_derivative = IDAGetDky,
};

static int residual(realtype t, N_Vector w, N_Vector rate, N_Vector out, void *data)
{
    Ida *d = data;
    const Ode *ode = d->s.base.ode;

    d->s.base.counts.evaluations++;
    return ode->dae.residual(ode->dae.context, t, N_VGetArrayPointer(w), N_VGetArrayPointer(rate),
                             N_VGetArrayPointer(out))
               ? 0
               : 1;
}

static Stepper *create(const Ode *ode, const Control *control)
{
    Ida *d = NEW(Ida);

    sundials_init(&d->s, &calls, &method_ida, ode, control, ode->dae.n);
    d->s.rate = MEM_GIVEN(N_VNew_Serial(d->s.n, d->s.context));
    d->s.memory = MEM_GIVEN(IDACreate(d->s.context));
    d->last = stepper_numbers(&d->s.base, d->s.all);
    return &d->s.base;
}

static void destroy(Stepper *stepper)
{
    Ida *d = (Ida *)stepper;

    if (d == NULL)
        return;
    MEM_FREE(d->place, d->start, d->entries);
    sundials_destroy(stepper);
}

/* Inverse of each unknown's error tolerance. Unknowns without a rate depend on those with one, and
 * are solved more finely than a loose tolerance requires: a diode's voltage with an error of a
 * tenth of a volt is no starting point for Newton's method. */
static int find_weights(N_Vector w, N_Vector weights, void *data)
{
    Ida *d = data;
    const Dae *dae = &d->s.base.ode->dae;
    const int work = d->s.base.ode->n;
    const Control *control = &d->s.base.control;
    const double part = d->share * stepper_part(&d->s.base);

    for (int i = 0; i < d->s.n; i++) {
        double error =
            part * (control->rtol * fabs(NV_Ith_S(w, i)) + control->atol * dae->weight[i]);

        if (i >= work && i < d->s.all)
            error = sundials_quadrature_error(&d->s, NV_Ith_S(w, i), NV_Ith_S(d->s.rate, i));
        if (dae->has_rate != NULL && !dae->has_rate[i])
            error = d->jumps ? SUNDIALS_ANY
                             : fmin(error, fmax(IDA_ALGEBRAIC * error, IDA_LEAST_ALGEBRAIC));
        NV_Ith_S(weights, i) = 1 / error;
    }
    return 0;
}

/* --- sparse Jacobians, by columns --- */

static int jacobian(realtype t, realtype c, N_Vector w, N_Vector rate, N_Vector out,
                    SUNMatrix matrix, void *data, N_Vector a, N_Vector b, N_Vector more)
{
    Ida *d = data;
    const Dae *dae = &d->s.base.ode->dae;
    sunindextype *start = SUNSparseMatrix_IndexPointers(matrix);
    sunindextype *row = SUNSparseMatrix_IndexValues(matrix);
    double *values = SUNSparseMatrix_Data(matrix);

    (void)out, (void)a, (void)b, (void)more;
    if (!dae->jacobian(dae->context, t, c, N_VGetArrayPointer(w), N_VGetArrayPointer(rate),
                       d->entries))
        return 1;
    for (int i = 0; i <= d->s.n; i++)
        start[i] = d->start[i];
    for (int k = 0; k < d->entry_count; k++) {
        row[d->place[k]] = d->row[k];
        values[d->place[k]] = d->entries[k];
    }
    return 0;
}

static int choose_sparse(Ida *d, const int *column)
{
    int code;

    d->entries = NEW_ARRAY(double, d->entry_count);
    d->place = NEW_ARRAY(int, d->entry_count);
    d->start = NEW_ARRAY(int, d->s.n + 2);
    for (int k = 0; k < d->entry_count; k++)
        d->start[column[k] + 2]++;
    for (int i = 0; i < d->s.n; i++)
        d->start[i + 2] += d->start[i + 1];
    for (int k = 0; k < d->entry_count; k++)
        d->place[k] = d->start[column[k] + 1]++;
    d->s.matrix = MEM_GIVEN(SUNSparseMatrix(d->s.n, d->s.n, d->entry_count, CSC_MAT, d->s.context));
    d->s.linear = MEM_GIVEN(SUNLinSol_KLU(d->s.w, d->s.matrix, d->s.context));
    code = IDASetLinearSolver(d->s.memory, d->s.linear, d->s.matrix);
    return code == 0 ? IDASetJacFn(d->s.memory, jacobian) : code;
}

/* --- full Jacobians --- */

/* column by column: each unknown is perturbed alone, with its rate as the method couples it */
static bool difference(Ida *d, double t, double c, double *w, double *rate, const double *at,
                       const double *weights, double *out)
{
    const Dae *dae = &d->s.base.ode->dae;
    const int n = d->s.n;
    bool sound = true;

    for (int j = 0; j < n && sound; j++) {
        const double value = w[j], slope = rate[j], error = 1 / weights[j];
        const double h = sqrt(DBL_EPSILON) * fmax(fabs(value), fmax(fabs(slope / c), error));
        double *column = out + (ptrdiff_t)j * n;

        w[j] = value + h;
        rate[j] = slope + c * h;
        d->s.base.counts.evaluations++;
        sound = dae->residual(dae->context, t, w, rate, column);
        for (int i = 0; i < n; i++)
            column[i] = (column[i] - at[i]) / h;
        w[j] = value;
        rate[j] = slope;
    }
    return sound;
}

static int full_jacobian(realtype t, realtype c, N_Vector w, N_Vector rate, N_Vector at,
                         SUNMatrix matrix, void *data, N_Vector a, N_Vector b, N_Vector more)
{
    Ida *d = data;
    const Dae *dae = &d->s.base.ode->dae;
    double *values = SUNDenseMatrix_Data(matrix), *here = N_VGetArrayPointer(w);
    double *rates = N_VGetArrayPointer(rate);

    (void)b, (void)more;
    if (dae->full != NULL && dae->full(dae->context, t, c, here, rates, values))
        return 0;
    (void)find_weights(w, a, d);
    return difference(d, t, c, here, rates, N_VGetArrayPointer(at), N_VGetArrayPointer(a), values)
               ? 0
               : 1;
}

static int choose_full(Ida *d)
{
    int code;

    d->s.matrix = MEM_GIVEN(SUNDenseMatrix(d->s.n, d->s.n, d->s.context));
    d->s.linear = MEM_GIVEN(SUNLinSol_Dense(d->s.w, d->s.matrix, d->s.context));
    code = IDASetLinearSolver(d->s.memory, d->s.linear, d->s.matrix);
    return code == 0 ? IDASetJacFn(d->s.memory, full_jacobian) : code;
}

static int choose_jacobian(Ida *d)
{
    const Dae *dae = &d->s.base.ode->dae;
    const int *column;

    d->entry_count = dae->pattern != NULL ? dae->pattern(dae->context, &d->row, &column) : -1;
    return d->entry_count >= 0 ? choose_sparse(d, column) : choose_full(d);
}

/* IDA divides the norm of errors by the number of all unknowns: the weights are scaled so that only
 * tested ones count. */
static int suppress(Ida *d)
{
    const bool *is_tested = d->s.base.ode->dae.is_tested;
    int code, tested = 0;

    d->share = 1;
    if (is_tested == NULL)
        return 0;
    for (int i = 0; i < d->s.n; i++) {
        NV_Ith_S(d->s.out, i) = is_tested[i];
        tested += is_tested[i];
    }
    d->share = sqrt((double)tested / d->s.n);
    code = IDASetId(d->s.memory, d->s.out);
    return code == 0 ? IDASetSuppressAlg(d->s.memory, SUNTRUE) : code;
}

/* Convergence test of Newton's method: its last correction is within the tolerance, and so is the
 * estimated rest. IDA requires less: the rate at which corrections decrease since the first one, or
 * in earlier steps. With the tangent of a diode that conducted, it would accept a step that passes
 * the end of conduction. With that of a diode that blocked, which leads far up the exponential, the
 * way back begins with a correction that is almost 0 by comparison. */
static int converges(SUNNonlinearSolver solver, N_Vector w, N_Vector correction, realtype tolerance,
                     N_Vector weights, void *data)
{
    Ida *d = data;
    const double size = N_VWrmsNorm(correction, weights), rate = size / d->corrected;
    int count = 0;

    (void)w;
    (void)SUNNonlinSolGetCurIter(solver, &count);
    d->corrected = size;
    if (count == 0)
        return size <= IDA_FIRST_CORRECTION * tolerance ? SUN_NLS_SUCCESS : SUN_NLS_CONTINUE;
    if (!(rate <= IDA_SLOWEST))
        return SUN_NLS_CONV_RECVR;
    return fmax(1, rate / (1 - rate)) * size <= tolerance ? SUN_NLS_SUCCESS : SUN_NLS_CONTINUE;
}

static int set_newton(Ida *d)
{
    int code;

    d->s.nonlinear = MEM_GIVEN(SUNNonlinSol_Newton(d->s.w, d->s.context));
    code = IDASetNonlinearSolver(d->s.memory, d->s.nonlinear);
    return code == 0 ? SUNNonlinSolSetConvTestFn(d->s.nonlinear, converges, d) : code;
}

static int first_start(Ida *d, double t)
{
    const Control *control = &d->s.base.control;
    int code = IDASetErrHandlerFn(d->s.memory, sundials_store_reason, d);

    if (code == 0)
        code = IDAInit(d->s.memory, residual, t, d->s.w, d->s.rate);
    if (code == 0)
        code = IDASetUserData(d->s.memory, d);
    if (code == 0)
        code = IDAWFtolerances(d->s.memory, find_weights);
    if (code == 0)
        code = IDASetMaxNumSteps(d->s.memory, SUNDIALS_TRIES);
    if (code == 0)
        code = IDASetMaxStep(d->s.memory, control_largest(control));
    if (code == 0)
        code = suppress(d);
    if (code == 0 && d->s.base.ode->dae.has_rate != NULL)
        code = set_newton(d);
    return code == 0 ? choose_jacobian(d) : code;
}

static Status start(Stepper *stepper, double t, const double *y, Diag *diag)
{
    Ida *d = (Ida *)stepper;
    const Dae *dae = &stepper->ode->dae;
    int code;

    sundials_place(&d->s, t, y);
    if (!dae->start(dae->context, t, stepper->y, N_VGetArrayPointer(d->s.w),
                    N_VGetArrayPointer(d->s.rate)))
        return ode_undefined(stepper->ode, t, diag);
    code = d->s.linear == NULL ? first_start(d, t) : IDAReInit(d->s.memory, t, d->s.w, d->s.rate);
    if (code == IDA_MEM_FAIL)
        transaction_fail();
    return code == 0 ? OK : solver_failure(diag, t, d->s.reason);
}

/* one internal step of IDA, at most to `end` */
static int advance(Sundials *s, double end, double *reached)
{
    int code = sundials_bound(s, end);

    if (code == 0)
        code = IDASolve(s->memory, end, reached, s->w, s->rate, IDA_ONE_STEP);
    sundials_count(s);
    return code;
}

/* Whether the error estimate of the step to `reached`, taken after one of length `last`, is
 * reliable. IDA estimates the error of a first-order step from the change of slope over both steps.
 * Where the last one was far longer, a slope that bends only in this one, as in a wall, appears to
 * bend slowly. */
static bool knows_its_error(const Sundials *s, double reached, double last)
{
    int order = 0;

    (void)IDAGetLastOrder(s->memory, &order);
    return order > 1 || reached - s->base.t >= IDA_SHORT_STEP * last;
}

/* One step without a history from the last point, projected. Three reasons: Newton's method doesn't
 * converge from the history of a stiff element; no step succeeds where the last point is off the
 * manifold by more than the tolerance; a smaller distance still makes the start inconsistent. */
static int begin_anew(Ida *d, double end, double *reached, Diag *diag)
{
    Stepper *stepper = &d->s.base;
    const Ode *ode = stepper->ode;
    const size_t bytes = (size_t)d->s.all * sizeof(double);
    bool sound = true;

    if (ode->project != NULL) {
        memcpy(d->last, stepper->y, bytes);
        sound = ode->project(ode->context, stepper->t, stepper->y);
        if (!sound) /* the cause is diagnosed at the last point */
            memcpy(stepper->y, d->last, bytes);
    }
    if (!sound || start(stepper, stepper->t, stepper->y, diag) != OK)
        return IDA_CONV_FAIL;
    return advance(&d->s, end, reached);
}

/* Whether the step just taken shows that integration makes no progress: steps are shorter than the
 * resolution of time. */
static bool gets_nowhere(const Stepper *stepper, int code, double reached)
{
    return code == IDA_ERR_FAIL || code == IDA_CONV_FAIL ||
           (code >= 0 && reached == stepper->t && stepper->stuck > 0);
}

/* The voltage of a diode that a coil's current leaves changes within some 1e-15 s, which no steps
 * resolve: it changes in one step, whose length is chosen for the states. */
static int jump(Ida *d, double end, double *reached, Diag *diag)
{
    Stepper *stepper = &d->s.base;
    int code = IDA_CONV_FAIL;

    if (start(stepper, stepper->t, stepper->y, diag) != OK)
        return code;
    d->jumps = d->has_jumped = true;
    code = advance(&d->s, end, reached);
    d->jumps = false;
    return code;
}

static Status step(Stepper *stepper, double end, Diag *diag)
{
    Sundials *s = (Sundials *)stepper;
    Ida *d = (Ida *)stepper;
    const double before = stepper->t, last = before - stepper->before;
    const int stuck = stepper->stuck;
    double reached = before;
    int code;

    if (d->has_jumped) {
        d->has_jumped = false;
        TRY(start(stepper, before, stepper->y, diag));
    }
    code = advance(s, end, &reached);
    if (code == IDA_CONV_FAIL || code == IDA_ERR_FAIL) {
        stepper->stuck = stuck;
        if (code == IDA_ERR_FAIL)
            stepper->next = IDA_RESTART * last;
        code = begin_anew(d, end, &reached, diag);
    }
    if (code >= 0 && !knows_its_error(s, reached, last)) {
        stepper->stuck = stuck;
        stepper->next = IDA_RESTART * (reached - before);
        code = begin_anew(d, end, &reached, diag);
    }
    if (stepper->ode->dae.has_rate != NULL && gets_nowhere(stepper, code, reached))
        code = jump(d, end, &reached, diag);
    stepper->before = before;
    if (code == IDA_MEM_FAIL)
        transaction_fail();
    if (code < 0)
        return sundials_failure(s, code, diag);
    return sundials_arrive(s, reached, diag);
}

const Method method_ida = {
    SUNDIALS_METHOD,
    .name = "ida",
    .short_part = 0.1,
    .brief = "IDA on the implicit equations, sparse: for networks. Mechanisms in the stabilised "
             "index-2 form, as a check: it fails near singular positions; rows are projected",
    .create = create,
    .destroy = destroy,
    .start = start,
    .step = step,
    .suits_stiff = true,
    .solves_dae = true,
};
