/* session_sweep.c: `sweep` and `montecarlo`
 *
 * The parameters of a run are overrides of the model's (model_override.h), so that a changed number
 * forms no equations anew, and the model is afterwards what it was. What the session knows of its
 * last run, its start and its linearisation is laid aside meanwhile. Nothing that a run leaves is
 * seen by the next one: its row depends on its parameters alone, so that processes that share the
 * runs make the same rows. */
#include "session/session_sweep.h"

#include "base/clock.h"
#include "base/worker_processes.h"
#include "language/verbs.h"
#include "session/session_limits.h"

#include <math.h>
#include <stdio.h>

void focus_put_aside(ct_session *session, SessionFocus *out)
{
    *out = (SessionFocus){.start = session->start,
                          .linear = session->linear,
                          .modes = session->modes,
                          .reporter = session->reporter,
                          .linear_is_old = session->linear_is_old,
                          .start_is_later = session->start_is_later,
                          .changed = session->changed,
                          .covered = session->covered,
                          .freed = session->freed,
                          .freedoms = session->freedoms};
    session->start = (Run){0};
    session->linear = NULL;
    session->modes = NULL;
}

void focus_clear(ct_session *session, int runs)
{
    while (session->runs.count > runs)
        run_free(&session->runs.at[--session->runs.count]);
    run_free(&session->start);
    linear_free(session->linear);
    session->linear = NULL;
    modes_free(session->modes);
    session->modes = NULL;
    session->start_is_later = true;
    session->covered = session->freed = 0;
    session_begin(session);
}

void focus_restore(ct_session *session, const SessionFocus *focus)
{
    session->start = focus->start;
    session->linear = focus->linear;
    session->modes = focus->modes;
    session->reporter = focus->reporter;
    session->linear_is_old = focus->linear_is_old;
    session->start_is_later = focus->start_is_later;
    session->changed = focus->changed;
    session->covered = focus->covered;
    session->freed = focus->freed;
    session->freedoms = focus->freedoms;
}

/* --- one run --- */

Analysis *sweep_analysis(const Statement *s)
{
    static Analysis *const verbs[VERB_COUNT] = {
        [VERB_simulate] = session_simulate,       [VERB_kinematics] = session_kinematics,
        [VERB_inverse] = session_inverse,         [VERB_assemble] = session_assemble,
        [VERB_equilibrium] = session_equilibrium, [VERB_op] = session_op,
        [VERB_linearize] = session_linearize,     [VERB_modes] = session_modes,
    };

    return s != NULL && s->kind == STATEMENT_VERB && s->row.component == NULL && s->row.number >= 0
               ? verbs[s->row.number]
               : NULL;
}

static Status check_rest(const Statement *s, Diag *diag)
{
    if (sweep_analysis(s->rest) != NULL)
        return OK;
    (void)diag_at(diag, E_VALUE, s->rest->place, "'%s' computes nothing that could be kept",
                  s->rest->verb != NULL ? s->rest->verb : s->rest->text);
    diag_hint(diag, "simulate, kinematics, inverse, assemble, equilibrium, op, linearize and modes "
                    "may stand after the colon");
    return E_VALUE;
}

bool sweep_is_of_one_run(Status status)
{
    return status == E_VALUE || status == E_ASSEMBLE || status == E_SINGULAR ||
           status == E_SOLVER || status == E_DOMAIN || status == E_MODEL || status == E_BRANCH;
}

static Status set_parameters(ct_session *session, const SweepTable *table, int row, Diag *diag)
{
    const double *values = sweep_table_row(table, row);
    Status status = OK;

    /* all of them, so that what one refuses may be allowed with the next */
    for (int i = 0; i < table->parameter_count; i++)
        model_override(session->model, table->columns.at[i].name, values[i]);
    for (int i = 0; i < table->parameter_count; i++)
        CHECK(model_check_parameter(session->model, table->columns.at[i].name, diag));
done:
    return status;
}

static Status keep_figures(ct_session *session, const Statement *s, const SweepTable *table,
                           int row, Diag *diag)
{
    double *values = sweep_table_row(table, row) + table->parameter_count;
    Status first = OK;

    for (int i = 0; sweep_kept(s, i) != NULL; i++) {
        Diag why = {0};
        const Status status = session_value_at(session, sweep_kept(s, i), NULL, &values[i], &why);

        if (status == OK)
            continue;
        values[i] = NAN;
        if (first == OK) {
            *diag = why;
            first = status;
        }
        if (!sweep_is_of_one_run(status)) {
            *diag = why;
            return status;
        }
    }
    return first;
}

static Status run_row(ct_session *session, const Statement *s, const SweepTable *table, int row,
                      Diag *diag)
{
    TRY(set_parameters(session, table, row, diag));
    TRY(sweep_analysis(s->rest)(session, s->rest, diag));
    return keep_figures(session, s, table, row, diag);
}

/* --- all of them --- */

/* The runs of a statement. Before the first they have the caller's process, then workers. */
typedef struct SweepWork {
    ct_session *session;
    const Statement *statement;
    SweepTable *table;
    SweepFile *file;
    bool *is_made;        /* each row; planned */
    int made;             /* rows */
    int overrides, runs;  /* of the session, before */
    int failed_row;       /* whose error is the statement's; -1: none */
    Status failed_status; /* of it */
    Diag first, fatal;    /* of the first row that failed; of failed_row */
    int first_row;
    bool is_stopped; /* by the user */
} SweepWork;

/* what a worker sends, before the figures */
typedef struct RowResult {
    Status status;
    Diag diag;
} RowResult;

static void note_reason(SweepTable *table, int row, const char *text)
{
    mem_free(table->reasons[row]);
    table->reasons[row] = mem_text(text, strlen(text));
    table->failures++;
}

/* of a row that was made, with its figures in the table */
static void take_row(SweepWork *work, int row, Status status, const Diag *diag)
{
    if (status != OK && !sweep_is_of_one_run(status)) {
        if (work->failed_row >= 0 && work->failed_row < row)
            return;
        work->failed_row = row;
        work->failed_status = status;
        work->fatal = *diag;
        return;
    }
    if (status != OK) {
        note_reason(work->table, row,
                    diag->status == status && diag->message[0] != '\0' ? diag->message
                                                                       : status_text(status));
        if (work->first_row < 0 || row < work->first_row) {
            work->first_row = row;
            work->first = *diag;
        }
    }
    work->is_made[row] = true;
    work->made++;
}

/* the same of a row that is complete: it is added to the file of rows, too */
static void finish_row(SweepWork *work, int row, Status status, const Diag *diag)
{
    Diag why = {0};

    take_row(work, row, status, diag);
    if (!work->is_made[row])
        return;
    status = sweep_file_add(work->file, work->table, row, &why);
    if (status != OK) {
        work->failed_row = row;
        work->failed_status = status;
        work->fatal = why;
    }
}

static Status make_row(SweepWork *work, int row, Diag *diag)
{
    Status status;

    focus_clear(work->session, work->runs);
    status = run_row(work->session, work->statement, work->table, row, diag);
    model_drop_overrides(work->session->model, work->overrides);
    return status;
}

static void report_progress(const SweepWork *work)
{
    const ct_hooks *hooks = &work->session->hooks;

    if (hooks->progress != NULL)
        hooks->progress(hooks->context, work->statement->verb,
                        (double)work->made / work->table->planned);
}

/* rows that aren't made yet, one after another, until `end` */
static Status make_rows_here(SweepWork *work, int end)
{
    for (int row = 0; row < end && work->failed_row < 0; row++) {
        Diag why = {0};
        Status status;

        if (work->is_made[row])
            continue;
        report_progress(work);
        TRY(monitor_poll(&work->session->watch));
        status = make_row(work, row, &why);
        if (status == E_STOPPED)
            return status;
        /* from now on there is something to lose */
        transaction_stop_asking();
        finish_row(work, row, status, &why);
    }
    return OK;
}

/* --- workers --- */

static void work_on_row(void *context, int row, void *result)
{
    SweepWork *work = context;
    const SweepTable *table = work->table;
    const int figures = table->columns.count - table->parameter_count;
    RowResult *out = result;

    if (work->is_made[row])
        return;
    work->session->watch.stop = NULL;
    out->status = make_row(work, row, &out->diag);
    memcpy((char *)result + sizeof *out, sweep_table_row(table, row) + table->parameter_count,
           (size_t)figures * sizeof(double));
}

static void take_result(void *context, int row, const void *result)
{
    SweepWork *work = context;
    const SweepTable *table = work->table;
    const int figures = table->columns.count - table->parameter_count;
    RowResult got;

    if (work->is_made[row])
        return;
    memcpy(&got, result, sizeof got);
    memcpy(sweep_table_row(table, row) + table->parameter_count, (const char *)result + sizeof got,
           (size_t)figures * sizeof(double));
    finish_row(work, row, got.status, &got.diag);
}

static void lose_row(void *context, int row, const char *why)
{
    Diag diag = {0};

    take_row(context, row, diag_set(&diag, E_SOLVER, "%s", why), &diag);
}

static bool has_to_stop(void *context)
{
    SweepWork *work = context;

    report_progress(work);
    work->is_stopped = monitor_poll(&work->session->watch) != OK;
    return work->is_stopped || work->failed_row >= 0;
}

static void make_rows_in_workers(SweepWork *work, int jobs)
{
    const SweepTable *table = work->table;
    const int figures = table->columns.count - table->parameter_count;
    const WorkPlan plan = {
        .end = table->planned,
        .workers = jobs < table->planned - work->made ? jobs : table->planned - work->made,
        .size = sizeof(RowResult) + (size_t)figures * sizeof(double),
        .piece = work_on_row,
        .take = take_result,
        .lose = lose_row,
        .stop = has_to_stop,
        .context = work};

    worker_processes_do(&plan);
}

/* whether the time that workers save is longer than it takes to start them */
static bool is_worth_workers(const SweepWork *work, double wall, bool given)
{
#ifdef COTREE_FAULTS
    return false;
#endif
    return given || wall * (work->table->planned - work->made) > SWEEP_WORKERS;
}

/* After a stop: the table ends with the last row that was made, and rows before it that were being
 * made have no figures. */
static void end_table(SweepWork *work)
{
    SweepTable *table = work->table;

    table->rows = table->planned;
    while (table->rows > 0 && !work->is_made[table->rows - 1])
        table->rows--;
    for (int row = 0; row < table->rows; row++)
        if (!work->is_made[row])
            table->reasons[row] = mem_text("stopped", strlen("stopped"));
}

static int first_to_make(const SweepWork *work)
{
    int row = 0;

    while (row < work->table->planned && work->is_made[row])
        row++;
    return row;
}

/* The first run is made here: it forms the equations, which workers then share. Rows are kept after
 * a stop. */
static Status run_rows(ct_session *session, const Statement *s, SweepTable *table, SweepFile *file,
                       int jobs, bool given, Diag *diag)
{
    void (*progress)(void *, const char *, double) = session->watch.progress;
    SweepWork work = {.session = session,
                      .statement = s,
                      .table = table,
                      .file = file,
                      .is_made = NEW_ARRAY(bool, table->planned),
                      .overrides = model_override_count(session->model),
                      .runs = session->runs.count,
                      .failed_row = -1,
                      .first_row = -1};
    const double began = clock_now();
    Status status;

    status = sweep_file_open(file, table, work.is_made, diag);
    if (status != OK) {
        mem_free(work.is_made);
        return status;
    }
    work.made = file->old;
    session->watch.progress = NULL; /* the phases of each run are of no interest */
    if (first_to_make(&work) < table->planned)
        status = make_rows_here(&work, first_to_make(&work) + 1);
    if (status == OK && jobs > 1 && work.failed_row < 0 && table->planned - work.made > 1 &&
        is_worth_workers(&work, clock_now() - began, given))
        make_rows_in_workers(&work, jobs);
    if (status == OK)
        status = work.is_stopped ? E_STOPPED : make_rows_here(&work, table->planned);
    model_drop_overrides(session->model, work.overrides);
    focus_clear(session, work.runs);
    end_table(&work);
    if (work.failed_row >= 0) {
        status = work.failed_status;
        *diag = work.fatal;
    } else if (status == E_STOPPED) {
        status = diag_set(diag, status, "stopped in run %d of %d", table->rows + 1, table->planned);
    } else if (work.first_row >= 0) {
        *diag = work.first;
    }
    session->watch.progress = progress;
    table->wall = clock_now() - began;
    mem_free(work.is_made);
    return status;
}

static void remark_rows(ct_session *session, const Statement *s, const SweepTable *table,
                        const SweepFile *file)
{
    Text line = {0};

    text_addf(&line, "%s: %d run%s", s->verb, table->rows, table->rows == 1 ? "" : "s");
    if (table->rows < table->planned)
        text_addf(&line, " of %d", table->planned);
    if (file->old > 0)
        text_addf(&line, ", %d of them from '%s'", file->old, file->name->text);
    if (table->failures > 0)
        text_addf(&line, ", %d failed", table->failures);
    text_addf(&line, ", %.2g s; 'show %s' prints %s", table->wall,
              table->is_random ? "statistics" : "sweep",
              table->is_random ? "statistics" : "the table");
    session_remark(session, line.at);
    text_free(&line);
}

/* a warning of the first run that failed */
static void remark_failures(ct_session *session, const SweepTable *table)
{
    Text line = {0};

    for (int r = 0; table->failures > 0 && r < table->rows && line.length == 0; r++)
        if (table->reasons[r] != NULL)
            text_addf(&line, "warning: run %d failed: %s%s", r + 1, table->reasons[r],
                      table->failures > 1 ? "; 'show sweep' has the reasons of the others" : "");
    session_remark(session, line.at);
    text_free(&line);
}

static bool has_figure(const SweepTable *table)
{
    for (int r = 0; r < table->rows; r++)
        for (int c = table->parameter_count; c < table->columns.count; c++)
            if (table->reasons[r] == NULL || isfinite(sweep_table_row(table, r)[c]))
                return true;
    return false;
}

static void report_nothing(const ct_session *session, Text *out)
{
    (void)session, (void)out;
}

Status session_sweep(ct_session *session, const Statement *s, Diag *diag)
{
    SessionFocus focus;
    SweepTable *table = NULL;
    SweepFile file;
    int jobs;
    bool given;
    Status status;

    CHECK(check_rest(s, diag));
    CHECK(sweep_jobs(session, s, &jobs, &given, diag));
    CHECK(sweep_plan(session, s, &table, diag));
    CHECK(sweep_file_plan(session, s, &table, &file, diag));
    focus_put_aside(session, &focus);
    session->is_sweeping = true;
    status = run_rows(session, s, table, &file, jobs, given, diag);
    session->is_sweeping = false;
    focus_restore(session, &focus);
    if ((status != OK && status != E_STOPPED) || table->rows == 0)
        goto done;
    session->reporter = report_nothing;
    remark_rows(session, s, table, &file);
    if (status == OK && !has_figure(table)) {
        const Diag why = *diag;

        status = diag_at(diag, why.status != OK ? why.status : E_VALUE,
                         why.status != OK ? why.place : s->verb_place,
                         "all %d runs failed; the first: %.400s", table->rows, table->reasons[0]);
        diag_hint(diag, "%s", why.hint);
    } else {
        remark_failures(session, table);
    }
    sweep_table_free(session->sweep);
    session->sweep = table;
    table = NULL;
done:
    sweep_table_free(table);
    return status;
}

Status session_montecarlo(ct_session *session, const Statement *s, Diag *diag)
{
    return session_sweep(session, s, diag);
}

void ct_seed(ct_session *session, uint64_t seed)
{
    SESSION_CALL(session, );

    session->seed = seed;
}

/* a column in units of a list */
static ct_column column_in(const SweepTable *table, int c, const char *units)
{
    const SweepColumn *from = &table->columns.at[c];
    Text text = {0};
    double size = 1;
    Unit unit;
    size_t fault;

    if (units != NULL && from->unit[0] != '\0' &&
        unit_parse(from->unit, strlen(from->unit), &unit, &fault))
        size = dimension_print_in(&text, dimension_without_angle(unit.dimension), units);
    if (size == 1) {
        text_free(&text);
        text_add(&text, from->unit);
    }

    ct_column out = {.name = mem_text(from->name, strlen(from->name)),
                     .unit = text_done(&text),
                     .values = NEW_ARRAY(double, table->rows)};

    for (int r = 0; r < table->rows; r++)
        out.values[r] = sweep_table_row(table, r)[c] / size;
    return out;
}

ct_status ct_sweep_columns(ct_session *session, const char *units, ct_column **out, int *columns,
                           int *parameters, int *rows, bool *is_random, ct_error *error)
{
    SESSION_WORK(session, error);

    const SweepTable *table = session->sweep;
    Diag diag = {0};
    Status status = OK;

    session_begin(session);
    if (table == NULL) {
        status = diag_set(&diag, E_MISSING, "there is no sweep yet");
        diag_hint(&diag, "sweep L=range(0.1, 0.3, 20) keep=[max(h1)] : simulate 5");
        return session_report(status, &diag, error);
    }
    *columns = table->columns.count;
    *parameters = table->parameter_count;
    *rows = table->rows;
    *is_random = table->is_random;
    *out = NEW_ARRAY(ct_column, table->columns.count + 1);
    for (int c = 0; c < table->columns.count; c++)
        (*out)[c] = column_in(table, c, units);
    return session_report(status, &diag, error);
}
