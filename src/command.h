/* command.h: the table of the verbs that the shell executes itself
 *
 * Grammar and help of every verb are in the library, which also defines whether the shell executes
 * it. Each row here is in the file that implements the verb. Output goes to `out`, and from there
 * to the screen, the pager or the file after `>`. */
#ifndef COTREE_SRC_COMMAND_H
#define COTREE_SRC_COMMAND_H

#include "shell.h"

/* A statement being carried out. */
typedef struct Call {
    Shell *shell;
    ct_session *session; /* the shell's */
    const ct_statement *statement;
    FILE *out;
    int columns; /* width of the screen that `out` is shown on; 0: a file or a pipe */
} Call;

typedef ct_status CommandFunction(Call *call, ct_error *error);

enum {
    WRITES = 1,    /* sees to `> "file"` itself */
    FORGOTTEN = 2, /* is not for history and recording */
    UNPAGED = 4,   /* prints what fits the screen as it is */
    OWN = 8        /* concerns only the shell: the session has no remarks */
};

typedef struct Command {
    const char *verb;
    CommandFunction *run;
    bool (*takes)(const ct_statement *statement); /* NULL: all that the library leaves to it */
    int flags;
} Command;

/* the row for a statement; NULL: the model's, or nobody's */
const Command *command_find(const ct_statement *statement);

/* print lines; an end of line is added where it is missing */
void write_text(FILE *out, const char *text);
/* Write a csv to the destination of the statement. For `>>` the file must have the same header, and
 * the rows are appended without it. */
ct_status csv_rows(const Call *call, const char *text, const char **rows, ct_error *error);
/* the word, name or string that is operand i; NULL: none */
const char *call_word(const Call *call, int i);

/* by file, each ended by a row without a verb */
extern const Command commands_look[], commands_run[], commands_session[], commands_plot[],
    commands_bode[], commands_draw[], commands_shell[];
CommandFunction command_run; /* what the session runs */

#endif
