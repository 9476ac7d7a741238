/* ldl.c: row after row of L (Davis 2005), its pattern found once
 *
 * Row k of L (n x n, unit lower triangular) solves L y = a_k, and L_kj = y_j / d_j. As soon as y_j
 * is known, y_j times column j < k of L is subtracted from the rest of y. The entries of column j
 * in rows between j and k are already known. */
#include "algebra/ldl.h"

#include "base/memory.h"

#include <camd.h>
#include <math.h>
#include <string.h>

enum { POLLED = 64 }; /* rows between looks at the watch */

struct LdlOrder {
    int n;
    int *start, *row; /* entries over the diagonal, column by column, the diagonal before them */
    int *left, *at;   /* columns of a row of L, rising, and the index of each entry */
    int *left_start;  /* n + 1 */
    int *below;       /* rows of a column of L, rising */
    int *below_start; /* n + 1 */
};

struct Ldl {
    const LdlOrder *order;
    double *entries; /* diagonal, then those over it */
    double *l, *pivot, *inverse, *taken, *y;
};

/* --- the order --- */

/* pivots[k]: the k-th unknown in the order */
static void choose_pivots(int n, const int *class, int entries, const int *row, const int *column,
                          int *pivots)
{
    int *start = NEW_ARRAY(int, n + 1), *rows = NEW_ARRAY(int, entries);
    int status;

    for (int k = 0; k < entries; k++)
        start[column[k] + 1]++;
    for (int c = 0; c < n; c++)
        start[c + 1] += start[c];
    for (int k = 0; k < entries; k++)
        rows[start[column[k]]++] = row[k];
    for (int c = n; c > 0; c--)
        start[c] = start[c - 1];
    start[0] = 0;
    mem_ask();
    status = camd_order(n, start, rows, pivots, NULL, NULL, class);
    if (status == CAMD_OUT_OF_MEMORY)
        transaction_fail();
    MEM_FREE(start, rows);
}

static int later(int a, int b)
{
    return a > b ? a : b;
}

/* entries over the diagonal of the permuted matrix by columns; place[k] of each given one */
static void place_entries(LdlOrder *o, int entries, const int *row, const int *column,
                          const int *place_of, int *place)
{
    o->start = NEW_ARRAY(int, o->n + 1);
    o->row = NEW_ARRAY(int, entries);
    for (int k = 0; k < entries; k++)
        if (row[k] != column[k])
            o->start[later(place_of[row[k]], place_of[column[k]]) + 1]++;
    for (int c = 0; c < o->n; c++)
        o->start[c + 1] += o->start[c];
    for (int k = 0; k < entries; k++) {
        const int a = place_of[row[k]], b = place_of[column[k]];
        int *next = &o->start[later(a, b)];

        place[k] = a;
        if (a == b)
            continue;
        place[k] = o->n + *next;
        o->row[(*next)++] = a + b - later(a, b);
    }
    for (int c = o->n; c > 0; c--)
        o->start[c] = o->start[c - 1];
    o->start[0] = 0;
}

/* Row k of L into its columns: up the elimination tree from each entry of column k. A visited node
 * without `parent` gets k as parent. next[j]: the next free index of column j; `below` NULL: only
 * count. */
static void put_row(const LdlOrder *o, int k, int *parent, int *seen, int *next, int *below)
{
    seen[k] = k;
    for (int e = o->start[k]; e < o->start[k + 1]; e++)
        for (int j = o->row[e]; seen[j] != k; j = parent[j]) {
            if (parent[j] < 0)
                parent[j] = k;
            seen[j] = k;
            if (below != NULL)
                below[next[j]] = k;
            next[j]++;
        }
}

/* rows of L from its columns */
static void transpose(LdlOrder *o, int *next)
{
    for (int e = 0; e < o->below_start[o->n]; e++)
        o->left_start[o->below[e] + 1]++;
    for (int k = 0; k < o->n; k++)
        o->left_start[k + 1] += o->left_start[k];
    memcpy(next, o->left_start, (size_t)o->n * sizeof(int));
    for (int j = 0; j < o->n; j++)
        for (int e = o->below_start[j]; e < o->below_start[j + 1]; e++) {
            const int i = next[o->below[e]]++;

            o->left[i] = j;
            o->at[i] = e;
        }
}

static void find_fill(LdlOrder *o)
{
    const int n = o->n;
    int *parent = NEW_ARRAY(int, n), *seen = NEW_ARRAY(int, n), *next = NEW_ARRAY(int, n);

    o->left_start = NEW_ARRAY(int, n + 1);
    o->below_start = NEW_ARRAY(int, n + 1);
    for (int k = 0; k < n; k++)
        parent[k] = seen[k] = -1;
    for (int k = 0; k < n; k++)
        put_row(o, k, parent, seen, next, NULL);
    for (int j = 0; j < n; j++) {
        o->below_start[j + 1] = o->below_start[j] + next[j];
        next[j] = o->below_start[j];
        seen[j] = -1;
    }
    o->below = NEW_ARRAY(int, o->below_start[n]);
    o->left = NEW_ARRAY(int, o->below_start[n]);
    o->at = NEW_ARRAY(int, o->below_start[n]);
    for (int k = 0; k < n; k++)
        put_row(o, k, parent, seen, next, o->below);
    transpose(o, next);
    MEM_FREE(parent, seen, next);
}

LdlOrder *ldl_order_new(int n, const int *class, int entries, const int *row, const int *column,
                        int *place, int *place_of)
{
    LdlOrder *o = NEW(LdlOrder);
    int *pivots = NEW_ARRAY(int, n);

    o->n = n;
    choose_pivots(n, class, entries, row, column, pivots);
    for (int k = 0; k < n; k++)
        place_of[pivots[k]] = k;
    mem_free(pivots);
    place_entries(o, entries, row, column, place_of, place);
    find_fill(o);
    return o;
}

void ldl_order_free(LdlOrder *o)
{
    if (o == NULL)
        return;
    MEM_FREE(o->start, o->row, o->left, o->at, o->left_start, o->below, o->below_start, o);
}

int ldl_order_width(const LdlOrder *o)
{
    int width = 0;

    for (int k = 0; k < o->n; k++) {
        const int left = o->left_start[k + 1] - o->left_start[k];
        const int below = o->below_start[k + 1] - o->below_start[k];

        width = left + below + 1 > width ? left + below + 1 : width;
    }
    return width;
}

int64_t ldl_order_products(const LdlOrder *o)
{
    int64_t sum = 0;

    for (int j = 0; j < o->n; j++) {
        const int64_t below = o->below_start[j + 1] - o->below_start[j];

        sum += below * (below + 1) / 2;
    }
    return sum;
}

/* --- factors --- */

Ldl *ldl_new(const LdlOrder *order)
{
    Ldl *ldl = NEW(Ldl);
    const int n = order->n;

    ldl->order = order;
    ldl->entries = NEW_ARRAY(double, n + order->start[n]);
    ldl->l = NEW_ARRAY(double, order->left_start[n]);
    ldl->pivot = NEW_ARRAY(double, n);
    ldl->inverse = NEW_ARRAY(double, n);
    ldl->taken = NEW_ARRAY(double, n);
    ldl->y = NEW_ARRAY(double, n);
    return ldl;
}

void ldl_free(Ldl *ldl)
{
    if (ldl == NULL)
        return;
    MEM_FREE(ldl->entries, ldl->l, ldl->pivot, ldl->inverse, ldl->taken, ldl->y, ldl);
}

double *ldl_entries(Ldl *ldl)
{
    return ldl->entries;
}

/* row k of L from the remaining y, which becomes 0 again */
static double find_row(Ldl *ldl, int k)
{
    const LdlOrder *o = ldl->order;
    const int *below = o->below;
    double *y = ldl->y, *l = ldl->l, d = ldl->entries[k], taken = 0;

    for (int i = o->left_start[k]; i < o->left_start[k + 1]; i++) {
        const int j = o->left[i], at = o->at[i];
        const double own = y[j], entry = own * ldl->inverse[j], part = entry * own;

        l[at] = entry;
        if (own == 0)
            continue;
        y[j] = 0;
        for (int e = o->below_start[j]; e < at; e++)
            y[below[e]] -= l[e] * own;
        d -= part;
        if (part > 0)
            taken += part;
    }
    ldl->taken[k] = taken;
    return d;
}

bool ldl_factor(Ldl *ldl, const double *reference, const CallMonitor *watch)
{
    const LdlOrder *o = ldl->order;
    const double *over = ldl->entries + o->n;

    for (int k = 0; k < o->n; k++) {
        double d;

        for (int e = o->start[k]; e < o->start[k + 1]; e++)
            ldl->y[o->row[e]] = over[e];
        ldl->pivot[k] = d = find_row(ldl, k);
        if (reference != NULL && fabs(d) < LDL_SMALL * reference[k])
            d -= LDL_HOLD * reference[k];
        ldl->inverse[k] = d != 0 ? 1 / d : 0;
        if (k % POLLED == POLLED - 1 && monitor_poll(watch) != OK)
            return false;
    }
    return true;
}

const double *ldl_pivots(const Ldl *ldl)
{
    return ldl->pivot;
}

const double *ldl_taken(const Ldl *ldl)
{
    return ldl->taken;
}

void ldl_solve(const Ldl *ldl, double *x)
{
    const LdlOrder *o = ldl->order;
    const int *below = o->below;

    for (int j = 0; j < o->n; j++) {
        const double own = x[j];

        if (own == 0) /* as speeds of a correction are */
            continue;
        for (int e = o->below_start[j]; e < o->below_start[j + 1]; e++)
            x[below[e]] -= ldl->l[e] * own;
    }
    for (int j = o->n - 1; j >= 0; j--) {
        double sum = x[j] * ldl->inverse[j];

        for (int e = o->below_start[j]; e < o->below_start[j + 1]; e++)
            sum -= ldl->l[e] * x[below[e]];
        x[j] = sum;
    }
}

void ldl_residual(const Ldl *ldl, const double *b, const double *x, double *out)
{
    const LdlOrder *o = ldl->order;
    const double *over = ldl->entries + o->n;

    for (int k = 0; k < o->n; k++)
        out[k] = b[k] - ldl->entries[k] * x[k];
    for (int k = 0; k < o->n; k++) {
        double sum = 0;

        for (int e = o->start[k]; e < o->start[k + 1]; e++) {
            sum += over[e] * x[o->row[e]];
            out[o->row[e]] -= over[e] * x[k];
        }
        out[k] -= sum;
    }
}
