/* phase.c: equations of a part of a run */
#include "simulate/run/phase.h"

#include "base/memory.h"

#include <string.h>

#define FEW 100 /* unknowns up to which radau's dense factors beat bdf's */

static bool *copy_sides(const bool *closed, int count)
{
    bool *copy = NEW_ARRAY(bool, count);

    memcpy(copy, closed, (size_t)count * sizeof(bool));
    return copy;
}

Status phase_new(System *system, Parameters *parameters, const bool *closed, int count, Phase **out,
                 Diag *diag)
{
    return phase_new_on(system, parameters, closed, count, NULL, 0, out, diag);
}

Status phase_new_on(System *system, Parameters *parameters, const bool *closed, int count,
                    const OnSurface *on, int on_count, Phase **out, Diag *diag)
{
    Phase *phase = NEW(Phase);
    const bool before = mem_scratch(true);
    Status status = OK;

    phase->system = system;
    phase->layout = layout_new_on(system, on, on_count);
    phase->like = phase;
    if (closed != NULL)
        phase->closed = copy_sides(closed, count);
    phase->on = NEW_ARRAY(OnSurface, on_count);
    for (int i = 0; i < on_count; i++)
        phase->on[i] = on[i];
    phase->on_count = on_count;
    phase_enter(phase);
    CHECK(numbers_new(phase->layout, parameters, &phase->numbers, diag));
    *out = phase;
    phase = NULL;
done:
    (void)mem_scratch(before);
    phase_free(phase);
    return status;
}

Phase *phase_new_like(Phase *other, const bool *closed, int count)
{
    Phase *phase = NEW(Phase);

    *phase = *other->like;
    phase->closed = copy_sides(closed, count);
    return phase;
}

void phase_enter(const Phase *phase)
{
    if (phase->closed != NULL)
        layout_take_sides(phase->layout, phase->closed);
}

Status phase_open(Phase *phase, Parameters *parameters, const MotionOptions *options, Diag *diag)
{
    const bool before = mem_scratch(true);
    Status status = OK;

    phase->motion = motion_new(numbers_equations(phase->numbers), options);
    phase->length = motion_length(phase->motion);
    if (phase->on_count == 0)
        phase->network = netdae_new(phase->layout, parameters, phase->motion);
    if (phase->network != NULL)
        motion_offer(phase->motion, netdae_equations(phase->network));
    CHECK(samples_new(phase->layout, parameters, phase->motion, &phase->samples, diag));
    CHECK(steep_new(phase->layout, parameters, phase->motion, numbers_equations(phase->numbers),
                    &phase->steep, diag));
    phase->onset = onset_new(phase->steep, motion_ode(phase->motion));
done:
    (void)mem_scratch(before);
    return status;
}

void phase_free(Phase *phase)
{
    if (phase == NULL)
        return;
    mem_free(phase->closed);
    if (phase->like != phase) {
        mem_free(phase);
        return;
    }
    events_free(phase->events);
    samples_free(phase->samples);
    onset_free(phase->onset);
    steep_free(phase->steep);
    probe_free(phase->states);
    mem_free(phase->among_whole);
    netdae_free(phase->network);
    motion_free(phase->motion);
    numbers_free(phase->numbers);
    layout_free(phase->layout);
    mem_free(phase->on);
    mem_free(phase);
}

const Method *phase_stiff_method(const Phase *phase)
{
    const bool is_network = phase->network != NULL;
    /* with switches a method of many steps would always begin anew */
    const bool one_step =
        phase->length + phase->layout->nz <= FEW || (phase->closed != NULL && is_network);

    return method_for(
        (MethodNeed){.stiff = true, .history = !one_step, .dae = !one_step && is_network});
}

bool phase_row(Phase *phase, double t, const double *y, RowValues *out)
{
    phase_enter(phase);
    return row_solve(phase->layout, phase->motion, t, y, out);
}

bool phase_states(Phase *phase, double t, const double *y, int count, RowValues *row, double *out)
{
    if (!phase_row(phase, t, y, row))
        return false;
    memcpy(out, probe_values(phase->states, row), (size_t)count * sizeof(double));
    return true;
}
