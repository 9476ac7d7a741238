/* inverse_steps.c: columns of unknowns in use, and their factors, which are reused as long as these
 * are the same */
#include "simulate/run/inverse_steps.h"

#include "base/memory.h"
#include "simulate/equations/factors.h"
#include "simulate/equations/rows.h"

#include <string.h>

struct InverseSteps {
    const Residual *residual;
    int rows, unknowns;
    bool *in_use;     /* for which the rest is valid */
    int *column;      /* of an unknown: column among `count`; -1: none */
    int count;        /* -1: not set up yet */
    Factors *factors; /* NULL: the matrix isn't square */
    int *start, *row; /* its pattern, by columns */
    int *root;        /* index of each entry's value among the roots */
    double *entries;
    double *found; /* count */
};

InverseSteps *inverse_steps_new(const Residual *residual, int unknowns)
{
    InverseSteps *s = NEW(InverseSteps);
    int slopes;

    (void)residual_slopes(residual, &slopes);
    s->residual = residual;
    s->rows = residual_row_count(residual);
    s->unknowns = unknowns;
    s->count = -1;
    s->in_use = NEW_ARRAY(bool, unknowns);
    s->column = NEW_ARRAY(int, unknowns);
    s->start = NEW_ARRAY(int, unknowns + 1);
    s->row = NEW_ARRAY(int, slopes);
    s->root = NEW_ARRAY(int, slopes);
    s->entries = NEW_ARRAY(double, slopes);
    s->found = NEW_ARRAY(double, unknowns);
    return s;
}

void inverse_steps_free(InverseSteps *s)
{
    if (s == NULL)
        return;
    factors_free(s->factors);
    MEM_FREE(s->in_use, s->column, s->start, s->row, s->root, s->entries, s->found, s);
}

/* order entries by columns, from those by rows */
static void put_entries(InverseSteps *s)
{
    const int first = residual_first_slope(s->residual);
    int count;
    const Slope *slopes = residual_slopes(s->residual, &count);
    int *next = NEW_ARRAY(int, s->count + 1);

    for (int k = 0; k < count; k++)
        if (s->column[slopes[k].unknown] >= 0)
            next[s->column[slopes[k].unknown] + 1]++;
    for (int c = 0; c < s->count; c++)
        next[c + 1] += next[c];
    memcpy(s->start, next, (size_t)(s->count + 1) * sizeof(int));
    for (int k = 0; k < count; k++)
        if (s->column[slopes[k].unknown] >= 0) {
            const int at = next[s->column[slopes[k].unknown]]++;

            s->row[at] = slopes[k].row;
            s->root[at] = first + k;
        }
    mem_free(next);
}

static void take_unknowns(InverseSteps *s, const bool *in_use)
{
    if (s->count >= 0 && memcmp(s->in_use, in_use, (size_t)s->unknowns * sizeof(bool)) == 0)
        return;
    memcpy(s->in_use, in_use, (size_t)s->unknowns * sizeof(bool));
    s->count = 0;
    for (int k = 0; k < s->unknowns; k++)
        s->column[k] = in_use[k] ? s->count++ : -1;
    factors_free(s->factors);
    s->factors = NULL;
    put_entries(s);
    if (s->count == s->rows)
        s->factors = factors_new(s->count, s->start, s->row, true);
}

static bool solve_square(InverseSteps *s, const double *values, const double *right)
{
    for (int e = 0; e < s->start[s->count]; e++)
        s->entries[e] = values[s->root[e]];
    return factors_make(s->factors, s->entries) &&
           factors_solve(s->factors, right, s->found) == s->count;
}

static bool solve_in_full(InverseSteps *s, const double *values, const double *right)
{
    double *full = NEW_ARRAY(double, s->rows * s->count);
    bool is_regular;

    for (int c = 0; c < s->count; c++)
        for (int e = s->start[c]; e < s->start[c + 1]; e++)
            full[s->row[e] * s->count + c] = values[s->root[e]];
    is_regular = rows_solve(full, s->rows, s->count, right, s->found) == s->count;
    mem_free(full);
    return is_regular;
}

bool inverse_step(InverseSteps *s, const double *values, const bool *in_use, const double *right,
                  double *out)
{
    take_unknowns(s, in_use);
    if (s->factors != NULL ? !solve_square(s, values, right) : !solve_in_full(s, values, right))
        return false;
    for (int k = 0; k < s->unknowns; k++)
        out[k] = s->column[k] >= 0 ? s->found[s->column[k]] : 0;
    return true;
}
