/* global_error.c: the global error of a run at its rows, from finer runs */
#include "simulate/run/global_error.h"

#include "base/memory.h"
#include "simulate/run/forward.h"
#include "simulate/run/run_limits.h"

#include <math.h>

/* --- events --- */

static Status copy_events(ActiveRun *r, const SimulationInput *setting, Events **out, Diag *diag)
{
    LIST(EventRecord) records = {0};
    Status status;

    for (int i = 0; i < events_count(r->events); i++)
        LIST_PUSH(records, events_record(r->events, i));
    status = active_run_events(r, r->phase, records.at, records.count, setting, out, diag);
    LIST_FREE(records);
    return status;
}

Status global_error_events(ActiveRun *r, const SimulationInput *setting, ErrorEvents *out,
                           Diag *diag)
{
    Status status = OK;

    for (int i = 0; i < COUNT(out->at) && status == OK; i++)
        status = copy_events(r, setting, &out->at[i], diag);
    return status;
}

void global_error_events_free(ErrorEvents *events)
{
    for (int i = 0; i < COUNT(events->at); i++)
        events_free(events->at[i]);
}

/* --- finer runs --- */

/* The largest difference of (q, u, x) at times that both grids contain, of the first one from row
 * `first` on. Rows of events are at times of their own, and a row at a switch may belong to either
 * phase. */
static double largest_difference(const ActiveRun *r, const Grid *a, int first, const Grid *b)
{
    double largest = 0;

    for (int i = first, j = 0; i < a->count && j < b->count;) {
        double delay = a->times[i] - b->times[j];
        int length = delay == 0 && a->phase[i] == b->phase[j]
                         ? variable_index_references(r->phases->at[a->phase[i]]->layout)
                         : 0;

        for (int k = 0; k < length; k++)
            largest = fmax(largest, fabs(grid_row(a, i)[k] - grid_row(b, j)[k]));
        i += delay <= 0;
        j += delay >= 0;
    }
    return largest;
}

/* a run that is closer to the exact motion than the one in question */
typedef struct FinerRun {
    Grid grid;
    const Method *method; /* that it used at its end */
} FinerRun;

/* Whether the errors of a method decrease with the tolerance: with fixed steps they don't, and with
 * a multistep method they hardly do. */
static bool answers_to_tolerance(const Method *method)
{
    return method == NULL || (!method->has_history && !method->has_fixed_step);
}

/* Options of the first finer run, of the second, which is finer, and so on: a fraction of the
 * tolerance. Other limits of the `steps` of a run by the same method (0: by another) are halved
 * too, or the finer run might take the same steps. Returns whether there are such options. */
static bool finer_options(const RunOptions *options, int64_t steps, int which, RunOptions *out)
{
    const double part = pow(FINER_RUN_TOLERANCE, which), mean = options->duration / (double)steps;

    *out = *options;
    out->rtol = fmax(RUN_LEAST_RTOL, options->rtol / part);
    out->atol = options->atol / part;
    if (steps > 0 && !(options->most > 0 && options->most < mean))
        out->most = mean / pow(2, which);
    return which == 1 || options->rtol >= RUN_LEAST_RTOL * part;
}

/* `events` have the states of its start; the caller frees the grid, also when it fails */
static Status run_finer(ActiveRun *r, const SimulationInput *setting, const RunOptions *options,
                        const Method *method, Events *events, double from, FinerRun *out,
                        Diag *diag)
{
    IntegrationPlan plan = forward_plan(r, setting, options, method, events);
    IntegrationReport integration_report = {.method = method_for((MethodNeed){0})};
    Status status;

    plan.from = from;
    plan.to = from + options->duration;
    status = forward_integrate(r, setting, &plan, &out->grid, NULL, &integration_report, diag);
    out->method = integration_report.method;
    remarks_free(&integration_report.remarks);
    LIST_FREE(integration_report.jumps);
    return status;
}

/* the largest number that the comparison of two runs contains */
static double largest_number(const ActiveRun *r, const Grid *grid)
{
    double largest = 0;

    for (int i = 0; i < grid->count; i++)
        for (int k = 0; k < variable_index_references(r->phases->at[grid->phase[i]]->layout); k++)
            largest = fmax(largest, fabs(grid_row(grid, i)[k]));
    return largest;
}

/* Whether a run at this distance from a finer one may be closer to the exact motion than that. */
static bool may_be_nearer(const ActiveRun *r, double off, const RunOptions *finer, const Grid *fine)
{
    return off < FINER_RUN_ERROR * (finer->atol + finer->rtol * largest_number(r, fine));
}

/* report the error: `by` is the finer run, `why` the failure of a finer run (NULL: none failed) */
static void report_global_error(ActiveRun *r, double off, bool is_bounded, bool is_fixed,
                                const FinerRun *by, const char *why)
{
    r->result->monitor_report.is_unresolved = !is_bounded;
    if (is_bounded)
        r->result->monitor_report.global_error =
            off * (by->method->has_history ? MULTISTEP_ERROR : ONE_STEP_ERROR);
    if (!(off <= DIFFERENT_MOTION))
        remarks_add(&r->result->remarks,
                    (Remark){.kind = is_bounded ? REMARK_FAR_OFF : REMARK_UNRESOLVED,
                             .what = is_fixed ? "step" : "rtol",
                             .more = why,
                             .size = off});
}

Status global_error_estimate(ActiveRun *r, const SimulationInput *setting,
                             const RunOptions *options, const Method *method, ErrorEvents *events,
                             int first, Diag *diag)
{
    const Grid *rows = &r->result->grid;
    const bool is_fixed = method != NULL && method->has_fixed_step;
    const Method *finer_method = answers_to_tolerance(method) ? method : NULL;
    const int64_t steps = finer_method == method ? r->result->monitor_report.steps : 0;
    RunOptions coarse = *options, finer;
    FinerRun runs[COUNT(events->at)] = {0};
    double off = INFINITY;
    bool is_bounded = false, is_doubtful = true;
    Diag why = {0};
    Status status = OK;

    if (is_fixed) { /* these have no meaning for it */
        coarse.rtol = fmin(coarse.rtol, FIXED_STEP_REFERENCE);
        coarse.atol = fmin(coarse.atol, FIXED_STEP_REFERENCE);
        coarse.step = 0;
    }
    for (int i = 0; i < COUNT(runs) && is_doubtful; i++) {
        if (!finer_options(&coarse, steps, i + 1, &finer))
            break;
        status = run_finer(r, setting, &finer, finer_method, events->at[i], rows->times[first],
                           &runs[i], &why);
        if (status != OK)
            break;
        off = largest_difference(r, rows, first, &runs[i].grid);
        is_bounded =
            off <= DIFFERENT_MOTION ||
            (i > 0 &&
             SURE_ERROR * largest_difference(r, &runs[i - 1].grid, 0, &runs[i].grid) <= off);
        is_doubtful = !is_bounded || may_be_nearer(r, off, &finer, &runs[i].grid);
    }
    if (status == OK || status == E_SOLVER)
        report_global_error(r, off, is_bounded, is_fixed, &runs[0],
                            status == OK ? NULL : why.message);
    else if (diag != NULL)
        *diag = why;
    for (int i = 0; i < COUNT(runs); i++)
        grid_free(&runs[i].grid);
    return status == E_SOLVER ? OK : status;
}
