/* mode_phases.c: the phase of each mode: sides of ideal switches, and of surfaces
 *
 * Phases of the same System share their equations with the one that was made first: sides of
 * switches between two resistances, and signs on surfaces, are inputs of its programs. */
#include "simulate/run/mode_phases.h"

#include "base/memory.h"

#include <string.h>

/* which states of the whole the phase's own are, by name */
static Status find_states(const ActiveRun *r, Phase *phase, Diag *diag)
{
    const VariableIndex *l = phase->layout, *whole = phases_whole(r->phases)->layout;

    phase->among_whole = NEW_ARRAY(int, l->nx);
    /* both are in the order of the parts: where one is, the next is not far */
    for (int i = 0, k = 0; i < l->nx; i++) {
        const char *name = system_x(l->system, i)->name;
        int looked = 0;

        while (looked < whole->nx && strcmp(system_x(whole->system, k)->name, name) != 0) {
            k = (k + 1) % whole->nx;
            looked++;
        }
        if (looked == whole->nx)
            return diag_set(diag, E_MODEL, "%s is no state on the other side of an ideal switch",
                            name);
        phase->among_whole[i] = k;
    }
    return OK;
}

static Status compile_states(ActiveRun *r, Phase *phase, Diag *diag)
{
    const VariableIndex *whole = phases_whole(r->phases)->layout;
    LIST(Expr) roots = {0};
    Status status = OK;

    for (int i = 0; i < whole->nx; i++) {
        Expr state;

        CHECK(system_variable(phase->system, system_x(whole->system, i)->name, 0, &state, diag));
        LIST_PUSH(roots, state);
    }
    for (int i = 0; system_invariant(phase->system, i) != NULL; i++)
        LIST_PUSH(roots, system_invariant(phase->system, i));
    CHECK(probe_new(phase->layout, &r->phases->parameters, roots.at, roots.count, &phase->states,
                    diag));
done:
    LIST_FREE(roots);
    return status;
}

/* Takes a new phase, opened and with its states found among those of the whole; freed where that
 * fails. */
static Status add_phase(ActiveRun *r, const SimulationInput *setting, Phase *phase, Phase **out,
                        Diag *diag)
{
    Status status = OK;

    CHECK(active_run_open_phase(r, phase, setting, diag));
    if (phase->closed != NULL) {
        CHECK(find_states(r, phase, diag));
        CHECK(compile_states(r, phase, diag));
    }
    phases_add(r->phases, phase);
    *out = phase;
    phase = NULL;
done:
    phase_free(phase);
    return status;
}

Status mode_phases_get(ActiveRun *r, const SimulationInput *setting, const bool *closed,
                       Phase **out, Diag *diag)
{
    mem_keep(r);
    int count = system_ideal_count(r->system);
    Phase *phase = NULL;
    System *system;

    *out = phases_find(r->phases, closed, count);
    if (*out != NULL)
        return OK;
    TRY(system_mode(r->system, setting->scene, closed, setting->watch, &system, diag));
    for (int i = 1; i < r->phases->count; i++)
        if (r->phases->at[i]->system == system && r->phases->at[i]->on_count == 0) {
            *out = phase_new_like(r->phases->at[i], closed, count, NULL);
            phases_add(r->phases, *out);
            return OK;
        }
    TRY(phase_new(system, &r->phases->parameters, closed, count, &phase, diag));
    return add_phase(r, setting, phase, out, diag);
}

static bool is_closed(const ActiveRun *r, const Phase *phase, const bool *closed)
{
    const size_t bytes = (size_t)system_ideal_count(r->system) * sizeof(bool);

    if (phase->closed == NULL || closed == NULL)
        return phase->closed == closed;
    return memcmp(phase->closed, closed, bytes) == 0;
}

static bool is_on(const Phase *phase, const OnSurface *on)
{
    for (int i = 0; i < phase->on_count; i++)
        if (!on_surface_is(&phase->on[i], &on[i]))
            return false;
    return true;
}

/* The phase of the same system with these switches, on these sides of these surfaces; NULL: none.
 * *like: one whose equations have the signs of these surfaces as inputs, or NULL. */
static Phase *find_on(const ActiveRun *r, const System *system, const bool *closed,
                      const OnSurface *on, int count, Phase **like)
{
    *like = NULL;
    for (int i = 0; i < r->phases->count; i++) {
        Phase *phase = r->phases->at[i];

        if (phase->motion == NULL || phase->system != system ||
            (phase->closed == NULL) != (closed == NULL) ||
            !variable_index_has_surfaces(phase->layout, on, count))
            continue;
        *like = phase->like;
        if (is_closed(r, phase, closed) && is_on(phase, on))
            return phase;
    }
    return NULL;
}

/* Equations with the signs of these surfaces as inputs; on one side of each. */
static Status new_equations(ActiveRun *r, const SimulationInput *setting, System *system,
                            const bool *closed, const OnSurface *on, int count, Phase **out,
                            Diag *diag)
{
    OnSurface *first = NEW_ARRAY(OnSurface, count);
    Phase *phase;
    Status status = OK;

    for (int i = 0; i < count; i++)
        first[i] = (OnSurface){.surface = on[i].surface, .side = 1};
    CHECK(phase_new_on(system, &r->phases->parameters, closed, system_ideal_count(r->system), first,
                       count, &phase, diag));
    CHECK(add_phase(r, setting, phase, out, diag));
done:
    mem_free(first);
    return status;
}

Status mode_phases_get_on(ActiveRun *r, const SimulationInput *setting, System *system,
                          const bool *closed, const OnSurface *on, int count, Phase **out,
                          Diag *diag)
{
    mem_keep(r);
    Phase *like;

    *out = find_on(r, system, closed, on, count, &like);
    if (*out != NULL)
        return OK;
    if (like == NULL)
        TRY(new_equations(r, setting, system, closed, on, count, &like, diag));
    *out = like;
    if (is_closed(r, like, closed) && is_on(like, on))
        return OK;
    TRY(compiled_slide(like->numbers, on, diag));
    *out = phase_new_like(like, closed, system_ideal_count(r->system), on);
    phases_add(r->phases, *out);
    return OK;
}

Status mode_phases_events(ActiveRun *r, const Phase *now, const Phase *next,
                          const SimulationInput *setting, Events **events, Diag *diag)
{
    mem_keep(r);
    Events **theirs = &next->like->events;

    if (*events == NULL || next->like == now->like)
        return OK;
    if (*theirs == NULL)
        TRY(active_run_events(r, next, NULL, 0, setting, theirs, diag));
    if (*theirs != *events)
        events_hand_over(*theirs, *events);
    *events = *theirs;
    return OK;
}
