/* embedded.c: G^T M and G^T F in symbols, for up to three constraints
 *
 * G = [J; 1] with J = -Phi_d^-1 Phi_i by minors (Cramer), so that every column of G has the
 * determinant of Phi_d below it once. Beyond three rows a run solves with Phi_d in numbers. */
#include "formulate/system_impl.h"

#include <string.h>

enum { MOST_ROWS = 3 };

static Expr phi_entry(System *system, int k, int j, Diag *diag, Status *status)
{
    Expr entry = expr_int(system->arena, 0);

    if (*status == OK)
        *status = system_show(system, BLOCK_JACOBIAN, k, j, &entry, diag);
    return entry;
}

/* determinant of the m x m matrix whose columns are Phi's columns[] */
static Expr determinant(System *system, const int *columns, Diag *diag, Status *status)
{
    Arena *arena = system->arena;
    int m = system->rows.count;
    Expr a[MOST_ROWS][MOST_ROWS];
    Expr terms[6];
    int count = 0;

    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++)
            a[i][j] = phi_entry(system, i, columns[j], diag, status);
    if (m == 1)
        return a[0][0];
    if (m == 2)
        return expr_sub(arena, expr_mul(arena, a[0][0], a[1][1]),
                        expr_mul(arena, a[0][1], a[1][0]));
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3;
        int q = (j + 2) % 3;

        terms[count++] = expr_product(arena, (Expr[]){a[0][j], a[1][p], a[2][q]}, 3);
        terms[count++] =
            expr_neg(arena, expr_product(arena, (Expr[]){a[0][j], a[1][q], a[2][p]}, 3));
    }
    return expr_sum(arena, terms, count);
}

static bool is_named(const System *system, int j)
{
    for (int i = 0; i < system->independent_count; i++)
        if (strcmp(system->independent[i], system->q.at[j].name) == 0)
            return true;
    return false;
}

/* which speeds are dependent: the user's others, else the last ones with a determinant that isn't
 * zero */
static Status choose(System *system, int *dependent, Expr *det, Diag *diag)
{
    int n = system->u.count;
    int m = system->rows.count;
    Status status = OK;

    if (system->independent_count > 0) {
        int count = 0;

        for (int j = 0; j < n; j++)
            if (!is_named(system, j) && count++ < m)
                dependent[count - 1] = j;
        if (count != m)
            return diag_set(diag, E_MODEL,
                            "%d independent coordinates are named, but %d are needed",
                            system->independent_count, n - m);
        *det = expr_fold(system->arena, determinant(system, dependent, diag, &status));
        if (status == OK && expr_is_zero(*det))
            return diag_set(diag, E_SINGULAR,
                            "the others don't follow from the independent coordinates named");
        return status;
    }
    for (int i = 0; i < m; i++)
        dependent[i] = n - m + i;
    for (;;) {
        int i = 0;

        *det = expr_fold(system->arena, determinant(system, dependent, diag, &status));
        if (status != OK || !expr_is_zero(*det))
            return status;
        /* the next choice: count down like an odometer of falling places */
        while (i < m && dependent[i] == i)
            i++;
        if (i == m)
            return diag_set(diag, E_SINGULAR, "the constraints aren't independent of one another");
        dependent[i]--;
        for (int k = i - 1; k >= 0; k--)
            dependent[k] = dependent[k + 1] - 1;
    }
}

/* row `row` of G^T times a vector or column */
static Status project(System *system, int row, Block block, int column, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    int m = system->rows.count;
    int dependent[MOST_ROWS];
    int independent = -1;
    Expr det = NULL;
    Expr own;
    Expr sum;
    Status status = OK;

    if (m > MOST_ROWS) {
        (void)diag_set(diag, E_MISSING,
                       "the embedded form is written out for up to %d constraints; here are %d",
                       MOST_ROWS, m);
        diag_hint(diag,
                  "runs use it at any size; `show mass` and `show jacobian` in the augmented form");
        return E_MISSING;
    }
    if (m > 0)
        CHECK(choose(system, dependent, &det, diag));
    for (int j = 0, seen = -1; j < system->u.count && seen < row; j++) {
        bool follows = false;

        for (int i = 0; i < m; i++)
            follows = follows || dependent[i] == j;
        if (!follows && ++seen == row)
            independent = j;
    }
    CHECK(system_show(system, block, independent, column, &own, diag));
    sum = own;
    for (int i = 0; i < m; i++) {
        int swapped[MOST_ROWS];
        Expr minor;
        Expr entry;

        memcpy(swapped, dependent, sizeof swapped);
        swapped[i] = independent;
        minor = expr_collect(arena, expr_fold(arena, determinant(system, swapped, diag, &status)));
        CHECK(status);
        CHECK(system_show(system, block, dependent[i], column, &entry, diag));
        sum = expr_sub(arena, sum,
                       expr_product(arena, (Expr[]){expr_div(arena, minor, det), entry}, 2));
    }
    *out = sum;
done:
    return status;
}

Status embedded_mass(System *system, int row, int column, Expr *out, Diag *diag)
{
    return project(system, row, BLOCK_MASS, column, out, diag);
}

Status embedded_force(System *system, int row, int column, Expr *out, Diag *diag)
{
    (void)column;
    return project(system, row, BLOCK_FORCES, 0, out, diag);
}
