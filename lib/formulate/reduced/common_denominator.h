/* common_denominator.h: the least common denominator of terms
 *
 * A factor is below the fraction line where it is a power with a negative whole exponent. The
 * denominator holds the base of each with its largest exponent, in the order in which they were
 * met. */
#ifndef COTREE_FORMULATE_REDUCED_COMMON_DENOMINATOR_H
#define COTREE_FORMULATE_REDUCED_COMMON_DENOMINATOR_H

#include "base/memory.h"
#include "expr/expr.h"

typedef struct CommonDenominator { /* {0}: 1 */
    LIST(Expr) bases;
    LIST(int64_t) powers;
} CommonDenominator;

/* the terms of a sum, or an expression as one term */
void denominator_add(CommonDenominator *denominator, Expr e);
/* The product of all added so far. Frees what it is made of. */
Expr denominator_done(Arena *arena, CommonDenominator *denominator);
/* the terms of e times a factor: a new sum, neither expanded nor collected */
Expr terms_times(Arena *arena, Expr e, Expr factor);

#endif
