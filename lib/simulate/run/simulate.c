/* simulate.c: runs: forward, resumed, driven */
#include "simulate/run/run.h"

#include "base/clock.h"
#include "base/memory.h"
#include "simulate/equations/failure_diagnosis.h"
#include "simulate/run/begin.h"
#include "simulate/run/charge_sharing.h"
#include "simulate/run/forward.h"
#include "simulate/run/global_error.h"
#include "simulate/run/inverse.h"
#include "simulate/run/pace.h"
#include "simulate/run/run_limits.h"
#include "simulate/run/sliding.h"

#include <math.h>
#include <string.h>

#define AUTO "auto"

const char *run_method(int i, const char **brief)
{
    const Method *method = method_row(i - 1);

    if (i == 0) {
        *brief =
            "dop853, and once the equations turn out to be stiff radau, or ida on large networks "
            "and where a coil's current alone determines the voltage of a diode";
        return AUTO;
    }
    if (method == NULL)
        return NULL;
    *brief = method->brief;
    return method->name;
}

/* --- options --- */

static Status find_method(const char *name, const Method **out, Diag *diag)
{
    Suggest suggest = suggest_for(name != NULL ? name : AUTO);
    const char *brief;

    *out = NULL;
    if (name == NULL || strcmp(name, AUTO) == 0)
        return OK;
    *out = method_find(name);
    if (*out != NULL)
        return OK;
    for (int i = 0; run_method(i, &brief) != NULL; i++)
        suggest_offer(&suggest, run_method(i, &brief));
    (void)diag_set(diag, E_NAME, "there is no method '%s'", name);
    if (suggest.best != NULL)
        diag_hint(diag, "did you mean '%s'? 'help methods' lists them", suggest.best);
    else
        diag_hint(diag, "'help methods' lists them");
    return E_NAME;
}

Status run_method_find(const char *name, const char **out, Diag *diag)
{
    const Method *method;

    TRY(find_method(name, &method, diag));
    *out = method != NULL ? method->name : AUTO;
    return OK;
}

/* between rounding error and a tolerance so loose that the result is meaningless */
static Status check_rtol(double rtol, Diag *diag)
{
    if (rtol >= RUN_LEAST_RTOL && rtol < 1)
        return OK;
    if (rtol < RUN_LEAST_RTOL)
        (void)diag_set(diag, E_VALUE, "rtol=%g is finer than numbers are", rtol);
    else
        (void)diag_set(diag, E_VALUE, "rtol=%g permits an error as large as the value itself",
                       rtol);
    diag_hint(diag, rtol < RUN_LEAST_RTOL ? "1e-12 is about the finest that makes sense"
                                          : "1e-3 is about the coarsest that makes sense");
    diag_about(diag, "rtol");
    return E_VALUE;
}

/* the options with their defaults in place */
static Status complete_options(const ActiveRun *r, const RunOptions *given, RunOptions *out,
                               Diag *diag)
{
    const VariableIndex *layout = r->phase->layout;
    const int width = 2 + layout->n + layout->nu + layout->nx;

    *out = *given;
    if (!(out->duration > 0) || !isfinite(out->duration))
        return diag_set(diag, E_VALUE, "a run takes a duration above 0, in seconds");
    if (!(out->every >= 0) || !(out->rtol >= 0) || !(out->atol >= 0) || !(out->step >= 0) ||
        !(out->most >= 0))
        return diag_set(diag, E_VALUE, "every, rtol, atol, step and maxstep can't be below 0");
    if (out->every == 0)
        out->every = out->duration / 500;
    if (out->rtol == 0)
        out->rtol = out->default_rtol > 0 ? out->default_rtol : DEFAULT_RTOL;
    if (out->atol == 0)
        out->atol = out->rtol;
    TRY(check_rtol(out->rtol, diag));
    if (out->duration / out->every > fmin(RESULT_MOST_ROWS, RESULT_MOST_VALUES / width)) {
        (void)diag_set(diag, E_VALUE, "that makes %.3g rows", out->duration / out->every);
        diag_hint(diag, "take a larger step of output, every=");
        diag_about(diag, "every");
        return E_VALUE;
    }
    return OK;
}

/* --- forward --- */

/* Only steps of known cost can run in real time: fixed ones, of the first such method unless the
 * user names another. */
static Status method_in_time(const RunOptions *options, const Method **method, Diag *diag)
{
    Text names = {0};

    if (!options->realtime || (*method != NULL && (*method)->has_fixed_step))
        return OK;
    if (*method == NULL) {
        *method = method_for((MethodNeed){.fixed = true});
        return OK;
    }
    for (int i = 0; method_row(i) != NULL; i++)
        if (method_row(i)->has_fixed_step)
            text_addf(&names, "%s%s", names.length > 0 ? " or " : "", method_row(i)->name);
    (void)diag_set(diag, E_VALUE, "%s chooses its steps, and can't keep up with the clock",
                   (*method)->name);
    diag_hint(diag, "method=%s, whose steps are fixed", names.at);
    diag_about(diag, "method");
    text_free(&names);
    return E_VALUE;
}

static MotionCounts counts_of(const ActiveRun *r)
{
    MotionCounts sum = {.singular_time = NAN};

    for (int i = 0; i < r->phases->count; i++) {
        MotionCounts counts = {.singular_time = NAN};

        if (r->phases->at[i]->motion != NULL && r->phases->at[i]->like == r->phases->at[i])
            counts = motion_counts(r->phases->at[i]->motion);
        sum.factorisations += counts.factorisations;
        sum.regularised += counts.regularised;
        if (!(sum.singular_time <= counts.singular_time) && !isnan(counts.singular_time))
            sum.singular_time = counts.singular_time;
    }
    return sum;
}

static void fill_report(ActiveRun *r, const IntegrationReport *integration,
                        const RunOptions *options, bool stopped, double began)
{
    MotionCounts counts = counts_of(r);

    r->result->monitor_report.method = integration->method->name;
    r->result->monitor_report.rtol = options->rtol;
    r->result->monitor_report.atol = options->atol;
    r->result->monitor_report.steps = integration->counts.steps;
    r->result->monitor_report.rejected = integration->counts.rejected;
    r->result->monitor_report.evaluations = integration->counts.evaluations;
    r->result->monitor_report.jacobians = integration->counts.jacobians;
    r->result->monitor_report.visits = integration->counts.visits;
    r->result->monitor_report.factorisations = counts.factorisations;
    r->result->monitor_report.regularised = counts.regularised;
    r->result->monitor_report.singular_time = counts.singular_time;
    r->result->monitor_report.position_residual = integration->position_residual;
    r->result->monitor_report.velocity_residual = integration->velocity_residual;
    r->result->monitor_report.reached = integration->reached;
    r->result->monitor_report.every = options->every;
    r->result->monitor_report.step = options->step;
    r->result->monitor_report.most = options->most;
    r->result->monitor_report.stopped = stopped;
    r->result->monitor_report.wall = clock_now() - began;
}

/* the loss of accuracy there is not known: a run with check=on measures it */
static void remark_singular(ActiveRun *r)
{
    const MotionCounts counts = counts_of(r);

    if (counts.regularised > 0)
        remarks_add(&r->result->remarks,
                    (Remark){.kind = REMARK_NEAR_SINGULAR, .t = counts.singular_time});
}

static void remark_integration(ActiveRun *r, const IntegrationReport *integration)
{
    remarks_append(&r->result->remarks, &integration->remarks);
    charge_sharing_report(r);
    events_remark(r->events, &r->result->remarks);
    remark_singular(r);
}

/* Integrate a run whose start is set; the rows so far are stored also when it ends early. */
static Status go(ActiveRun *r, const SimulationInput *setting, const RunOptions *given, double from,
                 bool skip_first, Diag *diag)
{
    const Method *method;
    RunOptions options;
    IntegrationPlan plan;
    IntegrationReport report_of = {.method = method_for((MethodNeed){0})};
    ErrorEvents again = {0};
    Pace pace = {0};
    int first = skip_first ? r->result->grid.count - 1 : 0;
    Status status = OK;
    double began = clock_now();

    CHECK(complete_options(r, given, &options, diag));
    CHECK(find_method(options.method, &method, diag));
    CHECK(method_in_time(&options, &method, diag));
    monitor_report(setting->watch, "compiling", -1);
    CHECK(active_run_prepare(r, diag));
    CHECK(samples_check(r->phase->samples, options.duration, diag));
    phases_tolerance(r->phases, options.atol);
    plan = forward_plan(r, setting, &options, method, r->events);
    plan.asks = given->rtol > 0 || given->atol > 0;
    plan.from = from;
    plan.to = from + options.duration;
    plan.skip_first = skip_first;
    plan.crossings = &r->result->crossings;
    if (setting->host != NULL && setting->host->row != NULL) {
        CHECK(forward_probe_seen(r, r->phase, setting->host, diag));
        plan.see = forward_show_row;
    }
    if (options.check)
        CHECK(global_error_events(r, setting, &again, diag));
    if (options.realtime) {
        pace = pace_begin(options.step > 0 ? options.step : options.every, from);
        plan.pace = &pace;
    }
    status = forward_integrate(r, setting, &plan, &r->result->grid, &r->result->corners, &report_of,
                               diag);
    if (report_of.events != r->events)
        events_hand_over(r->events, report_of.events);
    if (status == E_SOLVER)
        network_hint(r->system, diag);
    remark_integration(r, &report_of);
    remarks_free(&report_of.remarks);
    for (int i = 0; i < report_of.jumps.count; i++)
        LIST_PUSH(r->result->jumps, report_of.jumps.at[i]);
    LIST_FREE(report_of.jumps);
    fill_report(r, &report_of, &options, status == E_STOPPED, began);
    r->result->monitor_report.pace = pace;
    if (status == OK && options.check)
        status = global_error_estimate(r, setting, &options, method, &again, first, diag);
    if (active_run_balance(r, NULL) != OK)
        r->result->monitor_report.energy_drift = NAN;
    r->result->monitor_report.wall = clock_now() - began;
done:
    global_error_events_free(&again);
    return status;
}

Status run_assemble(System *system, const SimulationInput *setting, Result **out,
                    ResultReader **reader, Diag *diag)
{
    ActiveRun *r = NULL;
    RunReport *monitor_report;
    Status status = OK;

    CHECK(run_open(RUN_START, system, setting, &r, diag));
    monitor_report = &r->result->monitor_report;
    CHECK(slide_begin(r, setting, 0, r->begin, diag));
    active_run_add_row(r, 0, r->begin);
    motion_residuals(r->phase->motion, 0, r->begin, &monitor_report->position_residual,
                     &monitor_report->velocity_residual);
    if (monitor_poll(setting->watch) != OK)
        CHECK(diag_set(diag, E_STOPPED, "stopped at the start"));
    active_run_finish(r, out, reader);
    r = NULL;
done:
    active_run_free(r);
    return status;
}

/* return the result, unless it is empty */
static void give(ActiveRun *r, Status status, Result **out, ResultReader **reader)
{
    const bool kept = r != NULL && r->result->grid.count > 0 &&
                      (status == OK || status == E_STOPPED || status == E_SOLVER);

    *out = NULL;
    if (reader != NULL)
        *reader = NULL;
    if (kept)
        r->result->monitor_report.stopped = status == E_STOPPED;
    if (kept)
        active_run_finish(r, out, reader);
    else
        active_run_free(r);
}

Status run_simulate(System *system, const SimulationInput *setting, const RunOptions *options,
                    Result **out, ResultReader **reader, Diag *diag)
{
    ActiveRun *r = NULL;
    Status status = OK;

    CHECK(run_open(RUN_SIMULATE, system, setting, &r, diag));
    CHECK(phase_refuse_by(r->phase, diag));
    CHECK(go(r, setting, options, 0, false, diag));
done:
    give(r, status, out, reader);
    return status;
}

Status run_resume(const Result *old, const SimulationInput *setting, const RunOptions *options,
                  Result **out, ResultReader **reader, Diag *diag)
{
    ActiveRun *r = NULL;
    Status status = OK;

    if (old->kind != RUN_SIMULATE || old->grid.count == 0) {
        give(NULL, E_MISSING, out, reader);
        return diag_set(diag, E_MISSING, "only a forward run can be resumed");
    }
    CHECK(run_reopen(old, setting, &r, diag));
    CHECK(go(r, setting, options, old->grid.times[old->grid.count - 1], true, diag));
done:
    give(r, status, out, reader);
    return status;
}

/* --- driven --- */

static Status check_driven(const ActiveRun *r, Diag *diag)
{
    int left = r->phase->layout->nu - r->result->start.row_count;

    if (left == 0)
        return OK;
    (void)diag_set(diag, E_MODEL, "%d freedom%s left that no driver moves", left,
                   left == 1 ? " is" : "s are");
    diag_hint(diag, "add a driver for each, or use `simulate`");
    return E_MODEL;
}

/* The next row from the last one: predicted, then projected; in two halves where that fails. */
static bool reach(ActiveRun *r, double from, double to, double *y, int depth)
{
    const VariableIndex *l = r->phase->layout;
    const Ode *ode = motion_ode(r->phase->motion);
    double h = to - from;
    double *trial = NEW_ARRAY(double, r->phase->length);
    double *rate = NEW_ARRAY(double, r->phase->length);
    double moved = 0, turned = 0;
    /* where everything is prescribed there is only one branch, whatever the initial guess */
    const bool has_branches =
        compiled_equations(r->phase->numbers)->prescribed == NULL || l->multi_turns > 0;
    bool sound = !has_branches || ode->rate(ode->context, from, y, rate);

    for (int i = 0; i < l->n; i++) {
        double bend = compiled_equations(r->phase->numbers)->map == NULL ? rate[l->n + i] : 0;

        trial[i] = y[i] + h * rate[i] + h * h / 2 * bend;
    }
    for (int i = l->n; i < r->phase->length; i++)
        trial[i] = y[i];
    for (int i = variable_index_references(l); i < variable_index_references(l) + l->multi_turns;
         i++) {
        trial[i] = y[i] + h * rate[i];
        turned = fmax(turned, fabs(h * rate[i]));
    }
    memcpy(rate, trial, (size_t)r->phase->length * sizeof(double));
    sound = sound && motion_project(r->phase->motion, to, trial);
    for (int i = 0; i < l->n && has_branches; i++)
        moved = fmax(moved, fabs(trial[i] - rate[i]));
    for (int i = variable_index_references(l); i < variable_index_references(l) + l->multi_turns;
         i++)
        turned = fmax(turned, DRIVEN_TURN / DRIVEN_MISSED * fabs(trial[i] - rate[i]));
    /* far from the prediction it may be another branch */
    sound = sound && moved < 0.1 && turned < DRIVEN_TURN;
    if (sound) {
        memcpy(y, trial, (size_t)r->phase->length * sizeof(double));
        (void)motion_renew(r->phase->motion, to, y);
    }
    MEM_FREE(trial, rate);
    if (sound || depth == 0)
        return sound;
    return reach(r, from, from + h / 2, y, depth - 1) && reach(r, from + h / 2, to, y, depth - 1);
}

/* If the motion is already undetermined at its start, report the cause. */
static bool is_determined_at_start(ActiveRun *r, const double *y)
{
    Solved solved;

    return motion_solve(r->phase->motion, 0, y, &solved);
}

static void add_position(ActiveRun *r, double t, const double *y)
{
    double position = 0, velocity = 0;

    motion_residuals(r->phase->motion, t, y, &position, &velocity);
    r->result->monitor_report.position_residual =
        fmax(r->result->monitor_report.position_residual, position);
    r->result->monitor_report.velocity_residual =
        fmax(r->result->monitor_report.velocity_residual, velocity);
    active_run_add_row(r, t, y);
    r->result->monitor_report.reached = t;
}

static Status lost(ActiveRun *r, double last, double t, const double *y, Diag *diag)
{
    if (failure_meeting(r->phase->layout, &r->phases->parameters, last, y,
                        "nothing determines how it moves on", diag))
        return E_SINGULAR;
    return solver_failure(diag, t, "the drivers lead where the parts can't follow");
}

/* Between two instants, at the later of which events are due: the first such instant, by bisection;
 * y changes from that at the earlier one to that at it. */
static double locate_event(ActiveRun *r, double low, double high, double *y)
{
    double *trial = NEW_ARRAY(double, r->phase->length);
    double *found = NEW_ARRAY(double, r->phase->length);
    size_t bytes = (size_t)r->phase->length * sizeof(double);

    memcpy(found, y, bytes);
    if (!reach(r, low, high, found, 12))
        memcpy(found, y, bytes);
    for (;;) {
        double middle = low + (high - low) / 2;

        memcpy(trial, y, bytes);
        if (middle <= low || middle >= high || !reach(r, low, middle, trial, 12))
            break;
        if (events_are_due(r->events, middle, trial)) {
            high = middle;
            memcpy(found, trial, bytes);
        } else {
            low = middle;
            memcpy(y, trial, bytes);
        }
    }
    memcpy(y, found, bytes);
    MEM_FREE(trial, found);
    return high;
}

/* Events between two rows, checked at points between; y changes from that of the earlier row to
 * that of the later one, or to that at an event which ends the run. */
static Status follow_events(ActiveRun *r, double from, double to, double span, double *y,
                            bool *stop, Diag *diag)
{
    double *trial = NEW_ARRAY(double, r->phase->length);
    size_t bytes = (size_t)r->phase->length * sizeof(double);
    double last = from;
    Status status = OK;

    for (int k = 1; k <= DRIVEN_POINTS && !*stop;) {
        double t = k == DRIVEN_POINTS ? to : from + (to - from) * k / DRIVEN_POINTS;
        bool happened = false;

        memcpy(trial, y, bytes);
        if (!reach(r, last, t, trial, 12))
            CHECK(lost(r, last, t, y, diag));
        if (events_are_due(r->events, t, trial)) {
            t = locate_event(r, last, t, y);
        } else {
            memcpy(y, trial, bytes);
            k++;
        }
        CHECK(events_read(r->events, t, span, y, &happened, stop, diag));
        if (happened)
            add_position(r, t, y);
        last = t;
    }
done:
    mem_free(trial);
    return status;
}

static Status positions(ActiveRun *r, const SimulationInput *setting, const RunOptions *options,
                        Diag *diag)
{
    int rows = grid_rows(0, options->duration, options->every);
    double *y = NEW_ARRAY(double, r->phase->length);
    double last = 0;
    bool stop = false;
    Status status = OK;

    memcpy(y, r->begin, (size_t)r->phase->length * sizeof(double));
    if (!motion_project(r->phase->motion, 0, y))
        CHECK(solver_failure(diag, 0, "the start does not meet the constraints"));
    if (!is_determined_at_start(r, y))
        CHECK(lost(r, 0, 0, y, diag));
    transaction_stop_asking(); /* there will be rows to be stored */
    for (int k = 0; k <= rows && !stop; k++) {
        double t = k > 0 ? grid_time(0, options->duration, options->every, rows, k) : 0;

        if (monitor_poll(setting->watch) != OK)
            CHECK(diag_set(diag, E_STOPPED, "stopped at t = %.6g s", last));
        monitor_report(setting->watch, "kinematics", t / options->duration);
        if (k > 0 && events_count(r->events) > 0)
            CHECK(follow_events(r, last, t, options->duration, y, &stop, diag));
        else if (k > 0 && !reach(r, last, t, y, 12))
            CHECK(lost(r, last, t, y, diag));
        if (!stop &&
            (k == 0 || r->result->monitor_report.reached < t)) /* otherwise at an event's instant */
            add_position(r, t, y);
        if (k == 0 && events_count(r->events) > 0)
            stop = events_begin(r->events, 0, y);
        last = t;
    }
done:
    mem_free(y);
    events_remark(r->events, &r->result->remarks);
    remark_singular(r);
    r->result->monitor_report.regularised = counts_of(r).regularised;
    r->result->monitor_report.singular_time = counts_of(r).singular_time;
    r->result->monitor_report.every = options->every;
    r->result->monitor_report.method = "newton";
    r->result->monitor_report.steps = r->result->grid.count;
    return status;
}

/* refuse options that only an integration uses */
static Status refuse_idle(const RunOptions *given, Diag *diag)
{
    const struct {
        const char *key;
        bool given;
    } idle[] = {{"rtol", given->rtol > 0},         {"atol", given->atol > 0},
                {"method", given->method != NULL}, {"step", given->step > 0},
                {"maxstep", given->most > 0},      {"check", given->check}};

    for (int i = 0; i < COUNT(idle); i++)
        if (idle[i].given) {
            (void)diag_set(diag, E_VALUE, "%s= has nothing to act on: here nothing is integrated",
                           idle[i].key);
            diag_hint(diag, "the drivers give the motion, and the constraints are solved at each "
                            "instant as exactly as numbers allow; every= sets the instants");
            diag_about(diag, "%s", idle[i].key);
            return E_VALUE;
        }
    return OK;
}

/* Positions follow from the drivers. States of a network that the motion doesn't determine are
 * integrated along; with velocity rows, which depend on the way to a position, so is all of it. */
static Status drive(ActiveRun *r, const SimulationInput *setting, const RunOptions *given,
                    Diag *diag)
{
    RunOptions options;
    double began = clock_now();
    Status status = OK;

    CHECK(complete_options(r, given, &options, diag));
    CHECK(check_driven(r, diag));
    phases_tolerance(r->phases, 1e-12);
    if (r->phase->layout->ne > 0 && r->mode_search != NULL) {
        status = diag_set(diag, E_MODEL,
                          "what supplies a driver's motion can't be found through "
                          "ideal switches");
        diag_hint(diag, "give diodes and switches Ron= and Roff=");
        goto done;
    }
    if (r->mode_search != NULL || r->phase->layout->position_rows < r->phase->layout->m ||
        (r->phase->layout->nx > 0 && !inverse_finds_states(r->system))) {
        options.rtol = fmin(options.rtol, 1e-10);
        options.atol = fmin(options.atol, 1e-10);
        CHECK(go(r, setting, &options, 0, false, diag));
    } else {
        CHECK(refuse_idle(given, diag));
        CHECK(positions(r, setting, &options, diag));
    }
done:
    r->result->monitor_report.wall = clock_now() - began;
    return status;
}

Status run_kinematics(System *system, const SimulationInput *setting, const RunOptions *options,
                      Result **out, ResultReader **reader, Diag *diag)
{
    ActiveRun *r = NULL;
    Status status = OK;

    CHECK(run_open(RUN_KINEMATICS, system, setting, &r, diag));
    CHECK(phase_refuse_open(r->phase, diag));
    CHECK(drive(r, setting, options, diag));
done:
    give(r, status, out, reader);
    return status;
}

Status run_inverse(System *system, const SimulationInput *setting, const RunOptions *options,
                   Result **out, ResultReader **reader, Diag *diag)
{
    ActiveRun *r = NULL;
    Status status = OK;
    Status driven;
    Grid *rows;

    CHECK(run_open(RUN_INVERSE, system, setting, &r, diag));
    rows = &r->result->grid;
    CHECK(phase_refuse_open(r->phase, diag));
    driven = drive(r, setting, options, diag);
    if (driven != OK && driven != E_STOPPED && driven != E_SOLVER)
        CHECK(driven);
    /* the rows up to a stop are still completed */
    status = inverse_solve(r->phases, &r->result->start, rows, driven == OK ? setting->watch : NULL,
                           &r->result->driven, diag);
    if (status == E_STOPPED && rows->count > 0)
        r->result->monitor_report.reached = rows->times[rows->count - 1];
    CHECK(status);
    status = driven;
done:
    give(r, status, out, reader);
    return status;
}
