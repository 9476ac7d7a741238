/* shell.c: execution of statements
 *
 * A line is read statement by statement. Output of a command is collected first and written to the
 * screen, the pager or a file when the command has succeeded; so a failing statement prints only
 * its error. */
#include "shell.h"

#include "command.h"
#include "copy.h"
#include "file.h"
#include "interrupt.h"
#include "pager.h"
#include "terminal.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool hook_stop(void *context)
{
    (void)context;
    return interrupt_asked();
}

static void hook_progress(void *context, const char *phase, double fraction)
{
    Shell *shell = context;

    progress_show(&shell->progress, phase, fraction);
}

/* as in `source`: in the folder of the script that names it, if it is there */
static char *hook_find_file(void *context, const char *name)
{
    const Shell *shell = context;
    char *path = file_next_to(shell->script, name);
    ct_error why;

    /* the library reports a missing file */
    if (access(path, F_OK) == 0 && file_may_read(path, &why) != CT_OK) {
        free(path);
        return NULL;
    }
    return path;
}

static char *text_of(const ct_error *error)
{
    return copy_text(error->message);
}

/* a file of rows is one to be written: a --safe session has none */
static char *hook_append(void *context, const char *name, const char *bytes, size_t length)
{
    ct_error why;

    (void)context;
    return file_write(name, bytes, length, true, &why) == CT_OK ? NULL : text_of(&why);
}

static char *hook_content(void *context, const char *name, char **why)
{
    char *text = NULL;
    ct_error error;

    (void)context;
    if (file_may_write(name, &error) != CT_OK ||
        (access(name, F_OK) == 0 && file_read(name, &text, &error) != CT_OK))
        *why = text_of(&error);
    return text;
}

static const char *const *hook_setting(void *context, int i)
{
    (void)context;
    return settings_words(i);
}

/* Set the library's page width to the screen's; 0: text isn't wrapped. */
static void set_width(Shell *shell, int columns)
{
    ct_hooks hooks = {.context = shell,
                      .stop = hook_stop,
                      .progress = hook_progress,
                      .find_file = hook_find_file,
                      .append = hook_append,
                      .content = hook_content,
                      .setting = hook_setting,
                      .unicode = shell->unicode,
                      .columns = columns,
                      .units = shell->settings.units};

    ct_session_hooks(shell->session, &hooks);
}

void shell_open(Shell *shell, FindCommand *find)
{
    *shell = (Shell){.find = find, .unicode = terminal_is_utf8()};
    settings_start(&shell->settings);
    shell->session = check_allocated(ct_session_new(NULL));
    set_width(shell, 0);
}

void shell_close(Shell *shell)
{
    if (shell->record != NULL)
        fclose(shell->record);
    for (int i = 0; i < shell->history_count; i++)
        free(shell->history[i]);
    free(shell->history);
    free(shell->last_plot);
    autosave_close(shell->unsaved);
    gnuplot_close(shell->gnuplot);
    ct_session_free(shell->session);
}

/* --- output to its destination --- */

static const char *find_redirect(const ct_statement *statement)
{
    bool append;

    return ct_redirect(statement, &append);
}

static ct_status write_redirect(const ct_statement *statement, const char *text, size_t length,
                                ct_error *error)
{
    bool append;
    const char *path = ct_redirect(statement, &append);
    ct_error why;

    if (file_write(path, text, length, append, &why) == CT_OK)
        return CT_OK;
    return ct_error_at(statement, NULL, error, "%s", why.message);
}

static ct_status write_on_screen(Shell *shell, const char *text, size_t length, bool paged,
                                 ct_error *error)
{
    pager_show(text, length, paged);
    if (fflush(stdout) == 0 && !ferror(stdout))
        return CT_OK;
    clearerr(stdout);

    /* the reader closed the pipe: no message */
    if (errno == EPIPE) {
        shell->quitting = true;
        shell->failed++;
        return CT_OK;
    }
    return error_set(error, "can't write the results: %s", strerror(errno));
}

/* --- one statement --- */

/* a statement of the model; others have no command */
static ct_status build(Shell *shell, const ct_statement *statement, ct_error *error)
{
    if (find_redirect(statement) != NULL)
        return ct_error_at(statement, NULL, error, "'%s' prints nothing to write to a file",
                           ct_verb(statement));

    ct_status status = ct_apply(shell->session, statement, error);

    if (status == CT_NOT_MINE)
        return ct_error_at(statement, NULL, error, "nobody carries out '%s'", ct_verb(statement));
    return status;
}

static ct_status command(Shell *shell, const Command *row, const ct_statement *statement,
                         ct_error *error)
{
    const char *file = find_redirect(statement);
    OutputBuffer paper;
    int rows, columns;

    /* lines are broken for a screen only: files and pipes are for programs */
    terminal_size(&rows, &columns);
    columns = file == NULL && isatty(STDOUT_FILENO) ? columns : 0;
    set_width(shell, columns);
    output_buffer_open(&paper);

    Call call = {shell, shell->session, statement, paper.out, columns};
    ct_status status = row->run(&call, error);
    char *text = output_buffer_close(&paper);

    progress_end(&shell->progress);
    if (status == CT_OK && file != NULL && (row->flags & WRITES) == 0)
        status = write_redirect(statement, text, paper.length, error);
    else if (status == CT_OK && paper.length > 0)
        status = write_on_screen(
            shell, text, paper.length,
            shell->interactive && shell->settings.pager && (row->flags & UNPAGED) == 0, error);
    free(text);
    return status;
}

/* a line at a time; in quiet sessions warnings alone */
static void write_remarks(const Shell *shell)
{
    static const char warning[] = "warning: ";

    for (const char *line = ct_remarks(shell->session); *line != '\0';) {
        size_t length = strcspn(line, "\n");

        if (!shell->quiet || strncmp(line, warning, sizeof warning - 1) == 0)
            remark("%.*s", (int)length, line);
        line += length + (line[length] == '\n');
    }
}

/* Add an accepted statement to the history and the recording. */
static ct_status keep(Shell *shell, const ct_statement *statement, ct_error *error)
{
    const char *text = ct_statement_text(statement);
    size_t room = sizeof *shell->history * ((size_t)shell->history_count + 1);

    shell->history = check_allocated(realloc(shell->history, room));
    shell->history[shell->history_count++] = copy_text(text);
    if (shell->record == NULL)
        return CT_OK;
    if (fprintf(shell->record, "%s\n", text) > 0 && fflush(shell->record) == 0)
        return CT_OK;

    /* the statement itself took effect */
    fclose(shell->record);
    shell->record = NULL;
    return error_set(error, "can't record any more: %s", strerror(errno));
}

/* what helps, or leaves, at any time */
static bool is_for_reader(const ct_statement *statement)
{
    const char *verb = ct_verb(statement);

    return strcmp(verb, "help") == 0 || strcmp(verb, "quit") == 0 || strcmp(verb, "exit") == 0 ||
           strcmp(verb, "complete") == 0;
}

static ct_status carry_out(Shell *shell, const ct_statement *statement, ct_error *error)
{
    /* lines of a definition are its own, whoever carries them out elsewhere */
    const Command *row = ct_defining(shell->session) == NULL || is_for_reader(statement)
                             ? shell->find(statement)
                             : NULL;
    int depth = shell->depth;

    progress_begin(&shell->progress, !shell->quiet);

    ct_status status =
        row != NULL ? command(shell, row, statement, error) : build(shell, statement, error);

    progress_end(&shell->progress);
    if ((status == CT_OK || status == CT_STOPPED) && (row == NULL || (row->flags & OWN) == 0))
        write_remarks(shell);
    autosave_follow(shell->unsaved, shell->session, shell->script);
    if (status == CT_OK && depth == 0 && (row == NULL || (row->flags & FORGOTTEN) == 0))
        status = keep(shell, statement, error);
    return status;
}

/* --- verbs that precede a statement or need a line of their own --- */

static ct_status command_time(Call *call, ct_error *error)
{
    const double began = ct_clock();
    const ct_status status = carry_out(call->shell, ct_rest(call->statement), error);

    remark("time: %.3g s", ct_clock() - began);
    return status;
}

/* what Tab would offer */
static ct_status command_complete(Call *call, ct_error *error)
{
    const char *line = call_word(call, 0);
    size_t start;
    char **words = ct_complete(call->session, line, strlen(line), &start);

    (void)error;
    for (int i = 0; words != NULL && words[i] != NULL; i++)
        write_text(call->out, words[i]);
    ct_words_free(words);
    return CT_OK;
}

const Command commands_shell[] = {
    {"time", command_time, NULL, FORGOTTEN | OWN},
    {"complete", command_complete, NULL, FORGOTTEN | OWN | UNPAGED},
    {NULL, NULL, NULL, 0},
};

/* --- a line --- */

/* the next statement of a logical line */
static ct_status run_next(Shell *shell, const Origin *origin, ct_cursor *line, bool shortened)
{
    ct_statement *statement = NULL;
    ct_error error = {.status = CT_OK};

    ct_status status = ct_parse(line, shortened, &statement, &error);

    if (status == CT_OK && !ct_statement_is_empty(statement))
        status = carry_out(shell, statement, &error);

    /* an error in another file was reported there, without message here: name the statement that
     * led to it */
    if (status != CT_OK && error.message[0] != '\0') {
        shell->is_unsolved = error.is_unsolved;
        report_error(origin, line->text, &error);
    }
    if (status != CT_OK && error.message[0] == '\0' && origin->name != NULL)
        remark("%s:%d: in %s", origin->name, origin->line, ct_statement_text(statement));
    ct_statement_free(statement);
    return status;
}

/* after Ctrl-C between statements of a line */
static ct_status stop_line(const Origin *origin, const char *text)
{
    ct_error error;

    error_set(&error, "the rest of the line was not run");
    error.status = CT_STOPPED;
    report_error(origin, text, &error);
    return CT_STOPPED;
}

ct_status shell_run_line(Shell *shell, const Origin *origin, const char *text, bool shortened)
{
    ct_cursor line = {.text = text, .line = origin->line};
    ct_status status = CT_OK;

    while (status == CT_OK) {
        line.next += strspn(text + line.next, " \t;");
        if (text[line.next] == '\0' || shell->quitting)
            break;
        status =
            interrupt_asked() ? stop_line(origin, text) : run_next(shell, origin, &line, shortened);
    }
    return status;
}
