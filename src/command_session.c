/* command_session.c: commands about the session: files of statements, undo, history, settings */
#include "command.h"
#include "copy.h"
#include "file.h"
#include "replay.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 20 }; /* files within files */

/* the file that a statement names, or an error */
static ct_status find_path(const Call *call, const char **path, ct_error *error)
{
    *path = call_word(call, 0);
    if (*path != NULL && **path != '\0')
        return CT_OK;
    ct_error_at(call->statement, NULL, error, "%s which file?", ct_verb(call->statement));
    error_hint(error, "%s \"model.ct\"", ct_verb(call->statement));
    return CT_FAILED;
}

/* --- files of statements --- */

ct_status command_source(Call *call, ct_error *error)
{
    Shell *shell = call->shell;
    const ct_statement *statement = call->statement;
    const char *name;
    ct_error inner;
    ct_status status = find_path(call, &name, error);

    if (status != CT_OK)
        return status;
    if (shell->depth >= DEEPEST) {
        ct_error_at(statement, ct_operand(statement, 0), error, "files within files, %d deep",
                    DEEPEST);
        error_hint(error, "does '%s' lead back to itself?", name);
        return CT_FAILED;
    }

    char *path = file_beside(shell->script, name);

    shell->depth++;
    status = replay_file(shell, path, &inner);
    shell->depth--;
    if (status != CT_OK && inner.message[0] == '\0')
        *error = inner;
    else if (status != CT_OK)
        ct_error_at(statement, ct_operand(statement, 0), error, "%s", inner.message);
    free(path);
    return status;
}

ct_status command_save(Call *call, ct_error *error)
{
    const char *path;
    ct_error why;
    ct_status status = find_path(call, &path, error);

    if (status != CT_OK)
        return status;

    char *script = ct_save(call->session);

    if (file_write(path, script, strlen(script), false, &why) != CT_OK)
        status =
            ct_error_at(call->statement, ct_operand(call->statement, 0), error, "%s", why.message);
    ct_free(script);
    return status;
}

ct_status command_record(Call *call, ct_error *error)
{
    Shell *shell = call->shell;
    const char *path;
    ct_status status = find_path(call, &path, error);
    FILE *file = NULL;

    if (status != CT_OK)
        return status;
    if (strcmp(path, "off") != 0) {
        file = fopen(path, "ae");
        if (file == NULL)
            return ct_error_at(call->statement, ct_operand(call->statement, 0), error,
                               "can't write '%s': %s", path, strerror(errno));
    }
    if (shell->record != NULL)
        fclose(shell->record);
    shell->record = file;
    return CT_OK;
}

/* --- back and forth --- */

ct_status command_undo(Call *call, ct_error *error)
{
    return ct_undo(call->session, error);
}

ct_status command_redo(Call *call, ct_error *error)
{
    return ct_redo(call->session, error);
}

ct_status command_clear(Call *call, ct_error *error)
{
    (void)error;
    ct_clear(call->session);
    return CT_OK;
}

ct_status command_history(Call *call, ct_error *error)
{
    const Shell *shell = call->shell;

    (void)error;
    for (int i = 0; i < shell->history_count; i++)
        fprintf(call->out, "%5d  %s\n", i + 1, shell->history[i]);
    return CT_OK;
}

ct_status command_set(Call *call, ct_error *error)
{
    return settings_apply(&call->shell->settings, call->statement, error);
}

ct_status command_quit(Call *call, ct_error *error)
{
    (void)error;
    call->shell->quitting = true;
    return CT_OK;
}
