/* shell.h: a session at work: the model, what the user set, and how a statement is carried out */
#ifndef COTREE_SRC_SHELL_H
#define COTREE_SRC_SHELL_H

#include "autosave.h"
#include "cotree.h"
#include "gnuplot.h"
#include "progress.h"
#include "report_error.h"
#include "settings.h"

#include <stdio.h>

typedef struct Command Command;
/* the row for a statement; NULL: the model's, or nobody's */
typedef const Command *FindCommand(const ct_statement *statement);

typedef struct Shell {
    ct_session *session;
    FindCommand *find; /* command_find() */
    Settings settings;
    Progress progress;
    Gnuplot *gnuplot;  /* NULL until something is drawn */
    FILE *record;      /* NULL: nothing is recorded */
    Autosave *unsaved; /* NULL: statements aren't recorded */
    char **history;    /* accepted statements */
    int history_count;
    char *last_plot;    /* the statement that drew last; NULL */
    const char *script; /* name of the file being replayed; NULL */
    bool interactive;
    bool quiet;
    bool keep_going;
    bool quitting;
    bool unicode;
    int depth;      /* of files within files */
    int stopped_at; /* line at which a script ended early */
    int failed;     /* failed statements in scripts, and failed expectations */
    int unmet;
    int unsolved;     /* of the statements that failed: those whose computation did */
    bool is_unsolved; /* the last one that failed */
    int dropping;     /* line of the definition whose first line failed, up to its 'end'; 0: none */
} Shell;

void shell_open(Shell *shell, FindCommand *find);
void shell_close(Shell *shell);

/* Run every statement of a logical line. Output and messages are printed; the first failing
 * statement ends the line. */
ct_status shell_run_line(Shell *shell, const Origin *origin, const char *text, bool shortened);

#endif
