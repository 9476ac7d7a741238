/* modal.c: eigenvectors in doubles, corrected by residuals in twice the digits
 *
 * With R = K X - M X L, L diagonal, and G = X^T M X: X^-1 M^-1 K X = L + G^-1 X^T R. Products with
 * M and K are sums in numbers of twice the digits (Ogita, Rump and Oishi 2005); vectors are
 * corrected by first order as in Ogita and Aishima (2018). */
#include "algebra/modal.h"

#include "algebra/algebra_limits.h"
#include "algebra/block_triangular.h"
#include "algebra/dense.h"
#include "algebra/double_double.h"
#include "algebra/linear.h"
#include "algebra/schur.h"
#include "base/four.h"
#include "base/memory.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <stdlib.h>
#include <string.h>

enum { CORRECTIONS = 2, MOST = 4000 /* n, that bounds allow for */ };

/* --- products --- */

/* sum += f b, exact but for 2^-104 of it and the second order of rounding */
AS_WIDE_AS_CAN_BE static void add_dd(double f, const double *restrict b, double *restrict high,
                                     double *restrict low, int n)
{
    const double split = 134217729, ft = split * f, fh = ft - (ft - f), fl = f - fh;
    int j = 0;

    for (; j + 4 <= n; j += 4) {
        const Four x = *(const Four *)(b + j), sum = *(const Four *)(high + j);
        const Four xt = split * x, xh = xt - (xt - x), xl = x - xh, p = f * x;
        const Four off = ((fh * xh - p) + fh * xl + fl * xh) + fl * xl;
        const Four next = sum + p, other = next - sum;

        *(Four *)(high + j) = next;
        *(Four *)(low + j) += ((sum - (next - other)) + (p - other)) + off;
    }
    for (; j < n; j++) {
        const DoubleDouble p = dd_product(f, b[j]), s = dd_sum(high[j], p.high);

        high[j] = s.high;
        low[j] += s.low + p.low;
    }
}

/* out_high + out_low = a b, rows x n times n x columns */
static void multiply_dd(const double *a, const double *b, int rows, int n, int columns,
                        double *out_high, double *out_low)
{
    for (int i = 0; i < rows; i++) {
        double *high = out_high + (ptrdiff_t)i * columns, *low = out_low + (ptrdiff_t)i * columns;

        memset(high, 0, (size_t)columns * sizeof *high);
        memset(low, 0, (size_t)columns * sizeof *low);
        for (int k = 0; k < n; k++)
            if (a[i * n + k] != 0)
                add_dd(a[i * n + k], b + (ptrdiff_t)k * columns, high, low, columns);
    }
}

/* out = op(a) b in doubles, op(a): rows x n, b: n x columns */
static void multiply_some(CBLAS_TRANSPOSE_t op, const double *a, const double *b, int rows, int n,
                          int columns, double *out)
{
    if (rows > 0 && columns > 0)
        cblas_dgemm(CblasRowMajor, op, CblasNoTrans, rows, columns, n, 1, a, n, b, columns, 0, out,
                    columns);
}

static void multiply(CBLAS_TRANSPOSE_t op, const double *a, const double *b, int n, int columns,
                     double *out)
{
    multiply_some(op, a, b, n, n, columns, out);
}

static double *sizes(const double *a, int count)
{
    double *out = NEW_ARRAY(double, count);

    for (int i = 0; i < count; i++)
        out[i] = fabs(a[i]);
    return out;
}

/* errors of entries, including rounding of double-double sums */
static double *entry_errors(BoundedMatrix m, int count)
{
    double *out = NEW_ARRAY(double, count);

    for (int i = 0; i < count; i++)
        out[i] = m.error[i] + MODAL_PRODUCTS * fabs(m.at[i]);
    return out;
}

/* --- vectors in doubles --- */

/* symmetric parts, and results from them */
typedef struct Vectors {
    int n;
    const double *mass, *stiffness;
    Modal *out;
} Vectors;

/* some coordinates: rigid ones first, then those with stiffness */
typedef struct Coordinates {
    const int *at;
    int still, count;
} Coordinates;

/* Still coordinates: an M-orthonormal base of theirs, L^-T of M_zz = L L^T, which is left in `l`.
 */
static bool base_of_still(const Vectors *v, const Coordinates *c, double *l)
{
    double *unit;

    for (int i = 0; i < c->still; i++)
        for (int j = 0; j <= i; j++)
            l[i * c->still + j] = v->mass[c->at[i] * v->n + c->at[j]];
    if (c->still > 0 && !(cholesky_factor(l, c->still) > 0))
        return false;
    unit = NEW_ARRAY(double, c->still);
    for (int k = 0; k < c->still; k++) {
        memset(unit, 0, (size_t)c->still * sizeof *unit);
        unit[k] = 1;
        cholesky_backward(l, c->still, unit);
        for (int i = 0; i < c->still; i++)
            v->out->vector[c->at[i] * v->n + c->at[k]] = unit[i];
        v->out->is_still[c->at[k]] = true;
        v->out->square[c->at[k]] = 0;
    }
    mem_free(unit);
    return true;
}

/* M_zz^-1 M_zs of a column s */
static void follow_still(const Vectors *v, const Coordinates *c, const double *l, int s,
                         double *out)
{
    for (int i = 0; i < c->still; i++)
        out[i] = v->mass[c->at[i] * v->n + c->at[s]];
    cholesky_forward(l, c->still, out);
    cholesky_backward(l, c->still, out);
}

/* input of solve_others(): both matrices of the coordinates with stiffness, scaled */
typedef struct Pencil {
    int m;
    gsl_matrix *stiffness, *mass, *vector;
    gsl_vector *square;
    double *along; /* m x still: M_zz^-1 M_zs */
    double *scale;
} Pencil;

/* M_ss - M_sz M_zz^-1 M_zs: still ones are carried along freely; false: not positive */
static bool fill_pencil(const Vectors *v, const Coordinates *c, const Pencil *p)
{
    const int m = p->m, n = v->n;
    bool sound = true;

    for (int i = 0; i < m; i++) {
        const int row = c->at[c->still + i];

        for (int j = 0; j < m; j++) {
            const int column = c->at[c->still + j];
            double sum = v->mass[row * n + column];

            for (int z = 0; z < c->still; z++)
                sum -= v->mass[row * n + c->at[z]] * p->along[j * c->still + z];
            p->mass->data[i * m + j] = sum;
            p->stiffness->data[i * m + j] = v->stiffness[row * n + column];
        }
        sound = sound && p->mass->data[i * m + i] > 0 && isfinite(p->mass->data[i * m + i]);
    }
    for (int i = 0; i < m && sound; i++)
        p->scale[i] = ldexp(1, -ilogb(p->mass->data[i * m + i]) / 2);
    for (int i = 0; i < m && sound; i++)
        for (int j = 0; j < m; j++) {
            p->mass->data[i * m + j] *= p->scale[i] * p->scale[j];
            p->stiffness->data[i * m + j] *= p->scale[i] * p->scale[j];
        }
    return sound && vector_is_finite(p->mass->data, m * m) &&
           vector_is_finite(p->stiffness->data, m * m);
}

static void take_vectors(const Vectors *v, const Coordinates *c, const Pencil *p)
{
    for (int j = 0; j < p->m; j++) {
        const int column = c->at[c->still + j];

        v->out->square[column] = p->square->data[j];
        for (int i = 0; i < p->m; i++) {
            const double x = p->vector->data[i * p->m + j] * p->scale[i];

            v->out->vector[c->at[c->still + i] * v->n + column] = x;
            for (int z = 0; z < c->still; z++)
                v->out->vector[c->at[z] * v->n + column] -= p->along[i * c->still + z] * x;
        }
    }
}

/* K x = square M x of those that meet stiffness; false: no convergence, or M isn't definite */
static bool solve_others(const Vectors *v, const Coordinates *c, const double *l)
{
    const int m = c->count - c->still;
    const size_t size = (size_t)m;
    Pencil p = {m,
                dense_matrix(size, size),
                dense_matrix(size, size),
                dense_matrix(size, size),
                dense_vector(size),
                NEW_ARRAY(double, m * c->still),
                NEW_ARRAY(double, m)};
    gsl_eigen_gensymmv_workspace *work;
    bool sound;

    for (int j = 0; j < m; j++)
        follow_still(v, c, l, c->still + j, p.along + (ptrdiff_t)j * c->still);
    sound = fill_pencil(v, c, &p);
    /* no call of memory.h while GSL's workspace is allocated */
    work = sound ? gsl_eigen_gensymmv_alloc(size) : NULL;
    sound = work != NULL && gsl_eigen_gensymmv(p.stiffness, p.mass, p.square, p.vector, work) == 0;
    gsl_eigen_gensymmv_free(work);
    if (sound)
        take_vectors(v, c, &p);
    MEM_FREE(p.stiffness, p.mass, p.vector, p.square, p.along, p.scale);
    return sound;
}

/* Eigenvectors of coordinates that act on each other. gensymmv() returns them with length 1, so
 * they are scaled to x^T M x = 1 afterwards. */
static bool solve_some(const Vectors *v, const int *at, int count, const bool *meets)
{
    int *order = NEW_ARRAY(int, count);
    Coordinates c = {order, 0, count};
    double *l;
    bool sound;

    for (int pass = 0, next = 0; pass < 2; pass++)
        for (int i = 0; i < count; i++)
            if (meets[at[i]] == (pass == 1)) {
                order[next++] = at[i];
                c.still += pass == 0;
            }
    l = NEW_ARRAY(double, c.still *c.still);
    sound = base_of_still(v, &c, l) && (c.still == count || solve_others(v, &c, l));
    MEM_FREE(order, l);
    return sound;
}

static void normalise(const Vectors *v)
{
    const int n = v->n;
    double *moved = NEW_ARRAY(double, n), *x = NEW_ARRAY(double, n);

    for (int k = 0; k < n; k++) {
        double size = 0;

        for (int i = 0; i < n; i++)
            x[i] = v->out->vector[i * n + k];
        matrix_times(v->mass, n, n, x, moved);
        for (int i = 0; i < n; i++)
            size += x[i] * moved[i];
        for (int i = 0; i < n && size > 0; i++)
            v->out->vector[i * n + k] /= sqrt(size);
    }
    MEM_FREE(moved, x);
}

static bool is_there(BoundedMatrix m, int at)
{
    return m.at[at] != 0 || m.error[at] != 0;
}

static bool find_vectors(const Vectors *v, BoundedMatrix mass, BoundedMatrix stiffness,
                         const BoundedMatrix *damping)
{
    const int n = v->n;
    bool *pattern = NEW_ARRAY(bool, n *n), *meets = NEW_ARRAY(bool, n), sound = true;
    BlockTriangular blocks;

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const bool is_stiff = is_there(stiffness, i * n + j);

            meets[i] = meets[i] || is_stiff;
            meets[j] = meets[j] || is_stiff;
            if (is_stiff || is_there(mass, i * n + j) ||
                (damping != NULL && is_there(*damping, i * n + j)))
                pattern[i * n + j] = pattern[j * n + i] = true;
        }
    blocks = block_triangular_find(pattern, n);
    for (int b = 0; b < blocks.count && sound; b++)
        sound = solve_some(v, blocks.order + blocks.start[b], blocks.start[b + 1] - blocks.start[b],
                           meets);
    if (sound)
        normalise(v);
    block_triangular_free(&blocks);
    MEM_FREE(pattern, meets);
    return sound;
}

/* --- residuals --- */

/* of the present vectors */
typedef struct Residuals {
    int n;
    double *moved;     /* M X, rounded */
    double *rest;      /* R, rounded */
    double *projected; /* X^T R */
    double *gram;      /* X^T M X - 1 */
} Residuals;

static void residuals_open(Residuals *r, int n)
{
    *r = (Residuals){n, NEW_ARRAY(double, n *n), NEW_ARRAY(double, n *n), NEW_ARRAY(double, n *n),
                     NEW_ARRAY(double, n *n)};
}

static void residuals_close(const Residuals *r)
{
    MEM_FREE(r->moved, r->rest, r->projected, r->gram);
}

static void find_residuals(const Modal *m, const double *mass, const double *stiffness,
                           const Residuals *r)
{
    const int n = m->n;
    double *low = NEW_ARRAY(double, n *n), *moved_low = NEW_ARRAY(double, n *n);

    multiply_dd(mass, m->vector, n, n, n, r->moved, moved_low);
    multiply_dd(stiffness, m->vector, n, n, n, r->rest, low);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            const int at = i * n + k;
            const DoubleDouble y = dd_tidy(r->moved[at], moved_low[at]);

            r->rest[at] =
                dd_double(dd_sub(dd_tidy(r->rest[at], low[at]), dd_times(y, m->square[k])));
            r->moved[at] = dd_double(y);
        }
    multiply(CblasTrans, m->vector, r->rest, n, n, r->projected);
    multiply(CblasTrans, m->vector, r->moved, n, n, r->gram);
    for (int i = 0; i < n; i++)
        r->gram[i * n + i] -= 1;
    MEM_FREE(low, moved_low);
}

/* X (1 + Z), Z of first order; rigid modes mix only with each other, so that their columns remain
 * 0 */
static void correct(const Modal *m, const Residuals *r)
{
    const int n = m->n;
    double *z = NEW_ARRAY(double, n *n), *by = NEW_ARRAY(double, n *n);

    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++) {
            const double gap = m->square[j] - m->square[k], half = -r->gram[k * n + j] / 2;
            const double turn = r->projected[k * n + j] / gap;

            if (m->is_still[j] && !m->is_still[k])
                continue;
            z[k * n + j] = k != j && fabs(turn) < MODAL_SMALL ? turn : half;
        }
    multiply(CblasNoTrans, m->vector, z, n, n, by);
    for (int i = 0; i < n * n; i++)
        m->vector[i] += by[i];
    for (int k = 0; k < n; k++)
        m->square[k] += m->is_still[k] ? 0 : r->projected[k * n + k] / (1 + r->gram[k * n + k]);
    MEM_FREE(z, by);
}

/* --- bounds --- */

/* error bound of X^T R: |X|^T (|R| rounded + |dK| |X| + |dM| |X| |L|) */
static void bound_residual(const Modal *m, const Residuals *r, const double *x, BoundedMatrix mass,
                           BoundedMatrix stiffness, double *out)
{
    const int n = m->n;
    double *entries = entry_errors(stiffness, n * n), *v = NEW_ARRAY(double, n *n);
    double *other = NEW_ARRAY(double, n *n);

    multiply(CblasNoTrans, entries, x, n, n, v);
    mem_free(entries);
    entries = entry_errors(mass, n * n);
    multiply(CblasNoTrans, entries, x, n, n, other);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            v[i * n + k] += other[i * n + k] * fabs(m->square[k]) +
                            (n + 2) * UNIT_ROUNDOFF * fabs(r->rest[i * n + k]);
    multiply(CblasTrans, x, v, n, n, out);
    MEM_FREE(entries, v, other);
}

/* how far X^T M X may be from 1 */
static void bound_skew(Modal *m, const Residuals *r, const double *x, BoundedMatrix mass)
{
    const int n = m->n;
    double *entries = entry_errors(mass, n * n), *v = NEW_ARRAY(double, n *n);

    multiply(CblasNoTrans, entries, x, n, n, v);
    for (int i = 0; i < n * n; i++)
        v[i] += (n + 2) * UNIT_ROUNDOFF * fabs(r->moved[i]);
    multiply(CblasTrans, x, v, n, n, m->skew);
    for (int i = 0; i < n; i++) {
        double sum = 0;

        for (int k = 0; k < n; k++) {
            m->skew[i * n + k] = MODAL_MARGIN * (m->skew[i * n + k] + fabs(r->gram[i * n + k])) +
                                 (i == k ? 2 * UNIT_ROUNDOFF : 0);
            sum += m->skew[i * n + k];
        }
        if (!(sum <= m->skewed) && !isnan(m->skewed)) /* NaN is preserved */
            m->skewed = sum;
    }
    MEM_FREE(entries, v);
}

/* Of G^-1 h in the place of h: error becomes that. G^-1 - 1 is within sum over j > 0 of skew^j. */
static void allow_skew(const Modal *m, const double *h, double *error, int columns)
{
    const int n = m->n;
    double *all = NEW_ARRAY(double, n *columns), *more = NEW_ARRAY(double, n *columns);

    for (int i = 0; i < n * columns; i++)
        all[i] = fabs(h[i]) + error[i];
    multiply(CblasNoTrans, m->skew, all, n, columns, more);
    for (int k = 0; k < columns; k++) {
        double largest = 0;

        for (int i = 0; i < n; i++)
            largest = fmax(largest, more[i * columns + k]);
        largest *= m->skewed / (1 - m->skewed);
        for (int i = 0; i < n; i++)
            error[i * columns + k] =
                MODAL_MARGIN * (error[i * columns + k] + more[i * columns + k] + largest);
    }
    MEM_FREE(all, more);
}

static void find_bounds(Modal *m, const Residuals *r, BoundedMatrix mass, BoundedMatrix stiffness)
{
    const int n = m->n;
    double *x = sizes(m->vector, n * n);

    bound_skew(m, r, x, mass);
    bound_residual(m, r, x, mass, stiffness, m->error);
    mem_free(x);
    if (!(m->skewed < 1))
        return;
    allow_skew(m, r->projected, m->error, n);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            const double entry = r->projected[i * n + k];

            m->off[i * n + k] = i == k ? 0 : entry;
            if (i != k)
                continue;
            m->square[k] += entry;
            m->error[i * n + k] += UNIT_ROUNDOFF * fabs(m->square[k]);
        }
}

/* --- modal coordinates --- */

/* new: the symmetric part */
static double *symmetric(const double *a, int n)
{
    double *out = NEW_ARRAY(double, n *n);

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            out[i * n + j] = a[i * n + j] / 2 + a[j * n + i] / 2;
    return out;
}

static Modal *modal_open(int n)
{
    Modal *m = NEW(Modal);

    m->n = n;
    m->vector = NEW_ARRAY(double, n *n);
    m->square = NEW_ARRAY(double, n);
    m->off = NEW_ARRAY(double, n *n);
    m->error = NEW_ARRAY(double, n *n);
    m->skew = NEW_ARRAY(double, n *n);
    m->is_still = NEW_ARRAY(bool, n);
    return m;
}

Modal *modal_new(BoundedMatrix mass, BoundedMatrix stiffness, const BoundedMatrix *damping, int n)
{
    Modal *m = modal_open(n);
    double *even_mass = symmetric(mass.at, n), *even = symmetric(stiffness.at, n);
    const Vectors vectors = {n, even_mass, even, m};
    Residuals r;
    bool sound = n <= MOST && vector_is_finite(even_mass, n * n) && vector_is_finite(even, n * n);

    residuals_open(&r, n);
    sound = sound && find_vectors(&vectors, mass, stiffness, damping);
    for (int i = 0; i < CORRECTIONS && sound; i++) {
        find_residuals(m, even_mass, even, &r);
        correct(m, &r);
    }
    if (sound) {
        find_residuals(m, mass.at, stiffness.at, &r);
        find_bounds(m, &r, mass, stiffness);
    }
    sound = sound && m->skewed < 1 && vector_is_finite(m->vector, n * n) &&
            vector_is_finite(m->square, n) && vector_is_finite(m->error, n * n);
    residuals_close(&r);
    MEM_FREE(even_mass, even);
    if (sound)
        return m;
    modal_free(m);
    return NULL;
}

void modal_free(Modal *m)
{
    if (m == NULL)
        return;
    MEM_FREE(m->vector, m->square, m->off, m->error, m->is_still, m->skew, m);
}

void modal_transform(const Modal *m, BoundedMatrix b, int columns, double *out, double *out_error)
{
    const int n = m->n;
    double *across = NEW_ARRAY(double, n *n), *low = NEW_ARRAY(double, n *columns);
    double *off = entry_errors(b, n * columns);

    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            across[k * n + i] = m->vector[i * n + k];
    multiply_dd(across, b.at, n, n, columns, out, low);
    for (int i = 0; i < n * n; i++)
        across[i] = fabs(across[i]);
    multiply(CblasNoTrans, across, off, n, columns, out_error);
    for (int i = 0; i < n * columns; i++) {
        out[i] += low[i];
        out_error[i] = MODAL_MARGIN * out_error[i] + UNIT_ROUNDOFF * fabs(out[i]);
    }
    allow_skew(m, out, out_error, columns);
    MEM_FREE(across, low, off);
}

void modal_move(const Modal *m, BoundedMatrix b, int rows, double *out, double *out_error)
{
    const int n = m->n;
    double *x = sizes(m->vector, n * n), *low = NEW_ARRAY(double, rows *n);
    double *off = entry_errors(b, rows * n);

    multiply_dd(b.at, m->vector, rows, n, n, out, low);
    multiply_some(CblasNoTrans, off, x, rows, n, n, out_error);
    for (int i = 0; i < rows * n; i++) {
        out[i] += low[i];
        out_error[i] = MODAL_MARGIN * out_error[i] + UNIT_ROUNDOFF * fabs(out[i]);
    }
    MEM_FREE(x, low, off);
}
