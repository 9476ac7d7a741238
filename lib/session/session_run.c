/* session_run.c: simulate, kinematics, inverse, resume, assemble, and their reports */
#include "session/session_impl.h"

#include "present/show.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- options --- */

static Status number_of(ct_session *session, const Syntax *syntax, const char *unit,
                        const char *what, double *out, Diag *diag)
{
    Status status;
    Expr e;
    double value;

    CHECK(model_expression(session->model, syntax, &e, diag));
    CHECK(model_check_unit(session->model, syntax, unit, what, diag));
    if ((expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) != 0) {
        diag_at(diag, E_VALUE, syntax->place, "%s must be a number, or made of parameters", what);
        return E_VALUE;
    }
    value = model_number(session->model, e);
    if (!isfinite(value) || value <= 0)
        return diag_at(diag, E_VALUE, syntax->place, "%s must be positive, not %g", what, value);
    *out = value;
done:
    return status;
}

static Status method_of(const Syntax *syntax, const char **out, Diag *diag)
{
    const Status status = run_method_find(syntax->text, out, diag);

    if (status != OK && diag != NULL)
        diag->place = syntax->place;
    return status;
}

static Status switch_of(const Syntax *syntax, const char *key, bool *out, Diag *diag)
{
    if (strcmp(syntax->text, "on") != 0 && strcmp(syntax->text, "off") != 0)
        return diag_at(diag, E_VALUE, syntax->place, "%s is on or off", key);
    *out = strcmp(syntax->text, "on") == 0;
    return OK;
}

static Status read_options(ct_session *session, const Statement *s, RunOptions *out, Diag *diag)
{
    RunOptions options = {.default_rtol = session->run_rtol};
    const struct {
        const char *key;
        const char *unit; /* atol applies to lengths, voltages ... equally, each in SI */
        double *value;
    } numbers[] = {{"every", "s", &options.every},
                   {"rtol", "1", &options.rtol},
                   {"atol", "1", &options.atol},
                   {"step", "s", &options.step},
                   {"maxstep", "s", &options.most}};
    Status status;

    if (s->operands.count != 1) {
        diag_at(diag, E_SYNTAX, s->verb_place, "'%s' needs a time", s->verb);
        diag_hint(diag, "%s 10 every=0.01", s->verb);
        return E_SYNTAX;
    }
    CHECK(number_of(session, s->operands.at[0].value, "s", "the time of a run", &options.duration,
                    diag));
    for (int i = 0; i < s->pairs.count; i++) {
        const Pair *pair = s->pairs.at + i;

        for (int k = 0; k < COUNT(numbers); k++)
            if (strcmp(pair->name, numbers[k].key) == 0)
                CHECK(number_of(session, pair->value, numbers[k].unit, pair->name, numbers[k].value,
                                diag));
        if (strcmp(pair->name, "method") == 0)
            CHECK(method_of(pair->value, &options.method, diag));
        if (strcmp(pair->name, "check") == 0)
            CHECK(switch_of(pair->value, "check", &options.check, diag));
        if (strcmp(pair->name, "realtime") == 0)
            CHECK(switch_of(pair->value, "realtime", &options.realtime, diag));
    }
    *out = options;
done:
    return status;
}

/* --- the verbs --- */

typedef Status RunFunction(System *system, const SimulationInput *setting,
                           const RunOptions *options, Result **out, ResultReader **reader,
                           Diag *diag);

/* turns that came near a critical angle, by part and angle */
static void remark_critical(ct_session *session, ResultReader *reader)
{
    const Result *result = result_reader_result(reader);
    int rows = result_rows(result);
    double *values = NEW_ARRAY(double, rows);
    Critical critical;

    for (int i = 0; system_critical(result_system(result), i, &critical); i++) {
        int worst = 0;
        Text line = {0};
        Diag diag = {0};

        if (rows == 0 || result_reader_values(reader, &critical.measure, 1, values, &diag) != OK)
            continue;
        for (int r = 1; r < rows; r++)
            if (fabs(values[r]) < fabs(values[worst]))
                worst = r;
        if (!(fabs(values[worst]) < CRITICAL_NEAR))
            continue;
        text_addf(
            &line, "the turns of %s are singular at %s = %s, which it came near at t = %.6g s",
            critical.instance, critical.coordinate, critical.angles, result_times(result)[worst]);
        text_addf(&line, "; %s", critical.remedy);
        session_remark(session, line.at);
        text_free(&line);
    }
    mem_free(values);
}

/* Make it the last run, and report its summary. */
static void keep_run(ct_session *session, RunInput *input, Result *result, ResultReader *reader)
{
    Text line = {0};
    char name[32];

    LIST_PUSH(session->runs, run_input_done(input, result, reader));
    session_note_freedoms(session, result);
    session->start_is_later = false;
    session->changed = false;
    session_remark_result(session, result);
    remark_critical(session, reader);
    (void)snprintf(name, sizeof name, "run%d", session->runs.count);
    report_line(&line, result, name);
    session_remark(session, line.at);
    text_free(&line);
}

typedef LIST(Expr) Rests;

static bool has_rest(const Rests *rests, Expr when)
{
    for (int i = 0; i < rests->count; i++)
        if (rests->at[i] == when)
            return true;
    return false;
}

/* Adds the conditions of events that happened ever faster, for another run to hold their guards.
 * False: there are no further ones. */
static bool add_rests(const Model *model, const Result *result, Rests *rests)
{
    const int before = rests->count;

    for (int e = 0; result != NULL && e < result_event_count(result); e++) {
        const EventRecord record = result_event(result, e);

        for (int i = 0; i < model_event_count(model) && record.accumulates; i++) {
            const Event *event = model_event(model, i);

            if (strcmp(event->name, record.name) == 0 &&
                strcmp(event->condition, record.condition) == 0 && !has_rest(rests, event->when))
                LIST_PUSH(*rests, event->when);
        }
    }
    return rests->count > before;
}

/* A run whose events happened ever faster is taken again from its start, with equations that hold
 * their guards. Not where it has been seen by others. */
static bool takes_again(const RunOptions *options, const Host *host, Status status)
{
    return status == E_SOLVER && host == NULL && !options->realtime;
}

static Status run_new(ct_session *session, const RunOptions *options, RunFunction *function,
                      const Host *host, Diag *diag)
{
    RunInput input = {0};
    Result *result = NULL;
    ResultReader *reader = NULL;
    Rests rests = {0};
    System *system;
    Status status;

    session->reporter = NULL;
    if (graph_edge_count(model_graph(session->model)) == 0) {
        (void)diag_set(diag, E_MODEL, "the model is empty: there is nothing to run");
        diag_hint(diag, "body m1 mass=1 and capacitor C1 a 0 1 are parts; 'help' lists them all");
        return E_MODEL;
    }
    do {
        result_reader_free(reader);
        result_free(result);
        run_input_free(&input);
        input = (RunInput){0};
        result = NULL;
        reader = NULL;
        CHECK(session_resting(session, rests.at, rests.count, &system, diag));
        run_input_make(session, system, &input);
        run_input_host(&input, host, NULL);
        CHECK(session_check_freedoms(session, system, &input.setting, diag));
        if (function == run_simulate)
            watch_bounds(system, NULL, &input);
        status = function(system, &input.setting, options, &result, &reader, diag);
    } while (takes_again(options, host, status) && add_rests(session->model, result, &rests));
    if (result == NULL)
        goto done;
    status = check_bounds(&input, reader, status, diag);
    /* also what was computed before a stop or a failure */
    keep_run(session, &input, result, reader);
done:
    run_input_free(&input);
    LIST_FREE(rests);
    return status;
}

/* options that aren't repeated are those of the continued run */
static RunOptions options_from(const Result *old, const RunOptions *said)
{
    const RunReport *monitor_report = result_report(old);
    RunOptions options = *said;

    if (options.rtol == 0)
        options.rtol = monitor_report->rtol;
    if (options.atol == 0)
        options.atol = monitor_report->atol;
    if (options.method == NULL)
        options.method = monitor_report->method;
    if (options.every == 0)
        options.every = monitor_report->every;
    if (options.step == 0)
        options.step = monitor_report->step;
    if (options.most == 0)
        options.most = monitor_report->most;
    return options;
}

static Status run_on(ct_session *session, const RunOptions *said, const Host *host, Diag *diag)
{
    RunOptions options;
    const Run *old;
    RunInput input = {0};
    Result *result = NULL;
    ResultReader *reader = NULL;
    Status status = OK;

    session->reporter = NULL;
    if (session->runs.count == 0) {
        (void)diag_set(diag, E_MISSING, "there is no run to go on with");
        diag_hint(diag, "'simulate 10' makes one");
        return E_MISSING;
    }
    old = &session->runs.at[session->runs.count - 1];
    options = options_from(old->result, said);
    run_input_make(session, result_system(old->result), &input);
    run_input_go_on(&input, old);
    run_input_host(&input, host, old);
    watch_bounds(result_system(old->result), old, &input);
    status = run_resume(old->result, &input.setting, &options, &result, &reader, diag);
    if (result != NULL) {
        status = check_bounds(&input, reader, status, diag);
        keep_run(session, &input, result, reader);
    }
    run_input_free(&input);
    return status;
}

static Status run_stated(ct_session *session, const Statement *s, RunFunction *function, Diag *diag)
{
    RunOptions options;

    TRY(read_options(session, s, &options, diag));
    return run_new(session, &options, function, NULL, diag);
}

Status session_simulate(ct_session *session, const Statement *s, Diag *diag)
{
    return run_stated(session, s, run_simulate, diag);
}

Status session_kinematics(ct_session *session, const Statement *s, Diag *diag)
{
    return run_stated(session, s, run_kinematics, diag);
}

Status session_inverse(ct_session *session, const Statement *s, Diag *diag)
{
    return run_stated(session, s, run_inverse, diag);
}

Status session_resume(ct_session *session, const Statement *s, Diag *diag)
{
    RunOptions options;

    TRY(read_options(session, s, &options, diag));
    return run_on(session, &options, NULL, diag);
}

Status session_assemble(ct_session *session, const Statement *s, Diag *diag)
{
    Run *start;
    Status status;

    (void)s;
    run_free(&session->start);
    CHECK(session_start(session, &start, diag));
    session->start_is_later = true;
    session->reporter = NULL;
done:
    return status;
}

/* the options that an embedding program set */
static RunOptions options_of(const ct_run_options *given)
{
    return (RunOptions){.duration = given->duration,
                        .every = given->every,
                        .rtol = given->rtol,
                        .atol = given->atol,
                        .step = given->step,
                        .most = given->maxstep,
                        .method = given->method,
                        .check = given->check,
                        .realtime = given->realtime};
}

ct_status ct_simulate(ct_session *session, const ct_run_options *given, ct_error *error)
{
    SESSION_WORK(session, error);

    const RunOptions options = options_of(given);
    Host host = {.row = given->row, .input = given->input, .context = given->context};
    LIST(Expr) items = {0};
    Status status = OK;
    Diag diag = {0};

    session_begin(session);
    for (int i = 0; i < given->item_count; i++) {
        Expr item;

        CHECK(model_expression(session->model, syntax_of(given->items[i]), &item, &diag));
        LIST_PUSH(items, session_add_outputs(session->model, item));
    }
    host.items = items.at;
    host.item_count = items.count;
    status = given->resumes ? run_on(session, &options, &host, &diag)
                            : run_new(session, &options, run_simulate, &host, &diag);
done:
    LIST_FREE(items);
    session_free_unused(session);
    return session_report(status, &diag, error);
}

int ct_run_count(const ct_session *session)
{
    return session->runs.count;
}

/* --- reports --- */

bool ct_run_figures(const ct_session *session, int run, ct_figures *out)
{
    const int count = session->runs.count;
    const int i = run == 0 ? count - 1 : run - 1;
    const Result *result;
    const RunReport *monitor_report;
    int rows;

    if (i < 0 || i >= count)
        return false;
    result = session->runs.at[i].result;
    monitor_report = result_report(result);
    rows = result_rows(result);
    *out = (ct_figures){.method = monitor_report->method,
                        .rows = rows,
                        .from = rows > 0 ? result_times(result)[0] : NAN,
                        .to = rows > 0 ? result_times(result)[rows - 1] : NAN,
                        .rtol = monitor_report->rtol,
                        .atol = monitor_report->atol,
                        .steps = monitor_report->steps,
                        .rejected = monitor_report->rejected,
                        .evaluations = monitor_report->evaluations,
                        .position_residual = monitor_report->position_residual,
                        .velocity_residual = monitor_report->velocity_residual,
                        .energy_drift = monitor_report->energy_drift,
                        .energy_scale = monitor_report->energy_scale,
                        .global_error = monitor_report->global_error,
                        .wall = monitor_report->wall,
                        .stopped = monitor_report->stopped};
    return true;
}

static const Variable *unknown_at(const System *system, int i)
{
    const int n = system_n(system), nu = system_nu(system), nx = system_nx(system);

    return i < n             ? system_q(system, i)
           : i < n + nu      ? system_u(system, i - n)
           : i < n + nu + nx ? system_x(system, i - n - nu)
                             : system_z(system, i - n - nu - nx);
}

/* every coordinate, speed and network unknown at the start */
static void print_configuration(Text *out, const View *view, const Run *start)
{
    const System *system = result_system(start->result);
    const int count = system_n(system) + system_nu(system) + system_nx(system) + system_nz(system);
    Expr *items = NEW_ARRAY(Expr, count);
    double *values = NEW_ARRAY(double, count);
    Table table = table_for("ll");
    Text angle = {0};
    const bool in_radians = view_unit(view, "rad", &angle) == 1;
    Diag ignored;

    for (int i = 0; i < count; i++)
        items[i] = unknown_at(system, i)->symbol;
    if (result_reader_values(start->reader, items, count, values, &ignored) == OK) {
        for (int i = 0; i < count; i++) {
            const Variable *unknown = unknown_at(system, i);
            Text value = {0};

            view_quantity(view, unknown->name, values[i], 9, &value);
            table_cell(&table, unknown->name);
            if (i < system_n(system) && unknown->is_angle && in_radians)
                table_cells(&table, "%s (%.6g deg)", value.at, values[i] * 180 / M_PI);
            else
                table_cell(&table, value.at);
            text_free(&value);
        }
        table_print(out, &table, 0);
    }
    table_free(&table);
    text_free(&angle);
    mem_free(items);
    mem_free(values);
}

char *ct_report(ct_session *session)
{
    SESSION_CALL(session, NULL);

    Text text = {0};
    const View view = session_view(session);
    const int count = session->runs.count;
    Diag diag = {0};
    char name[32];

    if (session->reporter != NULL) {
        session->reporter(session, &text);
    } else if (session->start_is_later && session->start.result != NULL) {
        print_configuration(&text, &view, &session->start);
    } else if (count > 0) {
        (void)snprintf(name, sizeof name, "run%d", count);
        report_print(&text, session->runs.at[count - 1].result, name);
        if (report_friction(&view, &text, &diag) != OK)
            text_addf(&text, "friction: %s\n", diag.message);
    }
    return text_done(&text);
}
