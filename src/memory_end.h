/* memory_end.h: how the shell ends where there is no more memory */
#ifndef COTREE_SRC_MEMORY_END_H
#define COTREE_SRC_MEMORY_END_H

#include "unsaved.h"

/* From now on: the library ends here, too. */
void memory_end_setup(void);
/* what is kept of the session at hand; borrowed; NULL: nothing */
void memory_end_note(const Unsaved *unsaved);
/* Say it and end the process, with the status of a statement that failed. */
_Noreturn void memory_end(void);

#endif
