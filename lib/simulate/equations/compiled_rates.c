/* compiled_rates.c: rates by a program of their own, and whether pivots exceed rounding error
 *
 * A run evaluates these most often, where nothing else is needed: accelerations, their rounding
 * indicators, power, and q' where it isn't u, all functions of t, q and u. */
#include "simulate/equations/compiled_equations_impl.h"

#include "base/four.h"
#include "simulate/equations/equations_limits.h"

#include <string.h>

static bool has_few_pivots(const double *excess, int count)
{
    bool has = true;

    for (int j = 0; j < count; j++)
        has &= (excess[j] > 0) & (excess[j] < PIVOT_MOST_EXCESS);
    return has;
}

AS_WIDE_AS_CAN_BE static bool has_many_pivots(const double *excess, int count)
{
    FourTruths all = {-1, -1, -1, -1};
    int j = 0;

    for (; j + 4 <= count; j += 4) {
        const Four four = *(const Four *)(excess + j);

        all &= (four > 0) & (four < PIVOT_MOST_EXCESS);
    }
    return all[0] && all[1] && all[2] && all[3] && has_few_pivots(excess + j, count - j);
}

bool compiled_have_pivots(const double *excess, int count)
{
    return count < 4 ? has_few_pivots(excess, count) : has_many_pivots(excess, count);
}

bool compiled_speeds_are_rates(const System *system)
{
    const int n = system_n(system);

    for (int i = 0; i < n && n == system_nu(system); i++)
        if (system_q_rate(system, i) != system_u(system, i)->symbol)
            return false;
    return n == system_nu(system);
}

static bool outright_apart(void *context, double t, const double *y, double *out)
{
    const CompiledEquations *nb = context;
    const VariableIndex *l = nb->layout;
    double *inputs = probe_inputs(nb->rates);
    const double *rates_found = workspace_roots(nb->rates->workspace);

    inputs[l->t] = t;
    memcpy(inputs + l->q, y, (size_t)(l->n + l->nu) * sizeof(double));
    workspace_run_joined(nb->rates->workspace);
    memcpy(out, nb->has_rates_of_q ? rates_found + l->nu + 1 : y + l->n,
           (size_t)l->n * sizeof(double));
    memcpy(out + l->n, rates_found, (size_t)l->nu * sizeof(double));
    out[l->n + l->nu] = rates_found[l->nu];
    return compiled_have_pivots(rates_found + nb->rates_excess, nb->rates_pivots);
}

static bool may_be_apart(const CompiledEquations *nb, const Constrained *solved)
{
    const VariableIndex *l = nb->layout;

    return solved->looked_at == 0 && l->nx + l->nz == 0 && l->multi_turns == 0 &&
           l->surface_count == 0 && nb->eq.accelerated == NULL;
}

static void push_roots(CompiledEquations *nb, const Constrained *solved, CompiledRoots *roots)
{
    const VariableIndex *l = nb->layout;

    for (int j = 0; j < l->nu; j++)
        LIST_PUSH(*roots, solved->acceleration[j]);
    LIST_PUSH(*roots, variable_index_on_surfaces(l, system_power(l->system)));
    nb->has_rates_of_q = !compiled_speeds_are_rates(l->system);
    for (int i = 0; i < l->n && nb->has_rates_of_q; i++)
        LIST_PUSH(*roots, system_q_rate(l->system, i));
    nb->rates_excess = roots->count;
    for (int j = 0; j < l->nu; j++)
        if (!expr_is_number(solved->excess[j])) /* it is 1 for speeds that rows determine */
            LIST_PUSH(*roots, solved->excess[j]);
    nb->rates_pivots = roots->count - nb->rates_excess;
}

Status compiled_rates(CompiledEquations *nb, const Constrained *solved, Diag *diag)
{
    CompiledRoots roots = {0};
    Status status = OK;

    if (!may_be_apart(nb, solved))
        return OK;
    push_roots(nb, solved, &roots);
    CHECK(compiled_compile(nb->layout, nb->parameters, &roots, &nb->rates, diag));
    workspace_foresee(nb->rates->workspace, MOTION_FACTORS_PAID);
    nb->eq.outright = outright_apart;
    nb->eq.is_outright_apart = true;
done:
    LIST_FREE(roots);
    return status;
}

void compiled_end_rates(CompiledEquations *nb)
{
    probe_free(nb->rates);
    nb->rates = NULL;
    nb->eq.outright = NULL;
}
