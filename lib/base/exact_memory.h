/* exact_memory.h: memory of GMP's numbers and FLINT's polynomials
 *
 * Both libraries end the program when they are out of memory. Between exact_open() and
 * exact_close() they allocate as the call does (transaction.h), which then fails as any other call.
 * The embedding program's own use of them keeps its allocation functions. All numbers made between
 * the two are cleared there. Pairs may be nested.
 *
 * FLINT preserves integers for the next use by its thread. The outermost pair frees those, so that
 * none from before grows inside, and none of the call remains. */
#ifndef COTREE_BASE_EXACT_MEMORY_H
#define COTREE_BASE_EXACT_MEMORY_H

typedef struct ExactMemory ExactMemory;

ExactMemory *exact_open(void); /* new; exact_close() */
void exact_close(ExactMemory *memory);

#endif
