/* session.c: creating and freeing a session, statements that change the model, and messages */
#include "session/session_impl.h"

#include "algebra/dense.h"
#include "base/clock.h"

#include "config.h"

#include <limits.h>
#include <string.h>

const char *ct_version(void)
{
    return PACKAGE_VERSION;
}

double ct_clock(void)
{
    return clock_now();
}

void ct_free(void *piece)
{
    mem_free(piece);
}

static ct_session *session_new(const ct_hooks *hooks)
{
    ct_session *session = NEW(ct_session);

    dense_quiet();
    session->model = model_new();
    session->threads = threads_new();
    session->start_is_later = true;
    session->changed = true;
    ct_session_hooks(session, hooks);
    return session;
}

ct_session *ct_session_new(const ct_hooks *hooks)
{
    TRANSACTION(NULL);

    return session_new(hooks);
}

static bool stop(void *context)
{
    const ct_session *session = context;

    return session->hooks.stop != NULL && session->hooks.stop(session->hooks.context);
}

static void progress(void *context, const char *phase, double fraction)
{
    ct_session *session = context;

    session->phase = phase;
    session->fraction = fraction;
    if (session->hooks.progress != NULL)
        session->hooks.progress(session->hooks.context, phase, fraction);
}

void ct_session_hooks(ct_session *session, const ct_hooks *hooks)
{
    session->hooks = hooks != NULL ? *hooks : (ct_hooks){0};
    session->watch = (CallMonitor){.context = session, .stop = stop, .progress = progress};
    model_find_entries(session->model, &(EntryFinder){session_entry_dimension, session});
    model_find_data(session->model, &(DataFinder){.find = session->hooks.find_file,
                                                  .context = session->hooks.context});
}

static void drop_runs(ct_session *session)
{
    mem_keep(session->runs.at);
    for (int i = 0; i < session->runs.count; i++)
        run_free(session->runs.at + i);
    LIST_FREE(session->runs);
    run_free(&session->start);
    linear_free(session->linear);
    session->linear = NULL;
    modes_free(session->modes);
    session->modes = NULL;
    sweep_table_free(session->sweep);
    session->sweep = NULL;
    fit_result_free(session->fit);
    session->fit = NULL;
    optimum_free(session->optimum);
    session->optimum = NULL;
    session->reporter = NULL;
    for (int i = 0; i < session->systems.count; i++)
        system_free(session->systems.at[i]);
    LIST_FREE(session->systems);
}

void ct_session_free(ct_session *session)
{
    if (session == NULL)
        return;
    drop_runs(session);
    tree_costs_free(&session->costs);
    text_free(&session->remarks);
    model_free(session->model);
    threads_free(session->threads);
    mem_free(session);
}

ct_status session_left(ct_session *session, bool is_stopped, ct_error *error)
{
    const Status status = is_stopped ? E_STOPPED : E_MEMORY;
    Diag diag = {0};

    (void)diag_set(&diag, status, "%s", status_text(status));
    diag_hint(&diag, "nothing has changed: what was there before is still there");
    session_begin(session);
    return session_report(status, &diag, error);
}

/* trials with failing allocations report no progress and are short */
static bool stop_trial(void *context)
{
    static const int most = 2000;
    ct_session *session = context;

    return ++session->polls > most;
}

void session_enter(const ct_session *handle)
{
    ct_session *session = (ct_session *)handle; /* a borrowed one may be touched, too */

    mem_keep(session);
    session->phase = NULL;
    if (transaction_is_trial())
        session->watch = (CallMonitor){.context = session, .stop = stop_trial};
}

/* repeats the progress message at intervals, also when the work itself reports it only once */
static bool work_stops(void *context)
{
    const ct_session *session = context;

    if (session->phase != NULL)
        monitor_report(&session->watch, session->phase, session->fraction);
    return monitor_poll(&session->watch) != OK;
}

void session_work(const ct_session *handle)
{
    session_enter(handle);
    transaction_ask(work_stops, (ct_session *)handle);
}

const char *ct_remarks(const ct_session *session)
{
    return session->remarks.at != NULL ? session->remarks.at : "";
}

/* --- building --- */

/* a parameter, a law: the model */
static VerbChanges changes_of(const Statement *statement)
{
    return statement->kind == STATEMENT_VERB ? statement->row.changes : CHANGES_MODEL;
}

/* whether it chose trees or the form, and so left the graph alone */
static bool chooses(VerbChanges changes)
{
    return changes == CHANGES_TREES || changes == CHANGES_FORM;
}

static bool chooses_trees(const Statement *statement)
{
    return statement->row.changes == CHANGES_TREES;
}

static bool is_search(const Statement *statement)
{
    return chooses_trees(statement) && statement->operands.count == 1 &&
           statement->operands.at[0].sign == 0 &&
           statement->operands.at[0].value->kind == SYNTAX_VARIABLE &&
           strcmp(statement->operands.at[0].value->text, "best") == 0;
}

static void add_counts(Text *line, OpCount count)
{
    if (op_count_total(count) > INT_MAX) {
        text_add(line, "far too many operations to be written out");
        return;
    }
    layout_count(line, (int)count.add, "addition", "additions");
    text_add(line, ", ");
    layout_count(line, (int)count.mul, "multiplication", "multiplications");
    text_add(line, ", ");
    layout_count(line, (int)count.fun, "function", "functions");
}

/* up to this number of edges, the cost of trees is computed without a request */
enum { GLANCE = 40 };

/* index in `costs` of the cost of the present trees, computed if that is fast; -1: not available */
static int log_trees(ct_session *session)
{
    View view = session_view(session);
    TreeCost cost;
    Diag ignored;
    int place;

    if (graph_edge_count(model_graph(session->model)) > GLANCE ||
        session_shown(session, &view.system, &ignored) != OK ||
        tree_cost(&view, &cost, &ignored) != OK)
        return -1;
    place = tree_costs_add(&session->costs, &cost);
    if (tree_cost_is_slight(view.system) &&
        tree_cost_count(&view, &session->costs.at[place], &ignored) != OK)
        return -1;
    return place;
}

static bool costs_differ(const TreeCost *a, const TreeCost *b)
{
    return a->written.add != b->written.add || a->written.mul != b->written.mul ||
           a->written.fun != b->written.fun;
}

/* The effect of the trees just chosen, compared with those before: reported only if the model is
 * complete. */
static void remark_trees(ct_session *session)
{
    const int before = session->cost_now < session->costs.count ? session->cost_now : -1;
    const TreeCost old = before >= 0 ? session->costs.at[before] : (TreeCost){.is_counted = false};
    const int now = log_trees(session);
    View view = session_view(session);
    const TreeCost *cost;
    Text line = {0};
    Diag ignored;

    if (now < 0 || session_shown(session, &view.system, &ignored) != OK)
        return;
    cost = &session->costs.at[now];
    if (view_is_mechanical(&view)) {
        layout_count(&line, cost->n, "coordinate", "coordinates");
        text_add(&line, ", ");
        layout_count(&line, cost->m, "constraint", "constraints");
        text_add(&line, ", ");
        view_freedoms(&line, view.system, view.freedoms);
    } else {
        view_network(&line, view.system);
    }
    if (cost->is_counted) {
        text_add(&line, "; ");
        add_counts(&line, cost->written);
    }
    if (cost->is_counted && old.is_counted && costs_differ(&old, cost)) {
        text_add(&line, " (before: ");
        add_counts(&line, old.written);
        text_char(&line, ')');
    }
    session_remark(session, line.at);
    text_free(&line);
    session->cost_now = now;
}

static Status take_back(ct_session *session)
{
    Diag ignored;

    if (model_undo(session->model, &ignored) != OK)
        return E_MODEL;
    model_forget_undone(session->model);
    return OK;
}

/* Trees that remove freedoms are refused at once if the present values can be assembled; the
 * previous trees remain. */
static Status try_trees(ct_session *session, const Statement *s, Diag *diag)
{
    Status status = OK;

    if (graph_edge_count(model_graph(session->model)) > GLANCE)
        return OK;
    status = session_try_trees(session, diag);
    if (status != E_BRANCH)
        return status;
    diag->place = s->verb_place;
    TRY(take_back(session));
    return E_BRANCH;
}

/* `set network tree`, with trees whose equations can't be brought to a form that runs, is refused
 * at once where the state form has no such trouble; so are such trees once it is set. */
static Status try_network(ct_session *session, const Statement *s, int before, Diag *diag)
{
    const int form = model_setting_value(session->model, SETTING_NETWORK);
    System *system;
    Diag ignored;
    Status status;

    if (form != NETWORK_TREE || (form == before && !chooses_trees(s)))
        return OK;
    status = session_system(session, &system, diag);
    if (status == OK || status == E_STOPPED || status == E_MEMORY ||
        session_system_of(session, NETWORK_STATE, false, &system, &ignored) != OK)
        return status == E_STOPPED || status == E_MEMORY ? status : OK;
    diag->place = s->operands.count > 0 ? s->operands.at[0].place : s->verb_place;
    TRY(take_back(session));
    return status;
}

/* whether a bare name that would be printed is a command's that was mistyped */
static bool is_unknown(const Model *model, const Statement *s)
{
    const Syntax *first = s->unknown != NULL ? s->operands.at[0].value : NULL;

    while (first != NULL && first->kind == SYNTAX_BINARY)
        first = first->args[0];
    return first != NULL && (model_defining(model) != NULL ||
                             (s->unknown->hint[0] != '\0' && !model_has_name(model, first->text)));
}

ct_status ct_apply(ct_session *session, const ct_statement *statement, ct_error *error)
{
    SESSION_WORK(session, error);

    const Statement *s = statement_of(statement);
    const VerbChanges changes = changes_of(s);
    const uint64_t revision = model_revision(session->model);
    const int form = model_setting_value(session->model, SETTING_NETWORK);
    Status status = OK;
    Diag diag = {0};

    session_begin(session);
    if (s->kind == STATEMENT_EMPTY)
        return session_report(OK, &diag, error);
    if (is_unknown(session->model, s))
        return session_report(s->unknown->status, s->unknown, error);
    if (model_defining(session->model) != NULL) {
        status = model_apply(session->model, s, &diag);
        return session_report(status, &diag, error);
    }
    if (session_room(s) != ROOM_MODEL)
        return CT_NOT_MINE;
    /* the cost of the present trees, to compare that of the next ones with */
    if (chooses_trees(s) && session->costs.count == 0 &&
        graph_edge_count(model_graph(session->model)) > 0)
        session->cost_now = log_trees(session);
    if (is_search(s)) {
        status = session_best_trees(session, &diag);
        if (status != OK && diag.place.line == 0)
            diag.place = s->verb_place;
        if (status == OK)
            CHECK(try_trees(session, s, &diag));
    } else {
        CHECK(model_apply(session->model, s, &diag));
        if (chooses_trees(s))
            CHECK(try_trees(session, s, &diag));
        CHECK(try_network(session, s, form, &diag));
        session_remark(session, model_remarks(session->model));
    }
    if (is_search(s) ? model_revision(session->model) != revision : changes != CHANGES_NAMES)
        session_note_change(session, revision, chooses(changes));
    if (chooses_trees(s) && status == OK) {
        remark_trees(session);
        session_remark_free(session);
    }
done:
    return session_report(status, &diag, error);
}

const char *ct_defining(const ct_session *session)
{
    return model_defining(session->model);
}

void ct_drop_definition(ct_session *session)
{
    SESSION_CALL(session, );

    model_drop_definition(session->model);
}

/* --- undo and the rest --- */

static ct_status move_over(ct_session *session, Status (*move)(Model *, Diag *), const char *what,
                           ct_error *error)
{
    const uint64_t revision = model_revision(session->model);
    Statement *moved = NULL;
    bool is_statement; /* else the name of several */
    Status status;
    Diag diag = {0};

    session_begin(session);
    CHECK(move(session->model, &diag));
    is_statement = statement_parse(model_undone(session->model), 1, (SyntaxOptions){false}, NULL,
                                   &moved, NULL) == OK;
    text_addf(&session->remarks, "%s: %s\n", what, model_undone(session->model));
    session_note_change(session, revision, is_statement && chooses(changes_of(moved)));
done:
    statement_free(moved);
    return session_report(status, &diag, error);
}

ct_status ct_undo(ct_session *session, ct_error *error)
{
    SESSION_WORK(session, error);

    return move_over(session, model_undo, "undone", error);
}

ct_status ct_redo(ct_session *session, ct_error *error)
{
    SESSION_WORK(session, error);

    return move_over(session, model_redo, "done again", error);
}

int ct_begin_group(ct_session *session)
{
    return model_begin_group(session->model);
}

int ct_end_group(ct_session *session, int outer, const char *called)
{
    SESSION_CALL(session, model_leave_group(session->model, outer));

    return model_end_group(session->model, outer, called);
}

int ct_step_count(const ct_session *session)
{
    return model_step_count(session->model);
}

const char *ct_step(const ct_session *session, int i, int *number)
{
    return model_step(session->model, i, number);
}

bool ct_step_clears(const ct_session *session, int i)
{
    return model_step_clears(session->model, i);
}

void ct_clear(ct_session *session)
{
    SESSION_CALL(session, );

    session_begin(session);
    model_clear(session->model);
    drop_runs(session);
    tree_costs_free(&session->costs);
    session->changed = true;
    session->start_is_later = true;
}

char *ct_save(const ct_session *session)
{
    SESSION_CALL(session, NULL);

    return model_save(session->model);
}

bool ct_is_changed(const ct_session *session)
{
    return session->changed;
}

const char *ct_title(const ct_session *session)
{
    const char *title = model_title(session->model);

    return title != NULL ? title : "";
}
