/* bench_algebra.c: what lib/algebra does by hand, beside what a library does of the same
 *
 * bench_algebra SCRIPTS PROGRAM, which it has no use for. Matrices are those of a chain of bodies
 * in absolute coordinates: a plane body has three speeds and two rows of constraints, which move it
 * and the one before. */
#include "algebra/dense.h"
#include "algebra/hessenberg_form.h"
#include "algebra/linear.h"
#include "algebra/rank.h"
#include "algebra/sparse.h"
#include "base/memory.h"

#include "../random.h"
#include "bench.h"

#include <gsl/gsl_linalg.h>
#include <klu.h>
#include <stdlib.h>
#include <string.h>

enum { TRIES = 7, SPEEDS = 3, ROWS = 2 }; /* of a body */

/* rows of constraints of so many bodies; new */
static double *rows_of(int bodies)
{
    const int nu = SPEEDS * bodies;
    double *out = NEW_ARRAY(double, ROWS *bodies *nu);
    uint64_t seed = 1;

    for (int k = 0; k < ROWS * bodies; k++)
        for (int j = 0; j < 2 * SPEEDS; j++) {
            const int column = SPEEDS * (k / ROWS - 1) + j;

            if (column >= 0 && (j % SPEEDS == 2 || j % SPEEDS == k % ROWS))
                out[k * nu + column] = test_uniform(&seed, 0.5, 1.5);
        }
    return out;
}

/* [M G^T; G 0]; new */
static double *kkt_of(int bodies)
{
    const int nu = SPEEDS * bodies, m = ROWS * bodies, n = nu + m;
    double *rows = rows_of(bodies), *out = NEW_ARRAY(double, n *n);

    for (int i = 0; i < nu; i++)
        out[i * n + i] = 1 + i % SPEEDS;
    for (int k = 0; k < m; k++)
        for (int i = 0; i < nu; i++)
            out[(nu + k) * n + i] = out[i * n + nu + k] = rows[k * nu + i];
    mem_free(rows);
    return out;
}

static void line(const char *what, int size, const char *by, double seconds)
{
    char name[60];

    (void)snprintf(name, sizeof name, "algebra.%s_%d%s", what, size, by);
    bench_line(name, 1e6 * seconds, "us");
}

static int repeats(double entries)
{
    return 1 + (int)(3e5 / entries);
}

static void bench_lu(int bodies)
{
    const int n = (SPEEDS + ROWS) * bodies, count = repeats((double)n * n);
    const size_t bytes = (size_t)n * (size_t)n * sizeof(double);
    double *matrix = kkt_of(bodies), ours, theirs;
    Lu *lu = lu_new(n);
    gsl_matrix *gsl = dense_matrix((size_t)n, (size_t)n);
    gsl_vector *b = dense_vector((size_t)n);
    gsl_permutation *order = dense_permutation((size_t)n);

    BENCH_LEAST(
        TRIES, ours, for (int k = 0; k < count; k++) {
            memcpy(lu_matrix(lu), matrix, bytes);
            (void)lu_factor(lu);
            gsl_vector_set_all(b, 1);
            lu_solve(lu, b->data);
        });
    BENCH_LEAST(
        TRIES, theirs, for (int k = 0; k < count; k++) {
            int sign;

            memcpy(gsl->data, matrix, bytes);
            (void)gsl_linalg_LU_decomp(gsl, order, &sign);
            gsl_vector_set_all(b, 1);
            (void)gsl_linalg_LU_svx(gsl, order, b);
        });
    line("lu", n, "", ours / count);
    line("lu", n, "_gsl", theirs / count);
    lu_free(lu);
    mem_free(matrix);
    mem_free(gsl);
    mem_free(b);
    mem_free(order);
}

static void bench_cholesky(int bodies)
{
    const int m = ROWS * bodies, nu = SPEEDS * bodies, count = repeats((double)m * m);
    const size_t bytes = (size_t)m * (size_t)m * sizeof(double);
    double *rows = rows_of(bodies), *gram = NEW_ARRAY(double, m *m),
           *room = NEW_ARRAY(double, m *m);
    gsl_matrix_view view = gsl_matrix_view_array(room, (size_t)m, (size_t)m);
    double ours, theirs;

    matrix_gram(rows, m, nu, gram);
    BENCH_LEAST(
        TRIES, ours, for (int k = 0; k < count; k++) {
            memcpy(room, gram, bytes);
            (void)cholesky_factor(room, m);
        });
    BENCH_LEAST(
        TRIES, theirs, for (int k = 0; k < count; k++) {
            memcpy(room, gram, bytes);
            (void)gsl_linalg_cholesky_decomp1(&view.matrix);
        });
    line("cholesky", m, "", ours / count);
    line("cholesky", m, "_gsl", theirs / count);
    mem_free(rows);
    mem_free(gram);
    mem_free(room);
}

static void bench_rank(int bodies)
{
    const int m = ROWS * bodies, nu = SPEEDS * bodies, count = repeats((double)m * nu);
    double *rows = rows_of(bodies), ours, theirs;
    int *order = NEW_ARRAY(int, m);
    gsl_matrix *columns = dense_matrix((size_t)nu, (size_t)m);
    gsl_vector *tau = dense_vector((size_t)m), *norm = dense_vector((size_t)m);
    gsl_permutation *pivots = dense_permutation((size_t)m);

    BENCH_LEAST(
        TRIES, ours, for (int k = 0; k < count; k++) {
            int rank;

            if (rank_rows(rows, m, nu, 1e-9, NULL, &rank, order) != OK)
                return;
        });
    BENCH_LEAST(
        TRIES, theirs, for (int k = 0; k < count; k++) {
            gsl_matrix_const_view given = gsl_matrix_const_view_array(rows, (size_t)m, (size_t)nu);
            int sign;

            (void)gsl_matrix_transpose_memcpy(columns, &given.matrix);
            (void)gsl_linalg_QRPT_decomp(columns, tau, pivots, &sign, norm);
        });
    line("rank", m, "", ours / count);
    line("rank", m, "_gsl", theirs / count);
    mem_free(rows);
    mem_free(order);
    mem_free(columns);
    mem_free(tau);
    mem_free(norm);
    mem_free(pivots);
}

/* a full matrix, balanced, in Hessenberg form, with what it takes to come to it and back */
static void bench_hessenberg(int n)
{
    const int count = repeats((double)n * n * n);
    double *a = NEW_ARRAY(double, n *n), ours, theirs;
    gsl_matrix *h = dense_matrix((size_t)n, (size_t)n), *q = dense_matrix((size_t)n, (size_t)n);
    gsl_vector *d = dense_vector((size_t)n), *tau = dense_vector((size_t)n);
    uint64_t seed = 1;

    for (int i = 0; i < n * n; i++)
        a[i] = test_uniform(&seed, -1, 1);
    BENCH_LEAST(TRIES, ours,
                for (int k = 0; k < count; k++) hessenberg_form_free(hessenberg_form_new(a, n)););
    BENCH_LEAST(
        TRIES, theirs, for (int k = 0; k < count; k++) {
            memcpy(h->data, a, (size_t)(n * n) * sizeof(double));
            (void)gsl_linalg_balance_matrix(h, d);
            (void)gsl_linalg_hessenberg_decomp(h, tau);
            (void)gsl_linalg_hessenberg_unpack(h, tau, q);
        });
    line("hessenberg", n, "", ours / count);
    line("hessenberg", n, "_gsl", theirs / count);
    mem_free(a);
    mem_free(h);
    mem_free(q);
    mem_free(d);
    mem_free(tau);
}

/* new numbers in an old pattern, that of a ladder, factored and solved: a small one, which Sparse
 * keeps dense */
static void bench_sparse(int n)
{
    const int count = repeats((double)n * n);
    double *values = NEW_ARRAY(double, n *n), *b = NEW_ARRAY(double, n);
    int *row = NEW_ARRAY(int, n *n), *column = NEW_ARRAY(int, n *n), *start = NEW_ARRAY(int, n + 1);
    int entries = 0;
    double ours, theirs;
    Sparse *sparse;
    klu_common common;
    klu_symbolic *symbolic;
    klu_numeric *numeric;

    for (int j = 0; j < n; j++) { /* by columns, as KLU has them */
        for (int i = 0; i < n; i++)
            if (abs(i - j) <= 1) {
                row[entries] = i;
                column[entries] = j;
                values[entries++] = i == j ? 3 : -1;
            }
        start[j + 1] = entries;
    }
    sparse = sparse_new(n, entries, row, column);
    BENCH_LEAST(
        TRIES, ours, for (int k = 0; k < count; k++) {
            (void)sparse_factor(sparse, values);
            memset(b, 0, (size_t)n * sizeof(double));
            sparse_solve(sparse, b);
        });
    (void)klu_defaults(&common);
    symbolic = klu_analyze(n, start, row, &common);
    numeric = klu_factor(start, row, values, symbolic, &common);
    BENCH_LEAST(
        TRIES, theirs, for (int k = 0; k < count; k++) {
            (void)klu_refactor(start, row, values, symbolic, numeric, &common);
            (void)klu_rgrowth(start, row, values, symbolic, numeric, &common);
            memset(b, 0, (size_t)n * sizeof(double));
            (void)klu_solve(symbolic, numeric, n, 1, b, &common);
        });
    line("sparse", n, "", ours / count);
    line("sparse", n, "_klu", theirs / count);
    (void)klu_free_numeric(&numeric, &common);
    (void)klu_free_symbolic(&symbolic, &common);
    sparse_free(sparse);
    mem_free(values);
    mem_free(b);
    mem_free(row);
    mem_free(column);
    mem_free(start);
}

int main(void)
{
    static const int sizes[] = {2, 30};

    for (int i = 0; i < COUNT(sizes); i++) {
        bench_lu(sizes[i]);
        bench_cholesky(sizes[i]);
        bench_rank(sizes[i]);
    }
    bench_hessenberg(60);
    bench_sparse(4);
    bench_sparse(8);
    return 0;
}
