/* greek.h: names of Greek letters */
#ifndef COTREE_EXPR_GREEK_H
#define COTREE_EXPR_GREEK_H

#include <stddef.h>

typedef struct Greek {
    const char *name; /* also in LaTeX, after a backslash */
    const char *letter;
} Greek;

/* The letter of that name, or NULL. */
const Greek *greek_find(const char *name, size_t length);

#endif
