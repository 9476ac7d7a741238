/* fortran_lines.c: source code of Fortran on lines that its standard allows */
#include "present/fortran_lines.h"

#include <string.h>

enum { COLUMNS = 132, INDENT = 4, LEAST = COLUMNS / 2 };

/* Where to break what may have `most` bytes on this line: after a blank or a comma in its second
 * half, else after a sign there, or else anywhere but within a character of UTF-8. */
static size_t break_place(const char *rest, size_t most)
{
    static const char *const signs[] = {" ,", "*/("};

    for (int k = 0; k < 2; k++)
        for (size_t i = most; i > LEAST; i--)
            if (strchr(signs[k], rest[i - 1]) != NULL)
                return i;
    while (most > 1 && ((unsigned char)rest[most] & 0xc0) == 0x80)
        most--;
    return most;
}

/* Between two `&` a statement continues with the next character, even within a name. */
static void wrap_line(Text *out, const char *line, size_t length)
{
    const size_t indent = strspn(line, " ");
    const bool is_comment = line[indent] == '!';
    const char *mark = is_comment ? "" : "&", *next = is_comment ? "! " : "&";
    size_t most = COLUMNS - strlen(mark);

    while (length > most) {
        const size_t part = break_place(line, most);

        text_add_n(out, line, part);
        text_addf(out, "%s\n", mark);
        text_fill(out, ' ', (int)indent + (is_comment ? 0 : INDENT));
        text_add(out, next);
        line += part;
        length -= part;
        most = COLUMNS - strlen(mark) - strlen(next) - indent - (is_comment ? 0 : INDENT);
    }
    text_add_n(out, line, length);
}

void fortran_wrap(Text *text, size_t from)
{
    Text wrapped = {0};

    for (const char *line = text->at + from; from < text->length && *line != '\0';) {
        const size_t length = strcspn(line, "\n");

        if (length > COLUMNS && line[0] != '#')
            wrap_line(&wrapped, line, length);
        else
            text_add_n(&wrapped, line, length);
        line += length;
        if (*line == '\n') {
            text_char(&wrapped, '\n');
            line++;
        }
    }
    if (wrapped.length == 0)
        return;
    text->length = from;
    text->at[from] = '\0';
    text_add_n(text, wrapped.at, wrapped.length);
    text_free(&wrapped);
}
