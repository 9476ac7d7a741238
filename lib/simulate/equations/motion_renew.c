/* motion_renew.c: constraint rows and independent speeds chosen anew where they have worn out
 *
 * Which of redundant rows are in use, and which speeds of the embedded form are independent, is
 * good near the configuration at which it was chosen. */
#include "simulate/equations/motion_impl.h"

#include "algebra/rank.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

#define POOR 1e-2 /* pivot ratio of rows that others may better */

bool motion_choose_independent(Motion *mo)
{
    const int freedoms = mo->eq->nu - mo->used;
    bool changed;
    int *before;

    before = NEW_ARRAY(int, freedoms);
    memcpy(before, embed_independent(mo->embed), (size_t)freedoms * sizeof(int));
    mo->is_embedded_factored = false;
    changed = embed_choose(mo->embed, mo->eq->phi_u, mo->rows, mo->wanted,
                           mo->options.independent_count) &&
              memcmp(before, embed_independent(mo->embed), (size_t)freedoms * sizeof(int)) != 0;
    mo->options.independent_count = 0; /* a later choice is by pivots alone */
    mem_free(before);
    return changed;
}

void motion_partition(Motion *mo, double t, const double *y)
{
    if (mo->embed == NULL)
        return;
    motion_at_position(mo, t, y);
    (void)motion_choose_independent(mo);
    (void)motion_factor_embedded(mo);
    mo->is_repartitioned = false;
}

/* Other rows in place of worn ones, where all of them offer better. */
static bool renew_rows(Motion *mo)
{
    const Equations *eq = mo->eq;
    int *rows;
    double ratio;
    bool changed;

    if (mo->used == eq->m || mo->used == 0)
        return false;
    ratio = rank_ratio(eq->phi_u, eq->nu, mo->rows, mo->used);
    if (mo->row_ratio == 0)
        mo->row_ratio = ratio;
    if (ratio > fmax(MOTION_WORN * mo->row_ratio, POOR))
        return false;
    rows = NEW_ARRAY(int, mo->used);
    mo->row_ratio = rank_choose(eq->phi_u, eq->m, eq->nu, mo->used, rows);
    changed = mo->row_ratio > ratio / MOTION_WORN &&
              memcmp(rows, mo->rows, (size_t)mo->used * sizeof(int)) != 0;
    if (changed)
        memcpy(mo->rows, rows, (size_t)mo->used * sizeof(int));
    else
        mo->row_ratio = ratio;
    mem_free(rows);
    return changed;
}

Renewed motion_renew(Motion *mo, double t, const double *y)
{
    Renewed renewed = {.independent = mo->is_repartitioned};

    mo->is_repartitioned = false;
    if (mo->used == mo->eq->m || mo->used == 0)
        return renewed;
    motion_at_position(mo, t, y);
    renewed.rows = renew_rows(mo);
    if (renewed.rows) {
        mo->is_factored = false;
        if (mo->embed != NULL)
            renewed.independent = motion_choose_independent(mo) || renewed.independent;
    }
    return renewed;
}
