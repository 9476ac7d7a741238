/* command.h: the table of the verbs that the shell executes itself
 *
 * Grammar and help of every verb are in the library, which also defines whether the shell executes
 * it. Each row here is in the file that implements the verb. Output goes to `out`, and from there
 * to the screen, the pager or the file after `>`. */
#ifndef COTREE_SRC_COMMAND_H
#define COTREE_SRC_COMMAND_H

#include "command_call.h"

typedef ct_status CommandFunction(Call *call, ct_error *error);

enum {
    WRITES = 1,    /* sees to `> "file"` itself */
    FORGOTTEN = 2, /* is not for history and recording */
    UNPAGED = 4,   /* prints what fits the screen as it is */
    OWN = 8        /* concerns only the shell: the session has no remarks */
};

struct Command {
    const char *verb;
    CommandFunction *run;
    bool (*takes)(const ct_statement *statement); /* NULL: all that the library leaves to it */
    int flags;
};

FindCommand command_find;

/* by file, each ended by a row without a verb */
extern const Command commands_look[], commands_run[], commands_session[], commands_plot[],
    commands_bode[], commands_draw[], commands_shell[];
CommandFunction command_run; /* what the session runs */

#endif
