/* session_change.c: what a change of the model leaves of what was made of it */
#include "session/session_impl.h"

void session_note_change(ct_session *session, uint64_t revision, bool trees_only)
{
    session->changed = true;
    session->linear_is_old = true;
    session->start_is_later = true;
    session->reporter = NULL;
    run_free(&session->start);
    /* the figures of another graph don't apply to this one */
    if (model_revision(session->model) != revision && !trees_only)
        tree_costs_free(&session->costs);
    session_free_unused(session);
}

void session_end_group(ct_session *session, int group, const char *called, uint64_t revision,
                       bool keep)
{
    Model *model = session->model;
    const int count = model_end_group(model, group, called);

    if (!keep && count > 0) {
        Diag ignored;

        if (model_undo(model, &ignored) == OK)
            model_forget_undone(model);
    }
    if (count > 0)
        session_note_change(session, revision, false);
}
