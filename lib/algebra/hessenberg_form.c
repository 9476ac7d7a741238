/* hessenberg_form.c: (s - A)^-1 b by a Hessenberg form
 *
 * By hand: GSL has no elimination of s - H, whose O(n^2) for each s is what the form is for, and
 * its reflections go down columns, which takes three times as long (make bench:
 * algebra.hessenberg_*). */
#include "algebra/hessenberg_form.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

struct HessenbergForm {
    int n;
    gsl_matrix *h; /* 0 below the diagonal under the main one */
    gsl_vector *d; /* D */
    double *v; /* Q = P_0 P_1 ..., P_k = 1 - share_k v_k v_k^T: row k, from its k+1st entry on */
    double *share;
};

struct ShiftedFactors {
    int n;
    double *re, *im;               /* n x n: U, on and above the diagonal */
    double *factor_re, *factor_im; /* by which row k went off the next one, */
    bool *exchanged;               /* which it changed places with before */
    double *b, *c;
};

/* --- rows --- */

static double dot(const double *a, const double *b, int n)
{
    double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
    int i = 0;

    for (; i + 4 <= n; i += 4) {
        s0 += a[i] * b[i];
        s1 += a[i + 1] * b[i + 1];
        s2 += a[i + 2] * b[i + 2];
        s3 += a[i + 3] * b[i + 3];
    }
    for (; i < n; i++)
        s0 += a[i] * b[i];
    return (s0 + s1) + (s2 + s3);
}

/* a += f b; four at a time, which compilers make two instructions of */
static void add_row(double *restrict a, double f, const double *restrict b, int n)
{
    int i = 0;

    for (; i + 4 <= n; i += 4) {
        a[i] += f * b[i];
        a[i + 1] += f * b[i + 1];
        a[i + 2] += f * b[i + 2];
        a[i + 3] += f * b[i + 3];
    }
    for (; i < n; i++)
        a[i] += f * b[i];
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

/* H becomes P_k H P_k, with 0 below the entry under the diagonal of column k; room: n */
static void bring_column(HessenbergForm *r, int k, double *room)
{
    const int n = r->n, left = n - k - 1;
    double *h = r->h->data, *v = r->v + (ptrdiff_t)k * n + k + 1;

    for (int i = 0; i < left; i++)
        v[i] = h[(k + 1 + i) * n + k];
    h[(k + 1) * n + k] = reflect(v, left, &r->share[k]);
    for (int i = 1; i < left; i++)
        h[(k + 1 + i) * n + k] = 0;
    if (r->share[k] == 0)
        return;
    memset(room, 0, (size_t)left * sizeof(double));
    for (int i = 0; i < left; i++)
        add_row(room, r->share[k] * v[i], h + (k + 1 + i) * n + k + 1, left);
    for (int i = 0; i < left; i++)
        add_row(h + (k + 1 + i) * n + k + 1, -v[i], room, left);
    for (int i = 0; i < n; i++) {
        double *row = h + i * n + k + 1;

        add_row(row, -r->share[k] * dot(row, v, left), v, left);
    }
}

HessenbergForm *hessenberg_form_new(const double *a, int n)
{
    HessenbergForm *r = NEW(HessenbergForm);
    const size_t size = (size_t)n;
    double *room = NEW_ARRAY(double, n);

    r->n = n;
    r->h = dense_matrix(size, size);
    r->d = dense_vector(size);
    r->v = NEW_ARRAY(double, n *n);
    r->share = NEW_ARRAY(double, n);
    memcpy(r->h->data, a, size * size * sizeof(double));
    (void)gsl_linalg_balance_matrix(r->h, r->d);
    for (int k = 0; k + 2 < n; k++)
        bring_column(r, k, room);
    mem_free(room);
    return r;
}

void hessenberg_form_free(HessenbergForm *r)
{
    if (r == NULL)
        return;
    MEM_FREE(r->h, r->d, r->v, r->share, r);
}

size_t hessenberg_form_bytes(const HessenbergForm *r)
{
    return sizeof *r + (size_t)r->n * (size_t)(2 * r->n + 2) * sizeof(double);
}

/* --- factors --- */

ShiftedFactors *shifted_factors_new(int n)
{
    ShiftedFactors *f = NEW(ShiftedFactors);

    f->n = n;
    f->re = NEW_ARRAY(double, n *n);
    f->im = NEW_ARRAY(double, n *n);
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
static void bring_row(const HessenbergForm *r, double re, double *row, int i)
{
    int first = i > 0 ? i - 1 : 0;

    for (int k = first; k < r->n; k++)
        row[k] = -r->h->data[i * r->n + k];
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
        add_row(a_next + k + 1, -f->factor_re[k], a + k + 1, left);
        add_row(a_next + k + 1, f->factor_im[k], b + k + 1, left);
        add_row(b_next + k + 1, -f->factor_re[k], b + k + 1, left);
        add_row(b_next + k + 1, -f->factor_im[k], a + k + 1, left);
    }
    if (n == 0)
        return true;
    return fabs(f->re[n * n - 1]) + fabs(f->im[n * n - 1]) > 0 &&
           isfinite(f->re[n * n - 1] + f->im[n * n - 1]);
}

/* --- solutions --- */

/* b becomes P_k b */
static void apply_reflection(const HessenbergForm *r, int k, double *b)
{
    const int left = r->n - k - 1;
    const double *v = r->v + (ptrdiff_t)k * r->n + k + 1;

    if (r->share[k] != 0)
        add_row(b + k + 1, -r->share[k] * dot(b + k + 1, v, left), v, left);
}

/* the same of two, whose sums go side by side */
static void apply_to_both(const HessenbergForm *r, int k, double *restrict b, double *restrict c)
{
    const int n = r->n;
    const double *restrict v = r->v + (ptrdiff_t)k * n;
    double b_sum[2] = {0}, c_sum[2] = {0};
    int i = k + 1;

    if (r->share[k] == 0)
        return;
    for (; i + 2 <= n; i += 2)
        for (int j = 0; j < 2; j++) {
            b_sum[j] += v[i + j] * b[i + j];
            c_sum[j] += v[i + j] * c[i + j];
        }
    for (; i < n; i++) {
        b_sum[0] += v[i] * b[i];
        c_sum[0] += v[i] * c[i];
    }
    add_row(b + k + 1, -r->share[k] * (b_sum[0] + b_sum[1]), v + k + 1, n - k - 1);
    add_row(c + k + 1, -r->share[k] * (c_sum[0] + c_sum[1]), v + k + 1, n - k - 1);
}

/* out = Q^T D^-1 b */
static void enter(const HessenbergForm *r, const double *b, double *out)
{
    for (int i = 0; i < r->n; i++)
        out[i] = b[i] / r->d->data[i];
    for (int k = 0; k + 2 < r->n; k++)
        apply_reflection(r, k, out);
}

/* out = D Q b; b is used up */
static void leave(const HessenbergForm *r, double *b, double *out)
{
    for (int k = r->n - 3; k >= 0; k--)
        apply_reflection(r, k, b);
    for (int i = 0; i < r->n; i++)
        out[i] = b[i] * r->d->data[i];
}

static void enter_both(const HessenbergForm *r, const double *b, const double *c, double *b_out,
                       double *c_out)
{
    for (int i = 0; i < r->n; i++) {
        b_out[i] = b[i] / r->d->data[i];
        c_out[i] = c[i] / r->d->data[i];
    }
    for (int k = 0; k + 2 < r->n; k++)
        apply_to_both(r, k, b_out, c_out);
}

static void leave_both(const HessenbergForm *r, double *b, double *c, double *b_out, double *c_out)
{
    for (int k = r->n - 3; k >= 0; k--)
        apply_to_both(r, k, b, c);
    for (int i = 0; i < r->n; i++) {
        b_out[i] = b[i] * r->d->data[i];
        c_out[i] = c[i] * r->d->data[i];
    }
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

    enter_both(r, b, c, x, y);
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
        const double *p = x + i + 1, *q = y + i + 1;
        int left = n - i - 1;

        divide(x[i] - dot(re + 1, p, left) + dot(im + 1, q, left),
               y[i] - dot(re + 1, q, left) - dot(im + 1, p, left), re[0], im[0], &x[i], &y[i]);
    }
    leave_both(r, x, y, b, c);
}
