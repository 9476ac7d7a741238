/* fit_solve.c: Levenberg and Marquardt's method between bounds
 *
 * With weights w = rho' the losses near x are sum w (z + J d)^2. The columns of sqrt(w) J are
 * scaled to length 1. Their singular values s, vectors U and V give the step for every damping
 * lambda: d = -V s/(s^2 + lambda) U^T sqrt(w) z. */
#include "simulate/fit/fit_solve.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { MOST_ITERATIONS = 100, PASSES = 3 };

static const double first_damping = 1e-3, most_damping = 1e12;
/* a step that changes no unknown by more ends the search */
static const double least_change = 1e-10;
/* so does a decrease below this share of the losses */
static const double least_decrease = 1e-15;
/* 0.01 standard errors, squared */
static const double small_decrease = 1e-4;
/* singular values that count in a step without damping, relative to the largest */
static const double least_value = 1e-6;
typedef struct FitSearch {
    const FitProblem *problem;
    FitSolution *at; /* where it is */
    Loss loss;
    double losses;                     /* there */
    double *x, *z;                     /* where it tries */
    double *gradient, *lengths, *step; /* an unknown each */
    double *a, *s, *v, *right;         /* of the free columns */
    int *free, free_count;
    double damping, growth;
} FitSearch;

static double losses_of(const FitSearch *search, const double *z)
{
    const double c = search->loss == LOSS_SQUARES ? 1 : search->at->scale;
    double sum = 0;

    for (int i = 0; i < search->problem->residuals; i++)
        sum += loss_value(search->loss, z[i] / c * (z[i] / c));
    return c * c * sum;
}

static double weight(const FitSearch *search, double z)
{
    const double c = search->at->scale;

    return search->loss == LOSS_SQUARES ? 1 : loss_slope(search->loss, z / c * (z / c));
}

/* false in *has: the model has no values there */
static Status evaluate(FitSearch *search, const double *x, double *z, bool *has, Diag *diag)
{
    const FitProblem *problem = search->problem;

    search->at->evaluations++;
    TRY(problem->function(problem->context, 1, x, z, diag));
    *has = true;
    for (int i = 0; i < problem->residuals; i++)
        *has = *has && isfinite(z[i]);
    return OK;
}

/* --- derivatives --- */

static Status find_jacobian(FitSearch *search, Diag *diag)
{
    const FitProblem *problem = search->problem;
    FitSolution *at = search->at;
    const Differences differences = {.unknowns = problem->unknowns,
                                     .values = problem->residuals,
                                     .low = problem->low,
                                     .high = problem->high,
                                     .steps = search->step,
                                     .function = problem->function,
                                     .context = problem->context};

    if (problem->derivatives != NULL) {
        bool has = false;

        TRY(problem->derivatives(problem->context, at->x, at->jacobian, &has, diag));
        at->evaluations += has;
        if (has)
            return OK;
    }
    for (int i = 0; i < problem->unknowns; i++)
        search->step[i] = fmin(problem->step * fit_size(problem, at->x, i),
                               (problem->high[i] - problem->low[i]) / 2);
    return differences_find(&differences, at->x, at->z, at->jacobian, &at->evaluations, diag);
}

/* the jacobian, the gradient, and what is free */
static Status differentiate(FitSearch *search, Diag *diag)
{
    const FitProblem *problem = search->problem;
    FitSolution *at = search->at;
    const int m = problem->residuals, n = problem->unknowns;

    TRY(find_jacobian(search, diag));
    search->free_count = 0;
    for (int i = 0; i < n; i++) {
        double gradient = 0, squares = 0;

        for (int r = 0; r < m; r++) {
            const double slope = at->jacobian[(ptrdiff_t)r * n + i], w = weight(search, at->z[r]);

            gradient += w * slope * at->z[r];
            squares += w * slope * slope;
        }
        search->gradient[i] = gradient;
        search->lengths[i] = squares > 0 ? sqrt(squares) : 1;
        at->is_held[i] = (at->x[i] <= problem->low[i] && gradient > 0) ||
                         (at->x[i] >= problem->high[i] && gradient < 0);
        if (!at->is_held[i])
            search->free[search->free_count++] = i;
    }
    return OK;
}

static void decompose(FitSearch *search)
{
    const FitSolution *at = search->at;
    const int m = search->problem->residuals, n = search->problem->unknowns;
    const int columns = search->free_count;

    if (columns == 0)
        return;
    memset(search->a, 0, (size_t)(m > n ? m : n) * (size_t)n * sizeof *search->a);
    for (int r = 0; r < m; r++) {
        const double root = sqrt(weight(search, at->z[r]));

        for (int k = 0; k < columns; k++)
            search->a[(ptrdiff_t)r * columns + k] =
                root * at->jacobian[(ptrdiff_t)r * n + search->free[k]] /
                search->lengths[search->free[k]];
    }
    fit_singular_values(search->a, m, columns, search->s, search->v);
    memset(search->right, 0, (size_t)n * sizeof *search->right);
    for (int r = 0; r < m; r++) {
        const double z = sqrt(weight(search, at->z[r])) * at->z[r];

        for (int k = 0; k < columns; k++)
            search->right[k] += search->a[(ptrdiff_t)r * columns + k] * z;
    }
}

/* --- steps --- */

/* to search->x; returns by how much the losses should decrease */
static double make_step(FitSearch *search)
{
    const FitProblem *problem = search->problem;
    const FitSolution *at = search->at;
    const int m = problem->residuals, n = problem->unknowns, columns = search->free_count;
    double linear = 0, squares = 0;

    memset(search->step, 0, (size_t)n * sizeof *search->step);
    for (int k = 0; k < columns; k++) {
        double sum = 0;

        for (int i = 0; i < columns; i++)
            if (search->s[i] > 0)
                sum -= search->v[(ptrdiff_t)k * columns + i] * search->s[i] /
                       (search->s[i] * search->s[i] + search->damping) * search->right[i];
        search->step[search->free[k]] = sum / search->lengths[search->free[k]];
    }
    for (int i = 0; i < n; i++) {
        search->x[i] = fmin(fmax(at->x[i] + search->step[i], problem->low[i]), problem->high[i]);
        search->step[i] = search->x[i] - at->x[i];
        linear += search->gradient[i] * search->step[i];
    }
    for (int r = 0; r < m; r++) {
        double change = 0;

        for (int i = 0; i < n; i++)
            change += at->jacobian[(ptrdiff_t)r * n + i] * search->step[i];
        squares += weight(search, at->z[r]) * change * change;
    }
    return -2 * linear - squares;
}

static bool is_small(const FitSearch *search, double decrease)
{
    const FitProblem *problem = search->problem;
    double change = 0;

    for (int i = 0; i < problem->unknowns; i++)
        change = fmax(change, fabs(search->step[i]) / fit_size(problem, search->at->x, i));
    return change <= least_change || decrease <= least_decrease * search->losses ||
           decrease <= problem->noise * problem->noise;
}

static void move(FitSearch *search, double losses, double ratio)
{
    FitSolution *at = search->at;

    memcpy(at->x, search->x, (size_t)at->unknowns * sizeof *at->x);
    memcpy(at->z, search->z, (size_t)at->residuals * sizeof *at->z);
    search->losses = losses;
    search->damping *= fmax(1.0 / 3, 1 - pow(2 * ratio - 1, 3));
    search->growth = 2;
}

/* Whether a step without damping gains no more than rounding of the model hides, or moves no
 * unknown by more than 0.01 standard errors. */
static bool is_at_minimum(const FitSearch *search)
{
    const int m = search->problem->residuals, n = search->free_count;
    const double rounding = pow(search->problem->noise, 2);
    double decrease = 0;

    for (int i = 0; i < n; i++)
        if (search->s[i] > least_value * search->s[0])
            decrease += search->right[i] * search->right[i];
    return decrease <= rounding || search->losses <= m * rounding ||
           decrease * (m > n ? m - n : 1) <= small_decrease * search->losses;
}

/* One step that decreases the losses. *ends: there is none, or it would be too small. */
static Status descend(FitSearch *search, bool *ends, Diag *diag)
{
    search->at->is_converged = is_at_minimum(search);
    for (;;) {
        const double decrease = make_step(search);
        bool has;
        double losses;

        if (is_small(search, decrease) || search->damping > most_damping) {
            if (search->damping <= first_damping)
                search->at->is_converged = true;
            *ends = true;
            return OK;
        }
        TRY(evaluate(search, search->x, search->z, &has, diag));
        losses = has ? losses_of(search, search->z) : INFINITY;
        if (losses < search->losses) {
            move(search, losses, (search->losses - losses) / decrease);
            return OK;
        }
        search->damping *= search->growth;
        search->growth *= 2;
    }
}

static Status minimise(FitSearch *search, Diag *diag)
{
    bool ends = false;

    search->damping = first_damping;
    search->growth = 2;
    search->at->is_converged = false;
    search->losses = losses_of(search, search->at->z);
    for (int i = 0; i < MOST_ITERATIONS && !ends; i++) {
        TRY(differentiate(search, diag));
        decompose(search);
        TRY(descend(search, &ends, diag));
        search->at->iterations += !ends;
    }
    return OK;
}

/* the scale of the losses from the residuals as they are */
static void rescale(FitSearch *search)
{
    const FitProblem *problem = search->problem;
    const double deviation =
        problem->sigma_is_known ? 1 : loss_deviation(search->at->z, problem->residuals);

    search->at->scale = loss_tuning(problem->loss) * fmax(deviation, problem->noise);
    if (!(search->at->scale > 0))
        search->at->scale = 1;
}

/* squares first; then other losses, whose scale follows from the residuals */
static Status minimise_losses(FitSearch *search, Diag *diag)
{
    const FitProblem *problem = search->problem;

    search->loss = LOSS_SQUARES;
    TRY(minimise(search, diag));
    for (int pass = 0; problem->loss != LOSS_SQUARES && pass < PASSES; pass++) {
        rescale(search);
        search->loss = problem->loss;
        TRY(minimise(search, diag));
    }
    return OK;
}

/* --- the solution --- */

static FitSolution *solution_new(const FitProblem *problem)
{
    const int n = problem->unknowns, m = problem->residuals;
    FitSolution *out = NEW(FitSolution);

    out->unknowns = n;
    out->residuals = m;
    out->x = NEW_ARRAY(double, n);
    out->z = NEW_ARRAY(double, m);
    out->jacobian = mem_array((size_t)m * (size_t)n, sizeof(double));
    out->is_held = NEW_ARRAY(bool, n);
    out->errors = NEW_ARRAY(double, n);
    out->covariance = mem_array((size_t)n * (size_t)n, sizeof(double));
    out->undetermined = mem_array((size_t)n * (size_t)n, sizeof(double));
    for (int i = 0; i < n; i++) {
        out->x[i] = fmin(fmax(problem->start[i], problem->low[i]), problem->high[i]);
        out->errors[i] = NAN;
        for (int k = 0; k < n; k++)
            out->covariance[i * n + k] = NAN;
    }
    return out;
}

void fit_solution_free(FitSolution *solution)
{
    if (solution == NULL)
        return;
    MEM_FREE(solution->x, solution->z, solution->jacobian, solution->is_held, solution->errors,
             solution->covariance, solution->undetermined, solution);
}

static FitSearch search_new(const FitProblem *problem, FitSolution *at)
{
    const size_t n = (size_t)problem->unknowns, m = (size_t)problem->residuals;

    return (FitSearch){.problem = problem,
                       .at = at,
                       .x = mem_array(n, sizeof(double)),
                       .z = mem_array(m, sizeof(double)),
                       .gradient = mem_array(n, sizeof(double)),
                       .lengths = mem_array(n, sizeof(double)),
                       .step = mem_array(n, sizeof(double)),
                       .a = mem_array((m > n ? m : n) * n, sizeof(double)),
                       .s = mem_array(n, sizeof(double)),
                       .v = mem_array(n * n, sizeof(double)),
                       .right = mem_array(n, sizeof(double)),
                       .free = mem_array(n, sizeof(int))};
}

Status fit_solve(const FitProblem *problem, FitSolution **out, Diag *diag)
{
    FitSolution *at = solution_new(problem);
    FitSearch search = search_new(problem, at);
    bool has = false;
    Status status;

    *out = NULL;
    CHECK(evaluate(&search, at->x, at->z, &has, diag));
    if (!has) {
        status = diag_set(diag, E_SOLVER, "the model has no values at the start");
        goto done;
    }
    status = minimise_losses(&search, diag);
    for (int i = 0; i < at->residuals; i++)
        at->squares += at->z[i] * at->z[i];
    if (status == OK)
        fit_statistics(problem, at);
    *out = at;
    at = NULL;
done:
    MEM_FREE(search.x, search.z, search.gradient, search.lengths, search.step, search.a, search.s,
             search.v, search.right, search.free);
    fit_solution_free(at);
    return status;
}
