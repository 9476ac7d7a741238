/* implicit_jacobian.c: rows of the implicit equations, their derivatives, and the positions of
 * these in dF/dw + c dF/dw' */
#include "simulate/equations/implicit_jacobian.h"

#include "algebra/linear.h"
#include "algebra/sparse.h"
#include "base/memory.h"
#include "compile/jacobian.h"
#include "simulate/equations/probe.h"
#include "simulate/equations/rows.h"

#include <string.h>

typedef LIST(Expr) ImplicitJacobianRoots;

/* A term that is added to an entry of the matrix: a product of two entries of the Jacobian, of one
 * and 1, or 1. */
typedef struct ImplicitJacobianTerm {
    int entry, other;        /* of the Jacobian; -1: 1 */
    int row;                 /* constraint that has to be in use, or out of use; -1: none */
    bool is_unused, by_rate; /* it has to be out of use; the term is multiplied by c */
    double sign;
} ImplicitJacobianTerm;

struct ImplicitSlopes {
    const VariableIndex *l;
    Parameters *parameters;
    Motion *motion;
    bool is_asked, is_made; /* made once, if possible */
    /* columns of the Jacobian: [x'; z], u' and lambda, q, u, x; rows: G, balance, q', references,
     * Phi, Phi_u u - nu */
    int network, by_rate, states;
    int balance, kinematic, references, position, velocity, row_count;
    Probe *probe;
    Jacobian *jacobian;
    double *values;
    int tail; /* of w: L */
    LIST(ImplicitJacobianTerm) terms;
    LIST(int) rows;
    LIST(int) columns;
    int *place;
    Pattern pattern;
    bool *in_use; /* whether each constraint row is in use */
    /* of networks: dG/d[x'; z], the positions of its entries, and the derivatives of [x'; z] by
     * each column that G reads */
    Sparse *factors;
    LIST(int) own;
    LIST(int) reads;
    LIST(int) readers; /* rows of the Jacobian after G that read it */
    double *entries, *moved;
};

ImplicitSlopes *implicit_jacobian_new(const VariableIndex *l, Parameters *parameters,
                                      Motion *motion)
{
    ImplicitSlopes *j = NEW(ImplicitSlopes);

    j->l = l;
    j->parameters = parameters;
    j->motion = motion;
    j->network = l->nx + l->nz;
    j->by_rate = l->nu + l->m;
    j->states = l->n + l->nu + l->nx;
    j->balance = j->network;
    j->kinematic = j->balance + l->nu;
    j->references = j->kinematic + l->n;
    j->position = j->references + l->multi_turns;
    j->velocity = j->position + l->m;
    j->row_count = j->velocity + l->m;
    j->tail = motion_length(motion);
    return j;
}

void implicit_jacobian_free(ImplicitSlopes *j)
{
    if (j == NULL)
        return;
    jacobian_free(j->jacobian);
    probe_free(j->probe);
    LIST_FREE(j->terms);
    LIST_FREE(j->rows);
    LIST_FREE(j->columns);
    LIST_FREE(j->own);
    LIST_FREE(j->reads);
    LIST_FREE(j->readers);
    pattern_free(&j->pattern);
    sparse_free(j->factors);
    MEM_FREE(j->values, j->place, j->in_use, j->entries, j->moved, j);
}

/* --- the program --- */

static Status push_rows(const ImplicitSlopes *j, ImplicitJacobianRoots *roots)
{
    const VariableIndex *l = j->l;
    const EquationForm *run = system_run(l->system);

    for (int i = 0; i < j->network; i++)
        LIST_PUSH(*roots, row_network(l, i));
    LIST_ROOM(*roots, j->position);
    TRY(rows_balance(l, roots->at + j->balance, NULL));
    TRY(rows_kinematic(l, roots->at + j->kinematic, NULL));
    roots->count = j->position;
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, run->phi[k]);
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, row_velocity(l, k));
    return OK;
}

/* the inputs that are unknowns, one column each */
static void push_moves(const ImplicitSlopes *j, ColumnMoves *moves)
{
    const VariableIndex *l = j->l;
    const int follow = j->network + j->by_rate;

    moves_push(moves, 0, l->rates, l->nx);
    moves_push(moves, l->nx, l->z, l->nz);
    moves_push(moves, j->network, l->acceleration, l->nu);
    moves_push(moves, j->network + l->nu, l->multipliers, l->m);
    moves_push(moves, follow, l->q, l->n);
    moves_push(moves, follow + l->n, l->u, l->nu);
    moves_push(moves, follow + l->n + l->nu, l->x, l->nx);
}

/* --- positions of entries --- */

/* the row of F that corresponds to a row of the Jacobian, with its sign there */
static int row_of(const ImplicitSlopes *j, int row, double *sign)
{
    const VariableIndex *l = j->l;

    *sign = row >= j->kinematic && row < j->position ? -1 : 1;
    if (row < j->kinematic)
        return l->n + row - j->balance;
    if (row < j->references)
        return row - j->kinematic;
    if (row < j->position)
        return variable_index_references(l) + row - j->references;
    return j->tail + row - j->position;
}

/* the entry of w that a column of the Jacobian belongs to, or whose rate it is */
static int column_of(const ImplicitSlopes *j, int column)
{
    const VariableIndex *l = j->l;
    const int own = column - j->network;

    if (own >= j->by_rate)
        return own - j->by_rate;
    return own < l->nu ? l->n + own : j->tail + own - l->nu;
}

/* the constraint that an entry belongs to, by its row or as a multiplier's column; -1: none */
static int constraint_of(const ImplicitSlopes *j, int row, int column)
{
    const int multiplier = column - j->network - j->l->nu;

    if (row >= j->position)
        return (row - j->position) % j->l->m;
    return multiplier >= 0 && multiplier < j->l->m ? multiplier : -1;
}

static bool is_rate(const ImplicitSlopes *j, int column)
{
    return column < j->network + j->by_rate;
}

static void add_term(ImplicitSlopes *j, int row, int column, ImplicitJacobianTerm term)
{
    LIST_PUSH(j->rows, row);
    LIST_PUSH(j->columns, column);
    LIST_PUSH(j->terms, term);
}

static void add_entries(ImplicitSlopes *j)
{
    const Pattern *p = jacobian_pattern(j->jacobian);

    for (int k = 0; k < p->count; k++) {
        ImplicitJacobianTerm term = {.entry = k, .other = -1};

        if (p->row[k] < j->balance || p->column[k] < j->network)
            continue;
        term.row = constraint_of(j, p->row[k], p->column[k]);
        term.by_rate = is_rate(j, p->column[k]);
        add_term(j, row_of(j, p->row[k], &term.sign), column_of(j, p->column[k]), term);
    }
}

/* rates that F contains with coefficient 1: all of y but u; L and M where their rows aren't in
 * use; M of velocity rows, which have no position */
static void add_rates(ImplicitSlopes *j)
{
    const VariableIndex *l = j->l;

    for (int i = 0; i < j->tail; i++)
        if (i < l->n || i >= l->n + l->nu)
            add_term(j, i, i, (ImplicitJacobianTerm){-1, -1, -1, .by_rate = true, .sign = 1});
    for (int i = 0; i < 2 * l->m; i++)
        add_term(j, j->tail + i, j->tail + i,
                 (ImplicitJacobianTerm){-1, -1, i % l->m, .is_unused = true, .by_rate = true,
                                        .sign = 1});
    for (int i = l->position_rows; i < l->m; i++)
        add_term(j, j->tail + i, j->tail + l->m + i,
                 (ImplicitJacobianTerm){-1, -1, i, .by_rate = true, .sign = 1});
}

/* N Phi_u^T mu of q': N is q' by u, Phi_u the velocity rows by u */
static void add_stabilisation(ImplicitSlopes *j)
{
    const VariableIndex *l = j->l;
    const Pattern *p = jacobian_pattern(j->jacobian);
    const int first = j->network + j->by_rate + l->n;

    for (int c = first; c < first + l->nu; c++)
        for (int a = p->start[c]; a < p->start[c + 1]; a++)
            for (int b = p->start[c]; b < p->start[c + 1]; b++)
                if (p->row[a] >= j->kinematic && p->row[a] < j->references &&
                    p->row[b] >= j->velocity)
                    add_term(j, p->row[a] - j->kinematic, j->tail + l->m + p->row[b] - j->velocity,
                             (ImplicitJacobianTerm){a, b, p->row[b] - j->velocity, .by_rate = true,
                                                    .sign = -1});
}

/* --- through a network --- */

static void find_network(ImplicitSlopes *j)
{
    const Pattern *p = jacobian_pattern(j->jacobian);
    int *row = NEW_ARRAY(int, p->count), *column = NEW_ARRAY(int, p->count);
    bool *reads = NEW_ARRAY(bool, p->columns), *reader = NEW_ARRAY(bool, p->rows);

    for (int k = 0; k < p->count; k++) {
        const bool is_own = p->column[k] < j->network;

        if (p->row[k] < j->balance && is_own) {
            row[j->own.count] = p->row[k];
            column[j->own.count] = p->column[k];
            LIST_PUSH(j->own, k);
        }
        reads[p->column[k]] = reads[p->column[k]] || (p->row[k] < j->balance && !is_own);
        reader[p->row[k]] = reader[p->row[k]] || (p->row[k] >= j->balance && is_own);
    }
    for (int c = j->network; c < p->columns; c++)
        if (reads[c])
            LIST_PUSH(j->reads, c);
    for (int r = j->balance; r < p->rows; r++)
        if (reader[r])
            LIST_PUSH(j->readers, r);
    j->factors = sparse_new(j->network, j->own.count, row, column);
    j->entries = NEW_ARRAY(double, j->own.count);
    j->moved = mem_array((size_t)j->network * (size_t)j->reads.count + 1, sizeof(double));
    MEM_FREE(row, column, reads, reader);
}

/* Entries that come through the network follow the terms' entries: of x' and of each reader, by
 * each column that G reads. */
static void add_network(ImplicitSlopes *j)
{
    double sign;

    for (int c = 0; c < j->reads.count; c++) {
        for (int i = 0; i < j->l->nx; i++) {
            LIST_PUSH(j->rows, j->l->n + j->l->nu + i);
            LIST_PUSH(j->columns, column_of(j, j->reads.at[c]));
        }
        for (int r = 0; r < j->readers.count; r++) {
            LIST_PUSH(j->rows, row_of(j, j->readers.at[r], &sign));
            LIST_PUSH(j->columns, column_of(j, j->reads.at[c]));
        }
    }
}

/* Whether G reads a multiplier. Where rows are redundant the multipliers that it reads are those of
 * all rows, each of which follows from several unknowns. */
static bool reads_multiplier(const ImplicitSlopes *j)
{
    for (int c = 0; c < j->reads.count; c++)
        if (constraint_of(j, 0, j->reads.at[c]) >= 0)
            return true;
    return false;
}

/* --- construction --- */

static void find_matrix(ImplicitSlopes *j)
{
    const int n = j->tail + 2 * j->l->m;

    add_entries(j);
    add_rates(j);
    add_stabilisation(j);
    if (j->network > 0)
        add_network(j);
    j->place = NEW_ARRAY(int, j->rows.count);
    j->pattern = pattern_of(n, n, j->rows.count, j->rows.at, j->columns.at, j->place);
    j->in_use = NEW_ARRAY(bool, j->l->m);
}

static bool make(ImplicitSlopes *j)
{
    const bool before = mem_scratch(true); /* numbers that each call computes anew */
    const int columns = j->network + j->by_rate + j->states;
    ImplicitJacobianRoots roots = {0};
    ColumnMoves moves = {0};
    Arena *arena = system_arena(j->l->system);
    int used;
    bool sound = push_rows(j, &roots) == OK && arena_status(arena) == OK &&
                 probe_new(j->l, j->parameters, roots.at, roots.count, &j->probe, NULL) == OK;

    (void)motion_rows(j->motion, &used);
    if (sound) {
        push_moves(j, &moves);
        j->jacobian = jacobian_new(residual_program(probe_residual(j->probe)), roots.count, columns,
                                   moves.at, columns);
        j->values = NEW_ARRAY(double, jacobian_pattern(j->jacobian)->count);
        if (j->network > 0)
            find_network(j);
        find_matrix(j);
        sound = used == j->l->m || !reads_multiplier(j);
    } else {
        arena_reset(arena); /* the program was too large and is discarded */
    }
    LIST_FREE(moves);
    LIST_FREE(roots);
    (void)mem_scratch(before);
    return sound;
}

int implicit_jacobian_pattern(void *context, const int **row, const int **column)
{
    ImplicitSlopes *j = context;

    if (j->l->slides > 0)
        return -1;
    if (!j->is_asked) {
        mem_keep(j);
        j->is_made = make(j);
        j->is_asked = true;
    }
    if (!j->is_made)
        return -1;
    *row = j->pattern.row;
    *column = j->pattern.column;
    return j->pattern.count;
}

/* --- at a state --- */

/* the change of [x'; z] with each column: G_e de = -G_w, one solution each */
static bool solve_network(ImplicitSlopes *j)
{
    const Pattern *p = jacobian_pattern(j->jacobian);

    for (int k = 0; k < j->own.count; k++)
        j->entries[k] = j->values[j->own.at[k]];
    if (!sparse_factor(j->factors, j->entries))
        return false;
    memset(j->moved, 0, (size_t)j->network * (size_t)j->reads.count * sizeof(double));
    for (int i = 0; i < j->reads.count; i++) {
        double *moved = j->moved + (ptrdiff_t)i * j->network;
        const int c = j->reads.at[i];

        for (int k = p->start[c]; k < p->start[c + 1] && p->row[k] < j->balance; k++)
            moved[p->row[k]] = -j->values[k];
        sparse_solve(j->factors, moved);
    }
    return true;
}

/* the derivative of a row of the Jacobian by the change `moved` of [x'; z] */
static void follow_network(const ImplicitSlopes *j, const double *moved, double *out)
{
    const Pattern *p = jacobian_pattern(j->jacobian);

    memset(out, 0, (size_t)j->row_count * sizeof(double));
    for (int k = 0; k < p->start[j->network]; k++)
        out[p->row[k]] += j->values[k] * moved[p->column[k]];
}

static void put_network(const ImplicitSlopes *j, double c, double *out)
{
    const int *place = j->place + j->terms.count;
    double *by = NEW_ARRAY(double, j->row_count);

    for (int i = 0; i < j->reads.count; i++) {
        const double *moved = j->moved + (ptrdiff_t)i * j->network;
        const double times = is_rate(j, j->reads.at[i]) ? c : 1;

        follow_network(j, moved, by);
        for (int k = 0; k < j->l->nx; k++)
            out[*place++] -= times * moved[k];
        for (int r = 0; r < j->readers.count; r++) {
            double sign;

            (void)row_of(j, j->readers.at[r], &sign);
            out[*place++] += times * sign * by[j->readers.at[r]];
        }
    }
    mem_free(by);
}

static void put_terms(const ImplicitSlopes *j, double c, double *out)
{
    for (int k = 0; k < j->terms.count; k++) {
        const ImplicitJacobianTerm *term = &j->terms.at[k];
        double value = term->by_rate ? term->sign * c : term->sign;

        if (term->row >= 0 && j->in_use[term->row] == term->is_unused)
            continue;
        if (term->entry >= 0)
            value *= j->values[term->entry];
        if (term->other >= 0)
            value *= j->values[term->other];
        out[j->place[k]] += value;
    }
}

bool implicit_jacobian_at(void *context, double t, double c, const double *w, const double *w_rate,
                          double *out)
{
    ImplicitSlopes *j = context;
    const VariableIndex *l = j->l;
    Solved solved;
    RowValues row;

    if (!motion_evaluate_driven(j->motion, t, w, w_rate + l->n, w_rate + j->tail, &solved))
        return false;
    row = row_of_solved(l, motion_clock(j->motion, t), w, &solved);
    probe_set(j->probe, &row);
    jacobian_at(j->jacobian, probe_inputs(j->probe), NULL, j->values);
    if (!vector_is_finite(j->values, jacobian_pattern(j->jacobian)->count) ||
        (j->network > 0 && !solve_network(j)))
        return false;
    motion_rows_in_use(j->motion, j->in_use);
    memset(out, 0, (size_t)j->pattern.count * sizeof(double));
    put_terms(j, c, out);
    if (j->network > 0)
        put_network(j, c, out);
    return vector_is_finite(out, j->pattern.count);
}
