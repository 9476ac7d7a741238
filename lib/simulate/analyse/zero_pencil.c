/* zero_pencil.c: null vectors of [A - z b; c d] by inverse iteration, and the effect of errors dP
 * of its entries on z: |dz| <= |l|^T |dP| |r| / |l_x^T x|, where l and r are the left and right
 * null vectors, l_x and x their entries for states (Stewart and Sun 1990, chapter VI). */
#include "simulate/analyse/zero_pencil.h"

#include "algebra/algebra_limits.h"
#include "algebra/roots.h"
#include "base/memory.h"
#include "simulate/analyse/analyse_limits.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { SWEEPS = 3 };

typedef double complex Complex;

/* row by row, m x m; transposed: columns for rows */
static Complex *pencil_new(const Siso *s, Complex z, bool transposed)
{
    const int n = s->n, m = n + 1;
    Complex *p = mem_array((size_t)m * (size_t)m, sizeof *p);

    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++) {
            const double entry = i < n ? j < n ? s->a[i * n + j] : s->b[i] : j < n ? s->c[j] : s->d;

            p[transposed ? j * m + i : i * m + j] = entry - (i == j && i < n ? z : 0);
        }
    return p;
}

/* P = L U with exchanged rows; a pivot of 0 is replaced by rounding error */
static void factor(Complex *p, int m, int *pivot)
{
    double norm = 0;

    for (int i = 0; i < m * m; i++)
        norm = fmax(norm, cabs(p[i]));
    norm = fmax(norm * UNIT_ROUNDOFF, DBL_MIN);
    for (int k = 0; k < m; k++) {
        pivot[k] = k;
        for (int i = k + 1; i < m; i++)
            if (cabs(p[i * m + k]) > cabs(p[pivot[k] * m + k]))
                pivot[k] = i;
        for (int j = 0; j < m && pivot[k] != k; j++) {
            const Complex kept = p[k * m + j];

            p[k * m + j] = p[pivot[k] * m + j];
            p[pivot[k] * m + j] = kept;
        }
        if (cabs(p[k * m + k]) < norm)
            p[k * m + k] = norm;
        for (int i = k + 1; i < m; i++) {
            p[i * m + k] /= p[k * m + k];
            for (int j = k + 1; j < m && p[i * m + k] != 0; j++)
                p[i * m + j] -= p[i * m + k] * p[k * m + j];
        }
    }
}

static void solve(const Complex *p, int m, const int *pivot, Complex *v)
{
    for (int k = 0; k < m; k++) {
        const Complex kept = v[k];

        v[k] = v[pivot[k]];
        v[pivot[k]] = kept;
    }
    for (int i = 0; i < m; i++)
        for (int j = 0; j < i; j++)
            v[i] -= p[i * m + j] * v[j];
    for (int i = m - 1; i >= 0; i--) {
        for (int j = i + 1; j < m; j++)
            v[i] -= p[i * m + j] * v[j];
        v[i] /= p[i * m + i];
    }
}

/* null vector of length 1 of a nearly singular matrix, which is overwritten by its factors */
static void null_vector(Complex *p, int m, Complex *v)
{
    int *pivot = NEW_ARRAY(int, m);

    factor(p, m, pivot);
    for (int i = 0; i < m; i++)
        v[i] = 1 + 0.5 * disturbance(i, 0) + 0.5 * I * disturbance(0, i);
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double largest = 0;

        solve(p, m, pivot, v);
        for (int i = 0; i < m; i++)
            largest = fmax(largest, cabs(v[i]));
        for (int i = 0; i < m; i++)
            v[i] /= largest;
    }
    mem_free(pivot);
}

static double off(double value, double error)
{
    return fmax(error, UNIT_ROUNDOFF * fabs(value));
}

/* |l|^T |dP| |r| */
static double moved(const Siso *s, const Complex *left, const Complex *right)
{
    const int n = s->n;
    double sum = 0;

    for (int i = 0; i <= n; i++) {
        double row = i < n ? off(s->b[i], s->b_error[i]) : off(s->d, s->d_error);

        row *= cabs(right[n]);
        for (int j = 0; j < n; j++)
            row += cabs(right[j]) * (i < n ? off(s->a[i * n + j], s->a_error[i * n + j])
                                           : off(s->c[j], s->c_error[j]));
        sum += cabs(left[i]) * row;
    }
    return sum;
}

/* |l^T P r| */
static double left_over(const Complex *p, int m, const Complex *left, const Complex *right)
{
    Complex sum = 0;

    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++)
            sum += left[i] * p[i * m + j] * right[j];
    return cabs(sum);
}

double zero_pencil_error(const Siso *s, double complex z)
{
    const int m = s->n + 1;
    Complex *p = pencil_new(s, z, false), *turned = pencil_new(s, z, true);
    Complex *factors = mem_array((size_t)m * (size_t)m, sizeof *factors);
    Complex *left = mem_array((size_t)m, sizeof *left),
            *right = mem_array((size_t)m, sizeof *right);
    Complex slope = 0;
    double by;

    memcpy(factors, p, (size_t)m * (size_t)m * sizeof *factors);
    null_vector(factors, m, right);
    null_vector(turned, m, left);
    for (int i = 0; i < s->n; i++)
        slope += left[i] * right[i];
    by = moved(s, left, right) + left_over(p, m, left, right);
    MEM_FREE(p, turned, factors, left, right);
    return slope != 0 ? by / cabs(slope) + UNIT_ROUNDOFF * cabs(z) : INFINITY;
}
