/* reader.c: logical lines, from a file, a pipe, a string or the prompt */
#include "reader.h"

#include "copy.h"
#include "interrupt.h"
#include "line_edit.h"
#include "terminal.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct Reader {
    FILE *file;       /* NULL: text or prompt */
    const char *text; /* what is left of it; NULL: file or prompt */
    const char *name; /* NULL: prompt */
    int line;         /* of the last physical line */
    char *pasted;     /* a block with newlines, typed as one; NULL */
    size_t pasted_at; /* what was taken of it */
};

Reader *reader_of_file(FILE *file, const char *name)
{
    Reader *reader = copy_check(calloc(1, sizeof *reader));

    reader->file = file;
    reader->name = name;
    return reader;
}

Reader *reader_of_text(const char *text, const char *name)
{
    Reader *reader = copy_check(calloc(1, sizeof *reader));

    reader->text = text;
    reader->name = name;
    return reader;
}

Reader *reader_of_prompt(void)
{
    return copy_check(calloc(1, sizeof(Reader)));
}

void reader_free(Reader *reader)
{
    if (reader == NULL)
        return;
    if (reader->file != NULL && reader->file != stdin)
        fclose(reader->file);
    free(reader->pasted);
    free(reader);
}

bool reader_is_prompt(const Reader *reader)
{
    return reader->name == NULL;
}

/* --- physical lines --- */

static ReadResult read_file(Reader *reader, char **line, ct_error *error)
{
    size_t room = 0;

    *line = NULL;
    errno = 0;

    ssize_t length = getline(line, &room, reader->file);

    if (length < 0) {
        free(*line);
        *line = NULL;
        if (interrupt_asked())
            return READ_CLEARED;
        if (!ferror(reader->file))
            return READ_END;
        error_say(error, "can't read: %s", strerror(errno));
        return READ_FAILED;
    }
    if (strlen(*line) != (size_t)length) {
        error_say(error, "the line holds a zero byte, so this is no script");
        return READ_FAILED;
    }
    return READ_LINE;
}

/* the next line of a text; false at its end */
static bool cut_line(const char *text, size_t *at, char **line)
{
    if (text[*at] == '\0')
        return false;

    size_t length = strcspn(text + *at, "\n");

    *line = copy_piece(text + *at, length);
    *at += length + (text[*at + length] == '\n');
    return true;
}

static ReadResult read_prompt(Reader *reader, bool mark, bool more, char **line, int *prompt)
{
    /* what was pasted first */
    if (reader->pasted != NULL) {
        if (cut_line(reader->pasted, &reader->pasted_at, line))
            return READ_LINE;
        free(reader->pasted);
        reader->pasted = NULL;
    }

    const char *text = more ? "..> " : mark ? "ct*> " : "ct> ";
    ReadResult result = line_edit_read(text, line);

    *prompt = (int)strlen(text);
    if (result == READ_LINE && strchr(*line, '\n') != NULL) {
        line_edit_remember(*line);
        reader->pasted = *line;
        reader->pasted_at = 0;
        if (!cut_line(reader->pasted, &reader->pasted_at, line))
            *line = copy_text("");
    }
    return result;
}

static ReadResult read_physical(Reader *reader, bool mark, bool more, char **line, int *prompt,
                                ct_error *error)
{
    ReadResult result = READ_LINE;

    *line = NULL;
    if (reader->file != NULL) {
        result = read_file(reader, line, error);
    } else if (reader->text != NULL) {
        size_t at = 0;

        if (!cut_line(reader->text, &at, line))
            result = READ_END;
        reader->text += at;
    } else {
        result = read_prompt(reader, mark, more, line, prompt);
    }
    if (result == READ_LINE || result == READ_FAILED)
        reader->line++;
    return result;
}

/* --- logical lines --- */

/* The line's end is taken off; a backslash there goes on, unless a comment took it. Blanks behind
 * the backslash are taken off too, since nobody sees them. */
static bool goes_on(char *line)
{
    size_t length = strlen(line), last;
    bool in_string = false;

    while (length > 0 && strchr("\r\n", line[length - 1]) != NULL)
        line[--length] = '\0';
    for (size_t i = 0; i < length; i++) {
        if (line[i] == '"')
            in_string = !in_string;
        if (line[i] == '#' && !in_string)
            return false;
    }
    for (last = length; last > 0 && strchr(" \t", line[last - 1]) != NULL; last--)
        continue;
    if (last == 0 || line[last - 1] != '\\')
        return false;
    line[last] = '\0';
    return true;
}

static void join(char **text, const char *line)
{
    char *joined = *text == NULL ? copy_text(line) : copy_format("%s\n%s", *text, line);

    free(*text);
    *text = joined;
}

/* An editor's byte order mark is not part of the first statement. */
static size_t mark_length(const Reader *reader, const char *line)
{
    return reader->line == 1 && strncmp(line, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
}

ReadResult reader_next(Reader *reader, bool mark, char **text, Origin *origin, ct_error *error)
{
    ReadResult result;
    char *line = NULL;
    int prompt = 0;
    bool more = false;

    *text = NULL;
    if (reader_is_prompt(reader) && reader->pasted == NULL)
        reader->line = 0;
    *origin = (Origin){reader->name, reader->line + 1, 0};
    do {
        result = read_physical(reader, mark, more, &line, &prompt, error);
        if (result != READ_LINE)
            break;
        more = goes_on(line);
        join(text, line + mark_length(reader, line));
        free(line);
        line = NULL;
    } while (more);
    free(line);

    /* a backslash on the last line of all: what stands before it is the statement */
    if (result == READ_END && *text != NULL)
        result = READ_LINE;
    if (result != READ_LINE) {
        free(*text);
        *text = NULL;
        return result;
    }
    if (reader_is_prompt(reader) && reader->pasted == NULL) {
        int rows, columns;

        line_edit_remember(*text);
        terminal_size(&rows, &columns);
        if (strchr(*text, '\n') == NULL && prompt + terminal_width(*text, strlen(*text)) < columns)
            origin->prompt = prompt;
    }
    return READ_LINE;
}

int reader_drop_pasted(Reader *reader)
{
    int count = 0;
    char *line;

    while (reader->pasted != NULL && cut_line(reader->pasted, &reader->pasted_at, &line)) {
        count += line[strspn(line, " \t\r")] != '\0';
        free(line);
    }
    free(reader->pasted);
    reader->pasted = NULL;
    return count;
}
