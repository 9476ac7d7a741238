/* shifted.c: (s - J) d = b, dense, in Hessenberg form or by a network's sparse equations */
#include "simulate/integrate/shifted.h"

#include "algebra/linear.h"
#include "algebra/sparse.h"
#include "base/memory.h"
#include "simulate/integrate/condensed.h"
#include "simulate/integrate/integrate_limits.h"

#include <string.h>

struct Shifted {
    const Ode *ode;
    Counts *counts;
    int n;
    bool is_linear;
    /* dense */
    double *jacobian, *point, *column; /* rows of y' by n; y; its rate */
    Condensed *dense;
    /* of linear equations with few states: owned by them, or else here */
    const HessenbergForm *form;
    HessenbergForm *own_form;
    ShiftedFactors *form_real, *form_pair;
    /* sparse; entries of dF/dw and dF/dw' */
    int entries;
    const int *at_row, *at_column;
    double *still, *moving;
    double *w, *w_rate, *right, *values;
    Sparse *sparse_real, *sparse_pair;
    Sparse *rates; /* dF by the rates of y and the rest of w, where y has few entries */
};

static bool is_sparse(const Shifted *s)
{
    return s->ode->dae.is_index_one && s->n > SHIFTED_DENSE;
}

Shifted *shifted_new(const Ode *ode, Counts *counts)
{
    Shifted *s = NEW(Shifted);
    int n = ode->n, all = n + ode->quadratures;

    s->ode = ode;
    s->counts = counts;
    s->n = n;
    s->w = NEW_ARRAY(double, ode->dae.n);
    s->w_rate = NEW_ARRAY(double, ode->dae.n);
    s->right = NEW_ARRAY(double, 2 * (ode->dae.n > n ? ode->dae.n : n));
    if (is_sparse(s))
        return s;
    s->jacobian = NEW_ARRAY(double, all *n);
    s->point = NEW_ARRAY(double, all);
    s->column = NEW_ARRAY(double, all);
    return s;
}

void shifted_free(Shifted *s)
{
    if (s == NULL)
        return;
    MEM_FREE(s->jacobian, s->point, s->column);
    condensed_free(s->dense);
    sparse_free(s->rates);
    hessenberg_form_free(s->own_form);
    shifted_factors_free(s->form_real);
    shifted_factors_free(s->form_pair);
    MEM_FREE(s->still, s->moving, s->w, s->w_rate, s->right, s->values);
    sparse_free(s->sparse_real);
    sparse_free(s->sparse_pair);
    mem_free(s);
}

/* --- J --- */

static bool by_differences(Shifted *s, double t, const double *y, const double *rate)
{
    int n = s->n;

    /* for linear equations a long difference is the most accurate */
    double straight = s->is_linear ? fmax(1e-3, vector_largest(y, n)) : 0;

    memcpy(s->point, y, (size_t)(n + s->ode->quadratures) * sizeof(double));
    for (int j = 0; j < n; j++) {
        double h = straight > 0 ? straight : ode_increment(y[j]);

        s->point[j] = y[j] + h;
        h = s->point[j] - y[j];
        s->counts->evaluations++;
        if (!s->ode->rate(s->ode->context, t, s->point, s->column))
            return false;
        for (int i = 0; i < n; i++)
            s->jacobian[i * n + j] = (s->column[i] - rate[i]) / h;
        s->point[j] = y[j];
    }
    return true;
}

/* The pattern of s - J, and that of a complex s in real numbers: [a b; -b a], where dF/dw' alone
 * contributes to b. */
static void find_pattern(Shifted *s)
{
    int n = s->ode->dae.n;
    int *row, *column;

    s->entries = s->ode->dae.pattern(s->ode->dae.context, &s->at_row, &s->at_column);
    s->still = NEW_ARRAY(double, s->entries);
    s->moving = NEW_ARRAY(double, s->entries);
    s->values = NEW_ARRAY(double, 4 * s->entries);
    if (!is_sparse(s)) {
        s->rates = sparse_new(n, s->entries, s->at_row, s->at_column);
        return;
    }
    row = NEW_ARRAY(int, 4 * s->entries);
    column = NEW_ARRAY(int, 4 * s->entries);
    for (int k = 0; k < s->entries; k++)
        for (int part = 0; part < 4; part++) {
            row[4 * k + part] = s->at_row[k] + n * (part / 2);
            column[4 * k + part] = s->at_column[k] + n * (part % 2);
        }
    s->sparse_real = sparse_new(n, s->entries, s->at_row, s->at_column);
    s->sparse_pair = sparse_new(2 * n, 4 * s->entries, row, column);
    MEM_FREE(row, column);
}

static bool by_equations(Shifted *s, double t, const double *y)
{
    const Dae *dae = &s->ode->dae;

    s->counts->evaluations++;
    if (!dae->start(dae->context, t, y, s->w, s->w_rate))
        return false;
    if (s->still == NULL)
        find_pattern(s);
    if (!dae->jacobian(dae->context, t, 0, s->w, s->w_rate, s->still) ||
        !dae->jacobian(dae->context, t, 1, s->w, s->w_rate, s->moving))
        return false;
    for (int k = 0; k < s->entries; k++)
        s->moving[k] -= s->still[k];
    return true;
}

/* The same, dense, without an evaluation for each state: dF/dw' y' + dF/dz z' + dF/dy = 0, column
 * by column. */
static bool by_rates(Shifted *s, double t, const double *y)
{
    const int n = s->n, all = n + s->ode->quadratures, size = s->ode->dae.n;

    if (!by_equations(s, t, y))
        return false;
    for (int k = 0; k < s->entries; k++)
        s->values[k] = s->at_column[k] < all ? s->moving[k] : s->still[k];
    if (!sparse_factor(s->rates, s->values))
        return false;
    for (int j = 0; j < n; j++) {
        memset(s->right, 0, (size_t)size * sizeof(double));
        for (int k = 0; k < s->entries; k++)
            if (s->at_column[k] == j)
                s->right[s->at_row[k]] = -s->still[k];
        sparse_solve(s->rates, s->right);
        for (int i = 0; i < n; i++)
            s->jacobian[i * n + j] = s->right[i];
    }
    return vector_is_finite(s->jacobian, n * n);
}

/* from the problem */
static bool by_problem(Shifted *s, double t, const double *y)
{
    const OdeJacobian *jacobian = &s->ode->jacobian;

    if (jacobian->at == NULL)
        return false;
    s->counts->evaluations++;
    return jacobian->at(jacobian->context, t, y, s->jacobian);
}

static bool find_dense(Shifted *s, double t, const double *y, const double *rate)
{
    return by_problem(s, t, y) || (s->ode->dae.is_index_one && by_rates(s, t, y)) ||
           by_differences(s, t, y, rate);
}

/* J of linear equations, in Hessenberg form */
static bool find_form(Shifted *s, double t, const double *y, const double *rate)
{
    const Dae *dae = &s->ode->dae;
    HessenbergForm *found;

    if (s->form_real == NULL) {
        s->form_real = shifted_factors_new(s->n);
        s->form_pair = shifted_factors_new(s->n);
    }
    s->form = dae->known != NULL ? dae->known(dae->context) : NULL;
    if (s->form != NULL)
        return true;
    if (!find_dense(s, t, y, rate) || !vector_is_finite(s->jacobian, s->n * s->n))
        return false;
    s->counts->jacobians++;
    found = hessenberg_form_new(s->jacobian, s->n);
    if (dae->keep != NULL) {
        s->form = dae->keep(dae->context, found);
        return true;
    }
    hessenberg_form_free(s->own_form);
    s->form = s->own_form = found;
    return true;
}

bool shifted_differentiate(Shifted *s, double t, const double *y, const double *rate)
{
    const Dae *dae = &s->ode->dae;

    s->is_linear = dae->is_linear != NULL && dae->is_linear(dae->context);
    s->form = NULL;
    if (s->is_linear && !is_sparse(s))
        return find_form(s, t, y, rate);
    s->counts->jacobians++;
    if (is_sparse(s))
        return by_equations(s, t, y);
    if (!find_dense(s, t, y, rate))
        return false;
    if (s->dense == NULL)
        s->dense = condensed_new(s->n);
    condensed_set(s->dense, s->jacobian);
    return true;
}

bool shifted_jacobian(Shifted *s, double t, const double *y, const double *rate, double *out)
{
    double *const own = s->jacobian;
    bool found;

    if (is_sparse(s))
        return false;
    s->counts->jacobians++;
    s->jacobian = out;
    found = find_dense(s, t, y, rate);
    s->jacobian = own;
    return found;
}

bool shifted_is_linear(const Shifted *s)
{
    return s->is_linear;
}

/* --- factors --- */

bool shifted_factor(Shifted *s, double shift, double alpha, double beta)
{
    if (s->n == 0)
        return true;
    if (s->form != NULL)
        return hessenberg_form_factor(s->form, shift, s->form_real) &&
               hessenberg_form_factor_complex(s->form, alpha, -beta, s->form_pair);
    if (!is_sparse(s))
        return condensed_factor(s->dense, shift, alpha, beta);
    for (int k = 0; k < s->entries; k++)
        s->values[k] = s->still[k] + shift * s->moving[k];
    if (!sparse_factor(s->sparse_real, s->values))
        return false;
    for (int k = 0; k < s->entries; k++) {
        double *part = s->values + 4 * k;

        part[0] = part[3] = s->still[k] + alpha * s->moving[k];
        part[1] = beta * s->moving[k];
        part[2] = -part[1];
    }
    return sparse_factor(s->sparse_pair, s->values);
}

/* dF/dw' b, for the part of b that belongs to y */
static void bring_right(const Shifted *s, const double *b, double *out)
{
    memset(out, 0, (size_t)s->ode->dae.n * sizeof(double));
    for (int k = 0; k < s->entries; k++)
        if (s->at_column[k] < s->n)
            out[s->at_row[k]] += s->moving[k] * b[s->at_column[k]];
}

void shifted_solve(Shifted *s, double *b)
{
    if (s->n == 0)
        return;
    if (s->form != NULL) {
        hessenberg_form_solve(s->form, s->form_real, b);
        return;
    }
    if (!is_sparse(s)) {
        condensed_solve(s->dense, b);
        return;
    }
    bring_right(s, b, s->right);
    sparse_solve(s->sparse_real, s->right);
    memcpy(b, s->right, (size_t)s->n * sizeof(double));
}

void shifted_solve_pair(Shifted *s, double *b, double *c)
{
    const size_t bytes = (size_t)s->n * sizeof(double);
    const int second = s->ode->dae.n;

    if (s->n == 0)
        return;
    if (s->form != NULL) {
        hessenberg_form_solve_complex(s->form, s->form_pair, b, c);
        return;
    }
    if (!is_sparse(s)) {
        condensed_solve_pair(s->dense, b, c);
        return;
    }
    bring_right(s, b, s->right);
    bring_right(s, c, s->right + second);
    sparse_solve(s->sparse_pair, s->right);
    memcpy(b, s->right, bytes);
    memcpy(c, s->right + second, bytes);
}
