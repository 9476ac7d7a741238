/* eigen.c: eigenvalues of real matrices
 *
 * By the Francis method on the balanced matrix (GSL), a part of the matrix at a time: states that
 * act on each other both ways are a part. */
#include "simulate/eigen.h"

#include "base/memory.h"
#include "simulate/rows.h"

#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <math.h>

#define ROUNDING      1e-14 /* of the largest entry of its kind */
#define ROOT_ROUNDING 1e-7  /* of the largest eigenvalue */

/* --- what is rounding --- */

static int kind_of(const Linear *linear, int state)
{
    return state < linear->freedoms ? 0 : state < 2 * linear->freedoms ? 1 : 2;
}

/* balancing would make rounding as large as the rest (Watkins 2006) */
void linear_clean(const Linear *linear, double *a)
{
    int n = linear->states;
    double largest[3][3] = {{0}};

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double *most = &largest[kind_of(linear, i)][kind_of(linear, j)];

            *most = fmax(*most, fabs(linear->a[i * n + j]));
        }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double entry = linear->a[i * n + j];
            double least = ROUNDING * largest[kind_of(linear, i)][kind_of(linear, j)];

            a[i * n + j] = fabs(entry) > least ? entry : 0;
        }
}

void linear_clean_vector(const Linear *linear, const double *from, int stride, double *out)
{
    double largest[3] = {0};

    for (int i = 0; i < linear->states; i++)
        largest[kind_of(linear, i)] =
            fmax(largest[kind_of(linear, i)], fabs(from[(ptrdiff_t)i * stride]));
    for (int i = 0; i < linear->states; i++) {
        double entry = from[(ptrdiff_t)i * stride];

        out[i] = fabs(entry) > ROUNDING * largest[kind_of(linear, i)] ? entry : 0;
    }
}

/* --- zeros --- */

void eigen_set_zeros(const double *a, int n, gsl_vector_complex *values)
{
    double *right = NEW_ARRAY(double, n), *none = NEW_ARRAY(double, n);
    double largest = 0;
    int lacking = n - rows_solve(a, n, n, right, none);

    for (size_t i = 0; i < (size_t)n; i++)
        largest = fmax(largest, gsl_complex_abs(gsl_vector_complex_get(values, i)));
    for (int k = 0; k < 2 * lacking && k < n; k++) {
        size_t least = 0;
        double size = INFINITY;

        for (size_t i = 0; i < (size_t)n; i++) {
            double abs_i = gsl_complex_abs(gsl_vector_complex_get(values, i));

            if (abs_i > 0 && abs_i < size) {
                size = abs_i;
                least = i;
            }
        }
        if (size < ROOT_ROUNDING * largest)
            gsl_vector_complex_set(values, least, gsl_complex_rect(0, 0));
    }
    mem_free(right);
    mem_free(none);
}

/* --- parts --- */

/* part[i]: the least state that i acts on and that acts on i (Warshall 1962) */
static void find_parts(const double *a, int n, int *part)
{
    bool *reaches = NEW_ARRAY(bool, n *n);

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            reaches[i * n + j] = i == j || a[i * n + j] != 0;
    for (int k = 0; k < n; k++)
        for (int i = 0; i < n; i++)
            for (int j = 0; reaches[i * n + k] && j < n; j++)
                reaches[i * n + j] = reaches[i * n + j] || reaches[k * n + j];
    for (int i = 0; i < n; i++) {
        part[i] = 0;
        while (!(reaches[i * n + part[i]] && reaches[part[i] * n + i]))
            part[i]++;
    }
    mem_free(reaches);
}

/* of a matrix whose states all act on each other */
static bool values_of_part(const double *a, int n, Root *out)
{
    gsl_matrix *copy = gsl_matrix_alloc((size_t)n, (size_t)n);
    gsl_vector_complex *values = gsl_vector_complex_alloc((size_t)n);
    gsl_eigen_nonsymm_workspace *work = gsl_eigen_nonsymm_alloc((size_t)n);
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    int code;

    for (int k = 0; k < n * n; k++)
        copy->data[k] = a[k];
    gsl_eigen_nonsymm_params(0, 1, work);
    code = gsl_eigen_nonsymm(copy, values, work);
    (void)gsl_set_error_handler(handler);
    eigen_set_zeros(a, n, values);
    for (int i = 0; i < n; i++) {
        gsl_complex value = gsl_vector_complex_get(values, (size_t)i);

        out[i] = (Root){GSL_REAL(value), GSL_IMAG(value)};
    }
    gsl_matrix_free(copy);
    gsl_vector_complex_free(values);
    gsl_eigen_nonsymm_free(work);
    return code == GSL_SUCCESS;
}

bool eigen_values(const double *a, int n, Root *out)
{
    int *part = NEW_ARRAY(int, n), *members = NEW_ARRAY(int, n);
    double *piece = NEW_ARRAY(double, n *n);
    int found = 0;
    bool sound = true;

    find_parts(a, n, part);
    for (int p = 0; p < n && sound; p++) {
        int size = 0;

        for (int i = 0; i < n; i++)
            if (part[i] == p)
                members[size++] = i;
        for (int i = 0; i < size; i++)
            for (int j = 0; j < size; j++)
                piece[i * size + j] = a[members[i] * n + members[j]];
        if (size == 1)
            out[found] = (Root){piece[0], 0};
        else if (size > 1)
            sound = values_of_part(piece, size, out + found);
        found += size;
    }
    mem_free(part);
    mem_free(members);
    mem_free(piece);
    return sound;
}
