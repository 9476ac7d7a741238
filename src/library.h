/* library.h: a shared library of sources in C, by the compiler of the machine */
#ifndef COTREE_SRC_LIBRARY_H
#define COTREE_SRC_LIBRARY_H

#include "cotree.h"

/* Compiles the sources of an archive: *bytes new, free(). NULL with a message if there is no
 * compiler, or the format has no name for this machine. */
ct_status library_of(const ct_archive *archive, char **bytes, size_t *length, ct_error *error);

#endif
