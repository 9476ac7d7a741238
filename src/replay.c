/* replay.c: lines run one after the other: scripts, standard input, -e, the prompt */
#include "replay.h"

#include "copy.h"
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
    else if (status != CT_OK)
        shell->failed++;
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

    error_say(&error, "stopped before this line");
    error.status = CT_STOPPED;
    complain(origin, "", &error);
    shell->failed++;
    return CT_STOPPED;
}

ct_status replay(Shell *shell, Reader *reader)
{
    bool typed = reader_is_prompt(reader);
    ct_status first = CT_OK;

    while (!shell->quitting) {
        char *text;
        Origin origin;
        ct_error error;
        bool mark = ct_run_count(shell->session) > 0 && ct_is_changed(shell->session);
        ReadResult result = reader_next(reader, mark, &text, &origin, &error);
        ct_status status = CT_OK;

        if (result == READ_END)
            break;
        if (result == READ_FAILED) {
            complain(&origin, "", &error);
            shell->failed++;
            status = CT_FAILED;
        } else if (typed && result == READ_LINE) {
            run_typed_line(shell, reader, &origin, text);
            interrupt_clear();
        } else if (!typed) {
            status =
                interrupt_asked() ? stopped(shell, &origin) : run_script_line(shell, &origin, text);
        }
        free(text);
        if (first == CT_OK)
            first = status;
        if (status == CT_STOPPED || result == READ_FAILED ||
            (status != CT_OK && !shell->keep_going))
            break;
    }
    reader_free(reader);
    return first;
}

ct_status replay_file(Shell *shell, const char *path, ct_error *error)
{
    bool piped = strcmp(path, "-") == 0;
    FILE *file = piped ? stdin : fopen(path, "re");
    struct stat info;

    *error = (ct_error){.status = CT_OK};
    if (file == NULL)
        return error_say(error, "can't read '%s': %s", path, strerror(errno));
    if (!piped && fstat(fileno(file), &info) == 0 && S_ISDIR(info.st_mode)) {
        fclose(file);
        return error_say(error, "can't read '%s': it is a folder", path);
    }
    const char *outer = shell->script;

    shell->script = piped ? NULL : path;

    ct_status status = replay(shell, reader_of_file(file, piped ? "<stdin>" : path));

    shell->script = outer;
    if (status != CT_OK)
        *error = (ct_error){.status = status};
    return status;
}
