/* test_kkt_border.c: a platform on many legs, its matrix made up here: what elimination takes, what
 * it says where legs are stretched, held against GSL's matrices in full */
#include "algebra/kkt.h"

#include "test.h"

#include <gsl/gsl_linalg.h>

enum { MOST = 96, SPEEDS = 2 * MOST + 3, ROWS = 2 * MOST };

/* n planar legs of two links each, pinned to the ground and to a platform, whose x, y and angle
 * come last */
typedef struct Robot {
    int n;
    double length[MOST][2], angle[MOST][2], pin[MOST][2]; /* angles: of the first link, between */
    Pattern mass, rows;
    double masses[4 * MOST + 9], entries[8 * MOST];
    int mass_at[4 * MOST + 9], entry_at[8 * MOST], order[ROWS];
    Kkt *kkt;
} Robot;

static void open_patterns(Robot *r)
{
    int row[8 * MOST], column[8 * MOST], count = 0;

    for (int i = 0; i < r->n; i++)
        for (int k = 0; k < 4; k++, count++) {
            row[count] = 2 * i + k / 2;
            column[count] = 2 * i + k % 2;
        }
    for (int k = 0; k < 9; k++, count++) {
        row[count] = 2 * r->n + k / 3;
        column[count] = 2 * r->n + k % 3;
    }
    r->mass = pattern_of(2 * r->n + 3, 2 * r->n + 3, count, row, column, r->mass_at);
    for (int i = 0; i < 2 * r->n; i++)
        for (int k = 0; k < 4; k++) {
            row[4 * i + k] = k < 2 ? 2 * (i / 2) + k : 2 * r->n + (k == 2 ? i % 2 : 2);
            column[4 * i + k] = i;
        }
    r->rows = pattern_of(2 * r->n + 3, 2 * r->n, 8 * r->n, row, column, r->entry_at);
}

static void draw_masses(uint64_t *seed, Robot *r)
{
    const double spread[] = {0, 2, 4};
    const double decades = spread[(int)test_uniform(seed, 0, 3)];
    int at = 0;

    for (int i = 0; i < r->n; i++) {
        const double size = pow(10, test_uniform(seed, -decades / 2, decades / 2));
        const double coupling = test_uniform(seed, -0.5, 0.5);
        const double block[] = {size, coupling * size, coupling * size, size};

        for (int k = 0; k < 4; k++)
            r->masses[r->mass_at[at++]] = block[k];
    }
    for (int k = 0; k < 9; k++)
        r->masses[r->mass_at[at++]] = k % 4 == 0 ? test_uniform(seed, 0.5, 2) : 0;
}

/* G where the angles are: motion of the platform's pin less that of the leg's tip */
static void put_rows(Robot *r)
{
    for (int i = 0; i < r->n; i++) {
        const double *l = r->length[i], a = r->angle[i][0], b = a + r->angle[i][1];
        const double x = l[0] * cos(a) + l[1] * cos(b), y = l[0] * sin(a) + l[1] * sin(b);
        const double of[2][4] = {{y, l[1] * sin(b), 1, -r->pin[i][1]},
                                 {-x, -l[1] * cos(b), 1, r->pin[i][0]}};

        for (int k = 0; k < 8; k++)
            r->entries[r->entry_at[8 * i + k]] = of[k / 4][k % 4];
    }
}

static void open_robot(uint64_t *seed, int n, Robot *r)
{
    r->n = n;
    open_patterns(r);
    draw_masses(seed, r);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 2; k++) {
            r->order[2 * i + k] = 2 * i + k;
            r->length[i][k] = test_uniform(seed, 0.5, 1.5);
            r->pin[i][k] = test_uniform(seed, -1, 1);
        }
    r->kkt = kkt_new(&r->mass, &r->rows, r->order, 2 * n);
}

static void close_robot(Robot *r)
{
    kkt_free(r->kkt);
    pattern_free(&r->mass);
    pattern_free(&r->rows);
}

/* anywhere, but for `stretched` legs, which lack `left` rad */
static void draw_angles(uint64_t *seed, Robot *r, int stretched, double left)
{
    for (int i = 0; i < r->n; i++) {
        r->angle[i][0] = test_uniform(seed, -3, 3);
        r->angle[i][1] = i < stretched ? left : test_uniform(seed, 1, 2);
    }
    put_rows(r);
}

/* [M G^T; G 0] in full, in the order of its unknowns; new */
static gsl_matrix *in_full(const Robot *r)
{
    const int nu = 2 * r->n + 3;
    gsl_matrix *a = gsl_matrix_calloc(4 * (size_t)r->n + 3, 4 * (size_t)r->n + 3);

    for (int k = 0; k < r->mass.count; k++)
        gsl_matrix_set(a, (size_t)r->mass.row[k], (size_t)r->mass.column[k], r->masses[k]);
    for (int k = 0; k < r->rows.count; k++) {
        const size_t i = (size_t)r->rows.row[k], j = (size_t)nu + (size_t)r->rows.column[k];

        gsl_matrix_set(a, i, j, r->entries[k]);
        gsl_matrix_set(a, j, i, r->entries[k]);
    }
    return a;
}

/* G, columns over their largest entry, then rows of unit length; its least singular value */
static double least_singular_value(const Robot *r)
{
    const size_t nu = 2 * (size_t)r->n + 3, m = 2 * (size_t)r->n;
    gsl_matrix *g = gsl_matrix_calloc(nu, m), *v = gsl_matrix_alloc(m, m);
    gsl_vector *s = gsl_vector_alloc(m), *work = gsl_vector_alloc(m);
    double out;

    for (int k = 0; k < r->rows.count; k++)
        gsl_matrix_set(g, (size_t)r->rows.row[k], (size_t)r->rows.column[k], r->entries[k]);
    for (size_t i = 0; i < nu; i++) {
        gsl_vector_view row = gsl_matrix_row(g, i);
        const double most = fmax(gsl_vector_max(&row.vector), -gsl_vector_min(&row.vector));

        gsl_vector_scale(&row.vector, 1 / most);
    }
    for (size_t k = 0; k < m; k++) {
        double square = 0;
        gsl_vector_view column = gsl_matrix_column(g, k);

        for (size_t i = 0; i < nu; i++)
            square += pow(gsl_vector_get(&column.vector, i), 2);
        gsl_vector_scale(&column.vector, 1 / sqrt(square));
    }
    (void)gsl_linalg_SV_decomp(g, v, s, work);
    out = gsl_vector_get(s, m - 1);
    gsl_matrix_free(g);
    gsl_matrix_free(v);
    gsl_vector_free(s);
    gsl_vector_free(work);
    return out;
}

/* how far du is off the least-squares solution of least norm, over its largest entry */
static double error_of(const Robot *r, const double *top, const double *bottom, const double *du)
{
    const size_t size = 4 * (size_t)r->n + 3;
    const int nu = 2 * r->n + 3;
    gsl_matrix *a = in_full(r), *v = gsl_matrix_alloc(size, size);
    gsl_vector *s = gsl_vector_alloc(size), *x = gsl_vector_alloc(size),
               *b = gsl_vector_alloc(size);
    double error = 0, largest = 0;

    for (int i = 0; i < (int)size; i++)
        gsl_vector_set(b, (size_t)i, i < nu ? top[i] : bottom[i - nu]);
    (void)gsl_linalg_SV_decomp(a, v, s, x);
    for (size_t i = 0; i < size; i++)
        if (gsl_vector_get(s, i) < 1e-13 * gsl_vector_get(s, 0))
            gsl_vector_set(s, i, 0);
    (void)gsl_linalg_SV_solve(a, v, s, b, x);
    for (int i = 0; i < nu; i++) {
        error = fmax(error, fabs(gsl_vector_get(x, (size_t)i) - du[i]));
        largest = fmax(largest, fabs(du[i]));
    }
    gsl_matrix_free(a);
    gsl_matrix_free(v);
    gsl_vector_free(s);
    gsl_vector_free(x);
    gsl_vector_free(b);
    return error / largest;
}

static double solve_somewhere(uint64_t *seed, Robot *r, bool at_rest)
{
    double top[SPEEDS] = {0}, bottom[ROWS] = {0}, du[SPEEDS], lambda[ROWS];

    for (int i = 0; i < 2 * r->n + 3; i++)
        top[i] = test_uniform(seed, -1, 1);
    for (int i = 0; i < 2 * r->n; i++)
        bottom[i] = at_rest ? 0 : test_uniform(seed, -1, 1);
    EXPECT(kkt_factor(r->kkt, r->masses, r->entries, r->order));
    kkt_solve(r->kkt, top, bottom, du, lambda);
    return error_of(r, top, bottom, du);
}

static void the_work_is_linear_in_the_legs(void)
{
    uint64_t seed = 1;
    double before = 0;

    for (int n = 12; n <= MOST; n *= 2) {
        Robot r;

        open_robot(&seed, n, &r);
        draw_angles(&seed, &r, 0, 0);
        EXPECT(kkt_factor(r.kkt, r.masses, r.entries, r.order));
        EXPECT(n == 12 || (kkt_products(r.kkt) > 1.8 * before));
        EXPECT(n == 12 || (kkt_products(r.kkt) < 2.2 * before));
        before = kkt_products(r.kkt);
        close_robot(&r);
    }
}

/* Whatever its own links leave of a row, all of them determine the motion. */
static void stretched_legs_make_nothing_singular(void)
{
    uint64_t seed = 2;
    int asked = 0;

    for (int trial = 0; trial < 40; trial++) {
        const double left[] = {0, 1e-9, 1e-5, 1e-3, 0.1};
        Robot r;

        open_robot(&seed, 12, &r);
        for (int stretched = 3; stretched >= 0; stretched--) {
            draw_angles(&seed, &r, stretched, left[trial % 5]);
            if (least_singular_value(&r) < 0.02)
                continue;
            asked++;
            EXPECT(solve_somewhere(&seed, &r, false) < 1e-9);
            EXPECT(!kkt_is_regularised(r.kkt));
        }
        close_robot(&r);
    }
    EXPECT(asked > 100);
}

/* One order serves for legs that are stretched one after the other, and forgets them. */
static void the_order_follows_the_motion(void)
{
    uint64_t seed = 3;
    double least = INFINITY, most = 0;
    Robot r;

    open_robot(&seed, 24, &r);
    draw_angles(&seed, &r, 0, 0);
    for (int step = 0; step < 24 * 20; step++) {
        const int leg = step / 20;

        r.angle[leg][1] = fabs(step % 20 - 10.0) / 10 + 1e-12;
        put_rows(&r);
        if (step % 5 == 0)
            EXPECT(solve_somewhere(&seed, &r, false) < 1e-8);
        else
            (void)kkt_factor(r.kkt, r.masses, r.entries, r.order);
        least = fmin(least, kkt_products(r.kkt));
        most = fmax(most, kkt_products(r.kkt));
    }
    EXPECT(most > least && most < 1.5 * least);
    close_robot(&r);
}

/* Four stretched legs leave a platform one equation too many: a singular position. How near it is
 * follows the least singular value, whichever row comes last. */
static void more_of_them_than_freedoms_do(void)
{
    uint64_t seed = 4;

    for (int trial = 0; trial < 20; trial++) {
        const uint64_t same = seed;

        for (int decade = 1; decade <= 7; decade++) {
            const double left = decade == 7 ? 0 : pow(10, -decade);
            double near, least;
            Robot r;

            seed = same;
            open_robot(&seed, 12, &r);
            draw_angles(&seed, &r, 4, left);
            near = kkt_independence(r.kkt, r.entries, r.order);
            EXPECT(!kkt_is_factored(r.kkt));
            least = least_singular_value(&r);
            EXPECT(near >= 0.999 * least - 1e-12 && near < 10 * least + 3e-3);
            EXPECT(left > 0 || solve_somewhere(&seed, &r, true) < 1e-5);
            EXPECT(kkt_factor(r.kkt, r.masses, r.entries, r.order));
            EXPECT(kkt_is_regularised(r.kkt) == (near * near <= 1e-5));
            EXPECT((kkt_rounding_error(r.kkt) > 0) == (near * near < 1e-2));
            EXPECT(least > 5e-4 || kkt_is_regularised(r.kkt));
            close_robot(&r);
        }
    }
}

int main(void)
{
    RUN(the_work_is_linear_in_the_legs);
    RUN(stretched_legs_make_nothing_singular);
    RUN(the_order_follows_the_motion);
    RUN(more_of_them_than_freedoms_do);
    return test_end();
}
