/* replay.c: lines run one after the other: scripts, standard input, -e, the prompt */
#include "replay.h"

#include "copy.h"
#include "file.h"
#include "interrupt.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static ct_status run_script_line(Shell *shell, const Origin *origin, const char *text)
{
    ct_status status = shell_run_line(shell, origin, text, false);

    if (status == CT_UNMET)
        shell->unmet++;
    else if (status != CT_OK) {
        shell->failed++;
        shell->unsolved += shell->is_unsolved;
    }
    return status;
}

static void run_typed_line(Shell *shell, Reader *reader, const Origin *origin, const char *text)
{
    if (shell_run_line(shell, origin, text, true) == CT_OK)
        return;

    int dropped = reader_drop_pasted(reader);

    if (dropped > 0)
        remark("the rest of what was pasted (%d line%s) was not run", dropped,
               dropped == 1 ? "" : "s");
}

static ct_status stopped(Shell *shell, const Origin *origin)
{
    ct_error error;

    error_set(&error, "stopped before this line");
    error.status = CT_STOPPED;
    report_error(origin, "", &error);
    shell->failed++;
    return CT_STOPPED;
}

/* --- definitions that are open --- */

static const char *prompt(const Shell *shell)
{
    const char *defining = ct_defining(shell->session);

    if (defining != NULL)
        return defining;
    return ct_run_count(shell->session) > 0 && ct_is_changed(shell->session) ? "ct*" : "ct";
}

static void drop_definition(Shell *shell)
{
    if (ct_defining(shell->session) == NULL)
        return;
    remark("the definition of %s is dropped", ct_defining(shell->session));
    ct_drop_definition(shell->session);
}

/* Whether a statement of the line starts with the word. In a definition that can't be parsed, only
 * this identifies the first and last line. */
static bool has_statement(const char *text, const char *word)
{
    for (;;) {
        text += strspn(text, " \t;");
        if (strcspn(text, " \t\n;#") == strlen(word) && strncmp(text, word, strlen(word)) == 0)
            return true;
        text += strcspn(text, ";#");
        if (*text != ';')
            return false;
    }
}

/* If a script continues after a definition whose first line failed, the definition's lines must not
 * be added to the model. */
static ct_status run_or_drop_line(Shell *shell, const Origin *origin, const char *text)
{
    const bool opened = ct_defining(shell->session) != NULL;
    ct_status status;

    if (shell->dropping == 0) {
        status = run_script_line(shell, origin, text);
        if (status != CT_OK && shell->keep_going &&
            opened == (ct_defining(shell->session) != NULL) && has_statement(text, "subsystem") &&
            !has_statement(text, "end"))
            shell->dropping = origin->line;
        return status;
    }
    if (has_statement(text, "end")) {
        remark("what follows line %d up to 'end' in line %d is that definition's, and dropped",
               shell->dropping, origin->line);
        shell->dropping = 0;
    }
    return CT_OK;
}

/* The end of a file ends the definitions that it started; -e and the prompt may continue them. */
static ct_status end_of_lines(Shell *shell, const Reader *reader, const Origin *origin, bool opened)
{
    ct_error error;

    if (!reader_is_file(reader))
        return CT_OK;
    if (shell->dropping > 0) {
        error_set(&error, "the definition that begins in line %d has no 'end'", shell->dropping);
        report_error(origin, "", &error);
        shell->dropping = 0;
        shell->failed++;
        return CT_FAILED;
    }
    if (ct_defining(shell->session) == NULL || opened)
        return CT_OK;
    error_set(&error, "the definition of %s has no 'end'", ct_defining(shell->session));
    report_error(origin, "", &error);
    ct_drop_definition(shell->session);
    shell->failed++;
    shell->stopped_at = origin->line;
    return CT_FAILED;
}

ct_status replay(Shell *shell, Reader *reader)
{
    bool typed = reader_is_prompt(reader);
    const bool opened = ct_defining(shell->session) != NULL;
    ct_status first = CT_OK, status = CT_OK;

    if (reader_is_file(reader))
        shell->dropping = 0;
    while (!shell->quitting) {
        char *text;
        Origin origin;
        ct_error error;
        ReadResult result = reader_next(reader, prompt(shell), &text, &origin, &error);

        status = CT_OK;
        if (typed && result == READ_CLEARED)
            drop_definition(shell);
        if (result == READ_END) {
            status = end_of_lines(shell, reader, &origin, opened);
            break;
        }
        if (result == READ_FAILED) {
            report_error(&origin, "", &error);
            shell->failed++;
            status = CT_FAILED;
        } else if (typed && result == READ_LINE) {
            run_typed_line(shell, reader, &origin, text);
            interrupt_clear();
        } else if (!typed) {
            status = interrupt_asked() ? stopped(shell, &origin)
                                       : run_or_drop_line(shell, &origin, text);
        }
        free(text);
        if (first == CT_OK)
            first = status;
        if (status != CT_OK)
            shell->stopped_at = origin.line;
        if (status == CT_STOPPED || result == READ_FAILED ||
            (status != CT_OK && !shell->keep_going))
            break;
    }
    if (first == CT_OK)
        first = status;
    if (first != CT_OK && !typed && !shell->keep_going)
        ct_drop_definition(shell->session);
    if (reader_is_file(reader))
        shell->dropping = 0;
    reader_free(reader);
    return first;
}

/* The file is one undo step, also if it ended early: then a message reports what was executed, if
 * the session `goes_on`. */
static void end_file(Shell *shell, const char *path, int group, bool goes_on, ct_status status)
{
    char *called = copy_format("source \"%s\"", path);
    const int count = ct_end_group(shell->session, group, called);
    const char *plural = count == 1 ? "" : "s";

    free(called);
    if (status == CT_OK || !goes_on)
        return;
    if (count == 0)
        remark("%s ended at line %d: nothing of it changed the model", path, shell->stopped_at);
    else if (shell->keep_going && status != CT_STOPPED)
        remark("%s: what did not fail stands (%d statement%s); undo takes that back", path, count,
               plural);
    else
        remark("%s ended at line %d: what it made before (%d statement%s) stands; undo takes that "
               "back",
               path, shell->stopped_at, count, plural);
}

ct_status replay_file(Shell *shell, const char *path, ct_error *error)
{
    bool piped = strcmp(path, "-") == 0;
    struct stat info;

    *error = (ct_error){.status = CT_OK};

    /* what the user names may be read, and what lies around it */
    if (file_is_confined() && !piped && shell->depth == 0)
        file_confine(path);
    else if (!piped && file_may_read(path, error) != CT_OK)
        return CT_FAILED;

    FILE *file = piped ? stdin : fopen(path, "re");

    if (file == NULL)
        return error_set(error, "can't read '%s': %s", path, strerror(errno));
    if (!piped && fstat(fileno(file), &info) == 0 && S_ISDIR(info.st_mode)) {
        fclose(file);
        return error_set(error, "can't read '%s': it is a folder", path);
    }
    const char *outer = shell->script;

    shell->script = piped ? NULL : path;

    /* typed lines go back one by one, a file as a whole */
    const int group = piped ? 0 : ct_begin_group(shell->session);
    ct_status status = replay(shell, reader_of_file(file, piped ? "<stdin>" : path));

    if (!piped)
        end_file(shell, path, group, shell->depth == 1 && (outer == NULL || shell->keep_going),
                 status);
    shell->script = outer;
    if (file_is_confined() && shell->depth == 0)
        file_confine(NULL);
    if (status != CT_OK)
        *error = (ct_error){.status = status};
    return status;
}
