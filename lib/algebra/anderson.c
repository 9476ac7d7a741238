/* anderson.c: Anderson's acceleration of a fixed-point iteration */
#include "algebra/anderson.h"

#include "algebra/algebra_limits.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { MOST_STEPS = 24 };

struct Anderson {
    int n, steps, count;               /* steps since the restart; differences stored */
    double *image, *residual, *scaled; /* F, g of the last step; g in sizes */
    double *images, *residuals;        /* differences of these, MOST_STEPS x n */
    double *basis, *triangle, *fitted; /* Q, R of the residuals' differences; R c = Q^T g */
};

Anderson *anderson_new(int n)
{
    Anderson *a = NEW(Anderson);

    a->n = n;
    a->image = NEW_ARRAY(double, n);
    a->residual = NEW_ARRAY(double, n);
    a->scaled = NEW_ARRAY(double, n);
    a->images = NEW_ARRAY(double, MOST_STEPS *n);
    a->residuals = NEW_ARRAY(double, MOST_STEPS *n);
    a->basis = NEW_ARRAY(double, MOST_STEPS *n);
    a->triangle = NEW_ARRAY(double, MOST_STEPS *MOST_STEPS);
    a->fitted = NEW_ARRAY(double, MOST_STEPS);
    return a;
}

void anderson_free(Anderson *a)
{
    if (a == NULL)
        return;
    MEM_FREE(a->image, a->residual, a->scaled, a->images, a->residuals, a->basis, a->triangle,
             a->fitted, a);
}

void anderson_restart(Anderson *a)
{
    a->steps = a->count = 0;
}

static double *row_of(double *rows, const Anderson *a, int k)
{
    return rows + (ptrdiff_t)k * a->n;
}

static double dot(const double *a, const double *b, int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static void remember(Anderson *a, const double *x, const double *image)
{
    double *images, *residuals;

    if (a->count == MOST_STEPS) {
        const size_t rest = (size_t)(MOST_STEPS - 1) * (size_t)a->n * sizeof(double);

        memmove(a->images, row_of(a->images, a, 1), rest);
        memmove(a->residuals, row_of(a->residuals, a, 1), rest);
        a->count--;
    }
    images = row_of(a->images, a, a->count);
    residuals = row_of(a->residuals, a, a->count);
    a->count += a->steps > 0;
    for (int i = 0; i < a->n; i++) {
        const double residual = image[i] - x[i];

        if (a->steps > 0) {
            images[i] = image[i] - a->image[i];
            residuals[i] = residual - a->residual[i];
        }
        a->image[i] = image[i];
        a->residual[i] = residual;
    }
    a->steps++;
}

/* Q R of the differences by modified Gram-Schmidt, newest first; how many are independent */
static int orthogonalise(Anderson *a, const double *size, int *picked)
{
    int rank = 0;

    for (int k = a->count - 1; k >= 0; k--) {
        double *q = row_of(a->basis, a, rank);
        double whole, left;

        for (int i = 0; i < a->n; i++)
            q[i] = row_of(a->residuals, a, k)[i] / size[i];
        whole = sqrt(dot(q, q, a->n));
        for (int j = 0; j < rank; j++) {
            const double *other = row_of(a->basis, a, j);
            const double part = dot(other, q, a->n);

            a->triangle[j * MOST_STEPS + rank] = part;
            for (int i = 0; i < a->n; i++)
                q[i] -= part * other[i];
        }
        left = sqrt(dot(q, q, a->n));
        if (!(left > ANDERSON_DEPENDENT * whole))
            continue;
        a->triangle[rank * MOST_STEPS + rank] = left;
        for (int i = 0; i < a->n; i++)
            q[i] /= left;
        picked[rank++] = k;
    }
    return rank;
}

void anderson_step(Anderson *a, double *x, const double *image, const double *size)
{
    int picked[MOST_STEPS];
    int rank;

    remember(a, x, image);
    rank = orthogonalise(a, size, picked);
    memcpy(x, image, (size_t)a->n * sizeof(double));
    for (int i = 0; i < a->n; i++)
        a->scaled[i] = a->residual[i] / size[i];
    for (int j = 0; j < rank; j++)
        a->fitted[j] = dot(row_of(a->basis, a, j), a->scaled, a->n);
    for (int j = rank - 1; j >= 0; j--) {
        const double *difference = row_of(a->images, a, picked[j]);

        for (int k = j + 1; k < rank; k++)
            a->fitted[j] -= a->triangle[j * MOST_STEPS + k] * a->fitted[k];
        a->fitted[j] /= a->triangle[j * MOST_STEPS + j];
        for (int i = 0; i < a->n; i++)
            x[i] -= a->fitted[j] * difference[i];
    }
}
