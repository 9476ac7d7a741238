/* siso.c: the states between an input and an output, and (s - A)^-1 */
#include "simulate/analyse/siso.h"

#include "algebra/schur.h"
#include "base/memory.h"

#include <string.h>

/* --- states between input and output --- */

/* Mark what is reachable from marked states; `back`: what they are reachable from. */
static void follow(const double *a, int n, bool back, bool *marked)
{
    int *queue = NEW_ARRAY(int, n);
    int count = 0;

    for (int i = 0; i < n; i++)
        if (marked[i])
            queue[count++] = i;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < n; i++)
            if (!marked[i] && (back ? a[queue[k] * n + i] : a[i * n + queue[k]]) != 0) {
                marked[i] = true;
                queue[count++] = i;
            }
    mem_free(queue);
}

static int find_kept(const Linear *linear, int output, int input, int *kept)
{
    const int n = linear->states;
    bool *moved = NEW_ARRAY(bool, n), *seen = NEW_ARRAY(bool, n);
    int count = 0;

    for (int i = 0; i < n; i++) {
        moved[i] = linear->b[i * linear->inputs + input] != 0;
        seen[i] = linear->c[output * n + i] != 0;
    }
    follow(linear->a, n, false, moved);
    follow(linear->a, n, true, seen);
    for (int i = 0; i < n; i++)
        if (moved[i] && seen[i])
            kept[count++] = i;
    MEM_FREE(moved, seen);
    return count;
}

/* scale of each state; input and output count as one more state */
static void find_scale(const Siso *s, double *scale)
{
    const int n = s->n, m = n + 1;
    double *size = NEW_ARRAY(double, m *m);

    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            size[i * m + j] = fabs(s->a[i * n + j]);
        size[i * m + n] = fabs(s->b[i]);
        size[n * m + i] = fabs(s->c[i]);
    }
    matrix_balance(size, m, scale);
    mem_free(size);
}

static void apply_scale(Siso *s, const double *scale)
{
    const int n = s->n;

    for (int i = 0; i < n; i++) {
        const double by = scale[i] / scale[n];

        for (int j = 0; j < n; j++) {
            s->a[i * n + j] *= scale[i] / scale[j];
            s->a_error[i * n + j] *= scale[i] / scale[j];
        }
        s->b[i] *= by;
        s->b_error[i] *= by;
        s->c[i] /= by;
        s->c_error[i] /= by;
    }
}

Siso siso_new(const Linear *linear, int output, int input)
{
    const int all = linear->states, entry = output * linear->inputs + input;
    int *kept = NEW_ARRAY(int, all);
    const int n = find_kept(linear, output, input, kept);
    Siso s = {.n = n,
              .a = NEW_ARRAY(double, n *n),
              .b = NEW_ARRAY(double, n),
              .c = NEW_ARRAY(double, n),
              .d = linear->d[entry],
              .a_error = NEW_ARRAY(double, n *n),
              .b_error = NEW_ARRAY(double, n),
              .c_error = NEW_ARRAY(double, n),
              .d_error = linear->d_error[entry]};
    double *scale = NEW_ARRAY(double, n + 1);

    for (int i = 0; i < n; i++) {
        s.b[i] = linear->b[kept[i] * linear->inputs + input];
        s.b_error[i] = linear->b_error[kept[i] * linear->inputs + input];
        s.c[i] = linear->c[output * all + kept[i]];
        s.c_error[i] = linear->c_error[output * all + kept[i]];
        for (int j = 0; j < n; j++) {
            s.a[i * n + j] = linear->a[kept[i] * all + kept[j]];
            s.a_error[i * n + j] = linear->a_error[kept[i] * all + kept[j]];
        }
    }
    find_scale(&s, scale);
    apply_scale(&s, scale);
    MEM_FREE(kept, scale);
    return s;
}

void siso_free(Siso *single)
{
    MEM_FREE(single->a, single->b, single->c, single->a_error, single->b_error, single->c_error);
}

/* --- the resolvent --- */

struct Resolvent {
    int n;
    DoubleDouble *h, *q; /* A = Q H Q^T */
    DoubleDouble *b, *c; /* Q^T b, Q^T c */
    double norm;
    DoubleDoubleComplex *factors; /* n x n: U on and above the diagonal */
    DoubleDoubleComplex *factor;  /* of step k: multiple of row k taken from the next row */
    bool *exchanged;              /* step k exchanged its two rows first */
    DoubleDoubleComplex *x, *y;   /* (s - H)^-1 Q^T b, (s - H)^-T Q^T c */
};

/* out = Q^T v */
static void turn_in(const Resolvent *r, const DoubleDouble *v, DoubleDouble *out)
{
    for (int j = 0; j < r->n; j++)
        for (int i = 0; i < r->n && v[j].high != 0; i++)
            out[i] = dd_add(out[i], dd_mul(r->q[j * r->n + i], v[j]));
}

Resolvent *resolvent_new(const DoubleDouble *a, const DoubleDouble *b, const DoubleDouble *c, int n)
{
    Resolvent *r = NEW(Resolvent);

    *r = (Resolvent){n,
                     NEW_ARRAY(DoubleDouble, n * n),
                     NEW_ARRAY(DoubleDouble, n * n),
                     NEW_ARRAY(DoubleDouble, n),
                     NEW_ARRAY(DoubleDouble, n),
                     0,
                     NEW_ARRAY(DoubleDoubleComplex, n * n),
                     NEW_ARRAY(DoubleDoubleComplex, n),
                     NEW_ARRAY(bool, n),
                     NEW_ARRAY(DoubleDoubleComplex, n),
                     NEW_ARRAY(DoubleDoubleComplex, n)};
    for (int i = 0; i < n * n; i++) {
        r->h[i] = a[i];
        r->norm = fmax(r->norm, fabs(a[i].high));
    }
    matrix_hessenberg(r->h, n, r->q);
    turn_in(r, b, r->b);
    turn_in(r, c, r->c);
    return r;
}

void resolvent_free(Resolvent *resolvent)
{
    if (resolvent == NULL)
        return;
    MEM_FREE(resolvent->h, resolvent->q, resolvent->b, resolvent->c, resolvent->factors,
             resolvent->factor, resolvent->exchanged, resolvent->x, resolvent->y, resolvent);
}

static void eliminate(Resolvent *r, int k)
{
    const int n = r->n;
    DoubleDoubleComplex *row = r->factors + (ptrdiff_t)k * n, *next = row + n;

    r->exchanged[k] = dd_size(next[k]) > dd_size(row[k]);
    for (int j = k; j < n && r->exchanged[k]; j++) {
        const DoubleDoubleComplex kept = row[j];

        row[j] = next[j];
        next[j] = kept;
    }
    r->factor[k] = dd_real(dd_of(0));
    if (dd_size(next[k]) == 0)
        return;
    r->factor[k] = dd_cdiv(next[k], row[k]);
    for (int j = k + 1; j < n; j++)
        next[j] = dd_csub(next[j], dd_cmul(r->factor[k], row[j]));
}

bool resolvent_at(Resolvent *r, DoubleDoubleComplex s)
{
    const int n = r->n;
    const double least = fmax(DOUBLE_DOUBLE_ROUNDING * fmax(r->norm, dd_size(s)), 1e-290);
    bool apart = true;

    for (int i = 0; i < n; i++)
        for (int j = i > 0 ? i - 1 : 0; j < n; j++) {
            const DoubleDoubleComplex entry = dd_real(dd_neg(r->h[i * n + j]));

            r->factors[i * n + j] = i == j ? dd_cadd(s, entry) : entry;
        }
    for (int k = 0; k + 1 < n; k++)
        eliminate(r, k);
    for (int k = 0; k < n; k++)
        if (dd_size(r->factors[k * n + k]) == 0) {
            r->factors[k * n + k] = dd_real(dd_of(least));
            apart = false;
        }
    return apart;
}

static void exchange(DoubleDoubleComplex *x, int k)
{
    const DoubleDoubleComplex kept = x[k];

    x[k] = x[k + 1];
    x[k + 1] = kept;
}

static DoubleDoubleComplex along(const DoubleDouble *v, const DoubleDoubleComplex *x, int n)
{
    DoubleDoubleComplex sum = dd_real(dd_of(0));

    for (int i = 0; i < n; i++)
        sum = dd_cadd(sum, dd_ctimes(x[i], v[i]));
    return sum;
}

DoubleDoubleComplex resolvent_value(Resolvent *r)
{
    const int n = r->n;
    DoubleDoubleComplex *z = r->x;

    for (int i = 0; i < n; i++)
        z[i] = dd_real(r->b[i]);
    for (int k = 0; k + 1 < n; k++) {
        if (r->exchanged[k])
            exchange(z, k);
        z[k + 1] = dd_csub(z[k + 1], dd_cmul(r->factor[k], z[k]));
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++)
            z[k] = dd_csub(z[k], dd_cmul(r->factors[k * n + j], z[j]));
        z[k] = dd_cdiv(z[k], r->factors[k * n + k]);
    }
    return along(r->c, z, n);
}

DoubleDoubleComplex resolvent_slope(Resolvent *r)
{
    const int n = r->n;
    DoubleDoubleComplex *z = r->y, slope = dd_real(dd_of(0));

    for (int i = 0; i < n; i++)
        z[i] = dd_real(r->c[i]);
    for (int k = 0; k < n; k++) {
        for (int j = 0; j < k; j++)
            z[k] = dd_csub(z[k], dd_cmul(r->factors[j * n + k], z[j]));
        z[k] = dd_cdiv(z[k], r->factors[k * n + k]);
    }
    for (int k = n - 2; k >= 0; k--) {
        z[k] = dd_csub(z[k], dd_cmul(r->factor[k], z[k + 1]));
        if (r->exchanged[k])
            exchange(z, k);
    }
    for (int i = 0; i < n; i++)
        slope = dd_csub(slope, dd_cmul(z[i], r->x[i]));
    return slope;
}

void resolvent_vectors(const Resolvent *r, double complex *x, double complex *y)
{
    const int n = r->n;

    for (int i = 0; i < n; i++) {
        x[i] = y[i] = 0;
        for (int j = 0; j < n; j++) {
            x[i] += r->q[i * n + j].high * dd_to(r->x[j]);
            y[i] += r->q[i * n + j].high * dd_to(r->y[j]);
        }
    }
}
