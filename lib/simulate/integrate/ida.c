/* ida.c: SUNDIALS IDA on the implicit form that the problem offers
 *
 * With multipliers that is the stabilised index-2 form of Gear, Gupta and Leimkuhler (1985),
 * multipliers entering as derivatives of unknowns, which makes it index 1; in the embedded form it
 * is the index-1 system itself. A network alone is solved for its states and algebraic unknowns
 * together, with a sparse Jacobian. IDA gets consistent values from the problem; IDACalcIC isn't
 * used. */
#include "simulate/integrate/ode.h"

#include "base/memory.h"

#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

#define MAX_TRIES 100000
#define FINER     1e-2 /* of the tolerance: for what has no rate, */
#define FINE      1e-4 /* but not finer than this where the tolerance itself isn't */

typedef struct Ida {
    Stepper base;
    Cleanup cleanup;
    int all, n; /* of y; of w */
    SUNContext context;
    void *memory;
    N_Vector w, rate, out;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    Counts earlier;
    /* of a sparse Jacobian: entries as the problem has them, and where each stands by columns */
    int entry_count;
    const int *row;
    int *place, *start;
    double *entries;
    char reason[200];
} Ida;

static void keep_reason(int code, const char *module, const char *function, char *message,
                        void *data)
{
    Ida *d = data;

    (void)code, (void)module, (void)function;
    (void)snprintf(d->reason, sizeof d->reason, "%s", message);
}

static int residual(realtype t, N_Vector w, N_Vector rate, N_Vector out, void *data)
{
    Ida *d = data;
    const Ode *ode = d->base.ode;

    d->base.counts.evaluations++;
    return ode->dae.residual(ode->dae.context, t, N_VGetArrayPointer(w), N_VGetArrayPointer(rate),
                             N_VGetArrayPointer(out))
               ? 0
               : 1;
}

static void give_back(void *object)
{
    Ida *d = object;

    IDAFree(&d->memory);
    if (d->linear != NULL)
        SUNLinSolFree(d->linear);
    if (d->matrix != NULL)
        SUNMatDestroy(d->matrix);
    N_VDestroy(d->w);
    N_VDestroy(d->rate);
    N_VDestroy(d->out);
    SUNContext_Free(&d->context);
    cleanup_close(&d->cleanup);
}

static Stepper *create(const Ode *ode, const Control *control)
{
    Ida *d = NEW(Ida);

    d->base = (Stepper){.method = &method_ida, .ode = ode, .control = *control};
    d->all = ode->n + ode->quadratures;
    d->n = ode->dae.n;
    d->base.y = NEW_ARRAY(double, d->all);
    cleanup_open(&d->cleanup, give_back, d);
    mem_ask();
    if (SUNContext_Create(NULL, &d->context) != 0)
        transaction_fail();
    d->w = MEM_GIVEN(N_VNew_Serial(d->n, d->context));
    d->rate = MEM_GIVEN(N_VNew_Serial(d->n, d->context));
    d->out = MEM_GIVEN(N_VNew_Serial(d->n, d->context));
    d->memory = MEM_GIVEN(IDACreate(d->context));
    return &d->base;
}

static void destroy(Stepper *stepper)
{
    Ida *d = (Ida *)stepper;

    if (d == NULL)
        return;
    give_back(d);
    mem_free(d->base.y);
    mem_free(d->place);
    mem_free(d->start);
    mem_free(d->entries);
    mem_free(d);
}

/* --- sparse Jacobians, by columns --- */

static int jacobian(realtype t, realtype c, N_Vector w, N_Vector rate, N_Vector out,
                    SUNMatrix matrix, void *data, N_Vector a, N_Vector b, N_Vector more)
{
    Ida *d = data;
    const Dae *dae = &d->base.ode->dae;
    sunindextype *start = SUNSparseMatrix_IndexPointers(matrix);
    sunindextype *row = SUNSparseMatrix_IndexValues(matrix);
    double *values = SUNSparseMatrix_Data(matrix);

    (void)out, (void)a, (void)b, (void)more;
    if (!dae->jacobian(dae->context, t, c, N_VGetArrayPointer(w), N_VGetArrayPointer(rate),
                       d->entries))
        return 1;
    for (int i = 0; i <= d->n; i++)
        start[i] = d->start[i];
    for (int k = 0; k < d->entry_count; k++) {
        row[d->place[k]] = d->row[k];
        values[d->place[k]] = d->entries[k];
    }
    return 0;
}

static int choose_sparse(Ida *d)
{
    const Dae *dae = &d->base.ode->dae;
    const int *column;
    int code;

    d->entry_count = dae->pattern(dae->context, &d->row, &column);
    d->entries = NEW_ARRAY(double, d->entry_count);
    d->place = NEW_ARRAY(int, d->entry_count);
    d->start = NEW_ARRAY(int, d->n + 2);
    for (int k = 0; k < d->entry_count; k++)
        d->start[column[k] + 2]++;
    for (int i = 0; i < d->n; i++)
        d->start[i + 2] += d->start[i + 1];
    for (int k = 0; k < d->entry_count; k++)
        d->place[k] = d->start[column[k] + 1]++;
    d->matrix = MEM_GIVEN(SUNSparseMatrix(d->n, d->n, d->entry_count, CSC_MAT, d->context));
    d->linear = MEM_GIVEN(SUNLinSol_KLU(d->w, d->matrix, d->context));
    code = IDASetLinearSolver(d->memory, d->linear, d->matrix);
    return code == 0 ? IDASetJacFn(d->memory, jacobian) : code;
}

static int suppress(Ida *d)
{
    const bool *has_rate = d->base.ode->dae.has_rate;
    int code;

    if (has_rate == NULL)
        return 0;
    for (int i = 0; i < d->n; i++)
        NV_Ith_S(d->out, i) = has_rate[i];
    code = IDASetId(d->memory, d->out);
    return code == 0 ? IDASetSuppressAlg(d->memory, SUNTRUE) : code;
}

/* One over what an error of each unknown counts from. What has no rate follows from what has, and
 * is solved for more finely than a loose tolerance asks: a diode's voltage a tenth of a volt off is
 * no place to begin Newton's method from. */
static int find_weights(N_Vector w, N_Vector weights, void *data)
{
    const Ida *d = data;
    const Dae *dae = &d->base.ode->dae;
    const Control *control = &d->base.control;
    const double part = stepper_part(&d->base);

    for (int i = 0; i < d->n; i++) {
        double error =
            part * (control->rtol * fabs(NV_Ith_S(w, i)) + control->atol * dae->weight[i]);

        if (dae->has_rate != NULL && !dae->has_rate[i])
            error = fmin(error, fmax(FINER * error, FINE));
        NV_Ith_S(weights, i) = 1 / error;
    }
    return 0;
}

static int first_start(Ida *d, double t)
{
    const Control *control = &d->base.control;
    int code = IDASetErrHandlerFn(d->memory, keep_reason, d);

    if (code == 0)
        code = IDAInit(d->memory, residual, t, d->w, d->rate);
    if (code == 0)
        code = IDASetUserData(d->memory, d);
    if (code == 0)
        code = IDAWFtolerances(d->memory, find_weights);
    if (code == 0)
        code = IDASetMaxNumSteps(d->memory, MAX_TRIES);
    if (code == 0)
        code = IDASetMaxStep(d->memory, control_largest(control));
    if (code == 0)
        code = suppress(d);
    if (code != 0)
        return code;
    if (d->base.ode->dae.pattern != NULL)
        return choose_sparse(d);
    d->matrix = MEM_GIVEN(SUNDenseMatrix(d->n, d->n, d->context));
    d->linear = MEM_GIVEN(SUNLinSol_Dense(d->w, d->matrix, d->context));
    return IDASetLinearSolver(d->memory, d->linear, d->matrix);
}

static Status start(Stepper *stepper, double t, const double *y, Diag *diag)
{
    Ida *d = (Ida *)stepper;
    const Ode *ode = d->base.ode;
    int code;

    memmove(d->base.y, y, (size_t)d->all * sizeof(double));
    d->base.t = d->base.before = t;
    d->base.stuck = 0;
    if (!ode->dae.start(ode->dae.context, t, d->base.y, N_VGetArrayPointer(d->w),
                        N_VGetArrayPointer(d->rate)))
        return solver_failure(diag, t, "the accelerations are undefined");
    d->earlier = d->base.counts;
    code = d->linear == NULL ? first_start(d, t) : IDAReInit(d->memory, t, d->w, d->rate);
    if (code == IDA_MEM_FAIL)
        transaction_fail();
    return code == 0 ? OK : solver_failure(diag, t, d->reason);
}

/* one step of IDA's own, to `end` at most */
static int advance(Ida *d, double end, double *reached)
{
    int code = IDASetStopTime(d->memory, stepper_stop(&d->base, end));

    if (code == 0) /* growth is bounded there; a stop time cuts a step that is grown already */
        code =
            IDASetMaxStep(d->memory, stepper_allowed(&d->base, control_largest(&d->base.control)));
    return code == 0 ? IDASolve(d->memory, end, reached, d->w, d->rate, IDA_ONE_STEP) : code;
}

static void keep_counts(Ida *d)
{
    long steps = 0, failures = 0, jacobians = 0;

    (void)IDAGetNumSteps(d->memory, &steps);
    (void)IDAGetNumErrTestFails(d->memory, &failures);
    (void)IDAGetNumJacEvals(d->memory, &jacobians);
    d->base.counts.steps = d->earlier.steps + steps;
    d->base.counts.rejected = d->earlier.rejected + failures;
    d->base.counts.jacobians = d->earlier.jacobians + jacobians;
}

static Status step(Stepper *stepper, double end, Diag *diag)
{
    Ida *d = (Ida *)stepper;
    const double before = d->base.t;
    const int stuck = d->base.stuck;
    double reached = before, h = 0, next = 0;
    int code = advance(d, end, &reached);

    keep_counts(d);
    /* Newton's method finds no way from the history of a steep element: from consistent values it
     * does */
    if (code == IDA_CONV_FAIL && start(stepper, before, d->base.y, diag) == OK) {
        d->base.stuck = stuck;
        code = advance(d, end, &reached);
        keep_counts(d);
    }
    d->base.before = before;
    if (code == IDA_MEM_FAIL)
        transaction_fail();
    if (code < 0)
        return solver_failure(diag, before, d->reason);
    (void)IDAGetLastStep(d->memory, &h);
    (void)IDAGetCurrentStep(d->memory, &next);
    if (stepper_arrive(stepper, reached, h, next, diag) != OK)
        return E_SOLVER;
    memcpy(d->base.y, N_VGetArrayPointer(d->w), (size_t)d->all * sizeof(double));
    return OK;
}

static void at(Stepper *stepper, double t, double *y)
{
    Ida *d = (Ida *)stepper;

    if (t != d->base.t && IDAGetDky(d->memory, t, 0, d->out) == 0)
        memcpy(y, N_VGetArrayPointer(d->out), (size_t)d->all * sizeof(double));
    else
        memcpy(y, d->base.y, (size_t)d->all * sizeof(double));
}

static Status shorten(Stepper *stepper, double t, Diag *diag)
{
    const Ida *d = (const Ida *)stepper;

    return stepper_take_back(stepper, t, N_VGetArrayPointer(d->w), diag);
}

/* the slope of the history's polynomial, once there is one */
static bool slope(Stepper *stepper, double *rate)
{
    Ida *d = (Ida *)stepper;

    if (!(d->base.t > d->base.before) || IDAGetDky(d->memory, d->base.t, 1, d->out) != 0)
        return false;
    memcpy(rate, N_VGetArrayPointer(d->out), (size_t)d->all * sizeof(double));
    return true;
}

static const double nodes[] = {1};

const Method method_ida = {
    .name = "ida",
    .brief =
        "IDA on the stabilised index-2 form (embedded: index 1), on networks alone sparse; rows "
        "are projected",
    .create = create,
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
    .solves_dae = true,
};
