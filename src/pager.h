/* pager.h: long text, a screen at a time */
#ifndef COTREE_SRC_PAGER_H
#define COTREE_SRC_PAGER_H

#include <stdbool.h>
#include <stddef.h>

/* Show a text on standard output, through $PAGER (or less, or more) when that is a terminal, the
 * text longer than the screen and `allowed`. */
void pager_show(const char *text, size_t length, bool allowed);

#endif
