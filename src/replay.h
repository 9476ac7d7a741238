/* replay.h: lines run one after the other: scripts, standard input, -e, the prompt */
#ifndef COTREE_SRC_REPLAY_H
#define COTREE_SRC_REPLAY_H

#include "reader.h"
#include "shell.h"

/* Run all lines of a reader. A script stops at its first error (with `keep_going` at its end) and
 * returns it as status; a prompt continues. Takes ownership of the reader. */
ct_status replay(Shell *shell, Reader *reader);

/* Run a file: "-" is standard input. CT_FAILED with an empty message when the error was reported
 * where it occurred. */
ct_status replay_file(Shell *shell, const char *path, ct_error *error);

#endif
