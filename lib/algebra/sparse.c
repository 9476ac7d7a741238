/* sparse.c: LU factors of a sparse matrix, with KLU (Davis, Palamadai Natarajan 2010) */
#include "algebra/sparse.h"

#include "algebra/algebra_limits.h"
#include "algebra/linear.h"
#include "base/memory.h"

#include <klu.h>
#include <math.h>
#include <string.h>

/* KLU's factors for many solutions, LU + F = P (R \ A) Q. KLU's storage makes factoring fast, but
 * its solution divides once for each unknown and treats each block separately. Here they are stored
 * by rows: F and L, then U divided by its pivots, with the start of each row and the end of the
 * last one. */
typedef struct Unpacked {
    int *lower, *lower_column, *upper, *upper_column;
    double *lower_value, *upper_value;
    double *pivot, *scale; /* over each, of rows as they are permuted */
    int *p, *q;
    int *block, block_count; /* start of each block, and the end */
    double *x;
    int lower_room, upper_room;
} Unpacked;

struct Sparse {
    int n, entries;
    int *place; /* of an entry: in `lu`'s matrix, or in `values` */
    Lu *lu;     /* small */
    int *start, *row;
    double *values; /* by columns */
    klu_symbolic *symbolic;
    klu_numeric *numeric;
    klu_common common;
    double growth;   /* of pivots as they were chosen: least of max |A| / max |U| by columns */
    Cleanup cleanup; /* of KLU's */
    int singular;
    int solutions; /* with the factors there are; SPARSE_UNPACK: they are unpacked */
    Unpacked unpacked;
};

/* entries by columns: start of each, and the new index of each entry */
static void by_columns(Sparse *s, const int *row, const int *column)
{
    for (int k = 0; k < s->entries; k++)
        s->start[column[k] + 1]++;
    for (int c = 0; c < s->n; c++)
        s->start[c + 1] += s->start[c];
    for (int k = 0; k < s->entries; k++) {
        s->place[k] = s->start[column[k]]++;
        s->row[s->place[k]] = row[k];
    }
    for (int c = s->n; c > 0; c--)
        s->start[c] = s->start[c - 1];
    s->start[0] = 0;
}

static void close_factors(void *object)
{
    Sparse *s = object;

    (void)klu_free_numeric(&s->numeric, &s->common);
    (void)klu_free_symbolic(&s->symbolic, &s->common);
    cleanup_close(&s->cleanup);
}

Sparse *sparse_new(int n, int entries, const int *row, const int *column)
{
    Sparse *s = NEW(Sparse);

    s->n = n;
    s->entries = entries;
    s->singular = -1;
    s->place = NEW_ARRAY(int, entries);
    if (n <= SPARSE_DENSE) {
        s->lu = lu_new(n);
        for (int k = 0; k < entries; k++)
            s->place[k] = row[k] * n + column[k];
        return s;
    }
    s->start = NEW_ARRAY(int, n + 1);
    s->row = NEW_ARRAY(int, entries);
    s->values = NEW_ARRAY(double, entries);
    by_columns(s, row, column);
    (void)klu_defaults(&s->common);
    cleanup_open(&s->cleanup, close_factors, s);
    return s;
}

static void unpacked_free(Unpacked *u)
{
    MEM_FREE(u->lower, u->lower_column, u->upper, u->upper_column, u->lower_value, u->upper_value,
             u->pivot, u->scale, u->p, u->q, u->block, u->x);
}

void sparse_free(Sparse *s)
{
    if (s == NULL)
        return;
    if (s->lu == NULL)
        close_factors(s);
    lu_free(s->lu);
    unpacked_free(&s->unpacked);
    MEM_FREE(s->place, s->start, s->row, s->values, s);
}

static bool factor_dense(Sparse *s, const double *values)
{
    double *matrix = lu_matrix(s->lu);

    memset(matrix, 0, (size_t)(s->n * s->n) * sizeof(double));
    for (int k = 0; k < s->entries; k++)
        matrix[s->place[k]] = values[k];
    if (lu_factor(s->lu))
        return true;
    /* an empty column, at least, can be named */
    s->singular = -1;
    for (int c = 0; c < s->n; c++) {
        double size = 0;

        for (int k = 0; k < s->entries; k++)
            if (s->place[k] % s->n == c)
                size = fmax(size, fabs(values[k]));
        if (size == 0)
            s->singular = c;
    }
    return false;
}

/* the pivots of the last matrix serve this one too */
static bool refactor(Sparse *s)
{
    return s->numeric != NULL &&
           klu_refactor(s->start, s->row, s->values, s->symbolic, s->numeric, &s->common) &&
           s->common.status == KLU_OK &&
           klu_rgrowth(s->start, s->row, s->values, s->symbolic, s->numeric, &s->common) &&
           s->common.rgrowth > SPARSE_LEAST_GROWTH * s->growth;
}

bool sparse_factor(Sparse *s, const double *values)
{
    s->solutions = 0;
    if (s->lu != NULL)
        return factor_dense(s, values);
    for (int k = 0; k < s->entries; k++) {
        if (!isfinite(values[k]))
            return false;
        s->values[s->place[k]] = values[k];
    }
    if (refactor(s))
        return true;
    mem_ask();
    if (s->symbolic == NULL)
        s->symbolic = klu_analyze(s->n, s->start, s->row, &s->common);
    (void)klu_free_numeric(&s->numeric, &s->common);
    if (s->symbolic != NULL)
        s->numeric = klu_factor(s->start, s->row, s->values, s->symbolic, &s->common);
    if (s->common.status == KLU_OUT_OF_MEMORY)
        transaction_fail();
    if (s->numeric != NULL && s->common.status == KLU_OK) {
        (void)klu_rgrowth(s->start, s->row, s->values, s->symbolic, s->numeric, &s->common);
        s->growth = s->common.rgrowth;
        return true;
    }
    s->singular = s->common.status == KLU_SINGULAR ? s->common.singular_col : -1;
    return false;
}

double sparse_condition(Sparse *s)
{
    if (s->lu != NULL)
        return lu_pivot_ratio(s->lu);
    return klu_rcond(s->symbolic, s->numeric, &s->common) ? s->common.rcond : 0;
}

/* --- many solutions --- */

static void make_room(Sparse *s, int lower, int upper)
{
    Unpacked *u = &s->unpacked;

    if (u->x == NULL) {
        u->x = NEW_ARRAY(double, s->n);
        u->pivot = NEW_ARRAY(double, s->n);
        u->scale = NEW_ARRAY(double, s->n);
        u->p = NEW_ARRAY(int, s->n);
        u->q = NEW_ARRAY(int, s->n);
        u->block = NEW_ARRAY(int, s->n + 1);
        u->lower = NEW_ARRAY(int, s->n + 1);
        u->upper = NEW_ARRAY(int, s->n + 1);
    }
    if (lower > u->lower_room) {
        MEM_FREE(u->lower_column, u->lower_value);
        u->lower_column = NEW_ARRAY(int, lower);
        u->lower_value = NEW_ARRAY(double, lower);
        u->lower_room = lower;
    }
    if (upper > u->upper_room) {
        MEM_FREE(u->upper_column, u->upper_value);
        u->upper_column = NEW_ARRAY(int, upper);
        u->upper_value = NEW_ARRAY(double, upper);
        u->upper_room = upper;
    }
}

/* One of KLU's matrices by columns. */
typedef struct SparseColumns {
    int *start, *row;
    double *value;
} SparseColumns;

/* how many entries off the diagonal each row has, two places on */
static void count_rows(int n, const SparseColumns *from, int *start)
{
    for (int c = 0; c < n; c++)
        for (int k = from->start[c]; k < from->start[c + 1]; k++)
            if (from->row[k] != c && from->row[k] + 2 <= n)
                start[from->row[k] + 2]++;
}

/* Append entries to rows: start[r + 1] is the next free index of row r. Diagonal entries are stored
 * separately. */
static void bring_rows(int n, const SparseColumns *from, int *start, int *column, double *value,
                       double *diagonal)
{
    for (int c = 0; c < n; c++)
        for (int k = from->start[c]; k < from->start[c + 1]; k++) {
            const int row = from->row[k], at = row != c ? start[row + 1]++ : -1;

            if (at >= 0) {
                column[at] = c;
                value[at] = from->value[k];
            } else if (diagonal != NULL) {
                diagonal[c] = 1 / from->value[k];
            }
        }
}

/* F's part of a row precedes L's: it subtracts blocks that are solved earlier. */
static void merge(Sparse *s, const SparseColumns *l, const SparseColumns *u, const SparseColumns *f)
{
    Unpacked *to = &s->unpacked;
    const size_t bytes = (size_t)(s->n + 1) * sizeof(int);

    memset(to->lower, 0, bytes);
    memset(to->upper, 0, bytes);
    count_rows(s->n, f, to->lower);
    count_rows(s->n, l, to->lower);
    count_rows(s->n, u, to->upper);
    for (int i = 2; i <= s->n; i++) {
        to->lower[i] += to->lower[i - 1];
        to->upper[i] += to->upper[i - 1];
    }
    bring_rows(s->n, f, to->lower, to->lower_column, to->lower_value, NULL);
    bring_rows(s->n, l, to->lower, to->lower_column, to->lower_value, NULL);
    bring_rows(s->n, u, to->upper, to->upper_column, to->upper_value, to->pivot);
    for (int i = 0; i < s->n; i++)
        for (int k = to->upper[i]; k < to->upper[i + 1]; k++)
            to->upper_value[k] *= to->pivot[i];
}

static bool unpack(Sparse *s)
{
    const int lower = s->numeric->lnz, upper = s->numeric->unz, off = s->numeric->nzoff;
    const int n = s->n;
    int *places = NEW_ARRAY(int, 4 * (n + 1) + lower + upper + off);
    double *numbers = NEW_ARRAY(double, lower + upper + off);
    int *blocks = places, *start = blocks + n + 1, *row = start + 3 * (n + 1);
    SparseColumns l = {start, row, numbers}, u = {start + n + 1, row + lower, numbers + lower},
                  f = {start + 2 * (n + 1), u.row + upper, u.value + upper};
    bool sound;

    make_room(s, lower + off, upper);
    sound = klu_extract(s->numeric, s->symbolic, l.start, l.row, l.value, u.start, u.row, u.value,
                        f.start, f.row, f.value, s->unpacked.p, s->unpacked.q, s->unpacked.scale,
                        blocks, &s->common) != 0;
    for (int i = 0; i < n && sound; i++)
        s->unpacked.scale[i] = 1 / s->unpacked.scale[i];
    if (sound) {
        merge(s, &l, &u, &f);
        s->unpacked.block_count = s->symbolic->nblocks;
        memcpy(s->unpacked.block, blocks, (size_t)(s->symbolic->nblocks + 1) * sizeof(int));
    }
    MEM_FREE(places, numbers);
    return sound;
}

/* from - sum of the products of entries first..end-1 of a row */
static double taken_off(double from, const int *column, const double *value, int first, int end,
                        const double *x)
{
    for (int k = first; k < end; k++)
        from -= value[k] * x[column[k]];
    return from;
}

static void solve_unpacked(const Sparse *s, double *b)
{
    const Unpacked u = s->unpacked;

    for (int k = u.block_count - 1; k >= 0; k--) {
        const int first = u.block[k], end = u.block[k + 1];

        for (int i = first; i < end; i++)
            u.x[i] = taken_off(b[u.p[i]] * u.scale[i], u.lower_column, u.lower_value, u.lower[i],
                               u.lower[i + 1], u.x);
        if (end == first + 1) {
            u.x[first] *= u.pivot[first];
            continue;
        }
        for (int i = end - 1; i >= first; i--)
            u.x[i] = taken_off(u.x[i] * u.pivot[i], u.upper_column, u.upper_value, u.upper[i],
                               u.upper[i + 1], u.x);
    }
    for (int i = 0; i < s->n; i++)
        b[u.q[i]] = u.x[i];
}

void sparse_solve(Sparse *s, double *b)
{
    if (s->lu != NULL) {
        lu_solve(s->lu, b);
        return;
    }
    if (s->solutions < SPARSE_UNPACK && ++s->solutions == SPARSE_UNPACK && !unpack(s))
        s->solutions = 0;
    if (s->solutions == SPARSE_UNPACK)
        solve_unpacked(s, b);
    else
        (void)klu_solve(s->symbolic, s->numeric, s->n, 1, b, &s->common);
}

int sparse_singular(const Sparse *s)
{
    return s->singular;
}
