/* result.c: rows, and any variable at them */
#include "simulate/run/result.h"

#include "base/memory.h"
#include "base/random.h"

#include <math.h>
#include <string.h>

#define UNSOLVED 3   /* times that a value has to be the same */
#define FAR      1e3 /* what isn't known is taken up to this, of either sign */

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

bool result_solve_row(Phase *phase, double t, const double *y, const double *driven, RowValues *out)
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
    mem_keep(r);
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

Status result_make_events(Result *r, const Phase *phase, const Events *earlier,
                          const Setting *setting, Events **out, Diag *diag)
{
    mem_keep(r);
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
    mem_keep(r);
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

    if (result_solve_row(phase, t, y, driven, &row))
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
    mem_keep(r);
    const Items asked = {items, count};

    return ask_rows(r, ask_items, &asked, count, out, diag);
}

void result_add_row(Result *r, double t, const double *y)
{
    mem_keep(r);
    grid_add(&r->grid, t, result_phase_number(r, r->phase), y, r->phase->length);
}

void result_tolerance(Result *r, double tolerance)
{
    mem_keep(r);
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
    mem_keep(r);
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
