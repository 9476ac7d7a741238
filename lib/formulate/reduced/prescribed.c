/* prescribed.c: multipliers of drivers from the prescribed motion */
#include "formulate/reduced/prescribed.h"

#include "base/memory.h"
#include "formulate/dynamics/cutset_equations.h"
#include "formulate/reduced/along_trees.h"
#include "formulate/reduced/operation_cost.h"
#include "formulate/system/system_impl.h"

#include <string.h>

enum {
    FEW_SPEEDS = 4 /* above, M u' was the most expensive in each of 60 random trees */
};

/* the only speed in a row, with an entry of 1 or -1; -1: none */
static int own_speed(const System *system, int row)
{
    const int nu = system_nu(system);
    const Expr *entry = system_run(system)->phi_u + (ptrdiff_t)row * nu;
    int found = -1;

    for (int j = 0; j < nu; j++) {
        if (expr_is_zero(entry[j]))
            continue;
        if (found >= 0 || (!expr_is(entry[j], 1) && !expr_is(entry[j], -1)))
            return -1;
        found = j;
    }
    return found;
}

/* the row of each speed; false: one has none */
static bool find_rows(const System *system, int *row_of)
{
    const int nu = system_nu(system), m = system_m(system);

    for (int j = 0; j < nu; j++)
        row_of[j] = -1;
    for (int k = 0; k < m; k++) {
        const int speed = own_speed(system, k);

        if (speed < 0 || row_of[speed] >= 0)
            return false;
        row_of[speed] = k;
    }
    return m == nu && m > 0;
}

/* --- M u' - F, by the methods that are tried --- */

typedef struct Offer {
    const Expr *acceleration;
    Expr *best, *tried;
    int count;
    int64_t least;
} Offer;

static void offer(Offer *offer)
{
    const int64_t price = operation_cost(offer->tried, offer->count);

    if (price >= offer->least)
        return;
    offer->least = price;
    memcpy(offer->best, offer->tried, (size_t)offer->count * sizeof(Expr));
}

static void offer_by_mass(const System *system, Offer *out)
{
    const EquationForm *run = system_run(system);
    Arena *arena = system->arena;

    for (int j = 0; j < out->count; j++) {
        out->tried[j] = expr_neg(arena, run->force[j]);
        for (int k = 0; k < out->count; k++)
            out->tried[j] =
                expr_add(arena, out->tried[j],
                         expr_mul(arena, run->mass[j * out->count + k], out->acceleration[k]));
    }
    offer(out);
}

static void offer_over_groups(System *system, Offer *out)
{
    static const EliminationOrder ways[] = {{DELAY_NONE, false, false}, {DELAY_NONE, true, true}};
    Expr *pushes = NEW_ARRAY(Expr, out->count);
    Groups *groups = groups_new(system);

    if (groups == NULL || system_pushes(system, pushes, NULL) != OK)
        goto done;
    groups_move_inertia(system->arena, groups);
    for (int i = 0; i < COUNT(ways); i++) {
        efforts_along(system, groups, &ways[i], out->acceleration, out->tried);
        for (int j = 0; j < out->count; j++)
            out->tried[j] = expr_name_temporary(system->arena,
                                                expr_sub(system->arena, out->tried[j], pushes[j]));
        offer(out);
    }
done:
    groups_free(groups);
    mem_free(pushes);
}

bool system_prescribed(System *system, Expr *acceleration, Expr *multiplier)
{
    const EquationForm *run = system_run(system);
    Arena *arena = system->arena;
    const int nu = system_nu(system);
    int *row_of = NEW_ARRAY(int, nu);
    Offer effort = {.acceleration = acceleration, .count = nu, .least = INT64_MAX};
    const bool is_prescribed = find_rows(system, row_of);

    system_touch(system);
    if (is_prescribed) {
        effort.best = NEW_ARRAY(Expr, 2 * nu);
        effort.tried = effort.best + nu;
        for (int j = 0; j < nu; j++)
            acceleration[j] =
                expr_mul(arena, run->phi_u[row_of[j] * nu + j], run->gamma[row_of[j]]);
        if (nu <= FEW_SPEEDS && run->mass != NULL)
            offer_by_mass(system, &effort);
        if (dynamics_lack(system, acceleration, effort.tried))
            offer(&effort);
        offer_over_groups(system, &effort);
        for (int j = 0; j < nu; j++)
            multiplier[row_of[j]] =
                expr_neg(arena, expr_mul(arena, run->phi_u[row_of[j] * nu + j], effort.best[j]));
        mem_free(effort.best);
    }
    mem_free(row_of);
    return is_prescribed && effort.least < INT64_MAX;
}
