/* exact_memory.h: memory of GMP's numbers
 *
 * GMP ends the program when it is out of memory. Between exact_begin() and exact_end() its numbers
 * are allocated as memory of the call instead (transaction.h), which then fails as any other call.
 * The embedding program's own use of GMP keeps its allocation functions. All numbers made between
 * the two are cleared there. */
#ifndef COTREE_BASE_EXACT_MEMORY_H
#define COTREE_BASE_EXACT_MEMORY_H

void exact_begin(void);
void exact_end(void);

#endif
