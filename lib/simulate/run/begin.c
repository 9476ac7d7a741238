/* begin.c: start of a run: its phases, its initial state, and data of an earlier result */
#include "simulate/run/begin.h"

#include "base/memory.h"
#include "simulate/equations/failure_diagnosis.h"
#include "simulate/run/mode_phases.h"
#include "simulate/run/mode_start.h"
#include "simulate/run/result_reader_impl.h"
#include "simulate/run/run_limits.h"

#include <math.h>
#include <string.h>

/* The source of a driver's motion is searched in the equations of the whole model; this works as
 * long as they contain no ideal switch. */
static bool goes_through_modes(const VariableIndex *whole)
{
    bool any_ideal = false;

    for (int i = 0; i < system_ideal_count(whole->system); i++)
        any_ideal = any_ideal || system_is_ideal(whole->system, i);
    return system_has_modes(whole->system) && (any_ideal || whole->ne == 0);
}

static Status prepare(RunKind kind, System *system, const SimulationInput *setting, ActiveRun **out,
                      Diag *diag)
{
    ActiveRun *r = active_run_new(kind, system, setting);
    Phase *whole = NULL;
    System *sided;
    Status status = OK;

    r->phases->tolerance = START_TOLERANCE;
    monitor_report(setting->watch, "compiling", -1);
    CHECK(phase_new(system, &r->phases->parameters, NULL, 0, &whole, diag));
    phases_add(r->phases, whole);
    if (goes_through_modes(whole->layout)) {
        CHECK(system_sided(system, setting->scene, setting->watch, &sided, diag));
        CHECK(mode_search_new(sided, &r->phases->parameters, &r->mode_search, diag));
    }
    *out = r;
    r = NULL;
done:
    active_run_free(r);
    return status;
}

/* check that the initial state has accelerations, or the network a solution */
static Status check_start(ActiveRun *r, Diag *diag)
{
    const bool is_network = motion_ode(r->phase->motion)->is_network;
    const char *what = is_network ? "the network has no solution at the start"
                                  : "no accelerations can be found at the start";
    Solved solved;

    if (motion_solve(r->phase->motion, 0, r->begin, &solved))
        return OK;
    if (failure_diagnose(r->phase->layout, &r->phases->parameters, 0, r->begin, what, diag))
        return E_SINGULAR;
    (void)diag_set(diag, E_SINGULAR, "%s", what);
    if (system_hint_locking(r->phase->system, diag))
        return E_SINGULAR;
    diag_hint(diag, is_network ? "a circuit needs every current and voltage determined"
                               : "a part that moves freely needs a mass or an inertia; a circuit "
                                 "needs every current and voltage determined");
    return E_SINGULAR;
}

Status run_begin(ActiveRun *r, const SimulationInput *setting, Diag *diag)
{
    mem_keep(r);
    Phase *whole = phases_whole(r->phases);

    if (r->mode_search != NULL)
        return mode_start(r, setting, diag);
    if (whole->motion == NULL)
        TRY(active_run_open_phase(r, whole, setting, diag));
    r->phase = whole;
    mem_free(r->begin);
    r->begin = NEW_ARRAY(double, whole->length);
    memcpy(r->begin, r->result->start.y, (size_t)whole->length * sizeof(double));
    motion_guess(whole->motion, r->result->start.network);
    return OK;
}

Status run_open(RunKind kind, System *system, const SimulationInput *setting, ActiveRun **out,
                Diag *diag)
{
    const Phase *whole;
    ActiveRun *r = NULL;
    Status status = OK;

    CHECK(prepare(kind, system, setting, &r, diag));
    whole = phases_whole(r->phases);
    CHECK(initial_find(whole->layout, &r->phases->parameters, whole->numbers, setting,
                       r->mode_search != NULL, &r->result->start, diag));
    CHECK(run_begin(r, setting, diag));
    remarks_append(&r->result->remarks, &r->result->start.remarks);
    if (kind == RUN_SIMULATE)
        CHECK(check_start(r, diag));
    CHECK(active_run_events(r, r->phase, NULL, 0, setting, &r->events, diag));
    *out = r;
    r = NULL;
done:
    active_run_free(r);
    return status;
}

/* the phases of an earlier result, in the same order */
static Status copy_phases(ActiveRun *r, const Result *old, const SimulationInput *setting,
                          Diag *diag)
{
    Phase *phase;

    if (r->mode_search == NULL)
        TRY(active_run_open_phase(r, phases_whole(r->phases), setting, diag));
    for (int i = 1; i < old->phases.count; i++) {
        const PhaseKey *like = &old->phases.at[i];

        if (like->on_count > 0)
            TRY(mode_phases_get_on(r, setting, like->system, like->closed, like->on, like->on_count,
                                   &phase, diag));
        else
            TRY(mode_phases_get(r, setting, like->closed, &phase, diag));
    }
    return OK;
}

/* whole turns of sums of angles are those of the earlier start */
static void keep_whole_turns(ActiveRun *r, const Result *old)
{
    for (int i = 0; i < system_whole_turns_count(r->system); i++) {
        Expr whole = system_whole_turns(r->system, i)->symbol;
        double value;

        if (!parameters_kept(&old->parameters, whole, &value))
            continue;
        parameters_set(&r->phases->parameters, whole, value);
        compiled_set(phases_whole(r->phases)->numbers, whole, value);
    }
}

Status run_reopen(const Result *old, const SimulationInput *setting, ActiveRun **out, Diag *diag)
{
    int last = old->grid.count - 1;
    ActiveRun *r = NULL;
    Status status = OK;

    CHECK(prepare(old->kind, old->system, setting, &r, diag));
    keep_whole_turns(r, old);
    r->result->start.rows = NEW_ARRAY(int, old->start.row_count);
    memcpy(r->result->start.rows, old->start.rows, (size_t)old->start.row_count * sizeof(int));
    r->result->start.row_count = old->start.row_count;
    CHECK(copy_phases(r, old, setting, diag));
    grid_append(&r->result->grid, &old->grid);
    grid_append(&r->result->corners, &old->corners);
    crossings_append(&r->result->crossings, &old->crossings);
    for (int i = 0; i < old->jumps.count; i++)
        LIST_PUSH(r->result->jumps, old->jumps.at[i]);
    r->phase = r->phases->at[old->grid.phase[last]];
    r->begin = NEW_ARRAY(double, r->phase->length);
    memcpy(r->begin, grid_row(&r->result->grid, last), (size_t)r->phase->length * sizeof(double));
    CHECK(active_run_events(r, r->phase, old->events.at, old->events.count, setting, &r->events,
                            diag));
    *out = r;
    r = NULL;
done:
    active_run_free(r);
    return status;
}
