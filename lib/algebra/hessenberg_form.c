/* hessenberg_form.c: (s - A)^-1 b by a Hessenberg form
 *
 * GSL makes the form. It has no elimination of s - H, whose O(n^2) for each s is what the form is
 * for. */
#include "algebra/hessenberg_form.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

struct HessenbergForm {
    int n;
    gsl_matrix *h;       /* 0 below the diagonal under the main one */
    gsl_matrix *q, *q_t; /* Q, and Q^T */
    gsl_vector *d;       /* D */
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

HessenbergForm *hessenberg_form_new(const double *a, int n)
{
    HessenbergForm *r = NEW(HessenbergForm);
    const size_t size = (size_t)n;
    gsl_vector *tau = dense_vector(size);

    r->n = n;
    r->h = dense_matrix(size, size);
    r->q = dense_matrix(size, size);
    r->q_t = dense_matrix(size, size);
    r->d = dense_vector(size);
    memcpy(r->h->data, a, size * size * sizeof(double));
    (void)gsl_linalg_balance_matrix(r->h, r->d);
    (void)gsl_linalg_hessenberg_decomp(r->h, tau);
    (void)gsl_linalg_hessenberg_unpack(r->h, tau, r->q);
    (void)gsl_linalg_hessenberg_set_zero(r->h);
    (void)gsl_matrix_transpose_memcpy(r->q_t, r->q);
    mem_free(tau);
    return r;
}

void hessenberg_form_free(HessenbergForm *r)
{
    if (r == NULL)
        return;
    MEM_FREE(r->h, r->q, r->q_t, r->d, r);
}

size_t hessenberg_form_bytes(const HessenbergForm *r)
{
    return sizeof *r + (size_t)r->n * (size_t)(3 * r->n + 1) * sizeof(double);
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

/* out = Q^T D^-1 b */
static void enter(const HessenbergForm *r, const double *b, double *out)
{
    memset(out, 0, (size_t)r->n * sizeof(double));
    for (int i = 0; i < r->n; i++)
        if (b[i] != 0)
            add_row(out, b[i] / r->d->data[i], r->q->data + i * r->n, r->n);
}

/* out = D Q b */
static void leave(const HessenbergForm *r, const double *b, double *out)
{
    memset(out, 0, (size_t)r->n * sizeof(double));
    for (int k = 0; k < r->n; k++)
        add_row(out, b[k], r->q_t->data + k * r->n, r->n);
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
        const double *p = x + i + 1, *q = y + i + 1;
        int left = n - i - 1;

        divide(x[i] - dot(re + 1, p, left) + dot(im + 1, q, left),
               y[i] - dot(re + 1, q, left) - dot(im + 1, p, left), re[0], im[0], &x[i], &y[i]);
    }
    leave(r, x, b);
    leave(r, y, c);
}
