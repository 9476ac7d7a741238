/* complain.c: errors and remarks on standard error: where, the line, a caret, the way out
 *
 *     arm.ct:3:1: error: unknown command 'plto'
 *         plto h8
 *         ^~~~
 *         hint: did you mean 'plot'?
 *
 * At the prompt the line stands there already: the caret goes right under it. */
#include "complain.h"

#include "terminal.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum {
    INDENT = 4,
    SHOWN = 160, /* bytes of a line that are shown at most */
    BEFORE = 60  /* of them, before the caret */
};

ct_status error_say(ct_error *error, const char *format, ...)
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

void remark(const char *format, ...)
{
    va_list args;

    fflush(stdout);
    va_start(args, format);
    vfprintf(stderr, format, args);
    va_end(args);
    fputc('\n', stderr);
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
static void put_shown(const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)text[i];

        fputc((c < ' ' && c != '\t') || c == 0x7f ? '?' : c, stderr);
    }
}

/* blanks as wide as the text; its tabs stay tabs */
static void put_blank(const char *text, size_t length)
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

static void put_caret(const char *text, size_t before, size_t width)
{
    put_blank(text, before);
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

void complain(const Origin *origin, const char *text, const ct_error *error)
{
    const char *kind = error->status == CT_STOPPED ? "" : "error: ";
    bool has_place = error->line >= origin->line && error->column > 0 && *kind != '\0';
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
        put_caret(line, before, width);
    }
    if (origin->name != NULL)
        fprintf(stderr, "%s:%d:", origin->name, has_place ? error->line : origin->line);
    if (origin->name != NULL && has_place)
        fprintf(stderr, "%d:", error->column);
    fprintf(stderr, "%s%s%s\n", origin->name != NULL ? " " : "", kind, error->message);
    if (has_place && !under) {
        cut(&line, &length, &before);
        fprintf(stderr, "%*s", INDENT, "");
        put_shown(line, length);
        fprintf(stderr, "\n%*s", INDENT, "");
        put_caret(line, before, width < length - before ? width : length - before);
    }
    if (error->hint[0] != '\0')
        fprintf(stderr, "%*shint: %s\n", under ? 0 : INDENT, "", error->hint);
}
