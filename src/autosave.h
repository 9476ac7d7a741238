/* autosave.h: unsaved statements, in a file that outlives the session
 *
 * The statements that make the model are in a file of the session's own, each written when it was
 * accepted: so nothing has to be done when the session ends, however that happens. Undo truncates
 * the file. The session locks the file while it runs; an unlocked file belongs to an ended session.
 * A saved or empty model has no file. */
#ifndef COTREE_SRC_AUTOSAVE_H
#define COTREE_SRC_AUTOSAVE_H

#include "cotree.h"

#include <time.h>

typedef struct Autosave Autosave;

/* From now on; the model as it is counts as saved. NULL where there is no place for it. */
Autosave *autosave_open(const ct_session *session);
/* After a statement: `script` names the file that it came from, NULL: none. */
void autosave_follow(Autosave *unsaved, const ct_session *session, const char *script);
/* The model, as it is, can be had again from elsewhere. */
void autosave_settle(Autosave *unsaved, const ct_session *session);
/* whether there is something that would be lost */
bool autosave_is_kept(const Autosave *unsaved);
/* Stop recording; the file remains if there are unsaved statements. NULL is fine. */
void autosave_close(Autosave *unsaved);

/* A file of an ended session: locked by us until autosave_drop(). */
typedef struct Leftover {
    char *path;
    int file;                /* its lock is ours */
    struct timespec written; /* last */
    char when[32];           /* the same, for reading */
    int statements;
} Leftover;

/* All of them, the newest first; new array. */
Leftover *autosave_find(int *count);
/* Unlock the file, and delete it with `remove`. */
void autosave_drop(Leftover *leftover, bool remove);
void autosave_drop_all(Leftover *leftovers, int count, bool remove);
/* the folder that names in the statements below such a comment line are meant from; NULL: it is
 * another line */
const char *autosave_folder(const char *line);

#endif
