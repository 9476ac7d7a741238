/* hessenberg_form.c: (s - A)^-1 b by a Hessenberg form
 *
 * Own code: GSL has no elimination of s - H in O(n^2) for each s, which is the purpose of the form.
 * GSL's reflections run along columns, which takes three times as long (make bench:
 * algebra.hessenberg_*). */
#include "algebra/hessenberg_form.h"

#include "algebra/dense.h"
#include "base/four.h"
#include "base/memory.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

struct HessenbergForm {
    int n;
    gsl_matrix *h; /* 0 below the diagonal under the main one */
    gsl_vector *d; /* D */
    double *q;     /* n x n: Q = P_0 P_1 ..., P_k = 1 - share v v^T */
};

struct ShiftedFactors {
    int n;
    double *re, *im;               /* n x n: U, on and above the diagonal */
    double *factor_re, *factor_im; /* by which row k went off the next one, */
    bool *exchanged;               /* which it changed places with before */
    double *b, *c;
};

/* --- rows --- */

#define FOUR(row)     (*(Four *)(row))
#define FOUR_OF(row)  (*(const Four *)(row))
#define SUM_OF(four)  (((four)[0] + (four)[1]) + ((four)[2] + (four)[3]))
#define WHOLE_FOUR(n) ((n) - (n) % 4)

AS_WIDE_AS_CAN_BE static double dot(const double *a, const double *b, int n)
{
    Four sum = {0};

    for (int i = 0; i < WHOLE_FOUR(n); i += 4)
        sum += FOUR_OF(a + i) * FOUR_OF(b + i);
    for (int i = WHOLE_FOUR(n); i < n; i++)
        sum[0] += a[i] * b[i];
    return SUM_OF(sum);
}

/* a += f b */
AS_WIDE_AS_CAN_BE static void add_row(double *restrict a, double f, const double *restrict b, int n)
{
    for (int i = 0; i < WHOLE_FOUR(n); i += 4)
        FOUR(a + i) += f * FOUR_OF(b + i);
    for (int i = WHOLE_FOUR(n); i < n; i++)
        a[i] += f * b[i];
}

/* sum of a b, complex: into *re, *im */
AS_WIDE_AS_CAN_BE static void dot_complex(const double *a_re, const double *a_im,
                                          const double *b_re, const double *b_im, int n, double *re,
                                          double *im)
{
    Four x = {0}, y = {0};

    for (int i = 0; i < WHOLE_FOUR(n); i += 4) {
        x += FOUR_OF(a_re + i) * FOUR_OF(b_re + i) - FOUR_OF(a_im + i) * FOUR_OF(b_im + i);
        y += FOUR_OF(a_re + i) * FOUR_OF(b_im + i) + FOUR_OF(a_im + i) * FOUR_OF(b_re + i);
    }
    for (int i = WHOLE_FOUR(n); i < n; i++) {
        x[0] += a_re[i] * b_re[i] - a_im[i] * b_im[i];
        y[0] += a_re[i] * b_im[i] + a_im[i] * b_re[i];
    }
    *re = SUM_OF(x);
    *im = SUM_OF(y);
}

/* a -= f b, complex */
AS_WIDE_AS_CAN_BE static void take_complex(double *restrict a_re, double *restrict a_im, double re,
                                           double im, const double *restrict b_re,
                                           const double *restrict b_im, int n)
{
    for (int i = 0; i < WHOLE_FOUR(n); i += 4) {
        FOUR(a_re + i) -= re * FOUR_OF(b_re + i) - im * FOUR_OF(b_im + i);
        FOUR(a_im + i) -= re * FOUR_OF(b_im + i) + im * FOUR_OF(b_re + i);
    }
    for (int i = WHOLE_FOUR(n); i < n; i++) {
        a_re[i] -= re * b_re[i] - im * b_im[i];
        a_im[i] -= re * b_im[i] + im * b_re[i];
    }
}

/* out = q x */
AS_WIDE_AS_CAN_BE static void times(const double *restrict q, const double *restrict x, int n,
                                    double *restrict out)
{
    for (int i = 0; i < WHOLE_FOUR(n); i += 4) {
        const double *a = q + (ptrdiff_t)i * n, *b = a + n, *c = b + n, *d = c + n;
        Four sum[4] = {{0}};

        for (int k = 0; k < WHOLE_FOUR(n); k += 4) {
            sum[0] += FOUR_OF(a + k) * FOUR_OF(x + k);
            sum[1] += FOUR_OF(b + k) * FOUR_OF(x + k);
            sum[2] += FOUR_OF(c + k) * FOUR_OF(x + k);
            sum[3] += FOUR_OF(d + k) * FOUR_OF(x + k);
        }
        for (int j = 0; j < 4; j++) {
            out[i + j] = SUM_OF(sum[j]);
            for (int k = WHOLE_FOUR(n); k < n; k++)
                out[i + j] += a[j * n + k] * x[k];
        }
    }
    for (int i = WHOLE_FOUR(n); i < n; i++)
        out[i] = dot(q + (ptrdiff_t)i * n, x, n);
}

/* out = q^T x */
AS_WIDE_AS_CAN_BE static void times_across(const double *restrict q, const double *restrict x,
                                           int n, double *restrict out)
{
    memset(out, 0, (size_t)n * sizeof(double));
    for (int i = 0; i < WHOLE_FOUR(n); i += 4) {
        const double *a = q + (ptrdiff_t)i * n, *b = a + n, *c = b + n, *d = c + n;

        for (int k = 0; k < WHOLE_FOUR(n); k += 4)
            FOUR(out + k) += x[i] * FOUR_OF(a + k) + x[i + 1] * FOUR_OF(b + k) +
                             x[i + 2] * FOUR_OF(c + k) + x[i + 3] * FOUR_OF(d + k);
        for (int k = WHOLE_FOUR(n); k < n; k++)
            out[k] += x[i] * a[k] + x[i + 1] * b[k] + x[i + 2] * c[k] + x[i + 3] * d[k];
    }
    for (int i = WHOLE_FOUR(n); i < n; i++)
        add_row(out, x[i], q + (ptrdiff_t)i * n, n);
}

/* --- the form --- */

/* v of n entries becomes that of the reflection that leaves it only its first entry, which is the
 * result; *share 0: that is so already */
static double reflect(double *v, int n, double *share)
{
    double size = 0, norm, first = v[0];

    for (int i = 1; i < n; i++)
        size = fmax(size, fabs(v[i]));
    *share = 0;
    if (size == 0)
        return first;
    size = fmax(size, fabs(first)); /* so that no square leaves the range */
    for (int i = 0; i < n; i++)
        v[i] /= size;
    norm = copysign(sqrt(dot(v, v, n)), -first);
    *share = (norm - v[0]) / norm;
    for (int i = 1; i < n; i++)
        v[i] /= v[0] - norm;
    v[0] = 1;
    return norm * size;
}

/* the rows `a` of a matrix (`left` entries each, stride n) become those of P a; room: left */
static void apply(double *a, int n, const double *v, double share, int left, double *room)
{
    memset(room, 0, (size_t)left * sizeof(double));
    for (int i = 0; i < left; i++)
        add_row(room, share * v[i], a + (ptrdiff_t)i * n, left);
    for (int i = 0; i < left; i++)
        add_row(a + (ptrdiff_t)i * n, -v[i], room, left);
}

/* H becomes P_k H P_k, with 0 below the entry under the diagonal of column k, P_k into v and
 * *share; room: n */
static void bring_column(HessenbergForm *r, int k, double *v, double *share, double *room)
{
    const int n = r->n, left = n - k - 1;
    double *h = r->h->data;

    for (int i = 0; i < left; i++)
        v[i] = h[(k + 1 + i) * n + k];
    h[(k + 1) * n + k] = reflect(v, left, share);
    for (int i = 1; i < left; i++)
        h[(k + 1 + i) * n + k] = 0;
    if (*share == 0)
        return;
    apply(h + (k + 1) * n + k + 1, n, v, *share, left, room);
    for (int i = 0; i < n; i++) {
        double *row = h + i * n + k + 1;

        add_row(row, -*share * dot(row, v, left), v, left);
    }
}

HessenbergForm *hessenberg_form_new(const double *a, int n)
{
    HessenbergForm *r = NEW(HessenbergForm);
    const size_t size = (size_t)n;
    double *room = NEW_ARRAY(double, n), *share = NEW_ARRAY(double, n);
    double *v = NEW_ARRAY(double, n *n); /* of P_k: row k, from its k+1st entry on */

    r->n = n;
    r->h = dense_matrix(size, size);
    r->d = dense_vector(size);
    r->q = NEW_ARRAY(double, n *n);
    memcpy(r->h->data, a, size * size * sizeof(double));
    (void)gsl_linalg_balance_matrix(r->h, r->d);
    for (int k = 0; k + 2 < n; k++)
        bring_column(r, k, v + k * n + k + 1, &share[k], room);
    for (int i = 0; i < n; i++)
        r->q[i * n + i] = 1;
    for (int k = n - 3; k >= 0; k--)
        if (share[k] != 0)
            apply(r->q + (k + 1) * n + k + 1, n, v + k * n + k + 1, share[k], n - k - 1, room);
    MEM_FREE(room, share, v);
    return r;
}

void hessenberg_form_free(HessenbergForm *r)
{
    if (r == NULL)
        return;
    MEM_FREE(r->h, r->d, r->q, r);
}

size_t hessenberg_form_bytes(const HessenbergForm *r)
{
    return sizeof *r + (size_t)r->n * (size_t)(2 * r->n + 1) * sizeof(double);
}

/* --- factors --- */

ShiftedFactors *shifted_factors_new(int n)
{
    ShiftedFactors *f = NEW(ShiftedFactors);

    f->n = n;
    f->re =
        mem_grow(NULL, (size_t)n * (size_t)n, sizeof(double)); /* written before they are read */
    f->im = mem_grow(NULL, (size_t)n * (size_t)n, sizeof(double));
    f->factor_re = NEW_ARRAY(double, n);
    f->factor_im = NEW_ARRAY(double, n);
    f->exchanged = NEW_ARRAY(bool, n);
    f->b = NEW_ARRAY(double, n);
    f->c = NEW_ARRAY(double, n);
    return f;
}

void shifted_factors_free(ShiftedFactors *f)
{
    if (f == NULL)
        return;
    MEM_FREE(f->re, f->im, f->factor_re, f->factor_im, f->exchanged, f->b, f->c, f);
}

static void exchange_rows(double *a, double *b, int n)
{
    for (int i = 0; i < n; i++) {
        double kept = a[i];

        a[i] = b[i];
        b[i] = kept;
    }
}

/* row i of s - H, from the diagonal under the main one on */
AS_WIDE_AS_CAN_BE static void bring_row(const HessenbergForm *r, double re, double *row, int i)
{
    int first = i > 0 ? i - 1 : 0;

    const double *h = r->h->data + (ptrdiff_t)i * r->n;
    int k = first;

    for (; k + 4 <= r->n; k += 4)
        FOUR(row + k) = -FOUR_OF(h + k);
    for (; k < r->n; k++)
        row[k] = -h[k];
    row[i] += re;
}

bool hessenberg_form_factor(const HessenbergForm *r, double s, ShiftedFactors *f)
{
    int n = r->n;

    if (n > 0)
        bring_row(r, s, f->re, 0);
    for (int k = 0; k + 1 < n; k++) {
        double *row = f->re + k * n, *next = row + n;

        bring_row(r, s, next, k + 1);
        f->exchanged[k] = fabs(next[k]) > fabs(row[k]);
        if (f->exchanged[k])
            exchange_rows(row + k, next + k, n - k);
        if (!(fabs(row[k]) > 0) || !isfinite(row[k]))
            return false;
        f->factor_re[k] = next[k] / row[k];
        add_row(next + k + 1, -f->factor_re[k], row + k + 1, n - k - 1);
    }
    return n == 0 || (fabs(f->re[n * n - 1]) > 0 && isfinite(f->re[n * n - 1]));
}

/* a / b of complex numbers; the divisor's size is far from the ends of the range */
static void divide(double a_re, double a_im, double b_re, double b_im, double *re, double *im)
{
    double size = b_re * b_re + b_im * b_im;

    *re = (a_re * b_re + a_im * b_im) / size;
    *im = (a_im * b_re - a_re * b_im) / size;
}

bool hessenberg_form_factor_complex(const HessenbergForm *r, double re, double im,
                                    ShiftedFactors *f)
{
    int n = r->n;

    memset(f->im, 0, (size_t)(n * n) * sizeof(double));
    for (int k = 0; k < n; k++)
        f->im[k * n + k] = im;
    if (n > 0)
        bring_row(r, re, f->re, 0);
    for (int k = 0; k + 1 < n; k++) {
        double *a = f->re + k * n, *a_next = a + n;
        double *b = f->im + k * n, *b_next = b + n;
        int left = n - k - 1;

        bring_row(r, re, a_next, k + 1);
        f->exchanged[k] = fabs(a_next[k]) > fabs(a[k]) + fabs(b[k]);
        if (f->exchanged[k]) {
            exchange_rows(a + k, a_next + k, n - k);
            exchange_rows(b + k, b_next + k, n - k);
        }
        if (!(fabs(a[k]) + fabs(b[k]) > 0) || !isfinite(a[k] + b[k]))
            return false;
        divide(a_next[k], b_next[k], a[k], b[k], &f->factor_re[k], &f->factor_im[k]);
        take_complex(a_next + k + 1, b_next + k + 1, f->factor_re[k], f->factor_im[k], a + k + 1,
                     b + k + 1, left);
    }
    if (n == 0)
        return true;
    return fabs(f->re[n * n - 1]) + fabs(f->im[n * n - 1]) > 0 &&
           isfinite(f->re[n * n - 1] + f->im[n * n - 1]);
}

/* --- solutions --- */

/* out = Q^T D^-1 b; b is used up */
static void enter(const HessenbergForm *r, double *b, double *out)
{
    for (int i = 0; i < r->n; i++)
        b[i] /= r->d->data[i];
    times_across(r->q, b, r->n, out);
}

/* out = D Q b */
static void leave(const HessenbergForm *r, const double *b, double *out)
{
    times(r->q, b, r->n, out);
    for (int i = 0; i < r->n; i++)
        out[i] *= r->d->data[i];
}

static void swap(double *a, double *b)
{
    double kept = *a;

    *a = *b;
    *b = kept;
}

void hessenberg_form_solve(const HessenbergForm *r, ShiftedFactors *f, double *b)
{
    int n = r->n;
    double *x = f->b;

    enter(r, b, x);
    for (int k = 0; k + 1 < n; k++) {
        if (f->exchanged[k])
            swap(&x[k], &x[k + 1]);
        x[k + 1] -= f->factor_re[k] * x[k];
    }
    for (int i = n - 1; i >= 0; i--) {
        const double *row = f->re + i * n;

        x[i] = (x[i] - dot(row + i + 1, x + i + 1, n - i - 1)) / row[i];
    }
    leave(r, x, b);
}

void hessenberg_form_solve_complex(const HessenbergForm *r, ShiftedFactors *f, double *b, double *c)
{
    int n = r->n;
    double *x = f->b, *y = f->c;

    enter(r, b, x);
    enter(r, c, y);
    for (int k = 0; k + 1 < n; k++) {
        if (f->exchanged[k]) {
            swap(&x[k], &x[k + 1]);
            swap(&y[k], &y[k + 1]);
        }
        x[k + 1] -= f->factor_re[k] * x[k] - f->factor_im[k] * y[k];
        y[k + 1] -= f->factor_re[k] * y[k] + f->factor_im[k] * x[k];
    }
    for (int i = n - 1; i >= 0; i--) {
        const double *re = f->re + i * n + i, *im = f->im + i * n + i;
        double sum_re, sum_im;

        dot_complex(re + 1, im + 1, x + i + 1, y + i + 1, n - i - 1, &sum_re, &sum_im);
        divide(x[i] - sum_re, y[i] - sum_im, re[0], im[0], &x[i], &y[i]);
    }
    leave(r, x, b);
    leave(r, y, c);
}
