/* enclosure.c: eigenvalues by the Francis method, corrected by their residual
 *
 * With vectors X and values L found in doubles, Y nearly the inverse of X and R = A X - X L, formed
 * in numbers of twice the digits, X^-1 A X = L + (Y X)^-1 Y R. The term added to L is of the size
 * of rounding. Its diagonal corrects L; its other entries move an eigenvalue by their square over
 * its distance from the next one. Discs about the diagonal bound that, row and column k scaled
 * against the others (Gershgorin 1931; Wilkinson 1965, 2.15). */
#include "algebra/enclosure.h"

#include "algebra/algebra_limits.h"
#include "algebra/dense.h"
#include "base/memory.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <string.h>

/* --- in doubles --- */

/* Eigenvalues and eigenvectors; false when the iteration doesn't converge or GSL is out of
 * memory. */
static bool francis(const DoubleDouble *a, Enclosure *e)
{
    const size_t count = (size_t)e->n;
    gsl_matrix *matrix = dense_matrix(count, count);
    gsl_vector_complex_view value = gsl_vector_complex_view_array((double *)e->value, count);
    gsl_matrix_complex_view right = gsl_matrix_complex_view_array((double *)e->right, count, count);
    /* no call of memory.h while GSL's workspace is allocated */
    gsl_eigen_nonsymmv_workspace *work = gsl_eigen_nonsymmv_alloc(count);
    bool sound = work != NULL;

    for (int i = 0; i < e->n * e->n; i++)
        matrix->data[i] = a[i].high;
    sound = sound && gsl_eigen_nonsymmv(matrix, &value.vector, &right.matrix, work) == 0;
    gsl_eigen_nonsymmv_free(work);
    mem_free(matrix);
    return sound;
}

/* `left` becomes the inverse of `right`; false: it is singular */
static bool invert(Enclosure *e)
{
    const size_t count = (size_t)e->n;
    double complex *factors = mem_array(count * count, sizeof *factors);
    gsl_matrix_complex_view lu = gsl_matrix_complex_view_array((double *)factors, count, count);
    gsl_matrix_complex_view left = gsl_matrix_complex_view_array((double *)e->left, count, count);
    gsl_permutation *order = dense_permutation(count);
    int sign;
    bool sound;

    memcpy(factors, e->right, count * count * sizeof *factors);
    sound = gsl_linalg_complex_LU_decomp(&lu.matrix, order, &sign) == 0;
    for (size_t k = 0; k < count; k++)
        sound = sound && cabs(factors[k * count + k]) > UNIT_ROUNDOFF;
    sound = sound && gsl_linalg_complex_LU_invert(&lu.matrix, order, &left.matrix) == 0;
    MEM_FREE(factors, order);
    return sound;
}

/* --- the remainder --- */

/* value k is the conjugate of the one before */
static bool is_mirror(const Enclosure *e, int k)
{
    return k > 0 && cimag(e->value[k]) < 0 && e->value[k] == conj(e->value[k - 1]);
}

static void copy_mirror(double complex *matrix, int n, int k)
{
    for (int i = 0; i < n; i++)
        matrix[i * n + k] = conj(matrix[i * n + k - 1]);
}

/* A X - X L */
static void find_residual(const DoubleDouble *a, const Enclosure *e, double complex *out)
{
    const int n = e->n;
    DoubleDoubleComplex *sum = NEW_ARRAY(DoubleDoubleComplex, n);

    for (int k = 0; k < n; k++) {
        if (is_mirror(e, k)) {
            copy_mirror(out, n, k);
            continue;
        }
        for (int i = 0; i < n; i++) {
            const DoubleDoubleComplex x = dd_from(e->right[i * n + k]);

            sum[i] = dd_cneg(dd_cmul(dd_from(e->value[k]), x));
            for (int j = 0; j < n; j++) {
                const DoubleDouble entry = a[i * n + j];
                const double complex other = e->right[j * n + k];

                if (entry.high == 0)
                    continue;
                sum[i].re = dd_add(sum[i].re, dd_times(entry, creal(other)));
                if (cimag(e->value[k]) != 0)
                    sum[i].im = dd_add(sum[i].im, dd_times(entry, cimag(other)));
            }
            out[i * n + k] = dd_to(sum[i]);
        }
    }
    mem_free(sum);
}

/* out = a b */
static void multiply(int n, const double complex *a, const double complex *b, double complex *out)
{
    const double complex one = 1, none = 0;

    cblas_zgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, n, n, &one, a, n, b, n, &none, out,
                n);
}

/* --- bounds --- */

static double largest_row(const double complex *a, int n)
{
    double largest = 0;

    for (int i = 0; i < n; i++) {
        double sum = 0;

        for (int j = 0; j < n; j++)
            sum += cabs(a[i * n + j]);
        if (!(sum <= largest) && !isnan(largest))
            largest = sum; /* NaN is preserved */
    }
    return largest;
}

static double largest_of_column(const double complex *a, int n, int k)
{
    double largest = 0;

    for (int i = 0; i < n; i++)
        largest = fmax(largest, cabs(a[i * n + k]));
    return largest;
}

/* Sizes of the entries of the term added to L, from Y R: (Y X)^-1 is within 2 `inexact` of 1. */
static bool find_sizes(const Enclosure *e, const double complex *residual,
                       const double complex *projected, double norm, double *size)
{
    const int n = e->n;
    double complex *unity = mem_array((size_t)n * (size_t)n, sizeof *unity);
    const double left = largest_row(e->left, n);
    double inexact;

    multiply(n, e->left, e->right, unity);
    for (int i = 0; i < n; i++)
        unity[i * n + i] -= 1;
    inexact = largest_row(unity, n) + 4 * n * UNIT_ROUNDOFF * left * largest_row(e->right, n);
    for (int i = 0; i < n * n; i++)
        e->turn_left[i] = 2 * (cabs(unity[i]) + 4 * n * UNIT_ROUNDOFF * left);
    for (int k = 0; k < n; k++) {
        const double rounded = left * (4 * n * UNIT_ROUNDOFF * largest_of_column(residual, n, k) +
                                       4 * n * DOUBLE_DOUBLE_ROUNDING * norm);
        const double off = rounded + 2 * inexact * (largest_of_column(projected, n, k) + rounded);

        for (int i = 0; i < n; i++)
            size[i * n + k] = cabs(projected[i * n + k]) + off;
        e->error[k] = off;
    }
    mem_free(unity);
    return inexact < 0.1;
}

static double apart(const Enclosure *e, int i, int k)
{
    return cabs(e->value[i] - e->value[k]);
}

/* W: (L + E)(1 + w) = l (1 + w) for column k, |E| being `size`, has w_j (l - L_j) = E_jk + sum over
 * i of E_ji w_i, in which rows reach a quarter of the distance at most, so that no w_i is more than
 * twice the largest of first order. */
static void turn_right(const Enclosure *e, const double *size, const double *reach)
{
    const int n = e->n;

    for (int k = 0; k < n; k++) {
        double largest = 0;

        for (int j = 0; j < n; j++)
            if (j != k)
                largest = fmax(largest, 2 * size[j * n + k] / apart(e, j, k));
        for (int j = 0; j < n; j++)
            e->turn_right[j * n + k] =
                j == k ? 0 : (2 * size[j * n + k] + 4 * reach[j] * largest) / apart(e, j, k);
    }
}

/* Z: (1 + W)^-1 - 1 plus the error of `left` as an inverse; false: not bounded */
static bool turn_left(const Enclosure *e)
{
    const int n = e->n;
    double *column = NEW_ARRAY(double, n), widest = 0;

    for (int i = 0; i < n; i++) {
        double sum = 0;

        for (int k = 0; k < n; k++) {
            sum += e->turn_right[i * n + k];
            column[k] = fmax(column[k], e->turn_right[i * n + k]);
        }
        if (!(sum <= widest) && !isnan(widest))
            widest = sum; /* NaN is preserved */
    }
    for (int i = 0; i < n && widest < 0.1; i++)
        for (int k = 0; k < n; k++)
            e->turn_left[i * n + k] += 2 * (e->turn_right[i * n + k] + widest * column[k]);
    mem_free(column);
    return widest < 0.1;
}

/* No disc reaches farther than a quarter of the way to the next eigenvalue. With row k multiplied
 * and column k divided by `scale`, the other discs remain within half of that way, and disc k
 * becomes as small as that scale. */
static bool bound(const Enclosure *e, const double *size)
{
    const int n = e->n;
    double *reach = NEW_ARRAY(double, n);
    bool sound = true;

    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++)
            reach[k] += size[k * n + j];
    for (int k = 0; k < n && sound; k++) {
        double scale = 0;

        for (int j = 0; j < n && sound; j++) {
            if (j == k)
                continue;
            sound = reach[k] <= apart(e, j, k) / 4 && apart(e, j, k) > 0;
            scale = fmax(scale, 4 * size[j * n + k] / apart(e, j, k));
        }
        e->error[k] += scale * reach[k];
    }
    if (sound)
        turn_right(e, size, reach);
    mem_free(reach);
    return sound && turn_left(e);
}

/* --- an enclosure --- */

static bool correct(const DoubleDouble *a, Enclosure *e)
{
    const int n = e->n;
    double complex *residual = mem_array((size_t)n * (size_t)n, sizeof *residual);
    double complex *projected = mem_array((size_t)n * (size_t)n, sizeof *projected);
    double *size = NEW_ARRAY(double, n *n);
    double norm = 0;
    bool sound;

    for (int i = 0; i < n; i++) {
        double row = 0;

        for (int j = 0; j < n; j++)
            row += fabs(a[i * n + j].high);
        norm = fmax(norm, row);
    }
    find_residual(a, e, residual);
    multiply(n, e->left, residual, projected);
    sound = find_sizes(e, residual, projected, norm, size);
    /* real eigenvalues remain real; a conjugate one is recognised by the uncorrected one before
     * it */
    for (int k = n - 1; k >= 0; k--) {
        const double complex by = projected[k * n + k];

        if (is_mirror(e, k))
            e->value[k] += conj(projected[(k - 1) * n + k - 1]);
        else
            e->value[k] += cimag(e->value[k]) == 0 ? creal(by) : by;
    }
    sound = sound && bound(e, size);
    for (int k = 1; k < n && sound; k++)
        if (is_mirror(e, k))
            e->error[k] = e->error[k - 1];
    MEM_FREE(residual, projected, size);
    return sound;
}

bool enclosure_find(const DoubleDouble *a, int n, Enclosure *out)
{
    *out = (Enclosure){n,
                       mem_array((size_t)n, sizeof *out->value),
                       mem_array((size_t)n * (size_t)n, sizeof *out->right),
                       mem_array((size_t)n * (size_t)n, sizeof *out->left),
                       NEW_ARRAY(double, n),
                       NEW_ARRAY(double, n *n),
                       NEW_ARRAY(double, n *n)};
    return francis(a, out) && invert(out) && correct(a, out);
}

void enclosure_free(Enclosure *enclosure)
{
    MEM_FREE(enclosure->value, enclosure->right, enclosure->left, enclosure->error,
             enclosure->turn_right, enclosure->turn_left);
}
