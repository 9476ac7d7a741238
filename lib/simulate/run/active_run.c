/* active_run.c: a run while it proceeds, and the result that it returns at its end */
#include "simulate/run/active_run.h"

#include "base/random.h"
#include "simulate/run/charge_sharing.h"
#include "simulate/run/result_reader_impl.h"
#include "simulate/run/run_limits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POOL          1024 /* bytes: size of a chunk of names and times */
#define PLACES        16   /* rows at which these are evaluated, */
#define PERTURBATIONS 4    /* with so many perturbations each */

/* --- construction and destruction --- */

ActiveRun *active_run_new(RunKind kind, System *system, const SimulationInput *setting)
{
    ActiveRun *r = NEW(ActiveRun);

    r->kind = kind;
    r->system = system;
    r->result = NEW(Result);
    r->result->kind = kind;
    r->result->system = system;
    r->result->monitor_report.global_error = NAN;
    r->result->monitor_report.singular_time = NAN;
    r->phases = NEW(Phases);
    r->phases->system = system;
    r->phases->parameters = (Parameters){.value = setting->parameter,
                                         .context = setting->context,
                                         .evaluator = setting->evaluator,
                                         .threads = setting->threads};
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
    probe_free(r->energies);
    mem_free(r->begin);
    phases_free(r->phases);
    result_free(r->result);
    mem_free(r);
}

/* --- at the end --- */

static const char *keep_text(Result *result, const char *text)
{
    return pool_text(result->pool, text, strlen(text));
}

static void keep_phases(const ActiveRun *r)
{
    const size_t switches = (size_t)system_ideal_count(r->system) * sizeof(bool);

    for (int i = 0; i < r->phases->count; i++) {
        const Phase *phase = r->phases->at[i];
        PhaseKey key = {.system = phase->system,
                        .on = NEW_ARRAY(OnSurface, phase->on_count),
                        .on_count = phase->on_count};

        for (int k = 0; k < phase->on_count; k++)
            key.on[k] = phase->on[k];
        if (phase->closed != NULL) {
            key.closed = mem_array(switches, 1);
            memcpy(key.closed, phase->closed, switches);
        }
        LIST_PUSH(r->result->phases, key);
    }
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

void active_run_finish(ActiveRun *r, Result **out, ResultReader **reader)
{
    Result *result = r->result;

    result->pool = pool_new(POOL);
    keep_phases(r);
    r->result->parameters = parameters_like(&r->phases->parameters);
    keep_events(r);
    result->first = r->phase->number;
    result->freedoms = r->phase->layout->nu - result->start.row_count;
    *out = result;
    r->result = NULL;
    if (reader != NULL) {
        *reader = result_reader_of_run(result, r->phases);
        r->phases = NULL;
    }
    active_run_free(r);
}

/* --- during the run --- */

Status active_run_open_phase(ActiveRun *r, Phase *phase, const SimulationInput *setting, Diag *diag)
{
    const Manner manner = {.embedded = setting->form == FORM_EMBEDDED && r->kind == RUN_SIMULATE,
                           .independent = setting->independent,
                           .independent_count = setting->independent_count,
                           .rows = r->result->start.rows,
                           .row_count = r->result->start.row_count,
                           .watch = setting->watch,
                           .host = setting->host};

    return phases_open(r->phases, phase, &manner, diag);
}

Status active_run_events(ActiveRun *r, const Phase *phase, const EventRecord *earlier,
                         int earlier_count, const SimulationInput *setting, Events **out,
                         Diag *diag)
{
    mem_keep(r);
    const EventsPlan plan = {.layout = phase->layout,
                             .parameters = &r->phases->parameters,
                             .equations = compiled_equations(phase->numbers),
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
    grid_add(&r->result->grid, t, r->phase->number, y, r->phase->length);
}

/* --- energy --- */

static Status ask_energies(Phases *phases, const Phase *phase, const void *context, Probe **out,
                           Diag *diag)
{
    ActiveRun *r = (ActiveRun *)context;

    if (r->energies != NULL && phase->like == r->energies_of->like) {
        mem_keep(r);
        *out = r->energies;
        r->energies = NULL;
        return OK;
    }
    return probe_new(phase->layout, &phases->parameters,
                     (Expr[]){system_kinetic(phase->system), system_potential(phase->system)}, 2,
                     out, diag);
}

Status active_run_prepare(ActiveRun *r, Diag *diag)
{
    Probe *energies = NULL;
    double values[2]; /* the first evaluation compiles it to machine code */
    Status status = OK;

    CHECK(ask_energies(r->phases, r->phase, r, &energies, diag));
    mem_keep(r);
    r->energies = energies;
    r->energies_of = r->phase;
    phase_probe_at(r->phase, energies, 0, r->begin, NULL, 2, values);
done:
    return status;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* perturbations of row i by the tolerance, with random signs */
static void add_perturbed(const ActiveRun *r, int i, uint64_t *random, Grid *out)
{
    const Grid *grid = &r->result->grid;
    const RunReport *monitor_report = &r->result->monitor_report;
    const Phase *phase = r->phases->at[grid->phase[i]];
    const double *magnitude_bound = compiled_equations(phase->numbers)->magnitude_bound;
    double *y = NEW_ARRAY(double, phase->length);

    for (int turn = 0; turn <= PERTURBATIONS; turn++) {
        memcpy(y, grid_row(grid, i), (size_t)phase->length * sizeof(double));
        for (int k = 0; turn > 0 && k < variable_index_references(phase->layout); k++)
            y[k] += copysign(monitor_report->atol +
                                 monitor_report->rtol * fmin(fabs(y[k]), magnitude_bound[k]),
                             random_unit(random));
        grid_add(out, grid->times[i], grid->phase[i], y, phase->length);
    }
    mem_free(y);
}

/* effect on the energy balance of states with an error of the tolerance: */
typedef struct EnergyErrorFloor {
    double energy, power; /* J, W */
} EnergyErrorFloor;

/* W, power of all that does work; NAN where the equations have no solution */
static double power_at(const ActiveRun *r, const Grid *grid, int i)
{
    const Phase *phase = r->phases->at[grid->phase[i]];
    const Ode *ode = motion_ode(phase->motion);
    double *rate = NEW_ARRAY(double, phase->length);
    double power = NAN;

    phase_enter(phase);
    if (ode->rate(ode->context, grid->times[i], grid_row(grid, i), rate))
        power = rate[phase->length - 1];
    mem_free(rate);
    return power;
}

static double upper_quartile(double *values, int count)
{
    qsort(values, (size_t)count, sizeof values[0], compare);
    return values[3 * count / 4];
}

/* The upper quartile over some of the rows, since a row in a hard wall is exceptional. */
static Status find_energy_error_floor(ActiveRun *r, EnergyErrorFloor *out, Diag *diag)
{
    const int rows = r->result->grid.count, count = rows < PLACES ? rows : PLACES;
    const Driven none = {0};
    double values[PLACES * (1 + PERTURBATIONS)][2], energy[PLACES], power[PLACES];
    uint64_t random = 1;
    Grid perturbed = {0};
    Status status = OK;

    for (int i = 0; i < count; i++)
        add_perturbed(r, (int)((int64_t)rows * i / count), &random, &perturbed);
    CHECK(phases_ask(r->phases, &perturbed, &none, 0, ask_energies, r, 2, values[0], diag));
    for (int i = 0; i < count; i++) {
        const int row = i * (1 + PERTURBATIONS);
        const double(*at)[2] = values + row, there = power_at(r, &perturbed, row);

        energy[i] = power[i] = 0;
        for (int turn = 1; turn <= PERTURBATIONS; turn++) {
            energy[i] = fmax(energy[i], fabs(at[turn][0] - at[0][0] + at[turn][1] - at[0][1]));
            power[i] = fmax(power[i], fabs(power_at(r, &perturbed, row + turn) - there));
        }
    }
    *out = (EnergyErrorFloor){upper_quartile(energy, count), upper_quartile(power, count)};
done:
    grid_free(&perturbed);
    return status;
}

/* largest absolute values over the rows of a run */
typedef struct EnergyBalance {
    double drift;        /* |E - E0 - work| */
    double stored, work; /* the larger of kinetic and potential energy; |work| */
    double time;         /* s, from the first row to the last */
} EnergyBalance;

/* Reports stored energy that no work accounts for, unless the work is inaccurate. Work is
 * inaccurate where large powers cancel, as where a light part is pushed through oil: errors within
 * the tolerance are then more than the stored energy, without an effect on states. Rounding errors
 * of powers that don't depend on states are below the absolute tolerance, in J. */
static Status judge_balance(ActiveRun *r, EnergyBalance balance, Diag *diag)
{
    const RunReport *monitor_report = &r->result->monitor_report;
    const bool is_rounding =
        balance.drift <= monitor_report->atol && balance.work > WORK_ROUNDED * balance.drift;
    EnergyErrorFloor error_floor;

    if (!(balance.drift > ENERGY_OPEN * balance.stored) || is_rounding ||
        !(monitor_report->rtol > 0))
        return OK;
    TRY(find_energy_error_floor(r, &error_floor, diag));
    if (balance.drift >
        ENERGY_ERRORS * error_floor.energy + WORK_ERRORS * error_floor.power * balance.time)
        remarks_add(
            &r->result->remarks,
            (Remark){.kind = REMARK_ENERGY_OPEN, .size = balance.drift, .to = balance.stored});
    return OK;
}

Status active_run_balance(ActiveRun *r, Diag *diag)
{
    const Grid *grid = &r->result->grid;
    double *energies = NEW_ARRAY(double, 2 * grid->count);
    double first = 0, drift = 0, stored = 0, most = 0, time = 0;
    bool is_known = true;
    Status status = OK;

    CHECK(phases_ask(r->phases, grid, &r->result->driven, r->phase->number, ask_energies, r, 2,
                     energies, diag));
    for (int i = 0; i < grid->count; i++) {
        const double *value = energies + 2 * (ptrdiff_t)i;
        const double work = grid_row(grid, i)[r->phases->at[grid->phase[i]]->length - 1];
        const double balance = value[0] + value[1] - work;

        if (i == 0)
            first = balance;
        drift = fmax(drift, fabs(balance - first));
        stored = fmax(stored, fmax(value[0], fabs(value[1])));
        most = fmax(most, fabs(work));
        time = grid->times[i] - grid->times[0];
        is_known = is_known && isfinite(balance);
    }
    r->result->monitor_report.energy_drift = is_known ? drift : (double)NAN;
    r->result->monitor_report.energy_scale = stored;
    if (is_known)
        CHECK(judge_balance(r, (EnergyBalance){drift, stored, most, time}, diag));
done:
    mem_free(energies);
    return status;
}
