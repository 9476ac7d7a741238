/* result.c: rows, and any variable at them */
#include "simulate/result.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

#define TURNED 0.25 /* rad: parts of what lies between two rows, for counting turns */

/* --- life --- */

/* a variable of an earlier result at its first row */
static double warm_value(void *context, const char *name)
{
    Result *warm = context;
    const Layout *l = warm->layout;
    Probe *probe = NULL;
    RowValues row;
    Expr e;
    double value = NAN;

    for (int i = 0; i < l->nx && warm->grid.count > 0; i++)
        if (strcmp(system_x(l->system, i)->name, name) == 0)
            return warm->grid.states[l->n + l->nu + i];

    if (warm->grid.count > 0 && system_variable(warm->system, name, 0, &e, NULL) == OK &&
        probe_new(warm->layout, &warm->parameters, &e, 1, &probe, NULL) == OK &&
        result_row(warm, warm->grid.times[0], warm->grid.states, warm->driven.values, &row))
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

static Status make_motion(Result *r, const Setting *setting, double atol, Diag *diag)
{
    int *independent = NEW_ARRAY(int, setting->independent_count);
    MotionOptions options = {.embedded = setting->form == FORM_EMBEDDED && r->kind == RUN_SIMULATE,
                             .rows = r->start.rows,
                             .row_count = r->start.row_count,
                             .independent = independent,
                             .independent_count = setting->independent_count,
                             .tolerance = atol};
    Status status = OK;

    CHECK(find_independent(r->layout, setting, independent, diag));
    r->motion = motion_new(numbers_equations(r->numbers), &options);
    r->grid.length = motion_length(r->motion);
    r->network = netdae_new(r->layout, &r->parameters, r->motion);
    if (r->network != NULL)
        motion_offer(r->motion, netdae_equations(r->network));
    if (r->start.network != NULL)
        motion_guess(r->motion, r->start.network);
done:
    mem_free(independent);
    return status;
}

static Status prepare(RunKind kind, System *system, const Setting *setting, Result **out,
                      Diag *diag)
{
    Result *r = NEW(Result);
    Status status = OK;

    r->kind = kind;
    r->system = system;
    r->layout = layout_new(system);
    r->parameters = (Parameters){.value = setting->parameter, .context = setting->context};
    r->report.global_error = NAN;
    r->report.singular_time = NAN;
    CHECK(numbers_new(r->layout, &r->parameters, &r->numbers, diag));
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

    if (motion_solve(r->motion, 0, r->start.y, &solved))
        return OK;
    (void)diag_set(diag, E_SINGULAR, "no accelerations can be found at the start");
    diag_hint(diag, "a part that moves freely needs a mass or an inertia; a circuit needs every "
                    "current and voltage determined");
    return E_SINGULAR;
}

Status result_make_events(Result *r, const Events *earlier, const Setting *setting, Events **out,
                          Diag *diag)
{
    const EventsPlan plan = {.layout = r->layout,
                             .parameters = &r->parameters,
                             .equations = numbers_equations(r->numbers),
                             .motion = r->motion,
                             .rows = r->start.rows,
                             .row_count = r->start.row_count,
                             .kind = r->kind,
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

Status result_open(RunKind kind, System *system, const Setting *setting, Result **out, Diag *diag)
{
    const Result *warm = setting->from != NULL ? setting->from : setting->warm;
    Result *r = NULL;
    Status status = OK;

    CHECK(prepare(kind, system, setting, &r, diag));
    CHECK(start_find(r->layout, &r->parameters, r->numbers, setting,
                     warm != NULL ? warm_value : NULL, (void *)warm, &r->start, diag));
    CHECK(make_motion(r, setting, 1e-8, diag));
    text_add(&r->remarks, r->start.remarks.at != NULL ? r->start.remarks.at : "");
    if (kind == RUN_SIMULATE)
        CHECK(check_start(r, diag));
    CHECK(result_make_events(r, NULL, setting, &r->events, diag));
    CHECK(samples_new(r->layout, &r->parameters, r->motion, &r->samples, diag));
    *out = r;
    r = NULL;
done:
    result_free(r);
    return status;
}

Status result_reopen(const Result *old, const Setting *setting, Result **out, Diag *diag)
{
    Result *r = NULL;
    Status status = OK;

    CHECK(prepare(old->kind, old->system, setting, &r, diag));
    r->start.y = NEW_ARRAY(double, old->grid.length);
    r->start.rows = NEW_ARRAY(int, old->layout->m);
    memcpy(r->start.rows, old->start.rows, (size_t)old->layout->m * sizeof(int));
    r->start.row_count = old->start.row_count;
    memcpy(r->start.y, old->grid.states + (ptrdiff_t)(old->grid.count - 1) * old->grid.length,
           (size_t)old->grid.length * sizeof(double));
    CHECK(make_motion(r, setting, 1e-8, diag));
    for (int i = 0; i < old->grid.count; i++)
        grid_add(&r->grid, old->grid.times[i], old->grid.states + (ptrdiff_t)i * old->grid.length);
    CHECK(result_make_events(r, old->events, setting, &r->events, diag));
    CHECK(samples_new(r->layout, &r->parameters, r->motion, &r->samples, diag));
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
    samples_free(r->samples);
    netdae_free(r->network);
    motion_free(r->motion);
    numbers_free(r->numbers);
    parameters_free(&r->parameters);
    start_free(&r->start);
    layout_free(r->layout);
    grid_free(&r->grid);
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
    return r->layout->nu - r->start.row_count;
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

bool result_row(Result *r, double t, const double *y, const double *driven, RowValues *out)
{
    const Layout *l = r->layout;
    Solved solved;

    *out = row_of_state(l, t, y);
    if (driven != NULL) {
        out->rates = driven;
        out->z = driven + l->nx;
        out->acceleration = driven + l->nx + l->nz;
        out->multipliers = out->acceleration + l->nu;
        out->efforts = out->multipliers + l->m;
        return true;
    }
    if (!motion_solve(r->motion, t, y, &solved))
        return false;
    out->rates = solved.rates;
    out->z = solved.algebraic;
    out->acceleration = solved.acceleration;
    out->multipliers = solved.multipliers;
    return true;
}

static const double *driven_row(const Result *r, int row)
{
    return r->driven.values != NULL ? r->driven.values + (ptrdiff_t)row * r->driven.length : NULL;
}

/* a probe for expressions over user's variables */
static Status open_probe(Result *r, const Expr *items, int count, Probe **out, Diag *diag)
{
    Expr *roots = NEW_ARRAY(Expr, count);
    Status status = OK;

    for (int i = 0; i < count; i++)
        CHECK(system_resolve(r->system, items[i], &roots[i], diag));
    CHECK(probe_new(r->layout, &r->parameters, roots, count, out, diag));
done:
    mem_free(roots);
    return status;
}

/* Values of a row; where the equations have no solution, all are NAN. */
static void copy_values(Result *r, Probe *probe, double t, const double *y, const double *driven,
                        int count, double *out)
{
    RowValues row;

    if (result_row(r, t, y, driven, &row))
        memcpy(out, probe_values(probe, &row), (size_t)count * sizeof(double));
    else
        for (int k = 0; k < count; k++)
            out[k] = NAN;
}

Status result_values(Result *r, const Expr *items, int count, double *out, Diag *diag)
{
    Probe *probe = NULL;
    Status status = OK;

    CHECK(open_probe(r, items, count, &probe, diag));
    for (int i = 0; i < r->grid.count; i++)
        copy_values(r, probe, r->grid.times[i], r->grid.states + (ptrdiff_t)i * r->grid.length,
                    driven_row(r, i), count, out + (ptrdiff_t)i * count);
done:
    probe_free(probe);
    return status;
}

/* --- between rows --- */

/* Hermite polynomial of degree 5 through value, rate and second rate at both ends (s in 0..1),
 * and its rate */
static double quintic(const double a[3], const double b[3], double h, double s, double *rate)
{
    double d = b[0] - a[0] - h * a[1] - h * h / 2 * a[2];
    double e = h * (b[1] - a[1]) - h * h * a[2];
    double f = h * h * (b[2] - a[2]);
    double c3 = 10 * d - 4 * e + f / 2, c4 = -15 * d + 7 * e - f, c5 = 6 * d - 3 * e + f / 2;

    *rate = a[1] + s * h * a[2] + s * s * (3 * c3 + s * (4 * c4 + s * 5 * c5)) / h;
    return a[0] + s * h * (a[1] + s * h / 2 * a[2]) + s * s * s * (c3 + s * (c4 + s * c5));
}

static double cubic(double a, double a_rate, double b, double b_rate, double h, double s)
{
    double d = b - a;

    return a + s * d + s * (s - 1) * ((1 - 2 * s) * d + (s - 1) * h * a_rate + s * h * b_rate);
}

/* rates of (q, u, x, work) at a row */
static bool row_rates(Result *r, int row, double *out)
{
    const Layout *l = r->layout;
    const Ode *ode = motion_ode(r->motion);
    const double *y = r->grid.states + (ptrdiff_t)row * r->grid.length;
    const double *driven = driven_row(r, row);

    if (!ode->rate(ode->context, r->grid.times[row], y, out))
        return false;
    if (driven != NULL) {
        memcpy(out + l->n, driven + l->nx + l->nz, (size_t)l->nu * sizeof(double));
        memcpy(out + l->n + l->nu, driven, (size_t)l->nx * sizeof(double));
    }
    return true;
}

static void interpolate(const Result *r, int row, double t, const double *rate_a,
                        const double *rate_b, double *y)
{
    const Layout *l = r->layout;
    const double *a = r->grid.states + (ptrdiff_t)row * r->grid.length;
    const double *b = a + r->grid.length;
    double h = r->grid.times[row + 1] - r->grid.times[row];
    double s = (t - r->grid.times[row]) / h;

    for (int i = 0; i < r->grid.length; i++)
        y[i] = cubic(a[i], rate_a[i], b[i], rate_b[i], h, s);
    if (numbers_equations(r->numbers)->map != NULL)
        return;
    for (int i = 0; i < l->n; i++) { /* q'' is u' */
        const double ends[2][3] = {{a[i], a[l->n + i], rate_a[l->n + i]},
                                   {b[i], b[l->n + i], rate_b[l->n + i]}};

        y[i] = quintic(ends[0], ends[1], h, s, &y[l->n + i]);
    }
}

/* References of angles at t, from those of the row before it: in parts that no angle turns far in.
 * y, from its interpolation, keeps what else it has. */
static void follow_turns(Result *r, int row, double t, const double *rates, double *y)
{
    enum { MOST_PARTS = 1000000 };
    const Layout *l = r->layout;
    const double *next = rates + r->grid.length, *kept = r->grid.states;
    double *there = NEW_ARRAY(double, r->grid.length);
    double from = r->grid.times[row], fastest = 0;
    int first = layout_turned(l), parts;

    for (int k = first; k < first + l->turned; k++)
        fastest = fmax(fastest, fmax(fabs(rates[k]), fabs(next[k])));
    parts = (int)fmin(MOST_PARTS, ceil(fastest * (t - from) / TURNED));
    kept += (ptrdiff_t)row * r->grid.length + first;
    for (int i = 1; i <= parts; i++) {
        double at = from + (t - from) * i / parts;

        interpolate(r, row, at, rates, next, there);
        memcpy(there + first, kept, (size_t)l->turned * sizeof(double));
        equations_turn(numbers_equations(r->numbers), at, there, there + first);
        memcpy(y + first, there + first, (size_t)l->turned * sizeof(double));
        kept = y + first;
    }
    mem_free(there);
}

bool result_between(Result *r, double t, double *y)
{
    const double *times = r->grid.times;
    int count = r->grid.count;
    int row = 0;
    double *rates;
    bool sound;

    if (count == 0 || !(t >= times[0] - 1e-9 * fabs(times[0])) ||
        !(t <= times[count - 1] + 1e-9 * fabs(times[count - 1])))
        return false;
    while (row < count - 1 && times[row + 1] <= t)
        row++;
    if (row == count - 1 || times[row] == t) {
        memcpy(y, r->grid.states + (ptrdiff_t)row * r->grid.length,
               (size_t)r->grid.length * sizeof(double));
        return true;
    }
    rates = NEW_ARRAY(double, 2 * r->grid.length);
    sound = row_rates(r, row, rates) && row_rates(r, row + 1, rates + r->grid.length);
    if (sound) {
        interpolate(r, row, t, rates, rates + r->grid.length, y);
        if (r->layout->turned > 0)
            follow_turns(r, row, t, rates, y);
        sound = motion_project(r->motion, t, y);
    }
    mem_free(rates);
    return sound;
}

Status result_values_at(Result *r, const Expr *items, int count, double at, double *out, Diag *diag)
{
    double *y = NEW_ARRAY(double, r->grid.length);
    double *driven = NULL;
    Probe *probe = NULL;
    int row = 0;
    Status status = OK;

    CHECK(open_probe(r, items, count, &probe, diag));
    if (!result_between(r, at, y)) {
        int rows = r->grid.count;

        status =
            diag_set(diag, E_VALUE,
                     "t = %.6g s is outside the run, which goes from %.6g to "
                     "%.6g s",
                     at, rows > 0 ? r->grid.times[0] : 0, rows > 0 ? r->grid.times[rows - 1] : 0);
        goto done;
    }
    while (row < r->grid.count - 1 && r->grid.times[row + 1] <= at)
        row++;
    if (r->driven.values != NULL) { /* efforts of a driven run, straight between rows */
        int next = row < r->grid.count - 1 ? row + 1 : row;
        double h = r->grid.times[next] - r->grid.times[row];
        double s = h > 0 ? (at - r->grid.times[row]) / h : 0;

        driven = NEW_ARRAY(double, r->driven.length);
        for (int i = 0; i < r->driven.length; i++)
            driven[i] = (1 - s) * driven_row(r, row)[i] + s * driven_row(r, next)[i];
    }
    copy_values(r, probe, at, y, driven, count, out);
done:
    probe_free(probe);
    mem_free(driven);
    mem_free(y);
    return status;
}

/* --- energy --- */

Status result_balance(Result *r, Diag *diag)
{
    Expr energies[2] = {system_kinetic(r->system), system_potential(r->system)};
    Probe *probe = NULL;
    double first = 0, least = INFINITY, largest = -INFINITY;
    Status status = OK;

    CHECK(probe_new(r->layout, &r->parameters, energies, 2, &probe, diag));
    r->report.energy_drift = 0;
    for (int i = 0; i < r->grid.count; i++) {
        const double *y = r->grid.states + (ptrdiff_t)i * r->grid.length;
        double value[2], balance;

        copy_values(r, probe, r->grid.times[i], y, driven_row(r, i), 2, value);
        balance = value[0] + value[1] - y[r->grid.length - 1];
        if (i == 0)
            first = balance;
        r->report.energy_drift = fmax(r->report.energy_drift, fabs(balance - first));
        least = fmin(least, value[0]);
        largest = fmax(largest, value[0]);
    }
    r->report.energy_swing = r->grid.count > 0 ? largest - least : 0;
done:
    probe_free(probe);
    return status;
}
