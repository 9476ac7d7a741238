/* factors.c: sparse factors while they are well conditioned, full ones otherwise */
#include "simulate/equations/factors.h"

#include "algebra/linear.h"
#include "algebra/sparse.h"
#include "base/memory.h"
#include "simulate/equations/equations_limits.h"
#include "simulate/equations/rows.h"

#include <math.h>
#include <string.h>

struct Factors {
    int n;
    const int *start, *row;
    Sparse *sparse; /* NULL: full only */
    double *scaled; /* each value over the size of its row, then of its column */
    double *row_size, *column_size;
    double *full; /* row by row; NULL where it would be too large */
    bool is_full; /* how the last values were factored */
};

Factors *factors_new(int n, const int *start, const int *row, bool full)
{
    Factors *f = NEW(Factors);
    int *column;

    *f = (Factors){.n = n, .start = start, .row = row};
    if (full)
        f->full = NEW_ARRAY(double, (size_t)n *(size_t)n);
    if (full && n <= FACTORS_DENSE)
        return f;
    column = NEW_ARRAY(int, start[n]);
    for (int c = 0; c < n; c++)
        for (int k = start[c]; k < start[c + 1]; k++)
            column[k] = c;
    f->sparse = sparse_new(n, start[n], row, column);
    f->scaled = NEW_ARRAY(double, start[n]);
    f->row_size = NEW_ARRAY(double, n);
    f->column_size = NEW_ARRAY(double, n);
    mem_free(column);
    return f;
}

void factors_free(Factors *f)
{
    if (f == NULL)
        return;
    sparse_free(f->sparse);
    MEM_FREE(f->scaled, f->row_size, f->column_size, f->full, f);
}

static void scale(Factors *f, const double *values)
{
    memset(f->row_size, 0, (size_t)f->n * sizeof(double));
    for (int k = 0; k < f->start[f->n]; k++)
        f->row_size[f->row[k]] = fmax(f->row_size[f->row[k]], fabs(values[k]));
    for (int c = 0; c < f->n; c++) {
        double size = 0;

        for (int k = f->start[c]; k < f->start[c + 1]; k++) {
            f->scaled[k] = values[k] != 0 ? values[k] / f->row_size[f->row[k]] : 0;
            size = fmax(size, fabs(f->scaled[k]));
        }
        for (int k = f->start[c]; k < f->start[c + 1] && size > 0; k++)
            f->scaled[k] /= size;
        f->column_size[c] = size;
    }
}

static void fill(Factors *f, const double *values)
{
    memset(f->full, 0, (size_t)f->n * (size_t)f->n * sizeof(double));
    for (int c = 0; c < f->n; c++)
        for (int k = f->start[c]; k < f->start[c + 1]; k++)
            f->full[(ptrdiff_t)f->row[k] * f->n + c] = values[k];
}

bool factors_make(Factors *f, const double *values)
{
    if (!vector_is_finite(values, f->start[f->n]))
        return false;
    f->is_full = false;
    if (f->sparse != NULL) {
        scale(f, values);
        if (sparse_factor(f->sparse, f->scaled) &&
            (f->full == NULL || sparse_condition(f->sparse) > FACTORS_ILL_CONDITIONED))
            return true;
    }
    if (f->full == NULL)
        return false;
    f->is_full = true;
    fill(f, values);
    return true;
}

int factors_solve(Factors *f, const double *right, double *step)
{
    if (f->is_full)
        return rows_solve(f->full, f->n, f->n, right, step);
    for (int i = 0; i < f->n; i++)
        step[i] = right[i] / f->row_size[i];
    sparse_solve(f->sparse, step);
    for (int i = 0; i < f->n; i++)
        step[i] /= f->column_size[i];
    return vector_is_finite(step, f->n) ? f->n : -1;
}

int factors_singular(Factors *f, const double *values)
{
    if (f->sparse == NULL || !vector_is_finite(values, f->start[f->n]))
        return -1;
    scale(f, values);
    return sparse_factor(f->sparse, f->scaled) ? -1 : sparse_singular(f->sparse);
}

bool factors_may_be_full(const Factors *f)
{
    return f->full != NULL;
}
