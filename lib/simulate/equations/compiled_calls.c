/* compiled_calls.c: the callbacks of Equations; each runs its program up to the stage whose inputs
 * are known */
#include "simulate/equations/compiled_equations_impl.h"

#include <string.h>

static void take_references(void *context, const double *references)
{
    CompiledEquations *nb = context;

    inputs_set(probe_inputs(nb->main), nb->layout->references, references, nb->layout->multi_turns);
}

static void position(void *context, double t, const double *q)
{
    CompiledEquations *nb = context;
    double *inputs = probe_inputs(nb->main);

    inputs[nb->layout->t] = t;
    inputs_set(inputs, nb->layout->q, q, nb->layout->n);
    workspace_run(nb->main->workspace, STAGE_TIME, STAGE_POSITION);
    nb->is_mass_old = true;
    if (nb->articulated != NULL)
        nb->is_articulated = articulated_factor(
            nb->articulated, workspace_roots(nb->main->workspace) + nb->mass_needs);
    else if (nb->mass != NULL && nb->massing == NULL && !nb->is_mass_kept) {
        mass_matrix_set(nb->mass, workspace_roots(nb->main->workspace) + nb->mass_needs);
        nb->is_mass_kept = nb->is_mass_constant;
    }
}

static bool articulate(void *context, double *acceleration)
{
    CompiledEquations *nb = context;

    if (nb->is_articulated)
        articulated_solve(nb->articulated, nb->eq.force, acceleration);
    return nb->is_articulated;
}

/* u' of a program that eliminates M u' = F itself; false where a pivot is rounding error */
static bool set_accelerations(void *context, double *acceleration)
{
    const CompiledEquations *nb = context;

    if (!compiled_have_pivots(nb->eliminated_accelerations + nb->layout->nu, nb->layout->nu))
        return false;
    memcpy(acceleration, nb->eliminated_accelerations, (size_t)nb->layout->nu * sizeof(double));
    return true;
}

/* q and u are adjacent, in y as in the inputs */
static bool outright(void *context, double t, const double *y, double *out)
{
    CompiledEquations *nb = context;
    const VariableIndex *l = nb->layout;
    double *inputs = probe_inputs(nb->main);

    inputs[l->t] = t;
    memcpy(inputs + l->q, y, (size_t)(l->n + l->nu) * sizeof(double));
    workspace_run_joined(nb->main->workspace);
    memcpy(out, nb->eq.q_rate, (size_t)l->n * sizeof(double));
    out[l->n + l->nu] = *nb->eq.power;
    return set_accelerations(nb, out + l->n);
}

bool compiled_need_no_mass(const CompiledEquations *nb)
{
    return nb->eliminated_by == ELIMINATED_ALONG_TREES ||
           nb->eliminated_by == ELIMINATED_CONSTRAINED ||
           nb->eliminated_by == ELIMINATED_PRESCRIBED;
}

/* u' and lambda of such a program where drivers determine all speeds */
static void set_prescribed(void *context, double *acceleration, double *multiplier)
{
    const CompiledEquations *nb = context;
    const size_t size = (size_t)nb->layout->nu * sizeof(double);

    memcpy(acceleration, nb->eliminated_accelerations, size);
    memcpy(multiplier, nb->eliminated_accelerations + nb->layout->nu, size);
}

/* whether the pivots of a program that eliminates u' and the multipliers of the rows in use are
 * more than rounding error */
static bool constrained_has_pivots(void *context)
{
    const CompiledEquations *nb = context;

    return compiled_have_pivots(nb->eliminated_excess, nb->layout->nu);
}

static void constrained_step(void *context, const double *bottom, double *du)
{
    CompiledEquations *nb = context;
    double *asked = probe_inputs(nb->main) + nb->layout->multipliers;

    for (int k = 0; k < nb->eliminated.row_count; k++)
        asked[nb->eliminated.rows[k]] = bottom[k];
    workspace_run(nb->main->workspace, STAGE_ACCELERATION, STAGE_ACCELERATION);
    memcpy(du, nb->eliminated_step, (size_t)nb->layout->nu * sizeof(double));
}

static void bring_mass(void *context)
{
    CompiledEquations *nb = context;

    if (!nb->is_mass_old || nb->is_mass_kept)
        return;
    memcpy(probe_inputs(nb->massing), probe_inputs(nb->main),
           (size_t)nb->layout->count * sizeof(double));
    workspace_run(nb->massing->workspace, STAGE_TIME, STAGE_POSITION);
    if (nb->mass != NULL)
        mass_matrix_set(nb->mass, workspace_roots(nb->massing->workspace));
    nb->is_mass_old = false;
    nb->is_mass_kept = nb->is_mass_constant;
}

static void bring_force(void *context)
{
    CompiledEquations *nb = context;

    memcpy(probe_inputs(nb->massing), probe_inputs(nb->main),
           (size_t)nb->layout->count * sizeof(double));
    workspace_run(nb->massing->workspace, STAGE_TIME, STAGE_NETWORK);
}

static void velocity(void *context, const double *u, const double *x)
{
    CompiledEquations *nb = context;
    double *inputs = probe_inputs(nb->main);

    inputs_set(inputs, nb->layout->u, u, nb->layout->nu);
    inputs_set(inputs, nb->layout->x, x, nb->layout->nx);
    workspace_run(nb->main->workspace, STAGE_VELOCITY, STAGE_VELOCITY);
    nb->is_network_new = true;
}

static void copy_inputs(CompiledEquations *nb, int first, int count)
{
    memcpy(probe_inputs(nb->network) + first, probe_inputs(nb->main) + first,
           (size_t)count * sizeof(double));
}

static void network_at(void *context, const double *w)
{
    CompiledEquations *nb = context;
    const VariableIndex *l = nb->layout;
    double *inputs = probe_inputs(nb->network);

    inputs_set(inputs, l->rates, w, l->nx);
    inputs_set(inputs, l->z, w + l->nx, l->nz);
    if (nb->is_network_new)
        copy_inputs(nb, l->t, l->rates - l->t);
    workspace_run(nb->network->workspace, nb->is_network_new ? STAGE_TIME : STAGE_NETWORK,
                  STAGE_ACCELERATION);
    nb->is_network_new = false;
}

static void network_rounding(void *context, double *out)
{
    CompiledEquations *nb = context;
    const int first = (int)(nb->eq.network_residual - workspace_roots(nb->network->workspace));
    const int count = nb->layout->nx + nb->layout->nz;
    double *errors = NEW_ARRAY(double, first + count);

    probe_errors(nb->network, &(RowValues){0}, errors);
    memcpy(out, errors + first, (size_t)count * sizeof(double));
    mem_free(errors);
}

static void network_reads(void *context, const double *acceleration, const double *multipliers)
{
    CompiledEquations *nb = context;
    double *inputs = probe_inputs(nb->network);

    inputs_set(inputs, nb->layout->acceleration, acceleration, nb->layout->nu);
    inputs_set(inputs, nb->layout->multipliers, multipliers, nb->layout->m);
}

static void network_solved(void *context, const double *solved)
{
    CompiledEquations *nb = context;
    double *inputs = probe_inputs(nb->main);

    inputs_set(inputs, nb->layout->rates, solved, nb->layout->nx);
    inputs_set(inputs, nb->layout->z, solved + nb->layout->nx, nb->layout->nz);
}

static void loads(void *context)
{
    CompiledEquations *nb = context;

    workspace_run(nb->main->workspace, STAGE_NETWORK, STAGE_NETWORK);
}

static void accelerated(void *context, const double *acceleration, const double *multipliers)
{
    CompiledEquations *nb = context;
    double *inputs = probe_inputs(nb->main);

    inputs_set(inputs, nb->layout->acceleration, acceleration, nb->layout->nu);
    inputs_set(inputs, nb->layout->multipliers, multipliers, nb->layout->m);
    workspace_run(nb->main->workspace, STAGE_ACCELERATION, STAGE_ACCELERATION);
}

static bool may_be_outright(const CompiledEquations *nb)
{
    const VariableIndex *l = nb->layout;

    return nb->eq.without_mass == set_accelerations &&
           (nb->mass == NULL || compiled_need_no_mass(nb)) && l->nx + l->nz == 0 &&
           l->multi_turns == 0 && nb->eq.accelerated == NULL;
}

static void place_eliminated(CompiledEquations *nb)
{
    Eliminated *own = &nb->eliminated;
    const ConstrainedPlaces p = nb->eliminated_places;
    const double *at = nb->eliminated_accelerations;

    own->acceleration = at;
    own->multiplier = at + p.multiplier;
    own->pivot = p.taken > p.pivot ? at + p.pivot : NULL;
    own->taken = p.taken > p.pivot ? at + p.taken : NULL;
    nb->eliminated_excess = at + p.excess;
    own->left = at + p.left;
    nb->eliminated_step = at + p.step;
    own->has_pivots = constrained_has_pivots;
    own->step = constrained_step;
    nb->eq.eliminated = own;
}

void compiled_connect(CompiledEquations *nb)
{
    nb->eq.context = nb;
    nb->eq.take_references = take_references;
    nb->eq.position = position;
    nb->eq.velocity = velocity;
    nb->eq.network_solved = network_solved;
    nb->eq.loads = loads;
}

void compiled_connect_equations(CompiledEquations *nb, Stage network, Stage power)
{
    if (nb->eliminated_by == ELIMINATED_PRESCRIBED)
        nb->eq.prescribed = set_prescribed;
    else if (nb->eliminated_by == ELIMINATED_CONSTRAINED)
        place_eliminated(nb);
    else if (nb->eliminated_by != ELIMINATED_NOT)
        nb->eq.without_mass = set_accelerations;
    else if (nb->articulated != NULL)
        nb->eq.without_mass = articulate;
    nb->eq.accelerated = power == STAGE_ACCELERATION ? accelerated : NULL;
    if (may_be_outright(nb))
        nb->eq.outright = outright;
    nb->eq.network_reads = network == STAGE_ACCELERATION ? network_reads : NULL;
}

void compiled_connect_network(CompiledEquations *nb)
{
    nb->eq.network_at = network_at;
    nb->eq.network_rounding = network_rounding;
}

void compiled_connect_mass(CompiledEquations *nb)
{
    if (compiled_need_no_mass(nb))
        nb->eq.bring_force = bring_force;
    nb->eq.bring_mass = bring_mass;
}
