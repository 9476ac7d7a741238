/* copy.h: strings of the shell's own
 *
 * Where there is no memory for these the program ends, with a message (memory_end.h). */
#ifndef COTREE_SRC_COPY_H
#define COTREE_SRC_COPY_H

#include <stddef.h>
#include <stdio.h>

#define NEVER_NULL __attribute__((returns_nonnull))

NEVER_NULL void *copy_check(void *piece);     /* `piece`, unless it is NULL */
NEVER_NULL char *copy_text(const char *text); /* new, free() */
NEVER_NULL char *copy_piece(const char *text, size_t length);
NEVER_NULL char *copy_format(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A text that grows behind a stream; paper_close() hands over the characters as a new string. */
typedef struct Paper {
    FILE *out;
    char *text;
    size_t length;
} Paper;

void paper_open(Paper *paper);
NEVER_NULL char *paper_close(Paper *paper);

#endif
