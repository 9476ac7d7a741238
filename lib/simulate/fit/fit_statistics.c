/* fit_statistics.c: standard errors, and what residuals leave open
 *
 * The columns of J are scaled to length 1. Singular values below a share of the largest are those
 * of difference quotients alone: along their vectors no residual changes. */
#include "simulate/fit/fit_solve.h"

#include "base/memory.h"

#include <gsl/gsl_linalg.h>
#include <math.h>

/* of the largest singular value; difference quotients err by less */
static const double rank_threshold = 2e-5;
/* the share of a vector from which an unknown takes part in it */
static const double least_share = 1e-3;

/* the least size of an unknown that tends to 0, relative to its start */
static const double least_size = 0.01;

typedef struct Statistics {
    const FitProblem *problem;
    FitSolution *solution;
    int *columns, count; /* unknowns that are free and change residuals */
    double *lengths;     /* of their columns */
    double *a, *s, *v;
} Statistics;

double fit_size(const FitProblem *problem, const double *x, int i)
{
    const double span = problem->high[i] - problem->low[i];
    const double typical = problem->start[i] != 0 ? fabs(problem->start[i])
                           : isfinite(span)       ? 0.1 * span
                                                  : 1;

    return fmax(fabs(x[i]), least_size * typical);
}

void fit_singular_values(double *a, int rows, int columns, double *s, double *v)
{
    gsl_matrix_view u =
        gsl_matrix_view_array(a, (size_t)(rows > columns ? rows : columns), (size_t)columns);
    gsl_matrix_view q = gsl_matrix_view_array(v, (size_t)columns, (size_t)columns);
    gsl_vector_view values = gsl_vector_view_array(s, (size_t)columns);

    (void)gsl_linalg_SV_decomp_jacobi(&u.matrix, &q.matrix, &values.vector);
}

/* s^2 of squares; Huber's factor for other losses */
static double variance(const FitProblem *problem, const FitSolution *solution, int free)
{
    const int m = solution->residuals;
    double squares = 0, slope = 0;

    if (m <= free)
        return NAN;
    for (int i = 0; i < m; i++) {
        const double z = solution->z[i];
        const double u = solution->scale > 0 ? pow(z / solution->scale, 2) : 0;
        const double weight = loss_slope(problem->loss, u);

        squares += z * weight * z * weight;
        slope += (weight + 2 * u * loss_curvature(problem->loss, u)) / m;
    }
    return squares / (m - free) / (slope * slope);
}

static void add_undetermined(Statistics *st, int vector)
{
    FitSolution *solution = st->solution;
    const int n = solution->unknowns;
    double *row = solution->undetermined + (ptrdiff_t)solution->undetermined_count++ * n;
    double most = 0;

    for (int k = 0; k < st->count; k++) {
        const double share = st->v[(ptrdiff_t)k * st->count + vector];
        const int i = st->columns[k];

        if (fabs(share) > least_share)
            row[i] = share / st->lengths[k] / fit_size(st->problem, solution->x, i);
        most = fabs(row[i]) > fabs(most) ? row[i] : most;
    }
    for (int i = 0; i < n; i++)
        row[i] /= most;
}

/* Unknowns that are free: those with a column of 0 have no influence at all. */
static int choose_columns(Statistics *st)
{
    FitSolution *solution = st->solution;
    const int n = solution->unknowns, m = solution->residuals;
    int free = 0;

    for (int i = 0; i < n; i++) {
        double squares = 0;

        if (solution->is_held[i])
            continue;
        free++;
        for (int r = 0; r < m; r++)
            squares += pow(solution->jacobian[(ptrdiff_t)r * n + i], 2);
        if (sqrt(squares) * fit_size(st->problem, solution->x, i) <= st->problem->noise * sqrt(m)) {
            solution->undetermined[(ptrdiff_t)solution->undetermined_count++ * n + i] = 1;
            continue;
        }
        st->lengths[st->count] = sqrt(squares);
        st->columns[st->count++] = i;
    }
    return free;
}

static void decompose(Statistics *st)
{
    const int m = st->solution->residuals, n = st->solution->unknowns;

    for (int r = 0; r < m; r++)
        for (int k = 0; k < st->count; k++)
            st->a[(ptrdiff_t)r * st->count + k] =
                st->solution->jacobian[(ptrdiff_t)r * n + st->columns[k]] / st->lengths[k];
    fit_singular_values(st->a, m, st->count, st->s, st->v);
}

static bool is_determined(const Statistics *st, int k, int rank)
{
    for (int i = rank; i < st->count; i++)
        if (fabs(st->v[(ptrdiff_t)k * st->count + i]) > least_share)
            return false;
    return true;
}

static void fill_covariance(Statistics *st, int rank, double factor)
{
    FitSolution *solution = st->solution;
    const int n = solution->unknowns;

    for (int k = 0; k < st->count; k++)
        for (int l = 0; l < st->count; l++) {
            double sum = 0;

            if (!is_determined(st, k, rank) || !is_determined(st, l, rank))
                continue;
            for (int i = 0; i < rank; i++)
                sum += st->v[(ptrdiff_t)k * st->count + i] * st->v[(ptrdiff_t)l * st->count + i] /
                       (st->s[i] * st->s[i]);
            solution->covariance[st->columns[k] * n + st->columns[l]] =
                factor * sum / (st->lengths[k] * st->lengths[l]);
        }
    for (int i = 0; i < n; i++)
        solution->errors[i] = sqrt(solution->covariance[i * n + i]);
}

void fit_statistics(const FitProblem *problem, FitSolution *solution)
{
    const size_t n = (size_t)solution->unknowns, m = (size_t)solution->residuals;
    Statistics st = {.problem = problem,
                     .solution = solution,
                     .columns = mem_array(n, sizeof(int)),
                     .lengths = mem_array(n, sizeof(double)),
                     .a = mem_array((m > n ? m : n) * n, sizeof(double)),
                     .s = mem_array(n, sizeof(double)),
                     .v = mem_array(n * n, sizeof(double))};
    const int free = choose_columns(&st);
    int rank = 0;

    if (st.count > 0) {
        decompose(&st);
        while (rank < st.count && rank < solution->residuals &&
               st.s[rank] > rank_threshold * st.s[0])
            rank++;
        for (int i = rank; i < st.count; i++)
            add_undetermined(&st, i);
        fill_covariance(&st, rank, variance(problem, solution, free));
    }
    MEM_FREE(st.columns, st.lengths, st.a, st.s, st.v);
}
