/* reader.c: logical lines, from a file, a pipe, a string or the prompt */
#include "reader.h"

#include "copy.h"
#include "interrupt.h"
#include "line_edit.h"
#include "terminal.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Longer than any model's statement, and what is read of a file that is no script is little. */
enum { LONGEST = 4 << 20 }; /* bytes of a logical line */

struct Reader {
    FILE *file;       /* NULL: text or prompt */
    const char *text; /* what is left of it; NULL: file or prompt */
    const char *name; /* NULL: prompt */
    int line;         /* of the last physical line */
    bool returned;    /* it ended with a carriage return, to which a newline belongs */
    char *pasted;     /* a block with newlines, typed as one; NULL */
    size_t pasted_at; /* bytes of it read so far */
};

Reader *reader_of_file(FILE *file, const char *name)
{
    Reader *reader = check_allocated(calloc(1, sizeof *reader));

    reader->file = file;
    reader->name = name;
    return reader;
}

Reader *reader_of_text(const char *text, const char *name)
{
    Reader *reader = check_allocated(calloc(1, sizeof *reader));

    reader->text = text;
    reader->name = name;
    return reader;
}

Reader *reader_of_prompt(void)
{
    return check_allocated(calloc(1, sizeof(Reader)));
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

bool reader_is_file(const Reader *reader)
{
    return reader->file != NULL;
}

/* --- physical lines --- */

static ReadResult fail_long(ct_error *error)
{
    error_set(error, "the line is longer than %d MB", LONGEST >> 20);
    error_hint(error, "is it a script? Many numbers go into a file: table(\"data.csv\", x)");
    return READ_FAILED;
}

/* the next character; a signal that needs no action here (a window's new size) is ignored */
static int next_character(FILE *file)
{
    int c;

    while ((c = getc_unlocked(file)) == EOF && ferror(file) && errno == EINTR && !interrupt_asked())
        clearerr(file);
    return c;
}

/* room for one more character than there are */
static char *line_room(char *line, size_t length, size_t *room)
{
    if (length + 1 < *room)
        return line;
    *room = 2 * *room + 80;
    return check_allocated(realloc(line, *room));
}

/* The characters up to the end of a line, which may be a newline, a carriage return or both; a
 * newline after a carriage return is read only with the next line, because a terminal or a pipe may
 * delay it. */
static ReadResult read_file(Reader *reader, char **line, ct_error *error)
{
    size_t length = 0, room = 0;
    char *text = line_room(NULL, 0, &room);
    int c = 0;
    ReadResult result = READ_LINE;

    clearerr(reader->file);
    for (c = next_character(reader->file); c != EOF; c = next_character(reader->file)) {
        const bool is_rest = c == '\n' && length == 0 && reader->returned;

        reader->returned = c == '\r';
        if (is_rest)
            continue;
        if (c == '\n' || c == '\r')
            break;
        if (c == '\0') {
            error_set(error, "the line holds a zero byte, so this is no script");
            result = READ_FAILED;
            break;
        }
        if (++length > LONGEST) {
            result = fail_long(error);
            break;
        }
        text = line_room(text, length, &room);
        text[length - 1] = (char)c;
    }
    if (c == EOF && interrupt_asked()) {
        result = READ_CLEARED;
    } else if (c == EOF && ferror(reader->file)) {
        error_set(error, "can't read: %s", strerror(errno));
        result = READ_FAILED;
    } else if (c == EOF && length == 0) {
        result = READ_END;
    }
    text[length] = '\0';
    if (result == READ_LINE)
        *line = text;
    else
        free(text);
    return result;
}

/* the next line of a text; false at its end */
static bool cut_line(const char *text, size_t *at, char **line)
{
    if (text[*at] == '\0')
        return false;

    size_t length = strcspn(text + *at, "\r\n");

    *line = copy_piece(text + *at, length);
    *at += length;
    if (text[*at] == '\r' && text[*at + 1] == '\n')
        (*at)++;
    *at += text[*at] != '\0';
    return true;
}

static ReadResult read_prompt(Reader *reader, const char *prefix, bool more, char **line,
                              int *prompt)
{
    /* what was pasted first */
    if (reader->pasted != NULL) {
        if (cut_line(reader->pasted, &reader->pasted_at, line))
            return READ_LINE;
        free(reader->pasted);
        reader->pasted = NULL;
    }

    char *text = copy_format("%s> ", more ? ".." : prefix);
    ReadResult result = line_edit_read(text, line);

    *prompt = (int)strlen(text);
    free(text);
    if (result == READ_LINE && strchr(*line, '\n') != NULL) {
        line_edit_remember(*line);
        reader->pasted = *line;
        reader->pasted_at = 0;
        if (!cut_line(reader->pasted, &reader->pasted_at, line))
            *line = copy_text("");
    }
    return result;
}

static ReadResult read_physical(Reader *reader, const char *prefix, bool more, char **line,
                                int *prompt, ct_error *error)
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
        result = read_prompt(reader, prefix, more, line, prompt);
    }
    if (result == READ_LINE || result == READ_FAILED)
        reader->line++;
    return result;
}

/* --- logical lines --- */

/* A backslash at the line's end continues it, unless it is in a comment. Blanks after the backslash
 * are removed, because they are invisible. */
static bool goes_on(char *line)
{
    size_t length = strlen(line), last;
    bool in_string = false;

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

/* An editor's byte order mark is not part of the first statement. */
static size_t mark_length(const Reader *reader, const char *line)
{
    return reader->line == 1 && strncmp(line, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
}

/* Physical lines up to one that does not go on, onto `paper`. */
static ReadResult read_logical(Reader *reader, const char *prefix, OutputBuffer *paper, int *prompt,
                               ct_error *error)
{
    ReadResult result;
    size_t length = 0;
    int count = 0;
    bool more = false;

    do {
        char *line = NULL;

        result = read_physical(reader, prefix, more, &line, prompt, error);
        if (result == READ_LINE) {
            more = goes_on(line);
            length += strlen(line) + 1;
            fprintf(paper->out, "%s%s", count++ > 0 ? "\n" : "", line + mark_length(reader, line));
        }
        free(line);
        if (result == READ_LINE && length > LONGEST + 1)
            result = fail_long(error);
    } while (more && result == READ_LINE);

    /* a backslash on the very last line: the text before it is the statement */
    return result == READ_END && count > 0 ? READ_LINE : result;
}

ReadResult reader_next(Reader *reader, const char *prefix, char **text, Origin *origin,
                       ct_error *error)
{
    OutputBuffer paper;
    int prompt = 0;

    if (reader_is_prompt(reader) && reader->pasted == NULL)
        reader->line = 0;
    *origin = (Origin){reader->name, reader->line + 1, 0};
    output_buffer_open(&paper);

    ReadResult result = read_logical(reader, prefix, &paper, &prompt, error);

    *text = output_buffer_close(&paper);
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
