/* partitioning.c: partitioned elimination of constrained speeds
 *
 * Which speeds depend on others is found by Gauss's elimination with the largest pivot among those
 * that nobody wants independent; where these are used up, among all. Library factorisations take
 * no such wish. */
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
    double *work;     /* m x nu, of the choice; a column elsewhere */
    double *particular, *force, *reduced;
    double ratio, chosen_ratio; /* of Phi_d: now; when it was chosen */
    Lu *phi_d, *small;
};

Partitioning *partitioning_new(int nu, int m)
{
    Partitioning *e = NEW(Partitioning);

    e->nu = nu;
    e->m = m;
    e->f = nu - m;
    e->dependent = NEW_ARRAY(int, m);
    e->independent = NEW_ARRAY(int, e->f);
    e->mass = NEW_ARRAY(double, nu *nu);
    e->g = NEW_ARRAY(double, nu * e->f);
    e->work = NEW_ARRAY(double, (m + 1) * nu);
    e->particular = NEW_ARRAY(double, nu);
    e->force = NEW_ARRAY(double, nu);
    e->reduced = NEW_ARRAY(double, nu);
    e->phi_d = lu_new(m);
    e->small = lu_new(e->f);
    return e;
}

void partitioning_free(Partitioning *e)
{
    if (e == NULL)
        return;
    mem_free(e->dependent);
    mem_free(e->independent);
    mem_free(e->mass);
    mem_free(e->g);
    mem_free(e->work);
    mem_free(e->particular);
    mem_free(e->force);
    mem_free(e->reduced);
    lu_free(e->phi_d);
    lu_free(e->small);
    mem_free(e);
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
static double eliminate_one(Partitioning *e, int k, const bool *open, int *column)
{
    double best = 0;
    int row = k;

    for (int i = k; i < e->m; i++)
        for (int j = 0; j < e->nu; j++)
            if (open[j] && fabs(e->work[i * e->nu + j]) > best) {
                best = fabs(e->work[i * e->nu + j]);
                row = i;
                *column = j;
            }
    if (best == 0)
        return 0;
    exchange_rows(e->work, e->nu, k, row);
    for (int i = k + 1; i < e->m; i++) {
        double factor = e->work[i * e->nu + *column] / e->work[k * e->nu + *column];

        for (int j = 0; j < e->nu; j++)
            e->work[i * e->nu + j] -= factor * e->work[k * e->nu + j];
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

bool partitioning_choose(Partitioning *e, const double *phi_u, const int *rows, const int *wanted,
                         int wanted_count)
{
    bool *open = NEW_ARRAY(bool, e->nu);
    double largest = 0;
    int k = 0;
    int left = 0;

    for (int i = 0; i < e->m; i++)
        memcpy(e->work + i * e->nu, phi_u + rows[i] * e->nu, (size_t)e->nu * sizeof(double));
    for (int j = 0; j < e->nu; j++)
        open[j] = !is_in(wanted, wanted_count, j);
    for (; k < e->m; k++) {
        int column = 0;
        double pivot = eliminate_one(e, k, open, &column);

        largest = fmax(largest, pivot);
        if (!(pivot > 1e-8 * largest)) { /* the wanted speeds can't all be independent */
            for (int j = 0; j < e->nu; j++)
                open[j] = !is_in(e->dependent, k, j);
            pivot = eliminate_one(e, k, open, &column);
        }
        if (!(pivot > 1e-12 * largest))
            break;
        e->dependent[k] = column;
        open[column] = false;
    }
    for (int j = 0; k == e->m && j < e->nu; j++)
        if (!is_in(e->dependent, e->m, j))
            e->independent[left++] = j;
    e->chosen_ratio = 0;
    mem_free(open);
    return k == e->m;
}

const int *partitioning_independent(const Partitioning *e)
{
    return e->independent;
}

double partitioning_condition(const Partitioning *e)
{
    return e->chosen_ratio > 0 ? e->ratio / e->chosen_ratio : 1;
}

double partitioning_pivots(const Partitioning *e)
{
    return e->ratio;
}

/* u_d of a speed whose independent part is given: Phi_d u_d = right - Phi_i u_i, right in `column`
 */
static void solve_dependent(const Partitioning *e, double *column, double *out, int stride)
{
    lu_solve(e->phi_d, column);
    for (int k = 0; k < e->m; k++)
        out[e->dependent[k] * stride] = column[k];
}

bool partitioning_factor(Partitioning *e, const double *mass, const double *phi_u, const int *rows)
{
    double *small = lu_matrix(e->small);

    memcpy(e->mass, mass, (size_t)(e->nu * e->nu) * sizeof(double));
    for (int k = 0; k < e->m; k++)
        for (int j = 0; j < e->m; j++)
            lu_matrix(e->phi_d)[k * e->m + j] = phi_u[rows[k] * e->nu + e->dependent[j]];
    if (!lu_factor(e->phi_d))
        return false;
    e->ratio = lu_pivot_ratio(e->phi_d);
    if (e->chosen_ratio == 0)
        e->chosen_ratio = e->ratio;
    memset(e->g, 0, (size_t)(e->nu * e->f) * sizeof(double));
    for (int i = 0; i < e->f; i++) {
        for (int k = 0; k < e->m; k++)
            e->work[k] = -phi_u[rows[k] * e->nu + e->independent[i]];
        solve_dependent(e, e->work, e->g + i, e->f);
        e->g[e->independent[i] * e->f + i] = 1;
    }
    for (int i = 0; i < e->f; i++) { /* G^T M G, a column at a time */
        for (int j = 0; j < e->nu; j++) {
            e->particular[j] = 0;
            for (int k = 0; k < e->nu; k++)
                e->particular[j] += mass[j * e->nu + k] * e->g[k * e->f + i];
        }
        partitioning_reduce(e, e->particular, e->reduced);
        for (int j = 0; j < e->f; j++)
            small[j * e->f + i] = e->reduced[j];
    }
    return lu_factor(e->small);
}

void partitioning_reduce(const Partitioning *e, const double *v, double *out)
{
    for (int i = 0; i < e->f; i++) {
        out[i] = 0;
        for (int j = 0; j < e->nu; j++)
            out[i] += e->g[j * e->f + i] * v[j];
    }
}

void partitioning_solve(Partitioning *e, const double *force, const double *gamma, double *du)
{
    /* a particular solution of Phi_u p = gamma, then what is left along G */
    memset(e->particular, 0, (size_t)e->nu * sizeof(double));
    memcpy(e->work, gamma, (size_t)e->m * sizeof(double));
    solve_dependent(e, e->work, e->particular, 1);
    matrix_times(e->mass, e->nu, e->nu, e->particular, e->force);
    for (int j = 0; j < e->nu; j++)
        e->force[j] = force[j] - e->force[j];
    partitioning_reduce(e, e->force, e->reduced);
    lu_solve(e->small, e->reduced);
    for (int j = 0; j < e->nu; j++) {
        double sum = e->particular[j];

        for (int i = 0; i < e->f; i++)
            sum += e->g[j * e->f + i] * e->reduced[i];
        du[j] = sum;
    }
}
