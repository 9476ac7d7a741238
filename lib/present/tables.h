/* tables.h: the data of curves, as programs hold them */
#ifndef COTREE_PRESENT_TABLES_H
#define COTREE_PRESENT_TABLES_H

#include "base/text.h"
#include "expr/expr.h"

/* What the calls of table() in `roots` need before they mean anything: in C an array a table, in
 * Matlab a function for each derivative that occurs; nothing in other notations. `lead` stands
 * before each. */
void tables_print(Text *out, Notation notation, const char *lead, const Expr *roots, int count);

#endif
