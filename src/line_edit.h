/* line_edit.h: a line typed at a terminal: keys, history, completion (all of readline) */
#ifndef COTREE_SRC_LINE_EDIT_H
#define COTREE_SRC_LINE_EDIT_H

#include "cotree.h"
#include "reader.h"

void line_edit_open(ct_session *session); /* borrowed, for completion; loads the history */
void line_edit_close(void);
/* READ_LINE with a new string (with newlines if a block was pasted), READ_END or READ_CLEARED */
ReadResult line_edit_read(const char *prompt, char **line);
/* Add an entry to the history, and to its file; blank ones and repetitions are ignored. */
void line_edit_remember(const char *entry);

#endif
