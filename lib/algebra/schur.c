/* schur.c: balancing, Hessenberg form, and the QR method with single complex shifts
 *
 * GSL and LAPACK have the same in doubles, which is where it is not enough (enclosure.h); only the
 * scales, powers of 2, need no more. */
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

void wide_reflect(Wide *at, int n, int stride, int from, const Wide *v, Wide beta)
{
    Wide along = wide_of(0);

    for (int i = from; i < n; i++)
        along = wide_add(along, wide_mul(v[i], at[(ptrdiff_t)i * stride]));
    along = wide_mul(along, beta);
    for (int i = from; i < n && along.high != 0; i++)
        at[(ptrdiff_t)i * stride] = wide_sub(at[(ptrdiff_t)i * stride], wide_mul(along, v[i]));
}

/* v and beta that turn column k below its diagonal into one entry; false: it is one already */
static bool reflection(const Wide *a, int n, int k, Wide *v, Wide *beta)
{
    Wide square = wide_of(0);
    double largest = 0;
    Wide head, norm;

    for (int i = k + 2; i < n; i++)
        largest = fmax(largest, fabs(a[i * n + k].high));
    if (largest == 0)
        return false;
    largest = fmax(largest, fabs(a[(k + 1) * n + k].high));
    for (int i = k + 1; i < n; i++) {
        v[i] = wide_times(a[i * n + k], ldexp(1, -ilogb(largest)));
        square = wide_add(square, wide_mul(v[i], v[i]));
    }
    norm = wide_sqrt(square);
    head = v[k + 1];
    v[k + 1] = head.high > 0 ? wide_add(head, norm) : wide_sub(head, norm);
    /* v^T v = 2 norm (norm + |head|) */
    *beta = wide_div(wide_of(1),
                     wide_mul(norm, head.high > 0 ? wide_add(norm, head) : wide_sub(norm, head)));
    return true;
}

void matrix_hessenberg(Wide *a, int n, Wide *q)
{
    Wide *v = NEW_ARRAY(Wide, n), beta;

    for (int i = 0; i < n * n && q != NULL; i++)
        q[i] = wide_of(i % (n + 1) == 0 ? 1 : 0);
    for (int k = 0; k + 2 < n; k++) {
        if (!reflection(a, n, k, v, &beta))
            continue;
        for (int j = k; j < n; j++)
            wide_reflect(a + j, n, n, k + 1, v, beta);
        for (int i = 0; i < n; i++)
            wide_reflect(a + (ptrdiff_t)i * n, n, 1, k + 1, v, beta);
        for (int i = 0; i < n && q != NULL; i++)
            wide_reflect(q + (ptrdiff_t)i * n, n, 1, k + 1, v, beta);
        for (int i = k + 2; i < n; i++)
            a[i * n + k] = wide_of(0);
    }
    mem_free(v);
}

/* --- the QR method --- */

/* [c s; -conj(s) c] (a, b) = (r, 0) */
typedef struct Givens {
    Wide c;
    WideComplex s;
} Givens;

static Wide square_of(WideComplex a)
{
    return wide_add(wide_mul(a.re, a.re), wide_mul(a.im, a.im));
}

static Givens turn_for(WideComplex a, WideComplex b)
{
    const double largest = fmax(wide_size(a), wide_size(b));
    Givens turn = {wide_of(1), wide_real(wide_of(0))};
    Wide size, root;

    if (wide_size(b) == 0)
        return turn;
    a = wide_ctimes(a, wide_of(ldexp(1, -ilogb(largest))));
    b = wide_ctimes(b, wide_of(ldexp(1, -ilogb(largest))));
    size = wide_sqrt(square_of(a));
    root = wide_sqrt(wide_add(square_of(a), square_of(b)));
    if (size.high == 0) {
        turn.c = wide_of(0);
        turn.s = wide_ctimes(wide_conj(b), wide_div(wide_of(1), root));
        return turn;
    }
    turn.c = wide_div(size, root);
    /* s = a/|a| conj(b)/r */
    turn.s = wide_ctimes(wide_cmul(a, wide_conj(b)), wide_div(wide_of(1), wide_mul(size, root)));
    return turn;
}

static void turn_rows(const Givens *turn, WideComplex *upper, WideComplex *lower, int from, int to)
{
    for (int j = from; j < to; j++) {
        const WideComplex x = upper[j], y = lower[j];

        upper[j] = wide_cadd(wide_ctimes(x, turn->c), wide_cmul(turn->s, y));
        lower[j] = wide_csub(wide_ctimes(y, turn->c), wide_cmul(wide_conj(turn->s), x));
    }
}

/* columns k and k + 1 by the conjugate transpose */
static void turn_columns(const Givens *turn, WideComplex *at, int n, int k, int rows)
{
    for (int i = 0; i < rows; i++) {
        WideComplex *left = at + (ptrdiff_t)i * n + k, *right = left + 1;
        const WideComplex x = *left, y = *right;

        *left = wide_cadd(wide_ctimes(x, turn->c), wide_cmul(y, wide_conj(turn->s)));
        *right = wide_csub(wide_ctimes(y, turn->c), wide_cmul(x, turn->s));
    }
}

/* the eigenvalue of the last 2 x 2 that is closer to its last entry (Wilkinson) */
static WideComplex shift_of(const WideComplex *t, int n, int last)
{
    const WideComplex a = t[(last - 1) * n + last - 1], d = t[last * n + last];
    const WideComplex bc = wide_cmul(t[(last - 1) * n + last], t[last * n + last - 1]);
    const WideComplex half = wide_ctimes(wide_csub(a, d), wide_of(0.5));
    const WideComplex root = wide_csqrt(wide_cadd(wide_cmul(half, half), bc));
    const WideComplex plus = wide_cadd(half, root), minus = wide_csub(half, root);
    const WideComplex larger = wide_size(plus) > wide_size(minus) ? plus : minus;

    /* d - bc/larger */
    return wide_size(larger) > 0 ? wide_csub(d, wide_cdiv(bc, larger)) : d;
}

static void sweep(WideComplex *t, int n, int first, int last, WideComplex shift, WideComplex *z,
                  Givens *turns)
{
    for (int i = first; i <= last; i++)
        t[i * n + i] = wide_csub(t[i * n + i], shift);
    for (int k = first; k < last; k++) {
        turns[k] = turn_for(t[k * n + k], t[(k + 1) * n + k]);
        turn_rows(&turns[k], t + (ptrdiff_t)k * n, t + (ptrdiff_t)(k + 1) * n, k, n);
        t[(k + 1) * n + k] = wide_real(wide_of(0));
    }
    for (int k = first; k < last; k++) {
        turn_columns(&turns[k], t, n, k, k + 2);
        if (z != NULL)
            turn_columns(&turns[k], z, n, k, n);
    }
    for (int i = first; i <= last; i++)
        t[i * n + i] = wide_cadd(t[i * n + i], shift);
}

/* where the part that ends at `last` begins: behind an entry that is rounding beside its
 * neighbours, which becomes 0 */
static int part_begin(WideComplex *t, int n, int last, double norm)
{
    int first = last;

    for (; first > 0; first--) {
        WideComplex *below = t + (ptrdiff_t)first * n + first - 1;
        double beside = wide_size(below[1]) + wide_size(t[(first - 1) * n + first - 1]);

        if (beside == 0)
            beside = norm;
        if (wide_size(*below) <= WIDE_UNIT * beside || wide_size(*below) < 1e-290) {
            *below = wide_real(wide_of(0));
            break;
        }
    }
    return first;
}

bool schur(const Wide *a, int n, WideComplex *t, WideComplex *z)
{
    Wide *h = NEW_ARRAY(Wide, n * n), *q = NEW_ARRAY(Wide, n * n);
    Givens *turns = NEW_ARRAY(Givens, n);
    double norm = 0;
    int sweeps = 0;

    memcpy(h, a, (size_t)(n * n) * sizeof *h);
    matrix_hessenberg(h, n, q);
    for (int i = 0; i < n * n; i++) {
        t[i] = wide_real(h[i]);
        norm = fmax(norm, fabs(h[i].high));
        if (z != NULL)
            z[i] = wide_real(q[i]);
    }
    for (int last = n - 1; last > 0 && sweeps < MOST_SWEEPS; sweeps++) {
        const int first = part_begin(t, n, last, norm);
        WideComplex shift;

        if (first == last) {
            last--;
            sweeps = -1;
            continue;
        }
        shift = shift_of(t, n, last);
        if (sweeps % 10 == 9) /* now and then another, against circling */
            shift = wide_cadd(shift, wide_ctimes(t[last * n + last - 1], wide_of(0.75)));
        sweep(t, n, first, last, shift, z, turns);
    }
    MEM_FREE(h, q, turns);
    return sweeps < MOST_SWEEPS;
}

/* --- vectors --- */

/* t_kk - t_ii, or what rounding would make of 0 */
static WideComplex apart(const WideComplex *t, int n, int k, int i, double least)
{
    const WideComplex between = wide_csub(t[k * n + k], t[i * n + i]);

    return wide_size(between) > least ? between : wide_real(wide_of(least));
}

/* column k of V, T V = V diag(T), with 1 on its diagonal */
static void vector_of(const WideComplex *t, int n, int k, double least, WideComplex *v)
{
    v[k * n + k] = wide_real(wide_of(1));
    for (int i = k - 1; i >= 0; i--) {
        WideComplex sum = wide_real(wide_of(0));

        for (int j = i + 1; j <= k; j++)
            sum = wide_cadd(sum, wide_cmul(t[i * n + j], v[j * n + k]));
        v[i * n + k] = wide_cdiv(sum, apart(t, n, k, i, least));
    }
}

/* column k of the inverse of V, which has ones on its diagonal */
static void inverse_of(const WideComplex *v, int n, int k, WideComplex *out)
{
    out[k * n + k] = wide_real(wide_of(1));
    for (int i = k - 1; i >= 0; i--) {
        WideComplex sum = wide_real(wide_of(0));

        for (int j = i + 1; j <= k; j++)
            sum = wide_csub(sum, wide_cmul(v[i * n + j], out[j * n + k]));
        out[i * n + k] = sum;
    }
}

void schur_vectors(const WideComplex *t, const WideComplex *z, int n, WideComplex *right,
                   WideComplex *left)
{
    WideComplex *v = NEW_ARRAY(WideComplex, n * n), *w = NEW_ARRAY(WideComplex, n * n);
    double norm = 0;

    for (int i = 0; i < n * n; i++)
        norm = fmax(norm, wide_size(t[i]));
    for (int k = 0; k < n; k++)
        vector_of(t, n, k, fmax(WIDE_UNIT * norm, 1e-290), v);
    for (int k = 0; k < n; k++)
        inverse_of(v, n, k, w);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            WideComplex x = wide_real(wide_of(0)), y = x;

            for (int j = 0; j <= k; j++)
                x = wide_cadd(x, wide_cmul(z[i * n + j], v[j * n + k]));
            for (int j = i; j < n; j++)
                y = wide_cadd(y, wide_cmul(w[i * n + j], wide_conj(z[k * n + j])));
            right[i * n + k] = x;
            left[i * n + k] = y;
        }
    MEM_FREE(v, w);
}
