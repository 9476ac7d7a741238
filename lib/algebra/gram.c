/* gram.c: J J^T row by row, column by column of J, and its factors in Camd's order */
#include "algebra/gram.h"

#include "algebra/ldl.h"
#include "base/memory.h"

#include <float.h>
#include <math.h>

enum { NORMED = 8 }; /* units that rows are off after their division */

/* J J^T below its diagonal, in the order of the rows of J */
struct Gram {
    int m;
    int filled; /* entries of a row of J, at most */
    LIST(int) row, column;
    LIST(double) value;
    double *diagonal;
    /* entries of J: those of a column from the last row to the first */
    int *last; /* of each column, plus 1 */
    LIST(int) of, before;
    LIST(double) entry;
    int *met, *at; /* by row: the row, plus 1, that it was last multiplied by, and where that is */
    LdlOrder *order;
    Ldl *ldl;
    int *place_of;
};

void gram_free(Gram *p)
{
    LIST_FREE(p->row);
    LIST_FREE(p->column);
    LIST_FREE(p->value);
    LIST_FREE(p->of);
    LIST_FREE(p->before);
    LIST_FREE(p->entry);
    ldl_free(p->ldl);
    ldl_order_free(p->order);
    MEM_FREE(p->diagonal, p->last, p->met, p->at, p->place_of, p);
}

/* An entry of row i, in column j, times all before it there. */
static void multiply(Gram *p, int i, int j, double value)
{
    p->diagonal[i] += value * value;
    for (int e = p->last[j] - 1; e >= 0; e = p->before.at[e]) {
        const int other = p->of.at[e];

        if (p->met[other] != i + 1) {
            p->met[other] = i + 1;
            p->at[other] = p->value.count;
            LIST_PUSH(p->row, other);
            LIST_PUSH(p->column, i);
            LIST_PUSH(p->value, 0);
        }
        p->value.at[p->at[other]] += value * p->entry.at[e];
    }
    LIST_PUSH(p->of, i);
    LIST_PUSH(p->before, p->last[j] - 1);
    LIST_PUSH(p->entry, value);
    p->last[j] = p->of.count;
}

static void put_entries(Gram *p)
{
    const int count = p->value.count;
    int *class = NEW_ARRAY(int, p->m), *place = NEW_ARRAY(int, count);

    p->order = ldl_order_new(p->m, class, count, p->row.at, p->column.at, place, p->place_of);
    p->ldl = ldl_new(p->order);
    for (int k = 0; k < count; k++)
        ldl_entries(p->ldl)[place[k]] = p->value.at[k];
    MEM_FREE(class, place);
}

static Gram *gram_open(int m, int nu)
{
    Gram *p = NEW(Gram);

    p->m = m;
    p->diagonal = NEW_ARRAY(double, m);
    p->last = NEW_ARRAY(int, nu);
    p->met = NEW_ARRAY(int, m);
    p->at = NEW_ARRAY(int, m);
    p->place_of = NEW_ARRAY(int, m);
    return p;
}

Gram *gram_new(const double *matrix, int m, int nu, const double *norm)
{
    Gram *p = gram_open(m, nu);

    for (int i = 0; i < m; i++) {
        const double *row = matrix + (ptrdiff_t)i * nu;
        int filled = 0;

        for (int j = 0; j < nu; j++)
            if (row[j] != 0) {
                multiply(p, i, j, row[j] / (norm != NULL ? norm[i] : 1));
                filled++;
            }
        p->filled = filled > p->filled ? filled : p->filled;
    }
    put_entries(p);
    return p;
}

Gram *gram_of_columns(const Pattern *pattern, const double *values, const double *norm)
{
    Gram *p = gram_open(pattern->columns, pattern->rows);

    for (int i = 0; i < pattern->columns; i++) {
        const int first = pattern->start[i], end = pattern->start[i + 1];

        for (int k = first; k < end; k++)
            if (values[k] != 0)
                multiply(p, i, pattern->row[k], values[k] / (norm != NULL ? norm[i] : 1));
        p->filled = end - first > p->filled ? end - first : p->filled;
    }
    put_entries(p);
    return p;
}

double gram_largest(const Gram *p)
{
    double largest = 0;

    for (int i = 0; i < p->m; i++)
        largest = fmax(largest, p->diagonal[i]);
    return largest;
}

/* An entry is the sum of as many products as a row of J has, and of L has; as many entries as a row
 * of L + L^T has are off by a unit in the last place for each (Higham 2002, 10.1). */
double gram_rounding(const Gram *p)
{
    const double width = ldl_order_width(p->order), products = p->filled + width + NORMED;

    return products * width * DBL_EPSILON;
}

bool gram_factor(Gram *p, double added, double least, const CallMonitor *watch)
{
    for (int i = 0; i < p->m; i++)
        ldl_entries(p->ldl)[p->place_of[i]] = p->diagonal[i] + added;
    if (!ldl_factor(p->ldl, NULL, watch))
        return false;
    for (int i = 0; i < p->m; i++)
        if (!(ldl_pivots(p->ldl)[p->place_of[i]] > least * p->diagonal[i]))
            return false;
    return true;
}

void gram_solve(const Gram *p, double *b)
{
    double *x = NEW_ARRAY(double, p->m);

    for (int i = 0; i < p->m; i++)
        x[p->place_of[i]] = b[i];
    ldl_solve(p->ldl, x);
    for (int i = 0; i < p->m; i++)
        b[i] = x[p->place_of[i]];
    mem_free(x);
}
