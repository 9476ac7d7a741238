/* out_of_memory.h: end of the shell when it is out of memory itself
 *
 * If the library is out of memory, only the statement fails, and the shell continues. */
#ifndef COTREE_SRC_OUT_OF_MEMORY_H
#define COTREE_SRC_OUT_OF_MEMORY_H

#include <stdbool.h>

/* whether the unsaved model is kept in a file */
void out_of_memory_note(bool kept);
/* Print a message and end the process, with the status of a failed statement. */
_Noreturn void out_of_memory(void);

#endif
