/* session_start.c: the requested initial state, and the run that values are read from
 *
 * A run starts from the initial values and guesses of the model, and from 0 else. Earlier
 * assemblies have no influence. */
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

int *session_turns_of_start(const System *system, const Result *start)
{
    const int count = system_whole_turns_count(system);
    int *turns = NEW_ARRAY(int, count);

    for (int i = 0; i < count; i++)
        turns[i] = result_full_turns(start, system_whole_turns(system, i)->symbol);
    return turns;
}

Status session_prepare_formulas(ct_session *session, Need need, View *view, Diag *diag)
{
    Diag why = {0};
    Run *start = NULL;
    int *turns = NULL;
    Status status;

    TRY(session_prepare(session, need, view, diag));
    if (view->system == NULL || !system_reads_turns(view->system))
        return OK;
    status = session_start(session, &start, &why);
    if (status == E_STOPPED || status == E_MEMORY)
        return diag_set(diag, status, "%s", why.message);
    session_begin(session); /* the report is that of what is written */
    TRY(session_prepare(session, need, view, diag));
    if (status == OK)
        turns = session_turns_of_start(view->system, start->result);
    else
        session_remark(session, "full turns of angles are left out: there is no start that chooses "
                                "them");
    system_show_turns(view->system, turns);
    mem_free(turns);
    return OK;
}

void session_end_formulas(const View *view)
{
    if (view->system != NULL && system_whole_turns_count(view->system) > 0)
        system_show_turns(view->system, NULL);
}
