/* rank.c: rank decisions by pivoted QR
 *
 * Q R = phi^T P of the m x nu matrix phi by Householder reflections I - tau v v^T. Columns are
 * exchanged so that the one with the longest remainder is next. A constraint row moves few bodies,
 * so a reflection changes few entries, and most columns not at all: only entries other than 0 are
 * processed. GSL's pivoted QR processes all, takes twice as long for some dozen bodies (make bench:
 * algebra.rank_*), and can't be stopped. */
#include "algebra/rank.h"

#include "algebra/algebra_limits.h"
#include "algebra/independence.h"
#include "base/memory.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

typedef struct Pivoted {
    int rows, columns, least;
    double *entries;
    double **column; /* in the order of pivots: R on and above the diagonal, v (1 first) below it */
    double *tau;     /* least */
    int *order;      /* which column of the matrix */
    int *filled;     /* where the reflection at hand isn't 0 */
    int rank;
} Pivoted;

static Pivoted pivoted_new(int rows, int columns)
{
    const int least = rows < columns ? rows : columns;
    Pivoted p = {.rows = rows,
                 .columns = columns,
                 .least = least,
                 .entries = NEW_ARRAY(double, (ptrdiff_t)rows *columns),
                 .column = NEW_ARRAY(double *, columns),
                 .tau = NEW_ARRAY(double, least),
                 .order = NEW_ARRAY(int, columns),
                 .filled = NEW_ARRAY(int, rows)};

    for (int j = 0; j < columns; j++) {
        p.column[j] = p.entries + (ptrdiff_t)j * rows;
        p.order[j] = j;
    }
    return p;
}

static void release(Pivoted *p)
{
    MEM_FREE(p->entries, p->column, p->tau, p->order, p->filled);
}

static double square_of(const double *v, int from, int to)
{
    double sum = 0;

    for (int i = from; i < to; i++)
        sum += v[i] * v[i];
    return sum;
}

/* exchange the column with the longest remainder to place k */
static void exchange(Pivoted *p, int k, double *square, double *fresh)
{
    int best = k;

    for (int j = k + 1; j < p->columns; j++)
        if (square[j] > square[best])
            best = j;

    double *const column = p->column[k];
    const int order = p->order[k];

    p->column[k] = p->column[best];
    p->order[k] = p->order[best];
    p->column[best] = column;
    p->order[best] = order;
    square[best] = square[k];
    fresh[best] = fresh[k];
}

/* Column k becomes R's entry and the reflection that eliminates the entries below it; p->filled
 * becomes the reflection's count of entries. */
static int reflect(Pivoted *p, int k)
{
    double *const v = p->column[k];
    const double length = sqrt(square_of(v, k, p->rows));
    const double beta = v[k] > 0 ? -length : length;
    int count = 0;

    for (int i = k + 1; i < p->rows; i++)
        if (v[i] != 0)
            p->filled[count++] = i;
    if (count == 0) {
        p->tau[k] = 0;
        return 0;
    }
    p->tau[k] = (beta - v[k]) / beta;
    for (int i = 0; i < count; i++)
        v[p->filled[i]] /= v[k] - beta;
    v[k] = beta;
    return count;
}

/* x less its part along v_k, doubled */
static void apply(const Pivoted *p, int k, const int *filled, int count, double *x)
{
    const double *const v = p->column[k];
    double part = x[k];

    for (int i = 0; i < count; i++)
        part += v[filled[i]] * x[filled[i]];
    part *= p->tau[k];
    if (part == 0)
        return;
    x[k] -= part;
    for (int i = 0; i < count; i++)
        x[filled[i]] -= part * v[filled[i]];
}

/* E_STOPPED leaves the rest unchanged. O(rows columns least), less for entries that are 0. */
static Status factor(Pivoted *p, double threshold, const CallMonitor *watch)
{
    double *square = NEW_ARRAY(double, p->columns); /* of the remainder of each column, */
    double *fresh = NEW_ARRAY(double, p->columns);  /* and when it was last computed */
    Status status = OK;

    for (int j = 0; j < p->columns; j++)
        square[j] = fresh[j] = square_of(p->column[j], 0, p->rows);
    for (int k = 0; k < p->least; k++) {
        int count;

        CHECK(monitor_poll(watch));
        exchange(p, k, square, fresh);
        count = reflect(p, k);
        for (int j = k + 1; j < p->columns; j++) {
            double *const x = p->column[j];

            apply(p, k, p->filled, count, x);
            square[j] -= x[k] * x[k];
            if (square[j] <= RANK_STALE * fresh[j])
                square[j] = fresh[j] = square_of(x, k + 1, p->rows);
        }
    }
    while (p->rank < p->least &&
           fabs(p->column[p->rank][p->rank]) > threshold * fabs(p->column[0][0]))
        p->rank++;
done:
    MEM_FREE(square, fresh);
    return status;
}

static int rising(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

static double row_norm(const double *row, int n)
{
    double norm = 0;

    for (int j = 0; j < n; j++)
        if (row[j] != 0)
            norm = hypot(norm, row[j]);
    return norm;
}

/* rows of the matrix (NULL: all of them) as columns of unit size, or less where they are smaller
 * than `small` of the largest */
static Pivoted unit_rows(const double *matrix, int nu, const int *rows, int count, double small)
{
    Pivoted out = pivoted_new(nu, count);
    double *norm = NEW_ARRAY(double, count);
    double largest = 0;

    for (int k = 0; k < count; k++) {
        norm[k] = row_norm(matrix + (ptrdiff_t)(rows != NULL ? rows[k] : k) * nu, nu);
        largest = fmax(largest, norm[k]);
    }
    for (int k = 0; k < count; k++) {
        const double *row = matrix + (ptrdiff_t)(rows != NULL ? rows[k] : k) * nu;
        bool is_zero = !(norm[k] > 1e-10 * largest); /* rounding alone */

        for (int j = 0; j < nu && !is_zero; j++)
            out.column[k][j] = row[j] / fmax(norm[k], small * largest);
    }
    mem_free(norm);
    return out;
}

/* the first `count` in order of pivots, rising, then the others, rising */
static void put_order(const Pivoted *p, int m, int count, int *order)
{
    for (int k = 0; k < m; k++)
        order[k] = p->order[k];
    qsort(order, (size_t)count, sizeof(int), rising);
    qsort(order + count, (size_t)(m - count), sizeof(int), rising);
}

static void take_all(int m, int *order)
{
    for (int k = 0; k < m; k++)
        order[k] = k;
}

/* by pivots of the largest size */
static Status rank_written(const double *matrix, int m, int nu, double threshold,
                           const CallMonitor *watch, int *rank, int *order)
{
    Pivoted p = unit_rows(matrix, nu, NULL, m, 0);
    Status status = OK;

    *rank = 0;
    take_all(m, order);
    CHECK(factor(&p, threshold, watch));
    *rank = p.rank;
    put_order(&p, m, p.rank, order);
done:
    release(&p);
    return status;
}

Status rank_rows(const double *matrix, int m, int nu, double threshold, const CallMonitor *watch,
                 int *rank, int *order)
{
    *rank = 0;
    take_all(m, order);
    if (m == 0 || nu == 0)
        return OK;
    if (m < RANK_INDEPENDENCE_FIRST || !rows_are_independent(matrix, m, nu, threshold, watch))
        return rank_written(matrix, m, nu, threshold, watch, rank, order);
    *rank = m;
    return OK;
}

Status rank_columns(const Pattern *pattern, const double *values, double threshold,
                    const CallMonitor *watch, int *rank, int *order)
{
    const int m = pattern->columns;
    double *matrix;
    Status status;

    *rank = 0;
    take_all(m, order);
    if (m == 0 || pattern->rows == 0)
        return OK;
    if (m >= RANK_INDEPENDENCE_FIRST &&
        columns_are_independent(pattern, values, threshold, watch)) {
        *rank = m;
        return OK;
    }
    matrix = pattern_spread(pattern, values);
    status = rank_written(matrix, m, pattern->rows, threshold, watch, rank, order);
    mem_free(matrix);
    return status;
}

static double pivot_ratio(const Pivoted *p, int count)
{
    const double first = fabs(p->column[0][0]);
    const double last = fabs(p->column[count - 1][count - 1]);

    return first > 0 ? last / first : 0;
}

double rank_choose(const double *matrix, int m, int nu, int count, int *rows)
{
    int *order;
    double ratio;
    Pivoted p;

    if (count == 0)
        return 1;
    order = NEW_ARRAY(int, m);
    p = unit_rows(matrix, nu, NULL, m, RANK_LEAST_ROW);
    (void)factor(&p, 0, NULL);
    put_order(&p, m, count, order);
    for (int k = 0; k < count; k++)
        rows[k] = order[k];
    ratio = pivot_ratio(&p, count);
    release(&p);
    mem_free(order);
    return ratio;
}

double rank_ratio(const double *matrix, int nu, const int *rows, int count)
{
    double ratio;
    Pivoted p;

    if (count == 0)
        return 1;
    p = unit_rows(matrix, nu, rows, count, RANK_LEAST_ROW);
    (void)factor(&p, 0, NULL);
    ratio = pivot_ratio(&p, count);
    release(&p);
    return ratio;
}

/* the reflection of step k alone */
static void apply_alone(Pivoted *p, int k, double *x)
{
    int count = 0;

    for (int i = k + 1; i < p->rows; i++)
        if (p->column[k][i] != 0)
            p->filled[count++] = i;
    apply(p, k, p->filled, count, x);
}

void rank_least_multipliers(const double *phi_u, int m, int nu, double *lambda)
{
    Pivoted p;

    if (m == 0 || nu == 0)
        return;
    p = pivoted_new(m, nu);
    for (int k = 0; k < m; k++)
        for (int j = 0; j < nu; j++)
            p.column[j][k] = phi_u[k * nu + j];
    (void)factor(&p, RANK_THRESHOLD, NULL);
    for (int k = 0; k < p.least; k++)
        apply_alone(&p, k, lambda);
    for (int k = p.rank; k < m; k++)
        lambda[k] = 0;
    for (int k = p.least - 1; k >= 0; k--)
        apply_alone(&p, k, lambda);
    release(&p);
}
