/* saved.h: files that `save` writes and recognises
 *
 * The first line marks the file as written by cotree, with a checksum of the rest. A file that was
 * edited since, or has another origin, is replaced only with `overwrite`. */
#ifndef COTREE_SRC_SAVED_H
#define COTREE_SRC_SAVED_H

#include "cotree.h"

/* Write a script in one step; over a file that isn't ours only with `overwrite`. */
ct_status saved_write(const char *path, const char *script, bool overwrite, ct_error *error);
/* the same for the text of ct_store(), which includes its first line */
ct_status stored_write(const char *path, const char *text, bool overwrite, ct_error *error);

#endif
