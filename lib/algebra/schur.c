/* schur.c: balancing, Hessenberg form, and the QR method with single complex shifts
 *
 * GSL and LAPACK have the same in doubles, which don't suffice here (enclosure.h). Only the scales,
 * powers of 2, are doubles. */
#include "algebra/schur.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <gsl/gsl_linalg.h>
#include <string.h>

enum { MOST_SWEEPS = 60 }; /* for one eigenvalue */

/* --- balancing --- */

void matrix_balance(const double *size, int n, double *scale)
{
    gsl_matrix *matrix;
    gsl_vector *by;

    if (n == 0)
        return;
    matrix = dense_matrix((size_t)n, (size_t)n);
    by = dense_vector((size_t)n);
    memcpy(matrix->data, size, (size_t)n * (size_t)n * sizeof(double));
    (void)gsl_linalg_balance_matrix(matrix, by);
    for (int i = 0; i < n; i++)
        scale[i] = 1 / by->data[i];
    MEM_FREE(matrix, by);
}

/* --- Hessenberg form --- */

void dd_reflect(DoubleDouble *at, int n, int stride, int from, const DoubleDouble *v,
                DoubleDouble beta)
{
    DoubleDouble along = dd_of(0);

    for (int i = from; i < n; i++)
        along = dd_add(along, dd_mul(v[i], at[(ptrdiff_t)i * stride]));
    along = dd_mul(along, beta);
    for (int i = from; i < n && along.high != 0; i++)
        at[(ptrdiff_t)i * stride] = dd_sub(at[(ptrdiff_t)i * stride], dd_mul(along, v[i]));
}

/* v and beta that turn column k below its diagonal into one entry; false: it is one already */
static bool reflection(const DoubleDouble *a, int n, int k, DoubleDouble *v, DoubleDouble *beta)
{
    DoubleDouble square = dd_of(0);
    double largest = 0;
    DoubleDouble head, norm;

    for (int i = k + 2; i < n; i++)
        largest = fmax(largest, fabs(a[i * n + k].high));
    if (largest == 0)
        return false;
    largest = fmax(largest, fabs(a[(k + 1) * n + k].high));
    for (int i = k + 1; i < n; i++) {
        v[i] = dd_times(a[i * n + k], ldexp(1, -ilogb(largest)));
        square = dd_add(square, dd_mul(v[i], v[i]));
    }
    norm = dd_sqrt(square);
    head = v[k + 1];
    v[k + 1] = head.high > 0 ? dd_add(head, norm) : dd_sub(head, norm);
    /* v^T v = 2 norm (norm + |head|) */
    *beta = dd_div(dd_of(1), dd_mul(norm, head.high > 0 ? dd_add(norm, head) : dd_sub(norm, head)));
    return true;
}

void matrix_hessenberg(DoubleDouble *a, int n, DoubleDouble *q)
{
    DoubleDouble *v = NEW_ARRAY(DoubleDouble, n), beta;

    for (int i = 0; i < n * n && q != NULL; i++)
        q[i] = dd_of(i % (n + 1) == 0 ? 1 : 0);
    for (int k = 0; k + 2 < n; k++) {
        if (!reflection(a, n, k, v, &beta))
            continue;
        for (int j = k; j < n; j++)
            dd_reflect(a + j, n, n, k + 1, v, beta);
        for (int i = 0; i < n; i++)
            dd_reflect(a + (ptrdiff_t)i * n, n, 1, k + 1, v, beta);
        for (int i = 0; i < n && q != NULL; i++)
            dd_reflect(q + (ptrdiff_t)i * n, n, 1, k + 1, v, beta);
        for (int i = k + 2; i < n; i++)
            a[i * n + k] = dd_of(0);
    }
    mem_free(v);
}

/* --- the QR method --- */

/* [c s; -conj(s) c] (a, b) = (r, 0) */
typedef struct Givens {
    DoubleDouble c;
    DoubleDoubleComplex s;
} Givens;

static DoubleDouble square_of(DoubleDoubleComplex a)
{
    return dd_add(dd_mul(a.re, a.re), dd_mul(a.im, a.im));
}

static Givens turn_for(DoubleDoubleComplex a, DoubleDoubleComplex b)
{
    const double largest = fmax(dd_size(a), dd_size(b));
    Givens turn = {dd_of(1), dd_real(dd_of(0))};
    DoubleDouble size, root;

    if (dd_size(b) == 0)
        return turn;
    a = dd_ctimes(a, dd_of(ldexp(1, -ilogb(largest))));
    b = dd_ctimes(b, dd_of(ldexp(1, -ilogb(largest))));
    size = dd_sqrt(square_of(a));
    root = dd_sqrt(dd_add(square_of(a), square_of(b)));
    if (size.high == 0) {
        turn.c = dd_of(0);
        turn.s = dd_ctimes(dd_conj(b), dd_div(dd_of(1), root));
        return turn;
    }
    turn.c = dd_div(size, root);
    /* s = a/|a| conj(b)/r */
    turn.s = dd_ctimes(dd_cmul(a, dd_conj(b)), dd_div(dd_of(1), dd_mul(size, root)));
    return turn;
}

static void turn_rows(const Givens *turn, DoubleDoubleComplex *upper, DoubleDoubleComplex *lower,
                      int from, int to)
{
    for (int j = from; j < to; j++) {
        const DoubleDoubleComplex x = upper[j], y = lower[j];

        upper[j] = dd_cadd(dd_ctimes(x, turn->c), dd_cmul(turn->s, y));
        lower[j] = dd_csub(dd_ctimes(y, turn->c), dd_cmul(dd_conj(turn->s), x));
    }
}

/* columns k and k + 1 by the conjugate transpose */
static void turn_columns(const Givens *turn, DoubleDoubleComplex *at, int n, int k, int rows)
{
    for (int i = 0; i < rows; i++) {
        DoubleDoubleComplex *left = at + (ptrdiff_t)i * n + k, *right = left + 1;
        const DoubleDoubleComplex x = *left, y = *right;

        *left = dd_cadd(dd_ctimes(x, turn->c), dd_cmul(y, dd_conj(turn->s)));
        *right = dd_csub(dd_ctimes(y, turn->c), dd_cmul(x, turn->s));
    }
}

/* the eigenvalue of the last 2 x 2 that is closer to its last entry (Wilkinson) */
static DoubleDoubleComplex shift_of(const DoubleDoubleComplex *t, int n, int last)
{
    const DoubleDoubleComplex a = t[(last - 1) * n + last - 1], d = t[last * n + last];
    const DoubleDoubleComplex bc = dd_cmul(t[(last - 1) * n + last], t[last * n + last - 1]);
    const DoubleDoubleComplex half = dd_ctimes(dd_csub(a, d), dd_of(0.5));
    const DoubleDoubleComplex root = dd_csqrt(dd_cadd(dd_cmul(half, half), bc));
    const DoubleDoubleComplex plus = dd_cadd(half, root), minus = dd_csub(half, root);
    const DoubleDoubleComplex larger = dd_size(plus) > dd_size(minus) ? plus : minus;

    /* d - bc/larger */
    return dd_size(larger) > 0 ? dd_csub(d, dd_cdiv(bc, larger)) : d;
}

static void sweep(DoubleDoubleComplex *t, int n, int first, int last, DoubleDoubleComplex shift,
                  DoubleDoubleComplex *z, Givens *turns)
{
    for (int i = first; i <= last; i++)
        t[i * n + i] = dd_csub(t[i * n + i], shift);
    for (int k = first; k < last; k++) {
        turns[k] = turn_for(t[k * n + k], t[(k + 1) * n + k]);
        turn_rows(&turns[k], t + (ptrdiff_t)k * n, t + (ptrdiff_t)(k + 1) * n, k, n);
        t[(k + 1) * n + k] = dd_real(dd_of(0));
    }
    for (int k = first; k < last; k++) {
        turn_columns(&turns[k], t, n, k, k + 2);
        if (z != NULL)
            turn_columns(&turns[k], z, n, k, n);
    }
    for (int i = first; i <= last; i++)
        t[i * n + i] = dd_cadd(t[i * n + i], shift);
}

/* the first row of the part that ends at `last`: after a subdiagonal entry that is negligible
 * against its neighbours, which becomes 0 */
static int part_begin(DoubleDoubleComplex *t, int n, int last, double norm)
{
    int first = last;

    for (; first > 0; first--) {
        DoubleDoubleComplex *below = t + (ptrdiff_t)first * n + first - 1;
        double neighbours = dd_size(below[1]) + dd_size(t[(first - 1) * n + first - 1]);

        if (neighbours == 0)
            neighbours = norm;
        if (dd_size(*below) <= DOUBLE_DOUBLE_ROUNDING * neighbours || dd_size(*below) < 1e-290) {
            *below = dd_real(dd_of(0));
            break;
        }
    }
    return first;
}

bool schur(const DoubleDouble *a, int n, DoubleDoubleComplex *t, DoubleDoubleComplex *z)
{
    DoubleDouble *h = NEW_ARRAY(DoubleDouble, n * n), *q = NEW_ARRAY(DoubleDouble, n * n);
    Givens *turns = NEW_ARRAY(Givens, n);
    double norm = 0;
    int sweeps = 0;

    memcpy(h, a, (size_t)(n * n) * sizeof *h);
    matrix_hessenberg(h, n, q);
    for (int i = 0; i < n * n; i++) {
        t[i] = dd_real(h[i]);
        norm = fmax(norm, fabs(h[i].high));
        if (z != NULL)
            z[i] = dd_real(q[i]);
    }
    for (int last = n - 1; last > 0 && sweeps < MOST_SWEEPS; sweeps++) {
        const int first = part_begin(t, n, last, norm);
        DoubleDoubleComplex shift;

        if (first == last) {
            last--;
            sweeps = -1;
            continue;
        }
        shift = shift_of(t, n, last);
        if (sweeps % 10 == 9) /* now and then another, against circling */
            shift = dd_cadd(shift, dd_ctimes(t[last * n + last - 1], dd_of(0.75)));
        sweep(t, n, first, last, shift, z, turns);
    }
    MEM_FREE(h, q, turns);
    return sweeps < MOST_SWEEPS;
}

/* --- vectors --- */

/* t_kk - t_ii, or the size of its rounding where that is larger */
static DoubleDoubleComplex apart(const DoubleDoubleComplex *t, int n, int k, int i, double least)
{
    const DoubleDoubleComplex between = dd_csub(t[k * n + k], t[i * n + i]);

    return dd_size(between) > least ? between : dd_real(dd_of(least));
}

/* column k of V, T V = V diag(T), with 1 on its diagonal */
static void vector_of(const DoubleDoubleComplex *t, int n, int k, double least,
                      DoubleDoubleComplex *v)
{
    v[k * n + k] = dd_real(dd_of(1));
    for (int i = k - 1; i >= 0; i--) {
        DoubleDoubleComplex sum = dd_real(dd_of(0));

        for (int j = i + 1; j <= k; j++)
            sum = dd_cadd(sum, dd_cmul(t[i * n + j], v[j * n + k]));
        v[i * n + k] = dd_cdiv(sum, apart(t, n, k, i, least));
    }
}

/* column k of the inverse of V, which has ones on its diagonal */
static void inverse_of(const DoubleDoubleComplex *v, int n, int k, DoubleDoubleComplex *out)
{
    out[k * n + k] = dd_real(dd_of(1));
    for (int i = k - 1; i >= 0; i--) {
        DoubleDoubleComplex sum = dd_real(dd_of(0));

        for (int j = i + 1; j <= k; j++)
            sum = dd_csub(sum, dd_cmul(v[i * n + j], out[j * n + k]));
        out[i * n + k] = sum;
    }
}

void schur_vectors(const DoubleDoubleComplex *t, const DoubleDoubleComplex *z, int n,
                   DoubleDoubleComplex *right, DoubleDoubleComplex *left)
{
    DoubleDoubleComplex *v = NEW_ARRAY(DoubleDoubleComplex, n * n),
                        *w = NEW_ARRAY(DoubleDoubleComplex, n * n);
    double norm = 0;

    for (int i = 0; i < n * n; i++)
        norm = fmax(norm, dd_size(t[i]));
    for (int k = 0; k < n; k++)
        vector_of(t, n, k, fmax(DOUBLE_DOUBLE_ROUNDING * norm, 1e-290), v);
    for (int k = 0; k < n; k++)
        inverse_of(v, n, k, w);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            DoubleDoubleComplex x = dd_real(dd_of(0)), y = x;

            for (int j = 0; j <= k; j++)
                x = dd_cadd(x, dd_cmul(z[i * n + j], v[j * n + k]));
            for (int j = i; j < n; j++)
                y = dd_cadd(y, dd_cmul(w[i * n + j], dd_conj(z[k * n + j])));
            right[i * n + k] = x;
            left[i * n + k] = y;
        }
    MEM_FREE(v, w);
}
