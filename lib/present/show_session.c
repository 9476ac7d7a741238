/* show_session.c: parameters, outputs, settings and the last run */
#include "present/show.h"

#include "base/worker_processes.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

Status show_params(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    Table table = table_for("lll");

    (void)selection, (void)diag;
    for (int i = 0; i < model_parameter_count(view->model); i++) {
        Expr definition;
        const Expr symbol = model_parameter(view->model, i, &definition);
        char *text = expr_text(definition);
        Text value = {0};

        view_quantity(view, expr_name(symbol), model_parameter_value(view->model, symbol), 10,
                      &value);
        table_cells(&table, "%s\t= %s\t%s", expr_name(symbol), value.at,
                    expr_is_number(definition) ? "" : text);
        text_free(&value);
        mem_free(text);
    }
    if (table.cells.count == 0)
        text_add(out, "no parameters\n");
    table_finish(out, &table, 0);
    return OK;
}

Status show_outputs(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    EquationList equations = {0};

    (void)selection, (void)diag;
    if (model_output_count(view->model) == 0) {
        view_comment(out, view, "no outputs");
        return OK;
    }
    for (int i = 0; i < model_output_count(view->model); i++) {
        const char *name;
        const Expr e = model_output(view->model, i, &name);

        view_value(&equations, mem_text(name, strlen(name)), e);
    }
    view_block(out, view, &equations);
    return OK;
}

/* what the number of jobs means where nobody has set it, too */
static void add_processes(const Model *model, Text *out)
{
    const int available = worker_processes_available();

    if (model_settings(model)->is_given[SETTING_JOBS])
        text_add(out, "  (threads of a run, processes that share many runs)");
    else
        text_addf(out, "  (threads of a run; many runs share %d process%s)",
                  available < MOST_WORKERS ? available : MOST_WORKERS, available == 1 ? "" : "es");
}

Status show_settings(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const char *const *independent;
    int count;
    const Form form = model_form(view->model, &independent, &count);
    const Expr *gravity = model_gravity(view->model);
    Table table = table_for("ll");
    Text text = {0};

    (void)selection, (void)diag;
    table_cells(&table, "scene\t%s", model_is_planar(view->model) ? "planar" : "spatial");
    for (int i = 0; i < (model_is_planar(view->model) ? 2 : 3); i++) {
        char *component = expr_text(gravity[i]);

        layout_item(&text, component);
        mem_free(component);
    }
    table_cells(&table, "gravity\t[%s]", text.at);
    text_free(&text);
    for (int i = 0; i < count; i++)
        layout_item(&text, independent[i]);
    table_cells(&table, "form\t%s%s%s", form == FORM_EMBEDDED ? "embedded" : "augmented",
                form == FORM_EMBEDDED ? ", independent " : "",
                form != FORM_EMBEDDED ? ""
                : count > 0           ? text.at
                                      : "chosen by pivoting");
    text_free(&text);
    for (ModelSetting i = 0; i < MODEL_SETTINGS; i++) {
        table_cell(&table, model_setting((int)i)[0]);
        model_setting_text(view->model, i, &text);
        if (i == SETTING_JOBS)
            add_processes(view->model, &text);
        table_cell(&table, text.at);
        text_free(&text);
    }
    table_finish(out, &table, 0);
    return OK;
}

/* --- the last run --- */

static const char *kind_name(RunKind kind)
{
    static const char *const names[] = {
        [RUN_START] = "assemble",
        [RUN_SIMULATE] = "simulate",
        [RUN_KINEMATICS] = "kinematics",
        [RUN_INVERSE] = "inverse",
    };
    return names[kind];
}

static void add_work(Table *table, const RunReport *monitor_report)
{
    if (monitor_report->steps > 0)
        table_cells(table, "steps\t%" PRId64 " (%" PRId64 " rejected)", monitor_report->steps,
                    monitor_report->rejected);
    if (monitor_report->evaluations > 0)
        table_cells(table, "evaluations\t%" PRId64, monitor_report->evaluations);
    if (monitor_report->factorisations > 0)
        table_cells(table, "factorisations\t%" PRId64, monitor_report->factorisations);
    if (monitor_report->regularised > 0)
        table_cells(table, "near singular\t%" PRId64 " factorisations, first at t = %.6g s",
                    monitor_report->regularised, monitor_report->singular_time);
}

/* whether a relative energy drift can be shown: drift and scale are both known */
static bool reports_energy(const RunReport *monitor_report)
{
    return monitor_report->energy_scale > 0 && isfinite(monitor_report->energy_scale) &&
           !isnan(monitor_report->energy_drift);
}

/* of check=on, if requested; else empty */
static void write_error(Text *out, const RunReport *monitor_report)
{
    if (!isnan(monitor_report->global_error))
        text_addf(out, "%.2g", monitor_report->global_error);
    else if (monitor_report->is_unresolved)
        text_add(out, "not resolved");
}

static void add_quality(Table *table, const RunReport *monitor_report)
{
    Text error = {0};

    table_cells(table, "position residual\t%.2g", monitor_report->position_residual);
    table_cells(table, "velocity residual\t%.2g", monitor_report->velocity_residual);
    if (reports_energy(monitor_report))
        table_cells(table, "energy drift\t%.2g J of %.3g J", monitor_report->energy_drift,
                    monitor_report->energy_scale);
    write_error(&error, monitor_report);
    if (error.length > 0)
        table_cells(table, "global error\t%s", error.at);
    text_free(&error);
}

/* the user's settings of steps */
static void add_step(Table *table, const RunReport *monitor_report)
{
    if (monitor_report->step > 0)
        table_cells(table, "step\t%.3g s", monitor_report->step);
    if (monitor_report->most > 0)
        table_cells(table, "largest step\t%.3g s", monitor_report->most);
}

/* how well it followed the clock in real time */
static void add_pace(Table *table, const Pace *pace)
{
    if (!(pace->step > 0))
        return;
    if (pace->late == 0)
        table_cells(table,
                    "real time\tkept; the worst step took %.2g %% of its %.3g s, at t = %.6g s",
                    100 * pace->worst, pace->step, pace->worst_at);
    else
        table_cells(table,
                    "real time\t%" PRId64
                    " steps took longer than they are, %.2g times at t = %.6g s; "
                    "behind the clock by %.2g s at most",
                    pace->late, pace->worst, pace->worst_at, pace->delay);
}

void report_print(Text *out, const Result *result, const char *name)
{
    const RunReport *monitor_report = result_report(result);
    const double *times = result_times(result);
    const int rows = result_rows(result);
    Table table = table_for("ll");

    table_cells(&table, "%s\t%s%s%s%s", name, kind_name(result_kind(result)),
                monitor_report->method != NULL ? ", " : "",
                monitor_report->method != NULL ? monitor_report->method : "",
                monitor_report->stopped ? ", stopped" : "");
    if (rows > 1)
        table_cells(&table, "time\t%.6g ... %.6g s, %d rows", times[0], times[rows - 1], rows);
    else
        table_cells(&table, "time\t%.6g s", rows > 0 ? times[0] : 0.0);
    if (result_kind(result) == RUN_SIMULATE) {
        table_cells(&table, "tolerances\trtol %.3g, atol %.3g", monitor_report->rtol,
                    monitor_report->atol);
        add_step(&table, monitor_report);
        add_pace(&table, &monitor_report->pace);
    }
    add_work(&table, monitor_report);
    add_quality(&table, monitor_report);
    table_finish(out, &table, 0);
}

void report_line(Text *out, const Result *result, const char *name)
{
    const RunReport *monitor_report = result_report(result);
    const double *times = result_times(result);
    const int rows = result_rows(result);
    Text error = {0};

    text_addf(out, "%s: ", name);
    if (rows > 1)
        text_addf(out, "%.6g ... %.6g s, %d rows", times[0], times[rows - 1], rows);
    else
        text_add(out, "its start only");
    if (result_kind(result) == RUN_SIMULATE)
        text_addf(out, "; %lld step%s, %lld evaluations", (long long)monitor_report->steps,
                  monitor_report->steps == 1 ? "" : "s", (long long)monitor_report->evaluations);
    if (reports_energy(monitor_report))
        text_addf(out, "; energy drift %.2g J of %.3g J", monitor_report->energy_drift,
                  monitor_report->energy_scale);
    write_error(&error, monitor_report);
    if (error.length > 0)
        text_addf(out, "; global error %s", error.at);
    text_free(&error);
    text_char(out, '\n');
}

Status show_run(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    (void)selection;
    if (view->result == NULL)
        return show_without_run(diag);
    report_print(out, view->result, "run");
    TRY(report_friction(view, out, diag));
    remarks_write(result_remarks(view->result), out);
    return OK;
}

Status show_runs(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    Table table = table_for("lllrlr");

    (void)selection, (void)diag;
    if (view->run_count == 0) {
        view_comment(out, view, "no run yet: 'simulate 10' makes one");
        return OK;
    }
    table_cells(&table, "run\twhat\ttime\trows\tmethod\tsteps");
    for (int i = 0; i < view->run_count; i++) {
        const Result *result = view->run(view->session, i);
        const RunReport *monitor_report = result_report(result);
        const double *times = result_times(result);
        const int rows = result_rows(result);

        table_cells(
            &table, "run%d\t%s\t%.6g ... %.6g s%s\t%d\t%s\t%" PRId64, i + 1,
            kind_name(result_kind(result)), rows > 0 ? times[0] : 0, rows > 0 ? times[rows - 1] : 0,
            monitor_report->stopped ? ", stopped" : "", rows,
            monitor_report->steps > 0 && monitor_report->method != NULL ? monitor_report->method
                                                                        : "",
            monitor_report->steps);
    }
    table_finish(out, &table, 0);
    return OK;
}

Status show_init(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    (void)selection, (void)diag;
    if (model_start_count(view->model) == 0)
        view_comment(out, view, "nothing was given: what is free starts at 0");
    for (int i = 0; i < model_start_count(view->model); i++) {
        const Start *start = model_start(view->model, i);

        text_addf(out, "%s %s%.*s = ", start->is_guess ? "guess" : "init", start->name,
                  start->primes, "'''''''''");
        view_add(out, view, start->value);
        text_char(out, '\n');
    }
    return OK;
}

/* --- events --- */

void event_print(Text *out, const Event *event)
{
    static const char *const actions[] = {
        [EVENT_MARK] = "marks", [EVENT_STOP] = "stops the run", [EVENT_SET] = ""};

    text_add(out, actions[event->action]);
    for (int i = 0; i < event->value_count; i++) {
        const NewValue *value = &event->values[i];

        text_addf(out, "%s%s%.*s = ", i > 0 ? ", " : "", value->name, value->primes, "'''''''''");
        expr_print(out, value->value, NOTATION_TEXT);
    }
}

/* "3 times: 0.45 1.17 1.75 s" */
static void print_times(Text *out, const EventRecord *record)
{
    if (record->count == 0)
        text_add(out, record->from_start ? "not again: held at the start" : "not at all");
    else if (record->count > 1)
        text_addf(out, "%d times: ", record->count);
    for (int i = 0; i < record->count; i++)
        text_addf(out, "%s%.12g", i > 0 ? " " : "", record->times[i]);
    if (record->count > 0)
        text_addf(out, " s%s", record->ended ? ", which ended the run" : "");
}

/* events of the model, and what ended the run as one */
static bool is_computed(const EventRecord *record)
{
    return record->count > 0 || !record->is_bound;
}

Status show_events(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const int count = model_event_count(view->model);
    const int all = view->result != NULL ? result_event_count(view->result) : 0;
    Table table = table_for("lll");
    int past = 0;

    (void)selection, (void)diag;
    for (int i = 0; i < count; i++) {
        const Event *event = model_event(view->model, i);
        Text action = {0};

        event_print(&action, event);
        table_cell(&table, event->name);
        table_cell(&table, event->condition);
        table_cell(&table, action.at);
        text_free(&action);
    }
    table_finish(out, &table, 0);
    for (int i = 0; i < all; i++) {
        const EventRecord record = result_event(view->result, i);

        past += is_computed(&record);
    }
    if (count + past == 0)
        text_add(out, "no events\n");
    if (past > 0)
        text_add(out, "in the last run:\n");
    for (int i = 0; i < all; i++) {
        const EventRecord record = result_event(view->result, i);
        Text lead = {0}, times = {0};

        if (!is_computed(&record))
            continue;
        print_times(&times, &record);
        text_addf(&lead, "  %s  ", record.name);
        layout_words(out, view->page.columns, lead.at, times.at);
        text_free(&lead);
        text_free(&times);
    }
    return OK;
}
