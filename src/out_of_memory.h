/* out_of_memory.h: how the shell ends where there is no more memory for itself
 *
 * A statement that the library has no memory for fails, as others do, and the shell goes on. */
#ifndef COTREE_SRC_OUT_OF_MEMORY_H
#define COTREE_SRC_OUT_OF_MEMORY_H

#include "autosave.h"

/* what is kept of the session at hand; borrowed; NULL: nothing */
void out_of_memory_note(const Autosave *unsaved);
/* Print a message and end the process, with the status of a failed statement. */
_Noreturn void out_of_memory(void);

#endif
