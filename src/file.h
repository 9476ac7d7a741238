/* file.h: whole files, written at once or not at all; names of files */
#ifndef COTREE_SRC_FILE_H
#define COTREE_SRC_FILE_H

#include "cotree.h"

/* From now on no file is written, and none is read but those below the folder of `script`, by
 * whatever way a name leads out of it; NULL: below the current folder. One rule for the whole
 * process, as its rights are. */
void file_confine(const char *script);
bool file_is_confined(void);
ct_status file_may_read(const char *path, ct_error *error);
ct_status file_may_write(const char *path, ct_error *error);

/* Write a text. A regular file is replaced in one step (by renaming a temporary one in the same
 * folder), so that a failed write leaves the old one; `append`, pipes and devices are written
 * directly. CT_FAILED with a message naming the file. */
ct_status file_write(const char *path, const char *text, size_t length, bool append,
                     ct_error *error);
/* the whole of a text file into *text, which is new */
ct_status file_read(const char *path, char **text, ct_error *error);
bool file_has_content(const char *path);
/* without its end; new; NULL: it can't be read */
char *file_first_line(const char *path);

/* A temporary file for another program to write: a new empty file in the same folder as `path`, or
 * `path` itself if that is a device. `*place` is new, free(). file_settle() moves it to `path`, or
 * removes it when `keep` is false. */
ct_status file_place(const char *path, char **place, ct_error *error);
ct_status file_settle(const char *place, const char *path, bool keep, ct_error *error);

/* new: `name` as meant in the file `from` (relative to its folder if such a file is there) */
char *file_next_to(const char *from, const char *name);
const char *file_extension(const char *path); /* after the last dot of the last part; "" */
/* new: the file `name` in a folder of ours below $`variable`, or below ~/`home`; NULL: no home */
char *file_in_home(const char *variable, const char *home, const char *name, bool make_folder);

#endif
