/* kkt.c: dense KKT solver with scaling and quasi-definite regularisation */
#include "algebra/kkt.h"

#include "algebra/linear.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

#define NEAR     1e-2 /* pivot ratio of G G^T; below: a singular configuration isn't far, */
#define SINGULAR 1e-5 /* and here epsilon is needed */
#define SUSPECT  1e-1 /* pivot ratio of the LU above which nothing can be near singular */
#define ROUNDED                                                                                    \
    1e-14 /* of speeds, once over a pivot: what rounding of positions leaves of them               \
           */
#define MOST_BLUR   1e-8  /* what epsilon makes of that */
#define INEXACT     3e-2  /* pivot ratio of the LU below which a sweep of refinement is due, */
#define SETTLED     1e-11 /* and another where it corrects more than this */
#define EPSILON     1e-8  /* of the largest diagonal entry of G M^-1 G^T */
#define SWEEPS      2     /* of refinement at least, */
#define MOST_SWEEPS 30    /* and as long as each leaves less than */
#define CONTRACTION 0.3   /* of the correction before: what is slower, epsilon is to hold back */
#define ROUNDING    1e-15
#define LEAST_REACH 1e-9 /* of the largest: what is less is rounding */

struct Kkt {
    int nu, m, size;
    double *matrix; /* scaled, as it is, for residuals */
    double *scale;  /* size: unknown = scale * scaled unknown */
    double *norm;   /* of all rows: largest mass-norm of each so far */
    /* largest entry of each column, and norm of each of all rows, so far */
    double *reach, *row_reach;
    double *right, *answer, *residual;
    double *factor;     /* nu x nu, a Cholesky factor */
    double *bound;      /* m x nu */
    double *compliance; /* m x m */
    Lu *lu;
    const Watch *watch;
    double pivot; /* of the last configuration: how independent its rows are */
    bool regularised;
};

Kkt *kkt_new(int nu, int m, int all)
{
    Kkt *kkt = NEW(Kkt);
    int size = nu + m;

    kkt->nu = nu;
    kkt->m = m;
    kkt->size = size;
    kkt->matrix = NEW_ARRAY(double, size *size);
    kkt->scale = NEW_ARRAY(double, size);
    kkt->norm = NEW_ARRAY(double, all);
    kkt->reach = NEW_ARRAY(double, nu);
    kkt->row_reach = NEW_ARRAY(double, all);
    kkt->right = NEW_ARRAY(double, size);
    kkt->answer = NEW_ARRAY(double, size);
    kkt->residual = NEW_ARRAY(double, size);
    kkt->factor = NEW_ARRAY(double, nu *nu);
    kkt->bound = NEW_ARRAY(double, m *nu);
    kkt->compliance = NEW_ARRAY(double, m *m);
    kkt->lu = lu_new(size);
    return kkt;
}

void kkt_set_watch(Kkt *kkt, const Watch *watch)
{
    kkt->watch = watch;
}

void kkt_free(Kkt *kkt)
{
    if (kkt == NULL)
        return;
    mem_free(kkt->matrix);
    mem_free(kkt->scale);
    mem_free(kkt->norm);
    mem_free(kkt->reach);
    mem_free(kkt->row_reach);
    mem_free(kkt->right);
    mem_free(kkt->answer);
    mem_free(kkt->residual);
    mem_free(kkt->factor);
    mem_free(kkt->bound);
    mem_free(kkt->compliance);
    lu_free(kkt->lu);
    mem_free(kkt);
}

/* A speed without mass of its own takes the mass that gives it the same weight in its
 * constraints as its heaviest-felt neighbour has. */
static double borrowed_mass(const Kkt *kkt, const double *mass, const double *phi_u,
                            const int *rows, int i)
{
    int nu = kkt->nu;
    double borrowed = 0;

    for (int k = 0; k < kkt->m; k++) {
        const double *row = phi_u + rows[k] * nu;
        double strongest = 0; /* of g_j^2 / M_jj */

        for (int j = 0; j < nu; j++)
            if (mass[j * nu + j] > 0)
                strongest = fmax(strongest, row[j] * row[j] / mass[j * nu + j]);
        if (strongest > 0)
            borrowed = fmax(borrowed, row[i] * row[i] / strongest);
    }
    return borrowed;
}

/* A row is measured against the largest it has been: one that vanishes at a singular position is to
 * be seen vanishing. */
static void choose_scale(Kkt *kkt, const double *mass, const double *phi_u, const int *rows)
{
    int nu = kkt->nu;
    double largest = 0, most = 0;

    for (int i = 0; i < nu; i++)
        most = fmax(most, mass[i * nu + i]);
    for (int i = 0; i < nu; i++) {
        double own = mass[i * nu + i];

        if (!(own > 1e-9 * most))
            own = fmax(own, borrowed_mass(kkt, mass, phi_u, rows, i));
        kkt->scale[i] = own > 0 ? 1 / sqrt(own) : 1;
    }
    for (int k = 0; k < kkt->m; k++) {
        const double *row = phi_u + rows[k] * nu;
        double norm = 0;

        for (int i = 0; i < nu; i++)
            norm += row[i] * kkt->scale[i] * row[i] * kkt->scale[i];
        kkt->norm[rows[k]] = fmax(kkt->norm[rows[k]], sqrt(norm));
        largest = fmax(largest, kkt->norm[rows[k]]);
    }
    for (int k = 0; k < kkt->m; k++) {
        double norm = fmax(kkt->norm[rows[k]], 1e-3 * largest);

        kkt->scale[nu + k] = norm > 0 ? 1 / norm : 1;
    }
}

static void fill_matrix(Kkt *kkt, const double *mass, const double *phi_u, const int *rows)
{
    int nu = kkt->nu, size = kkt->size;
    double *a = kkt->matrix;

    for (int i = 0; i < nu; i++)
        for (int j = 0; j < nu; j++)
            a[i * size + j] = mass[i * nu + j] * kkt->scale[i] * kkt->scale[j];
    for (int k = 0; k < kkt->m; k++)
        for (int i = 0; i < nu; i++) {
            double entry = phi_u[rows[k] * nu + i] * kkt->scale[i] * kkt->scale[nu + k];

            a[(nu + k) * size + i] = entry;
            a[i * size + nu + k] = entry;
        }
}

/* kkt->factor = Cholesky factor of M, scaled; false when it isn't positive definite */
static bool factor_mass(Kkt *kkt)
{
    int nu = kkt->nu;

    for (int i = 0; i < nu; i++)
        memcpy(kkt->factor + i * nu, kkt->matrix + i * kkt->size, (size_t)nu * sizeof(double));
    return cholesky_factor(kkt->factor, nu) > 1e-14;
}

/* kkt->bound (m x nu) = G L^-T, L the factor: its rows' products are G (L L^T)^-1 G^T */
static void find_bound(Kkt *kkt)
{
    int nu = kkt->nu;

    for (int k = 0; k < kkt->m; k++) {
        double *row = kkt->bound + k * nu;

        memcpy(row, kkt->matrix + (nu + k) * kkt->size, (size_t)nu * sizeof(double));
        cholesky_forward(kkt->factor, nu, row);
    }
}

static double dot(const double *a, const double *b, int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Lengths are told from angles by the largest entry that each column has had: what a unit of the
 * speed moves. */
static void measure_columns(Kkt *kkt, const double *phi_u, const int *rows)
{
    for (int k = 0; k < kkt->m; k++)
        for (int i = 0; i < kkt->nu; i++)
            kkt->reach[i] = fmax(kkt->reach[i], fabs(phi_u[rows[k] * kkt->nu + i]));
}

/* How independent the rows of G are: the least pivot of G G^T, columns of G over their reach, rows
 * over the largest norm that they have had. Those of the LU only raise suspicion: an exchange of
 * rows splits one of size sigma^2 into two of size sigma, and light parts between heavy ones make
 * small pivots that are none of the geometry's. */
static double least_pivot(Kkt *kkt, const double *phi_u, const int *rows)
{
    const int m = kkt->m, nu = kkt->nu;
    const double least = LEAST_REACH * vector_largest(kkt->reach, nu);
    double *s = kkt->compliance, *g = kkt->bound;

    for (int k = 0; k < m; k++) {
        double norm;

        for (int i = 0; i < nu; i++)
            g[k * nu + i] = phi_u[rows[k] * nu + i] / fmax(kkt->reach[i], least);
        norm = fmax(kkt->row_reach[rows[k]], sqrt(dot(g + k * nu, g + k * nu, nu)));
        kkt->row_reach[rows[k]] = norm;
        for (int i = 0; i < nu && norm > 0; i++)
            g[k * nu + i] /= norm;
    }
    matrix_gram(g, m, nu, s);
    return fmax(0, cholesky_factor(s, m));
}

/* largest diagonal entry of G M^-1 G^T, scaled; 1 where M can't be inverted */
static double largest_compliance(Kkt *kkt)
{
    double largest = 1;

    if (!factor_mass(kkt))
        return 1;
    find_bound(kkt);
    for (int k = 0; k < kkt->m; k++) {
        const double *row = kkt->bound + k * kkt->nu;

        largest = fmax(largest, dot(row, row, kkt->nu));
    }
    return largest;
}

bool kkt_factor(Kkt *kkt, const double *mass, const double *phi_u, const int *rows)
{
    size_t bytes = (size_t)kkt->size * (size_t)kkt->size * sizeof(double);
    double epsilon;
    bool sound;

    choose_scale(kkt, mass, phi_u, rows);
    measure_columns(kkt, phi_u, rows);
    fill_matrix(kkt, mass, phi_u, rows);
    if (!vector_is_finite(kkt->matrix, kkt->size * kkt->size))
        return false;
    memcpy(lu_matrix(kkt->lu), kkt->matrix, bytes);
    kkt->regularised = false;
    sound = lu_factor_watched(kkt->lu, kkt->watch) && lu_pivot_ratio(kkt->lu) > 1e-14;
    kkt->pivot =
        kkt->m > 0 && lu_pivot_ratio(kkt->lu) < SUSPECT ? least_pivot(kkt, phi_u, rows) : 1;
    if (kkt->pivot > SINGULAR)
        return sound;

    kkt->regularised = true;
    epsilon = EPSILON * largest_compliance(kkt);
    memcpy(lu_matrix(kkt->lu), kkt->matrix, bytes);
    for (int k = kkt->nu; k < kkt->size; k++)
        lu_matrix(kkt->lu)[k * kkt->size + k] = -epsilon;
    return lu_factor_watched(kkt->lu, kkt->watch);
}

double kkt_independence(Kkt *kkt, const double *phi_u, const int *rows)
{
    measure_columns(kkt, phi_u, rows);
    return sqrt(least_pivot(kkt, phi_u, rows));
}

double kkt_blur(const Kkt *kkt)
{
    return kkt->pivot < NEAR ? fmin(MOST_BLUR, ROUNDED / (kkt->pivot + 1e-300)) : 0;
}

bool kkt_is_regularised(const Kkt *kkt)
{
    return kkt->regularised;
}

/* the size of the correction. One sweep makes the solution exact to what the rows themselves
 * determine, however they are scaled (Skeel 1980): masses many decades apart. */
static double refine_once(Kkt *kkt)
{
    matrix_times(kkt->matrix, kkt->size, kkt->size, kkt->answer, kkt->residual);
    for (int i = 0; i < kkt->size; i++)
        kkt->residual[i] = kkt->right[i] - kkt->residual[i];
    lu_solve(kkt->lu, kkt->residual);
    for (int i = 0; i < kkt->size; i++)
        kkt->answer[i] += kkt->residual[i];
    return vector_largest(kkt->residual, kkt->size);
}

static void refine(Kkt *kkt, int least, double enough)
{
    double before = INFINITY;

    for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
        const double size = refine_once(kkt);

        if (size <= enough * vector_largest(kkt->answer, kkt->size) ||
            (sweep + 1 >= least && !(size < CONTRACTION * before)))
            break;
        before = size;
    }
}

void kkt_solve(Kkt *kkt, const double *top, const double *bottom, double *du, double *lambda)
{
    int nu = kkt->nu;

    for (int i = 0; i < nu; i++)
        kkt->right[i] = top != NULL ? top[i] * kkt->scale[i] : 0;
    for (int k = 0; k < kkt->m; k++)
        kkt->right[nu + k] = bottom[k] * kkt->scale[nu + k];
    memcpy(kkt->answer, kkt->right, (size_t)kkt->size * sizeof(double));
    lu_solve(kkt->lu, kkt->answer);
    if (kkt->regularised)
        refine(kkt, SWEEPS, ROUNDING);
    else if (lu_pivot_ratio(kkt->lu) < INEXACT)
        refine(kkt, 1, SETTLED);
    for (int i = 0; i < nu; i++)
        du[i] = kkt->answer[i] * kkt->scale[i];
    for (int k = 0; k < kkt->m; k++)
        lambda[k] = kkt->answer[nu + k] * kkt->scale[nu + k];
}
