/* cvode.c: SUNDIALS CVODE, BDF and Adams, on y' = f(t, y)
 *
 * Multistep methods run without projection: their history isn't on the manifold, and what is read
 * from a step is projected by whoever reads it. They restart at order 1 after a jump. */
#include "simulate/integrate/ode.h"

#include "base/memory.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#define MAX_TRIES 100000 /* inner steps that CVODE may take for one of ours: one mode makes one */
#define NO_ERROR  1e10   /* a tolerance that nothing comes near */

typedef struct Cvode {
    Stepper base;
    Cleanup cleanup;
    int all;
    SUNContext context;
    void *memory;
    N_Vector y, out;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    SUNNonlinearSolver nonlinear;
    Counts earlier; /* of integrations before the last restart */
    char reason[200];
} Cvode;

/* CVODE's own words belong into our message, not on the terminal */
static void keep_reason(int code, const char *module, const char *function, char *message,
                        void *data)
{
    Cvode *c = data;

    (void)code, (void)module, (void)function;
    (void)snprintf(c->reason, sizeof c->reason, "%s", message);
}

static int rate(realtype t, N_Vector y, N_Vector out, void *data)
{
    Cvode *c = data;

    c->base.counts.evaluations++;
    return c->base.ode->rate(c->base.ode->context, t, N_VGetArrayPointer(y),
                             N_VGetArrayPointer(out))
               ? 0
               : 1;
}

/* CVODE's own differences move an unknown that is 0 by next to nothing where a first step is short,
 * and then see rounding alone. */
static int jacobian(realtype t, N_Vector y, N_Vector rate_there, SUNMatrix matrix, void *data,
                    N_Vector point, N_Vector column, N_Vector more)
{
    Cvode *c = data;

    (void)more;
    N_VScale(1, y, point);
    for (int j = 0; j < c->base.ode->n; j++) { /* nothing follows from quadratures */
        double *entries = SUNDenseMatrix_Column(matrix, j);
        const double was = NV_Ith_S(point, j);
        double h;

        NV_Ith_S(point, j) = was + ode_increment(was);
        h = NV_Ith_S(point, j) - was;
        if (rate(t, point, column, data) != 0)
            return 1;
        NV_Ith_S(point, j) = was;
        for (int i = 0; i < c->all; i++)
            entries[i] = (NV_Ith_S(column, i) - NV_Ith_S(rate_there, i)) / h;
    }
    return 0;
}

static void give_back(void *object)
{
    Cvode *c = object;

    CVodeFree(&c->memory);
    if (c->linear != NULL)
        SUNLinSolFree(c->linear);
    if (c->nonlinear != NULL)
        SUNNonlinSolFree(c->nonlinear);
    if (c->matrix != NULL)
        SUNMatDestroy(c->matrix);
    N_VDestroy(c->y);
    N_VDestroy(c->out);
    SUNContext_Free(&c->context);
    cleanup_close(&c->cleanup);
}

static Stepper *create(const Method *method, const Ode *ode, const Control *control)
{
    Cvode *c = NEW(Cvode);
    int all = ode->n + ode->quadratures;

    c->base = (Stepper){.method = method, .ode = ode, .control = *control};
    c->all = all;
    c->base.y = NEW_ARRAY(double, all);
    cleanup_open(&c->cleanup, give_back, c);
    mem_ask();
    if (SUNContext_Create(NULL, &c->context) != 0)
        transaction_fail();
    c->y = MEM_GIVEN(N_VNew_Serial(all, c->context));
    c->out = MEM_GIVEN(N_VNew_Serial(all, c->context));
    /* kept and freed by give_back(): NOLINTNEXTLINE(clang-analyzer-osx.cocoa.RetainCount) */
    c->memory = MEM_GIVEN(CVodeCreate(method->is_stiff ? CV_BDF : CV_ADAMS, c->context));
    return &c->base;
}

static Stepper *create_bdf(const Ode *ode, const Control *control)
{
    return create(&method_bdf, ode, control);
}

static Stepper *create_adams(const Ode *ode, const Control *control)
{
    return create(&method_adams, ode, control);
}

static void destroy(Stepper *stepper)
{
    Cvode *c = (Cvode *)stepper;

    if (c == NULL)
        return;
    give_back(c);
    mem_free(c->base.y);
    mem_free(c);
}

/* One over what an error of each unknown counts from; a quadrature's own doesn't steer the step. */
static int find_weights(N_Vector y, N_Vector weights, void *data)
{
    const Cvode *c = data;
    const Control *control = &c->base.control;
    const double part = stepper_part(&c->base);

    for (int i = 0; i < c->all; i++) {
        const double atol = i < c->base.ode->n ? part * control->atol : NO_ERROR;

        NV_Ith_S(weights, i) = 1 / (part * control->rtol * fabs(NV_Ith_S(y, i)) + atol);
    }
    return 0;
}

static int first_start(Cvode *c, double t)
{
    int code = CVodeSetErrHandlerFn(c->memory, keep_reason, c);

    if (code == 0)
        code = CVodeInit(c->memory, rate, t, c->y);
    if (code == 0)
        code = CVodeSetUserData(c->memory, c);
    if (code == 0)
        code = CVodeWFtolerances(c->memory, find_weights);
    if (code == 0)
        code = CVodeSetMaxNumSteps(c->memory, MAX_TRIES);
    if (code == 0)
        code = CVodeSetMaxStep(c->memory, control_largest(&c->base.control));
    if (code != 0)
        return code;
    if (c->base.method->is_stiff) {
        c->matrix = MEM_GIVEN(SUNDenseMatrix(c->all, c->all, c->context));
        c->linear = MEM_GIVEN(SUNLinSol_Dense(c->y, c->matrix, c->context));
        code = CVodeSetLinearSolver(c->memory, c->linear, c->matrix);
        return code == 0 ? CVodeSetJacFn(c->memory, jacobian) : code;
    }
    c->nonlinear = MEM_GIVEN(SUNNonlinSol_FixedPoint(c->y, 0, c->context));
    return CVodeSetNonlinearSolver(c->memory, c->nonlinear);
}

static void keep_counts(Cvode *c)
{
    long steps = 0, failures = 0, jacobians = 0;

    (void)CVodeGetNumSteps(c->memory, &steps);
    (void)CVodeGetNumErrTestFails(c->memory, &failures);
    if (c->linear != NULL)
        (void)CVodeGetNumJacEvals(c->memory, &jacobians);
    c->base.counts.steps = c->earlier.steps + steps;
    c->base.counts.rejected = c->earlier.rejected + failures;
    c->base.counts.jacobians = c->earlier.jacobians + jacobians;
}

static Status start(Stepper *stepper, double t, const double *y, Diag *diag)
{
    Cvode *c = (Cvode *)stepper;
    int code;

    memmove(c->base.y, y, (size_t)c->all * sizeof(double));
    c->base.t = c->base.before = t;
    c->base.stuck = 0;
    memcpy(N_VGetArrayPointer(c->y), y, (size_t)c->all * sizeof(double));
    c->earlier = c->base.counts;
    code = c->linear == NULL && c->nonlinear == NULL ? first_start(c, t)
                                                     : CVodeReInit(c->memory, t, c->y);
    if (code == 0 && c->base.control.first > 0)
        code = CVodeSetInitStep(c->memory, c->base.control.first);
    if (code == CV_MEM_FAIL)
        transaction_fail();
    return code == 0 ? OK : solver_failure(diag, t, c->reason);
}

static Status step(Stepper *stepper, double end, Diag *diag)
{
    Cvode *c = (Cvode *)stepper;
    double reached = c->base.t, h = 0, next = 0;
    int code = CVodeSetStopTime(c->memory, stepper_stop(&c->base, end));

    c->base.before = c->base.t;
    if (code == 0) /* growth is bounded there; a stop time cuts a step that is grown already */
        code = CVodeSetMaxStep(c->memory,
                               stepper_allowed(&c->base, control_largest(&c->base.control)));
    if (code == 0)
        code = CVode(c->memory, end, c->y, &reached, CV_ONE_STEP);
    keep_counts(c);
    if (code == CV_MEM_FAIL)
        transaction_fail();
    if (code == CV_REPTD_RHSFUNC_ERR)
        return solver_failure(diag, c->base.before,
                              "the equations have no solution just behind this instant");
    if (code < 0)
        return solver_failure(diag, c->base.before, c->reason);
    (void)CVodeGetLastStep(c->memory, &h);
    (void)CVodeGetCurrentStep(c->memory, &next);
    if (stepper_arrive(stepper, reached, h, next, diag) != OK)
        return E_SOLVER;
    memcpy(c->base.y, N_VGetArrayPointer(c->y), (size_t)c->all * sizeof(double));
    return OK;
}

static void at(Stepper *stepper, double t, double *y)
{
    Cvode *c = (Cvode *)stepper;

    if (t != c->base.t && CVodeGetDky(c->memory, t, 0, c->out) == 0)
        memcpy(y, N_VGetArrayPointer(c->out), (size_t)c->all * sizeof(double));
    else
        memcpy(y, c->base.y, (size_t)c->all * sizeof(double));
}

static Status shorten(Stepper *stepper, double t, Diag *diag)
{
    const Cvode *c = (const Cvode *)stepper;

    return stepper_take_back(stepper, t, N_VGetArrayPointer(c->y), diag);
}

/* the slope of the history's polynomial, once there is one */
static bool slope(Stepper *stepper, double *rate)
{
    Cvode *c = (Cvode *)stepper;

    if (!(c->base.t > c->base.before) || CVodeGetDky(c->memory, c->base.t, 1, c->out) != 0)
        return false;
    memcpy(rate, N_VGetArrayPointer(c->out), (size_t)c->all * sizeof(double));
    return true;
}

static const double nodes[] = {1};

const Method method_bdf = {
    .name = "bdf",
    .brief = "CVODE, backward differentiation, for stiff equations; rows are projected",
    .create = create_bdf,
    .destroy = destroy,
    .start = start,
    .step = step,
    .at = at,
    .shorten = shorten,
    .slope = slope,
    .nodes = nodes,
    .node_count = COUNT(nodes),
    .has_history = true,
    .sees_little = true,
    .pulse_steps = 24,
    .is_stiff = true,
};

const Method method_adams = {
    .name = "adams",
    .brief = "CVODE, Adams-Moulton; rows are projected",
    .create = create_adams,
    .destroy = destroy,
    .start = start,
    .step = step,
    .at = at,
    .shorten = shorten,
    .slope = slope,
    .nodes = nodes,
    .node_count = COUNT(nodes),
    .has_history = true,
    .sees_little = true,
    .pulse_steps = 24,
};
