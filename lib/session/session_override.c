/* session_override.c: values of parameters that win over their definitions */
#include "session/session_impl.h"

ct_status ct_override(ct_session *session, const char *text, ct_error *error)
{
    SESSION_WORK(session, error);

    const uint64_t revision = model_revision(session->model);
    Statement *statement = NULL;
    size_t next = 0;
    Diag diag = {0};
    Status status;

    session_begin(session);
    CHECK(statement_parse(text, 1, (SyntaxOptions){false}, &next, &statement, &diag));
    if (statement->kind != STATEMENT_PARAMETER || text[next] != '\0') {
        status = diag_set(&diag, E_SYNTAX, "'%.80s' is no value of a parameter", text);
        diag_hint(&diag, "L=0.7, or 'L=70 cm' in quotes");
        goto done;
    }
    CHECK(model_override_by(session->model, statement->name, statement->value, &diag));
    session_note_change(session, revision, true);
done:
    statement_free(statement);
    return session_report(status, &diag, error);
}

const char *ct_override_unused(const ct_session *session)
{
    for (int i = 0; i < model_override_count(session->model); i++)
        if (!model_has_parameter(session->model, model_override_name(session->model, i)))
            return model_override_name(session->model, i);
    return NULL;
}
