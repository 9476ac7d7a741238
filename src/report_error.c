/* report_error.c: errors and remarks on standard error: position, line, caret, hint
 *
 *     arm.ct:3:1: error: unknown command 'plto'
 *         plto h8
 *         ^~~~
 *         hint: did you mean 'plot'?
 *
 * At the prompt the line is on the screen already: the caret is printed under it. */
#include "report_error.h"

#include "terminal.h"

#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    INDENT = 4,
    SHOWN = 160, /* bytes of a line that are shown at most */
    BEFORE = 60  /* of them, before the caret */
};

ct_status error_set(ct_error *error, const char *format, ...)
{
    va_list args;

    *error = (ct_error){.status = CT_FAILED};
    va_start(args, format);
    vsnprintf(error->message, sizeof error->message, format, args);
    va_end(args);
    return CT_FAILED;
}

void error_hint(ct_error *error, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    vsnprintf(error->hint, sizeof error->hint, format, args);
    va_end(args);
}

/* A line of prose; on a terminal it is broken between words, what follows set in. */
static void write_prose(const char *text, size_t length, int indent)
{
    int rows, columns, at = 0;

    terminal_size(&rows, &columns);
    if (!isatty(STDERR_FILENO))
        columns = INT_MAX;
    while (length > 0) {
        size_t blanks = strspn(text, " ");
        size_t n = blanks + strcspn(text + blanks, " \n");

        n = n < length ? n : length;

        int width = terminal_width(text, n);

        if (at > 0 && at + width >= columns) {
            fprintf(stderr, "\n%*s", indent, "");
            at = indent;
            text += blanks;
            length -= blanks;
            n -= blanks;
            width -= (int)blanks;
        }
        fwrite(text, 1, n, stderr);
        at += width;
        text += n;
        length -= n;
    }
    fputc('\n', stderr);
}

void remark(const char *format, ...)
{
    char *text = NULL;
    va_list args;

    fflush(stdout);
    va_start(args, format);

    int length = vasprintf(&text, format, args);

    va_end(args);
    if (length < 0)
        return;
    for (const char *line = text; *line != '\0';) {
        size_t n = strcspn(line, "\n");

        write_prose(line, n, INDENT);
        line += n + (line[n] == '\n');
    }
    free(text);
}

/* the physical line `number` of the text, counted from 0 */
static const char *find_line(const char *text, int number, size_t *length)
{
    while (number-- > 0 && strchr(text, '\n') != NULL)
        text = strchr(text, '\n') + 1;
    *length = strcspn(text, "\n");
    return text;
}

/* characters that would move the cursor are not for showing */
static void write_shown(const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)text[i];

        fputc((c < ' ' && c != '\t') || c == 0x7f ? '?' : c, stderr);
    }
}

/* blanks as wide as the text; its tabs remain tabs */
static void write_blank(const char *text, size_t length)
{
    for (size_t i = 0; i < length;) {
        int columns;
        int bytes = terminal_character(text + i, length - i, &columns);

        if (text[i] == '\t')
            fputc('\t', stderr);
        else
            fprintf(stderr, "%*s", columns, "");
        i += (size_t)bytes;
    }
}

static void write_caret(const char *text, size_t before, size_t width)
{
    write_blank(text, before);
    fputc('^', stderr);
    for (int i = terminal_width(text + before, width); i > 1; i--)
        fputc('~', stderr);
    fputc('\n', stderr);
}

/* a long line is cut on both sides, between characters */
static void cut(const char **line, size_t *length, size_t *before)
{
    size_t start = 0;

    if (*length <= SHOWN)
        return;
    if (*before > BEFORE)
        start = *before - BEFORE;
    while (start > 0 && ((unsigned char)(*line)[start] & 0xC0) == 0x80)
        start--;
    *line += start;
    *length -= start;
    *before -= start;
    if (*length > SHOWN)
        *length = SHOWN;
    while (*length > *before && ((unsigned char)(*line)[*length] & 0xC0) == 0x80)
        (*length)--;
}

/* where, what */
static void write_message(const Origin *origin, bool has_place, const ct_error *error)
{
    const char *kind = error->status == CT_STOPPED ? "" : "error: ";

    if (origin->name == NULL)
        remark("%s%s", kind, error->message);
    else if (has_place)
        remark("%s:%d:%d: %s%s", origin->name, error->line, error->column, kind, error->message);
    else
        remark("%s:%d: %s%s", origin->name, origin->line, kind, error->message);
}

/* the line of a definition where the error arose, as it is, the caret under it */
static void write_inside(const char *lines)
{
    while (*lines != '\0') {
        const size_t length = strcspn(lines, "\n");

        fprintf(stderr, "%*s", INDENT, "");
        write_shown(lines, length);
        fputc('\n', stderr);
        lines += length + (lines[length] == '\n');
    }
}

void report_error(const Origin *origin, const char *text, const ct_error *error)
{
    bool has_place =
        error->line >= origin->line && error->column > 0 && error->status != CT_STOPPED;
    size_t length = 0, before = 0, width = error->width > 0 ? (size_t)error->width : 1;
    const char *line = "";

    fflush(stdout);
    if (has_place) {
        line = find_line(text, error->line - origin->line, &length);
        before = (size_t)error->column - 1 < length ? (size_t)error->column - 1 : length;
        if (width > length - before)
            width = length - before;
    }

    /* under the line as it was typed, if it wasn't wrapped */
    bool under = has_place && origin->prompt > 0 && error->line == origin->line;

    if (under) {
        fprintf(stderr, "%*s", origin->prompt, "");
        write_caret(line, before, width);
    }
    write_message(origin, has_place, error);
    if (has_place && !under) {
        cut(&line, &length, &before);
        fprintf(stderr, "%*s", INDENT, "");
        write_shown(line, length);
        fprintf(stderr, "\n%*s", INDENT, "");
        write_caret(line, before, width < length - before ? width : length - before);
    }
    write_inside(error->inside);
    if (error->hint[0] != '\0')
        remark("%*shint: %s", under ? 0 : INDENT, "", error->hint);
}
