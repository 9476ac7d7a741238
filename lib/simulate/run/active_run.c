/* active_run.c: a run as long as it goes, and what it hands over at its end */
#include "simulate/run/active_run.h"

#include "simulate/run/charge_sharing.h"
#include "simulate/run/result_reader_impl.h"

#include <math.h>
#include <string.h>

#define POOL 1024 /* bytes: a chunk of names and times */

/* --- made and freed --- */

ActiveRun *active_run_new(RunKind kind, System *system, const Setting *setting)
{
    ActiveRun *r = NEW(ActiveRun);

    r->kind = kind;
    r->system = system;
    r->result = NEW(Result);
    r->result->kind = kind;
    r->result->system = system;
    r->result->report.global_error = NAN;
    r->result->report.singular_time = NAN;
    r->phases = NEW(Phases);
    r->phases->system = system;
    r->phases->parameters = (Parameters){.value = setting->parameter, .context = setting->context};
    return r;
}

static void free_later(void *object)
{
    active_run_free(object);
}

void active_run_free(ActiveRun *r)
{
    if (r == NULL || mem_frees_later(r, free_later))
        return;
    events_free(r->events);
    mode_search_free(r->mode_search);
    shares_free(r->shares);
    mem_free(r->begin);
    phases_free(r->phases);
    result_free(r->result);
    mem_free(r);
}

/* --- at the end --- */

static Manner manner_of(const ActiveRun *r, const Setting *setting)
{
    return (Manner){.embedded = setting->form == FORM_EMBEDDED && r->kind == RUN_SIMULATE,
                    .independent = setting->independent,
                    .independent_count = setting->independent_count,
                    .rows = r->result->start.rows,
                    .row_count = r->result->start.row_count,
                    .watch = setting->watch};
}

static const char *keep_text(Result *result, const char *text)
{
    return pool_text(result->pool, text, strlen(text));
}

/* the manner, whose names are the setting's, with names of its own */
static void keep_manner(const ActiveRun *r, const Setting *setting)
{
    Result *result = r->result;
    const size_t size = (size_t)setting->independent_count * sizeof(char *);
    const char **names = setting->independent_count > 0 ? pool_alloc(result->pool, size) : NULL;

    for (int i = 0; i < setting->independent_count; i++)
        names[i] = keep_text(result, setting->independent[i]);
    result->manner = manner_of(r, setting);
    result->manner.independent = names;
    result->manner.watch = NULL;
}

static void keep_phases(const ActiveRun *r)
{
    const size_t switches = (size_t)system_ideal_count(r->system) * sizeof(bool);

    for (int i = 0; i < r->phases->count; i++) {
        const Phase *phase = r->phases->at[i];
        PhaseKey key = {.system = phase->system,
                        .on = NEW_ARRAY(OnSurface, phase->on_count),
                        .on_count = phase->on_count,
                        .is_open = phase->motion != NULL};

        for (int k = 0; k < phase->on_count; k++)
            key.on[k] = phase->on[k];
        if (phase->closed != NULL) {
            key.closed = mem_array(switches, 1);
            memcpy(key.closed, phase->closed, switches);
        }
        LIST_PUSH(r->result->phases, key);
    }
}

static void keep_parameters(const ActiveRun *r)
{
    const Parameters *known = &r->phases->parameters;
    Parameters *kept = &r->result->parameters;

    *kept = (Parameters){.value = known->value, .context = known->context};
    for (int i = 0; i < known->count; i++)
        parameters_set(kept, known->symbols[i], known->values[i]);
}

static void keep_events(const ActiveRun *r)
{
    Result *result = r->result;

    for (int i = 0; i < events_count(r->events); i++) {
        EventRecord record = events_record(r->events, i);
        const size_t bytes = (size_t)record.count * sizeof(double);
        double *times = record.count > 0 ? pool_alloc(result->pool, bytes) : NULL;

        if (times != NULL)
            memcpy(times, record.times, bytes);
        record.name = keep_text(result, record.name);
        record.condition = keep_text(result, record.condition);
        record.times = times;
        LIST_PUSH(result->events, record);
    }
}

void active_run_finish(ActiveRun *r, const Setting *setting, Result **out, ResultReader **reader)
{
    Result *result = r->result;

    result->pool = pool_new(POOL);
    keep_manner(r, setting);
    keep_phases(r);
    keep_parameters(r);
    keep_events(r);
    result->first = phases_number(r->phases, r->phase);
    result->freedoms = r->phase->layout->nu - result->start.row_count;
    result->tolerance = r->phases->tolerance;
    *out = result;
    r->result = NULL;
    if (reader != NULL) {
        *reader = result_reader_of_run(result, r->phases);
        r->phases = NULL;
    }
    active_run_free(r);
}

/* --- on its way --- */

Status active_run_open_phase(ActiveRun *r, Phase *phase, const Setting *setting, Diag *diag)
{
    const Manner manner = manner_of(r, setting);

    return phases_open(r->phases, phase, &manner, diag);
}

Status active_run_events(ActiveRun *r, const Phase *phase, const EventRecord *earlier,
                         int earlier_count, const Setting *setting, Events **out, Diag *diag)
{
    mem_keep(r);
    const EventsPlan plan = {.layout = phase->layout,
                             .parameters = &r->phases->parameters,
                             .equations = numbers_equations(phase->numbers),
                             .motion = phase->motion,
                             .rows = r->result->start.rows,
                             .row_count = r->result->start.row_count,
                             .kind = r->kind,
                             .whole = phase->closed != NULL ? r->system : NULL,
                             .events = setting->events,
                             .event_count = setting->event_count};

    *out = NULL;
    if (r->kind == RUN_START || (setting->event_count == 0 && earlier_count == 0))
        return OK;
    TRY(events_new(&plan, out, diag));
    events_go_on(*out, earlier, earlier_count);
    return OK;
}

void active_run_add_row(ActiveRun *r, double t, const double *y)
{
    mem_keep(r->result);
    grid_add(&r->result->grid, t, phases_number(r->phases, r->phase), y, r->phase->length);
}

/* --- energy --- */

static Status ask_energies(Phases *phases, const Phase *phase, const void *context, Probe **out,
                           Diag *diag)
{
    const Expr energies[2] = {system_kinetic(phase->system), system_potential(phase->system)};

    (void)context;
    return probe_new(phase->layout, &phases->parameters, energies, 2, out, diag);
}

Status active_run_balance(ActiveRun *r, Diag *diag)
{
    const Grid *grid = &r->result->grid;
    double *energies = NEW_ARRAY(double, 2 * grid->count);
    double first = 0, drift = 0, least = INFINITY, largest = -INFINITY;
    bool is_known = true;
    Status status = OK;

    CHECK(phases_ask(r->phases, grid, &r->result->driven, phases_number(r->phases, r->phase),
                     ask_energies, NULL, 2, energies, diag));
    for (int i = 0; i < grid->count; i++) {
        const double *value = energies + 2 * (ptrdiff_t)i;
        double work = grid_row(grid, i)[r->phases->at[grid->phase[i]]->length - 1];
        double balance = value[0] + value[1] - work;

        if (i == 0)
            first = balance;
        drift = fmax(drift, fabs(balance - first));
        is_known = is_known && isfinite(balance);
        least = fmin(least, value[0]);
        largest = fmax(largest, value[0]);
    }
    r->result->report.energy_drift = is_known ? drift : (double)NAN;
    r->result->report.energy_swing = grid->count > 0 ? largest - least : 0;
done:
    mem_free(energies);
    return status;
}
