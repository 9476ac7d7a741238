/* terminal.h: properties of the terminal: its size, and the width of text */
#ifndef COTREE_SRC_TERMINAL_H
#define COTREE_SRC_TERMINAL_H

#include <stdbool.h>
#include <stddef.h>

/* of standard output; 24 x 80 if that is no terminal, or doesn't report its size */
void terminal_size(int *rows, int *columns);
bool terminal_is_utf8(void);
/* of $TERM: the terminal prints lines only, without cursor movement */
bool terminal_is_dumb(void);
/* columns of the first `length` bytes; a tab counts as one, as do bytes that are no character */
int terminal_width(const char *text, size_t length);
/* bytes of the character at `text` (at least 1) and its width in columns */
int terminal_character(const char *text, size_t length, int *columns);

#endif
