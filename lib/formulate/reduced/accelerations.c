/* accelerations.c: M u' = F solved in symbols by the cheapest method, for the program of a run
 *
 * M (nu x nu) is factored as L^T D L from the last speed on: the elimination then has no fill-in
 * along trees (Featherstone 2005). Or speeds are eliminated along the trees (along_trees.h). */
#include "formulate/reduced/accelerations.h"

#include "base/memory.h"
#include "formulate/reduced/along_trees.h"
#include "formulate/reduced/operation_cost.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

#include <string.h>

enum {
    MOST_SPEEDS = 16, /* of a full M that is factored in symbols */
    FEW_SPEEDS = 8,   /* up to here M along the trees costs no more than body by body */
    WORTH = 800,      /* cost of M above which other methods are tried */
    /* With more the program exceeds the processor's caches; then loops over data do it instead. */
    MOST_SPEEDS_ALONG = 2000,
    MOST_OPERATIONS = 100000
};

/* Pivots and rows of L in `mass`, right sides in `right`. */
static bool eliminate_mass(Arena *arena, int n, Expr *mass, Expr *right, Expr *inverse)
{
    for (int k = n - 1; k >= 0; k--) {
        if (expr_is_zero(mass[k * n + k]))
            return false;
        inverse[k] =
            expr_name_temporary(arena, expr_div(arena, expr_int(arena, 1), mass[k * n + k]));
        for (int i = 0; i < k; i++) {
            const Expr part =
                expr_name_temporary(arena, expr_mul(arena, mass[k * n + i], inverse[k]));

            if (expr_is_zero(part))
                continue;
            for (int j = 0; j <= i; j++)
                mass[i * n + j] =
                    expr_name_temporary(arena, expr_sub(arena, mass[i * n + j],
                                                        expr_mul(arena, part, mass[k * n + j])));
            right[i] = expr_name_temporary(
                arena, expr_sub(arena, right[i], expr_mul(arena, part, right[k])));
        }
        for (int i = 0; i < k; i++)
            mass[k * n + i] = expr_mul(arena, mass[k * n + i], inverse[k]);
    }
    return true;
}

static bool through_mass(System *system, const Expr *force, Expr *acceleration, Expr *excess)
{
    Arena *arena = system->arena;
    const int n = system_nu(system);
    const Expr *whole = system_run(system)->mass;
    Expr *mass, *inverse;
    bool found;

    if (n > MOST_SPEEDS || whole == NULL)
        return false;
    mass = NEW_ARRAY(Expr, n * n);
    inverse = NEW_ARRAY(Expr, n);
    memcpy(mass, whole, (size_t)(n * n) * sizeof(Expr));
    memcpy(acceleration, force, (size_t)n * sizeof(Expr));
    found = eliminate_mass(arena, n, mass, acceleration, inverse);
    for (int k = 0; k < n && found; k++) {
        Expr sum = expr_mul(arena, acceleration[k], inverse[k]);

        for (int i = 0; i < k; i++)
            sum = expr_sub(arena, sum, expr_mul(arena, mass[k * n + i], acceleration[i]));
        acceleration[k] = expr_name_temporary(arena, sum);
        excess[k] = expr_mul(arena, whole[k * n + k], inverse[k]);
    }
    MEM_FREE(mass, inverse);
    return found;
}

/* --- cheapest method --- */

typedef struct AccelerationsSearch {
    System *system;
    const Groups *groups;
    const Expr *pushes;
    int n;
    Expr *best, *tried; /* 2 n: u', then a measure of their rounding */
    int64_t least;
} AccelerationsSearch;

static bool offer(AccelerationsSearch *search)
{
    const int64_t cost = operation_cost(search->tried, 2 * search->n);

    if (cost >= search->least)
        return false;
    search->least = cost;
    memcpy(search->best, search->tried, (size_t)(2 * search->n) * sizeof(Expr));
    return true;
}

/* One order of elimination: writing out more of them takes longer than the best saves in most
 * runs. */
static bool offer_along(AccelerationsSearch *search)
{
    const EliminationOrder way = {search->n <= FEW_SPEEDS ? DELAY_ALL : DELAY_NONE, true, true};

    return accelerations_along(search->system, search->groups, &way, search->pushes, search->tried,
                               search->tried + search->n) &&
           offer(search);
}

/* F, applied loads, u' and excess in one array */
static EliminatedBy eliminate(System *system, Expr *all)
{
    const int n = system_nu(system);
    AccelerationsSearch search = {
        .system = system, .pushes = all + n, .n = n, .least = MOST_OPERATIONS};
    Groups *groups = NULL;
    EliminatedBy eliminated_how = ELIMINATED_NOT;

    search.best = all + 2 * n;
    search.tried = NEW_ARRAY(Expr, 2 * n);
    if (through_mass(system, all, search.tried, search.tried + n) && offer(&search))
        eliminated_how = ELIMINATED_BY_MASS;
    if (n <= MOST_SPEEDS_ALONG && search.least >= WORTH)
        groups = groups_new(system);
    if (groups != NULL) {
        groups_move_inertia(system->arena, groups);
        search.groups = groups;
        if (offer_along(&search))
            eliminated_how = ELIMINATED_ALONG_TREES;
    }
    groups_free(groups);
    mem_free(search.tried);
    return eliminated_how;
}

EliminatedBy system_accelerations(System *system, const Expr *force, const Expr *pushes,
                                  Expr *acceleration, Expr *excess)
{
    Shown *shown = system->shown;
    const int n = system_nu(system);
    const size_t size = (size_t)n * sizeof(Expr);

    system_touch(system);
    if (shown->eliminated == NULL || memcmp(shown->eliminated, force, size) != 0 ||
        memcmp(shown->eliminated + n, pushes, size) != 0) {
        Expr *all = NEW_ARRAY(Expr, 4 * n);

        memcpy(all, force, size);
        memcpy(all + n, pushes, size);
        shown->eliminated_how = eliminate(system, all);
        mem_free(shown->eliminated);
        shown->eliminated = all;
    }
    memcpy(acceleration, shown->eliminated + 2 * n, size);
    memcpy(excess, shown->eliminated + 3 * n, size);
    return shown->eliminated_how;
}
