/* session_start.c: the start that is asked for, and the run that values are taken from
 *
 * A run starts from the initial values and guesses of the model, and from 0 else. What was
 * assembled before is no part of it. */
#include "session/session_impl.h"

Status session_start(ct_session *session, Run **out, Diag *diag)
{
    RunInput input = {0};
    Result *result = NULL;
    ResultReader *reader = NULL;
    System *system;
    Status status = OK;

    if (session->start.result == NULL) {
        CHECK(session_running(session, &system, diag));
        run_input_make(session, system, &input);
        CHECK(session_check_freedoms(session, system, &input.setting, diag));
        CHECK(run_assemble(system, &input.setting, &result, &reader, diag));
        session->start = run_input_done(&input, result, reader);
        session_note_freedoms(session, result);
        session_remark_result(session, result);
    }
    *out = &session->start;
done:
    run_input_free(&input);
    return status;
}

Status session_source(ct_session *session, Run **out, Diag *diag)
{
    if (session->runs.count > 0 && !session->start_is_later) {
        *out = session->runs.at + session->runs.count - 1;
        return OK;
    }
    return session_start(session, out, diag);
}
