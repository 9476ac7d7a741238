/* replay.h: lines run one after the other: scripts, standard input, -e, the prompt */
#ifndef COTREE_SRC_REPLAY_H
#define COTREE_SRC_REPLAY_H

#include "reader.h"
#include "shell.h"

/* Run everything a reader gives. A script stops at its first error (with `keep_going` at its end)
 * and tells it in the returned status; a prompt goes on. The reader is given. */
ct_status replay(Shell *shell, Reader *reader);

/* Run a file: "-" is standard input. CT_FAILED with an empty message when the error was told
 * where it happened. */
ct_status replay_file(Shell *shell, const char *path, ct_error *error);

#endif
