/* test_simulate_linear.c: LU, KKT, embedded form, rank, least squares on matrices made up here */
#include "algebra/kkt.h"
#include "algebra/levenberg_marquardt.h"
#include "algebra/linear.h"
#include "algebra/rank.h"
#include "simulate/equations/partitioning.h"

#include "test.h"

#include <gsl/gsl_linalg.h>

enum { NU = 6, M = 4 };
static const int all_rows[M] = {0, 1, 2, 3};

/* a Kkt of full matrices */
typedef struct Full {
    Pattern mass, rows;
    Kkt *kkt;
} Full;

static Kkt *full_open(Full *full, int nu, int m)
{
    full->mass = pattern_full(nu, nu);
    full->rows = pattern_full(nu, m);
    full->kkt = kkt_new(&full->mass, &full->rows, all_rows, m);
    return full->kkt;
}

static void full_close(Full *full)
{
    kkt_free(full->kkt);
    pattern_free(&full->mass);
    pattern_free(&full->rows);
}

static void random_matrix(uint64_t *seed, double *a, int n)
{
    for (int i = 0; i < n; i++)
        a[i] = test_uniform(seed, -1, 1);
}

/* a mass matrix of full rank, and constraint rows */
static void random_system(uint64_t *seed, double *mass, double *phi_u)
{
    double root[NU * NU];

    random_matrix(seed, root, NU * NU);
    random_matrix(seed, phi_u, M * NU);
    for (int i = 0; i < NU; i++)
        for (int j = 0; j < NU; j++) {
            mass[i * NU + j] = i == j ? 0.1 : 0;
            for (int k = 0; k < NU; k++)
                mass[i * NU + j] += root[i * NU + k] * root[j * NU + k];
        }
}

static void lu_solves_random_systems(void)
{
    uint64_t seed = 1;
    Lu *lu = lu_new(NU);

    for (int trial = 0; trial < 100; trial++) {
        double a[NU * NU], x[NU], b[NU];

        random_matrix(&seed, a, NU * NU);
        random_matrix(&seed, x, NU);
        matrix_times(a, NU, NU, x, b);
        memcpy(lu_matrix(lu), a, sizeof a);
        EXPECT(lu_factor(lu));
        lu_solve(lu, b);
        for (int i = 0; i < NU; i++)
            EXPECT_NEAR(b[i], x[i], 1e-13 / lu_pivot_ratio(lu));
    }
    lu_free(lu);
}

static void lu_refuses_singular_and_undefined_matrices(void)
{
    Lu *lu = lu_new(2);

    memset(lu_matrix(lu), 0, 4 * sizeof(double));
    EXPECT(!lu_factor(lu));
    lu_matrix(lu)[0] = NAN;
    EXPECT(!lu_factor(lu));
    lu_free(lu);
}

/* largest residual of M du + G^T lambda = top, G du = bottom */
static double kkt_residual(const double *mass, const double *phi_u, const double *top,
                           const double *bottom, const double *du, const double *lambda)
{
    double largest = 0;

    for (int i = 0; i < NU; i++) {
        double sum = -top[i];

        for (int j = 0; j < NU; j++)
            sum += mass[i * NU + j] * du[j];
        for (int k = 0; k < M; k++)
            sum += phi_u[k * NU + i] * lambda[k];
        largest = fmax(largest, fabs(sum));
    }
    for (int k = 0; k < M; k++) {
        double sum = -bottom[k];

        for (int j = 0; j < NU; j++)
            sum += phi_u[k * NU + j] * du[j];
        largest = fmax(largest, fabs(sum));
    }
    return largest;
}

static void kkt_and_embedded_form_agree(void)
{
    uint64_t seed = 2;
    Full full;
    Kkt *kkt = full_open(&full, NU, M);
    Partitioning *embed = partitioning_new(NU, M);

    for (int trial = 0; trial < 100; trial++) {
        double mass[NU * NU], phi_u[M * NU], top[NU], bottom[M], du[NU], other[NU], lambda[M];

        random_system(&seed, mass, phi_u);
        random_matrix(&seed, top, NU);
        random_matrix(&seed, bottom, M);
        EXPECT(kkt_factor(kkt, mass, phi_u, all_rows));
        kkt_solve(kkt, top, bottom, du, lambda);
        EXPECT(kkt_residual(mass, phi_u, top, bottom, du, lambda) < 1e-10);
        EXPECT(partitioning_choose(embed, phi_u, all_rows, NULL, 0));
        EXPECT(partitioning_factor(embed, mass, phi_u, all_rows));
        partitioning_solve(embed, top, bottom, other);
        for (int i = 0; i < NU; i++)
            EXPECT_NEAR(other[i], du[i], 1e-9);
    }
    full_close(&full);
    partitioning_free(embed);
}

static void wanted_speeds_become_independent(void)
{
    static const int wanted[2] = {1, 4};
    uint64_t seed = 3;
    Partitioning *embed = partitioning_new(NU, M);
    double phi_u[M * NU];

    random_matrix(&seed, phi_u, M * NU);
    EXPECT(partitioning_choose(embed, phi_u, all_rows, wanted, 2));
    EXPECT(partitioning_independent(embed)[0] == 1 && partitioning_independent(embed)[1] == 4);
    partitioning_free(embed);
}

/* A stage of a step that is rejected may lie at a singular position. */
static void a_choice_that_fails_leaves_the_one_before(void)
{
    static const int wanted[2] = {1, 4};
    uint64_t seed = 4;
    double mass[NU * NU], phi_u[M * NU], singular[M * NU], top[NU], bottom[M], before[NU], du[NU];
    Partitioning *embed = partitioning_new(NU, M);

    random_system(&seed, mass, phi_u);
    random_matrix(&seed, top, NU);
    random_matrix(&seed, bottom, M);
    memcpy(singular, phi_u, sizeof singular);
    memcpy(singular + (ptrdiff_t)(M - 1) * NU, phi_u, NU * sizeof(double));
    EXPECT(partitioning_choose(embed, phi_u, all_rows, wanted, 2));
    EXPECT(partitioning_factor(embed, mass, phi_u, all_rows));
    partitioning_solve(embed, top, bottom, before);
    EXPECT(!partitioning_choose(embed, singular, all_rows, NULL, 0));
    EXPECT(partitioning_factor(embed, mass, phi_u, all_rows));
    partitioning_solve(embed, top, bottom, du);
    for (int i = 0; i < NU; i++)
        EXPECT_NEAR(du[i], before[i], 1e-12);
    partitioning_free(embed);
}

/* --- bodies in a row and across, as absolute coordinates have them --- */

enum { BODIES = 40, SPEEDS = 3 * BODIES, JOINTS = BODIES + 5, ROWS = 2 * JOINTS };

/* Pinned each to the one before and some to one far before: 2 rows a joint, of up to 6 entries. */
typedef struct Pinned {
    Pattern mass, rows;
    double masses[SPEEDS], entries[6 * ROWS];
    int order[ROWS];
} Pinned;

static void open_pinned(uint64_t *seed, double decades, Pinned *p)
{
    int row[6 * ROWS], column[6 * ROWS], place[6 * ROWS], diagonal[SPEEDS], count = 0;

    for (int i = 0; i < SPEEDS; i++) {
        diagonal[i] = i;
        p->masses[i] = pow(10, test_uniform(seed, -decades / 2, decades / 2));
    }
    for (int j = 0; j < JOINTS; j++) {
        const int one = j < BODIES ? j : 7 * (j - BODIES) + 6, other = j < BODIES ? j - 1 : one - 5;

        for (int k = 0; k < 12; k++)
            if (k < 6 || other >= 0) {
                row[count] = 3 * (k < 6 ? one : other) + k % 3;
                column[count++] = 2 * j + k / 3 % 2;
            }
    }
    p->mass = pattern_of(SPEEDS, SPEEDS, SPEEDS, diagonal, diagonal, diagonal);
    p->rows = pattern_of(SPEEDS, ROWS, count, row, column, place);
    for (int k = 0; k < ROWS; k++)
        p->order[k] = k;
}

/* to some attitude: a row holds the x or y of two points, each a body's and its arm's turned */
static void turn_pinned(uint64_t *seed, Pinned *p)
{
    for (int e = 0; e < p->rows.count; e++) {
        const int body = p->rows.row[e] / 3,
                  last = p->rows.row[p->rows.start[p->rows.column[e] + 1] - 1];
        const double sign = body == last / 3 ? 1 : -1;

        p->entries[e] = p->rows.row[e] % 3 == 2                       ? test_uniform(seed, -1, 1)
                        : p->rows.row[e] % 3 == p->rows.column[e] % 2 ? sign
                                                                      : 0;
    }
}

/* the same by GSL, everything in full */
static void solve_in_full(const Pinned *p, const double *top, const double *bottom, double *du)
{
    const size_t n = SPEEDS + ROWS;
    gsl_matrix *a = gsl_matrix_calloc(n, n);
    gsl_vector *b = gsl_vector_alloc(n);
    gsl_permutation *order = gsl_permutation_alloc(n);
    int sign;

    for (size_t i = 0; i < SPEEDS; i++) {
        gsl_matrix_set(a, i, i, p->masses[i]);
        gsl_vector_set(b, i, top[i]);
    }
    for (int e = 0; e < p->rows.count; e++) {
        const size_t i = (size_t)p->rows.row[e], k = SPEEDS + (size_t)p->rows.column[e];

        gsl_matrix_set(a, i, k, p->entries[e]);
        gsl_matrix_set(a, k, i, p->entries[e]);
    }
    for (size_t k = 0; k < ROWS; k++)
        gsl_vector_set(b, SPEEDS + k, bottom[k]);
    (void)gsl_linalg_LU_decomp(a, order, &sign);
    (void)gsl_linalg_LU_svx(a, order, b);
    for (size_t i = 0; i < SPEEDS; i++)
        du[i] = gsl_vector_get(b, i);
    gsl_matrix_free(a);
    gsl_vector_free(b);
    gsl_permutation_free(order);
}

/* largest left of a row or force, over what its terms are */
static double left_of_pinned(const Pinned *p, const double *top, const double *bottom,
                             const double *du, const double *lambda)
{
    double force[SPEEDS], size[SPEEDS], largest = 0;

    for (int i = 0; i < SPEEDS; i++) {
        force[i] = p->masses[i] * du[i] - top[i];
        size[i] = fabs(p->masses[i] * du[i]) + fabs(top[i]);
    }
    for (int k = 0; k < ROWS; k++) {
        double sum = -bottom[k], terms = fabs(bottom[k]);

        for (int e = p->rows.start[k]; e < p->rows.start[k + 1]; e++) {
            const int i = p->rows.row[e];

            sum += p->entries[e] * du[i];
            terms += fabs(p->entries[e] * du[i]);
            force[i] += p->entries[e] * lambda[k];
            size[i] += fabs(p->entries[e] * lambda[k]);
        }
        largest = fmax(largest, fabs(sum) / terms);
    }
    for (int i = 0; i < SPEEDS; i++)
        largest = fmax(largest, fabs(force[i]) / size[i]);
    return largest;
}

static void sparse_and_full_elimination_agree(void)
{
    uint64_t seed = 11;

    for (int trial = 0; trial < 40; trial++) {
        double top[SPEEDS], bottom[ROWS], du[SPEEDS], full[SPEEDS], lambda[ROWS], largest = 0;
        Pinned p;
        Kkt *kkt;

        open_pinned(&seed, trial % 4 * 2, &p);
        kkt = kkt_new(&p.mass, &p.rows, p.order, ROWS);
        for (int again = 0; again < 2; again++) { /* factors are found anew in the same order */
            turn_pinned(&seed, &p);
            random_matrix(&seed, top, SPEEDS);
            random_matrix(&seed, bottom, ROWS);
            EXPECT(kkt_factor(kkt, p.masses, p.entries, p.order));
            kkt_solve(kkt, top, bottom, du, lambda);
            EXPECT(!kkt_is_regularised(kkt));
            EXPECT(left_of_pinned(&p, top, bottom, du, lambda) < 1e-13);
            solve_in_full(&p, top, bottom, full);
            for (int i = 0; i < SPEEDS; i++)
                largest = fmax(largest, fabs(full[i]));
            for (int i = 0; i < SPEEDS; i++)
                EXPECT_NEAR(du[i], full[i], 1e-9 * largest);
        }
        kkt_free(kkt);
        pattern_free(&p.mass);
        pattern_free(&p.rows);
    }
}

/* Rows at an angle that falls, until epsilon holds one back: a correction isn't refined before, but
 * one that is corrected once more is the solution. */
static void corrections_settle_when_they_are_corrected(void)
{
    uint64_t seed = 31;
    Full full;
    Kkt *kkt = full_open(&full, 3, 2);

    for (double angle = 1; angle > 1e-4; angle /= 3) {
        const double mass[9] = {1, 0, 0, 0, 1e3, 0, 0, 0, 10};
        const double phi_u[6] = {1, 0.5, 0, cos(angle), 0.5 * cos(angle), sin(angle)};
        double bottom[2], left[2], du[3], once[3], again[3], lambda[2];

        random_matrix(&seed, bottom, 2);
        EXPECT(kkt_factor(kkt, mass, phi_u, all_rows));
        kkt_solve(kkt, NULL, bottom, du, lambda);
        kkt_correct(kkt, bottom, once);
        for (int i = 0; i < 3 && kkt_is_regularised(kkt); i++)
            EXPECT(once[i] == du[i]);
        if (kkt_is_regularised(kkt))
            continue;
        for (int k = 0; k < 2; k++) {
            left[k] = bottom[k];
            for (int i = 0; i < 3; i++)
                left[k] -= phi_u[3 * k + i] * once[i];
            EXPECT(fabs(left[k]) < 1e-6);
        }
        kkt_correct(kkt, left, again);
        for (int i = 0; i < 3; i++)
            EXPECT_NEAR(once[i] + again[i], du[i], 1e-11 * vector_largest(du, 3));
    }
    full_close(&full);
}

/* a row that repeats two others is dropped, and then another one of the three */
static void rows_in_use_may_be_others(void)
{
    const double mass[9] = {2, 1, 0, 1, 3, 0, 0, 0, 1}, phi_u[9] = {1, 1, 0, 0, 1, 1, 1, 2, 1};
    const double top[3] = {1, 2, 3}, bottom[2] = {0, 0};
    static const int first[2] = {0, 1}, then[2] = {1, 2};
    double du[3], other[3], lambda[2];
    Full full = {.mass = pattern_full(3, 3), .rows = pattern_full(3, 3)};
    Kkt *kkt = full.kkt = kkt_new(&full.mass, &full.rows, first, 2);

    EXPECT(kkt_factor(kkt, mass, phi_u, first));
    kkt_solve(kkt, top, bottom, du, lambda);
    EXPECT(kkt_factor(kkt, mass, phi_u, then));
    kkt_solve(kkt, top, bottom, other, lambda);
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(other[i], du[i], 1e-14);
    full_close(&full);
}

static void massless_speeds_are_held_by_their_constraints(void)
{
    /* a point mass on a massless rod, lying flat: M has a zero */
    const double mass[9] = {1, 0, 0, 0, 1, 0, 0, 0, 0}, phi_u[6] = {1, 0, 0, 0, 1, 1};
    const double top[3] = {0, -9.81, 0}, bottom[2] = {0, 0};
    double du[3], lambda[2];
    Full full;
    Kkt *kkt = full_open(&full, 3, 2);

    EXPECT(kkt_factor(kkt, mass, phi_u, all_rows));
    EXPECT(!kkt_is_regularised(kkt));
    kkt_solve(kkt, top, bottom, du, lambda);
    EXPECT_NEAR(du[1], -9.81, 1e-14);
    EXPECT_NEAR(du[2], 9.81, 1e-14);
    EXPECT_NEAR(lambda[1], 0, 1e-14);
    full_close(&full);
}

static void a_free_massless_speed_has_no_acceleration(void)
{
    const double mass[4] = {1, 0, 0, 0}, phi_u[2] = {1, 0};
    Full full, empty;
    Kkt *kkt = full_open(&full, 2, 1), *bare = full_open(&empty, 2, 0);

    EXPECT(!kkt_factor(bare, mass, NULL, NULL));
    EXPECT(!kkt_factor(kkt, mass, phi_u, all_rows));
    full_close(&full);
    full_close(&empty);
}

static void a_row_that_fades_is_regularised(void)
{
    double mass[4] = {1, 0, 0, 1}, phi_u[4] = {1, 0, 1, 1};
    const double top[2] = {1, 0}, bottom[2] = {0, 0};
    double du[2], lambda[2];
    Full full;
    Kkt *kkt = full_open(&full, 2, 2);

    EXPECT(kkt_factor(kkt, mass, phi_u, all_rows));
    EXPECT(!kkt_is_regularised(kkt));
    phi_u[3] = 1e-4; /* the rows become parallel */
    EXPECT(kkt_factor(kkt, mass, phi_u, all_rows));
    EXPECT(kkt_is_regularised(kkt));
    kkt_solve(kkt, top, bottom, du, lambda);
    EXPECT_NEAR(du[0], 0, 1e-6);
    EXPECT_NEAR(lambda[0] + lambda[1], 1, 1e-6);
    phi_u[3] = 0;
    EXPECT(kkt_factor(kkt, mass, phi_u, all_rows));
    kkt_solve(kkt, top, bottom, du, lambda);
    EXPECT_NEAR(lambda[0] + lambda[1], 1, 1e-6);
    full_close(&full);
}

/* A speed without mass that a row of its own holds changes nothing of what others are told. */
static void a_massless_speed_hides_no_row_that_fades(void)
{
    const double top[3] = {1, 0, 0}, bottom[3] = {0, 0, 0};

    for (int k = 0; k <= 60; k++) {
        const double sine = pow(10, -0.01 - k / 15.0);
        const double phi_u[9] = {1, 0, 0, 1, sine, 0, 0, 1, 1};
        const double whole[9] = {1, 0, 0, 1, 1, 0, 0, 1, 1};
        Kkt *of[2];
        Full full[2];

        for (int i = 0; i < 2; i++) {
            const double mass[9] = {1, 0, 0, 0, 1, 0, 0, 0, i};
            double du[3], lambda[3];

            of[i] = full_open(&full[i], 3, 3);
            EXPECT(kkt_factor(of[i], mass, whole, all_rows));
            EXPECT(kkt_factor(of[i], mass, phi_u, all_rows));
            kkt_solve(of[i], top, bottom, du, lambda);
            EXPECT_NEAR(du[0], 0, 1e-6);
            EXPECT_NEAR(lambda[0] + lambda[1], 1, 1e-6);
        }
        EXPECT(kkt_is_regularised(of[0]) == kkt_is_regularised(of[1]));
        EXPECT(kkt_is_regularised(of[0]) == (sine * sine < 1e-5));
        EXPECT((kkt_rounding_error(of[0]) > 0) == (sine * sine < 1e-2));
        full_close(&full[0]);
        full_close(&full[1]);
    }
}

/* a light slide between two heavy ones, the second of which hangs on it: no position of it is
 * singular, whatever the masses are */
static void a_light_part_between_heavy_ones_is_no_singularity(void)
{
    const double phi_u[6] = {1, -1, 0, 0, 1, -1};
    const double bottom[2] = {0, 0};

    for (int decade = -8; decade <= 8; decade++) {
        const double ratio = pow(10, decade);
        const double mass[9] = {1, 0, 0, 0, ratio, 0, 0, 0, 1}, top[3] = {0, 0, 1};
        double du[3], lambda[2];
        Full full;
        Kkt *kkt = full_open(&full, 3, 2);

        EXPECT(kkt_factor(kkt, mass, phi_u, all_rows));
        EXPECT(!kkt_is_regularised(kkt));
        kkt_solve(kkt, top, bottom, du, lambda);
        EXPECT_NEAR(du[0] * (2 + ratio), 1, 1e-13);
        EXPECT_NEAR(lambda[1] * (2 + ratio), -(1 + ratio), 1e-13 * (2 + ratio));
        full_close(&full);
    }
}

/* what epsilon holds back is what is singular; the rest is exact all the same */
static void what_is_only_nearly_singular_is_exact(void)
{
    double mass[9] = {1, 0, 0, 0, 1e-4, 0, 0, 0, 1}, phi_u[6] = {1, 0, 0, 1, 1, 0};
    const double top[3] = {1, 2, 3}, bottom[2] = {0, 1e-3};
    double du[3], lambda[2];
    Full full;
    Kkt *kkt = full_open(&full, 3, 2);

    EXPECT(kkt_factor(kkt, mass, phi_u, all_rows));
    phi_u[4] = 1e-3; /* the rows become parallel */
    EXPECT(kkt_factor(kkt, mass, phi_u, all_rows));
    EXPECT(kkt_is_regularised(kkt));
    kkt_solve(kkt, top, bottom, du, lambda);
    EXPECT_NEAR(du[0], 0, 1e-12);
    EXPECT_NEAR(du[1], 1, 1e-9);
    EXPECT_NEAR(du[2], 3, 1e-12);
    full_close(&full);
}

static void rank_finds_the_row_that_follows(void)
{
    double rows[4 * 3] = {1, 2, 3, 0, 1e-3, 1e-3, 1, 2.001, 3.001, 5, 0, 0};
    int order[4], rank;

    EXPECT(rank_rows(rows, 4, 3, 1e-9, NULL, &rank, order) == OK && rank == 3);
    rows[9] = 0; /* a row of zeros */
    EXPECT(rank_rows(rows, 4, 3, 1e-9, NULL, &rank, order) == OK && rank == 2);
    EXPECT(order[0] < order[1] && order[2] < order[3]);
    EXPECT(order[2] == 3 || order[3] == 3);
}

static bool count_down(void *context)
{
    int *left = context;

    return (*left)-- <= 0;
}

static void long_work_asks_whether_to_stop(void)
{
    enum { N = 60 };
    double matrix[N * N];
    int order[N], rank = -1, left = N / 2;
    uint64_t seed = 5;
    const CallMonitor watch = {.context = &left, .stop = count_down};
    Lu *lu = lu_new(N);

    random_matrix(&seed, matrix, N * N);
    EXPECT(rank_rows(matrix, N, N, 1e-9, &watch, &rank, order) == E_STOPPED);
    left = 10 * N;
    EXPECT(rank_rows(matrix, N, N, 1e-9, &watch, &rank, order) == OK && rank == N);
    EXPECT(left <= 9 * N); /* at least once a column */

    left = N / 2;
    memcpy(lu_matrix(lu), matrix, sizeof matrix);
    EXPECT(!lu_factor_watched(lu, &watch));
    left = 10 * N;
    memcpy(lu_matrix(lu), matrix, sizeof matrix);
    EXPECT(lu_factor_watched(lu, &watch));
    lu_free(lu);
}

/* Rows that follow from others, of any scale: as many as were made are found, and they span. */
static void rank_is_that_of_the_making(void)
{
    enum { WIDE = 14, HIGH = 20 };
    uint64_t seed = 11;

    for (int trial = 0; trial < 200; trial++) {
        const int made = 1 + trial % 12;
        double rows[HIGH * WIDE] = {0}, chosen[HIGH * WIDE];
        int order[HIGH], rank;

        for (int i = 0; i < HIGH; i++) {
            double *row = rows + i * WIDE;
            const double scale = pow(10, test_uniform(&seed, -3, 3));

            /* one entry of its own, and two that others may have */
            for (int k = 0; i < made && k < 3; k++)
                row[k == 0 ? i : made + (int)(test_random(&seed) % (unsigned)(WIDE - made))] =
                    test_uniform(&seed, 0.5, 1);
            for (int k = 0; i >= made && k < 2; k++) {
                const double *of = rows + (int)(test_random(&seed) % (unsigned)made) * WIDE;
                const double share = test_uniform(&seed, -1, 1);

                for (int j = 0; j < WIDE; j++)
                    row[j] += share * of[j];
            }
            for (int j = 0; j < WIDE; j++)
                row[j] *= scale;
        }
        EXPECT(rank_rows(rows, HIGH, WIDE, 1e-9, NULL, &rank, order) == OK && rank == made);
        for (int k = 0; k < made; k++)
            memcpy(chosen + k * WIDE, rows + order[k] * WIDE, WIDE * sizeof(double));
        EXPECT(rank_rows(chosen, made, WIDE, 1e-9, NULL, &rank, order) == OK && rank == made);
    }
}

static void least_multipliers_give_the_same_forces(void)
{
    const double phi_u[3 * 2] = {1, 0, 0, 1, 1, 1};
    double lambda[3] = {3, 0, 0};

    rank_least_multipliers(phi_u, 3, 2, lambda);
    /* the null space of phi_u^T is (1, 1, -1) */
    EXPECT_NEAR(lambda[0] + lambda[2], 3, 1e-14);
    EXPECT_NEAR(lambda[1] + lambda[2], 0, 1e-14);
    EXPECT_NEAR(lambda[0] + lambda[1] - lambda[2], 0, 1e-14);
}

/* a point on two circles of radius 2 about (0,0) and (2,0), each given twice */
static void circles(void *context, const double *v, double *residual, double *jacobian)
{
    double x = v[0], y = v[1];

    (void)context;
    for (int twice = 0; twice < 2; twice++) {
        residual[2 * twice] = x * x + y * y - 4;
        residual[2 * twice + 1] = (x - 2) * (x - 2) + y * y - 4;
        if (jacobian != NULL) {
            const double rows[4] = {2 * x, 2 * y, 2 * (x - 2), 2 * y};

            memcpy(jacobian + 4 * twice, rows, sizeof rows);
        }
    }
}

static void least_squares_goes_to_the_near_solution(void)
{
    Rows rows = {.rows = 4, .columns = 2, .length = 2, .evaluate = circles};
    double v[2] = {0.5, 0.7}, below[2] = {1.3, -4};

    EXPECT(levenberg_marquardt_solve(&rows, NULL, NULL, 1e-12, v, NULL));
    EXPECT_NEAR(v[0], 1, 1e-13);
    EXPECT_NEAR(v[1], sqrt(3), 1e-13);
    EXPECT(levenberg_marquardt_solve(&rows, NULL, NULL, 1e-12, below, NULL));
    EXPECT_NEAR(below[1], -sqrt(3), 1e-13);
}

/* v_k + v_(k+1)^3 / 8 = sin(k), by places of two entries a row, or in full */
typedef struct Ladder {
    int rows;
    bool is_full;
} Ladder;

static void ladder(void *context, const double *v, double *residual, double *jacobian)
{
    const Ladder *l = context;
    const int columns = l->rows + 1;

    if (jacobian != NULL && l->is_full)
        memset(jacobian, 0, (size_t)(l->rows * columns) * sizeof(double));
    for (int k = 0; k < l->rows; k++) {
        residual[k] = v[k] + v[k + 1] * v[k + 1] * v[k + 1] / 8 - sin(k);
        if (jacobian != NULL) {
            double *row = jacobian + (l->is_full ? k * columns + k : 2 * k);

            row[0] = 1;
            row[1] = 3 * v[k + 1] * v[k + 1] / 8;
        }
    }
}

static void sparse_least_squares_agree_with_full_ones(void)
{
    enum { MOST = 100 };

    for (int rows = 5; rows <= MOST; rows += 19) { /* few and many: by dense and sparse factors */
        Ladder way[2] = {{rows, true}, {rows, false}};
        double v[2][MOST + 1] = {{0}}, residual[MOST];
        double full[MOST * (MOST + 1)] = {0}, spread[MOST * (MOST + 1)] = {0};
        int row[2 * MOST], column[2 * MOST], place[2 * MOST];
        Pattern pattern;

        for (int k = 0; k < 2 * rows; k++) {
            row[k] = (k + 1) / 2;
            column[k] = k / 2;
        }
        pattern = pattern_of(rows + 1, rows, 2 * rows, row, column, place);
        for (int i = 0; i < 2; i++) {
            const Rows problem = {.rows = rows,
                                  .columns = rows + 1,
                                  .length = rows + 1,
                                  .context = &way[i],
                                  .pattern = i == 0 ? NULL : &pattern,
                                  .evaluate = ladder};

            for (int k = 0; k <= rows; k++)
                v[i][k] = 0.1 * k / rows;
            EXPECT(levenberg_marquardt_solve(&problem, NULL, NULL, 1e-12, v[i], residual));
            rows_evaluate_full(&problem, v[0], residual, i == 0 ? full : spread);
        }
        for (int k = 0; k <= rows; k++)
            EXPECT_NEAR(v[0][k], v[1][k], 1e-13);
        EXPECT(memcmp(full, spread, (size_t)(rows * (rows + 1)) * sizeof(double)) == 0);
        pattern_free(&pattern);
    }
}

static void least_squares_keeps_what_is_held(void)
{
    Rows rows = {.rows = 4, .columns = 2, .length = 2, .evaluate = circles};
    const bool held[2] = {true, false};
    double v[2] = {1.5, 1}, residual[4];

    EXPECT(!levenberg_marquardt_solve(&rows, held, NULL, 1e-12, v, residual));
    EXPECT_NEAR(v[0], 1.5, 0);
    /* the best y leaves both circles missed by the same */
    EXPECT(fabs(residual[0]) > 0.5 && fabs(residual[1]) > 0.5);
}

int main(void)
{
    RUN(lu_solves_random_systems);
    RUN(lu_refuses_singular_and_undefined_matrices);
    RUN(kkt_and_embedded_form_agree);
    RUN(wanted_speeds_become_independent);
    RUN(a_choice_that_fails_leaves_the_one_before);
    RUN(sparse_and_full_elimination_agree);
    RUN(corrections_settle_when_they_are_corrected);
    RUN(rows_in_use_may_be_others);
    RUN(massless_speeds_are_held_by_their_constraints);
    RUN(a_free_massless_speed_has_no_acceleration);
    RUN(a_row_that_fades_is_regularised);
    RUN(a_massless_speed_hides_no_row_that_fades);
    RUN(a_light_part_between_heavy_ones_is_no_singularity);
    RUN(what_is_only_nearly_singular_is_exact);
    RUN(rank_finds_the_row_that_follows);
    RUN(long_work_asks_whether_to_stop);
    RUN(rank_is_that_of_the_making);
    RUN(least_multipliers_give_the_same_forces);
    RUN(least_squares_goes_to_the_near_solution);
    RUN(sparse_least_squares_agree_with_full_ones);
    RUN(least_squares_keeps_what_is_held);
    return test_end();
}
