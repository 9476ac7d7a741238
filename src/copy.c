/* copy.c: strings of the shell's own */
#include "copy.h"

#include "out_of_memory.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void *check_allocated(void *piece)
{
    if (piece == NULL) {
        out_of_memory();
    }
    return piece;
}

char *copy_text(const char *text)
{
    return check_allocated(strdup(text));
}

char *copy_piece(const char *text, size_t length)
{
    return check_allocated(strndup(text, length));
}

char *copy_format(const char *format, ...)
{
    char *text = NULL;
    va_list args;

    va_start(args, format);
    if (vasprintf(&text, format, args) < 0)
        text = NULL;
    va_end(args);
    return check_allocated(text);
}

void output_buffer_open(OutputBuffer *paper)
{
    *paper = (OutputBuffer){0};
    paper->out = check_allocated(open_memstream(&paper->text, &paper->length));
}

char *output_buffer_close(OutputBuffer *paper)
{
    fclose(paper->out);
    paper->out = NULL;

    char *text = check_allocated(paper->text);

    paper->text = NULL;
    return text;
}
