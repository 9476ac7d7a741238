/* sensitivity.c: S along a run, from segment to segment */
#include "simulate/sensitivity/sensitivity_impl.h"

#include "base/memory.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define SAME_INSTANT 1e-13 /* of the run: an instant at a crossing */

/* --- values --- */

/* at (t, unknowns), into the next place */
static void emit(SensitivityPass *pass, double t, const double *unknowns)
{
    const ptrdiff_t stride = (ptrdiff_t)pass->item_count * pass->order->by.count;

    item_slopes_at(pass->slopes, pass->variational, t, unknowns, pass->out + pass->next * stride);
    pass->next++;
}

/* those inside the last step, up to its end */
static Status emit_inside(SensitivityPass *pass, Stepper *stepper, Diag *diag)
{
    const Ode *ode = stepper->ode;
    double *unknowns;
    Status status = OK;

    if (pass->next == pass->time_count || pass->times[pass->next] >= stepper->t)
        return OK;
    unknowns = NEW_ARRAY(double, ode->n);
    while (pass->next < pass->time_count && pass->times[pass->next] < stepper->t) {
        const double t = pass->times[pass->next];

        stepper->method->at(stepper, t, unknowns);
        if (ode->project != NULL && !ode->project(ode->context, t, unknowns))
            CHECK(solver_failure(diag, t, "the constraints can't be met"));
        emit(pass, t, unknowns);
    }
done:
    mem_free(unknowns);
    return status;
}

/* Those at the end of a segment: before a crossing there all but the last of several equal
 * instants, at the end of the run all. */
static void emit_at_end(SensitivityPass *pass, double end, double span, bool is_last)
{
    const double near = SAME_INSTANT * span;

    while (pass->next < pass->time_count && pass->times[pass->next] <= end + near &&
           (is_last ||
            (pass->next + 1 < pass->time_count && pass->times[pass->next + 1] <= end + near)))
        emit(pass, end, pass->unknowns);
}

/* --- integration --- */

static Status refuse_rates(const SensitivityPass *pass, double t, Diag *diag)
{
    double *slopes = NEW_ARRAY(double, variational_ode(pass->variational)->n);
    const Ode *ode = variational_ode(pass->variational);
    const bool sound = ode->rate(ode->context, t, pass->unknowns, slopes);

    mem_free(slopes);
    if (sound)
        return OK;
    (void)diag_set(diag, E_MODEL,
                   "at t = %.6g s: the accelerations have no derivatives by parameters: a singular "
                   "position, or reactions of redundant constraints act on a network",
                   t);
    return E_MODEL;
}

static const Method *method_of(const Result *result)
{
    const Method *method = method_find(result->monitor_report.method);

    if (method != NULL && method->suits_stiff)
        return method_for((MethodNeed){.stiff = true});
    return method_for((MethodNeed){0});
}

/* steps up to `end`, with the values inside */
static Status take_steps(SensitivityPass *pass, const Method *method, double end, double span,
                         bool *is_stiff, Diag *diag)
{
    const RunReport *report = &pass->reader->result->monitor_report;
    const Ode *ode = variational_ode(pass->variational);
    const Control control = {
        .rtol = report->rtol, .atol = report->atol, .most = report->most, .span = span};
    Stepper *stepper = method->create(ode, &control);
    Status status = OK;

    *is_stiff = false;
    CHECK(method->start(stepper, pass->t, pass->unknowns, diag));
    while (end - stepper->t > DBL_EPSILON * fabs(end) && pass->next < pass->time_count) {
        monitor_report(pass->order->watch, "sensitivities", stepper->t / span);
        CHECK(monitor_poll(pass->order->watch));
        CHECK(method->step(stepper, end, diag));
        CHECK(emit_inside(pass, stepper, diag));
        if (stepper->found_stiff && !stepper->is_oscillatory) {
            *is_stiff = true;
            break;
        }
    }
    memcpy(pass->unknowns, stepper->y, (size_t)ode->n * sizeof(double));
    pass->t = *is_stiff ? stepper->t : end;
done:
    method->destroy(stepper);
    return status;
}

static Status integrate_to(SensitivityPass *pass, double end, double span, Diag *diag)
{
    const Method *method = method_of(pass->reader->result);
    bool is_stiff = true;

    TRY(refuse_rates(pass, pass->t, diag));
    while (is_stiff) {
        TRY(take_steps(pass, method, end, span, &is_stiff, diag));
        method = method_for((MethodNeed){.stiff = true});
    }
    return OK;
}

/* --- the run --- */

static Status refuse_start(const SensitivityPass *pass, Diag *diag)
{
    const Phase *whole = phases_whole(pass->reader->phases);
    const VariableIndex *l = pass->phase->layout;

    if (whole->layout->n == l->n && whole->layout->nu == l->nu && whole->layout->nx == l->nx &&
        whole->layout->multi_turns == l->multi_turns)
        return OK;
    (void)diag_set(diag, E_MODEL,
                   "there are no sensitivities where ideal switches change the number of states");
    diag_hint(diag, "Ron= and Roff= give switches and diodes resistances, and one set of states");
    return E_MODEL;
}

static Status refuse_samples(const SensitivityPass *pass, Diag *diag)
{
    if (pass->phase->samples == NULL)
        return OK;
    return diag_set(diag, E_MODEL, "there are no sensitivities of sampled states (period=)");
}

static Status begin(SensitivityPass *pass, Diag *diag)
{
    const Grid *grid = &pass->reader->result->grid;
    const int count = pass->order->by.count;
    int n;

    TRY(sensitivity_open(pass, grid->phase[0], diag));
    TRY(refuse_start(pass, diag));
    TRY(refuse_samples(pass, diag));
    n = variational_states(pass->variational);
    memcpy(pass->unknowns, grid_row(grid, 0), (size_t)n * sizeof(double));
    memcpy(pass->unknowns + n, pass->order->start, (size_t)n * (size_t)count * sizeof(double));
    pass->t = grid->times[0];
    if (!variational_project(pass->variational, pass->t, pass->unknowns))
        return solver_failure(diag, pass->t, "the constraints have no derivatives");
    return OK;
}

static Status follow_run(SensitivityPass *pass, Diag *diag)
{
    const Result *result = pass->reader->result;
    const Crossings *crossings = &result->crossings;
    const double end = result->grid.times[result->grid.count - 1];
    const double span = end - result->grid.times[0];
    double low = -INFINITY;

    TRY(begin(pass, diag));
    for (int i = 0; i <= crossings->list.count && pass->next < pass->time_count; i++) {
        const bool is_last = i == crossings->list.count;
        const Crossing *crossing = is_last ? NULL : &crossings->list.at[i];
        const double until = is_last ? end : crossing->before;

        motion_window(pass->phase->motion, low, is_last ? INFINITY : until);
        TRY(integrate_to(pass, until, span, diag));
        emit_at_end(pass, until, span, is_last);
        if (is_last || pass->next == pass->time_count)
            break;
        TRY(sensitivity_jump(pass, i, diag));
        low = crossing->after;
    }
    return OK;
}

/* --- starts and driven runs --- */

static Status stay_at_start(SensitivityPass *pass, Diag *diag)
{
    TRY(begin(pass, diag));
    while (pass->next < pass->time_count)
        emit(pass, pass->t, pass->unknowns);
    return OK;
}

static Status place_driven(SensitivityPass *pass, double t, Diag *diag)
{
    const double *y = NULL, *driven = NULL;
    Phase *phase = NULL;
    int n;

    TRY(result_reader_at(pass->reader, t, &phase, &y, &driven, diag));
    assert(phase != NULL);
    if (phase != pass->phase || pass->unknowns == NULL)
        TRY(sensitivity_open(pass, phase->number, diag));
    n = variational_states(pass->variational);
    memset(pass->unknowns, 0, (size_t)variational_ode(pass->variational)->n * sizeof(double));
    memcpy(pass->unknowns, y, (size_t)n * sizeof(double));
    if (!variational_project(pass->variational, t, pass->unknowns))
        return solver_failure(diag, t, "the constraints have no derivatives");
    emit(pass, t, pass->unknowns);
    return OK;
}

static Status follow_drivers(SensitivityPass *pass, Diag *diag)
{
    const VariableIndex *l = phases_whole(pass->reader->phases)->layout;

    if (l->nx > 0 || l->multi_turns > 0)
        return diag_set(diag, E_MODEL,
                        "there are no sensitivities of a driven run with states of a network or "
                        "angles of many turns; 'simulate' has them");
    while (pass->next < pass->time_count)
        TRY(place_driven(pass, pass->times[pass->next], diag));
    return OK;
}

/* --- all --- */

int result_reader_start(const ResultReader *reader, const double **y)
{
    const VariableIndex *l = phases_whole(reader->phases)->layout;

    *y = reader->result->start.y;
    return variable_index_references(l) + l->multi_turns;
}

static Status check_times(const Result *result, const double *times, int count, Diag *diag)
{
    const Grid *grid = &result->grid;
    const double first = grid->count > 0 ? grid->times[0] : 0;
    const double last = grid->count > 0 ? grid->times[grid->count - 1] : 0;

    for (int i = 0; i < count; i++)
        if (!(times[i] >= first - 1e-9 * fabs(first) && times[i] <= last + 1e-9 * fabs(last)))
            return diag_set(diag, E_VALUE,
                            "t = %.6g s is outside the run, which goes from %.6g to %.6g s",
                            times[i], first, last);
    return OK;
}

/* NOLINTBEGIN(readability-non-const-parameter): out is written to in each pass */
Status sensitivity_find(ResultReader *reader, const SensitivityOrder *order, const Expr *items,
                        int item_count, const double *times, int time_count, double *out,
                        Diag *diag)
/* NOLINTEND(readability-non-const-parameter) */
{
    const Result *result = reader->result;
    SensitivityPass pass = {.reader = reader,
                            .order = order,
                            .items = items,
                            .item_count = item_count,
                            .times = times,
                            .time_count = time_count,
                            .out = out};
    const bool is_integrated =
        result->monitor_report.method != NULL && method_find(result->monitor_report.method) != NULL;
    Status status = OK;

    mem_keep(reader);
    mem_keep(reader->phases);
    CHECK(check_times(result, times, time_count, diag));
    if (result->kind == RUN_INVERSE)
        CHECK(diag_set(diag, E_MODEL,
                       "there are no sensitivities of 'inverse', but of 'kinematics' and "
                       "'simulate'"));
    if (result->kind == RUN_START)
        CHECK(stay_at_start(&pass, diag));
    else
        CHECK(is_integrated ? follow_run(&pass, diag) : follow_drivers(&pass, diag));
done:
    sensitivity_close(&pass);
    return status;
}
