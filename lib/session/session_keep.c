/* session_keep.c: `keep`: results become parameters, each a number with its unit */
#include "session/session_impl.h"

#include <math.h>
#include <string.h>

/* "A = 0.25 [m]": as a user would define it, and as `save` writes it */
static Status write_definition(ct_session *session, const Pair *pair, const double *at, Text *out,
                               Diag *diag)
{
    static const Dimension none;
    Dimension dimension = none;
    double value;

    if (pair->primes > 0) {
        (void)diag_at(diag, E_NAME, pair->name_place, "a parameter has no primes");
        diag_hint(diag, "keep RATE = %s'", pair->name);
        return E_NAME;
    }
    TRY(session_value_at(session, pair->value, at, &value, diag));
    if (!isfinite(value))
        return diag_at(diag, E_VALUE, pair->value->place, "this has no value there");
    text_addf(out, "%s = %.17g", pair->name, value);
    if (!model_dimension(session->model, pair->value, &dimension))
        return OK;
    dimension = dimension_without_angle(dimension);
    if (memcmp(&dimension, &none, sizeof none) != 0 && !pair->value->has_unit) {
        text_add(out, " [");
        dimension_print(out, dimension);
        text_add(out, "]");
    }
    return OK;
}

/* nothing depends on new names yet: then bare ones still mean the run */
static void note(ct_session *session, uint64_t revision, bool is_new)
{
    const bool is_later = session->start_is_later;

    if (model_revision(session->model) == revision)
        return;
    session_note_change(session, revision, true);
    if (is_new)
        session->start_is_later = is_later;
}

static void report_nothing(const ct_session *session, Text *out)
{
    (void)session, (void)out;
}

/* one statement of the model, as if it had been typed; an error is of the line that was */
static Status define(ct_session *session, const Pair *pair, const char *text, Diag *diag)
{
    Statement *statement = NULL;
    Status status;

    CHECK(statement_parse(text, 1, (SyntaxOptions){false}, NULL, &statement, diag));
    CHECK(model_apply(session->model, statement, diag));
done:
    statement_free(statement);
    if (status != OK)
        diag->place = pair->name_place;
    return status;
}

Status session_keep(ct_session *session, const Statement *s, Diag *diag)
{
    const uint64_t revision = model_revision(session->model);
    LIST(char *) texts = {0};
    double instant;
    int done_so_far = 0;
    bool is_new = true;
    Diag ignored;
    Status status = OK;

    if (s->at != NULL)
        CHECK(session_instant(session, s->at, &instant, diag));
    for (int i = 0; i < s->pairs.count; i++) {
        Text text = {0};

        is_new = is_new && !model_has_parameter(session->model, s->pairs.at[i].name);
        status = write_definition(session, &s->pairs.at[i], s->at != NULL ? &instant : NULL, &text,
                                  diag);
        LIST_PUSH(texts, text_done(&text));
        CHECK(status);
    }
    for (; done_so_far < s->pairs.count; done_so_far++)
        CHECK(define(session, &s->pairs.at[done_so_far], texts.at[done_so_far], diag));
    for (int i = 0; i < texts.count; i++)
        session_remark(session, texts.at[i]);
    note(session, revision, is_new);
    session->reporter = report_nothing;
done:
    for (; status != OK && done_so_far > 0; done_so_far--)
        if (model_undo(session->model, &ignored) == OK)
            model_forget_undone(session->model);
    for (int i = 0; i < texts.count; i++)
        mem_free(texts.at[i]);
    LIST_FREE(texts);
    return status;
}
