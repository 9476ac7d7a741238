/* archive.h: files that go out as one: a zip, or one that is no text */
#ifndef COTREE_EXPORT_ARCHIVE_H
#define COTREE_EXPORT_ARCHIVE_H

#include "base/diag.h"
#include "base/memory.h"

typedef struct ArchiveFile {
    char *name; /* with folders: "sources/model.c" */
    char *bytes;
    size_t length;
} ArchiveFile;

typedef struct Archive {
    LIST(ArchiveFile) files;
    bool is_plain;      /* of one file, written without archive */
    const char *binary; /* where a binary for this machine belongs; NULL: there is no name for it */
} Archive;

void archive_free(Archive *archive); /* NULL is fine */
/* Add a file; takes ownership of `bytes`. */
void archive_add(Archive *archive, const char *name, char *bytes, size_t length);
/* The zip, or the plain file, new: the same bytes for the same files. `binary`: the one for this
 * machine; NULL: none.
 */
MUST_USE Status archive_pack(const Archive *archive, const char *binary, size_t binary_length,
                             char **bytes, size_t *length, Diag *diag);

#endif
