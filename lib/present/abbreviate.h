/* abbreviate.h: long expressions written over named subexpressions
 *
 * A subexpression that occurs more than once, or is too long for one line, gets a name; the
 * expressions and the definitions of the names are then short. Built in the caller's arena.
 * Definitions are ordered so that each uses earlier ones only. */
#ifndef COTREE_PRESENT_ABBREVIATE_H
#define COTREE_PRESENT_ABBREVIATE_H

#include "base/memory.h"
#include "expr/expr.h"

typedef struct Naming {
    const char *prefix; /* of the names: w gives w1, w2 ... */
    int64_t least;      /* operations that an expression occurring more than once has to be named */
    int64_t most;       /* operations of a root without names; 0: any number */
} Naming;

typedef struct Abbreviated {
    Expr symbol; /* of kind SYMBOL_ARGUMENT */
    Expr value;
} Abbreviated;

typedef struct Abbreviation {
    Expr *roots; /* one for each root of the caller */
    LIST(Abbreviated) definitions;
} Abbreviation;

/* O(nodes). Holds are ignored. Free with abbreviation_free(). */
Abbreviation abbreviate(Arena *arena, const Expr *roots, int count, const Naming *naming);
void abbreviation_free(Abbreviation *abbreviation);

#endif
