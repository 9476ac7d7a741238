/* reader.h: logical lines, from a file, a pipe, a string or the prompt
 *
 * A physical line that ends with a backslash is continued in the next one, unless the backslash is
 * in a comment. Lines may also end with a carriage return alone or before the newline. */
#ifndef COTREE_SRC_READER_H
#define COTREE_SRC_READER_H

#include "report_error.h"

#include <stdio.h>

typedef struct Reader Reader;

typedef enum ReadResult {
    READ_LINE,
    READ_END,
    READ_CLEARED, /* Ctrl-C: the line is to be forgotten */
    READ_FAILED
} ReadResult;

Reader *reader_of_file(FILE *file, const char *name); /* owns the file from then on, unless stdin */
Reader *reader_of_text(const char *text, const char *name); /* borrowed */
Reader *reader_of_prompt(void);                             /* line_edit.h must be open */
void reader_free(Reader *reader);
bool reader_is_prompt(const Reader *reader);
bool reader_is_file(const Reader *reader);

/* The next logical line, its physical lines joined by newlines: new, free(). `prefix`: the text of
 * the prompt. */
ReadResult reader_next(Reader *reader, const char *prefix, char **text, Origin *origin,
                       ct_error *error);

/* Forget what is left of a pasted block; how many lines those were. */
int reader_drop_pasted(Reader *reader);

#endif
