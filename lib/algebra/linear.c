/* linear.c: LU with partial pivoting, and Cholesky factors, in place */
#include "algebra/linear.h"

#include "base/four.h"
#include "base/memory.h"

#include <gsl/gsl_cblas.h>
#include <math.h>
#include <string.h>

struct Lu {
    int n;
    double *a;      /* n x n: multipliers below, U on and above the diagonal */
    int *exchanged; /* row that step k brought up */
    int *filled; /* columns of the pivot row that aren't 0: systems of many bodies are mostly 0 */
    double ratio;
};

Lu *lu_new(int n)
{
    const bool was_scratch = mem_scratch(true); /* numbers that each factorisation finds anew */
    Lu *lu = NEW(Lu);

    lu->n = n;
    lu->a = NEW_ARRAY(double, n *n);
    lu->exchanged = NEW_ARRAY(int, n);
    lu->filled = NEW_ARRAY(int, n);
    (void)mem_scratch(was_scratch);
    return lu;
}

void lu_resize(Lu *lu, int n)
{
    lu->n = n;
}

void lu_free(Lu *lu)
{
    if (lu == NULL)
        return;
    MEM_FREE(lu->a, lu->exchanged, lu->filled, lu);
}

double *lu_matrix(Lu *lu)
{
    return lu->a;
}

double lu_pivot_ratio(const Lu *lu)
{
    return lu->ratio;
}

static int largest_below(const Lu *lu, int k)
{
    int best = k;

    for (int i = k + 1; i < lu->n; i++)
        if (fabs(lu->a[i * lu->n + k]) > fabs(lu->a[best * lu->n + k]))
            best = i;
    return best;
}

static void exchange(Lu *lu, int k, int p)
{
    double *a = lu->a + k * lu->n, *b = lu->a + p * lu->n;

    lu->exchanged[k] = p;
    for (int j = 0; j < lu->n && p != k; j++) {
        double kept = a[j];

        a[j] = b[j];
        b[j] = kept;
    }
}

/* rows below k less their share of row k */
static void eliminate(Lu *lu, int k)
{
    int n = lu->n, count = 0;
    const double *top = lu->a + k * n;

    for (int j = k + 1; j < n; j++)
        if (top[j] != 0)
            lu->filled[count++] = j;
    for (int i = k + 1; i < n; i++) {
        double *row = lu->a + i * n;
        double factor;

        if (row[k] == 0)
            continue;
        factor = row[k] / top[k];
        row[k] = factor;
        if (2 * count < n - k)
            for (int j = 0; j < count; j++)
                row[lu->filled[j]] -= factor * top[lu->filled[j]];
        else
            for (int j = k + 1; j < n; j++)
                row[j] -= factor * top[j];
    }
}

bool lu_factor(Lu *lu)
{
    return lu_factor_watched(lu, NULL);
}

bool lu_factor_watched(Lu *lu, const CallMonitor *watch)
{
    int n = lu->n;
    double least = INFINITY, largest = 0;

    lu->ratio = 0;
    for (int k = 0; k < n; k++) {
        double pivot;

        if (monitor_poll(watch) != OK)
            return false;
        exchange(lu, k, largest_below(lu, k));
        pivot = fabs(lu->a[k * n + k]);
        if (!(pivot > 0) || !isfinite(pivot))
            return false;
        least = fmin(least, pivot);
        largest = fmax(largest, pivot);
        eliminate(lu, k);
    }
    lu->ratio = n > 0 ? least / largest : 1;
    return true;
}

void lu_solve(const Lu *lu, double *b)
{
    int n = lu->n;

    for (int k = 0; k < n; k++) {
        int p = lu->exchanged[k];
        double kept = b[p];

        b[p] = b[k];
        b[k] = kept;
    }
    for (int i = 1; i < n; i++) {
        const double *row = lu->a + i * n;
        double sum = b[i];

        for (int j = 0; j < i; j++)
            sum -= row[j] * b[j];
        b[i] = sum;
    }
    for (int i = n - 1; i >= 0; i--) {
        const double *row = lu->a + i * n;
        double sum = b[i];

        for (int j = i + 1; j < n; j++)
            sum -= row[j] * b[j];
        b[i] = sum / row[i];
    }
}

double cholesky_factor(double *l, int n)
{
    double least = INFINITY;

    for (int i = 0; i < n; i++) {
        double *row = l + i * n;
        int first = 0;

        while (first < i && row[first] == 0)
            first++;
        for (int j = first; j <= i; j++) {
            const double *other = l + j * n;
            double sum = row[j];

            for (int k = first; k < j; k++)
                sum -= row[k] * other[k];
            if (i == j)
                least = fmin(least, sum);
            if (i == j && !(sum > 0))
                return sum;
            row[j] = i == j ? sqrt(sum) : sum / other[j];
        }
    }
    return least;
}

void cholesky_forward(const double *l, int n, double *b)
{
    int first = 0;

    while (first < n && b[first] == 0)
        first++;
    for (int i = first; i < n; i++) {
        double sum = b[i];

        for (int j = first; j < i; j++)
            sum -= l[i * n + j] * b[j];
        b[i] = sum / l[i * n + i];
    }
}

void cholesky_backward(const double *l, int n, double *b)
{
    for (int i = n - 1; i >= 0; i--) {
        b[i] /= l[i * n + i];
        for (int j = 0; j < i; j++)
            b[j] -= l[i * n + j] * b[i];
    }
}

void matrix_times(const double *matrix, int rows, int columns, const double *v, double *out)
{
    for (int i = 0; i < rows; i++) {
        double sum = 0;

        for (int j = 0; j < columns; j++)
            sum += matrix[i * columns + j] * v[j];
        out[i] = sum;
    }
}

void matrices_times(const double *a, const double *b, int n, double *out)
{
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, n, n, 1, a, n, b, n, 0, out, n);
}

void matrix_gram(const double *matrix, int rows, int columns, double *out)
{
    int *place = NEW_ARRAY(int, columns);

    for (int i = 0; i < rows; i++) {
        const double *row = matrix + (ptrdiff_t)i * columns;
        int count = 0;

        for (int k = 0; k < columns; k++)
            if (row[k] != 0)
                place[count++] = k;
        for (int j = 0; j <= i; j++) {
            const double *other = matrix + (ptrdiff_t)j * columns;
            double sum = 0;

            for (int k = 0; k < count; k++)
                sum += row[place[k]] * other[place[k]];
            out[(ptrdiff_t)i * rows + j] = sum;
        }
    }
    mem_free(place);
}

double vector_largest(const double *v, int n)
{
    double largest = 0;

    for (int i = 0; i < n; i++)
        if (!(fabs(v[i]) <= largest))
            largest = fabs(v[i]);
    return largest;
}

AS_WIDE_AS_CAN_BE static bool are_many_finite(const double *v, int n)
{
    Four none = {0}, other = {0}; /* NAN once there is one that isn't */
    double rest = 0;
    int i = 0;

    for (; i + 8 <= n; i += 8) {
        none += *(const Four *)(v + i) * 0;
        other += *(const Four *)(v + i + 4) * 0;
    }
    for (; i < n; i++)
        rest += v[i] * 0;
    none += other;
    return none[0] + none[1] + none[2] + none[3] + rest == 0;
}

bool vector_is_finite(const double *v, int n)
{
    double none = 0;

    if (n >= 8)
        return are_many_finite(v, n);
    for (int i = 0; i < n; i++)
        none += v[i] * 0;
    return none == 0;
}
