/* saved.h: files that `save` writes, and knows again
 *
 * The first line says that cotree wrote the rest, with a number that follows from it: a file that
 * was edited since, or is somebody else's, is not replaced unasked. */
#ifndef COTREE_SRC_SAVED_H
#define COTREE_SRC_SAVED_H

#include "cotree.h"

/* Write a script in one step; over a file that isn't ours only with `overwrite`. */
ct_status saved_write(const char *path, const char *script, bool overwrite, ct_error *error);
/* the same of what ct_store() tells, which brings its first line */
ct_status stored_write(const char *path, const char *text, bool overwrite, ct_error *error);

#endif
