/* lower_impl.h: shared parts of lower.c and lowered.c */
#ifndef COTREE_COMPILE_LOWER_IMPL_H
#define COTREE_COMPILE_LOWER_IMPL_H

#include "compile/lower.h"

/* a value times two, plus one where its negative is meant */
typedef uint32_t Signed;

/* Values of expressions of an arena, whatever program they are for: operands before users, inputs
 * numbered as their symbols were met. */
typedef struct Lowering {
    LIST(LoweredValue) values;
    LIST(Expr) symbols; /* args[0] of an input is a place here */
    LIST(const Curve *) tables;
    Signed *known; /* by creation number: plus 1; 0 where not lowered */
    uint32_t known_count;
    uint32_t *table;     /* hash table of values: plus 1; 0 where free */
    uint32_t table_size; /* a power of two; 0: none yet */
} Lowering;

/* the values of more expressions; new, mem_free() */
uint32_t *lowering_add(Lowering *low, const Expr *roots, int count);
/* the slot of a value in the table, or the empty slot for it */
uint32_t lowering_slot(const Lowering *low, const LoweredValue *wanted);

#endif
