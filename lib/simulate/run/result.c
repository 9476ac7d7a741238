/* result.c: rows, and any variable at them */
#include "simulate/run/result.h"

#include "base/memory.h"
#include "base/random.h"
#include "simulate/equations/causes.h"
#include "simulate/run/commute.h"
#include "simulate/run/share.h"

#include <math.h>
#include <string.h>

#define UNSOLVED 3   /* times that a value has to be the same */
#define FAR      1e3 /* what isn't known is taken up to this, of either sign */

#define START_TOLERANCE 1e-8

/* --- rows --- */

Phase *result_whole(const Result *r)
{
    return r->phases.at[0];
}

int result_phase_number(const Result *r, const Phase *phase)
{
    int number = 0;

    while (r->phases.at[number] != phase)
        number++;
    return number;
}

Phase *result_phase(const Result *r, int row)
{
    return r->phases.at[r->grid.phase[row]];
}

const double *result_driven(const Result *r, int row)
{
    return r->driven.values != NULL ? r->driven.values + (ptrdiff_t)row * r->driven.length : NULL;
}

/* Everything at (t, y); `driven` is the row's block, or NULL to solve. False: no solution. */
static bool find_row(Phase *phase, double t, const double *y, const double *driven, RowValues *out)
{
    const Layout *l = phase->layout;

    if (driven == NULL)
        return phase_row(phase, t, y, out);
    phase_enter(phase);
    *out = row_of_state(l, t, y);
    out->rates = driven;
    out->z = driven + l->nx;
    out->acceleration = driven + l->nx + l->nz;
    out->multipliers = out->acceleration + l->nu;
    out->efforts = out->multipliers + l->m;
    return true;
}

/* --- life --- */

/* a variable of an earlier result at its first row */
static double warm_value(void *context, const char *name)
{
    Result *warm = context;
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
        find_row(result_phase(warm, 0), warm->grid.times[0], grid_row(&warm->grid, 0),
                 result_driven(warm, 0), &row))
        value = probe_values(probe, &row)[0];
    probe_free(probe);
    return value;
}

/* speeds asked for as independent, by the names of their coordinates */
static Status find_independent(const Layout *l, const Setting *setting, int *out, Diag *diag)
{
    for (int i = 0; i < setting->independent_count; i++) {
        out[i] = -1;
        for (int j = 0; j < l->nu; j++) {
            const Variable *u = system_u(l->system, j);
            const char *name = u->derivative_of != NULL ? expr_name(*u->derivative_of) : u->name;

            if (l->n == l->nu) /* u = q' */
                name = system_q(l->system, j)->name;
            if (strcmp(name, setting->independent[i]) == 0)
                out[i] = j;
        }
        if (out[i] < 0) {
            (void)diag_set(diag, E_NAME, "'%s' is no coordinate of these trees",
                           setting->independent[i]);
            diag_hint(diag, "show coordinates lists them");
            return E_NAME;
        }
    }
    return OK;
}

Status result_open_phase(Result *r, Phase *phase, const Setting *setting, Diag *diag)
{
    int *independent = NEW_ARRAY(int, setting->independent_count);
    MotionOptions options = {.watch = setting->watch,
                             .embedded = setting->form == FORM_EMBEDDED && r->kind == RUN_SIMULATE,
                             .rows = r->start.rows,
                             .row_count = r->start.row_count,
                             .independent = independent,
                             .independent_count = setting->independent_count,
                             .tolerance = r->tolerance};
    Status status = OK;

    CHECK(find_independent(phase->layout, setting, independent, diag));
    CHECK(phase_open(phase, &r->parameters, &options, diag));
done:
    mem_free(independent);
    return status;
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
        CHECK(sides_new(sided, &r->parameters, &r->sides, diag));
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

Status result_make_events(Result *r, const Phase *phase, const Events *earlier,
                          const Setting *setting, Events **out, Diag *diag)
{
    const EventsPlan plan = {.layout = phase->layout,
                             .parameters = &r->parameters,
                             .equations = numbers_equations(phase->numbers),
                             .motion = phase->motion,
                             .rows = r->start.rows,
                             .row_count = r->start.row_count,
                             .kind = r->kind,
                             .whole = phase->closed != NULL ? r->system : NULL,
                             .events = setting->events,
                             .event_count = setting->event_count};
    Status status = OK;

    *out = NULL;
    if (r->kind == RUN_START || (setting->event_count == 0 && events_count(earlier) == 0))
        return OK;
    CHECK(events_new(&plan, out, diag));
    events_go_on(*out, earlier);
done:
    return status;
}

Status result_begin(Result *r, const Setting *setting, Diag *diag)
{
    Phase *whole = result_whole(r);
    Status status = OK;

    if (r->sides != NULL)
        return commute_begin(r, setting, diag);
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
    CHECK(start_find(whole->layout, &r->parameters, whole->numbers, setting, r->sides != NULL,
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
            CHECK(commute_phase_on(r, setting, like, like->on, like->on_count, &phase, diag));
        else
            CHECK(commute_phase(r, setting, like->closed, &phase, diag));
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

void result_free(Result *r)
{
    if (r == NULL)
        return;
    events_free(r->events);
    for (int i = 0; i < r->phases.count; i++)
        phase_free(r->phases.at[i]);
    LIST_FREE(r->phases);
    sides_free(r->sides);
    shares_free(r->shares);
    parameters_free(&r->parameters);
    start_free(&r->start);
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

/* --- looking --- */

RunKind result_kind(const Result *r)
{
    return r->kind;
}

System *result_system(const Result *r)
{
    return r->system;
}

const RunReport *result_report(const Result *r)
{
    return &r->report;
}

int result_freedoms(const Result *r)
{
    return r->phase->layout->nu - r->start.row_count;
}

const char *result_remarks(const Result *r)
{
    return r->remarks.at != NULL ? r->remarks.at : "";
}

int result_event_count(const Result *r)
{
    return events_count(r->events);
}

EventRecord result_event(const Result *r, int i)
{
    return events_record(r->events, i);
}

int result_rows(const Result *r)
{
    return r->grid.count;
}

const double *result_times(const Result *r)
{
    return r->grid.times;
}

/* --- values --- */

Status result_probe(Result *r, const Phase *phase, const Expr *items, int count, Probe **out,
                    Diag *diag)
{
    Expr *roots = NEW_ARRAY(Expr, count);
    Status status = OK;

    for (int i = 0; i < count; i++)
        CHECK(system_resolve(phase->system, items[i], &roots[i], diag));
    CHECK(probe_new(phase->layout, &r->parameters, roots, count, out, diag));
done:
    mem_free(roots);
    return status;
}

/* Where the equations have no solution what they would solve for may be anything: values that
 * don't change with it, as those of coordinates, are known all the same. */
static void probe_unsolved(const Phase *phase, Probe *probe, double t, const double *y, int count,
                           double *out)
{
    const Layout *l = phase->layout;
    double *any = NEW_ARRAY(double, l->count);
    RowValues row = row_of_state(l, t, y);
    uint64_t seed = 1;

    row.signs = row.rates = row.z = row.acceleration = row.multipliers = row.efforts = row.jerk =
        any;
    for (int turn = 0; turn < UNSOLVED; turn++) {
        const double *values;

        for (int i = 0; i < l->count; i++)
            any[i] = FAR * random_unit(&seed);
        values = probe_values(probe, &row);
        for (int k = 0; k < count; k++)
            out[k] = turn == 0 || out[k] == values[k] ? values[k] : NAN;
    }
    mem_free(any);
}

void result_probe_at(Phase *phase, Probe *probe, double t, const double *y, const double *driven,
                     int count, double *out)
{
    RowValues row;

    if (find_row(phase, t, y, driven, &row))
        memcpy(out, probe_values(probe, &row), (size_t)count * sizeof(double));
    else
        probe_unsolved(phase, probe, t, y, count, out);
}

/* what is asked at every row, in the equations of its phase */
typedef Status (*Ask)(Result *r, const Phase *phase, const void *context, Probe **out, Diag *diag);

static Status ask_rows(Result *r, Ask ask, const void *context, int count, double *out, Diag *diag)
{
    Probe **probes = NEW_ARRAY(Probe *, r->phases.count);
    Status status = OK;

    if (r->grid.count == 0) /* it may be wrong all the same */
        CHECK(ask(r, r->phase, context, &probes[0], diag));
    for (int i = 0; i < r->grid.count; i++) {
        Phase *phase = result_phase(r, i);
        Probe **probe = &probes[r->grid.phase[i]];

        if (*probe == NULL)
            CHECK(ask(r, phase, context, probe, diag));
        result_probe_at(phase, *probe, r->grid.times[i], grid_row(&r->grid, i), result_driven(r, i),
                        count, out + (ptrdiff_t)i * count);
    }
done:
    for (int i = 0; i < r->phases.count; i++)
        probe_free(probes[i]);
    mem_free(probes);
    return status;
}

typedef struct Items {
    const Expr *at;
    int count;
} Items;

static Status ask_items(Result *r, const Phase *phase, const void *context, Probe **out, Diag *diag)
{
    const Items *items = context;

    return result_probe(r, phase, items->at, items->count, out, diag);
}

Status result_values(Result *r, const Expr *items, int count, double *out, Diag *diag)
{
    const Items asked = {items, count};

    return ask_rows(r, ask_items, &asked, count, out, diag);
}

void result_add_row(Result *r, double t, const double *y)
{
    grid_add(&r->grid, t, result_phase_number(r, r->phase), y, r->phase->length);
}

void result_tolerance(Result *r, double tolerance)
{
    r->tolerance = tolerance;
    for (int i = 0; i < r->phases.count; i++)
        if (r->phases.at[i]->motion != NULL)
            motion_tolerance(r->phases.at[i]->motion, tolerance);
}

/* --- energy --- */

static Status ask_energies(Result *r, const Phase *phase, const void *context, Probe **out,
                           Diag *diag)
{
    const Expr energies[2] = {system_kinetic(phase->system), system_potential(phase->system)};

    (void)context;
    return probe_new(phase->layout, &r->parameters, energies, 2, out, diag);
}

Status result_balance(Result *r, Diag *diag)
{
    double *energies = NEW_ARRAY(double, 2 * r->grid.count);
    double first = 0, least = INFINITY, largest = -INFINITY, drift = 0;
    bool is_known = true;
    Status status = OK;

    CHECK(ask_rows(r, ask_energies, NULL, 2, energies, diag));
    for (int i = 0; i < r->grid.count; i++) {
        const double *value = energies + 2 * (ptrdiff_t)i;
        double work = grid_row(&r->grid, i)[result_phase(r, i)->length - 1];
        double balance = value[0] + value[1] - work;

        if (i == 0)
            first = balance;
        drift = fmax(drift, fabs(balance - first));
        is_known = is_known && isfinite(balance);
        least = fmin(least, value[0]);
        largest = fmax(largest, value[0]);
    }
    r->report.energy_drift = is_known ? drift : (double)NAN;
    r->report.energy_swing = r->grid.count > 0 ? largest - least : 0;
done:
    mem_free(energies);
    return status;
}
