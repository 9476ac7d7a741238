/* command_call.h: a statement being carried out by a command */
#ifndef COTREE_SRC_COMMAND_CALL_H
#define COTREE_SRC_COMMAND_CALL_H

#include "shell.h"

typedef struct Call {
    Shell *shell;
    ct_session *session; /* the shell's */
    const ct_statement *statement;
    FILE *out;
    int columns; /* width of the screen that `out` is shown on; 0: a file or a pipe */
} Call;

/* print lines; an end of line is added where it is missing */
void write_text(FILE *out, const char *text);
/* Write a csv to the destination of the statement. For `>>` the file must have the same header, and
 * the rows are appended without it. */
ct_status csv_rows(const Call *call, const char *text, const char **rows, ct_error *error);
/* the word, name or string that is operand i; NULL: none */
const char *call_word(const Call *call, int i);

#endif
