/* motion_renew.c: chooses constraint rows and independent speeds anew where the choice has worn out
 *
 * The choice of rows in use, where some are redundant, and of independent speeds in the embedded
 * form is good only near the configuration at which it was made. */
#include "simulate/equations/motion_impl.h"

#include "algebra/rank.h"
#include "base/memory.h"
#include "simulate/equations/equations_limits.h"

#include <math.h>
#include <string.h>

bool motion_choose_independent(Motion *mo)
{
    const int freedoms = mo->eq->nu - mo->used;
    bool changed;
    int *before;

    before = NEW_ARRAY(int, freedoms);
    pattern_fill(mo->eq->rows, mo->eq->phi_u, mo->full_phi_u);
    memcpy(before, partitioning_independent(mo->partitioning), (size_t)freedoms * sizeof(int));
    mo->is_embedded_factored = false;
    changed = partitioning_choose(mo->partitioning, mo->full_phi_u, mo->rows, mo->wanted,
                                  mo->options.independent_count) &&
              memcmp(before, partitioning_independent(mo->partitioning),
                     (size_t)freedoms * sizeof(int)) != 0;
    mo->options.independent_count = 0; /* a later choice is by pivots alone */
    mem_free(before);
    return changed;
}

void motion_partition(Motion *mo, double t, const double *y)
{
    if (mo->partitioning == NULL)
        return;
    motion_at_position(mo, t, y);
    (void)motion_choose_independent(mo);
    (void)motion_factor_embedded(mo);
    mo->is_repartitioned = false;
}

/* Replace worn rows by others, where the rows of the full Phi_u offer better ones. */
static bool choose_rows_of(Motion *mo, const double *phi_u)
{
    const Equations *eq = mo->eq;
    int *rows;
    double ratio = rank_ratio(phi_u, eq->nu, mo->rows, mo->used);
    bool changed;

    if (mo->row_ratio == 0)
        mo->row_ratio = ratio;
    if (ratio > fmax(ROWS_WORN * mo->row_ratio, ROWS_POOR))
        return false;
    rows = NEW_ARRAY(int, mo->used);
    mo->row_ratio = rank_choose(phi_u, eq->m, eq->nu, mo->used, rows);
    changed = mo->row_ratio > ratio / ROWS_WORN &&
              memcmp(rows, mo->rows, (size_t)mo->used * sizeof(int)) != 0;
    if (changed)
        memcpy(mo->rows, rows, (size_t)mo->used * sizeof(int));
    else
        mo->row_ratio = ratio;
    mo->is_factored = mo->is_factored && !changed;
    mem_free(rows);
    return changed;
}

static bool choose_rows(Motion *mo)
{
    double *phi_u;
    bool changed;

    if (mo->used == mo->eq->m || mo->used == 0)
        return false;
    phi_u = pattern_spread(mo->eq->rows, mo->eq->phi_u);
    changed = choose_rows_of(mo, phi_u);
    mem_free(phi_u);
    return changed;
}

int *motion_set_rows(Motion *mo)
{
    int *kept;

    if (mo->used == mo->eq->m || mo->used == 0)
        return NULL;
    kept = NEW_ARRAY(int, mo->used);
    memcpy(kept, mo->rows, (size_t)mo->used * sizeof(int));
    if (choose_rows(mo)) {
        if (mo->is_implicit)
            return kept;
        if (mo->partitioning != NULL)
            mo->is_repartitioned = motion_choose_independent(mo) || mo->is_repartitioned;
    }
    mem_free(kept);
    return NULL;
}

void motion_return_rows(Motion *mo, int *rows)
{
    if (rows == NULL)
        return;
    memcpy(mo->rows, rows, (size_t)mo->used * sizeof(int));
    mo->row_ratio = 0;
    mo->is_factored = false;
    mem_free(rows);
}

Renewed motion_renew(Motion *mo, double t, const double *y)
{
    Renewed renewed = {.independent = mo->is_repartitioned};

    mo->is_repartitioned = false;
    if (mo->used == mo->eq->m || mo->used == 0)
        return renewed;
    motion_at_position(mo, t, y);
    renewed.rows = choose_rows(mo);
    if (renewed.rows && mo->partitioning != NULL)
        renewed.independent = motion_choose_independent(mo) || renewed.independent;
    return renewed;
}

/* The first steps may be small: their extrapolation counts after some steps only. */
static bool elimination_pays(const Motion *mo, double steps_ahead)
{
    const double ahead = steps_ahead * mo->factored / mo->steps;

    return mo->factored >= MOTION_FACTORS_PAID ||
           (mo->factored >= MOTION_FACTORS_SEEN && ahead >= MOTION_FACTORS_PAID);
}

Status motion_try_coordinate_partitioning(Motion *mo, double steps_ahead, Diag *diag)
{
    const Equations *eq = mo->eq;

    mo->steps++;
    if (eq->eliminate == NULL || mo->partitioning != NULL || !elimination_pays(mo, steps_ahead))
        return OK;
    mo->factored = mo->steps = 0;
    mo->is_evaluated = mo->is_factored = mo->is_alone = false;
    mem_keep(mo); /* as it is now: where the call fails, so does what was evaluated after it */
    return eq->eliminate(eq->context, mo->rows, mo->used, ELIMINATION_COST * kkt_products(mo->kkt),
                         diag);
}
