/* command_draw.c: `draw` and `animate`: the linear graph and the mechanism
 *
 * The library draws. It returns text for a terminal, a finished file, or, for a bitmap or a window,
 * commands for gnuplot. */
#include "copy.h"
#include "drawing.h"
#include "file.h"
#include "interrupt.h"
#include "terminal.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* --- files --- */

static bool is_one_of(const char *type, const char *types)
{
    const size_t length = strlen(type);

    for (const char *at = types; (at = strstr(at, type)) != NULL && length > 0; at += length)
        if ((at == types || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0'))
            return true;
    return false;
}

static ct_status write_file(const Call *call, const char *path, const char *text, size_t length,
                            ct_error *error)
{
    ct_error why;

    if (file_write(path, text, length, false, &why) == CT_OK)
        return CT_OK;
    return ct_error_at(call->statement, NULL, error, "%s", why.message);
}

/* An error unless the file after `>` is of one of these types and may be written. */
static ct_status check_file(const Call *call, const char *types, const char **path, ct_error *error)
{
    bool append = false;
    ct_error why;

    *path = ct_redirect(call->statement, &append);
    if (*path == NULL)
        return CT_OK;
    if (append)
        return ct_error_at(call->statement, NULL, error,
                           "a picture can't be appended to another: '>' writes it anew");
    if (!is_one_of(file_extension(*path), types)) {
        ct_error_at(call->statement, NULL, error, "this goes to a file that ends in one of: %s",
                    types);
        error_hint(error, "the name's ending says the format");
        return CT_FAILED;
    }
    if (file_may_write(*path, &why) != CT_OK)
        return ct_error_at(call->statement, NULL, error, "%s", why.message);
    return CT_OK;
}

/* --- the mechanism --- */

static ct_paper text_output_buffer(void)
{
    ct_paper paper = {.format = "text", .columns = 79, .rows = 30};

    if (isatty(STDOUT_FILENO)) {
        terminal_size(&paper.rows, &paper.columns);
        paper.columns = paper.columns > 20 ? paper.columns - 1 : 20;
        paper.rows = paper.rows > 10 ? paper.rows - 2 : 8;
    }
    return paper;
}

typedef struct Frames {
    char **texts; /* gnuplot's commands of each, ended by NULL */
} Frames;

static void write_frames(FILE *out, const Drawing *drawing)
{
    const Frames *frames = drawing->of;

    for (int i = 0; frames->texts[i] != NULL; i++) {
        fputs(frames->texts[i], out);

        /* a file of pictures has its own clock */
        if (drawing->interval > 0 && frames->texts[i + 1] != NULL)
            fprintf(out, "if (GPVAL_TERM ne 'gif') pause %.4g\n", drawing->interval);
    }
}

/* What the library drew, on the paper it was drawn for, to where it is to go. */
static ct_status write_drawn(Call *call, const ct_paper *paper, char *drawn, const char *path,
                             ct_error *error)
{
    char *texts[2] = {drawn, NULL};
    const Frames frames = {texts};
    const Drawing drawing = {.put = write_frames,
                             .of = &frames,
                             .title = "",
                             .width = paper->width,
                             .height = paper->height};

    if (strcmp(paper->format, "gnuplot") == 0)
        return drawing_make(call, &drawing, path, error);
    if (path != NULL)
        return write_file(call, path, drawn, strlen(drawn), error);
    write_text(call->out, drawn);
    return CT_OK;
}

static ct_status command_draw(Call *call, ct_error *error)
{
    const char *word = call_word(call, 0);
    const char *path;
    char *drawn = NULL;
    bool graph = word == NULL || strcmp(word, "mechanism") != 0;
    ct_status status = check_file(
        call, graph ? "svg png pdf eps gp dot gv txt" : "svg png pdf eps gp txt", &path, error);

    if (status != CT_OK)
        return status;

    const char *type = path != NULL ? file_extension(path) : "";
    ct_paper paper = text_output_buffer();

    /* on a screen the whole graph is shown as text, which shows its trees best */
    if (is_one_of(type, "dot gv"))
        paper.format = "dot";
    else if (strcmp(type, "svg") == 0)
        paper.format = "svg";
    else if (path != NULL ? strcmp(type, "txt") != 0 : word != NULL && drawing_in_window(call))
        paper.format = "gnuplot";
    status = ct_draw(call->session, call->statement, &paper, &drawn, error);
    if (status == CT_OK)
        status = write_drawn(call, &paper, drawn, path, error);
    ct_free(drawn);
    return status;
}

/* --- animate --- */

static int line_count(const char *text)
{
    int count = 0;

    for (; *text != '\0'; text++)
        count += *text == '\n';
    return count;
}

/* Wait, unless Ctrl-C comes; false then. Another signal, as of a new size, ends the wait early. */
static bool wait_for(double seconds)
{
    struct timespec rest = {(time_t)seconds, (long)((seconds - (double)(time_t)seconds) * 1e9)};

    if (!interrupt_asked())
        (void)nanosleep(&rest, NULL);
    return !interrupt_asked();
}

static bool terminal_moves(void)
{
    return isatty(STDOUT_FILENO) && !terminal_is_dumb();
}

static bool fits(const ct_paper *paper)
{
    const ct_paper now = text_output_buffer();

    return now.columns == paper->columns && now.rows == paper->rows;
}

/* Draw the pictures one over the other; the last one remains, and only that is written to a file or
 * a pipe. Returns the frame to continue with, redrawn, when the size of the terminal has changed;
 * -1: finished. */
static int show_frames(Call *call, char *const *frames, const ct_paper *paper, int first,
                       double interval)
{
    const bool moves = terminal_moves();
    const char *last = frames[0];

    for (int i = 0; frames[i] != NULL; i++) {
        last = frames[i];
        if (!moves || i < first)
            continue;
        if (!fits(paper))
            return i;
        for (const char *line = last; *line != '\0'; line += strcspn(line, "\n") + 1)
            printf("\r%.*s\033[K\n", (int)strcspn(line, "\n"), line);
        printf("\033[%dA", line_count(last));
        fflush(stdout);
        if (!wait_for(interval))
            break;
    }
    interrupt_clear();
    write_text(call->out, last);
    return -1;
}

static ct_status command_animate(Call *call, ct_error *error)
{
    const char *path;
    ct_status status = check_file(call, "html svg gif", &path, error);
    char **texts = NULL;
    double interval;

    if (status != CT_OK)
        return status;

    const char *type = path != NULL ? file_extension(path) : "";
    ct_paper paper = text_output_buffer();

    if (is_one_of(type, "html svg"))
        paper.format = type;
    else if (path != NULL || drawing_in_window(call))
        paper.format = "gnuplot";
    status = ct_animate(call->session, call->statement, &paper, &texts, &interval, error);
    if (status != CT_OK)
        return status;
    if (strcmp(paper.format, "gnuplot") == 0) {
        const Frames frames = {texts};
        const Drawing drawing = {.put = write_frames,
                                 .of = &frames,
                                 .title = "",
                                 .width = paper.width,
                                 .height = paper.height,
                                 .interval = interval};

        status = drawing_make(call, &drawing, path, error);
    } else if (path != NULL) {
        status = write_file(call, path, texts[0], strlen(texts[0]), error);
    } else {
        int next = show_frames(call, texts, &paper, 0, interval);

        while (next >= 0 && status == CT_OK) {
            ct_words_free(texts);
            texts = NULL;
            fputs("\r\033[J", stdout);
            paper = text_output_buffer();
            status = ct_animate(call->session, call->statement, &paper, &texts, &interval, error);
            if (status == CT_OK)
                next = show_frames(call, texts, &paper, next, interval);
        }
    }
    ct_words_free(texts);
    return status;
}

const Command commands_draw[] = {
    {"draw", command_draw, NULL, WRITES},
    {"animate", command_animate, NULL, WRITES | UNPAGED},
    {NULL, NULL, NULL, 0},
};
