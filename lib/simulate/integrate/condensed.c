/* condensed.c: partition of the unknowns into D and R, and the Schur complement of D */
#include "simulate/integrate/condensed.h"

#include "algebra/linear.h"
#include "base/memory.h"

#include <complex.h>
#include <string.h>

struct Condensed {
    int n, determined, left; /* number of unknowns; of those in D; of those in R */
    int *order;              /* those of D, then those of R */
    double *jacobian;        /* in that order */
    double *through;         /* J_RD J_DR (left x left) */
    double s, alpha, beta;
    Lu *real, *pair; /* of R; of twice its size: for so many unknowns, */
    int factored;    /* -1: none */
    double *right;   /* 2 left */
    double *shared;  /* 2 determined: b_D / s */
};

Condensed *condensed_new(int n)
{
    Condensed *c = NEW(Condensed);

    c->n = n;
    c->factored = -1;
    c->order = NEW_ARRAY(int, n);
    c->jacobian = NEW_ARRAY(double, n *n);
    c->through = NEW_ARRAY(double, n *n);
    c->right = NEW_ARRAY(double, 2 * n);
    c->shared = NEW_ARRAY(double, 2 * n);
    return c;
}

void condensed_free(Condensed *c)
{
    if (c == NULL)
        return;
    lu_free(c->real);
    lu_free(c->pair);
    MEM_FREE(c->order, c->jacobian, c->through, c->right, c->shared, c);
}

/* --- J --- */

/* whether the rate of i depends neither on i nor on an unknown of D, and no rate of D on i */
static bool is_apart(const Condensed *c, const double *jacobian, int i)
{
    if (jacobian[i * c->n + i] != 0)
        return false;
    for (int k = 0; k < c->determined; k++) {
        const int j = c->order[k];

        if (jacobian[i * c->n + j] != 0 || jacobian[j * c->n + i] != 0)
            return false;
    }
    return true;
}

/* Choose D greedily, in the order of the unknowns. */
static void choose(Condensed *c, const double *jacobian)
{
    c->determined = c->left = 0;
    for (int i = 0; i < c->n; i++)
        if (is_apart(c, jacobian, i))
            c->order[c->determined++] = i;
    for (int i = 0, k = 0; i < c->n; i++)
        if (k < c->determined && c->order[k] == i)
            k++;
        else
            c->order[c->determined + c->left++] = i;
}

static const double *row_of(const Condensed *c, int i)
{
    return c->jacobian + (ptrdiff_t)i * c->n;
}

void condensed_set(Condensed *c, const double *jacobian)
{
    choose(c, jacobian);
    for (int i = 0; i < c->n; i++)
        for (int j = 0; j < c->n; j++)
            c->jacobian[i * c->n + j] = jacobian[c->order[i] * c->n + c->order[j]];
    memset(c->through, 0, (size_t)c->left * (size_t)c->left * sizeof(double));
    for (int d = 0; d < c->determined; d++)
        for (int j = 0; j < c->left; j++) {
            const double by = row_of(c, d)[c->determined + j];

            for (int i = 0; i < c->left && by != 0; i++)
                c->through[i * c->left + j] += row_of(c, c->determined + i)[d] * by;
        }
}

/* --- factors --- */

/* Replaces factors of another size. */
static void open_factors(Condensed *c, bool with_pair)
{
    if (c->factored != c->left) {
        lu_free(c->real);
        lu_free(c->pair);
        c->real = lu_new(c->left);
        c->pair = NULL;
        c->factored = c->left;
    }
    if (with_pair && c->pair == NULL)
        c->pair = lu_new(2 * c->left);
}

bool condensed_factor_real(Condensed *c, double s)
{
    const int n = c->left;
    double *a;

    c->s = s;
    open_factors(c, false);
    a = lu_matrix(c->real);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            a[i * n + j] = (i == j) * s - row_of(c, c->determined + i)[c->determined + j] -
                           c->through[i * n + j] / s;
    return lu_factor(c->real);
}

static bool factor_pair(Condensed *c, double alpha, double beta)
{
    const int n = c->left;
    const double complex over = 1 / (alpha - I * beta);
    double *b;

    c->alpha = alpha;
    c->beta = beta;
    open_factors(c, true);
    b = lu_matrix(c->pair);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const double entry = row_of(c, c->determined + i)[c->determined + j];
            const double through = c->through[i * n + j];
            double *pair = b + (ptrdiff_t)i * 2 * n + j;

            pair[0] = pair[2 * n * n + n] = (i == j) * alpha - entry - creal(over) * through;
            pair[n] = (i == j) * beta + cimag(over) * through;
            pair[2 * n * n] = -pair[n];
        }
    return lu_factor(c->pair);
}

bool condensed_factor(Condensed *c, double s, double alpha, double beta)
{
    return condensed_factor_real(c, s) && factor_pair(c, alpha, beta);
}

/* --- solutions --- */

/* J_RD x_D, of an unknown of R */
static double from_determined(const Condensed *c, int i, const double *determined)
{
    double sum = 0;

    for (int d = 0; d < c->determined; d++)
        sum += row_of(c, c->determined + i)[d] * determined[d];
    return sum;
}

/* J_DR x_R, of an unknown of D */
static double from_left(const Condensed *c, int d, const double *x)
{
    double sum = 0;

    for (int j = 0; j < c->left; j++)
        sum += row_of(c, d)[c->determined + j] * x[j];
    return sum;
}

void condensed_solve(Condensed *c, double *b)
{
    double *determined = c->shared;

    for (int d = 0; d < c->determined; d++)
        determined[d] = b[c->order[d]] / c->s;
    for (int i = 0; i < c->left; i++)
        c->right[i] = b[c->order[c->determined + i]] + from_determined(c, i, determined);
    lu_solve(c->real, c->right);
    for (int i = 0; i < c->left; i++)
        b[c->order[c->determined + i]] = c->right[i];
    for (int d = 0; d < c->determined; d++)
        b[c->order[d]] = determined[d] + from_left(c, d, c->right) / c->s;
}

void condensed_solve_pair(Condensed *c, double *b, double *other)
{
    const double complex over = 1 / (c->alpha - I * c->beta);
    double *determined = c->shared, *turned = determined + c->determined;

    for (int d = 0; d < c->determined; d++) {
        const double complex part = over * (b[c->order[d]] + I * other[c->order[d]]);

        determined[d] = creal(part);
        turned[d] = cimag(part);
    }
    for (int i = 0; i < c->left; i++) {
        c->right[i] = b[c->order[c->determined + i]] + from_determined(c, i, determined);
        c->right[c->left + i] = other[c->order[c->determined + i]] + from_determined(c, i, turned);
    }
    lu_solve(c->pair, c->right);
    for (int i = 0; i < c->left; i++) {
        b[c->order[c->determined + i]] = c->right[i];
        other[c->order[c->determined + i]] = c->right[c->left + i];
    }
    for (int d = 0; d < c->determined; d++) {
        const double complex part =
            over * (from_left(c, d, c->right) + I * from_left(c, d, c->right + c->left));

        b[c->order[d]] = determined[d] + creal(part);
        other[c->order[d]] = turned[d] + cimag(part);
    }
}
