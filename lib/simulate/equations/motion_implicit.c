/* motion_implicit.c: a motion as implicit equations F(t, w, w') = 0
 *
 * With multipliers, w = (y, L, M): L' = lambda and M' = mu of all rows, 0 where they aren't in use,
 * so that the positions of the equations don't depend on the rows in use. F is the stabilised
 * index-2 formulation (Gear, Gupta, Leimkuhler 1985): q' = N (u + Phi_u^T mu), M u' + Phi_u^T
 * lambda = F, Phi = 0, Phi_u u = nu, and mu = 0 of velocity rows. In the embedded form w is y, and
 * F is y' less its rates. */
#include "simulate/equations/motion_impl.h"

#include "algebra/linear.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

bool motion_evaluate_driven(Motion *mo, double t, const double *y, const double *acceleration,
                            const double *multipliers, Solved *out)
{
    const Equations *eq = mo->eq;

    motion_at_position(mo, motion_clock(mo, t), y);
    if (mo->lambda_all != multipliers)
        memcpy(mo->lambda_all, multipliers, (size_t)eq->m * sizeof(double));
    if (eq->network_reads != NULL) {
        for (int k = 0; k < mo->used; k++)
            mo->lambda[k] = multipliers[mo->rows[k]];
        motion_spread_multipliers(mo);
        eq->network_reads(eq->context, acceleration, mo->lambda_all);
    }
    if (!motion_evaluate_all(mo, t, y))
        return false;
    *out = (Solved){.acceleration = acceleration,
                    .multipliers = multipliers,
                    .rates = mo->solved,
                    .algebraic = mo->solved + eq->nx};
    return true;
}

/* Stabilised index 2: q' = N (u + Phi_u^T mu), M u' + Phi_u^T lambda = F, Phi = 0, Phi_u u = nu. */
static void constrain(Motion *mo, const double *w, const double *w_rate, double *out)
{
    const Equations *eq = mo->eq;
    const int tail = motion_length(mo);
    const double *u = w + eq->n, *lambda = w_rate + tail, *mu = lambda + eq->m;
    const double *mass = equations_mass(eq), *force = equations_force(eq);
    double *force_rows = out + eq->n;

    memset(mo->du, 0, (size_t)eq->nu * sizeof(double));
    for (int j = 0; j < eq->nu; j++)
        force_rows[j] = pattern_dot(eq->masses, mass, j, w_rate + eq->n) - force[j];
    memcpy(out + tail, lambda, (size_t)(2 * eq->m) * sizeof(double));
    for (int k = 0; k < mo->used; k++) {
        const int row = mo->rows[k];

        pattern_add(eq->rows, eq->phi_u, row, lambda[row], force_rows);
        pattern_add(eq->rows, eq->phi_u, row, mu[row], mo->du);
        out[tail + row] = row < eq->position_rows ? eq->phi[row] : mu[row];
        out[tail + eq->m + row] = pattern_dot(eq->rows, eq->phi_u, row, u) - eq->nu_rate[row];
    }
    for (int i = 0; i < eq->n; i++) { /* q' = N (u + Phi_u^T mu) */
        const double sum = eq->map == NULL ? mo->du[i] : pattern_dot(eq->maps, eq->map, i, mo->du);

        out[i] = w_rate[i] - eq->q_rate[i] - sum;
    }
}

static bool residual(void *context, double t, const double *w, const double *w_rate, double *out)
{
    Motion *mo = context;
    const Equations *eq = mo->eq;
    const int x = eq->n + eq->nu, references = multi_turn_place(eq),
              work = references + eq->multi_turn_count;
    const double *multipliers = w_rate + motion_length(mo);
    Solved solved;

    if (!motion_evaluate_driven(mo, t, w, w_rate + eq->n, multipliers, &solved))
        return false;
    if (eq->accelerated != NULL)
        eq->accelerated(eq->context, w_rate + eq->n, multipliers);
    constrain(mo, w, w_rate, out);
    for (int i = 0; i < eq->nx; i++)
        out[x + i] = w_rate[x + i] - mo->solved[i];
    for (int k = 0; k < eq->multi_turn_count; k++)
        out[references + k] = w_rate[references + k] - eq->multi_turn_rate[k];
    out[work] = w_rate[work] - (eq->power != NULL ? *eq->power : 0);
    return vector_is_finite(out, mo->ode.dae.n);
}

static bool start(void *context, double t, const double *y, double *w, double *w_rate)
{
    Motion *mo = context;
    const int tail = motion_length(mo), m = mo->eq->m;

    mo->is_implicit = true;
    memset(w, 0, (size_t)mo->ode.dae.n * sizeof(double));
    memset(w_rate, 0, (size_t)mo->ode.dae.n * sizeof(double));
    memcpy(w, y, (size_t)tail * sizeof(double));
    if (!motion_evaluate_all(mo, t, y) || !motion_solve_plain(mo))
        return false;
    motion_bring_power(mo, mo->du);
    motion_write_rates(mo, w_rate);
    for (int k = 0; k < mo->used; k++) {
        w_rate[tail + mo->rows[k]] = mo->lambda[k];
        mo->dae_weight[tail + mo->rows[k]] = fmax(1, fabs(mo->lambda[k]));
    }
    return vector_is_finite(w_rate, tail + 2 * m);
}

static int pattern(void *context, const int **row, const int **column)
{
    const Motion *mo = context;
    const ImplicitJacobian *jacobian = &mo->implicit;

    return jacobian->pattern != NULL ? jacobian->pattern(jacobian->context, row, column) : -1;
}

static bool jacobian(void *context, double t, double c, const double *w, const double *w_rate,
                     double *values)
{
    const Motion *mo = context;

    return mo->implicit.at(mo->implicit.context, t, c, w, w_rate, values);
}

/* --- embedded form --- */

static bool embedded_residual(void *context, double t, const double *w, const double *w_rate,
                              double *out)
{
    const Motion *mo = context;

    if (!mo->ode.rate(mo->ode.context, t, w, out))
        return false;
    for (int i = 0; i < mo->ode.dae.n; i++)
        out[i] = w_rate[i] - out[i];
    return vector_is_finite(out, mo->ode.dae.n);
}

static bool embedded_start(void *context, double t, const double *y, double *w, double *w_rate)
{
    const Motion *mo = context;

    memcpy(w, y, (size_t)mo->ode.dae.n * sizeof(double));
    return mo->ode.rate(mo->ode.context, t, y, w_rate);
}

static bool embedded_jacobian(void *context, double t, double c, const double *w,
                              const double *w_rate, double *out)
{
    Motion *mo = context;
    const OdeJacobian *rates = &mo->ode.jacobian;
    const int n = mo->ode.n, all = mo->ode.dae.n;

    (void)w_rate;
    if (mo->slopes == NULL) {
        mem_keep(mo);
        mo->slopes = NEW_ARRAY(double, all *n);
    }
    if (rates->at == NULL || !rates->at(rates->context, t, w, mo->slopes))
        return false;
    for (int i = 0; i < all; i++)
        for (int j = 0; j < all; j++)
            out[(ptrdiff_t)j * all + i] =
                (i == j ? c : 0) - (j < n ? mo->slopes[(ptrdiff_t)i * n + j] : 0);
    return true;
}

/* --- the interface to solvers --- */

void motion_offer_implicit(Motion *mo, ImplicitJacobian offered)
{
    mo->implicit = offered;
}

void ode_set_jacobian(Motion *mo, const Dae *dae)
{
    mo->ode.dae = *dae;
}

void motion_open_implicit(Motion *mo)
{
    const Equations *eq = mo->eq;
    const int y = motion_length(mo);

    mo->ode.dae = mo->options.embedded ? (Dae){.n = y,
                                               .residual = embedded_residual,
                                               .start = embedded_start,
                                               .full = embedded_jacobian}
                                       : (Dae){.n = y + 2 * eq->m,
                                               .residual = residual,
                                               .start = start,
                                               .pattern = pattern,
                                               .jacobian = jacobian};
    mo->ode.dae.context = mo;
    mo->dae_weight = NEW_ARRAY(double, mo->ode.dae.n);
    for (int i = 0; i < mo->ode.dae.n; i++)
        mo->dae_weight[i] = eq->unit != NULL && i < mo->ode.n ? eq->unit[i] : 1;
    mo->dae_weight[y - 1] = 1e20; /* work has no influence on other unknowns */
    mo->ode.dae.weight = mo->dae_weight;
    mo->is_tested = NEW_ARRAY(bool, mo->ode.dae.n);
    for (int i = 0; i < y; i++)
        mo->is_tested[i] = true;
    mo->ode.dae.is_tested = mo->is_tested;
}
