/* command_session.c: commands about the session: files of statements, undo, history, settings */
#include "command.h"
#include "copy.h"
#include "file.h"
#include "replay.h"
#include "saved.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { DEEPEST = 20 }; /* files within files */

/* the file that a statement names by an operand, or an error */
static ct_status find_path(const Call *call, int operand, const char **path, ct_error *error)
{
    *path = call_word(call, operand);
    if (*path != NULL && **path != '\0')
        return CT_OK;
    ct_error_at(call->statement, NULL, error, "%s which file?", ct_verb(call->statement));
    error_hint(error, "%s%s \"model.ct\"", ct_verb(call->statement), operand > 0 ? " NAME" : "");
    return CT_FAILED;
}

/* --- files of statements --- */

static ct_status command_source(Call *call, ct_error *error)
{
    Shell *shell = call->shell;
    const ct_statement *statement = call->statement;
    const char *name;
    ct_error inner;
    ct_status status = find_path(call, 0, &name, error);

    if (status != CT_OK)
        return status;
    if (shell->depth >= DEEPEST) {
        ct_error_at(statement, ct_operand(statement, 0), error, "files within files, %d deep",
                    DEEPEST);
        error_hint(error, "does '%s' lead back to itself?", name);
        return CT_FAILED;
    }

    char *path = file_next_to(shell->script, name);
    const bool is_first = shell->depth == 0 && ct_step_count(call->session) == 0;

    shell->depth++;
    status = replay_file(shell, path, &inner);
    shell->depth--;

    /* a model that a file makes alone is in that file */
    if (status == CT_OK && is_first)
        autosave_settle(shell->unsaved, call->session);
    if (status != CT_OK && inner.message[0] == '\0')
        *error = inner;
    else if (status != CT_OK)
        ct_error_at(statement, ct_operand(statement, 0), error, "%s", inner.message);
    free(path);
    return status;
}

/* whether a key that is a switch is on */
static ct_status read_switch(const Call *call, const char *key, bool *on, ct_error *error)
{
    const ct_expression *value = ct_key_value(call->statement, key);
    const char *word = value != NULL ? ct_expression_word(value) : "off";

    *on = word != NULL && strcmp(word, "on") == 0;
    if (*on || (word != NULL && strcmp(word, "off") == 0))
        return CT_OK;
    return ct_error_at(call->statement, value, error, "%s is on or off", key);
}

static ct_status report_unwritten(const Call *call, int operand, const ct_error *why,
                                  ct_error *error)
{
    const ct_status status = ct_error_at(call->statement, ct_operand(call->statement, operand),
                                         error, "%s", why->message);

    error_hint(error, "%s", why->hint);
    return status;
}

static ct_status command_save(Call *call, ct_error *error)
{
    const char *path;
    bool overwrite = false;
    ct_error why;
    struct stat info;
    ct_status status = find_path(call, 0, &path, error);

    if (status == CT_OK)
        status = read_switch(call, "overwrite", &overwrite, error);
    if (status != CT_OK)
        return status;

    char *script = ct_save(call->session);

    if (script == NULL)
        return ct_error_at(call->statement, NULL, error, "out of memory");
    if (saved_write(path, script, overwrite, &why) != CT_OK) {
        status = report_unwritten(call, 0, &why, error);
    } else if (stat(path, &info) == 0 && S_ISREG(info.st_mode))
        autosave_settle(call->shell->unsaved, call->session);
    ct_free(script);
    return status;
}

/* the definition of a subsystem, in a file of its own */
static ct_status command_store(Call *call, ct_error *error)
{
    const char *path;
    bool overwrite = false;
    char *text = NULL;
    ct_error why;
    ct_status status = find_path(call, 1, &path, error);

    if (status == CT_OK)
        status = read_switch(call, "overwrite", &overwrite, error);
    if (status == CT_OK)
        status = ct_store(call->session, call->statement, &text, error);
    if (status == CT_OK && stored_write(path, text, overwrite, &why) != CT_OK)
        status = report_unwritten(call, 1, &why, error);
    ct_free(text);
    return status;
}

static ct_status command_load(Call *call, ct_error *error)
{
    return ct_load(call->session, call->statement, error);
}

/* applied, or with `>` written */
static ct_status command_import(Call *call, ct_error *error)
{
    bool append;
    const bool is_written = ct_redirect(call->statement, &append) != NULL;
    char *text = NULL;
    ct_status status = ct_import(call->session, call->statement, is_written ? &text : NULL, error);

    if (status == CT_OK && is_written)
        write_text(call->out, text);
    ct_free(text);
    return status;
}

static ct_status command_record(Call *call, ct_error *error)
{
    Shell *shell = call->shell;
    const char *path;
    ct_status status = find_path(call, 0, &path, error);
    FILE *file = NULL;

    if (status != CT_OK)
        return status;
    if (strcmp(path, "off") != 0) {
        ct_error why;

        if (file_may_write(path, &why) != CT_OK)
            return ct_error_at(call->statement, ct_operand(call->statement, 0), error, "%s",
                               why.message);
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

/* --- what was left unsaved --- */

/* Apply the statements of a leftover; how many failed. A last line without an end was cut off. */
static int apply_leftover(Shell *shell, const Leftover *leftover, FILE *file)
{
    const char *outer = shell->script;
    char *line = NULL, *script = NULL;
    size_t room = 0;
    ssize_t length;
    Origin origin = {leftover->path, 0, 0};
    int failed = 0;

    while (!shell->quitting && (length = getline(&line, &room, file)) > 0 &&
           line[length - 1] == '\n') {
        line[length - 1] = '\0';
        origin.line++;

        const char *folder = autosave_folder(line);

        if (folder != NULL) {
            free(script);
            script = copy_format("%s/recovered", folder);
            shell->script = script;
        }
        failed += line[0] != '#' && shell_run_line(shell, &origin, line, false) != CT_OK;
    }
    shell->script = outer;
    free(script);
    free(line);
    return failed;
}

static ct_status recover(Call *call, Leftover *leftover, ct_error *error)
{
    Shell *shell = call->shell;
    FILE *file = fopen(leftover->path, "re");

    if (file == NULL)
        return ct_error_at(call->statement, NULL, error, "can't read '%s': %s", leftover->path,
                           strerror(errno));

    const int group = ct_begin_group(call->session);

    if (ct_step_count(call->session) > 0)
        ct_clear(call->session);
    shell->depth++;

    const int failed = apply_leftover(shell, leftover, file);

    shell->depth--;
    fclose(file);
    ct_end_group(call->session, group, "recover");
    autosave_follow(shell->unsaved, call->session, shell->script);
    if (failed > 0) {
        ct_error_at(call->statement, NULL, error, "%d of its %d statements failed", failed,
                    leftover->statements);
        error_hint(error, "they are all in '%s', which stays", leftover->path);
        return CT_FAILED;
    }
    remark("recovered: %d statement%s, the last of %s", leftover->statements,
           leftover->statements == 1 ? "" : "s", leftover->when);

    /* the file is deleted after this session has recorded the same statements */
    autosave_drop(leftover, autosave_is_kept(shell->unsaved));
    return CT_OK;
}

/* `recover`, `recover list`, `recover drop` */
static ct_status command_recover(Call *call, ct_error *error)
{
    const Shell *shell = call->shell;
    const char *word = call_word(call, 0);
    const int steps = ct_step_count(call->session);
    int count;
    Leftover *leftovers = autosave_find(&count);
    ct_status status = CT_OK;

    if (count == 0 && word != NULL) {
        write_text(call->out, "nothing was left unsaved");
    } else if (count == 0) {
        status = ct_error_at(call->statement, NULL, error, "nothing was left unsaved");
    } else if (word != NULL && strcmp(word, "list") == 0) {
        for (int i = 0; i < count; i++)
            fprintf(call->out, "%s  %d statement%s  %s\n", leftovers[i].when,
                    leftovers[i].statements, leftovers[i].statements == 1 ? "" : "s",
                    leftovers[i].path);
    } else if (word != NULL) {
        autosave_drop_all(leftovers, count, true);
        return CT_OK;
    } else if (autosave_is_kept(shell->unsaved) || (shell->unsaved == NULL && steps > 0)) {
        status = ct_error_at(call->statement, NULL, error, "the model that is here is not saved");
        error_hint(error, "save \"model.ct\" or clear, then recover");
    } else {
        status = recover(call, &leftovers[0], error);
    }
    autosave_drop_all(leftovers, count, false);
    return status;
}

/* --- back and forth --- */

static ct_status command_undo(Call *call, ct_error *error)
{
    return ct_undo(call->session, error);
}

static ct_status command_redo(Call *call, ct_error *error)
{
    return ct_redo(call->session, error);
}

/* Reports what it removes: undo restores statements, but not runs. */
static ct_status command_clear(Call *call, ct_error *error)
{
    const int steps = ct_step_count(call->session), runs = ct_run_count(call->session);

    (void)error;
    if (steps + runs > 0 && !call->shell->quiet)
        remark("cleared: a model of %d statement%s, which undo brings back, and %d run%s", steps,
               steps == 1 ? "" : "s", runs, runs == 1 ? "" : "s");
    ct_clear(call->session);
    return CT_OK;
}

static ct_status command_history(Call *call, ct_error *error)
{
    const Shell *shell = call->shell;

    (void)error;
    for (int i = 0; i < shell->history_count; i++)
        fprintf(call->out, "%5d  %s\n", i + 1, shell->history[i]);
    return CT_OK;
}

static ct_status command_set(Call *call, ct_error *error)
{
    const Settings old = call->shell->settings;
    const ct_status status = settings_apply(&call->shell->settings, call->statement, error);

    if (status == CT_OK && !call->shell->quiet)
        settings_report_dropped(&old, &call->shell->settings);
    return status;
}

static ct_status command_quit(Call *call, ct_error *error)
{
    (void)error;
    call->shell->quitting = true;
    return CT_OK;
}

const Command commands_session[] = {
    {"source", command_source, NULL, OWN},
    {"save", command_save, NULL, OWN},
    {"store", command_store, NULL, OWN},
    {"load", command_load, NULL, 0},
    {"import", command_import, NULL, 0},
    {"record", command_record, NULL, FORGOTTEN | OWN},
    {"recover", command_recover, NULL, FORGOTTEN | OWN},
    {"undo", command_undo, NULL, 0},
    {"redo", command_redo, NULL, 0},
    {"clear", command_clear, NULL, OWN},
    {"history", command_history, NULL, FORGOTTEN | OWN},
    {"quit", command_quit, NULL, FORGOTTEN | OWN},
    {"exit", command_quit, NULL, FORGOTTEN | OWN},
    {"set", command_set, settings_own, OWN},
    {NULL, NULL, NULL, 0},
};
