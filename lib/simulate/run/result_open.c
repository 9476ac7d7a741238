/* result_open.c: how a result begins: its phases, its start, and what an earlier one hands on */
#include "simulate/run/result.h"

#include "base/memory.h"
#include "simulate/equations/causes.h"
#include "simulate/run/charge_sharing.h"
#include "simulate/run/mode_switch.h"

#include <math.h>
#include <string.h>

#define START_TOLERANCE 1e-8

/* a variable of an earlier result at its first row */
static double warm_value(void *context, const char *name)
{
    Result *warm = context;

    mem_keep(warm);
    const Phase *phase;
    const Layout *l;
    Probe *probe = NULL;
    RowValues row;
    Expr e;
    double value = NAN;

    if (warm->grid.count == 0)
        return NAN;
    phase = result_phase(warm, 0);
    l = phase->layout;
    for (int i = 0; i < l->nx; i++)
        if (strcmp(system_x(l->system, i)->name, name) == 0)
            return grid_row(&warm->grid, 0)[l->n + l->nu + i];

    if (system_variable(phase->system, name, 0, &e, NULL) == OK &&
        probe_new(l, &warm->parameters, &e, 1, &probe, NULL) == OK &&
        result_solve_row(result_phase(warm, 0), warm->grid.times[0], grid_row(&warm->grid, 0),
                         result_driven(warm, 0), &row))
        value = probe_values(probe, &row)[0];
    probe_free(probe);
    return value;
}

/* What supplies a driver's motion is found in the equations of the whole, as long as no ideal
 * switch is in them. */
static bool goes_through_modes(const Layout *whole)
{
    bool any_ideal = false;

    for (int i = 0; i < system_ideal_count(whole->system); i++)
        any_ideal = any_ideal || system_is_ideal(whole->system, i);
    return system_has_modes(whole->system) && (any_ideal || whole->ne == 0);
}

static Status prepare(RunKind kind, System *system, const Setting *setting, Result **out,
                      Diag *diag)
{
    Result *r = NEW(Result);
    Phase *whole = NULL;
    System *sided;
    Status status = OK;

    r->kind = kind;
    r->system = system;
    r->tolerance = START_TOLERANCE;
    r->parameters = (Parameters){.value = setting->parameter, .context = setting->context};
    r->report.global_error = NAN;
    r->report.singular_time = NAN;
    CHECK(phase_new(system, &r->parameters, NULL, 0, &whole, diag));
    LIST_PUSH(r->phases, whole);
    if (goes_through_modes(whole->layout)) {
        CHECK(system_sided(system, setting->scene, setting->watch, &sided, diag));
        CHECK(mode_search_new(sided, &r->parameters, &r->sides, diag));
    }
    *out = r;
    r = NULL;
done:
    result_free(r);
    return status;
}

/* the start has accelerations at all */
static Status check_start(Result *r, Diag *diag)
{
    Solved solved;

    if (motion_solve(r->phase->motion, 0, r->begin, &solved))
        return OK;
    if (cause_tell(r->phase->layout, &r->parameters, 0, r->begin,
                   "no accelerations can be found at the start", diag))
        return E_SINGULAR;
    (void)diag_set(diag, E_SINGULAR, "no accelerations can be found at the start");
    diag_hint(diag, "a part that moves freely needs a mass or an inertia; a circuit needs every "
                    "current and voltage determined");
    return E_SINGULAR;
}

Status result_begin(Result *r, const Setting *setting, Diag *diag)
{
    mem_keep(r);
    Phase *whole = result_whole(r);
    Status status = OK;

    if (r->sides != NULL)
        return mode_switch_begin(r, setting, diag);
    if (whole->motion == NULL)
        CHECK(result_open_phase(r, whole, setting, diag));
    r->phase = whole;
    mem_free(r->begin);
    r->begin = NEW_ARRAY(double, whole->length);
    memcpy(r->begin, r->start.y, (size_t)whole->length * sizeof(double));
    motion_guess(whole->motion, r->start.network);
done:
    return status;
}

Status result_open(RunKind kind, System *system, const Setting *setting, Result **out, Diag *diag)
{
    const Result *warm = setting->from != NULL ? setting->from : setting->warm;
    const Phase *whole;
    Result *r = NULL;
    Status status = OK;

    CHECK(prepare(kind, system, setting, &r, diag));
    whole = result_whole(r);
    CHECK(initial_find(whole->layout, &r->parameters, whole->numbers, setting, r->sides != NULL,
                       warm != NULL ? warm_value : NULL, (void *)warm, &r->start, diag));
    CHECK(result_begin(r, setting, diag));
    text_add(&r->remarks, r->start.remarks.at != NULL ? r->start.remarks.at : "");
    if (kind == RUN_SIMULATE)
        CHECK(check_start(r, diag));
    CHECK(result_make_events(r, r->phase, NULL, setting, &r->events, diag));
    *out = r;
    r = NULL;
done:
    result_free(r);
    return status;
}

/* the phases of an earlier result, in the same order */
static Status copy_phases(Result *r, const Result *old, const Setting *setting, Diag *diag)
{
    Phase *phase;
    Status status = OK;

    if (r->sides == NULL)
        CHECK(result_open_phase(r, result_whole(r), setting, diag));
    for (int i = 1; i < old->phases.count; i++) {
        const Phase *like = old->phases.at[i];

        if (like->on_count > 0)
            CHECK(mode_switch_phase_on(r, setting, like, like->on, like->on_count, &phase, diag));
        else
            CHECK(mode_switch_phase(r, setting, like->closed, &phase, diag));
    }
done:
    return status;
}

/* sums of angles go on in the turns that the start chose */
static void keep_whole_turns(Result *r, const Result *old)
{
    for (int i = 0; i < system_whole_turns_count(r->system); i++) {
        Expr whole = system_whole_turns(r->system, i)->symbol;
        double value = parameters_value((Parameters *)&old->parameters, whole);

        parameters_set(&r->parameters, whole, value);
        numbers_set(result_whole(r)->numbers, whole, value);
    }
}

Status result_reopen(const Result *old, const Setting *setting, Result **out, Diag *diag)
{
    int last = old->grid.count - 1;
    int m = result_whole(old)->layout->m;
    Result *r = NULL;
    Status status = OK;

    CHECK(prepare(old->kind, old->system, setting, &r, diag));
    keep_whole_turns(r, old);
    r->start.rows = NEW_ARRAY(int, m);
    memcpy(r->start.rows, old->start.rows, (size_t)m * sizeof(int));
    r->start.row_count = old->start.row_count;
    CHECK(copy_phases(r, old, setting, diag));
    grid_append(&r->grid, &old->grid);
    grid_append(&r->corners, &old->corners);
    for (int i = 0; i < old->jumps.count; i++)
        LIST_PUSH(r->jumps, old->jumps.at[i]);
    r->phase = result_phase(r, last);
    r->begin = NEW_ARRAY(double, r->phase->length);
    memcpy(r->begin, grid_row(&r->grid, last), (size_t)r->phase->length * sizeof(double));
    CHECK(result_make_events(r, r->phase, old->events, setting, &r->events, diag));
    *out = r;
    r = NULL;
done:
    result_free(r);
    return status;
}

static void result_free_later(void *object)
{
    result_free(object);
}

void result_free(Result *r)
{
    if (r == NULL || mem_frees_later(r, result_free_later))
        return;
    events_free(r->events);
    for (int i = 0; i < r->phases.count; i++)
        phase_free(r->phases.at[i]);
    LIST_FREE(r->phases);
    mode_search_free(r->sides);
    shares_free(r->shares);
    parameters_free(&r->parameters);
    initial_free(&r->start);
    mem_free(r->begin);
    grid_free(&r->grid);
    grid_free(&r->corners);
    grid_free(&r->asked);
    mem_free(r->asked_driven.values);
    LIST_FREE(r->jumps);
    mem_free(r->driven.values);
    text_free(&r->remarks);
    mem_free(r);
}
