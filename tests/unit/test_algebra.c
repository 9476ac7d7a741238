/* test_algebra.c: parts of lib/algebra by what they promise, on random matrices */
#include "algebra/anderson.h"
#include "algebra/block_triangular.h"
#include "algebra/dense.h"
#include "algebra/enclosure.h"
#include "algebra/gram.h"
#include "algebra/independence.h"
#include "algebra/linear.h"
#include "algebra/markov_parameters.h"
#include "algebra/rank.h"
#include "algebra/sparse.h"
#include "base/memory.h"

#include "../random.h"
#include "test.h"

#include <gsl/gsl_errno.h>
#include <math.h>
#include <string.h>
#include <threads.h>

enum { MOST = 9 };

static void fill_pattern(bool *pattern, int n, double part, uint64_t *seed)
{
    for (int i = 0; i < n * n; i++)
        pattern[i] = test_uniform(seed, 0, 1) < part;
}

/* whether i is reached from j, as Warshall (1962) has it */
static void close_pattern(const bool *pattern, int n, bool *reach)
{
    memcpy(reach, pattern, (size_t)(n * n) * sizeof(bool));
    for (int k = 0; k < n; k++)
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++)
                reach[i * n + j] = reach[i * n + j] || (reach[i * n + k] && reach[k * n + j]);
}

static void blocks_are_what_acts_both_ways(void)
{
    uint64_t seed = 3;

    for (int turn = 0; turn < 400; turn++) {
        const int n = turn % (MOST + 1);
        bool pattern[MOST * MOST], reach[MOST * MOST];
        int block[MOST] = {0};
        BlockTriangular blocks;

        fill_pattern(pattern, n, test_uniform(&seed, 0, 0.4), &seed);
        close_pattern(pattern, n, reach);
        blocks = block_triangular_find(pattern, n);
        EXPECT(blocks.start[0] == 0 && blocks.start[blocks.count] == n);
        for (int b = 0; b < blocks.count; b++)
            for (int k = blocks.start[b]; k < blocks.start[b + 1]; k++) {
                block[blocks.order[k]] = b;
                EXPECT(k == blocks.start[b] || blocks.order[k] > blocks.order[k - 1]);
            }
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) {
                const bool both = i == j || (reach[i * n + j] && reach[j * n + i]);

                EXPECT((block[i] == block[j]) == both);
                EXPECT(!pattern[i * n + j] || block[j] <= block[i]); /* what acts comes before */
            }
        block_triangular_free(&blocks);
    }
}

/* whether rows from r on can have columns that aren't taken, by trying all */
static bool can_match(const bool *pattern, int n, int r, unsigned taken)
{
    if (r == n)
        return true;
    for (int c = 0; c < n; c++)
        if (pattern[r * n + c] && !(taken >> c & 1) &&
            can_match(pattern, n, r + 1, taken | 1U << c))
            return true;
    return false;
}

static void a_match_is_found_where_there_is_one(void)
{
    uint64_t seed = 5;
    int found = 0;

    for (int turn = 0; turn < 400; turn++) {
        const int n = turn % 8;
        bool pattern[MOST * MOST];
        int column[MOST];
        unsigned taken = 0;

        fill_pattern(pattern, n, test_uniform(&seed, 0.1, 0.7), &seed);
        EXPECT(block_triangular_match(pattern, n, column) == can_match(pattern, n, 0, 0));
        if (!can_match(pattern, n, 0, 0))
            continue;
        for (int r = 0; r < n; r++) {
            EXPECT(pattern[r * n + column[r]]);
            taken |= 1U << column[r];
        }
        EXPECT(taken == (1U << n) - 1);
        found++;
    }
    EXPECT(found > 50 && found < 350);
}

static void cholesky_factors_solve(void)
{
    uint64_t seed = 7;

    for (int turn = 0; turn < 100; turn++) {
        const int n = 1 + turn % MOST;
        double rows[MOST * MOST], a[MOST * MOST], l[MOST * MOST], x[MOST], b[MOST];

        for (int i = 0; i < n * n; i++)
            rows[i] = i % (n + 1) == 0 ? 2 : i % 3 == 0 ? test_uniform(&seed, -1, 1) : 0;
        matrix_gram(rows, n, n, a);
        memcpy(l, a, sizeof a);
        for (int i = 0; i < n; i++)
            b[i] = x[i] = i % 4 == 1 ? test_uniform(&seed, -1, 1) : 0;
        EXPECT(cholesky_factor(l, n) > 0);
        cholesky_forward(l, n, x);
        cholesky_backward(l, n, x);
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++)
                b[i] -= (j <= i ? a[i * n + j] : a[j * n + i]) * x[j];
            EXPECT_NEAR(b[i], 0, 1e-12);
        }
        l[0] = -1; /* not positive definite */
        EXPECT(!(cholesky_factor(l, n) > 0));
    }
}

/* --- GSL's error handler --- */

/* Rows i of 1, 2 a place on and some entry of either sign further on, of sizes over four decades:
 * independent, as the first entries alone form a triangle. Then one of them, whichever, becomes a
 * sum of two others but for `apart`. */
static void put_rows(double *matrix, int m, int nu, uint64_t *seed)
{
    memset(matrix, 0, (size_t)(m * nu) * sizeof(double));
    for (int i = 0; i < m; i++) {
        const double size = pow(10, test_uniform(seed, -2, 2));

        matrix[i * nu + i] = size;
        matrix[i * nu + i + 1] = size / 2;
        matrix[i * nu + i + 1 + (int)test_uniform(seed, 1, nu - i - 1)] = size / 4;
    }
}

/* by rows, and by columns of a pattern in which some entries that could be there are 0 */
static int rank_of(const double *matrix, int m, int nu, int *order)
{
    int *row = NEW_ARRAY(int, m *nu), *column = NEW_ARRAY(int, m *nu);
    int *place = NEW_ARRAY(int, m *nu), *other = NEW_ARRAY(int, m), count = 0, rank, again;
    double *values;
    Pattern pattern;

    EXPECT(rank_rows(matrix, m, nu, 1e-9, NULL, &rank, order) == OK);
    for (int i = 0; i < m; i++)
        for (int j = 0; j < nu; j++)
            if (matrix[i * nu + j] != 0 || (i + j) % 7 == 0) {
                row[count] = j;
                column[count++] = i;
            }
    pattern = pattern_of(nu, m, count, row, column, place);
    values = NEW_ARRAY(double, pattern.count);
    for (int k = 0; k < count; k++)
        values[place[k]] = matrix[column[k] * nu + row[k]];
    EXPECT(rank_columns(&pattern, values, 1e-9, NULL, &again, other) == OK && again == rank);
    for (int k = 0; k < m; k++)
        EXPECT(other[k] == order[k]);
    EXPECT(columns_are_independent(&pattern, values, 1e-9, NULL) ==
           rows_are_independent(matrix, m, nu, 1e-9, NULL));
    pattern_free(&pattern);
    MEM_FREE(row, column, place, other, values);
    return rank;
}

static void many_rows_have_the_rank_that_they_are_made_of(void)
{
    enum { ROWS = 90, COLUMNS = 100 };
    static const double apart[] = {0, 1e-13, 1e-7, 1e-3};
    double *matrix = NEW_ARRAY(double, ROWS *COLUMNS);
    int order[ROWS], rank;
    uint64_t seed = 11;

    for (int turn = 0; turn < 40; turn++) {
        const int m = turn % 2 == 0 ? ROWS : ROWS / 2; /* either way to find it */
        const int third = m / 3, a = (int)test_uniform(&seed, 0, third);
        const int c = third + (int)test_uniform(&seed, 0, third), b = m - 1 - a;
        const double small = apart[turn / 2 % COUNT(apart)];

        put_rows(matrix, m, COLUMNS, &seed);
        EXPECT(rank_of(matrix, m, COLUMNS, order) == m);
        for (int k = 0; k < m; k++)
            EXPECT(order[k] == k);
        for (int j = 0; j < COLUMNS; j++)
            matrix[c * COLUMNS + j] = matrix[a * COLUMNS + j] - matrix[b * COLUMNS + j];
        matrix[c * COLUMNS + COLUMNS - 1] +=
            small * fmax(fabs(matrix[a * COLUMNS + a]), fabs(matrix[b * COLUMNS + b]));
        rank = rank_of(matrix, m, COLUMNS, order);
        EXPECT(rank == (small < 1e-9 ? m - 1 : m));
        if (rank < m)
            EXPECT(order[m - 1] == a || order[m - 1] == b || order[m - 1] == c);
        memset(matrix + (ptrdiff_t)c * COLUMNS, 0, COLUMNS * sizeof(double));
        rank = rank_of(matrix, m, COLUMNS, order);
        EXPECT(rank == m - 1 && order[m - 1] == c);
    }
    mem_free(matrix);
}

/* Turns of a chain's links and where they begin, each given beside the one before: of n links the
 * least singular value is some 1/n^2. The sum of all turns beside them is nothing new. */
static void rows_of_a_long_chain_are_told_to_be_independent(void)
{
    enum { LINKS = 300, COLUMNS = 2 * LINKS };
    double *matrix = NEW_ARRAY(double, COLUMNS *COLUMNS);

    for (int i = 0; i < LINKS; i++) {
        double *turn = matrix + (ptrdiff_t)i * COLUMNS, *shift = turn + LINKS * COLUMNS;

        turn[i] = shift[LINKS + i] = 1;
        shift[i] = -0.5;
        if (i > 0)
            turn[i - 1] = shift[LINKS + i - 1] = -1;
        if (i > 0)
            shift[i - 1] = -0.5;
    }
    EXPECT(rows_are_independent(matrix, COLUMNS, COLUMNS, 1e-9, NULL));
    for (int apart = 0; apart < 2; apart++) {
        double *last = matrix + (ptrdiff_t)(COLUMNS - 1) * COLUMNS;

        memset(last, 0, COLUMNS * sizeof(double));
        last[LINKS - 1] = 1;
        last[0] = apart * 1e-9;
        EXPECT(!rows_are_independent(matrix, COLUMNS, COLUMNS, 1e-9, NULL));
    }
    mem_free(matrix);
}

#ifndef COTREE_FAULTS /* whose book of what is held is one for all threads */
static _Atomic int calls, running;

static void count_call(const char *reason, const char *file, int line, int code)
{
    (void)reason, (void)file, (void)line, (void)code;
    calls++;
}

static int find_many(void *unused)
{
    (void)unused;
    for (int k = 0; k < 3000; k++) {
        const DoubleDouble a[4] = {dd_of(0), dd_of(1), dd_of(-1), dd_of(k)};
        Enclosure e;

        (void)enclosure_find(a, 2, &e);
        enclosure_free(&e);
    }
    running--;
    return 0;
}

static void threads_leave_the_error_handler_to_who_set_it(void)
{
    gsl_error_handler_t *silent;
    thrd_t thread[2];

    mem_free(dense_vector(1));
    silent = gsl_set_error_handler(count_call);
    EXPECT(silent != NULL); /* NULL stands for the one that ends the program */
    running = 2;
    for (int i = 0; i < 2; i++)
        EXPECT(thrd_create(&thread[i], find_many, NULL) == thrd_success);
    while (running > 0)
        EXPECT(gsl_set_error_handler(count_call) == count_call);
    for (int i = 0; i < 2; i++)
        EXPECT(thrd_join(thread[i], NULL) == thrd_success);
    EXPECT(gsl_set_error_handler(silent) == count_call);
    EXPECT(calls == 0);
}
#endif

/* by putting the solution in; a row that is another's multiple has no pivot of its own */
static void rows_times_rows_are_solved_where_their_pivots_are_sound(void)
{
    enum { ROWS = 90, COLUMNS = 100 };
    double *matrix = NEW_ARRAY(double, ROWS *COLUMNS);
    uint64_t seed = 5;

    for (int turn = 0; turn < 20; turn++) {
        const double added = turn % 2 == 0 ? 0 : 0.1;
        double b[ROWS], x[ROWS], across[COLUMNS] = {0};
        Gram *gram;

        put_rows(matrix, ROWS, COLUMNS, &seed);
        for (int i = 0; i < ROWS; i++)
            x[i] = b[i] = matrix[i * COLUMNS + i] * test_uniform(&seed, -1, 1);
        gram = gram_new(matrix, ROWS, COLUMNS, NULL);
        EXPECT(gram_factor(gram, added, 1e-8, NULL));
        gram_solve(gram, x);
        gram_free(gram);
        for (int i = 0; i < ROWS; i++)
            for (int j = 0; j < COLUMNS; j++)
                across[j] += matrix[i * COLUMNS + j] * x[i];
        for (int i = 0; i < ROWS; i++) {
            double left = added * x[i] - b[i];

            for (int j = 0; j < COLUMNS; j++)
                left += matrix[i * COLUMNS + j] * across[j];
            EXPECT(fabs(left) < 1e-9 * matrix[i * COLUMNS + i]);
        }
        for (int j = 0; j < COLUMNS; j++)
            matrix[(turn + 1) * COLUMNS + j] = 3 * matrix[j];
        gram = gram_new(matrix, ROWS, COLUMNS, NULL);
        EXPECT(!gram_factor(gram, 0, 1e-8, NULL));
        gram_free(gram);
    }
    mem_free(matrix);
}

/* 3^200 of 2^-52 is left where two that differ by so much cancel; 1 is left of (2^53 - 1)^2 and its
 * neighbours' product; an endless road has Fibonacci's numbers */
static void sums_that_cancel_keep_all_their_digits(void)
{
    const double threes[] = {3, 0, 0, 3}, near[] = {1 + 0x1p-52, 1}, apart[] = {1, -1};
    const double ways[] = {0, 0x1p53 - 1, 0x1p53, 0};
    const double even[] = {0x1p53 - 1, 0, 0, 0x1p53 - 2}, first[] = {1, 1};
    const double last[] = {0x1p53 - 1, -0x1p53}, road[] = {1, 1, 1, 0}, begin[] = {1, 0};
    int at;
    MarkovParameters *r = markov_parameters_new(threes, near, apart, 2, 300);
    double sum = markov_parameters_value(r, 200, &at);

    EXPECT(fabs(ldexp(sum, at) / (pow(3, 200) * 0x1p-52) - 1) < 1e-14);
    markov_parameters_free(r);
    r = markov_parameters_new(even, first, last, 2, 2);
    sum = markov_parameters_value(r, 1, &at);
    EXPECT(ldexp(sum, at) == 1);
    markov_parameters_free(r);
    r = markov_parameters_new(ways, begin, begin, 2, 2);
    EXPECT(markov_parameters_value(r, 1, &at) == 0);
    markov_parameters_free(r);
    r = markov_parameters_new(road, begin, apart, 2, 90);
    sum = markov_parameters_value(r, 80, &at); /* F_81 - F_80 = F_79 */
    EXPECT(ldexp(sum, at) == 14472334024676221);
    markov_parameters_free(r);
}

/* x = c + sum_k a_k (b_k . x), whose eigenvalues are far above 1, in rank + 2 steps */
static void an_affine_map_meets_its_fixed_point(void)
{
    enum { N = 7, RANK = 3 };
    const double size[N] = {1e-3, 1, 1, 50, 1, 1e3, 1};
    uint64_t seed = 11;

    for (int trial = 0; trial < 200; trial++) {
        const int rank = trial % (RANK + 1);
        double a[RANK][N], b[RANK][N], c[N], x[N] = {0}, image[N];
        double largest = 0;
        Anderson *anderson = anderson_new(N);

        for (int i = 0; i < N; i++) {
            c[i] = size[i] * test_uniform(&seed, -1, 1);
            for (int k = 0; k < rank; k++) {
                a[k][i] = size[i] * test_uniform(&seed, -4, 4);
                b[k][i] = test_uniform(&seed, -4, 4) / size[i];
            }
        }
        for (int step = 0; step < rank + 3; step++) {
            memcpy(image, c, sizeof c);
            for (int k = 0; k < rank; k++) {
                double along = 0;

                for (int i = 0; i < N; i++)
                    along += b[k][i] * x[i];
                for (int i = 0; i < N; i++)
                    image[i] += a[k][i] * along;
            }
            if (step < rank + 2)
                anderson_step(anderson, x, image, size);
        }
        for (int i = 0; i < N; i++)
            largest = fmax(largest, fabs(image[i] - x[i]) / size[i]);
        EXPECT(largest < 1e-6);
        anderson_free(anderson);
    }
}

/* a ring of n unknowns: diagonal entries `own` in size, neighbours about 1 */
static void fill_ring(int n, double own, uint64_t *seed, int *row, int *column, double *value)
{
    for (int i = 0; i < n; i++)
        for (int k = -1; k <= 1; k++) {
            const int e = 3 * i + k + 1;

            row[e] = i;
            column[e] = (i + k + n) % n;
            value[e] = (k == 0 ? own : 1) * test_uniform(seed, 0.5, 1.5);
        }
}

/* Pivots on the diagonal serve the first matrix; in the second nearly nothing is left of them. */
static void pivots_of_an_earlier_matrix_are_given_up_where_they_wear(void)
{
    enum { N = 15 };
    int row[3 * N], column[3 * N];
    double value[3 * N], b[N];
    uint64_t seed = 5;
    Sparse *sparse;

    fill_ring(N, 4, &seed, row, column, value);
    sparse = sparse_new(N, 3 * N, row, column);
    EXPECT(sparse_factor(sparse, value));
    for (int turn = 0; turn < 20; turn++) {
        fill_ring(N, pow(10, -turn), &seed, row, column, value);
        EXPECT(sparse_factor(sparse, value));
        memset(b, 0, sizeof b);
        for (int e = 0; e < 3 * N; e++)
            b[row[e]] += value[e] * (1 + column[e]);
        sparse_solve(sparse, b);
        for (int i = 0; i < N; i++)
            EXPECT_NEAR(b[i], 1 + i, 1e-8);
    }
    sparse_free(sparse);
}

int main(void)
{
    RUN(pivots_of_an_earlier_matrix_are_given_up_where_they_wear);
    RUN(an_affine_map_meets_its_fixed_point);
    RUN(blocks_are_what_acts_both_ways);
    RUN(a_match_is_found_where_there_is_one);
    RUN(cholesky_factors_solve);
    RUN(rows_times_rows_are_solved_where_their_pivots_are_sound);
    RUN(many_rows_have_the_rank_that_they_are_made_of);
    RUN(sums_that_cancel_keep_all_their_digits);
    RUN(rows_of_a_long_chain_are_told_to_be_independent);
#ifndef COTREE_FAULTS
    RUN(threads_leave_the_error_handler_to_who_set_it);
#endif
    return test_end();
}
