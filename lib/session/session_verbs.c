/* session_verbs.c: a statement to the function of its verb */
#include "session/session_impl.h"

#include "language/verbs.h"

static Status run_any(ct_session *session, const Statement *s, Diag *diag)
{
    static Analysis *const verbs[VERB_COUNT] = {
#define SESSION_VERB(word, ...) [VERB_##word] = session_##word,
#include "language/verbs.def"
    };

    if (s->kind == STATEMENT_VERB && s->row.room == ROOM_SESSION)
        return verbs[s->row.number](session, s, diag);
    return diag_at(diag, E_NAME, s->place, "'%s' is no verb that runs",
                   s->verb != NULL ? s->verb : s->text);
}

/* where a message belongs: at the key that it is about */
static Place place_of_message(const Statement *s, const Diag *diag)
{
    for (int i = 0; i < s->pairs.count; i++)
        if (strcmp(s->pairs.at[i].name, diag->about) == 0)
            return s->pairs.at[i].name_place;
    return s->verb_place;
}

ct_status ct_run(ct_session *session, const ct_statement *statement, ct_error *error)
{
    SESSION_WORK(session, error);

    const Statement *s = statement_of(statement);
    Status status;
    Diag diag = {0};

    session_begin(session);
    status = run_any(session, s, &diag);
    if (status != OK && diag.place.line == 0 && s->kind == STATEMENT_VERB)
        diag.place = place_of_message(s, &diag);
    session_free_unused(session);
    return session_report(status, &diag, error);
}
