/* copy.c: strings of the shell's own */
#include "copy.h"

#include "memory_end.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void *copy_check(void *piece)
{
    if (piece == NULL) {
        memory_end();
    }
    return piece;
}

char *copy_text(const char *text)
{
    return copy_check(strdup(text));
}

char *copy_piece(const char *text, size_t length)
{
    return copy_check(strndup(text, length));
}

char *copy_format(const char *format, ...)
{
    char *text = NULL;
    va_list args;

    va_start(args, format);
    if (vasprintf(&text, format, args) < 0)
        text = NULL;
    va_end(args);
    return copy_check(text);
}

void paper_open(Paper *paper)
{
    *paper = (Paper){0};
    paper->out = copy_check(open_memstream(&paper->text, &paper->length));
}

char *paper_close(Paper *paper)
{
    fclose(paper->out);
    paper->out = NULL;

    char *text = copy_check(paper->text);

    paper->text = NULL;
    return text;
}
