/* rate_jacobian.c: derivatives of rates by each entry of the state
 *
 * The equations E(w, e) = 0 of rate_jacobian.h in the order of rows.h: balance (nu), acceleration
 * (m), network (nx + nz). Rows of constraints that aren't in use become lambda_k = 0. E_e is
 * factored (sparse LU), and each column of -E_w solved for; q', the rates of references and the
 * power follow from the chain rule. */
#include "simulate/equations/rate_jacobian.h"

#include "algebra/linear.h"
#include "algebra/sparse.h"
#include "base/memory.h"
#include "compile/jacobian.h"
#include "simulate/equations/compiled_equations.h"
#include "simulate/equations/probe.h"
#include "simulate/equations/rows.h"

#include <string.h>

typedef LIST(Expr) RateJacobianRoots;

struct RateJacobian {
    const VariableIndex *l;
    Parameters *parameters;
    Motion *motion;
    bool is_asked, is_made; /* made once, if possible */
    int follow, states;     /* numbers of entries of e and of w */
    Expr *others;           /* other_count: further symbols to differentiate by */
    int other_count;
    int slides;         /* signs of surfaces that the motion slides along, which are unknowns too */
    Probe *probe;       /* E, q', rates of references, power */
    Jacobian *jacobian; /* derivatives of these by e, then by w, then by other symbols */
    double *values;     /* its entries */
    Pattern matrix;     /* E_e, with diagonal entries for multipliers that aren't in use */
    int *place;         /* index into it: entries of the Jacobian, diagonals; -1: none */
    double *entries;    /* of the matrix */
    Sparse *factors;
    double *right; /* follow */
    bool *in_use;  /* constraint rows */
};

static RateJacobian *create(const VariableIndex *l, Parameters *parameters, Motion *motion,
                            int slides)
{
    RateJacobian *j = NEW(RateJacobian);

    j->l = l;
    j->parameters = parameters;
    j->motion = motion;
    j->slides = slides;
    j->follow = l->nu + l->m + l->nx + l->nz + slides;
    j->states = l->n + l->nu + l->nx;
    return j;
}

RateJacobian *rate_jacobian_new(const VariableIndex *l, Parameters *parameters, Motion *motion)
{
    return create(l, parameters, motion, 0);
}

RateJacobian *rate_jacobian_new_by(const VariableIndex *l, Parameters *parameters, Motion *motion,
                                   const Expr *others, int count)
{
    RateJacobian *j = create(l, parameters, motion, l->slides);

    j->others = NEW_ARRAY(Expr, count);
    j->other_count = count;
    for (int i = 0; i < count; i++)
        j->others[i] = others[i];
    return j;
}

int rate_jacobian_unknowns(const RateJacobian *j)
{
    return j->follow;
}

void rate_jacobian_free(RateJacobian *j)
{
    if (j == NULL)
        return;
    jacobian_free(j->jacobian);
    probe_free(j->probe);
    pattern_free(&j->matrix);
    sparse_free(j->factors);
    MEM_FREE(j->others, j->values, j->place, j->entries, j->right, j->in_use, j);
}

/* --- making --- */

static Status push_rows(const RateJacobian *j, RateJacobianRoots *roots)
{
    const VariableIndex *l = j->l;

    LIST_ROOM(*roots, l->nu);
    TRY(rows_balance(l, roots->at, NULL));
    roots->count = l->nu;
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, row_acceleration(l, k));
    for (int i = 0; i < l->nx + l->nz; i++)
        LIST_PUSH(*roots, row_network(l, i));
    for (int k = 0; k < j->slides; k++) {
        Expr slip;

        TRY(compiled_slip(l, k, &slip, NULL));
        LIST_PUSH(*roots, slip);
    }
    LIST_ROOM(*roots, j->follow + l->n + l->multi_turns);
    TRY(rows_kinematic(l, roots->at + j->follow, NULL));
    roots->count = j->follow + l->n + l->multi_turns;
    LIST_PUSH(*roots, system_power(l->system));
    return OK;
}

/* the inputs that are e, w and other symbols, one column each */
static void push_moves(const RateJacobian *j, ColumnMoves *moves)
{
    const VariableIndex *l = j->l;

    moves_push(moves, 0, l->acceleration, l->nu);
    moves_push(moves, l->nu, l->multipliers, l->m);
    moves_push(moves, l->nu + l->m, l->rates, l->nx);
    moves_push(moves, l->nu + l->m + l->nx, l->z, l->nz);
    for (int k = 0; k < j->slides; k++)
        moves_push(moves, l->nu + l->m + l->nx + l->nz + k, l->signs + l->slid[k], 1);
    moves_push(moves, j->follow, l->q, l->n);
    moves_push(moves, j->follow + l->n, l->u, l->nu);
    moves_push(moves, j->follow + l->n + l->nu, l->x, l->nx);
    for (int i = 0; i < j->other_count; i++) {
        const int place = probe_place(j->probe, j->others[i]);

        if (place >= 0)
            moves_push(moves, j->follow + j->states + i, place, 1);
    }
}

static void find_matrix(RateJacobian *j)
{
    const Pattern *p = jacobian_pattern(j->jacobian);
    const int most = p->count + j->l->m;
    int *row = NEW_ARRAY(int, 3 * most), *column = row + most, *at = column + most;
    int count = 0;

    j->place = NEW_ARRAY(int, most);
    for (int k = 0; k < most; k++) {
        const bool is_entry = k < p->count;
        const int diagonal = j->l->nu + k - p->count;

        j->place[k] = -1;
        if (is_entry && (p->row[k] >= j->follow || p->column[k] >= j->follow))
            continue;
        row[count] = is_entry ? p->row[k] : diagonal;
        column[count] = is_entry ? p->column[k] : diagonal;
        j->place[k] = count++;
    }
    j->matrix = pattern_of(j->follow, j->follow, count, row, column, at);
    for (int k = 0; k < most; k++)
        if (j->place[k] >= 0)
            j->place[k] = at[j->place[k]];
    mem_free(row);
}

static void open_room(RateJacobian *j)
{
    j->values = NEW_ARRAY(double, jacobian_pattern(j->jacobian)->count);
    j->entries = NEW_ARRAY(double, j->matrix.count);
    j->factors = sparse_new(j->follow, j->matrix.count, j->matrix.row, j->matrix.column);
    j->right = NEW_ARRAY(double, j->follow);
    j->in_use = NEW_ARRAY(bool, j->l->m);
}

static bool make(RateJacobian *j)
{
    const bool before = mem_scratch(true); /* numbers that each call computes anew */
    RateJacobianRoots roots = {0};
    ColumnMoves moves = {0};
    Arena *arena = system_arena(j->l->system);
    bool sound = push_rows(j, &roots) == OK && arena_status(arena) == OK &&
                 probe_new(j->l, j->parameters, roots.at, roots.count, &j->probe, NULL) == OK;

    if (sound) {
        push_moves(j, &moves);
        j->jacobian = jacobian_new(residual_program(probe_residual(j->probe)), roots.count,
                                   j->follow + j->states + j->other_count, moves.at, moves.count);
        find_matrix(j);
        open_room(j);
    }
    if (!sound)
        arena_reset(arena); /* the program was too large and is discarded */
    LIST_FREE(moves);
    LIST_FREE(roots);
    (void)mem_scratch(before);
    return sound;
}

/* --- at a state --- */

/* Factor E_e; multipliers of rows that aren't in use are set to 0. */
static bool factor(RateJacobian *j)
{
    const VariableIndex *l = j->l;
    const Pattern *p = jacobian_pattern(j->jacobian);

    motion_rows_in_use(j->motion, j->in_use);
    memset(j->entries, 0, (size_t)j->matrix.count * sizeof(double));
    for (int k = 0; k < p->count; k++) {
        const int row = p->row[k] - l->nu;

        if (j->place[k] >= 0 && !(row >= 0 && row < l->m && !j->in_use[row]))
            j->entries[j->place[k]] = j->values[k];
    }
    for (int k = 0; k < l->m; k++)
        if (!j->in_use[k])
            j->entries[j->place[p->count + k]] = 1;
    return sparse_factor(j->factors, j->entries);
}

/* derivative of e by an entry of the state, or by another symbol after those: E_e de = -E_w */
static void find_follow(RateJacobian *j, int state)
{
    const VariableIndex *l = j->l;
    const Pattern *p = jacobian_pattern(j->jacobian);
    const int c = j->follow + state;

    memset(j->right, 0, (size_t)j->follow * sizeof(double));
    for (int k = p->start[c]; k < p->start[c + 1]; k++) {
        const int row = p->row[k], constraint = row - l->nu;

        if (row < j->follow && !(constraint >= 0 && constraint < l->m && !j->in_use[constraint]))
            j->right[row] = -j->values[k];
    }
    sparse_solve(j->factors, j->right);
}

/* The row of y' that a row after E gives: those of q, of references, of work. */
static int rate_row(const RateJacobian *j, int row)
{
    const VariableIndex *l = j->l;
    const int own = row - j->follow;

    return own < l->n ? own : variable_index_references(l) + own - l->n;
}

/* add `by` times the entries after E of a column of the Jacobian */
static void add_column(const RateJacobian *j, int c, double by, double *out, int stride)
{
    const Pattern *p = jacobian_pattern(j->jacobian);

    for (int k = p->start[c + 1] - 1; k >= p->start[c] && p->row[k] >= j->follow; k--)
        out[rate_row(j, p->row[k]) * stride] += by * j->values[k];
}

/* the column of y', entries `stride` apart */
static void write_column(RateJacobian *j, int state, double *out, int stride)
{
    const VariableIndex *l = j->l;

    find_follow(j, state);
    for (int i = 0; i < l->nu; i++)
        out[(l->n + i) * stride] = j->right[i];
    for (int i = 0; i < l->nx; i++)
        out[(l->n + l->nu + i) * stride] = j->right[l->nu + l->m + i];
    add_column(j, j->follow + state, 1, out, stride);
    for (int k = 0; k < j->follow; k++)
        if (j->right[k] != 0)
            add_column(j, k, j->right[k], out, stride);
}

/* the solution with the constraint rows in use; on surfaces that the motion slides along only
 * where those are all */
static bool solve(const RateJacobian *j, double t, const double *y, Solved *out)
{
    int used;

    if (j->slides == 0)
        return motion_solve_in_use(j->motion, t, y, out);
    (void)motion_rows(j->motion, &used);
    return used == j->l->m && motion_solve(j->motion, t, y, out);
}

/* Evaluate the derivatives of the rows at (t, y), and factor E_e. */
static bool evaluate(RateJacobian *j, double t, const double *y)
{
    Solved solved;
    RowValues row;

    if (j->l->slides != j->slides || !solve(j, t, y, &solved))
        return false;
    if (!j->is_asked) {
        mem_keep(j);
        j->is_made = make(j);
        j->is_asked = true;
    }
    if (!j->is_made)
        return false;
    row = row_of_solved(j->l, motion_clock(j->motion, t), y, &solved);
    probe_set(j->probe, &row);
    jacobian_at(j->jacobian, probe_inputs(j->probe), NULL, j->values);
    return vector_is_finite(j->values, jacobian_pattern(j->jacobian)->count) && factor(j);
}

bool rate_jacobian_at(void *context, double t, const double *y, double *out)
{
    RateJacobian *j = context;
    const int n = variable_index_references(j->l) + j->l->multi_turns;

    if (!evaluate(j, t, y))
        return false;
    memset(out, 0, (size_t)(n + 1) * (size_t)n * sizeof(double));
    for (int state = 0; state < j->states; state++)
        write_column(j, state, out + state, n);
    return vector_is_finite(out, n * (n + 1));
}

bool rate_jacobian_by_others(RateJacobian *j, double t, const double *y, double *out,
                             double *follow)
{
    const int n = variable_index_references(j->l) + j->l->multi_turns;
    const int stride = n + j->other_count;

    if (!evaluate(j, t, y))
        return false;
    memset(out, 0, (size_t)(n + 1) * (size_t)stride * sizeof(double));
    if (follow != NULL)
        memset(follow, 0, (size_t)j->follow * (size_t)stride * sizeof(double));
    for (int k = 0; k < j->states + j->other_count; k++) {
        const int column = k < j->states ? k : n + k - j->states;

        write_column(j, k, out + column, stride);
        for (int i = 0; follow != NULL && i < j->follow; i++)
            follow[i * stride + column] = j->right[i];
    }
    return vector_is_finite(out, (n + 1) * stride);
}
