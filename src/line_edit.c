/* line_edit.c: a line typed at a terminal: keys, history, completion (all of readline)
 *
 * Readline runs by callbacks below a loop of ours, so that Ctrl-C can drop a half-typed line in
 * whatever state the editor is. Signals are delivered only inside ppoll(), so none is missed.
 * Readline supports one terminal, and its callbacks have no context: hence the one static
 * struct. */
#include "line_edit.h"

#include "copy.h"
#include "file.h"
#include "interrupt.h"
#include "terminal.h"

#include <readline/history.h>
#include <readline/readline.h>

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { HISTORY_KEPT = 2000 };

static struct {
    ct_session *session;
    char *history_file; /* NULL: there is no place for one */
    char *line;         /* what readline handed over */
    bool done;
    bool at_once; /* keys were waiting at the start of the line: pasted, or typed ahead */
    int keys;     /* read since then */
    sigset_t wait;
    char **words; /* of the completion going on */
    size_t words_start;
} edit;

/* --- completion --- */

/* offset of the string that `line` leaves open before the cursor; false: none */
static bool find_open_string(const char *line, size_t cursor, size_t *start)
{
    bool open = false;

    for (size_t i = 0; i < cursor; i++)
        if (line[i] == '"') {
            open = !open;
            *start = i + 1;
        }
    return open;
}

static int compare_words(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* completions of a file name, sorted, as a list ended by NULL, like the words of ct_complete() */
static char **complete_file(const char *typed)
{
    char **words = NULL;
    size_t count = 0;
    char *word;

    rl_filename_completion_desired = 1;
    while ((word = rl_filename_completion_function(typed, count == 0 ? 0 : 1)) != NULL) {
        words = check_allocated(realloc(words, (count + 2) * sizeof *words));
        words[count++] = word;
        words[count] = NULL;
    }
    if (count > 0)
        qsort(words, count, sizeof *words, compare_words);
    return words;
}

/* length of the common prefix of all words */
static size_t common_length(char *const *words)
{
    size_t length = strlen(words[0]);

    for (int i = 1; words[i] != NULL; i++)
        for (size_t n = 0; n < length; n++)
            if (words[i][n] != words[0][n])
                length = n;
    return length;
}

/* Show the words in columns; readline counts from 1, the first being what they share. */
static void list_words(char **words, size_t shared)
{
    int count = 0, longest = 0;

    while (words[count] != NULL)
        count++;

    char **all = check_allocated(calloc((size_t)count + 2, sizeof *all));

    all[0] = copy_piece(words[0], shared);
    for (int i = 0; i < count; i++) {
        int length = (int)strlen(words[i]);

        all[i + 1] = words[i];
        longest = length > longest ? length : longest;
    }
    rl_crlf();
    rl_display_match_list(all, count, longest);
    free(all[0]);
    free(all);
    rl_forced_update_display();
}

/* a word that is complete is followed by a blank, unless something touches it */
static bool wants_blank(const char *word)
{
    size_t length = strlen(word);

    return length > 0 && strchr("=(.\"'/[", word[length - 1]) == NULL;
}

/* Insert the common prefix of all words; list the words if that adds nothing. */
static void offer(char **words, size_t start, bool in_string)
{
    size_t typed = (size_t)rl_point - start;
    size_t shared = common_length(words);
    bool alone = words[1] == NULL;

    if (shared > typed || alone) {
        rl_begin_undo_group();
        rl_delete_text((int)start, rl_point);
        rl_point = (int)start;

        char *piece = copy_piece(words[0], shared);

        rl_insert_text(piece);
        free(piece);
        if (alone && !in_string && wants_blank(words[0]) && rl_line_buffer[rl_point] != ' ')
            rl_insert_text(" ");
        rl_end_undo_group();
    } else {
        list_words(words, shared);
    }
}

static int on_tab(int count, int key)
{
    size_t start = 0;

    (void)count;
    (void)key;
    if (find_open_string(rl_line_buffer, (size_t)rl_point, &start)) {
        char *typed = copy_piece(rl_line_buffer + start, (size_t)rl_point - start);
        char **files = complete_file(typed);

        free(typed);
        if (files == NULL) {
            rl_ding();
            return 0;
        }
        offer(files, start, true);
        for (int i = 0; files[i] != NULL; i++)
            free(files[i]);
        free(files);
        return 0;
    }

    char **words = ct_complete(edit.session, rl_line_buffer, (size_t)rl_point, &start);

    if (words == NULL || words[0] == NULL || start > (size_t)rl_point)
        rl_ding();
    else
        offer(words, start, false);
    ct_words_free(words);
    return 0;
}

/* --- pasting --- */

/* Line ends of a pasted text become newlines, in place. Carriage return and newline are one end,
 * and so are two carriage returns where every end is twice there: a terminal has made them of the
 * others. */
static void settle_line_ends(char *text)
{
    bool doubled = true;
    size_t length = 0;

    for (const char *at = text; *at != '\0';) {
        const size_t run = strspn(at, "\r");

        doubled = doubled && (run % 2 == 0 || at[run] == '\n');
        at += run > 0 ? run : 1;
    }
    for (const char *at = text; *at != '\0'; at++) {
        const bool returns = *at == '\r';

        text[length++] = returns ? '\n' : *at;
        if (returns && (at[1] == '\n' || (doubled && at[1] == '\r')))
            at++;
    }
    text[length] = '\0';
}

/* Wait for a key; false: Ctrl-C, or nothing more can come. */
static bool wait_for_key(void)
{
    struct pollfd keys = {.fd = STDIN_FILENO, .events = POLLIN};
    int ready;

    do
        ready = ppoll(&keys, 1, NULL, &edit.wait);
    while (ready < 0 && errno == EINTR && !interrupt_asked());
    return ready > 0 && !interrupt_asked();
}

/* Insert a bracketed paste as one piece: readline's own function makes two line ends of a carriage
 * return with a newline. */
static int on_paste(int count, int key)
{
    static const char end[] = "\033[201~";
    const size_t end_length = sizeof end - 1;
    OutputBuffer paper;
    size_t length = 0;
    int c = 0;
    bool is_whole = false;

    (void)count;
    (void)key;
    output_buffer_open(&paper);
    while (!is_whole && wait_for_key() && (c = rl_read_key()) > 0) {
        putc(c, paper.out);
        length++;
        if (c == end[end_length - 1] && fflush(paper.out) == 0)
            is_whole = length >= end_length &&
                       memcmp(paper.text + length - end_length, end, end_length) == 0;
    }

    char *text = output_buffer_close(&paper);

    if (is_whole)
        text[length - end_length] = '\0';
    settle_line_ends(text);
    if (is_whole)
        rl_insert_text(text);
    free(text);
    return 0;
}

/* Without brackets a line end may be a carriage return, which ends the line, and a newline, which
 * would be a line of its own. */
static int on_newline(int count, int key)
{
    if (edit.at_once && edit.keys == 1 && rl_end == 0)
        return 0;
    return rl_newline(count, key);
}

static void bind_pasting(void)
{
    Keymap maps[] = {emacs_standard_keymap, vi_insertion_keymap, vi_movement_keymap};

    for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++) {
        rl_bind_key_in_map('\n', on_newline, maps[i]);
        if (maps[i] != vi_movement_keymap)
            rl_bind_keyseq_in_map("\033[200~", on_paste, maps[i]);
    }
}

/* --- history --- */

void line_edit_open(ct_session *session)
{
    edit.session = session;
    rl_readline_name = "cotree";
    rl_outstream = isatty(STDOUT_FILENO) ? stdout : stderr;
    rl_catch_signals = 0;
    rl_catch_sigwinch = 0;
    rl_initialize();
    rl_variable_bind("enable-bracketed-paste", terminal_is_dumb() ? "off" : "on");
    rl_bind_key('\t', on_tab);
    bind_pasting();
    using_history();

    /* with times in the file, an entry may have several lines */
    history_comment_char = '#';
    history_write_timestamps = 1;
    stifle_history(HISTORY_KEPT);
    if (!file_is_confined())
        edit.history_file = file_in_home("XDG_STATE_HOME", ".local/state", "history", true);
    if (edit.history_file != NULL)
        read_history(edit.history_file);
}

void line_edit_remember(const char *entry)
{
    HIST_ENTRY *last = history_length > 0 ? history_get(history_base + history_length - 1) : NULL;

    if (entry[strspn(entry, " \t\n")] == '\0' || (last != NULL && strcmp(last->line, entry) == 0))
        return;
    add_history(entry);
    if (edit.history_file != NULL && append_history(1, edit.history_file) != 0)
        write_history(edit.history_file);
}

void line_edit_close(void)
{
    if (edit.history_file != NULL)
        history_truncate_file(edit.history_file, HISTORY_KEPT);
    free(edit.history_file);
    edit.history_file = NULL;
    clear_history();
}

/* --- the loop --- */

static void on_line(char *line)
{
    edit.line = line;
    edit.done = true;
    rl_callback_handler_remove();
}

/* The terminal was lent to another program. */
static void take_back_terminal(void)
{
    rl_deprep_terminal();
    rl_prep_terminal(1);
    rl_reset_screen_size();
    rl_forced_update_display();
}

static ReadResult drop_line(void)
{
    /* below a line of several rows */
    if (!RL_ISSTATE(RL_STATE_ISEARCH | RL_STATE_NSEARCH)) {
        rl_point = rl_end;
        rl_redisplay();
    }
    fputs(interrupt_ending() ? "\n" : "^C\n", rl_outstream);
    rl_callback_sigcleanup();
    rl_free_line_state();
    rl_replace_line("", 1);
    rl_point = 0;
    rl_callback_handler_remove();
    fflush(rl_outstream);
    return interrupt_ending() ? READ_END : READ_CLEARED;
}

ReadResult line_edit_read(const char *prompt, char **line)
{
    struct pollfd keys = {.fd = STDIN_FILENO, .events = POLLIN};
    ReadResult result = READ_LINE;

    *line = NULL;
    edit.line = NULL;
    edit.done = false;
    edit.at_once = poll(&keys, 1, 0) > 0;
    edit.keys = 0;
    fflush(stdout);
    if (interrupt_resized())
        rl_reset_screen_size();
    interrupt_hold(&edit.wait);
    rl_callback_handler_install(prompt, on_line);
    while (!edit.done && result == READ_LINE) {
        /* a paste may have been cancelled meanwhile */
        int ready = interrupt_asked() ? 0 : ppoll(&keys, 1, NULL, &edit.wait);

        if (interrupt_asked())
            result = drop_line();
        else if (interrupt_continued())
            take_back_terminal();
        else if (interrupt_resized())
            rl_resize_terminal();
        else if (ready > 0) {
            edit.keys++;
            rl_callback_read_char();
        } else if (ready < 0 && errno != EINTR)
            result = READ_END;
    }
    interrupt_release(&edit.wait);
    interrupt_clear();
    if (result != READ_LINE)
        return result;
    if (edit.line == NULL) {
        fputc('\n', rl_outstream);
        return READ_END;
    }
    *line = edit.line;
    return READ_LINE;
}
