/* verified_solve.c: Gaussian elimination on the diagonal blocks of a block triangular matrix
 *
 * Rows are matched to columns, the rest is permuted to block triangular form (Duff and Reid 1978).
 * With |B^-1| known the error of x is at most |B^-1| (|db| + |dB| |x|) (Higham 2002, 7.2), which
 * doesn't depend on how rows and columns are scaled. B within dB is regular where the spectral
 * radius of |B^-1| |dB| is below 1. Libraries eliminate in doubles and give no error bound for each
 * entry. */
#include "algebra/verified_solve.h"

#include "algebra/block_triangular.h"
#include "algebra/double_double.h"
#include "algebra/linear.h"
#include "algebra/perron.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

struct VerifiedSolve {
    int n;
    const double *matrix, *error;
    int *row, *column; /* of the permuted matrix: block triangular, lower */
    BlockTriangular blocks;
    DoubleDouble
        *factors; /* n x n, permuted; of diagonal blocks L, with ones, and U; rows exchanged */
    int *exchanged;
    double *inverse; /* n x n: sizes; rows as columns of the matrix, columns as its rows */
    bool is_regular;
};

/* --- factors --- */

static void permute(VerifiedSolve *s, const int *column)
{
    const int n = s->n;
    bool *pattern = NEW_ARRAY(bool, n *n);

    /* row r belongs to unknown column[r]; unknown j acts on i if the row of i contains j */
    for (int r = 0; r < n; r++)
        for (int j = 0; j < n; j++)
            pattern[column[r] * n + j] = s->matrix[r * n + j] != 0 || s->error[r * n + j] != 0;
    s->blocks = block_triangular_find(pattern, n);
    for (int k = 0; k < n; k++)
        s->column[k] = s->blocks.order[k];
    for (int k = 0; k < n; k++)
        for (int r = 0; r < n; r++)
            if (column[r] == s->column[k])
                s->row[k] = r;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            s->factors[i * n + j] = dd_of(s->matrix[s->row[i] * n + s->column[j]]);
    mem_free(pattern);
}

/* the row from k on whose entry is largest against the rest of its row */
static int pivot_row(const VerifiedSolve *s, int k, int end, const double *scale)
{
    int best = k;

    for (int i = k + 1; i < end; i++)
        if (fabs(s->factors[i * s->n + k].high) * scale[i] >
            fabs(s->factors[best * s->n + k].high) * scale[best])
            best = i;
    return best;
}

static void exchange(VerifiedSolve *s, int first, int end, int k, int p, double *scale)
{
    const double kept = scale[k];

    s->exchanged[k] = p;
    scale[k] = scale[p];
    scale[p] = kept;
    for (int j = first; j < end && p != k; j++) {
        const DoubleDouble entry = s->factors[k * s->n + j];

        s->factors[k * s->n + j] = s->factors[p * s->n + j];
        s->factors[p * s->n + j] = entry;
    }
}

static bool factor_block(VerifiedSolve *s, int first, int end)
{
    const int n = s->n;
    double *scale = NEW_ARRAY(double, n);
    bool sound = true;

    for (int i = first; i < end; i++) {
        for (int j = first; j < end; j++)
            scale[i] = fmax(scale[i], fabs(s->factors[i * n + j].high));
        scale[i] = scale[i] > 0 ? 1 / scale[i] : 1;
    }
    for (int k = first; k < end && sound; k++) {
        const DoubleDouble *top = s->factors + (ptrdiff_t)k * n;

        exchange(s, first, end, k, pivot_row(s, k, end, scale), scale);
        sound = top[k].high != 0 && isfinite(top[k].high);
        for (int i = k + 1; i < end && sound; i++) {
            DoubleDouble *row = s->factors + (ptrdiff_t)i * n;

            if (row[k].high == 0)
                continue;
            row[k] = dd_div(row[k], top[k]);
            for (int j = k + 1; j < end; j++)
                if (top[j].high != 0)
                    row[j] = dd_sub(row[j], dd_mul(row[k], top[j]));
        }
    }
    mem_free(scale);
    return sound;
}

/* x, permuted, becomes the solution; components before `from` are 0 */
static void solve_permuted(const VerifiedSolve *s, DoubleDouble *x, int from)
{
    const int n = s->n;

    for (int b = 0; b < s->blocks.count; b++) {
        const int first = s->blocks.start[b], end = s->blocks.start[b + 1];

        if (end <= from)
            continue;
        for (int i = first; i < end; i++)
            for (int j = from; j < first; j++)
                if (x[j].high != 0 && s->factors[i * n + j].high != 0)
                    x[i] = dd_sub(x[i], dd_mul(s->factors[i * n + j], x[j]));
        for (int k = first; k < end; k++) {
            const DoubleDouble kept = x[k];

            x[k] = x[s->exchanged[k]];
            x[s->exchanged[k]] = kept;
        }
        for (int i = first; i < end; i++)
            for (int j = first; j < i; j++)
                if (x[j].high != 0)
                    x[i] = dd_sub(x[i], dd_mul(s->factors[i * n + j], x[j]));
        for (int i = end - 1; i >= first; i--) {
            for (int j = i + 1; j < end; j++)
                if (x[j].high != 0)
                    x[i] = dd_sub(x[i], dd_mul(s->factors[i * n + j], x[j]));
            if (x[i].high != 0)
                x[i] = dd_div(x[i], s->factors[i * n + i]);
        }
    }
}

/* --- bounds --- */

static void invert(VerifiedSolve *s)
{
    const int n = s->n;
    DoubleDouble *x = NEW_ARRAY(DoubleDouble, n);

    for (int c = 0, b = 0; c < n; c++) {
        while (s->blocks.start[b + 1] <= c)
            b++;
        memset(x, 0, (size_t)n * sizeof *x);
        x[c] = dd_of(1);
        solve_permuted(s, x, s->blocks.start[b]);
        for (int i = 0; i < n; i++)
            s->inverse[s->column[i] * n + s->row[c]] = fabs(x[i].high);
    }
    mem_free(x);
}

/* |B^-1| |dB| v, dB including rounding errors of elimination */
static void apply_change(const void *context, const double *v, double *out)
{
    const VerifiedSolve *s = context;
    const int n = s->n;
    double *moved = NEW_ARRAY(double, n);

    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++)
            moved[k] +=
                (s->error[k * n + j] + n * DOUBLE_DOUBLE_ROUNDING * fabs(s->matrix[k * n + j])) *
                v[j];
    matrix_times(s->inverse, n, n, moved, out);
    mem_free(moved);
}

/* its spectral radius below 1 */
static bool is_still_regular(const VerifiedSolve *s)
{
    return perron_bound(apply_change, s, s->n) < 1; /* false for a NaN */
}

/* --- a system --- */

VerifiedSolve *verified_solve_new(const double *matrix, const double *error, int n)
{
    VerifiedSolve *s = NEW(VerifiedSolve);
    int *column = NEW_ARRAY(int, n);
    bool *pattern = NEW_ARRAY(bool, n *n);
    bool sound = true;

    s->n = n;
    s->matrix = matrix;
    s->error = error;
    s->row = NEW_ARRAY(int, n);
    s->column = NEW_ARRAY(int, n);
    s->exchanged = NEW_ARRAY(int, n);
    s->factors = NEW_ARRAY(DoubleDouble, n * n);
    s->inverse = NEW_ARRAY(double, n *n);
    for (int k = 0; k < n * n && sound; k++) {
        pattern[k] = matrix[k] != 0;
        sound = isfinite(matrix[k]) && isfinite(error[k]);
    }
    sound = sound && block_triangular_match(pattern, n, column);
    if (sound)
        permute(s, column);
    for (int b = 0; b < s->blocks.count && sound; b++)
        sound = factor_block(s, s->blocks.start[b], s->blocks.start[b + 1]);
    if (sound)
        invert(s);
    s->is_regular = sound && is_still_regular(s);
    MEM_FREE(column, pattern);
    return s;
}

void verified_solve_free(VerifiedSolve *square)
{
    if (square == NULL)
        return;
    block_triangular_free(&square->blocks);
    MEM_FREE(square->row, square->column, square->factors, square->exchanged, square->inverse,
             square);
}

bool verified_solve_is_regular(const VerifiedSolve *square)
{
    return square->is_regular;
}

void verified_solve_solution(const VerifiedSolve *s, const double *right, const double *right_error,
                             double *out, double *out_error)
{
    const int n = s->n;
    DoubleDouble *x = NEW_ARRAY(DoubleDouble, n);
    double *left = NEW_ARRAY(double, n); /* error bound of each equation */

    for (int i = 0; i < n; i++)
        x[i] = dd_of(right[s->row[i]]);
    solve_permuted(s, x, 0);
    for (int i = 0; i < n; i++)
        out[s->column[i]] = dd_double(x[i]);
    for (int i = 0; i < n && out_error != NULL; i++) {
        left[i] = (right_error != NULL ? right_error[i] : 0) +
                  n * DOUBLE_DOUBLE_ROUNDING * fabs(right[i]);
        for (int j = 0; j < n; j++)
            if (out[j] != 0)
                left[i] += (s->error[i * n + j] +
                            n * DOUBLE_DOUBLE_ROUNDING * fabs(s->matrix[i * n + j])) *
                           fabs(out[j]);
    }
    for (int i = 0; i < n && out_error != NULL; i++) {
        out_error[i] = 0x1p-53 * fabs(out[i]);
        for (int j = 0; j < n; j++)
            if (left[j] != 0)
                out_error[i] += s->inverse[i * n + j] * left[j];
    }
    MEM_FREE(x, left);
}
