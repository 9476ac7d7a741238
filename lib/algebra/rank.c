/* rank.c: rank decisions by pivoted QR */
#include "algebra/rank.h"

#include "base/memory.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define THRESHOLD 1e-9

typedef struct Pivoted {
    gsl_matrix *qr;
    gsl_vector *tau;
    gsl_permutation *order;
    int rank;
} Pivoted;

static Pivoted factor(gsl_matrix *matrix, double threshold)
{
    size_t least = matrix->size1 < matrix->size2 ? matrix->size1 : matrix->size2;
    Pivoted p = {.qr = matrix,
                 .tau = gsl_vector_alloc(least),
                 .order = gsl_permutation_alloc(matrix->size2)};
    gsl_vector *norms = gsl_vector_alloc(matrix->size2);
    int sign = 0;

    (void)gsl_linalg_QRPT_decomp(matrix, p.tau, p.order, &sign, norms);
    while (p.rank < (int)least && fabs(gsl_matrix_get(matrix, (size_t)p.rank, (size_t)p.rank)) >
                                      threshold * fabs(gsl_matrix_get(matrix, 0, 0)))
        p.rank++;
    gsl_vector_free(norms);
    return p;
}

static void release(Pivoted *p)
{
    gsl_matrix_free(p->qr);
    gsl_vector_free(p->tau);
    gsl_permutation_free(p->order);
}

static int rising(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

static double row_norm(const double *row, int n)
{
    double norm = 0;

    for (int j = 0; j < n; j++)
        norm = hypot(norm, row[j]);
    return norm;
}

/* rows of the matrix (NULL: all of them) as columns of unit size; new */
static gsl_matrix *unit_rows(const double *matrix, int nu, const int *rows, int count)
{
    gsl_matrix *out = gsl_matrix_alloc((size_t)nu, (size_t)count);
    double largest = 0;

    for (int k = 0; k < count; k++)
        largest = fmax(largest, row_norm(matrix + (rows != NULL ? rows[k] : k) * nu, nu));
    for (int k = 0; k < count; k++) {
        const double *row = matrix + (rows != NULL ? rows[k] : k) * nu;
        double norm = row_norm(row, nu);
        bool is_zero = !(norm > 1e-10 * largest); /* rounding alone */

        for (int j = 0; j < nu; j++)
            gsl_matrix_set(out, (size_t)j, (size_t)k, is_zero ? 0 : row[j] / norm);
    }
    return out;
}

/* the first `count` in order of pivots, rising, then the others, rising */
static void put_order(const Pivoted *p, int m, int count, int *order)
{
    for (int k = 0; k < m; k++)
        order[k] = (int)gsl_permutation_get(p->order, (size_t)k);
    qsort(order, (size_t)count, sizeof(int), rising);
    qsort(order + count, (size_t)(m - count), sizeof(int), rising);
}

int rank_rows(const double *matrix, int m, int nu, double threshold, int *order)
{
    Pivoted p;

    if (m == 0 || nu == 0) {
        for (int k = 0; k < m && order != NULL; k++)
            order[k] = k;
        return 0;
    }
    p = factor(unit_rows(matrix, nu, NULL, m), threshold);
    if (order != NULL)
        put_order(&p, m, p.rank, order);
    release(&p);
    return p.rank;
}

static double pivot_ratio(const Pivoted *p, int count)
{
    const double first = fabs(gsl_matrix_get(p->qr, 0, 0));
    const double last = fabs(gsl_matrix_get(p->qr, (size_t)count - 1, (size_t)count - 1));

    return first > 0 ? last / first : 0;
}

double rank_choose(const double *matrix, int m, int nu, int count, int *rows)
{
    int *order;
    double ratio;
    Pivoted p;

    if (count == 0)
        return 1;
    order = NEW_ARRAY(int, m);
    p = factor(unit_rows(matrix, nu, NULL, m), 0);
    put_order(&p, m, count, order);
    for (int k = 0; k < count; k++)
        rows[k] = order[k];
    ratio = pivot_ratio(&p, count);
    release(&p);
    mem_free(order);
    return ratio;
}

double rank_ratio(const double *matrix, int nu, const int *rows, int count)
{
    double ratio;
    Pivoted p;

    if (count == 0)
        return 1;
    p = factor(unit_rows(matrix, nu, rows, count), 0);
    ratio = pivot_ratio(&p, count);
    release(&p);
    return ratio;
}

void rank_least_multipliers(const double *phi_u, int m, int nu, double *lambda)
{
    gsl_vector_view v;
    gsl_matrix *copy;
    Pivoted p;

    if (m == 0 || nu == 0)
        return;
    copy = gsl_matrix_alloc((size_t)m, (size_t)nu);
    for (int k = 0; k < m; k++)
        for (int j = 0; j < nu; j++)
            gsl_matrix_set(copy, (size_t)k, (size_t)j, phi_u[k * nu + j]);
    p = factor(copy, THRESHOLD);
    v = gsl_vector_view_array(lambda, (size_t)m);
    (void)gsl_linalg_QR_QTvec(p.qr, p.tau, &v.vector);
    for (int k = p.rank; k < m; k++)
        lambda[k] = 0;
    (void)gsl_linalg_QR_Qvec(p.qr, p.tau, &v.vector);
    release(&p);
}
