/* search.c: KINSOL with a linear solver that allows singular matrices */
#include "simulate/analyse/search.h"

#include "algebra/dense.h"
#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/analyse/analyse_limits.h"
#include "simulate/equations/factors.h"

#include <gsl/gsl_linalg.h>
#include <kinsol/kinsol.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

struct EquilibriumSearch {
    Cleanup cleanup;
    EquilibriumResidual *equations;
    const CallMonitor *watch;
    int n;
    int speeds;             /* number of steps in w */
    const int *start, *row; /* pattern of the Jacobian */
    Factors *factors;
    double *kept;                  /* base */
    bool is_held;                  /* the mechanics is held */
    double *missed, *size, *entry; /* of rows: residuals, sums of terms, largest entries */
    SUNContext context;
    void *memory;
    N_Vector w, unit, weight; /* scales of KINSOL: of unknowns, of residuals */
    SUNMatrix matrix;
    SUNLinearSolver linear;
};

/* --- callbacks of KINSOL --- */

static SUNLinearSolver_Type solver_type(SUNLinearSolver solver)
{
    (void)solver;
    return SUNLINEARSOLVER_DIRECT;
}

static SUNLinearSolver_ID solver_id(SUNLinearSolver solver)
{
    (void)solver;
    return SUNLINEARSOLVER_CUSTOM;
}

static int solver_setup(SUNLinearSolver solver, SUNMatrix matrix)
{
    const EquilibriumSearch *s = solver->content;

    return factors_make(s->factors, SUNSparseMatrix_Data(matrix)) ? SUNLS_SUCCESS
                                                                  : SUNLS_LUFACT_FAIL;
}

/* a step's length in KINSOL's norm */
static double length_of(const EquilibriumSearch *s, const double *step)
{
    double length = 0;

    for (int i = 0; i < s->n; i++) {
        const double w = NV_Ith_S(s->w, i);

        length = fmax(length, fabs(step[i]) /
                                  (1 / NV_Ith_S(s->unit, i) + fmax(fabs(w), fabs(w + step[i]))));
    }
    return length;
}

/* Shorten the step so that no part moves further than SEARCH_LONGEST_STEP. `right` is unchanged, as
 * for the whole step: the predicted decrease of the residuals is then never exceeded, and KINSOL
 * makes no longer step. */
static int solver_solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector step, N_Vector right,
                        realtype tolerance)
{
    const EquilibriumSearch *s = solver->content;
    double *w = N_VGetArrayPointer(step);
    double furthest;

    (void)matrix, (void)tolerance;
    if (factors_solve(s->factors, N_VGetArrayPointer(right), w) < 0)
        return SUNLS_PACKAGE_FAIL_UNREC;
    furthest = vector_largest(w, s->speeds);
    for (int i = 0; i < s->n && furthest > SEARCH_LONGEST_STEP; i++)
        w[i] *= SEARCH_LONGEST_STEP / furthest;
    return KINSetScaledStepTol(s->memory,
                               fmax(SEARCH_ROUND_STEP, SEARCH_LEAST_STEP * length_of(s, w))) == 0
               ? SUNLS_SUCCESS
               : SUNLS_PACKAGE_FAIL_UNREC;
}

static void residual_at(const EquilibriumSearch *s, const double *w, double *out)
{
    memcpy(out, equilibrium_residual(s->equations, w), (size_t)s->n * sizeof(double));
    if (s->is_held)
        equilibrium_hold(s->equations, out, NULL);
}

static int residual(N_Vector w, N_Vector out, void *data)
{
    const EquilibriumSearch *s = data;
    double *values = N_VGetArrayPointer(out);

    if (monitor_poll(s->watch) != OK)
        return -1;
    residual_at(s, N_VGetArrayPointer(w), values);
    for (int i = 0; i < s->n; i++)
        if (!(fabs(values[i]) * NV_Ith_S(s->weight, i) <= SEARCH_UNDEFINED))
            values[i] = SEARCH_UNDEFINED / NV_Ith_S(s->weight, i);
    return 0;
}

static int jacobian(N_Vector w, N_Vector f, SUNMatrix matrix, void *data, N_Vector a, N_Vector b)
{
    const EquilibriumSearch *s = data;
    const double *values = equilibrium_jacobian(s->equations, N_VGetArrayPointer(w));

    (void)f, (void)a, (void)b;
    for (int c = 0; c <= s->n; c++)
        SUNSparseMatrix_IndexPointers(matrix)[c] = s->start[c];
    for (int k = 0; k < s->start[s->n]; k++) {
        SUNSparseMatrix_IndexValues(matrix)[k] = s->row[k];
        SUNSparseMatrix_Data(matrix)[k] = values[k];
    }
    if (s->is_held)
        equilibrium_hold(s->equations, NULL, SUNSparseMatrix_Data(matrix));
    return 0;
}

/* NOLINTNEXTLINE(readability-non-const-parameter): the type is that of SUNDIALS */
static void keep_quiet(int code, const char *module, const char *function, char *message,
                       void *data)
{
    (void)code, (void)module, (void)function, (void)message, (void)data;
}

/* --- construction and destruction --- */

static void close_solver(void *object)
{
    EquilibriumSearch *s = object;

    KINFree(&s->memory);
    if (s->linear != NULL)
        SUNLinSolFreeEmpty(s->linear);
    if (s->matrix != NULL)
        SUNMatDestroy(s->matrix);
    N_VDestroy(s->w);
    N_VDestroy(s->unit);
    N_VDestroy(s->weight);
    SUNContext_Free(&s->context);
    cleanup_close(&s->cleanup);
}

static void open_linear(EquilibriumSearch *s)
{
    s->linear = MEM_GIVEN(SUNLinSolNewEmpty(s->context));
    s->linear->content = s;
    s->linear->ops->gettype = solver_type;
    s->linear->ops->getid = solver_id;
    s->linear->ops->setup = solver_setup;
    s->linear->ops->solve = solver_solve;
}

static bool open_solver(EquilibriumSearch *s)
{
    int code;

    cleanup_open(&s->cleanup, close_solver, s);
    mem_ask();
    if (SUNContext_Create(NULL, &s->context) != 0)
        transaction_fail();
    s->w = MEM_GIVEN(N_VNew_Serial(s->n, s->context));
    s->unit = MEM_GIVEN(N_VNew_Serial(s->n, s->context));
    s->weight = MEM_GIVEN(N_VNew_Serial(s->n, s->context));
    for (int i = 0; i < s->n; i++)
        NV_Ith_S(s->unit, i) = i < s->speeds ? 1 : 1 / SEARCH_LEAST_SCALE;
    s->matrix = MEM_GIVEN(SUNSparseMatrix(s->n, s->n, s->start[s->n] + 1, CSC_MAT, s->context));
    s->memory = MEM_GIVEN(KINCreate(s->context));
    open_linear(s);
    code = KINSetErrHandlerFn(s->memory, keep_quiet, NULL);
    if (code == 0)
        code = KINInit(s->memory, residual, s->w);
    if (code == KIN_MEM_FAIL)
        transaction_fail();
    if (code == 0)
        code = KINSetUserData(s->memory, s);
    if (code == 0)
        code = KINSetLinearSolver(s->memory, s->linear, s->matrix);
    if (code == 0)
        code = KINSetJacFn(s->memory, jacobian);
    if (code == 0)
        code = KINSetMaxSetupCalls(s->memory, 1);
    if (code == 0)
        code = KINSetNumMaxIters(s->memory, SEARCH_ITERATIONS);
    if (code == 0)
        code = KINSetMaxNewtonStep(s->memory, SEARCH_UNDEFINED);
    if (code == 0)
        code = KINSetFuncNormTol(s->memory, SEARCH_ROUND_RESIDUAL);
    return code == 0 && KINSetScaledStepTol(s->memory, SEARCH_ROUND_STEP) == 0;
}

EquilibriumSearch *search_new(EquilibriumResidual *equations, const CallMonitor *watch)
{
    EquilibriumSearch *s = NEW(EquilibriumSearch);

    s->equations = equations;
    s->watch = watch;
    s->n = equilibrium_count(equations);
    s->kept = NEW_ARRAY(double, equilibrium_length(equations));
    s->missed = NEW_ARRAY(double, s->n);
    s->size = NEW_ARRAY(double, s->n);
    s->entry = NEW_ARRAY(double, s->n);
    s->speeds = equilibrium_layout(equations)->nu;
    equilibrium_pattern(equations, &s->start, &s->row);
    s->factors = factors_new(s->n, s->start, s->row,
                             !equilibrium_is_network(equations) || s->n <= SEARCH_MOST_DENSE);
    if (s->n == 0 || open_solver(s))
        return s;
    search_free(s);
    return NULL;
}

void search_free(EquilibriumSearch *s)
{
    if (s == NULL)
        return;
    if (s->n > 0)
        close_solver(s);
    factors_free(s->factors);
    MEM_FREE(s->kept, s->missed, s->size, s->entry, s);
}

/* --- rounds --- */

/* evaluate w at the base, its residuals and sizes of rows; false where something isn't finite */
static bool look(EquilibriumSearch *s)
{
    double *w = N_VGetArrayPointer(s->w);
    const double *values;

    equilibrium_begin(s->equations, w);
    values = equilibrium_jacobian(s->equations, w);
    residual_at(s, w, s->missed);
    if (!vector_is_finite(values, s->start[s->n]) || !vector_is_finite(s->missed, s->n))
        return false;
    equilibrium_sizes(s->equations, w, s->size);
    memset(s->entry, 0, (size_t)s->n * sizeof(double));
    for (int k = 0; k < s->start[s->n]; k++)
        s->entry[s->row[k]] = fmax(s->entry[s->row[k]], fabs(values[k]));
    return true;
}

static bool holds(const EquilibriumSearch *s, int i, double missed)
{
    return fabs(missed) <=
           fmax(SEARCH_CONVERGED * s->size[i], SEARCH_CONVERGED_ENTRY * s->entry[i]);
}

/* Weights of residuals, after look(): the size of their terms or of themselves; but at least
 * `share` of the largest force, or of an unknown of 1, while reactions and currents are still
 * unknown. */
static void weigh(EquilibriumSearch *s, double share)
{
    double force = 0;

    for (int i = 0; i < s->speeds; i++)
        force = fmax(force, fmax(s->size[i], fabs(s->missed[i])));
    for (int i = 0; i < s->n; i++) {
        const double least = share * (i < s->speeds && force > 0 ? force : s->entry[i]);
        const double weight = fmax(least, fmax(s->size[i], fabs(s->missed[i])));

        NV_Ith_S(s->weight, i) = weight > 0 ? 1 / weight : 1;
    }
}

/* whether all equations hold, after look() */
static bool all_hold(const EquilibriumSearch *s)
{

    for (int i = 0; i < s->n; i++)
        if (!holds(s, i, s->missed[i]))
            return false;
    return true;
}

/* KINSOL's norm of the residuals, after weigh() */
static double measure(const EquilibriumSearch *s)
{
    double sum = 0;

    for (int i = 0; i < s->n; i++)
        sum += s->missed[i] * NV_Ith_S(s->weight, i) * s->missed[i] * NV_Ith_S(s->weight, i);
    return sqrt(sum);
}

/* the largest residual, after weigh() */
static double worst(const EquilibriumSearch *s, const double *missed)
{
    double largest = 0;

    for (int i = 0; i < s->n; i++)
        largest = fmax(largest, fabs(missed[i]) * NV_Ith_S(s->weight, i));
    return vector_is_finite(missed, s->n) ? largest : INFINITY;
}

/* the rounds of search_run(); the base is where they end */
static bool go_on(EquilibriumSearch *s)
{
    bool is_stuck = false;
    double share = 1; /* each balance is relative to the largest, until all hold */

    if (!look(s))
        return false;
    for (int round = 0; round < SEARCH_ROUNDS; round++) {
        double before;
        int code;

        weigh(s, share);
        before = measure(s);
        code = KINSol(s->memory, s->w, KIN_LINESEARCH, s->unit, s->weight);
        if (monitor_poll(s->watch) != OK || !vector_is_finite(N_VGetArrayPointer(s->w), s->n))
            return false;
        equilibrium_place(s->equations, N_VGetArrayPointer(s->w), equilibrium_base(s->equations));
        equilibrium_rebase(s->equations);
        if (!look(s))
            return false;
        if (code == KIN_MAXITER_REACHED && measure(s) < SEARCH_SLOW * before)
            continue;
        if (all_hold(s)) {
            share = SEARCH_LEAST_WEIGHT;
            weigh(s, share);
            if (code < 0 || worst(s, s->missed) <= SEARCH_FINE)
                return true;
        } else if (code < 0) {
            /* the decrease may show with new weights */
            if (is_stuck)
                return false;
            is_stuck = true;
        }
    }
    return all_hold(s);
}

bool search_run(EquilibriumSearch *s)
{
    const size_t bytes = (size_t)equilibrium_length(s->equations) * sizeof(double);
    double *base = equilibrium_base(s->equations);

    if (s->n == 0)
        return true;
    memcpy(s->kept, base, bytes);
    if (go_on(s))
        return true;
    memcpy(base, s->kept, bytes);
    equilibrium_rebase(s->equations);
    return false;
}

bool search_settle(EquilibriumSearch *s)
{
    bool found;

    s->is_held = true;
    found = search_run(s);
    s->is_held = false;
    return found;
}

/* --- at the base --- */

double search_growth(EquilibriumSearch *s, const double *w)
{
    if (!look(s))
        return INFINITY;
    weigh(s, 1);
    return worst(s, equilibrium_residual(s->equations, w));
}

bool search_holds(EquilibriumSearch *s, int i, double *missed)
{
    const bool finite = look(s);

    *missed = s->missed[i];
    return finite && holds(s, i, *missed);
}

int search_rank(EquilibriumSearch *s)
{
    if (s->n == 0)
        return 0;
    if (!look(s) ||
        !factors_make(s->factors, equilibrium_jacobian(s->equations, N_VGetArrayPointer(s->w))))
        return -1;
    return factors_solve(s->factors, s->size, N_VGetArrayPointer(s->w));
}

/* the unknown that moves most along the null space; -1: none. O(n^3) */
static int loosest(const EquilibriumSearch *s, const double *values)
{
    const size_t n = (size_t)s->n;
    gsl_matrix *u = dense_matrix(n, n), *moves = dense_matrix(n, n);
    gsl_vector *sizes = dense_vector(n), *work = dense_vector(n);
    size_t most = 0;
    bool is_lifted;

    for (int c = 0; c < s->n; c++)
        for (int k = s->start[c]; k < s->start[c + 1]; k++)
            if (values[k] != 0)
                gsl_matrix_set(u, (size_t)s->row[k], (size_t)c, values[k] / s->entry[s->row[k]]);
    (void)gsl_linalg_SV_decomp(u, moves, sizes, work);
    for (size_t i = 1; i < n; i++)
        if (fabs(gsl_matrix_get(moves, i, n - 1)) >
            fabs(gsl_matrix_get(moves, most, n - 1)) * (1 + 1e-9))
            most = i;
    is_lifted = gsl_vector_get(sizes, n - 1) <= 1e-13 * gsl_vector_get(sizes, 0);
    MEM_FREE(u, moves, sizes, work);
    return is_lifted ? (int)most : -1;
}

int search_undetermined(EquilibriumSearch *s)
{
    const double *values;
    int column;

    if (s->n == 0 || !look(s))
        return -1;
    values = equilibrium_jacobian(s->equations, N_VGetArrayPointer(s->w));
    column = factors_singular(s->factors, values);
    return column < 0 && s->n <= SEARCH_MOST_SVD ? loosest(s, values) : column;
}

bool search_may_be_full(const EquilibriumSearch *s)
{
    return factors_may_be_full(s->factors);
}
