/* redundancy.c: multipliers of redundant equations (theory 5)
 *
 * A row that holds in every position still has a multiplier mu: the load that its joint carries in
 * that direction. A virtual branch at the joint's position carries no load. So the sums of loads
 * beyond it, P without mu and W mu, cancel:
 *
 *     W mu = -P,   W^T W mu = -W^T P = b
 *
 * with three force rows for each virtual branch of the translation tree and three moment rows for
 * each of the rotation tree; those along its motion are zero by themselves. W depends on q alone.
 * Its rank is computed numerically, at a random position. On independent columns W^T W is positive
 * definite, so L D L^T needs no pivoting and can be formed in symbols. The null space (W y = 0)
 * remains undetermined, whichever trees are chosen. */
#include "formulate/dynamics/efforts.h"
#include "formulate/dynamics/loads.h"
#include "formulate/dynamics/reactions.h"
#include "formulate/formulate_limits.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/sample.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <math.h>
#include <stdlib.h>

/* --- the equations --- */

typedef struct RedundancyMatrix { /* of expressions, row by row; P is their right-hand side,
                                     reversed */
    int rows, columns;
    LIST(Expr) W;
    LIST(Expr) P;
} RedundancyMatrix;

static Vec beyond(const Sums *sums, int node, bool moment)
{
    return (moment ? sums->torque : sums->force)[node];
}

/* three rows: forces or moments beyond a node */
static void add_rows(const Recovery *recovery, const Sums *sums, int node, bool moment,
                     RedundancyMatrix *out)
{
    for (int i = 0; i < 3; i++) {
        bool empty = true;

        for (int k = 0; k < out->columns; k++)
            empty = empty && expr_is_zero(beyond(recovery->sums[k], node, moment).at[i]);
        if (empty)
            continue;
        for (int k = 0; k < out->columns; k++)
            LIST_PUSH(out->W, beyond(recovery->sums[k], node, moment).at[i]);
        LIST_PUSH(out->P, beyond(sums, node, moment).at[i]);
        out->rows++;
    }
}

/* each virtual branch carries no load */
static void gather(System *system, const Recovery *recovery, const Sums *sums,
                   RedundancyMatrix *out)
{
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *joint = &system->origin->instances[i];

        if (!joint->is_virtual)
            continue;
        for (TreeKind kind = TREE_TRANSLATION; kind <= TREE_ROTATION; kind++)
            if (tree_has(system->origin->trees[kind], joint->edge))
                add_rows(recovery, sums, tree_far_node(system->origin->trees[kind], joint->edge),
                         kind == TREE_ROTATION, out);
    }
}

static void unit_sums(System *system, Recovery *recovery)
{
    int count = system->constraints->redundant_rows.count;

    recovery->sums = pool_alloc(system->pool, (size_t)count * sizeof *recovery->sums);
    for (int k = 0; k < count; k++) {
        Loads unit = loads_new(system);

        loads_add_row(system, &unit, &system->constraints->redundant_rows.at[k],
                      expr_int(system->arena, 1));
        recovery->sums[k] = loads_sum(system, &unit, SUMS_FOR_JOINTS);
    }
}

/* --- rank ---
 *
 * Gauss elimination, since its result is used in formulas: zeros and ones of directions along axes
 * remain exact, while orthogonal factors would add rounding errors. */

typedef struct RedundancyElimination {
    int rows, columns;
    double *at;
    int *column; /* pivot columns, then free ones */
    int rank;
} RedundancyElimination;

static void swap_rows(RedundancyElimination *e, int a, int b)
{
    for (int c = 0; c < e->columns; c++) {
        double kept = e->at[a * e->columns + c];

        e->at[a * e->columns + c] = e->at[b * e->columns + c];
        e->at[b * e->columns + c] = kept;
    }
}

/* makes the largest remaining entry the pivot; false: it is 0 */
static bool choose_pivot(RedundancyElimination *e)
{
    double largest = REDUNDANCY_ZERO;
    int row = -1;
    int place = -1;

    for (int r = e->rank; r < e->rows; r++)
        for (int c = e->rank; c < e->columns; c++)
            if (fabs(e->at[r * e->columns + e->column[c]]) > largest) {
                largest = fabs(e->at[r * e->columns + e->column[c]]);
                row = r;
                place = c;
            }
    if (row < 0)
        return false;
    swap_rows(e, row, e->rank);
    row = e->column[place];
    e->column[place] = e->column[e->rank];
    e->column[e->rank] = row;
    return true;
}

/* Gauss and Jordan with full pivoting: unit columns at the pivots */
static void eliminate(RedundancyElimination *e)
{
    for (; e->rank < e->rows && choose_pivot(e); e->rank++) {
        double *own = e->at + (ptrdiff_t)e->rank * e->columns;
        double pivot = own[e->column[e->rank]];

        for (int c = 0; c < e->columns; c++)
            own[c] /= pivot;
        for (int r = 0; r < e->rows; r++) {
            double *other = e->at + (ptrdiff_t)r * e->columns;
            double share = other[e->column[e->rank]];

            for (int c = 0; c < e->columns && r != e->rank && share != 0; c++)
                other[c] -= share * own[c];
        }
    }
}

/* the null space of W: a free column is 1, and the pivot columns balance it */
static void find_open(System *system, const RedundancyElimination *e, Recovery *recovery)
{
    int count = e->columns - e->rank;

    recovery->open_count = count;
    recovery->open = pool_alloc(system->pool, (size_t)e->columns * (size_t)count * sizeof(double));
    for (int j = 0; j < count; j++) {
        int column = e->column[e->rank + j];

        recovery->open[column * count + j] = 1;
        for (int i = 0; i < e->rank; i++) {
            double share = -e->at[i * e->columns + column];

            recovery->open[e->column[i] * count + j] = fabs(share) > REDUNDANCY_ZERO ? share : 0;
        }
    }
}

/* --- solving --- */

/* sum over the rows of W_ra W_rb; of W_ra P_r where b is -1 */
static Expr product(const System *system, const RedundancyMatrix *m, int a, int b)
{
    enum { SHORT = 400 }; /* operations of an expression that may be written out */
    Arena *arena = system->arena;
    Expr sum = expr_int(arena, 0);

    for (int r = 0; r < m->rows; r++) {
        Expr left = m->W.at[r * m->columns + a];
        Expr right = b < 0 ? m->P.at[r] : m->W.at[r * m->columns + b];

        sum = expr_add(arena, sum, expr_mul(arena, left, right));
    }
    /* axes that turn together give 1 and 0 */
    if (b >= 0 && op_count_total(expr_count(&sum, 1)) < SHORT)
        sum = expr_fold(arena, expr_open(arena, sum));
    return expr_name_temporary(arena, sum);
}

/* L D L^T y = b, L below the diagonal of `at` and D on it; y in the place of b */
static void solve(Arena *arena, int n, Expr *at, Expr *y)
{
    for (int j = 0; j < n; j++) {
        for (int i = j; i < n; i++) {
            Expr *entry = &at[i * n + j];

            for (int k = 0; k < j; k++)
                *entry = expr_sub(
                    arena, *entry,
                    expr_product(arena, (Expr[]){at[i * n + k], at[j * n + k], at[k * n + k]}, 3));
            *entry = expr_name_temporary(arena, *entry);
        }
        for (int i = j + 1; i < n; i++)
            at[i * n + j] =
                expr_name_temporary(arena, expr_div(arena, at[i * n + j], at[j * n + j]));
    }
    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++)
            y[i] = expr_name_temporary(arena,
                                       expr_sub(arena, y[i], expr_mul(arena, at[i * n + k], y[k])));
    for (int i = 0; i < n; i++)
        y[i] = expr_name_temporary(arena, expr_div(arena, y[i], at[i * n + i]));
    for (int i = n - 1; i >= 0; i--)
        for (int k = i + 1; k < n; k++)
            y[i] = expr_name_temporary(arena,
                                       expr_sub(arena, y[i], expr_mul(arena, at[k * n + i], y[k])));
}

static void solve_columns(System *system, const RedundancyMatrix *m, const RedundancyElimination *e,
                          Recovery *recovery)
{
    int n = e->rank;
    Expr *at = NEW_ARRAY(Expr, (size_t)n * (size_t)n);
    Expr *y = NEW_ARRAY(Expr, n);

    for (int i = 0; i < n; i++) {
        y[i] = expr_neg(system->arena, product(system, m, e->column[i], -1));
        for (int j = 0; j <= i; j++)
            at[i * n + j] = product(system, m, e->column[i], e->column[j]);
    }
    solve(system->arena, n, at, y);
    for (int i = 0; i < n; i++)
        recovery->multipliers[e->column[i]] = y[i];
    MEM_FREE(at, y);
}

static int by_number(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

/* finds the undetermined combinations, and the pivot columns in the order of the joints: L is then
 * as sparse as their adjacency */
static void find_columns(System *system, const RedundancyMatrix *m, Recovery *recovery,
                         RedundancyElimination *e)
{
    for (int i = 0; i < m->rows * m->columns; i++)
        e->at[i] = sample_number(recovery->sample, m->W.at[i]);
    for (int k = 0; k < m->columns; k++)
        e->column[k] = k;
    eliminate(e);
    find_open(system, e, recovery);
    qsort(e->column, (size_t)e->rank, sizeof *e->column, by_number);
}

void recovery_build(System *system, const Loads *loads)
{
    Recovery *recovery = pool_alloc(system->pool, sizeof *recovery);
    int count = system->constraints->redundant_rows.count;
    const Sums *sums = loads_sum(system, loads, SUMS_FOR_JOINTS);
    RedundancyMatrix m = {.columns = count};
    RedundancyElimination e;

    system->shown->recovery = recovery;
    recovery->sample = sample_new(system, 5, false);
    recovery->multipliers = pool_alloc(system->pool, (size_t)count * sizeof(Expr));
    for (int k = 0; k < count; k++)
        recovery->multipliers[k] = expr_int(system->arena, 0);
    unit_sums(system, recovery);
    gather(system, recovery, sums, &m);
    e = (RedundancyElimination){.rows = m.rows, .columns = count};
    e.at = NEW_ARRAY(double, m.rows *count);
    e.column = NEW_ARRAY(int, count);
    find_columns(system, &m, recovery, &e);
    solve_columns(system, &m, &e, recovery);
    MEM_FREE(e.at, e.column);
    LIST_FREE(m.W);
    LIST_FREE(m.P);
}
