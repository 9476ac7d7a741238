/* sparse.c: LU factors of a sparse matrix, with KLU (Davis, Palamadai Natarajan 2010) */
#include "algebra/sparse.h"

#include "algebra/linear.h"
#include "base/memory.h"

#include <klu.h>
#include <math.h>
#include <string.h>

#define SMALL  12   /* up to here dense factors are faster (make bench: algebra.sparse_*) */
#define GROWTH 1e-8 /* pivots kept from an earlier matrix are given up below this */

struct Sparse {
    int n, entries;
    int *place; /* of an entry: in `lu`'s matrix, or in `values` */
    Lu *lu;     /* small */
    int *start, *row;
    double *values; /* by columns */
    klu_symbolic *symbolic;
    klu_numeric *numeric;
    klu_common common;
    Cleanup cleanup; /* of KLU's */
    int singular;
};

/* entries by columns: start of each, and where each entry went */
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
    if (n <= SMALL) {
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

void sparse_free(Sparse *s)
{
    if (s == NULL)
        return;
    if (s->lu == NULL)
        close_factors(s);
    lu_free(s->lu);
    mem_free(s->place);
    mem_free(s->start);
    mem_free(s->row);
    mem_free(s->values);
    mem_free(s);
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
           s->common.rgrowth > GROWTH;
}

bool sparse_factor(Sparse *s, const double *values)
{
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
    if (s->numeric != NULL && s->common.status == KLU_OK)
        return true;
    s->singular = s->common.status == KLU_SINGULAR ? s->common.singular_col : -1;
    return false;
}

double sparse_condition(Sparse *s)
{
    if (s->lu != NULL)
        return lu_pivot_ratio(s->lu);
    return klu_rcond(s->symbolic, s->numeric, &s->common) ? s->common.rcond : 0;
}

void sparse_solve(Sparse *s, double *b)
{
    if (s->lu != NULL)
        lu_solve(s->lu, b);
    else
        (void)klu_solve(s->symbolic, s->numeric, s->n, 1, b, &s->common);
}

int sparse_singular(const Sparse *s)
{
    return s->singular;
}
