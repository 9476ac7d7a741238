/* tables.h: the data of curves in programs */
#ifndef COTREE_PRESENT_TABLES_H
#define COTREE_PRESENT_TABLES_H

#include "base/text.h"
#include "expr/expr.h"

/* The definitions that calls of table() in `roots` need: in C an array for each table, in Matlab a
 * function for each derivative that occurs; nothing in other notations. `lead` precedes each. */
void tables_print(Text *out, Notation notation, const char *lead, const Expr *roots, int count);

#endif
