/* session_optimum_entry.c: figures of the last optimisation: optimum.value(k), optimum.figure */
#include "session/session_impl.h"

static Status need_optimum(const ct_session *session, Diag *diag)
{
    if (session->optimum != NULL)
        return OK;
    (void)diag_set(diag, E_MISSING, "there is no optimum yet");
    diag_hint(diag, "optimise k=[0, 20] minimise=max(h) : simulate 5");
    return E_MISSING;
}

bool optimum_entry_is_called(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_CALL && strcmp(syntax->text, "optimum.value") == 0;
}

Status optimum_entry_value(const ct_session *session, const Syntax *call, double *out, Diag *diag)
{
    const Syntax *name = call->count == 1 ? call->args[0] : NULL;
    Text list = {0};
    int i;

    TRY(need_optimum(session, diag));
    if (name == NULL) {
        (void)diag_at(diag, E_VALUE, call->place, "optimum.value takes 1 argument, not %d",
                      call->count);
        diag_hint(diag, "optimum.value(PARAMETER)");
        return E_VALUE;
    }
    i = name->kind == SYNTAX_VARIABLE ? optimum_find(session->optimum, name->text) : -1;
    if (i >= 0) {
        *out = session->optimum->parameters.at[i].value;
        return OK;
    }
    for (int k = 0; k < session->optimum->parameters.count; k++)
        text_addf(&list, "%s%s", k > 0 ? ", " : "", session->optimum->parameters.at[k].name);
    (void)diag_at(diag, E_NAME, name->place, "the optimisation has no such parameter");
    diag_hint(diag, "it has: %.300s", list.at);
    text_free(&list);
    return E_NAME;
}

Status optimum_size_value(ct_session *session, const char *path, double *out, Diag *diag)
{
    const Optimum *optimum = session->optimum;

    TRY(need_optimum(session, diag));
    if (strcmp(path, "optimum.figure") == 0)
        *out = optimum->value;
    else if (strcmp(path, "optimum.initial") == 0)
        *out = optimum->start;
    else if (strcmp(path, "optimum.runs") == 0)
        *out = optimum->runs;
    else if (strcmp(path, "optimum.converged") == 0)
        *out = optimum->is_converged;
    else {
        (void)diag_set(diag, E_NAME, "there is no '%s'", path);
        diag_hint(diag, "optimum.figure is the value found, optimum.initial that of the start; "
                        "optimum.runs and optimum.converged; optimum.value(PARAMETER)");
        return E_NAME;
    }
    return OK;
}

bool optimum_entry_dimension(const ct_session *session, const Syntax *call, Dimension *out)
{
    const Optimum *optimum = session->optimum;
    size_t fault;
    Unit unit;
    int i;

    if (optimum == NULL || call->count != 1 || call->args[0]->kind != SYNTAX_VARIABLE)
        return false;
    i = optimum_find(optimum, call->args[0]->text);
    if (i < 0 || optimum->parameters.at[i].unit[0] == '\0' ||
        !unit_parse(optimum->parameters.at[i].unit, strlen(optimum->parameters.at[i].unit), &unit,
                    &fault))
        return false;
    *out = unit.dimension;
    return true;
}
