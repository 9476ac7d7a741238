/* independence.c: J J^T - shift 1 is positive definite where J's singular values are beyond the
 * root of the shift
 *
 * Its factors without exchange stay as sparse as their order allows, while pivots by size, which
 * tell a rank that is less, fill in. Rounding moves its eigenvalues by no more than some m^2 units
 * in the last place (Higham 2002, 10.1), far less than SHIFT for some thousand rows. */
#include "algebra/independence.h"

#include "algebra/ldl.h"
#include "base/memory.h"

#include <math.h>

#define SHIFT   1e-8  /* at least: of singular values of 1e-4 */
#define NOTHING 1e-10 /* of the largest row: rounding alone */
#define LARGE   1e100 /* squares of more, or less than its inverse, lose digits or are none */

/* J J^T below its diagonal, as rows of J come one after the other */
typedef struct Products {
    LIST(int) row, column;
    LIST(double) value;
    double *diagonal;
    /* entries of J: those of a column from the last row to the first */
    int *last; /* of each column, plus 1 */
    LIST(int) of, before;
    LIST(double) entry;
    int *met, *at; /* by row: the row, plus 1, that it was last multiplied by, and where that is */
} Products;

static void products_free(Products *p)
{
    LIST_FREE(p->row);
    LIST_FREE(p->column);
    LIST_FREE(p->value);
    LIST_FREE(p->of);
    LIST_FREE(p->before);
    LIST_FREE(p->entry);
    MEM_FREE(p->diagonal, p->last, p->met, p->at);
}

/* Row i times all before it that share a column with it. */
static void multiply(Products *p, int i, const double *row, int nu, double norm)
{
    for (int j = 0; j < nu; j++) {
        const double value = row[j] / norm;

        if (row[j] == 0)
            continue;
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
}

/* false when a row is as good as 0, or can't be squared */
static bool multiply_rows(Products *p, const double *matrix, int m, int nu)
{
    double least = INFINITY, largest = 0;

    for (int i = 0; i < m; i++) {
        const double *row = matrix + (ptrdiff_t)i * nu;
        double square = 0;

        for (int j = 0; j < nu; j++)
            square += row[j] * row[j];
        least = fmin(least, sqrt(square));
        largest = fmax(largest, sqrt(square));
        if (!(sqrt(square) < LARGE && least > 1 / LARGE && least > NOTHING * largest))
            return false;
        multiply(p, i, row, nu, sqrt(square));
    }
    return true;
}

static bool is_positive(const Products *p, int m, double shift, const Watch *watch)
{
    int *class = NEW_ARRAY(int, m), *place_of = NEW_ARRAY(int, m);
    int *place = NEW_ARRAY(int, p->value.count);
    LdlOrder *order =
        ldl_order_new(m, class, p->value.count, p->row.at, p->column.at, place, place_of);
    Ldl *ldl = ldl_new(order);
    bool positive;

    for (int k = 0; k < p->value.count; k++)
        ldl_entries(ldl)[place[k]] = p->value.at[k];
    for (int i = 0; i < m; i++)
        ldl_entries(ldl)[place_of[i]] = p->diagonal[i] - shift;
    positive = ldl_factor(ldl, NULL, watch);
    for (int k = 0; k < m && positive; k++)
        positive = ldl_pivots(ldl)[k] > 0;
    ldl_free(ldl);
    ldl_order_free(order);
    MEM_FREE(class, place_of, place);
    return positive;
}

bool rows_are_independent(const double *matrix, int m, int nu, double threshold, const Watch *watch)
{
    Products p = {.diagonal = NEW_ARRAY(double, m),
                  .last = NEW_ARRAY(int, nu),
                  .met = NEW_ARRAY(int, m),
                  .at = NEW_ARRAY(int, m)};
    bool independent;

    independent = m <= nu && multiply_rows(&p, matrix, m, nu) &&
                  is_positive(&p, m, fmax(SHIFT, 4 * threshold * threshold), watch);
    products_free(&p);
    return independent;
}
