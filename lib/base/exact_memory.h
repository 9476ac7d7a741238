/* exact_memory.h: memory of GMP's numbers
 *
 * GMP ends the program where memory ends. Between exact_begin() and exact_end() its numbers are
 * pieces of the call instead (transaction.h), which fails as any other; what a caller of the
 * library does with GMP of its own stays with the functions that it had. All numbers made
 * between the two are cleared there. */
#ifndef COTREE_BASE_EXACT_MEMORY_H
#define COTREE_BASE_EXACT_MEMORY_H

void exact_begin(void);
void exact_end(void);

#endif
