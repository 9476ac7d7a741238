/* session_named_laws.c: formulas that call the user's laws by name
 *
 * Equations contain the bodies of laws. With `set laws named` those that are printed are formed of
 * a fork of the model, in which calls of laws remain calls. */
#include "session/session_impl.h"

/* whether the statement prints for readers: a program has no laws */
static bool is_for_readers(const Statement *s)
{
    Notation notation = NOTATION_TEXT;

    if (s->as != NULL && !notation_find(s->as, &notation))
        return false;
    return notation_row(notation)->kind == NOTATION_READ ||
           notation_row(notation)->kind == NOTATION_TYPESET;
}

Status session_name_laws(ct_session *session, const Statement *s, NamedLaws *out, View *view,
                         Diag *diag)
{
    SystemOptions options = {.watch = &session->watch};
    Status status = OK;

    if (view->system == NULL || model_setting_value(session->model, SETTING_LAWS) == 0 ||
        !is_for_readers(s))
        return OK;
    out->mark = arena_mark(model_arena(session->model));
    CHECK(model_fork_named(session->model, &out->fork, diag));
    CHECK(model_scene(out->fork, &out->scene, diag));
    options.form = system_network_form(view->system);
    CHECK(system_new_view(&out->scene, &options, &out->system, diag));
    system_set_watch(out->system, &session->watch);
    if (system_reads_turns(out->system) && session->start.result != NULL) {
        int *turns = session_turns_of_start(out->system, session->start.result);

        system_show_turns(out->system, turns);
        mem_free(turns);
    }
    out->substituted = view->system;
    view->model = out->fork;
    view->system = out->system;
    view->defined = &out->defined;
done:
    return status;
}

void session_end_named_laws(ct_session *session, NamedLaws *laws, View *view)
{
    if (laws->substituted != NULL) {
        view->model = session->model;
        view->system = laws->substituted;
    }
    system_free(laws->system);
    scene_free(&laws->scene);
    model_free(laws->fork);
    if (laws->mark != NULL)
        arena_release(model_arena(session->model), laws->mark);
    LIST_FREE(laws->defined);
}
