/* session_sweep.h: many runs of one statement, with other values of parameters each */
#ifndef COTREE_SESSION_SESSION_SWEEP_H
#define COTREE_SESSION_SESSION_SWEEP_H

#include "session/session_impl.h"

#include "simulate/sweep/sweep_table.h"

/* The sets of a file: a column for each parameter, a row for each run. */
typedef struct SweepSets {
    LIST(char *) names;
    LIST(double) values; /* row by row, SI where the head has a unit, else as written */
    LIST(Unit) units;    /* of heads; factor 0: none */
    int rows;
} SweepSets;
/* of a file that the statement names; *out needs sweep_sets_free() even then */
MUST_USE Status sweep_sets_read(ct_session *session, const Syntax *file, SweepSets *out,
                                Diag *diag);
void sweep_sets_free(SweepSets *sets);

/* The table of a statement, with the parameters of all its runs and the names of the figures that
 * it keeps: new. */
MUST_USE Status sweep_plan(ct_session *session, const Statement *statement, SweepTable **out,
                           Diag *diag);
/* a number in the unit of a parameter */
MUST_USE Status sweep_number(ct_session *session, const char *name, const Syntax *syntax,
                             double *out, Diag *diag);
/* how many processes share the runs: jobs=, what is set, or all processors; *given: not the last */
MUST_USE Status sweep_jobs(ct_session *session, const Statement *statement, int *out, bool *given,
                           Diag *diag);
/* --- rows in a file (session_sweep_file.c) --- */

/* of a row that no file has */
#define SWEEP_MISSING    "missing"
#define SWEEP_MOST_PARTS 1000000

/* file= and part=: rows part, part + parts ... of those planned */
typedef struct SweepFile {
    ct_session *session;
    const Syntax *name; /* NULL: rows are written to no file */
    int part, parts;
    int planned; /* rows of all parts */
    int old;     /* rows that the file had */
    uint64_t fingerprint;
} SweepFile;
/* What the statement says of it; *table then has the rows of the part alone. */
MUST_USE Status sweep_file_plan(ct_session *session, const Statement *statement, SweepTable **table,
                                SweepFile *out, Diag *diag);
/* Read the rows that the file has, and write its head if it has none. */
MUST_USE Status sweep_file_open(SweepFile *file, SweepTable *table, bool *is_made, Diag *diag);
MUST_USE Status sweep_file_add(const SweepFile *file, const SweepTable *table, int row, Diag *diag);

/* the figure i of keep=; NULL: there are no more */
const Syntax *sweep_kept(const Statement *statement, int i);

/* --- runs of many --- */

/* what a run changes in the session */
typedef struct SessionFocus {
    Run start;
    Linear *linear;
    Modes *modes;
    Report *reporter;
    bool linear_is_old, start_is_later, changed;
    uint64_t covered, freed;
    int freedoms;
} SessionFocus;
void focus_put_aside(ct_session *session, SessionFocus *out);
/* as before any run of the model: frees all but the first `runs` */
void focus_clear(ct_session *session, int runs);
void focus_restore(ct_session *session, const SessionFocus *focus);
/* of a statement that may stand after the colon; else NULL */
Analysis *sweep_analysis(const Statement *statement);
/* whether it is the fault of the parameters of one run; else the statement is wrong */
bool sweep_is_of_one_run(Status status);

#endif
