/* exact_memory.h: memory of GMP's numbers and FLINT's polynomials
 *
 * Both libraries end the program when they are out of memory. Between exact_begin() and exact_end()
 * they allocate as the call does (transaction.h), which then fails as any other call. The embedding
 * program's own use of them keeps its allocation functions. All numbers made between the two are
 * cleared there. Pairs may be nested. */
#ifndef COTREE_BASE_EXACT_MEMORY_H
#define COTREE_BASE_EXACT_MEMORY_H

#include "base/transaction.h"

void exact_begin(void);
void exact_end(void);

/* The same where FLINT is used, after flint_load(). It preserves integers for the next use by its
 * thread, so that no call may leave any behind, and none from before may grow inside. One at a time
 * in a thread; a field of an object of the call. */
typedef struct ExactMemory {
    Cleanup cleanup;
} ExactMemory;

void exact_open(ExactMemory *memory);
void exact_close(ExactMemory *memory);

#endif
