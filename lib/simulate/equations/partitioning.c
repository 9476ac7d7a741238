/* partitioning.c: coordinate partitioning (Wehage, Haug 1982): elimination of dependent speeds
 *
 * Dependent speeds are chosen by Gaussian elimination with the largest pivot among the speeds that
 * are not wanted as independent; when these are used up, among all. Factorisations of libraries
 * have no such preference. */
#include "simulate/equations/partitioning.h"

#include "algebra/linear.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

struct Partitioning {
    int nu, m, f;
    int *dependent;   /* m */
    int *independent; /* f */
    double *mass;     /* nu x nu, borrowed at the last factor */
    double *g;        /* nu x f */
    double *work;     /* m x nu while choosing; a column elsewhere */
    double *particular, *force, *reduced;
    double ratio, chosen_ratio; /* pivot ratio of Phi_d: now; when it was chosen */
    Lu *phi_d, *small;
};

Partitioning *partitioning_new(int nu, int m)
{
    Partitioning *p = NEW(Partitioning);

    p->nu = nu;
    p->m = m;
    p->f = nu - m;
    p->dependent = NEW_ARRAY(int, m);
    p->independent = NEW_ARRAY(int, p->f);
    p->mass = NEW_ARRAY(double, nu *nu);
    p->g = NEW_ARRAY(double, nu * p->f);
    p->work = NEW_ARRAY(double, (m + 1) * nu);
    p->particular = NEW_ARRAY(double, nu);
    p->force = NEW_ARRAY(double, nu);
    p->reduced = NEW_ARRAY(double, nu);
    p->phi_d = lu_new(m);
    p->small = lu_new(p->f);
    return p;
}

void partitioning_free(Partitioning *p)
{
    if (p == NULL)
        return;
    MEM_FREE(p->dependent, p->independent, p->mass, p->g, p->work, p->particular, p->force,
             p->reduced);
    lu_free(p->phi_d);
    lu_free(p->small);
    mem_free(p);
}

static void exchange_rows(double *a, int n, int i, int j)
{
    for (int k = 0; k < n && i != j; k++) {
        double kept = a[i * n + k];

        a[i * n + k] = a[j * n + k];
        a[j * n + k] = kept;
    }
}

/* Eliminate with the largest entry among columns of `open`; 0 when none is left. */
static double eliminate_one(Partitioning *p, int k, const bool *open, int *column)
{
    double best = 0;
    int row = k;

    for (int i = k; i < p->m; i++)
        for (int j = 0; j < p->nu; j++)
            if (open[j] && fabs(p->work[i * p->nu + j]) > best) {
                best = fabs(p->work[i * p->nu + j]);
                row = i;
                *column = j;
            }
    if (best == 0)
        return 0;
    exchange_rows(p->work, p->nu, k, row);
    for (int i = k + 1; i < p->m; i++) {
        double factor = p->work[i * p->nu + *column] / p->work[k * p->nu + *column];

        for (int j = 0; j < p->nu; j++)
            p->work[i * p->nu + j] -= factor * p->work[k * p->nu + j];
    }
    return best;
}

static bool is_in(const int *list, int count, int item)
{
    for (int i = 0; i < count; i++)
        if (list[i] == item)
            return true;
    return false;
}

bool partitioning_choose(Partitioning *p, const double *phi_u, const int *rows, const int *wanted,
                         int wanted_count)
{
    bool *open = NEW_ARRAY(bool, p->nu);
    int *dependent = NEW_ARRAY(int, p->m);
    double largest = 0;
    int k = 0;
    int left = 0;

    for (int i = 0; i < p->m; i++)
        memcpy(p->work + i * p->nu, phi_u + rows[i] * p->nu, (size_t)p->nu * sizeof(double));
    for (int j = 0; j < p->nu; j++)
        open[j] = !is_in(wanted, wanted_count, j);
    for (; k < p->m; k++) {
        int column = 0;
        double pivot = eliminate_one(p, k, open, &column);

        largest = fmax(largest, pivot);
        if (!(pivot > 1e-8 * largest)) { /* the wanted speeds can't all be independent */
            for (int j = 0; j < p->nu; j++)
                open[j] = !is_in(dependent, k, j);
            pivot = eliminate_one(p, k, open, &column);
        }
        if (!(pivot > 1e-12 * largest))
            break;
        dependent[k] = column;
        open[column] = false;
    }
    if (k == p->m) {
        memcpy(p->dependent, dependent, (size_t)p->m * sizeof(int));
        for (int j = 0; j < p->nu; j++)
            if (!is_in(dependent, p->m, j))
                p->independent[left++] = j;
        p->chosen_ratio = 0;
    }
    MEM_FREE(open, dependent);
    return k == p->m;
}

const int *partitioning_independent(const Partitioning *p)
{
    return p->independent;
}

double partitioning_condition(const Partitioning *p)
{
    return p->chosen_ratio > 0 ? p->ratio / p->chosen_ratio : 1;
}

double partitioning_pivots(const Partitioning *p)
{
    return p->ratio;
}

/* u_d for a given independent part: Phi_d u_d = right - Phi_i u_i, right in `column` */
static void solve_dependent(const Partitioning *p, double *column, double *out, int stride)
{
    lu_solve(p->phi_d, column);
    for (int k = 0; k < p->m; k++)
        out[p->dependent[k] * stride] = column[k];
}

/* out[j] = (G^T v)_j, nu - m entries */
static void reduce(const Partitioning *p, const double *v, double *out)
{
    for (int i = 0; i < p->f; i++) {
        out[i] = 0;
        for (int j = 0; j < p->nu; j++)
            out[i] += p->g[j * p->f + i] * v[j];
    }
}

bool partitioning_factor(Partitioning *p, const double *mass, const double *phi_u, const int *rows)
{
    double *small = lu_matrix(p->small);

    memcpy(p->mass, mass, (size_t)(p->nu * p->nu) * sizeof(double));
    for (int k = 0; k < p->m; k++)
        for (int j = 0; j < p->m; j++)
            lu_matrix(p->phi_d)[k * p->m + j] = phi_u[rows[k] * p->nu + p->dependent[j]];
    if (!lu_factor(p->phi_d))
        return false;
    p->ratio = lu_pivot_ratio(p->phi_d);
    if (p->chosen_ratio == 0)
        p->chosen_ratio = p->ratio;
    memset(p->g, 0, (size_t)(p->nu * p->f) * sizeof(double));
    for (int i = 0; i < p->f; i++) {
        for (int k = 0; k < p->m; k++)
            p->work[k] = -phi_u[rows[k] * p->nu + p->independent[i]];
        solve_dependent(p, p->work, p->g + i, p->f);
        p->g[p->independent[i] * p->f + i] = 1;
    }
    for (int i = 0; i < p->f; i++) { /* G^T M G, a column at a time */
        for (int j = 0; j < p->nu; j++) {
            p->particular[j] = 0;
            for (int k = 0; k < p->nu; k++)
                p->particular[j] += mass[j * p->nu + k] * p->g[k * p->f + i];
        }
        reduce(p, p->particular, p->reduced);
        for (int j = 0; j < p->f; j++)
            small[j * p->f + i] = p->reduced[j];
    }
    return lu_factor(p->small);
}

void partitioning_solve(Partitioning *p, const double *force, const double *gamma, double *du)
{
    /* a particular solution of Phi_u p = gamma, then the rest along G */
    memset(p->particular, 0, (size_t)p->nu * sizeof(double));
    memcpy(p->work, gamma, (size_t)p->m * sizeof(double));
    solve_dependent(p, p->work, p->particular, 1);
    matrix_times(p->mass, p->nu, p->nu, p->particular, p->force);
    for (int j = 0; j < p->nu; j++)
        p->force[j] = force[j] - p->force[j];
    reduce(p, p->force, p->reduced);
    lu_solve(p->small, p->reduced);
    for (int j = 0; j < p->nu; j++) {
        double sum = p->particular[j];

        for (int i = 0; i < p->f; i++)
            sum += p->g[j * p->f + i] * p->reduced[i];
        du[j] = sum;
    }
}
