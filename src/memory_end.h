/* memory_end.h: how the shell ends where there is no more memory for itself
 *
 * A statement that the library has no memory for fails, as others do, and the shell goes on. */
#ifndef COTREE_SRC_MEMORY_END_H
#define COTREE_SRC_MEMORY_END_H

#include "unsaved.h"

/* what is kept of the session at hand; borrowed; NULL: nothing */
void memory_end_note(const Unsaved *unsaved);
/* Say it and end the process, with the status of a statement that failed. */
_Noreturn void memory_end(void);

#endif
