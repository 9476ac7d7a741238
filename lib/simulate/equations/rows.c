/* rows.c: the equations as symbolic residuals, and steps from them */
#include "simulate/equations/rows.h"

#include "algebra/dense.h"
#include "algebra/linear.h"
#include "base/memory.h"
#include "formulate/dynamics/composite_mass.h"
#include "formulate/dynamics/cutset_equations.h"
#include "simulate/equations/equations_limits.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

static Expr plus_product(Arena *arena, Expr sum, Expr a, Expr b)
{
    return expr_add(arena, sum, expr_mul(arena, a, b));
}

Expr row_balance(const VariableIndex *l, int speed)
{
    const EquationForm *run = system_run(l->system);
    Arena *arena = system_arena(l->system);
    Expr sum = expr_neg(arena, run->force[speed]);

    for (int k = 0; k < l->nu; k++)
        sum =
            plus_product(arena, sum, run->mass[speed * l->nu + k], l->symbols[l->acceleration + k]);
    for (int k = 0; k < l->m; k++)
        sum =
            plus_product(arena, sum, run->phi_u[k * l->nu + speed], l->symbols[l->multipliers + k]);
    return sum;
}

Status rows_balance(const VariableIndex *l, Expr *out, Diag *diag)
{
    const EquationForm *run = system_run(l->system);
    Arena *arena = system_arena(l->system);

    if (system_composite_mass(l->system) == NULL ||
        !dynamics_lack(l->system, l->symbols + l->acceleration, out)) {
        TRY(system_form_mass(l->system, diag));
        for (int j = 0; j < l->nu; j++)
            out[j] = row_balance(l, j);
        return OK;
    }
    for (int j = 0; j < l->nu; j++)
        for (int k = 0; k < l->m; k++)
            out[j] = plus_product(arena, out[j], run->phi_u[k * l->nu + j],
                                  l->symbols[l->multipliers + k]);
    return OK;
}

Status rows_kinematic(const VariableIndex *l, Expr *out, Diag *diag)
{
    for (int i = 0; i < l->n; i++)
        out[i] = system_q_rate(l->system, i);
    for (int k = 0; k < l->multi_turns; k++)
        TRY(system_multi_turn_rate(l->system, k, &out[l->n + k], diag));
    return OK;
}

/* Phi_u v - right */
static Expr rate_row(const VariableIndex *l, int constraint, int first, Expr right)
{
    const EquationForm *run = system_run(l->system);
    Arena *arena = system_arena(l->system);
    Expr sum = expr_neg(arena, right);

    for (int k = 0; k < l->nu; k++)
        sum = plus_product(arena, sum, run->phi_u[constraint * l->nu + k], l->symbols[first + k]);
    return sum;
}

Expr row_acceleration(const VariableIndex *l, int constraint)
{
    return rate_row(l, constraint, l->acceleration, system_run(l->system)->gamma[constraint]);
}

Expr row_velocity(const VariableIndex *l, int constraint)
{
    return rate_row(l, constraint, l->u, system_run(l->system)->nu[constraint]);
}

Expr row_network(const VariableIndex *l, int equation)
{
    return system_run(l->system)->network_residual[equation];
}

int speed_coordinate(const System *system, int speed)
{
    for (int i = 0; i < system_n(system); i++)
        if (expr_is(system_n_entry(system, i, speed), 1))
            return i;
    return -1;
}

/* --- steps --- */

/* largest entry of a row or a column, 1 where all are 0 */
static double size_of(const double *first, int count, int stride)
{
    double largest = 0;

    for (int i = 0; i < count; i++)
        largest = fmax(largest, fabs(first[(ptrdiff_t)i * stride]));
    return largest > 0 ? largest : 1;
}

/* Copies a matrix and a right side to `a` and `b`, each row divided by its size, then each column
 * of `a` by its own, which is returned in scale (columns): the unknown is x_j / scale_j. */
static void load(const double *matrix, int rows, int columns, const double *right, gsl_matrix *a,
                 gsl_vector *b, double *scale)
{
    for (int i = 0; i < rows; i++) {
        double size = size_of(matrix + (ptrdiff_t)i * columns, columns, 1);

        for (int j = 0; j < columns; j++)
            gsl_matrix_set(a, (size_t)i, (size_t)j, matrix[(ptrdiff_t)i * columns + j] / size);
        gsl_vector_set(b, (size_t)i, right[i] / size);
    }
    for (int j = 0; j < columns; j++) {
        scale[j] = size_of(gsl_matrix_const_ptr(a, 0, (size_t)j), (int)a->size1, (int)a->tda);
        for (size_t i = 0; i < a->size1; i++)
            *gsl_matrix_ptr(a, i, (size_t)j) /= scale[j];
    }
}

static int solve_loaded(gsl_matrix *a, const gsl_vector *b, gsl_vector *x)
{
    gsl_vector *tau = dense_vector(a->size2), *norms = dense_vector(a->size2);
    gsl_vector *residual = dense_vector(a->size1);
    gsl_permutation *order = dense_permutation(a->size2);
    size_t rank = 0;
    int sign = 0;

    (void)gsl_linalg_QRPT_decomp(a, tau, order, &sign, norms);
    while (rank < a->size2 &&
           fabs(gsl_matrix_get(a, rank, rank)) > ROWS_RANK * fabs(gsl_matrix_get(a, 0, 0)))
        rank++;
    gsl_vector_set_zero(x);
    if (rank > 0)
        (void)gsl_linalg_QRPT_lssolve2(a, tau, order, b, rank, x, residual);
    MEM_FREE(tau, norms, residual, order);
    return (int)rank;
}

int rows_solve(const double *matrix, int rows, int columns, const double *right, double *out)
{
    /* zero rows are appended where rows are few: the factorisation needs rows >= columns */
    size_t tall = (size_t)(rows > columns ? rows : columns);
    gsl_matrix *a;
    gsl_vector *b, *x;
    double *scale;
    int rank;

    if (!vector_is_finite(matrix, rows * columns) || !vector_is_finite(right, rows))
        return -1;
    if (columns == 0)
        return 0;
    a = dense_matrix(tall, (size_t)columns);
    b = dense_vector(tall);
    x = dense_vector((size_t)columns);
    scale = NEW_ARRAY(double, columns);
    load(matrix, rows, columns, right, a, b, scale);
    rank = solve_loaded(a, b, x);
    for (int j = 0; j < columns; j++)
        out[j] = gsl_vector_get(x, (size_t)j) / scale[j];
    MEM_FREE(a, b, x, scale);
    return vector_is_finite(out, columns) ? rank : -1;
}
