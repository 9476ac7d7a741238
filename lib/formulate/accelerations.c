/* accelerations.c: M u' = F eliminated in symbols, so that a run's program does it: L^T D L
 *
 * From the last speed on, so that trees fill nothing in (Featherstone 2005). */
#include "formulate/accelerations.h"

#include "base/memory.h"
#include "formulate/system_impl.h"

#include <string.h>

enum { MOST_SPEEDS = 16 }; /* of a full M that is eliminated in symbols */

/* Pivots and rows of L in `mass`, right sides in `right`. */
static bool eliminate_mass(Arena *arena, int n, Expr *mass, Expr *right, Expr *inverse)
{
    for (int k = n - 1; k >= 0; k--) {
        if (expr_is_zero(mass[k * n + k]))
            return false;
        inverse[k] = expr_hold(arena, expr_div(arena, expr_int(arena, 1), mass[k * n + k]));
        for (int i = 0; i < k; i++) {
            const Expr part = expr_hold(arena, expr_mul(arena, mass[k * n + i], inverse[k]));

            if (expr_is_zero(part))
                continue;
            for (int j = 0; j <= i; j++)
                mass[i * n + j] =
                    expr_hold(arena, expr_sub(arena, mass[i * n + j],
                                              expr_mul(arena, part, mass[k * n + j])));
            right[i] = expr_hold(arena, expr_sub(arena, right[i], expr_mul(arena, part, right[k])));
        }
        for (int i = 0; i < k; i++)
            mass[k * n + i] = expr_mul(arena, mass[k * n + i], inverse[k]);
    }
    return true;
}

bool system_accelerations(System *system, const Expr *force, Expr *acceleration, Expr *excess)
{
    Arena *arena = system->arena;
    const int n = system_nu(system);
    const Expr *whole = system_run(system)->mass;
    Expr *mass, *inverse;
    bool found;

    if (n > MOST_SPEEDS || whole == NULL)
        return false;
    system_touch(system);
    mass = NEW_ARRAY(Expr, n * n);
    inverse = NEW_ARRAY(Expr, n);
    memcpy(mass, whole, (size_t)(n * n) * sizeof(Expr));
    memcpy(acceleration, force, (size_t)n * sizeof(Expr));
    found = eliminate_mass(arena, n, mass, acceleration, inverse);
    for (int k = 0; k < n && found; k++) {
        Expr sum = expr_mul(arena, acceleration[k], inverse[k]);

        for (int i = 0; i < k; i++)
            sum = expr_sub(arena, sum, expr_mul(arena, mass[k * n + i], acceleration[i]));
        acceleration[k] = expr_hold(arena, sum);
        excess[k] = expr_mul(arena, whole[k * n + k], inverse[k]);
    }
    MEM_FREE(mass, inverse);
    return found;
}
