/* copy.h: strings of the shell's own
 *
 * Where there is no memory for these the program ends, with a message (out_of_memory.h). */
#ifndef COTREE_SRC_COPY_H
#define COTREE_SRC_COPY_H

#include <stddef.h>
#include <stdio.h>

#define NEVER_NULL __attribute__((returns_nonnull))

NEVER_NULL void *check_allocated(void *piece); /* `piece`, unless it is NULL */
NEVER_NULL char *copy_text(const char *text);  /* new, free() */
NEVER_NULL char *copy_piece(const char *text, size_t length);
NEVER_NULL char *copy_format(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A stream that writes to a growing text; output_buffer_close() returns the characters as a new
 * string. */
typedef struct OutputBuffer {
    FILE *out;
    char *text;
    size_t length;
} OutputBuffer;

void output_buffer_open(OutputBuffer *paper);
NEVER_NULL char *output_buffer_close(OutputBuffer *paper);

#endif
