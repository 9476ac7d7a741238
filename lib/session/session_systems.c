/* session_systems.c: the equations of a session, and how its calls report */
#include "session/session_impl.h"

#include <stdio.h>
#include <string.h>

/* --- errors and remarks --- */

ct_status session_report(Status status, const Diag *diag, ct_error *error)
{
    const ct_status public = status == OK          ? CT_OK
                             : status == E_STOPPED ? CT_STOPPED
                             : status == E_EXPECT  ? CT_UNMET
                                                   : CT_FAILED;

    if (error == NULL)
        return public;
    memset(error, 0, sizeof *error);
    error->status = public;
    error->is_unsolved = status == E_ASSEMBLE || status == E_SINGULAR || status == E_SOLVER;
    if (status == OK)
        return public;
    error->line = diag->place.line;
    error->column = diag->place.column;
    error->width = diag->place.width;
    /* a function that was stopped may have set no message */
    (void)snprintf(error->message, sizeof error->message, "%s",
                   diag->status == status && diag->message[0] != '\0' ? diag->message
                                                                      : status_text(status));
    (void)snprintf(error->hint, sizeof error->hint, "%s", diag->status == status ? diag->hint : "");
    memcpy(error->inside, diag->inside, sizeof error->inside);
    return public;
}

void session_begin(ct_session *session)
{
    text_free(&session->remarks);
}

void session_remark(ct_session *session, const char *lines)
{
    if (lines == NULL || lines[0] == '\0')
        return;
    text_add(&session->remarks, lines);
    if (lines[strlen(lines) - 1] != '\n')
        text_char(&session->remarks, '\n');
}

void session_remark_result(ct_session *session, const Result *result)
{
    const Remarks *remarks = result_remarks(result);

    for (int i = 0; i < remarks->list.count; i++) {
        Text line = {0};

        if (remarks->list.at[i].kind == REMARK_BOUND_MET)
            continue;
        remark_write(&remarks->list.at[i], &line);
        session_remark(session, line.at);
        text_free(&line);
    }
}

/* --- equations --- */

static bool is_of(const Run *run, const System *system)
{
    return run->result != NULL && result_system(run->result) == system;
}

static bool is_named(const ct_session *session, const System *system)
{
    for (int i = 0; i < session->runs.count; i++)
        if (is_of(&session->runs.at[i], system))
            return true;
    return is_of(&session->start, system);
}

static bool is_current(const ct_session *session, const System *system)
{
    return system_holds(system, model_revision(session->model), model_scene_number, session->model);
}

void session_free_unused(ct_session *session)
{
    const System *last = NULL, *before = NULL;
    int kept = 0;

    mem_keep(session->systems.at);
    for (int i = 0; i < session->systems.count; i++)
        if (!system_serves(session->systems.at[i], &(SystemOptions){0})) {
            before = last;
            last = session->systems.at[i];
        }
    for (int i = 0; i < session->systems.count; i++) {
        System *system = session->systems.at[i];

        /* perhaps only numbers have changed since the last one was made for a run, or other changes
         * have been undone */
        if (is_current(session, system) || is_named(session, system) || system == last ||
            system == before)
            session->systems.at[kept++] = system;
        else
            system_free(system);
    }
    session->systems.count = kept;
}

/* one that there is; NULL: none. With the scene also one that it differs from in numbers alone. */
static System *find_system(const ct_session *session, const SystemOptions *options,
                           const Scene *scene)
{
    for (int i = session->systems.count - 1; i >= 0; i--) {
        System *system = session->systems.at[i];

        if (system_network_form(system) == options->form && system_serves(system, options) &&
            (scene == NULL || system_follows(system, scene)) && is_current(session, system))
            return system;
    }
    return NULL;
}

/* it is the one used last from now on */
static void put_last(ct_session *session, System *system)
{
    const int count = session->systems.count;
    int kept = 0;

    mem_keep(session->systems.at);
    for (int i = 0; i < count; i++)
        if (session->systems.at[i] != system)
            session->systems.at[kept++] = session->systems.at[i];
    session->systems.at[count - 1] = system;
}

static Status find_or_make(ct_session *session, const SystemOptions *options, System **out,
                           Diag *diag)
{
    System *system = NULL;
    Scene scene = {0};
    Status status = OK;

    *out = find_system(session, options, NULL);
    if (*out != NULL)
        return OK;
    CHECK(model_scene(session->model, &scene, diag));
    *out = find_system(session, options, &scene);
    if (*out != NULL) {
        put_last(session, *out);
        goto done;
    }
    monitor_report(&session->watch, "equations", -1);
    CHECK(system_new_view(&scene, options, &system, diag));
    system_set_watch(system, &session->watch);
    LIST_PUSH(session->systems, system);
    session_free_unused(session);
    *out = system;
done:
    scene_free(&scene);
    return status;
}

Status session_system_of(ct_session *session, NetworkForm form, bool has_lifted, System **out,
                         Diag *diag)
{
    const SystemOptions options = {
        .form = form, .has_lifted = has_lifted, .watch = &session->watch};

    return find_or_make(session, &options, out, diag);
}

Status session_system(ct_session *session, System **out, Diag *diag)
{
    return session_system_of(session,
                             (NetworkForm)model_setting_value(session->model, SETTING_NETWORK),
                             false, out, diag);
}

Status session_resting(ct_session *session, const Expr *rests, int rest_count, System **out,
                       Diag *diag)
{
    const SystemOptions options = {
        .form = (NetworkForm)model_setting_value(session->model, SETTING_NETWORK),
        .has_lifted = true,
        .rests = rests,
        .rest_count = rest_count,
        .watch = &session->watch};

    return find_or_make(session, &options, out, diag);
}

Status session_running(ct_session *session, System **out, Diag *diag)
{
    return session_resting(session, NULL, 0, out, diag);
}

Status session_shown(ct_session *session, System **out, Diag *diag)
{
    Diag why = {0};
    Status status = OK;

    CHECK(session_system(session, out, diag));
    if (system_tree_is_normal(*out))
        return OK;
    status = session_system_of(session, NETWORK_TREE, false, out, &why);
    if (status != OK && status != E_STOPPED) {
        Text line = {0};

        text_addf(&line, "network in state form: %s\n",
                  status == E_MODEL ? why.message
                                    : "the equations of these trees can't be solved for their "
                                      "highest derivatives");
        session_remark(session, line.at);
        text_free(&line);
        status = session_system(session, out, diag);
    } else if (status != OK) {
        *diag = why;
    }
done:
    return status;
}

Status session_prepare(ct_session *session, Need need, View *view, Diag *diag)
{
    return need == NEED_SYSTEM    ? session_shown(session, &view->system, diag)
           : need == NEED_RUNNING ? session_system(session, &view->system, diag)
                                  : OK;
}

void session_note_freedoms(ct_session *session, const Result *result)
{
    if (system_revision(result_system(result)) != model_revision(session->model))
        return;
    session->freed = model_revision(session->model) + 1;
    session->freedoms = result_freedoms(result);
}

int session_freedoms(const ct_session *session)
{
    return session->freed == model_revision(session->model) + 1 ? session->freedoms : -1;
}

static const Result *run_result(const void *session, int i)
{
    return ((const ct_session *)session)->runs.at[i].result;
}

static Status run_integrals(const void *context, const Expr *items, int count, double *out,
                            Diag *diag)
{
    const ct_session *session = context;
    const Run *last = &session->runs.at[session->runs.count - 1];
    const double end = result_times(last->result)[result_rows(last->result) - 1];

    return result_reader_integrals(last->reader, items, count, &end, 1, &session->watch, out, diag);
}

View session_view(const ct_session *session)
{
    const int runs = session->runs.count;

    return (View){.model = session->model,
                  .result = runs > 0 ? session->runs.at[runs - 1].result : NULL,
                  .run = run_result,
                  .integrals = run_integrals,
                  .session = session,
                  .run_count = runs,
                  .linear = session->linear,
                  .sweep = session->sweep,
                  .fit = session->fit,
                  .optimum = session->optimum,
                  .freedoms = session_freedoms(session),
                  .page = {.columns = session->hooks.columns,
                           .unicode = session->hooks.unicode,
                           .notation = session->hooks.unicode ? NOTATION_UNICODE : NOTATION_TEXT,
                           .units = session->hooks.units},
                  .watch = &session->watch};
}

Expr session_add_outputs(const Model *model, Expr e)
{
    const int count = model_output_count(model);
    Arena *arena = model_arena(model);
    Expr *symbols = NEW_ARRAY(Expr, count), *values = NEW_ARRAY(Expr, count);

    for (int i = 0; i < count; i++) {
        const char *name;

        values[i] = model_output(model, i, &name);
        symbols[i] = expr_symbol(arena, name, SYMBOL_VARIABLE);
    }
    for (int depth = 0; depth < count; depth++) {
        const Expr next = expr_substitute(arena, e, symbols, values, count);

        if (next == e)
            break;
        e = next;
    }
    MEM_FREE(symbols, values);
    return e;
}
