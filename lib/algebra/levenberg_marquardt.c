/* levenberg_marquardt.c: Levenberg-Marquardt in the form for few equations and many unknowns
 *
 * GSL's and MINPACK's solvers need at least as many residuals as unknowns, and add the step to the
 * unknowns. A mechanism has more freedoms than conditions, a step rotates Euler parameters, and
 * some directions are fixed. */
#include "algebra/levenberg_marquardt.h"

#include "algebra/algebra_limits.h"
#include "algebra/gram.h"
#include "algebra/linear.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

typedef struct Least {
    const Rows *rows;
    const bool *held;
    Pattern full;             /* where the rows have no pattern */
    const Pattern *pattern;   /* of the Jacobian, a column each row */
    double *scale;            /* rows */
    double *residual, *trial; /* rows, scaled */
    double *jacobian;         /* by places, scaled */
    double *step, *weights;   /* columns; rows */
    double *v, *next;         /* length */
    Lu *lu;                   /* NULL: not needed yet */
} Least;

void rows_evaluate_full(const Rows *rows, const double *v, double *residual, double *jacobian)
{
    double *values;

    if (rows->pattern == NULL) {
        rows->evaluate(rows->context, v, residual, jacobian);
        return;
    }
    values = NEW_ARRAY(double, rows->pattern->count);
    rows->evaluate(rows->context, v, residual, values);
    pattern_fill(rows->pattern, values, jacobian);
    mem_free(values);
}

static void evaluate(Least *l, const double *v, double *residual, bool with_jacobian)
{
    const Pattern *p = l->pattern;

    l->rows->evaluate(l->rows->context, v, residual, with_jacobian ? l->jacobian : NULL);
    for (int k = 0; k < l->rows->rows; k++) {
        residual[k] *= l->scale[k];
        for (int i = p->start[k]; with_jacobian && i < p->start[k + 1]; i++)
            l->jacobian[i] *= l->held != NULL && l->held[p->row[i]] ? 0 : l->scale[k];
    }
}

static void choose_scale(Least *l)
{
    const Pattern *p = l->pattern;
    double largest = 0;

    for (int k = 0; k < l->rows->rows; k++)
        l->scale[k] = 1;
    evaluate(l, l->v, l->residual, true);
    for (int k = 0; k < l->rows->rows; k++) {
        double norm = 0;

        for (int i = p->start[k]; i < p->start[k + 1]; i++)
            norm = hypot(norm, l->jacobian[i]);
        l->scale[k] = norm;
        largest = fmax(largest, norm);
    }
    for (int k = 0; k < l->rows->rows; k++) {
        double norm = fmax(l->scale[k], 1e-3 * largest);

        l->scale[k] = norm > 0 ? 1 / norm : 1;
    }
}

static double norm_of(const double *v, int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += v[i] * v[i];
    return sqrt(sum);
}

/* term added to the diagonal of J J^T */
static double ridge(double damping, double largest)
{
    return damping + LEVENBERG_MARQUARDT_RIDGE * fmax(largest, 1e-30);
}

/* weights = (J J^T + damping 1)^-1 weights by sparse factors; false where rows are too close to
 * each other for pivots in the order of least filling */
static bool weigh_sparse(Least *l, double damping)
{
    Gram *gram = gram_of_columns(l->pattern, l->jacobian, NULL);
    const bool sound = gram_factor(gram, ridge(damping, gram_largest(gram)),
                                   LEVENBERG_MARQUARDT_SOUND_PIVOT, l->rows->watch);

    if (sound)
        gram_solve(gram, l->weights);
    gram_free(gram);
    return sound;
}

/* the same by dense ones */
static bool weigh(Least *l, double damping)
{
    int m = l->rows->rows;
    double *a, *jacobian = pattern_spread(l->pattern, l->jacobian);
    double largest = 0;

    if (l->lu == NULL)
        l->lu = lu_new(m);
    a = lu_matrix(l->lu);
    matrix_gram(jacobian, m, l->rows->columns, a);
    mem_free(jacobian);
    for (int i = 0; i < m; i++)
        for (int j = 0; j < i; j++)
            a[j * m + i] = a[i * m + j];
    for (int i = 0; i < m; i++)
        largest = fmax(largest, a[i * m + i]);
    for (int i = 0; i < m; i++)
        a[i * m + i] += ridge(damping, largest);
    if (!lu_factor_watched(l->lu, l->rows->watch))
        return false;
    lu_solve(l->lu, l->weights);
    return true;
}

/* l->step = -J^T (J J^T + damping 1)^-1 r; false when that can't be solved */
static bool find_step(Least *l, double damping)
{
    int m = l->rows->rows, n = l->rows->columns;

    memcpy(l->weights, l->residual, (size_t)m * sizeof(double));
    if (!(m >= LEVENBERG_MARQUARDT_SPARSE && weigh_sparse(l, damping)) && !weigh(l, damping))
        return false;
    memset(l->step, 0, (size_t)n * sizeof(double));
    for (int i = 0; i < m; i++)
        pattern_add(l->pattern, l->jacobian, i, -l->weights[i], l->step);
    return vector_is_finite(l->step, n);
}

static void take(Least *l)
{
    memcpy(l->next, l->v, (size_t)l->rows->length * sizeof(double));
    if (l->rows->move != NULL)
        l->rows->move(l->rows->context, l->next, l->step);
    else
        for (int j = 0; j < l->rows->columns; j++)
            l->next[j] += l->step[j];
    evaluate(l, l->next, l->trial, false);
}

/* the residual after the step predicted by the linear model */
static double promised(const Least *l)
{
    double sum = 0;

    for (int i = 0; i < l->rows->rows; i++) {
        const double left = l->residual[i] + pattern_dot(l->pattern, l->jacobian, i, l->step);

        sum += left * left;
    }
    return sqrt(sum);
}

/* Steps until the residual no longer decreases. Damping depends on the ratio of actual to predicted
 * decrease. */
static void descend(Least *l, double tolerance)
{
    int m = l->rows->rows;
    double mu = 1;

    for (int i = 0, polish = 0; i < LEVENBERG_MARQUARDT_ITERATIONS && polish < 3; i++) {
        double before, after, gain;

        evaluate(l, l->v, l->residual, true);
        before = norm_of(l->residual, m);
        if (before == 0 || monitor_poll(l->rows->watch) != OK || !find_step(l, mu * before))
            return;
        take(l);
        after = norm_of(l->trial, m);
        if (vector_largest(l->residual, m) < tolerance)
            polish++;
        if (!(after < before)) {
            if (polish > 0)
                return;
            mu = mu * 4 + 1e-6;
            if (mu > 1e12)
                return;
            continue;
        }
        memcpy(l->v, l->next, (size_t)l->rows->length * sizeof(double));
        gain = (before - after) / fmax(before - promised(l), 1e-300);
        mu *= gain > 0.75 ? 0.1 : gain > 0.25 ? 1 : 4;
        if (before - after < 1e-12 * before && polish == 0)
            return; /* a minimum that is no solution */
    }
}

bool levenberg_marquardt_solve(const Rows *rows, const bool *held, const double *scale,
                               double tolerance, double *v, double *residual)
{
    int m = rows->rows, n = rows->columns;
    Least l = {.rows = rows,
               .held = held,
               .scale = NEW_ARRAY(double, m),
               .residual = NEW_ARRAY(double, m),
               .trial = NEW_ARRAY(double, m),
               .step = NEW_ARRAY(double, n),
               .weights = NEW_ARRAY(double, m),
               .v = v,
               .next = NEW_ARRAY(double, rows->length)};
    bool solved;

    if (rows->pattern == NULL)
        l.full = pattern_full(n, m);
    l.pattern = rows->pattern != NULL ? rows->pattern : &l.full;
    l.jacobian = NEW_ARRAY(double, l.pattern->count);
    if (scale != NULL)
        memcpy(l.scale, scale, (size_t)m * sizeof(double));
    else
        choose_scale(&l);
    descend(&l, tolerance);
    evaluate(&l, v, l.residual, false);
    solved = vector_largest(l.residual, m) < tolerance;
    if (residual != NULL)
        rows->evaluate(rows->context, v, residual, NULL);
    MEM_FREE(l.scale, l.residual, l.trial, l.jacobian, l.step, l.weights, l.next);
    pattern_free(&l.full);
    lu_free(l.lu);
    return solved;
}
