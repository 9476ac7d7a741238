/* variational.c: S' = f_y S + f_p, and S on the constraints */
#include "simulate/sensitivity/variational.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "compile/jacobian.h"
#include "simulate/equations/rows.h"

#include <string.h>

typedef LIST(Expr) VariationalRoots;

struct Variational {
    Phase *phase;
    const SensitivityParameters *by;
    RateJacobian *jacobian;
    int n;             /* of y without work */
    double *y, *rate;  /* n + 1, with work */
    double *slopes;    /* (n + 1) x (n + symbols): f_y, f_p */
    double *follow;    /* unknowns x (n + symbols): the same of (u', lambda, x', z) */
    double *solved;    /* unknowns x count */
    double *magnitude; /* of the Ode */
    double *unit, *error_floor;
    /* Phi, Phi_u u - nu, q', by q, u and the symbols; NULL: without constraints */
    Probe *constraints;
    Jacobian *by_state;
    double *entries; /* its values, spread: (2 m + n) x (n_q + nu + symbols) */
    double *values, *right, *move;
    Ode ode;
};

/* --- rates --- */

static void copy_state(const Variational *v, const double *unknowns)
{
    memcpy(v->y, unknowns, (size_t)v->n * sizeof(double));
    v->y[v->n] = 0;
}

/* rows of slopes [A B] times [S; weights], for one parameter: out has a row of each */
static void along(const Variational *v, const double *slopes, int rows, const double *column,
                  int parameter, double *out)
{
    const SensitivityParameters *by = v->by;
    const int stride = v->n + by->symbol_count;

    for (int i = 0; i < rows; i++) {
        const double *row = slopes + (ptrdiff_t)i * stride;
        double sum = 0, moved = 0;

        for (int k = 0; k < v->n; k++)
            sum += row[k] * column[k];
        for (int k = 0; k < by->symbol_count; k++)
            moved += row[v->n + k] * by->weights[k * by->count + parameter];
        out[i] = sum + moved * by->sizes[parameter];
    }
}

static bool rate(void *context, double t, const double *unknowns, double *out)
{
    Variational *v = context;

    if (!variational_rate(v, t, unknowns, v->rate) ||
        !rate_jacobian_by_others(v->jacobian, t, v->y, v->slopes, NULL))
        return false;
    memcpy(out, v->rate, (size_t)v->n * sizeof(double));
    for (int p = 0; p < v->by->count; p++) {
        const ptrdiff_t first = (ptrdiff_t)(p + 1) * v->n;

        along(v, v->slopes, v->n, unknowns + first, p, out + first);
    }
    return vector_is_finite(out, v->ode.n);
}

bool variational_rate(Variational *v, double t, const double *unknowns, double *out)
{
    const Ode *ode = motion_ode(v->phase->motion);

    copy_state(v, unknowns);
    return ode->rate(ode->context, t, v->y, out);
}

const double *variational_solved(Variational *v, double t, const double *unknowns)
{
    const int rows = rate_jacobian_unknowns(v->jacobian);
    double *column = NEW_ARRAY(double, rows);
    bool sound;

    copy_state(v, unknowns);
    sound = rate_jacobian_by_others(v->jacobian, t, v->y, v->slopes, v->follow);
    for (int p = 0; p < v->by->count && sound; p++) {
        along(v, v->follow, rows, unknowns + (ptrdiff_t)(p + 1) * v->n, p, column);
        for (int i = 0; i < rows; i++)
            v->solved[i * v->by->count + p] = column[i];
    }
    mem_free(column);
    return sound ? v->solved : NULL;
}

/* Derivatives of all rates by the unknowns: f_y in each block of the diagonal. Those of S' by y,
 * second derivatives of f, are left out: y is known before S to an implicit method, since y' does
 * not depend on S. */
static bool jacobian_at_state(void *context, double t, const double *unknowns, double *out)
{
    Variational *v = context;
    const int n = v->n, all = v->ode.n, stride = n + v->by->symbol_count;

    copy_state(v, unknowns);
    if (!rate_jacobian_by_others(v->jacobian, t, v->y, v->slopes, NULL))
        return false;
    memset(out, 0, (size_t)all * (size_t)all * sizeof(double));
    for (int p = 0; p <= v->by->count; p++)
        for (int i = 0; i < n; i++)
            memcpy(out + (ptrdiff_t)(p * n + i) * all + (ptrdiff_t)p * n,
                   v->slopes + (ptrdiff_t)i * stride, (size_t)n * sizeof(double));
    return true;
}

static void begin(void *context, double t, const double *unknowns, double h)
{
    const Variational *v = context;
    const Ode *ode = motion_ode(v->phase->motion);

    copy_state(v, unknowns);
    if (ode->begin != NULL)
        ode->begin(ode->context, t, v->y, h);
}

static double rounding_error(void *context)
{
    const Variational *v = context;
    const Ode *ode = motion_ode(v->phase->motion);

    return ode->rounding_error(ode->context);
}

/* --- constraints --- */

static Status push_constraints(const VariableIndex *l, VariationalRoots *roots)
{
    const EquationForm *run = system_run(l->system);

    LIST_ROOM(*roots, 2 * l->m + l->n + l->multi_turns);
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, run->phi[k]);
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, row_velocity(l, k));
    TRY(rows_kinematic(l, roots->at + roots->count, NULL));
    roots->count += l->n;
    return OK;
}

static Status open_constraints(Variational *v, Parameters *parameters, Diag *diag)
{
    const VariableIndex *l = v->phase->layout;
    const int columns = l->n + l->nu + v->by->symbol_count, rows = 2 * l->m + l->n;
    VariationalRoots roots = {0};
    ColumnMoves moves = {0};
    Status status = OK;

    if (l->m == 0)
        return OK;
    CHECK(push_constraints(l, &roots));
    CHECK(probe_new(l, parameters, roots.at, rows, &v->constraints, diag));
    moves_push(&moves, 0, l->q, l->n);
    moves_push(&moves, l->n, l->u, l->nu);
    for (int i = 0; i < v->by->symbol_count; i++) {
        const int place = probe_place(v->constraints, v->by->symbols[i]);

        if (place >= 0)
            moves_push(&moves, l->n + l->nu + i, place, 1);
    }
    v->by_state = jacobian_new(residual_program(probe_residual(v->constraints)), rows, columns,
                               moves.at, moves.count);
    v->entries = mem_array((size_t)rows * (size_t)columns, sizeof(double));
    v->values = NEW_ARRAY(double, jacobian_pattern(v->by_state)->count);
    v->right = NEW_ARRAY(double, l->m);
    v->move = NEW_ARRAY(double, l->nu);
done:
    LIST_FREE(roots);
    LIST_FREE(moves);
    return status;
}

/* the derivatives of rows from `first` on along the column of a parameter, into v->right, times -1
 */
static void constraint_slopes(const Variational *v, int first, const double *column, int parameter)
{
    const VariableIndex *l = v->phase->layout;
    const SensitivityParameters *by = v->by;
    const int columns = l->n + l->nu + by->symbol_count;

    for (int k = 0; k < l->m; k++) {
        const double *row = v->entries + (ptrdiff_t)(first + k) * columns;
        double sum = 0, moved = 0;

        for (int i = 0; i < l->n + l->nu; i++)
            sum += row[i] * column[i];
        for (int i = 0; i < by->symbol_count; i++)
            moved += row[l->n + l->nu + i] * by->weights[i * by->count + parameter];
        v->right[k] = -sum - moved * by->sizes[parameter];
    }
}

/* Phi_u, m x nu: the velocity rows by u; new */
static double *constraint_matrix(const Variational *v)
{
    const VariableIndex *l = v->phase->layout;
    const int columns = l->n + l->nu + v->by->symbol_count;
    double *out = NEW_ARRAY(double, l->m * l->nu);

    for (int k = 0; k < l->m; k++)
        memcpy(out + (ptrdiff_t)k * l->nu, v->entries + (ptrdiff_t)(l->m + k) * columns + l->n,
               (size_t)l->nu * sizeof(double));
    return out;
}

/* positions by N d with Phi_u d = -Phi_q S_q - Phi_p, then speeds */
static bool project_column(const Variational *v, const double *matrix, int parameter,
                           double *column)
{
    const VariableIndex *l = v->phase->layout;
    const int columns = l->n + l->nu + v->by->symbol_count;

    constraint_slopes(v, 0, column, parameter);
    memset(v->right + l->position_rows, 0, (size_t)(l->m - l->position_rows) * sizeof(double));
    if (rows_solve(matrix, l->position_rows, l->nu, v->right, v->move) < 0)
        return false;
    for (int i = 0; i < l->n; i++)
        for (int k = 0; k < l->nu; k++)
            column[i] += v->entries[(ptrdiff_t)(2 * l->m + i) * columns + l->n + k] * v->move[k];
    constraint_slopes(v, l->m, column, parameter);
    if (rows_solve(matrix, l->m, l->nu, v->right, v->move) < 0)
        return false;
    for (int k = 0; k < l->nu; k++)
        column[l->n + k] += v->move[k];
    return true;
}

bool variational_project(Variational *v, double t, double *unknowns)
{
    const VariableIndex *l = v->phase->layout;
    const int columns = l->n + l->nu + v->by->symbol_count;
    const Pattern *p;
    RowValues row;
    double *matrix;
    bool sound = true;

    if (v->constraints == NULL)
        return true;
    copy_state(v, unknowns);
    p = jacobian_pattern(v->by_state);
    row = row_of_state(l, motion_clock(v->phase->motion, t), v->y);
    probe_set(v->constraints, &row);
    jacobian_at(v->by_state, probe_inputs(v->constraints), NULL, v->values);
    if (!vector_is_finite(v->values, p->count))
        return false;
    memset(v->entries, 0, (size_t)(2 * l->m + l->n) * (size_t)columns * sizeof(double));
    for (int k = 0; k < p->count; k++)
        v->entries[(ptrdiff_t)p->row[k] * columns + p->column[k]] = v->values[k];
    matrix = constraint_matrix(v);
    for (int i = 0; i < v->by->count && sound; i++)
        sound = project_column(v, matrix, i, unknowns + (ptrdiff_t)(i + 1) * v->n);
    mem_free(matrix);
    return sound;
}

static bool project(void *context, double t, double *unknowns)
{
    Variational *v = context;
    const Ode *ode = motion_ode(v->phase->motion);

    copy_state(v, unknowns);
    if (ode->project != NULL && !ode->project(ode->context, t, v->y))
        return false;
    memcpy(unknowns, v->y, (size_t)v->n * sizeof(double));
    return variational_project(v, t, unknowns);
}

/* --- construction --- */

static void set_ode(Variational *v)
{
    const Ode *base = motion_ode(v->phase->motion);
    const int all = v->n * (v->by->count + 1);

    v->magnitude = NEW_ARRAY(double, all);
    v->unit = NEW_ARRAY(double, all);
    v->error_floor = NEW_ARRAY(double, all);
    for (int i = 0; i < all; i++) {
        v->unit[i] = ode_nominal(base, i % v->n);
        v->magnitude[i] =
            i < v->n && base->magnitude_bound != NULL ? base->magnitude_bound[i] : HUGE_VAL;
        v->error_floor[i] = i < v->n && base->error_floor != NULL ? base->error_floor[i] : 0;
    }
    v->ode = (Ode){.n = all,
                   .context = v,
                   .rate = rate,
                   .begin = base->begin != NULL ? begin : NULL,
                   .project = base->project != NULL || v->constraints != NULL ? project : NULL,
                   .magnitude_bound = v->magnitude,
                   .unit = v->unit,
                   .error_floor = v->error_floor,
                   .rounding_error = base->rounding_error != NULL ? rounding_error : NULL,
                   .jacobian = {v, jacobian_at_state},
                   .is_network = base->is_network,
                   .stiffness_falls = base->stiffness_falls};
}

Status variational_new(Phase *phase, Parameters *parameters, const SensitivityParameters *by,
                       Variational **out, Diag *diag)
{
    const VariableIndex *l = phase->layout;
    Variational *v = NEW(Variational);
    int stride, unknowns;
    Status status = OK;

    v->phase = phase;
    v->by = by;
    v->n = variable_index_references(l) + l->multi_turns;
    v->jacobian = rate_jacobian_new_by(l, parameters, phase->motion, by->symbols, by->symbol_count);
    stride = v->n + by->symbol_count;
    unknowns = rate_jacobian_unknowns(v->jacobian);
    v->y = NEW_ARRAY(double, v->n + 1);
    v->rate = NEW_ARRAY(double, v->n + 1);
    v->slopes = mem_array((size_t)(v->n + 1) * (size_t)stride, sizeof(double));
    v->follow = mem_array((size_t)unknowns * (size_t)stride + 1, sizeof(double));
    v->solved = mem_array((size_t)unknowns * (size_t)by->count + 1, sizeof(double));
    CHECK(open_constraints(v, parameters, diag));
    set_ode(v);
    *out = v;
    v = NULL;
done:
    variational_free(v);
    return status;
}

void variational_free(Variational *v)
{
    if (v == NULL)
        return;
    rate_jacobian_free(v->jacobian);
    jacobian_free(v->by_state);
    probe_free(v->constraints);
    MEM_FREE(v->y, v->rate, v->slopes, v->follow, v->solved, v->magnitude, v->unit, v->error_floor,
             v->entries, v->values, v->right, v->move, v);
}

const Ode *variational_ode(const Variational *v)
{
    return &v->ode;
}

int variational_states(const Variational *v)
{
    return v->n;
}
