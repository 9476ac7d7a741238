/* operating.c: operating points by KINSOL (Hindmarsh and others 2005), and two continuations */
#include "simulate/operating.h"

#include "base/memory.h"
#include "simulate/linear.h"
#include "simulate/sparse.h"

#include <gsl/gsl_linalg.h>
#include <kinsol/kinsol.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#define FEW        100 /* unknowns for full matrices */
#define ITERATIONS 200
#define ENOUGH     1e-12 /* residual over the largest entry of its row, V or A */
#define GOOD       1e-9  /* the same, where rounding lets no step get better */
#define LEAST      1e-4  /* of the loads, in a step */
#define LEAK       1e-1  /* S, to begin with */
#define NO_LEAK    1e-14 /* S, from which on there is none */

typedef struct Search {
    Operating *o;
    Slopes slopes; /* those by x' left out */
    Probe *probe;  /* G, slopes */
    int n;
    int *start, *place; /* by columns: of each, and where each slope stands */
    SUNContext context;
    void *memory;
    N_Vector v, unit, size;
    SUNMatrix matrix;
    SUNLinearSolver linear;
} Search;

/* NOLINTNEXTLINE(readability-non-const-parameter): the type is that of SUNDIALS */
static void keep_quiet(int code, const char *module, const char *function, char *message,
                       void *data)
{
    (void)code, (void)module, (void)function, (void)message, (void)data;
}

static const double *values_at(const Search *s, const double *v)
{
    RowValues row = {.x = v, .z = v + s->o->l->nx};

    return probe_values(s->probe, &row);
}

static int residual(N_Vector v, N_Vector out, void *data)
{
    const Search *s = data;

    memcpy(N_VGetArrayPointer(out), values_at(s, N_VGetArrayPointer(v)),
           (size_t)s->n * sizeof(double));
    return vector_is_finite(N_VGetArrayPointer(out), s->n) ? 0 : 1;
}

static int jacobian(N_Vector v, N_Vector f, SUNMatrix matrix, void *data, N_Vector a, N_Vector b)
{
    const Search *s = data;
    const double *values = values_at(s, N_VGetArrayPointer(v)) + s->n;

    (void)f, (void)a, (void)b;
    for (int i = 0; i <= s->n; i++)
        SUNSparseMatrix_IndexPointers(matrix)[i] = s->start[i];
    for (int k = 0; k < s->slopes.count; k++) {
        SUNSparseMatrix_IndexValues(matrix)[s->place[k]] = s->slopes.row[k];
        SUNSparseMatrix_Data(matrix)[s->place[k]] = values[k];
    }
    return vector_is_finite(values, s->slopes.count) ? 0 : 1;
}

/* --- life --- */

/* what is left of the slopes with x' at 0: columns in (x, z) */
static void keep_slopes(Search *s)
{
    Slopes *all = &s->slopes;
    int nx = s->o->l->nx, kept = 0;

    for (int k = 0; k < all->count; k++) {
        if (k < all->rates && all->column[k] < nx)
            continue;
        all->row[kept] = all->row[k];
        all->column[kept] = all->column[k];
        all->value[kept++] = all->value[k];
    }
    all->count = kept;
    s->start = NEW_ARRAY(int, s->n + 2);
    s->place = NEW_ARRAY(int, kept);
    for (int k = 0; k < kept; k++)
        s->start[all->column[k] + 2]++;
    for (int i = 0; i < s->n; i++)
        s->start[i + 2] += s->start[i + 1];
    for (int k = 0; k < kept; k++)
        s->place[k] = s->start[all->column[k] + 1]++;
}

/* programs hold the parameters' values: they are made anew when a knob was turned */
static Status compile(Search *s, Diag *diag)
{
    const Reading *run = system_run(s->o->l->system);
    Parameters fresh = {.value = s->o->parameters->value, .context = s->o->parameters->context};
    LIST(Expr) roots = {0};
    Status status;

    probe_free(s->probe);
    s->probe = NULL;
    parameters_free(s->o->parameters);
    *s->o->parameters = fresh;
    for (int i = 0; i < s->n; i++)
        LIST_PUSH(roots, run->network_residual[i]);
    for (int k = 0; k < s->slopes.count; k++)
        LIST_PUSH(roots, s->slopes.value[k]);
    status = probe_new(s->o->l, s->o->parameters, roots.at, roots.count, &s->probe, diag);
    LIST_FREE(roots);
    return status;
}

static bool open_solver(Search *s)
{
    int code;

    if (SUNContext_Create(NULL, &s->context) != 0)
        return false;
    s->v = N_VNew_Serial(s->n, s->context);
    s->unit = N_VNew_Serial(s->n, s->context);
    s->size = N_VNew_Serial(s->n, s->context);
    N_VConst(1, s->unit);
    s->matrix = SUNSparseMatrix(s->n, s->n, s->slopes.count, CSC_MAT, s->context);
    s->linear = SUNLinSol_KLU(s->v, s->matrix, s->context);
    s->memory = KINCreate(s->context);
    code = KINInit(s->memory, residual, s->v);
    if (code == 0)
        code = KINSetUserData(s->memory, s);
    if (code == 0)
        code = KINSetErrHandlerFn(s->memory, keep_quiet, NULL);
    if (code == 0)
        code = KINSetLinearSolver(s->memory, s->linear, s->matrix);
    if (code == 0)
        code = KINSetJacFn(s->memory, jacobian);
    if (code == 0)
        code = KINSetMaxSetupCalls(s->memory, 1);
    if (code == 0)
        code = KINSetNumMaxIters(s->memory, ITERATIONS);
    if (code == 0)
        code = KINSetFuncNormTol(s->memory, ENOUGH);
    return code == 0 && KINSetScaledStepTol(s->memory, 1e-15) == 0;
}

static void close_search(Search *s)
{
    KINFree(&s->memory);
    if (s->linear != NULL)
        SUNLinSolFree(s->linear);
    if (s->matrix != NULL)
        SUNMatDestroy(s->matrix);
    if (s->context != NULL) {
        N_VDestroy(s->v);
        N_VDestroy(s->unit);
        N_VDestroy(s->size);
    }
    SUNContext_Free(&s->context);
    probe_free(s->probe);
    slopes_free(&s->slopes);
    mem_free(s->start);
    mem_free(s->place);
}

/* --- Newton --- */

static double missed(const Search *s)
{
    const double *values = values_at(s, N_VGetArrayPointer(s->v));
    double largest = 0;

    for (int i = 0; i < s->n; i++)
        largest = fmax(largest, fabs(values[i]) * NV_Ith_S(s->size, i));
    return vector_is_finite(values, s->n) ? largest : INFINITY;
}

/* rows weigh by their largest entries where the search begins */
static bool weigh_rows(Search *s)
{
    const double *values = values_at(s, s->o->v) + s->n;

    if (!vector_is_finite(values, s->slopes.count))
        return false;
    N_VConst(0, s->size);
    for (int k = 0; k < s->slopes.count; k++)
        NV_Ith_S(s->size, s->slopes.row[k]) =
            fmax(NV_Ith_S(s->size, s->slopes.row[k]), fabs(values[k]));
    for (int i = 0; i < s->n; i++)
        NV_Ith_S(s->size, i) = NV_Ith_S(s->size, i) > 0 ? 1 / NV_Ith_S(s->size, i) : 1;
    return true;
}

/* from o->v to o->v; it stays where no solution is found */
static bool newton(Search *s)
{
    size_t bytes = (size_t)s->n * sizeof(double);
    int code;

    if (!weigh_rows(s))
        return false;
    memcpy(N_VGetArrayPointer(s->v), s->o->v, bytes);
    code = KINSol(s->memory, s->v, KIN_LINESEARCH, s->unit, s->size);
    if (!vector_is_finite(N_VGetArrayPointer(s->v), s->n) || code < 0 || !(missed(s) <= GOOD))
        return false;
    memcpy(s->o->v, N_VGetArrayPointer(s->v), bytes);
    return true;
}

/* the place in v that moves most where G stays as it is; -1: none does. O(n^3) */
static int loosest(const Search *s)
{
    size_t n = (size_t)s->n;
    const double *values = values_at(s, s->o->v) + s->n;
    gsl_matrix *u = gsl_matrix_calloc(n, n), *moves = gsl_matrix_alloc(n, n);
    gsl_vector *sizes = gsl_vector_alloc(n), *work = gsl_vector_alloc(n);
    size_t most = 0;
    bool is_loose = false;

    if (vector_is_finite(values, s->slopes.count)) {
        for (int k = 0; k < s->slopes.count; k++)
            *gsl_matrix_ptr(u, (size_t)s->slopes.row[k], (size_t)s->slopes.column[k]) +=
                values[k] * NV_Ith_S(s->size, s->slopes.row[k]);
        (void)gsl_linalg_SV_decomp(u, moves, sizes, work);
        for (size_t i = 1; i < n; i++)
            if (fabs(gsl_matrix_get(moves, i, n - 1)) >
                fabs(gsl_matrix_get(moves, most, n - 1)) * (1 + 1e-9))
                most = i;
        is_loose = gsl_vector_get(sizes, n - 1) <= 1e-13 * gsl_vector_get(sizes, 0);
    }
    gsl_matrix_free(u);
    gsl_matrix_free(moves);
    gsl_vector_free(sizes);
    gsl_vector_free(work);
    return is_loose ? (int)most : -1;
}

/* the place in v of a column that the others span */
static int undetermined(const Search *s)
{
    Sparse *sparse = sparse_new(s->n, s->slopes.count, s->slopes.row, s->slopes.column);
    int column = -1;

    if (!sparse_factor(sparse, values_at(s, s->o->v) + s->n))
        column = sparse_singular(sparse);
    sparse_free(sparse);
    return column < 0 && s->n <= FEW ? loosest(s) : column;
}

/* --- continuations --- */

static Status grow_sources(Search *s, bool *found, Diag *diag)
{
    double reached = 0, share = 0.25;
    Status status = OK;

    s->o->knobs->load = 0;
    CHECK(compile(s, diag));
    *found = newton(s);
    while (*found && reached < 1 && share > LEAST) {
        CHECK(poll(s->o->watch));
        report(s->o->watch, "operating point: sources", reached);
        s->o->knobs->load = fmin(1, reached + share);
        CHECK(compile(s, diag));
        if (newton(s)) {
            reached = s->o->knobs->load;
            share *= 2;
        } else {
            share /= 4;
        }
    }
    *found = reached >= 1;
done:
    s->o->knobs->load = 1;
    return status;
}

static Status shrink_leaks(Search *s, bool *found, Diag *diag)
{
    double last = LEAK, factor = 0.1;
    Status status = OK;

    s->o->knobs->leak = LEAK;
    CHECK(compile(s, diag));
    *found = newton(s);
    while (*found && last > 0 && factor < 0.99) {
        double next = last * factor;

        CHECK(poll(s->o->watch));
        report(s->o->watch, "operating point: leaks", -1);
        s->o->knobs->leak = next < NO_LEAK ? 0 : next;
        CHECK(compile(s, diag));
        if (newton(s)) {
            last = s->o->knobs->leak;
            factor = factor * factor > 1e-3 ? factor * factor : factor;
        } else {
            factor = sqrt(factor);
        }
    }
    *found = *found && last == 0;
done:
    s->o->knobs->leak = 0;
    return status;
}

Status operating_find(Operating *o, bool *found, Diag *diag)
{
    Search s = {.o = o, .n = o->l->nx + o->l->nz};
    double *begun = NEW_ARRAY(double, s.n);
    size_t bytes = (size_t)s.n * sizeof(double);
    Status status = OK;

    o->singular = -1;
    *found = s.n == 0;
    if (s.n == 0)
        goto done;
    memcpy(begun, o->v, bytes);
    s.slopes = slopes_of(o->l);
    keep_slopes(&s);
    CHECK(compile(&s, diag));
    if (!open_solver(&s))
        CHECK(diag_set(diag, E_SOLVER, "SUNDIALS could not be started"));
    *found = newton(&s);
    if (*found)
        goto done;
    o->singular = undetermined(&s);
    CHECK(grow_sources(&s, found, diag));
    if (*found)
        goto done;
    memcpy(o->v, begun, bytes);
    CHECK(shrink_leaks(&s, found, diag));
    if (!*found)
        memcpy(o->v, begun, bytes);
done:
    close_search(&s);
    mem_free(begun);
    return status;
}
