/* linear.c: LU with partial pivoting, in place */
#include "simulate/linear.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

struct Lu {
    int n;
    double *a;      /* n x n: multipliers below, U on and above the diagonal */
    int *exchanged; /* row that step k brought up */
    double ratio;
};

Lu *lu_new(int n)
{
    Lu *lu = NEW(Lu);

    lu->n = n;
    lu->a = NEW_ARRAY(double, n *n);
    lu->exchanged = NEW_ARRAY(int, n);
    return lu;
}

void lu_free(Lu *lu)
{
    if (lu == NULL)
        return;
    mem_free(lu->a);
    mem_free(lu->exchanged);
    mem_free(lu);
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

bool lu_factor(Lu *lu)
{
    int n = lu->n;
    double least = INFINITY, largest = 0;

    lu->ratio = 0;
    for (int k = 0; k < n; k++) {
        int p = largest_below(lu, k);
        double *top = lu->a + k * n;

        lu->exchanged[k] = p;
        if (p != k)
            for (int j = 0; j < n; j++) {
                double kept = top[j];

                top[j] = lu->a[p * n + j];
                lu->a[p * n + j] = kept;
            }
        if (!(fabs(top[k]) > 0) || !isfinite(top[k]))
            return false;
        least = fmin(least, fabs(top[k]));
        largest = fmax(largest, fabs(top[k]));
        for (int i = k + 1; i < n; i++) {
            double *row = lu->a + i * n;
            double factor = row[k] / top[k];

            row[k] = factor;
            if (factor != 0)
                for (int j = k + 1; j < n; j++)
                    row[j] -= factor * top[j];
        }
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

void matrix_times(const double *matrix, int rows, int columns, const double *v, double *out)
{
    for (int i = 0; i < rows; i++) {
        double sum = 0;

        for (int j = 0; j < columns; j++)
            sum += matrix[i * columns + j] * v[j];
        out[i] = sum;
    }
}

double vector_largest(const double *v, int n)
{
    double largest = 0;

    for (int i = 0; i < n; i++)
        if (!(fabs(v[i]) <= largest))
            largest = fabs(v[i]);
    return largest;
}

bool vector_is_finite(const double *v, int n)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(v[i]))
            return false;
    return true;
}
