/* network_order.c: the equations of the user's tree, brought to a form that can be solved
 *
 * Each unknown has a highest rate in the equations. They are linear in these rates, with the matrix
 * L (count x count), and are solved for them. Where L is singular throughout, elimination leaves a
 * row without highest rates. That row determines a lower rate of one of its unknowns.
 * Differentiated, it determines the higher rates, which are substituted in the other rows: this
 * lowers the order of the unknown. theory 8. */
#include "formulate/formulate_limits.h"
#include "formulate/network/network_impl.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/rates.h"
#include "formulate/system/resolve.h"
#include "formulate/system/sample.h"
#include "formulate/system/system_impl.h"

#include <math.h>
#include <string.h>

typedef struct Order {
    System *system;
    int64_t nodes; /* of the arena at the start */
    int count;
    Expr *row; /* G, one for each unknown */
    Expr *L;   /* count x count */
    double *number;
} Order;

/* --- numeric tests instead of proofs --- */

/* an expression that is 0 at three points is 0 */
static bool vanishes(Expr e)
{
    for (uint32_t seed = 1; seed <= 3; seed++)
        if (fabs(expr_value_somewhere(e, seed)) > 1e-11)
            return false;
    return true;
}

/* rank of L at one point; O(count^3) */
static int rank_at(Order *o, uint32_t seed)
{
    int n = o->count;
    double *a = o->number;
    int rank = 0;

    for (int i = 0; i < n * n; i++)
        a[i] = expr_is_zero(o->L[i]) ? 0 : expr_value_somewhere(o->L[i], seed);
    for (int c = 0; c < n && rank < n; c++) {
        int p = rank;

        for (int r = rank; r < n; r++)
            if (fabs(a[r * n + c]) > fabs(a[p * n + c]))
                p = r;
        if (!(fabs(a[p * n + c]) > 1e-10))
            continue;
        for (int k = 0; k < n; k++) {
            double kept = a[p * n + k];

            a[p * n + k] = a[rank * n + k];
            a[rank * n + k] = kept;
        }
        for (int r = rank + 1; r < n; r++) {
            double f = a[r * n + c] / a[rank * n + c];

            for (int k = c; k < n && f != 0; k++)
                a[r * n + k] -= f * a[rank * n + k];
        }
        rank++;
    }
    return rank;
}

/* --- symbols --- */

/* y^(order) */
static Expr rate_symbol(const Unknown *y, int order)
{
    return order == 0 ? y->symbol : y->rates[order - 1];
}

static Expr highest(const Order *o, int j)
{
    const Unknown *y = &o->system->network->unknowns.at[j];

    return rate_symbol(y, y->order);
}

static Status check_room(const Order *o, Diag *diag)
{
    Status status = monitor_poll(o->system->watch);

    if (status == OK && arena_nodes(o->system->arena) - o->nodes > NETWORK_MOST_NODES) {
        status = diag_set(diag, E_MODEL, "the equations of this tree grow too long");
        diag_hint(diag, "set network state integrates the state form, which any network has");
    }
    return status;
}

static Status form_leading(Order *o, Diag *diag)
{
    Arena *arena = o->system->arena;
    Expr zero = expr_int(arena, 0);

    for (int i = 0; i < o->count; i++) {
        TRY(check_room(o, diag));
        for (int j = 0; j < o->count; j++)
            o->L[i * o->count + j] = expr_depends(o->row[i], highest(o, j))
                                         ? expr_diff(arena, o->row[i], highest(o, j))
                                         : zero;
    }
    return OK;
}

/* --- one row without highest rates --- */

/* The remainders of the highest rates cancel, and others may, except for rounding. */
static void drop_cancelled(const Order *o, Expr *row)
{
    Arena *arena = o->system->arena;
    Expr zero = expr_int(arena, 0);

    for (int j = 0; j < o->count; j++)
        for (int k = 0; k <= o->system->network->unknowns.at[j].order; k++) {
            Expr symbol = rate_symbol(&o->system->network->unknowns.at[j], k);

            if (expr_depends(*row, symbol) && (k == o->system->network->unknowns.at[j].order ||
                                               vanishes(expr_diff(arena, *row, symbol))))
                *row = expr_substitute(arena, *row, &symbol, &zero, 1);
        }
}

/* Eliminates until a row has no highest rates: returns which row, and its remainder in *out. */
static Status leftover(Order *o, int *found, Expr *out, Diag *diag)
{
    Arena *arena = o->system->arena;
    int n = o->count;
    Expr *row = NEW_ARRAY(Expr, n);
    Expr *L = NEW_ARRAY(Expr, n * n);
    bool *used = NEW_ARRAY(bool, n);
    Status status = OK;

    *found = -1;
    memcpy(row, o->row, (size_t)n * sizeof(Expr));
    memcpy(L, o->L, (size_t)(n * n) * sizeof(Expr));
    for (int c = 0; c < n; c++) {
        int p = -1;

        for (int r = 0; r < n && p < 0; r++)
            if (!used[r] && !vanishes(L[r * n + c]))
                p = r;
        if (p < 0)
            continue;
        used[p] = true;
        for (int r = 0; r < n; r++) {
            Expr f;

            if (used[r] || vanishes(L[r * n + c]))
                continue;
            CHECK(check_room(o, diag));
            f = expr_div(arena, L[r * n + c], L[p * n + c]);
            for (int k = 0; k < n; k++)
                L[r * n + k] = expr_fold(
                    arena, expr_sub(arena, L[r * n + k], expr_mul(arena, f, L[p * n + k])));
            row[r] = expr_sub(arena, row[r], expr_mul(arena, f, row[p]));
        }
    }
    for (int r = 0; r < n && *found < 0; r++)
        if (!used[r]) {
            *out = row[r];
            drop_cancelled(o, out);
            *out = expr_fold(arena, *out);
            *found = r;
        }
done:
    MEM_FREE(row, L, used);
    return status;
}

/* The unknown whose order the row lowers least: the row contains its rate `*rate` and none nearer
 * to a highest one; -1: the row contains no unknown. */
static int lowered_by(const Order *o, Expr row, int *rate)
{
    int best = -1;
    int gap = 0;

    for (int j = 0; j < o->count; j++) {
        const Unknown *y = &o->system->network->unknowns.at[j];
        int k = y->order - 1;

        while (k >= 0 && vanishes(expr_diff(o->system->arena, row, rate_symbol(y, k))))
            k--;
        if (k < 0 || (best >= 0 && y->order - k >= gap))
            continue;
        best = j;
        gap = y->order - k;
        *rate = k;
    }
    return best;
}

/* the owner of an unknown: an edge of the graph, or a part with a state of its own */
static const char *edge_of(const Order *o, int j)
{
    const System *system = o->system;
    const Unknown *y = &system->network->unknowns.at[j];

    return y->branchlike < 0
               ? system->origin->instances[y->instance].name
               : graph_edge(system->origin->graph, system->network->branches.at[y->branchlike].edge)
                     ->name;
}

static Status cant_order(const Order *o, int row, Diag *diag)
{
    const Unknown *y = &o->system->network->unknowns.at[row];

    (void)diag_set(diag, E_MODEL, "the equations of this tree can't be solved for %s",
                   expr_name(y->symbol));
    diag_hint(diag, "set network state integrates the state form, which any network has");
    return E_MODEL;
}

/* substitutes in the expressions of the unknowns: v and i of edges, and rates that are
 * expressions */
static void substitute_all(System *system, const Expr *from, const Expr *to, int count)
{
    Arena *arena = system->arena;

    for (int b = 0; b < system->network->branches.count; b++) {
        Branchlike *branch = &system->network->branches.at[b];

        branch->v = expr_substitute(arena, branch->v, from, to, count);
        branch->i = expr_substitute(arena, branch->i, from, to, count);
    }
    for (int k = 0; k < system->network->unknowns.count; k++) {
        const Unknown *y = &system->network->unknowns.at[k];

        for (int i = y->order; i < y->known; i++)
            y->rates[i] = expr_substitute(arena, y->rates[i], from, to, count);
    }
}

/* Rates of unknown j above order k, where the equation `row` determines that of order k: the first
 * in value[0], and so on. */
static Status rates_by(const Order *o, Expr row, int j, int k, Expr *symbol, Expr *value,
                       Diag *diag)
{
    System *system = o->system;
    Arena *arena = system->arena;
    Expr zero = expr_int(arena, 0);
    int count = system->network->unknowns.at[j].order - k;

    for (int i = 0; i < count; i++) {
        Expr rate;

        symbol[i] = rate_symbol(&system->network->unknowns.at[j], k + 1 + i);
        TRY(network_no_rate(system, edge_of(o, j),
                            system_rate_of(system, i == 0 ? row : value[i - 1], &rate, diag),
                            diag));
        if (i == 0 && expr_is_zero(expr_diff(arena, rate, symbol[0])))
            TRY(cant_order(o, j, diag));
        if (i == 0)
            value[0] =
                expr_neg(arena, expr_div(arena, expr_substitute(arena, rate, symbol, &zero, 1),
                                         expr_diff(arena, rate, symbol[0])));
        else
            value[i] = expr_substitute(arena, rate, symbol, value, i);
    }
    return OK;
}

static Status lower_order(Order *o, Diag *diag)
{
    System *system = o->system;
    Expr *symbol = NULL, *value = NULL;
    Expr rest = NULL;
    int k = 0;
    int r = -1;
    int j = -1;
    int count;
    Status status = OK;

    CHECK(leftover(o, &r, &rest, diag));
    if (r >= 0)
        j = lowered_by(o, rest, &k);
    if (j < 0)
        CHECK(cant_order(o, r >= 0 ? r : 0, diag));
    count = system->network->unknowns.at[j].order - k;
    symbol = NEW_ARRAY(Expr, count);
    value = NEW_ARRAY(Expr, count);
    CHECK(rates_by(o, rest, j, k, symbol, value, diag));
    for (int i = 0; i < o->count; i++)
        if (i != r) {
            CHECK(check_room(o, diag));
            o->row[i] = expr_substitute(system->arena, o->row[i], symbol, value, count);
        }
    substitute_all(system, symbol, value, count);
    o->row[r] = rest;
    /* they can still be determined */
    for (int i = 0; i < count; i++)
        system->network->unknowns.at[j].rates[k + i] = value[i];
    system->network->unknowns.at[j].order = k;
done:
    MEM_FREE(symbol, value);
    return status;
}

/* --- result --- */

/* the highest rates become the variables that are solved for */
static void rename(Order *o)
{
    System *system = o->system;
    Arena *arena = system->arena;
    Expr *from = NEW_ARRAY(Expr, o->count);
    Expr *to = NEW_ARRAY(Expr, o->count);

    for (int j = 0; j < o->count; j++) {
        Unknown *y = &system->network->unknowns.at[j];

        from[j] = highest(o, j);
        to[j] = expr_symbol(arena, expr_name(from[j]),
                            y->order == 0 ? SYMBOL_ALGEBRAIC : SYMBOL_STATE_RATE);
        if (y->order == 0)
            y->symbol = to[j];
        else
            y->rates[y->order - 1] = to[j];
        network_know(system, to[j], j, y->order);
    }
    for (int j = 0; j < o->count; j++) {
        Unknown *y = &system->network->unknowns.at[j];

        y->left = expr_substitute(arena, y->left, from, to, o->count);
        y->right = expr_substitute(arena, y->right, from, to, o->count);
        y->residual = expr_substitute(arena, o->row[j], from, to, o->count);
    }
    substitute_all(system, from, to, o->count);
    MEM_FREE(from, to);
}

Status network_bring_order(System *system, Diag *diag)
{
    Order o = {.system = system, .nodes = arena_nodes(system->arena)};
    Status status = OK;

    for (int k = 0; k < system->network->unknowns.count; k++) {
        CHECK(network_row(system, k, diag));
        CHECK(check_room(&o, diag));
    }
    o.count = system->network->unknowns.count;
    o.row = NEW_ARRAY(Expr, o.count);
    o.L = NEW_ARRAY(Expr, o.count * o.count);
    o.number = NEW_ARRAY(double, o.count *o.count);
    for (int k = 0; k < o.count; k++)
        o.row[k] =
            expr_sub(system->arena, expr_open(system->arena, system->network->unknowns.at[k].left),
                     expr_open(system->arena, system->network->unknowns.at[k].right));
    for (int round = 0;; round++) {
        CHECK(form_leading(&o, diag));
        if (rank_at(&o, 1) == o.count || rank_at(&o, 2) == o.count)
            break;
        if (round == NETWORK_ROUNDS)
            CHECK(cant_order(&o, 0, diag));
        CHECK(lower_order(&o, diag));
    }
    rename(&o);
done:
    MEM_FREE(o.row, o.L, o.number);
    return status;
}
