/* motion_solve.c: accelerations, multipliers and network rates at the current state
 *
 *     augmented   [M Phi_u^T; Phi_u 0] [u'; lambda] = [F; gamma]          (kkt.h)
 *     embedded    [G^T M; Phi_u] u' = [G^T F; gamma] for u_i' alone         (partitioning.h)
 *     coupled     either with G([x'; z]) = 0, as a fixed point in w = [x'; z] (solve_together()) */
#include "simulate/equations/motion_impl.h"

#include "algebra/linear.h"
#include "algebra/rank.h"
#include "base/memory.h"
#include "simulate/equations/equations_limits.h"

#include <math.h>
#include <string.h>

static void pick_rows(const Motion *mo, const double *all, double *out)
{
    for (int k = 0; k < mo->used; k++)
        out[k] = all[mo->rows[k]];
}

static bool solve_augmented(Motion *mo)
{
    const Equations *eq = mo->eq;

    if (motion_is_prescribed(mo)) {
        eq->prescribed(eq->context, mo->du, mo->lambda_all);
        pick_rows(mo, mo->lambda_all, mo->lambda);
        return true;
    }
    if (eq->without_mass != NULL && eq->without_mass(eq->context, mo->du)) {
        mo->counts.factorisations += !mo->is_alone;
        mo->is_alone = true;
        return true;
    }
    if (motion_is_eliminated(mo)) {
        memcpy(mo->du, eq->eliminated->acceleration, (size_t)eq->nu * sizeof(double));
        memcpy(mo->lambda, eq->eliminated->multiplier, (size_t)mo->used * sizeof(double));
        return true;
    }
    if (!motion_factor(mo))
        return false;
    pick_rows(mo, mo->eq->gamma, mo->bottom);
    kkt_solve(mo->kkt, equations_force(mo->eq), mo->bottom, mo->du, mo->lambda);
    return true;
}

/* Accelerations don't depend on the choice of independent speeds as long as Phi_d is well
 * conditioned. Where the choice is worn others are chosen, in the middle of a step too. Near a
 * singular position every choice is ill conditioned, and the augmented form gives the same
 * accelerations. */
static bool solve_embedded(Motion *mo)
{
    bool sound = motion_factor_embedded(mo);

    if (!sound || partitioning_condition(mo->partitioning) < MOTION_WORN) {
        mo->is_repartitioned = motion_choose_independent(mo) || mo->is_repartitioned;
        sound = motion_factor_embedded(mo);
    }
    if (!sound || partitioning_pivots(mo->partitioning) < PARTITIONING_SUSPECT) {
        if (!solve_augmented(mo))
            return false;
        if (!sound || kkt_is_regularised(mo->kkt))
            return true;
    }
    pick_rows(mo, mo->eq->gamma, mo->bottom);
    partitioning_solve(mo->partitioning, equations_force(mo->eq), mo->bottom, mo->du);
    return true;
}

/* Copy the multipliers of rows in use to their positions among all rows; 0 for the others. */
static void place_multipliers(Motion *mo)
{
    memset(mo->lambda_all, 0, (size_t)mo->eq->m * sizeof(double));
    for (int k = 0; k < mo->used; k++)
        mo->lambda_all[mo->rows[k]] = mo->lambda[k];
}

/* call after u' is known: power may read it and the multipliers, also in the embedded form */
void motion_bring_power(Motion *mo, const double *acceleration)
{
    if (mo->eq->accelerated == NULL)
        return;
    if (mo->partitioning != NULL) {
        memcpy(mo->kept, acceleration, (size_t)mo->eq->nu * sizeof(double));
        if (!solve_augmented(mo))
            return;
        memcpy(mo->du, mo->kept, (size_t)mo->eq->nu * sizeof(double));
    }
    place_multipliers(mo);
    mo->eq->accelerated(mo->eq->context, mo->du, mo->lambda_all);
}

void motion_write_rates(const Motion *mo, double *out)
{
    const Equations *eq = mo->eq;

    memcpy(out, eq->q_rate, (size_t)eq->n * sizeof(double));
    memcpy(out + eq->n, mo->du, (size_t)eq->nu * sizeof(double));
    memcpy(out + eq->n + eq->nu, mo->solved, (size_t)eq->nx * sizeof(double));
    if (eq->multi_turn_count > 0)
        memcpy(out + multi_turn_place(eq), eq->multi_turn_rate,
               (size_t)eq->multi_turn_count * sizeof(double));
    out[multi_turn_place(eq) + eq->multi_turn_count] = eq->power != NULL ? *eq->power : 0;
}

/* Multipliers of all rows from those in use: of all that give the same forces, the ones of least
 * norm. */
void motion_spread_multipliers(Motion *mo)
{
    const Equations *eq = mo->eq;
    double *phi_u;

    if (mo->used == eq->m) {
        for (int k = 0; k < mo->used; k++)
            mo->lambda_all[mo->rows[k]] = mo->lambda[k];
        return;
    }
    place_multipliers(mo);
    phi_u = pattern_spread(eq->rows, eq->phi_u);
    rank_least_multipliers(phi_u, eq->m, eq->nu, mo->lambda_all);
    mem_free(phi_u);
}

/* the change of w in a turn, relative to the sizes of its entries; 0: within their last digits */
static double turn_of(Motion *mo, int n)
{
    double largest = 0;

    for (int i = 0; i < n; i++) {
        const double size = fabs(mo->solved[i]);
        const double move = fabs(mo->solved[i] - mo->solved_before[i]);

        mo->turn_size[i] = fmax(mo->solved_size[i], fmax(size, TOGETHER_LEAST));
        if (!(move <= 1e-13 * size + TOGETHER_LEAST))
            largest = fmax(largest, move / mo->turn_size[i]);
    }
    return largest;
}

static void note_size(Motion *mo, int n)
{
    for (int i = 0; i < n; i++)
        mo->solved_size[i] = fmax(mo->solved_size[i], fabs(mo->solved[i]));
}

/* A network that reads u' or lambda, while forces read the network: the fixed point w = F(w), w =
 * [x'; z], where F solves for u' and lambda at w, and then for w. Where forces don't depend on what
 * follows from u' the second turn is the last. A reflected inertia larger than that of M makes the
 * iteration w <- F(w) diverge; Anderson's acceleration is applied.
 *
 * Ends where w doesn't change, or changes by rounding alone: a small difference of large terms has
 * fewer digits. */
static bool iterate_together(Motion *mo)
{
    const Equations *eq = mo->eq;
    const int n = eq->nx + eq->nz;
    double least = INFINITY;
    int stalled = 0;

    anderson_restart(mo->together);
    for (int k = 0; k < TOGETHER_ITERATIONS; k++) {
        double turn;

        if (!solve_augmented(mo))
            return false;
        motion_spread_multipliers(mo);
        memcpy(mo->solved_before, mo->solved, (size_t)n * sizeof(double));
        eq->network_reads(eq->context, mo->du, mo->lambda_all);
        if (!netsolve_find(mo->network))
            return false;
        turn = turn_of(mo, n);
        stalled = turn > least / 2 ? stalled + 1 : 0;
        if (turn == 0 || (stalled >= TOGETHER_STALLED && turn <= TOGETHER_ROUNDING)) {
            note_size(mo, n);
            return true;
        }
        least = fmin(least, turn);
        anderson_step(mo->together, mo->solved_before, mo->solved, mo->turn_size);
        memcpy(netsolve_values(mo->network), mo->solved_before, (size_t)n * sizeof(double));
        eq->network_solved(eq->context, mo->solved);
        if (eq->loads != NULL)
            eq->loads(eq->context);
    }
    return false;
}

/* Where it fails its values have no meaning: the next search begins at 0, and the network reads u'
 * = 0 and lambda = 0. */
static bool solve_together(Motion *mo)
{
    const Equations *eq = mo->eq;

    if (iterate_together(mo))
        return true;
    memset(netsolve_values(mo->network), 0, (size_t)(eq->nx + eq->nz) * sizeof(double));
    memset(mo->du, 0, (size_t)eq->nu * sizeof(double));
    memset(mo->lambda_all, 0, (size_t)eq->m * sizeof(double));
    eq->network_reads(eq->context, mo->du, mo->lambda_all);
    return false;
}

/* Solve for u' and lambda in the augmented form, with what the network reads of them. */
bool motion_solve_plain(Motion *mo)
{
    return mo->eq->network_reads != NULL ? solve_together(mo) : solve_augmented(mo);
}

bool motion_report(const Motion *mo, Solved *out)
{
    const Equations *eq = mo->eq;

    *out = (Solved){.acceleration = mo->du,
                    .multipliers = mo->lambda_all,
                    .rates = mo->solved,
                    .algebraic = mo->solved + eq->nx};
    return vector_is_finite(mo->du, eq->nu) && vector_is_finite(mo->lambda_all, eq->m) &&
           vector_is_finite(mo->solved, eq->nx + eq->nz);
}

bool motion_solve_in_use(Motion *mo, double t, const double *y, Solved *out)
{
    const bool spreads = mo->eq->network_reads != NULL && mo->used < mo->eq->m;

    if (mo->eq->slide_count > 0 || mo->is_projecting || spreads || !motion_evaluate(mo, t, y) ||
        !motion_solve_plain(mo) || (mo->is_factored && kkt_is_regularised(mo->kkt)))
        return false;
    place_multipliers(mo);
    return motion_report(mo, out);
}

bool motion_solve_rates(Motion *mo)
{
    if (mo->partitioning == NULL)
        return motion_solve_plain(mo);
    return (mo->eq->network_reads == NULL || solve_together(mo)) && solve_embedded(mo);
}
