/* probe.c: a residual over a variable index, its workspace, and its inputs from a row of values */
#include "simulate/equations/probe.h"

#include "base/memory.h"
#include "base/random.h"

#include <string.h>

static Expr put_on_surfaces(const void *layout, Expr e)
{
    return variable_index_on_surfaces(layout, e);
}

/* values of parameters, set once; the layout determines sides of switches */
static void put_parameters(Probe *probe, Parameters *parameters)
{
    int count;
    const Expr *own = residual_parameters(probe->residual, &count);
    double *inputs = probe->inputs + probe->layout->count;

    for (int i = 0; i < count; i++) {
        const int side = variable_index_side_of(probe->layout, own[i]);

        if (side >= 0)
            LIST_PUSH(probe->sides, (SideInput){probe->layout->count + i, side});
        else
            inputs[i] = parameters_value(parameters, own[i]);
    }
    probe_set_sides(probe);
    if (probe->sides.count == 0)
        workspace_run(probe->workspace, STAGE_PARAMETER, STAGE_PARAMETER);
}

Status probe_make(const VariableIndex *layout, Parameters *parameters, const ProbeOrder *order,
                  Probe **out, Diag *diag)
{
    const int parts = order->is_apart ? threads_count(parameters->threads) : 1;
    int *blocks = parts > 1 ? variable_index_blocks(layout) : NULL;
    const ResidualOrder rows = {.arena = system_arena(layout->system),
                                .roots = order->roots,
                                .root_count = order->root_count,
                                .row_count = order->row_count,
                                .unknowns = order->unknowns,
                                .unknown_count = order->unknown_count,
                                .inputs = layout->symbols,
                                .input_count = layout->count,
                                .blocks = {blocks, parts},
                                .put = order->is_put ? NULL : put_on_surfaces,
                                .context = layout,
                                .watch = order->watch};
    Probe *probe = NEW(Probe);
    Status status = OK;

    probe->layout = layout;
    CHECK(residual_new(&rows, &probe->residual, diag));
    probe->workspace = workspace_new(residual_program(probe->residual));
    workspace_choose(probe->workspace, parameters->evaluator);
    workspace_share(probe->workspace, parameters->threads);
    probe->inputs = workspace_inputs(probe->workspace);
    put_parameters(probe, parameters);
    *out = probe;
    probe = NULL;
done:
    mem_free(blocks);
    probe_free(probe);
    return status;
}

Status probe_new(const VariableIndex *layout, Parameters *parameters, const Expr *roots, int count,
                 Probe **out, Diag *diag)
{
    const ProbeOrder order = {.roots = roots, .root_count = count};

    return probe_make(layout, parameters, &order, out, diag);
}

void probe_free(Probe *probe)
{
    if (probe == NULL)
        return;
    workspace_free(probe->workspace);
    residual_free(probe->residual);
    LIST_FREE(probe->sides);
    mem_free(probe);
}

const Residual *probe_residual(const Probe *probe)
{
    return probe->residual;
}

bool probe_reads_state(const Probe *probe)
{
    /* signs of surfaces that the motion slides along have to be solved for */
    return probe->layout->slides == 0 &&
           program_last_stage(residual_program(probe->residual)) <= STAGE_VELOCITY;
}

bool probe_turn(Probe *probe, Expr parameter, double value)
{
    const int place = probe_place(probe, parameter);

    if (place < 0)
        return false;
    probe->inputs[place] = value;
    workspace_run(probe->workspace, STAGE_PARAMETER, STAGE_PARAMETER);
    return true;
}

double *probe_input(Probe *probe, int place)
{
    return probe->inputs + place;
}

void probe_set_sides(Probe *probe)
{
    const VariableIndex *l = probe->layout;

    probe->seen = l->sides;
    inputs_set(probe->inputs, l->signs, l->sign_values, l->sign_count);
    for (int i = 0; i < probe->sides.count; i++)
        probe->inputs[probe->sides.at[i].input] = l->closed[probe->sides.at[i].side];
    if (probe->sides.count > 0)
        workspace_run(probe->workspace, STAGE_PARAMETER, STAGE_PARAMETER);
}

/* --- rows --- */

RowValues row_of_state(const VariableIndex *l, double t, const double *y)
{
    return (RowValues){.t = t,
                       .q = y,
                       .u = y + l->n,
                       .x = y + l->n + l->nu,
                       .references = y + variable_index_references(l)};
}

RowValues row_of_solved(const VariableIndex *l, double t, const double *y, const Solved *solved)
{
    RowValues row = row_of_state(l, t, y);

    row.rates = solved->rates;
    row.z = solved->algebraic;
    row.acceleration = solved->acceleration;
    row.multipliers = solved->multipliers;
    return row;
}

bool row_solve(const VariableIndex *l, Motion *motion, double t, const double *y, RowValues *out)
{
    Solved solved;
    const bool sound = motion_solve(motion, t, y, &solved);

    *out = sound ? row_of_solved(l, t, y, &solved) : row_of_state(l, t, y);
    return sound;
}

static void put_state(const VariableIndex *l, const RowValues *row, double *inputs)
{
    inputs_set(inputs, l->signs, row->signs != NULL ? row->signs : l->sign_values, l->sign_count);
    inputs[l->t] = row->t;
    inputs_set(inputs, l->references, row->references, l->multi_turns);
    inputs_set(inputs, l->q, row->q, l->n);
    inputs_set(inputs, l->u, row->u, l->nu);
    inputs_set(inputs, l->x, row->x, l->nx);
}

static void put_row(const VariableIndex *l, const RowValues *row, double *inputs)
{
    put_state(l, row, inputs);
    inputs_set(inputs, l->rates, row->rates, l->nx);
    inputs_set(inputs, l->z, row->z, l->nz);
    inputs_set(inputs, l->acceleration, row->acceleration, l->nu);
    inputs_set(inputs, l->multipliers, row->multipliers, l->m);
    inputs_set(inputs, l->efforts, row->efforts, l->ne);
    inputs_set(inputs, l->jerk, row->jerk, l->nu);
}

const double *probe_values(Probe *probe, const RowValues *row)
{
    if (probe_reads_state(probe))
        put_state(probe->layout, row, probe_inputs(probe));
    else
        put_row(probe->layout, row, probe_inputs(probe));
    workspace_run(probe->workspace, STAGE_TIME, STAGE_ACCELERATION);
    return workspace_roots(probe->workspace);
}

/* errors of all inputs for these errors of the row; new */
static double *input_errors(const Probe *probe, const RowValues *errors)
{
    const VariableIndex *l = probe->layout;
    const int count = program_input_count(residual_program(probe->residual));
    double *inputs = NEW_ARRAY(double, count);

    put_row(l, errors, inputs);
    inputs_set(inputs, l->signs, errors->signs, l->sign_count);
    for (int i = l->count; i < count; i++)
        inputs[i] = number_error(probe->inputs[i]);
    return inputs;
}

void probe_errors(const Probe *probe, const RowValues *errors, double *out)
{
    double *inputs = input_errors(probe, errors);

    workspace_errors(probe->workspace, inputs, out);
    mem_free(inputs);
}

void probe_set(Probe *probe, const RowValues *row)
{
    put_row(probe->layout, row, probe_inputs(probe));
}

void probe_tangents(Probe *probe, const RowValues *row, const RowValues *errors, Tangents *tangents)
{
    double *off = errors != NULL ? input_errors(probe, errors) : NULL;

    probe_set(probe, row);
    tangents_at(tangents, probe->inputs, off);
    mem_free(off);
}

void probe_tangents_perturbed(Probe *probe, const RowValues *row, uint64_t seed, Tangents *tangents)
{
    const int count = program_input_count(residual_program(probe->residual));
    double *inputs = NEW_ARRAY(double, count);

    probe_set(probe, row);
    for (int i = 0; i < count; i++)
        inputs[i] = probe->inputs[i] * (1 + 0x1p-50 * random_unit(&seed));
    tangents_at(tangents, inputs, NULL);
    mem_free(inputs);
}

int probe_place(const Probe *probe, Expr symbol)
{
    int count;
    const Expr *own = residual_parameters(probe->residual, &count);

    for (int i = 0; i < probe->layout->count; i++)
        if (probe->layout->symbols[i] == symbol)
            return i;
    for (int i = 0; i < count; i++)
        if (own[i] == symbol)
            return probe->layout->count + i;
    return -1;
}

Status probe_at(const VariableIndex *layout, Parameters *parameters, Expr e, const RowValues *row,
                double *out, Diag *diag)
{
    Probe *probe = NULL;
    Status status = OK;

    CHECK(probe_new(layout, parameters, &e, 1, &probe, diag));
    *out = probe_values(probe, row)[0];
done:
    probe_free(probe);
    return status;
}
