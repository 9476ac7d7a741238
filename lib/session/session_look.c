/* session_look.c: show, count, check, info, tree */
#include "session/session_impl.h"

#include "model/model.h"
#include "present/info.h"
#include "present/show.h"
#include "session/session_limits.h"

#include <math.h>

/* returns the text, or frees it and reports the error */
static ct_status finish(Status status, Text *out, const Diag *diag, char **text, ct_error *error)
{
    if (status == OK)
        *text = text_done(out);
    text_free(out);
    return session_report(status, diag, error);
}

/* a formula is in SI, whatever its number would be shown in */
static Status check_no_units(const Statement *s, Diag *diag)
{
    for (int i = 0; i < s->operands.count; i++) {
        const Syntax *value = s->operands.at[i].value;

        if (!value->has_unit || value->kind == SYNTAX_NUMBER || value->kind == SYNTAX_VECTOR)
            continue;
        (void)diag_at(diag, E_UNIT, value->unit_place, "a formula is in SI, not in %s",
                      value->unit_text);
        diag_hint(diag, "'print' shows its value in a unit");
        return E_UNIT;
    }
    return OK;
}

/* An instant of the last run, or without one the end of what a bare name means (`at` NULL). */
typedef struct InstantReader {
    Run *run;
    double time; /* s */
} InstantReader;

static Status instant_reader_find(ct_session *session, const Syntax *at, InstantReader *out,
                                  Diag *diag)
{
    const int runs = session->runs.count;
    const double *times;
    double instant = 0;

    if (at != NULL)
        TRY(session_instant(session, at, &instant, diag));
    if (at != NULL && runs > 0)
        out->run = session->runs.at + runs - 1;
    else
        TRY(session_source(session, &out->run, diag));
    times = result_times(out->run->result);
    out->time = at != NULL ? session_row_time(out->run->result, instant)
                           : times[result_rows(out->run->result) - 1];
    return OK;
}

/* expressions over the user's variables there; the context is an InstantReader */
static Status instant_read(const void *context, const Expr *items, int count, double *out,
                           Diag *diag)
{
    const InstantReader *instant = context;
    ResultReader *reader = instant->run->reader;

    TRY(result_reader_values_at(reader, items, count, instant->time, out, diag));
    for (int i = 0; i < count; i++) {
        double open;

        if (out[i] == 0 || !(fabs(out[i]) <= NOISE_LARGEST))
            continue;
        TRY(result_reader_rounding(reader, items[i], &instant->time, 1, &open, diag));
        if (fabs(out[i]) <= NOISE_ROUNDINGS * open)
            out[i] = 0;
    }
    return OK;
}

static Status instant_shares(const void *context, const char *const *parts, int count, bool *out,
                             Diag *diag)
{
    const InstantReader *instant = context;

    return result_reader_shares(instant->run->reader, instant->time, parts, count, out, diag);
}

ct_status ct_show(ct_session *session, const ct_statement *statement, char **text, ct_error *error)
{
    SESSION_WORK(session, error);

    const Statement *s = statement_of(statement);
    View view = session_view(session);
    NamedLaws laws = {0};
    InstantReader reader;
    ViewInstant instant;
    Text out = {0};
    Diag diag = {0};
    Status status;
    Need need;

    session_begin(session);
    CHECK(check_no_units(s, &diag));
    CHECK(show_need(&view, s, &need, &diag));
    if (need == NEED_INSTANT || s->at != NULL) {
        CHECK(instant_reader_find(session, s->at, &reader, &diag));
        instant = (ViewInstant){instant_read, instant_shares, &reader, reader.time};
        view.instant = &instant;
    }
    CHECK(session_prepare_formulas(session, need, &view, &diag));
    if (need == NEED_SYSTEM)
        CHECK(session_name_laws(session, s, &laws, &view, &diag));
    monitor_report(&session->watch, "writing out", -1);
    CHECK(show(&view, s, &out, &diag));
    if (need == NEED_LINEAR)
        session_remark_linear(session);
done:
    session_end_named_laws(session, &laws, &view);
    session_end_formulas(&view);
    return finish(status, &out, &diag, text, error);
}

/* Count the equations of trees that were tried, on a fork of the model that has them. */
static Status count_choice(ct_session *session, TreeCost *cost, Diag *diag)
{
    ArenaMark *mark = arena_mark(model_arena(session->model));
    SystemOptions options = {.form =
                                 (NetworkForm)model_setting_value(session->model, SETTING_NETWORK),
                             .watch = &session->watch};
    View view = session_view(session);
    Model *fork = NULL;
    Scene scene = {0};
    int statements = 0;
    Status status;

    CHECK(model_fork(session->model, &fork, diag));
    CHECK(session_apply_text(fork, cost->statements, &statements, diag));
    CHECK(model_scene(fork, &scene, diag));
    CHECK(system_new_view(&scene, &options, &view.system, diag));
    if (!system_tree_is_normal(view.system)) {
        system_free(view.system);
        view.system = NULL;
        options.form = NETWORK_TREE;
        CHECK(system_new_view(&scene, &options, &view.system, diag));
    }
    view.model = fork;
    CHECK(tree_cost_count(&view, cost, diag));
done:
    system_free(view.system);
    scene_free(&scene);
    model_free(fork);
    arena_release(model_arena(session->model), mark);
    return status;
}

ct_status ct_count(ct_session *session, const ct_statement *statement, char **text, ct_error *error)
{
    SESSION_WORK(session, error);

    const bool for_trees = count_is_for_trees(statement_of(statement));
    View view = session_view(session);
    TreeCost cost;
    Text out = {0};
    Diag diag = {0};
    Status status;

    session_begin(session);
    CHECK(session_shown(session, &view.system, &diag));
    monitor_report(&session->watch, "counting", -1);
    CHECK(tree_cost(&view, &cost, &diag));
    session->cost_now = tree_costs_add(&session->costs, &cost);
    mem_keep(session->costs.at);
    if (for_trees || tree_cost_is_slight(view.system))
        CHECK(tree_cost_count(&view, &session->costs.at[session->cost_now], &diag));
    for (int i = 0; for_trees && i < session->costs.count; i++)
        if (!session->costs.at[i].is_counted)
            CHECK(count_choice(session, &session->costs.at[i], &diag));
    CHECK(count_print(&view, statement_of(statement), &session->costs, &out, &diag));
done:
    return finish(status, &out, &diag, text, error);
}

ct_status ct_check(ct_session *session, char **text, ct_error *error)
{
    SESSION_WORK(session, error);

    View view = session_view(session);
    Run *start = NULL;
    Text out = {0};
    Diag diag = {0}, why = {0};
    Status status;

    session_begin(session);
    CHECK(session_system(session, &view.system, &diag));
    /* a start that can't be assembled is an answer here, a stop isn't */
    status = session_start(session, &start, &why);
    if (status == E_STOPPED)
        goto done;
    status = OK;
    session_begin(session); /* the report contains the remarks on the initial state */
    check_print(&view, start != NULL ? start->result : NULL, why.message, &out);
done:
    return finish(status, &out, &diag, text, error);
}

ct_status ct_info(ct_session *session, const ct_statement *statement, char **text, ct_error *error)
{
    SESSION_WORK(session, error);

    const Statement *s = statement_of(statement);
    const View view = session_view(session);
    Text out = {0};
    Diag diag = {0};
    Status status = OK;

    session_begin(session);
    if (s->operands.count == 0) {
        status = diag_at(&diag, E_SYNTAX, s->verb_place, "'info' needs a name");
        diag_hint(&diag, "'show graph' and 'show params' list them");
    }
    for (int i = 0; status == OK && i < s->operands.count; i++)
        status =
            info_print(&view, s->operands.at[i].value->text, s->operands.at[i].place, &out, &diag);
    return finish(status, &out, &diag, text, error);
}

ct_status ct_tree_text(ct_session *session, char **text, ct_error *error)
{
    SESSION_WORK(session, error);

    const View view = session_view(session);
    const Selection all = {.number_count = 0};
    Text out = {0};
    Diag diag = {0};

    session_begin(session);
    return finish(show_tree(&view, &all, &out, &diag), &out, &diag, text, error);
}
