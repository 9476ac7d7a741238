/* motion_place.c: evaluates a motion at a state: runs its programs and factors its matrices */
#include "simulate/equations/motion_impl.h"

#include "algebra/linear.h"

#include <math.h>
#include <string.h>

int motion_length(const Motion *mo)
{
    return multi_turn_place(mo->eq) + mo->eq->multi_turn_count + 1;
}

double motion_clock(const Motion *mo, double t)
{
    t = t > mo->low ? t : mo->low;
    return t < mo->high ? t : mo->high;
}

/* --- evaluation --- */

/* whether references are those of the last evaluation, or so near that they determine the same
 * turns */
static bool turns_alike(const Motion *mo, const double *near)
{
    for (int k = 0; k < mo->eq->multi_turn_count; k++)
        if (!(fabs(near[k] - mo->references[k]) < 1))
            return false;
    return true;
}

/* before eq->position() */
static void set_near(Motion *mo, const double *y)
{
    if (mo->eq->multi_turn_count == 0)
        return;
    memcpy(mo->references, y + multi_turn_place(mo->eq),
           (size_t)mo->eq->multi_turn_count * sizeof(double));
    mo->eq->take_references(mo->eq->context, mo->references);
}

static uint64_t sides_of(const Motion *mo)
{
    return mo->eq->sides != NULL ? *mo->eq->sides : 0;
}

void motion_at_position(Motion *mo, double t, const double *y)
{
    size_t bytes = (size_t)mo->eq->n * sizeof(double);

    if (mo->is_evaluated && mo->t == t && mo->sides == sides_of(mo) &&
        memcmp(mo->q, y, bytes) == 0 && turns_alike(mo, y + multi_turn_place(mo->eq)))
        return;
    set_near(mo, y);
    mo->eq->position(mo->eq->context, t, y);
    mo->t = t;
    mo->sides = sides_of(mo);
    memcpy(mo->q, y, bytes);
    mo->is_evaluated = true;
    mo->is_factored = mo->is_embedded_factored = mo->is_alone = false;
}

bool motion_factor_with(Motion *mo, Kkt *kkt, const double *mass)
{
    mo->counts.factorisations++;
    if (!kkt_factor(kkt, mass, mo->eq->phi_u, mo->rows))
        return false;
    if (kkt_is_regularised(kkt)) {
        mo->counts.regularised++;
        if (isnan(mo->counts.singular_time))
            mo->counts.singular_time = mo->t;
    }
    mo->rounding_error = fmax(mo->rounding_error, kkt_rounding_error(kkt));
    return true;
}

bool motion_factor(Motion *mo)
{
    if (!mo->is_factored || !kkt_is_factored(mo->kkt)) {
        mo->is_factored = motion_factor_with(mo, mo->kkt, equations_mass(mo->eq));
        mo->factored += mo->is_factored && kkt_is_plain(mo->kkt);
    }
    return mo->is_factored;
}

/* Whether the independence of rows is known without pivots at the current state: far from
 * dependent, by the extrapolation of the step; or near a singular position, where each position is
 * checked when it is projected. Then pivots are only compared with rounding error. */
static bool are_rows_known(const Motion *mo)
{
    return (mo->is_far || mo->is_projecting) && motion_is_in_step(mo);
}

static bool is_of_rows_in_use(const Motion *mo, const Eliminated *own)
{
    return own != NULL && own->row_count == mo->used &&
           memcmp(own->rows, mo->rows, (size_t)mo->used * sizeof(int)) == 0;
}

bool motion_rows_are_fixed(const Motion *mo)
{
    const Eliminated *own = mo->eq->eliminated;

    return own != NULL && own->pivot == NULL && is_of_rows_in_use(mo, own);
}

bool motion_is_eliminated(Motion *mo)
{
    const Equations *eq = mo->eq;
    const Eliminated *own = eq->eliminated;

    if (!is_of_rows_in_use(mo, own))
        return false;
    if (!mo->is_alone) {
        mo->is_alone = own->has_pivots(eq->context) &&
                       (own->pivot == NULL ||
                        kkt_is_sound(mo->kkt, own->pivot, own->taken, eq->phi_u, mo->rows,
                                     own->left, own->left_count, are_rows_known(mo)));
        mo->counts.factorisations += mo->is_alone;
    }
    return mo->is_alone;
}

bool motion_factor_embedded(Motion *mo)
{
    if (mo->is_embedded_factored)
        return true;
    mo->counts.factorisations++;
    pattern_fill(mo->eq->masses, equations_mass(mo->eq), mo->full_mass);
    pattern_fill(mo->eq->rows, mo->eq->phi_u, mo->full_phi_u);
    mo->is_embedded_factored =
        partitioning_factor(mo->partitioning, mo->full_mass, mo->full_phi_u, mo->rows);
    return mo->is_embedded_factored;
}

bool motion_find_network(Motion *mo, double t, const double *y)
{
    const Equations *eq = mo->eq;

    motion_at_position(mo, motion_clock(mo, t), y);
    eq->velocity(eq->context, y + eq->n, y + eq->n + eq->nu);
    if (!netsolve_find(mo->network))
        return false;
    eq->network_solved(eq->context, mo->solved);
    return true;
}

/* what evaluate() does, with the current signs on surfaces */
bool motion_evaluate(Motion *mo, double t, const double *y)
{
    if (!motion_find_network(mo, t, y))
        return false;
    if (mo->eq->loads != NULL)
        mo->eq->loads(mo->eq->context);
    return true;
}
