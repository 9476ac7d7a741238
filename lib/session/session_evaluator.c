/* session_evaluator.c: numeric functions of a model, in SIMD batches
 *
 * Solves R(y, s) = 0 for s, group by group of the equations. The linear systems are solved lane by
 * lane: rows and columns are scaled to equal size, then Gaussian elimination, or least squares of
 * least norm where constraints are redundant. Newton's method iterates in all lanes at once, each
 * with a step of its own. Nothing is allocated once an evaluator is made. */
#include "session/session_model.h"

#include "algebra/dense.h"
#include "algebra/linear.h"
#include "session/session_impl.h"
#include "session/session_limits.h"

#include <gsl/gsl_linalg.h>
#include <math.h>

enum { MOST_STEPS = 200, MOST_HALVES = 60, MOST_SWEEPS = 20, CONFIRMED = 3 };

/* square equations of one size */
typedef struct SessionEvaluatorSolver {
    int n;
    Lu *lu;
    gsl_matrix *a;
    gsl_vector *tau[2], *x, *rest, *work;
    gsl_permutation *order;
    size_t rank;
    double *rows, *scale; /* [A | b], n x (n + 1); of columns */
} SessionEvaluatorSolver;

struct ct_evaluator {
    const ct_model *model;
    SimdBatch **values; /* one a function */
    SimdBatch *(*slopes)[DIFFERENTIABLE];
    SessionEvaluatorSolver groups[2], all,
        nearest;     /* of groups of unknowns, of the residual, of projection */
    double *numbers; /* results of a function, in all lanes */
    double *old, *step, *weight, *lack, *trial; /* of Newton's method */
    int *near;
    double *slope_of_s; /* of one lane, by entries of a part */
};

/* --- equations of one lane --- */

static void solver_open(SessionEvaluatorSolver *solver, int n, bool is_redundant)
{
    solver->n = n;
    solver->rows = NEW_ARRAY(double, n *(n + 1));
    solver->scale = NEW_ARRAY(double, n + 1);
    if (!is_redundant) {
        solver->lu = lu_new(n);
        return;
    }
    solver->a = dense_matrix((size_t)n, (size_t)n);
    for (int i = 0; i < COUNT(solver->tau); i++)
        solver->tau[i] = dense_vector((size_t)n);
    solver->x = dense_vector((size_t)n);
    solver->rest = dense_vector((size_t)n);
    solver->work = dense_vector((size_t)n);
    solver->order = dense_permutation((size_t)n);
}

static void solver_close(SessionEvaluatorSolver *solver)
{
    lu_free(solver->lu);
    MEM_FREE(solver->rows, solver->scale, solver->a, solver->tau[0], solver->tau[1], solver->x,
             solver->rest, solver->work, solver->order);
}

static double largest_in(const double *values, int count, int stride)
{
    double most = 0;

    for (int i = 0; i < count; i++)
        if (!(fabs(values[(size_t)i * stride]) <= most))
            most = fabs(values[(size_t)i * stride]);
    return most;
}

/* Factor the matrix in `rows`; right sides are scaled with it. */
static bool solver_factor(SessionEvaluatorSolver *solver)
{
    const int n = solver->n, w = n + 1;
    double *a = solver->rows;

    for (int i = 0; i < n; i++) {
        const double most = largest_in(a + (size_t)i * w, n, 1);

        if (!isfinite(most) || (!(most > 0) && solver->lu != NULL))
            return false;
        for (int j = 0; most > 0 && j < w; j++)
            a[i * w + j] /= most;
    }
    for (int j = 0; j < n; j++) {
        /* the least norm is that of the unknowns themselves */
        solver->scale[j] = solver->lu != NULL ? largest_in(a + j, n, w) : 1;
        if (!(solver->scale[j] > 0))
            return false;
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            *(solver->lu != NULL ? lu_matrix(solver->lu) + (size_t)i * n + j
                                 : gsl_matrix_ptr(solver->a, (size_t)i, (size_t)j)) =
                a[i * w + j] / solver->scale[j];
    if (solver->lu != NULL)
        return lu_factor(solver->lu) && lu_pivot_ratio(solver->lu) > EVALUATOR_SINGULAR;
    return gsl_linalg_COD_decomp_e(solver->a, solver->tau[0], solver->tau[1], solver->order,
                                   EVALUATOR_RANK, &solver->rank, solver->work) == GSL_SUCCESS;
}

/* b, scaled as the rows are, becomes x */
static bool solver_solve(SessionEvaluatorSolver *solver, double *b)
{
    const int n = solver->n;

    if (solver->lu != NULL) {
        lu_solve(solver->lu, b);
    } else {
        const gsl_vector_const_view right = gsl_vector_const_view_array(b, (size_t)n);

        if (gsl_linalg_COD_lssolve(solver->a, solver->tau[0], solver->tau[1], solver->order,
                                   solver->rank, &right.vector, solver->x,
                                   solver->rest) != GSL_SUCCESS)
            return false;
        memcpy(b, solver->x->data, (size_t)n * sizeof(double));
    }
    for (int i = 0; i < n; i++)
        b[i] /= solver->scale[i];
    return vector_is_finite(b, n);
}

/* x of the rows [A | b] that were filled in */
static bool solver_run(SessionEvaluatorSolver *solver, double *x)
{
    const int n = solver->n;

    if (!solver_factor(solver))
        return false;
    for (int i = 0; i < n; i++)
        x[i] = solver->rows[i * (n + 1) + n];
    return solver_solve(solver, x);
}

/* --- functions --- */

static void put(const ct_evaluator *e, SimdBatch *lanes, const double *p, const double *t,
                const double *y, const double *s)
{
    const ct_model *model = e->model;
    const double *const arrays[] = {[CODE_P] = p, [CODE_T] = t, [CODE_Y] = y, [CODE_S] = s};

    for (int i = 0; i < model->input_count; i++) {
        const struct ModelInput *input = &model->inputs[i];

        if (input->place >= 0 && arrays[input->array] != NULL)
            simd_batch_set(lanes, i, input->stage,
                           arrays[input->array] + (size_t)input->place * model->lanes);
    }
    simd_batch_run(lanes);
}

void ct_evaluate(ct_evaluator *e, int function, const double *p, const double *t, const double *y,
                 const double *s, double *values)
{
    const ModelFunction *f = &e->model->functions.at[function];
    const int lanes = e->model->lanes;

    put(e, e->values[function], p, t, y, s);
    for (int i = 0; i < f->rows * f->columns; i++)
        for (int lane = 0; lane < lanes; lane++)
            values[i * lanes + lane] = simd_batch_root(e->values[function], i, lane);
}

/* --- solving --- */

/* the rows of a group in a lane */
static void take_rows(const ct_evaluator *e, const CodeGroup *group, SessionEvaluatorSolver *solver,
                      int lane)
{
    for (int i = 0; i < group->count * (group->count + 1); i++)
        solver->rows[i] = simd_batch_root(e->values[group->function], i, lane);
}

/* no solution in this lane */
static void lose(const ct_evaluator *e, double *values, int count, int lane)
{
    for (int i = 0; i < count; i++)
        values[(size_t)i * e->model->lanes + lane] = NAN;
}

static bool solve_linear(ct_evaluator *e, const CodeGroup *group, SessionEvaluatorSolver *solver,
                         double *s)
{
    const int lanes = e->model->lanes;
    bool all = true;

    for (int lane = 0; lane < lanes; lane++) {
        take_rows(e, group, solver, lane);
        if (!solver_run(solver, e->step)) {
            lose(e, s, e->model->ns, lane);
            all = false;
            continue;
        }
        for (int i = 0; i < group->count; i++)
            s[(group->first + i) * lanes + lane] = e->step[i];
    }
    return all;
}

/* norm of the residuals of a lane, each divided by its weight */
static double lack_of(const ct_evaluator *e, const CodeGroup *group, int lane)
{
    const int n = group->count;
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += fabs(simd_batch_root(e->values[group->function], i * (n + 1) + n, lane)) /
               e->weight[i * e->model->lanes + lane];
    return sum;
}

/* the search direction of a lane; false: there is none */
static bool find_step(ct_evaluator *e, const CodeGroup *group, SessionEvaluatorSolver *solver,
                      const double *s, int lane)
{
    const int n = group->count, lanes = e->model->lanes;

    take_rows(e, group, solver, lane);
    for (int i = 0; i < n; i++)
        e->weight[i * lanes + lane] = largest_in(solver->rows + (size_t)i * (n + 1), n, 1);
    e->lack[lane] = lack_of(e, group, lane);
    if (!solver_run(solver, e->trial))
        return false;
    for (int i = 0; i < n; i++) {
        e->step[i * lanes + lane] = e->trial[i];
        e->old[i * lanes + lane] = s[(group->first + i) * lanes + lane];
    }
    return true;
}

/* a lane's s after `part` of its step */
static void go(const ct_evaluator *e, const CodeGroup *group, double *s, int lane, double part)
{
    const int lanes = e->model->lanes;

    for (int i = 0; i < group->count; i++)
        s[(group->first + i) * lanes + lane] =
            e->old[i * lanes + lane] + part * e->step[i * lanes + lane];
}

/* Steps are halved in all lanes in which they increase the residual. */
static void search(ct_evaluator *e, const CodeGroup *group, const double *p, const double *t,
                   const double *y, double *s)
{
    const int lanes = e->model->lanes;
    unsigned open = 0;
    double part = 1;

    for (int lane = 0; lane < lanes; lane++)
        if (e->near[lane] == 0 && e->lack[lane] > 0)
            open |= 1U << lane;
    for (int halves = 0; open != 0 && halves < MOST_HALVES; halves++) {
        put(e, e->values[group->function], p, t, y, s);
        part /= 2;
        for (int lane = 0; lane < lanes; lane++)
            if ((open >> lane & 1) != 0 && lack_of(e, group, lane) < e->lack[lane])
                open &= ~(1U << lane);
            else if ((open >> lane & 1) != 0)
                go(e, group, s, lane, part);
    }
}

/* whether a lane's steps have become small */
static bool is_near(const ct_evaluator *e, const CodeGroup *group, int lane)
{
    const int lanes = e->model->lanes;
    const double change = largest_in(e->step + lane, group->count, lanes);

    return change <= EVALUATOR_NEAR * largest_in(e->old + lane, group->count, lanes) ||
           !(e->lack[lane] > 0);
}

/* Newton's method, its steps shortened where they lead away */
static bool solve_newton(ct_evaluator *e, const CodeGroup *group, SessionEvaluatorSolver *solver,
                         const double *p, const double *t, const double *y, double *s)
{
    const int lanes = e->model->lanes;
    unsigned open = (1U << lanes) - 1, lost = 0;

    memset(e->near, 0, (size_t)lanes * sizeof(int));
    memset(e->step, 0, (size_t)(group->count * lanes) * sizeof(double));
    for (int tries = 0; open != 0 && tries < MOST_STEPS; tries++) {
        put(e, e->values[group->function], p, t, y, s);
        for (int lane = 0; lane < lanes; lane++) {
            if ((open >> lane & 1) != 0 && !find_step(e, group, solver, s, lane)) {
                lost |= 1U << lane;
                open &= ~(1U << lane);
            }
            if ((open >> lane & 1) != 0)
                go(e, group, s, lane, 1);
            else
                e->lack[lane] = 0;
        }
        search(e, group, p, t, y, s);
        for (int lane = 0; lane < lanes; lane++)
            if ((open >> lane & 1) != 0 && is_near(e, group, lane) && ++e->near[lane] >= CONFIRMED)
                open &= ~(1U << lane);
    }
    for (int lane = 0; lane < lanes; lane++)
        if (((open | lost) >> lane & 1) != 0)
            lose(e, s, e->model->ns, lane);
    return (open | lost) == 0;
}

ct_status ct_solve(ct_evaluator *e, const double *p, const double *t, const double *y, double *s)
{
    const ct_model *model = e->model;
    bool all = true;

    for (int g = 0; g < model->group_count; g++) {
        const CodeGroup *group = &model->groups[g];

        if (group->iterates) {
            all = solve_newton(e, group, &e->groups[g], p, t, y, s) && all;
            continue;
        }
        put(e, e->values[group->function], p, t, y, s);
        all = solve_linear(e, group, &e->groups[g], s) && all;
    }
    if (model->accelerations >= 0) {
        const int rows = model->functions.at[model->accelerations].rows;
        double *last = s + (size_t)(model->ns - rows) * model->lanes;

        ct_evaluate(e, model->accelerations, p, t, y, s, last);
        all = vector_is_finite(last, rows * model->lanes) && all;
    }
    return all ? CT_OK : CT_FAILED;
}

ct_status ct_rates(ct_evaluator *e, const double *p, const double *t, const double *y, double *s,
                   double *rates)
{
    const ct_status status = ct_solve(e, p, t, y, s);

    ct_evaluate(e, model_function_find(e->model, "derivative"), p, t, y, s, rates);
    return status;
}

/* --- projection --- */

static void normalise(const ct_model *model, double *y)
{
    const int lanes = model->lanes;

    for (int k = 0; k < model->quaternions.count; k++)
        for (int lane = 0; lane < lanes; lane++) {
            double *at = y + (size_t)model->quaternions.at[k] * lanes + lane;
            double sum = 0;

            for (int i = 0; i < 4; i++)
                sum += at[i * lanes] * at[i * lanes];
            for (int i = 0; i < 4; i++)
                at[i * lanes] /= sqrt(sum);
        }
}

/* the least correction of u or du in a lane that cancels the residual `off`, in e->trial; the
 * Jacobian is current */
static bool find_nearest(ct_evaluator *e, int jacobian, const double *off, int lane)
{
    const ct_model *model = e->model;
    const int nu = model->nu, n = nu + model->m, w = n + 1;
    double *a = e->nearest.rows;

    memset(a, 0, (size_t)(n * w) * sizeof(double));
    for (int i = 0; i < nu; i++)
        a[i * w + i] = 1;
    for (int i = 0; i < model->m; i++) {
        for (int j = 0; j < nu; j++)
            a[j * w + nu + i] = a[(nu + i) * w + j] =
                simd_batch_root(e->values[jacobian], i * nu + j, lane);
        a[(nu + i) * w + n] = -off[i * model->lanes + lane];
    }
    return solver_run(&e->nearest, e->trial);
}

static bool project_positions(ct_evaluator *e, const double *p, const double *t, double *y)
{
    const ct_model *model = e->model;
    const int lanes = model->lanes, constraints = model_function_find(model, "constraints"),
              jacobian = model_function_find(model, "jacobian"),
              map = model_function_find(model, "map");
    bool all = true;

    for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
        ct_evaluate(e, constraints, p, t, y, NULL, e->numbers);
        if (largest_in(e->numbers, model->m * lanes, 1) <= EVALUATOR_CLOSED)
            break;
        put(e, e->values[jacobian], p, t, y, NULL);
        put(e, e->values[map], p, t, y, NULL);
        for (int lane = 0; lane < lanes; lane++) {
            if (!find_nearest(e, jacobian, e->numbers, lane)) {
                lose(e, y, ct_model_size(model, CT_STATE), lane);
                all = false;
                continue;
            }
            for (int i = 0; i < model->n; i++)
                for (int j = 0; j < model->nu; j++)
                    y[i * lanes + lane] +=
                        simd_batch_root(e->values[map], i * model->nu + j, lane) * e->trial[j];
        }
        normalise(model, y);
    }
    return all;
}

static bool project_speeds(ct_evaluator *e, const double *p, const double *t, double *y)
{
    const ct_model *model = e->model;
    const int lanes = model->lanes, nu = model->nu,
              velocity = model_function_find(model, "velocity"),
              jacobian = model_function_find(model, "jacobian");
    double *u = y + (size_t)model->n * lanes;
    bool all = true;

    ct_evaluate(e, velocity, p, t, y, NULL, e->numbers);
    put(e, e->values[jacobian], p, t, y, NULL);
    for (int lane = 0; lane < lanes; lane++) {
        for (int i = 0; i < model->m; i++) {
            double *off = &e->numbers[i * lanes + lane];

            *off = -*off;
            for (int j = 0; j < nu; j++)
                *off +=
                    simd_batch_root(e->values[jacobian], i * nu + j, lane) * u[j * lanes + lane];
        }
        if (!find_nearest(e, jacobian, e->numbers, lane)) {
            lose(e, y, ct_model_size(model, CT_STATE), lane);
            all = false;
            continue;
        }
        for (int j = 0; j < nu; j++)
            u[j * lanes + lane] += e->trial[j];
    }
    return all;
}

ct_status ct_project(ct_evaluator *e, const double *p, const double *t, double *y)
{
    const ct_model *model = e->model;
    const int first = model->n + model->nu + model->nx,
              angles = model_function_find(model, "angles");
    bool all = true;

    normalise(model, y);
    if (model->m > 0) {
        all = project_positions(e, p, t, y);
        all = project_speeds(e, p, t, y) && all;
    }
    ct_evaluate(e, angles, p, t, y, NULL, e->numbers);
    memcpy(y + (size_t)first * model->lanes, e->numbers,
           (size_t)(model->functions.at[angles].rows * model->lanes) * sizeof(double));
    return all ? CT_OK : CT_FAILED;
}

/* --- derivatives --- */

static SimdBatch *put_slopes(ct_evaluator *e, int function, ct_part by, const double *p,
                             const double *t, const double *y, const double *s)
{
    put(e, e->slopes[function][by], p, t, y, s);
    return e->slopes[function][by];
}

ct_status ct_partial_derivatives(ct_evaluator *e, int function, ct_part by, const double *p,
                                 const double *t, const double *y, const double *s, double *values)
{
    const ModelFunction *f = &e->model->functions.at[function];
    const int lanes = e->model->lanes, columns = ct_model_size(e->model, by);
    const SimdBatch *slopes;

    if (!f->has_slopes || by >= CT_OUTPUTS)
        return CT_FAILED;
    slopes = put_slopes(e, function, by, p, t, y, s);
    memset(values, 0, (size_t)(f->rows * f->columns * columns * lanes) * sizeof(double));
    for (int k = 0; k < f->slopes[by].count; k++)
        for (int lane = 0; lane < lanes; lane++)
            values[(f->slopes[by].row[k] * columns + f->slopes[by].column[k]) * lanes + lane] =
                simd_batch_root(slopes, k, lane);
    return CT_OK;
}

/* A direction, in e->step, in which s may change without changing the residual, for redundant
 * constraints: a random direction minus its least solution. */
static bool find_open_direction(ct_evaluator *e, const double *a)
{
    const int n = e->model->ns, w = n + 1;
    double *open = e->step, *held = e->old;

    for (int i = 0; i < n; i++)
        open[i] = 1 + fmod(i * 0.6180339887498949, 1); /* all different */
    for (int i = 0; i < n; i++) {
        held[i] = 0;
        for (int j = 0; j < n; j++)
            held[i] += a[i * w + j] * open[j];
    }
    if (!solver_solve(&e->all, held))
        return false;
    for (int i = 0; i < n; i++)
        open[i] -= held[i];
    return true;
}

/* ds of a lane, entries of s by those of the part, in e->slope_of_s: R_s ds = -R_x. With redundant
 * constraints it is the least one. */
static bool find_solution_slopes(ct_evaluator *e, ct_part by, int lane)
{
    const ct_model *model = e->model;
    const ModelFunction *residual = &model->functions.at[model->residual];
    const SessionSlopes *of_s = &residual->slopes[CT_SOLUTION], *of_x = &residual->slopes[by];
    const SimdBatch *simd_batch_s = e->slopes[model->residual][CT_SOLUTION],
                    *simd_batch_x = e->slopes[model->residual][by];
    const int n = model->ns, w = n + 1, columns = ct_model_size(model, by);
    double *a = e->all.rows, *ds = e->slope_of_s;

    memset(a, 0, (size_t)(n * w) * sizeof(double));
    for (int k = 0; k < of_s->count; k++)
        a[of_s->row[k] * w + of_s->column[k]] = simd_batch_root(simd_batch_s, k, lane);
    for (int i = 0; i < n; i++)
        a[i * w + n] = 1; /* becomes one over what the row is scaled by */
    if (!solver_factor(&e->all) || (model->is_redundant && !find_open_direction(e, e->all.rows)))
        return false;
    memset(ds, 0, (size_t)(n * columns) * sizeof(double));
    for (int k = 0; k < of_x->count; k++)
        ds[of_x->row[k] * columns + of_x->column[k]] =
            -simd_batch_root(simd_batch_x, k, lane) * a[of_x->row[k] * w + n];
    for (int column = 0; column < columns; column++) {
        for (int i = 0; i < n; i++)
            e->trial[i] = ds[i * columns + column];
        if (!solver_solve(&e->all, e->trial))
            return false;
        for (int i = 0; i < n; i++)
            ds[i * columns + column] = e->trial[i];
    }
    return true;
}

/* Entries of a function that move with what its constraints leave open have no derivatives. */
static bool lose_open_entries(const ct_evaluator *e, const ModelFunction *f, const SimdBatch *of_s,
                              int columns, int lane, double *values)
{
    const SessionSlopes *slopes = &f->slopes[CT_SOLUTION];
    bool none = true;

    for (int k = 0, next; k < slopes->count; k = next) {
        const int row = slopes->row[k];
        double sum = 0, size = 0;

        for (next = k; next < slopes->count && slopes->row[next] == row; next++) {
            const double slope = simd_batch_root(of_s, next, lane);

            sum += slope * e->step[slopes->column[next]];
            size += fabs(slope);
        }
        if (fabs(sum) <= EVALUATOR_UNDETERMINED * size)
            continue;
        lose(e, values + (size_t)row * columns * e->model->lanes, columns, lane);
        none = false;
    }
    return none;
}

ct_status ct_derivatives(ct_evaluator *e, int function, ct_part by, const double *p,
                         const double *t, const double *y, const double *s, double *values)
{
    const ct_model *model = e->model;
    const ModelFunction *f = &model->functions.at[function];
    const SessionSlopes *of_s = &f->slopes[CT_SOLUTION];
    const int lanes = model->lanes, columns = ct_model_size(model, by);
    bool all = true;
    ct_status status;

    if (by >= CT_SOLUTION)
        return CT_FAILED;
    status = ct_partial_derivatives(e, function, by, p, t, y, s, values);
    if (status != CT_OK || of_s->count == 0)
        return status;
    (void)put_slopes(e, function, CT_SOLUTION, p, t, y, s);
    (void)put_slopes(e, model->residual, CT_SOLUTION, p, t, y, s);
    (void)put_slopes(e, model->residual, by, p, t, y, s);
    for (int lane = 0; lane < lanes; lane++) {
        if (!find_solution_slopes(e, by, lane)) {
            lose(e, values, f->rows * f->columns * columns, lane);
            all = false;
            continue;
        }
        for (int k = 0; k < of_s->count; k++) {
            const double slope = simd_batch_root(e->slopes[function][CT_SOLUTION], k, lane);

            for (int c = 0; c < columns; c++)
                values[(of_s->row[k] * columns + c) * lanes + lane] +=
                    slope * e->slope_of_s[of_s->column[k] * columns + c];
        }
        if (model->is_redundant)
            all =
                lose_open_entries(e, f, e->slopes[function][CT_SOLUTION], columns, lane, values) &&
                all;
    }
    return all ? CT_OK : CT_FAILED;
}

/* --- an evaluator --- */

static void open_solvers(ct_evaluator *e)
{
    const ct_model *model = e->model;

    for (int g = 0; g < model->group_count; g++)
        solver_open(&e->groups[g], model->groups[g].count, model->is_redundant);
    if (model->functions.at[model->residual].has_slopes)
        solver_open(&e->all, model->ns, model->is_redundant);
    if (model->m > 0)
        solver_open(&e->nearest, model->nu + model->m, model->is_redundant);
}

ct_evaluator *ct_evaluator_new(const ct_model *model)
{
    TRANSACTION(NULL);

    const int functions = model->functions.count, lanes = model->lanes,
              most = model->ns + model->nu + model->m + 1;
    const int columns = ct_model_size(model, CT_PARAMETERS) + ct_model_size(model, CT_STATE);
    ct_evaluator *e = NEW(ct_evaluator);

    e->model = model;
    e->values = NEW_ARRAY(SimdBatch *, functions);
    e->slopes = mem_array(functions, sizeof *e->slopes);
    for (int f = 0; f < functions; f++) {
        const ModelFunction *function = &model->functions.at[f];

        e->values[f] = simd_batch_new(function->program, function->native, lanes);
        for (int part = 0; function->has_slopes && part < DIFFERENTIABLE; part++)
            e->slopes[f][part] = simd_batch_new(function->slopes[part].program,
                                                function->slopes[part].native, lanes);
    }
    open_solvers(e);
    e->numbers = NEW_ARRAY(double, model->largest *lanes);
    e->old = NEW_ARRAY(double, most *lanes);
    e->step = NEW_ARRAY(double, most *lanes);
    e->weight = NEW_ARRAY(double, most *lanes);
    e->trial = NEW_ARRAY(double, most);
    e->lack = NEW_ARRAY(double, lanes);
    e->near = NEW_ARRAY(int, lanes);
    if (model->functions.at[model->residual].has_slopes)
        e->slope_of_s = NEW_ARRAY(double, model->ns *columns);
    return e;
}

void ct_evaluator_free(ct_evaluator *e)
{
    if (e == NULL)
        return;
    for (int f = 0; f < e->model->functions.count; f++) {
        simd_batch_free(e->values[f]);
        for (int part = 0; part < DIFFERENTIABLE; part++)
            simd_batch_free(e->slopes[f][part]);
    }
    for (int g = 0; g < e->model->group_count; g++)
        solver_close(&e->groups[g]);
    if (e->all.n > 0)
        solver_close(&e->all);
    if (e->nearest.n > 0)
        solver_close(&e->nearest);
    MEM_FREE(e->values, e->slopes, e->numbers, e->old, e->step, e->weight, e->trial, e->lack,
             e->near, e->slope_of_s, e);
}
