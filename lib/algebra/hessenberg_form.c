/* hessenberg_form.c: (s - A)^-1 b by a Hessenberg form */
#include "algebra/hessenberg_form.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

#define SWEEPS 8    /* of balancing */
#define BETTER 0.95 /* of the size of a row and column: what is worth a sweep */
#define RADIX  2.0

struct HessenbergForm {
    int n;
    double *h;       /* n x n; 0 below the diagonal under the main one */
    double *q, *q_t; /* Q, and Q^T */
    double *d;       /* D */
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

/* a += f b */
static void add_row(double *restrict a, double f, const double *restrict b, int n)
{
    for (int i = 0; i < n; i++)
        a[i] += f * b[i];
}

/* --- the form --- */

/* Scale state i: row i over f, column i times f, so that their sizes come near each other. */
static bool balance_one(HessenbergForm *r, int i)
{
    double row = 0, column = 0, f = 1, size;
    int n = r->n;

    for (int k = 0; k < n; k++)
        if (k != i) {
            row += fabs(r->h[i * n + k]);
            column += fabs(r->h[k * n + i]);
        }
    if (!(row > 0) || !(column > 0))
        return false;
    size = row + column;
    while (column < row / RADIX) {
        f *= RADIX;
        column *= RADIX * RADIX;
    }
    while (column > row * RADIX) {
        f /= RADIX;
        column /= RADIX * RADIX;
    }
    if (f == 1 || !((row + column) / f < BETTER * size))
        return false;
    r->d[i] *= f;
    for (int k = 0; k < n; k++)
        r->h[i * n + k] /= f;
    for (int k = 0; k < n; k++)
        r->h[k * n + i] *= f;
    return true;
}

/* Parlett, Reinsch (1969) */
static void matrix_balance(HessenbergForm *r)
{
    bool again = true;

    for (int i = 0; i < r->n; i++)
        r->d[i] = 1;
    for (int sweep = 0; sweep < SWEEPS && again; sweep++) {
        again = false;
        for (int i = 0; i < r->n; i++)
            again = balance_one(r, i) || again;
    }
}

/* The reflection 1 - tau v v^T that brings column k below the next row to 0; v is 0 up to row k.
 * 0: nothing is to be done. */
static double reflection(const HessenbergForm *r, int k, double *v)
{
    const double *h = r->h;
    int n = r->n;
    double largest = 0, sum = 0, head;

    for (int i = k + 2; i < n; i++)
        largest = fmax(largest, fabs(h[i * n + k]));
    if (!(largest > 0))
        return 0;
    largest = fmax(largest, fabs(h[(k + 1) * n + k]));
    for (int i = k + 1; i < n; i++) {
        v[i] = h[i * n + k] / largest;
        sum += v[i] * v[i];
    }
    head = v[k + 1];
    v[k + 1] += head < 0 ? -sqrt(sum) : sqrt(sum);
    return 1 / (sum + fabs(head) * sqrt(sum));
}

/* rows of m from `first` on by the reflection, from the left */
static void reflect_left(double *m, int n, int first, const double *v, double tau, double *w)
{
    memset(w, 0, (size_t)n * sizeof(double));
    for (int i = first; i < n; i++)
        add_row(w, tau * v[i], m + i * n, n);
    for (int i = first; i < n; i++)
        add_row(m + i * n, -v[i], w, n);
}

static void reflect_right(double *m, int n, int first, const double *v, double tau)
{
    for (int i = 0; i < n; i++) {
        double *row = m + i * n + first;

        add_row(row, -tau * dot(row, v + first, n - first), v + first, n - first);
    }
}

static void reduce(HessenbergForm *r)
{
    int n = r->n;
    double *v = NEW_ARRAY(double, n), *w = NEW_ARRAY(double, n);

    for (int k = 0; k + 2 < n; k++) {
        double tau = reflection(r, k, v);

        if (tau == 0)
            continue;
        reflect_left(r->h, n, k + 1, v, tau, w);
        reflect_right(r->h, n, k + 1, v, tau);
        reflect_right(r->q, n, k + 1, v, tau);
        for (int i = k + 2; i < n; i++)
            r->h[i * n + k] = 0;
    }
    mem_free(v);
    mem_free(w);
}

HessenbergForm *hessenberg_form_new(const double *a, int n)
{
    HessenbergForm *r = NEW(HessenbergForm);

    r->n = n;
    r->h = NEW_ARRAY(double, n *n);
    r->q = NEW_ARRAY(double, n *n);
    r->q_t = NEW_ARRAY(double, n *n);
    r->d = NEW_ARRAY(double, n);
    memcpy(r->h, a, (size_t)(n * n) * sizeof(double));
    for (int i = 0; i < n; i++)
        r->q[i * n + i] = 1;
    matrix_balance(r);
    reduce(r);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            r->q_t[k * n + i] = r->q[i * n + k];
    return r;
}

void hessenberg_form_free(HessenbergForm *r)
{
    if (r == NULL)
        return;
    mem_free(r->h);
    mem_free(r->q);
    mem_free(r->q_t);
    mem_free(r->d);
    mem_free(r);
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
    mem_free(f->re);
    mem_free(f->im);
    mem_free(f->factor_re);
    mem_free(f->factor_im);
    mem_free(f->exchanged);
    mem_free(f->b);
    mem_free(f->c);
    mem_free(f);
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
        row[k] = -r->h[i * r->n + k];
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
            add_row(out, b[i] / r->d[i], r->q + i * r->n, r->n);
}

/* out = D Q b */
static void leave(const HessenbergForm *r, const double *b, double *out)
{
    memset(out, 0, (size_t)r->n * sizeof(double));
    for (int k = 0; k < r->n; k++)
        add_row(out, b[k], r->q_t + k * r->n, r->n);
    for (int i = 0; i < r->n; i++)
        out[i] *= r->d[i];
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
