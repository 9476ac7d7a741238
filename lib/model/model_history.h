/* model_history.h: the accepted statements of a model, in order, with undo and redo
 *
 * Each step has a mark of the state before it. Where that state no longer exists, it is rebuilt
 * from the texts of the steps before. */
#ifndef COTREE_MODEL_MODEL_HISTORY_H
#define COTREE_MODEL_MODEL_HISTORY_H

#include "model/model_impl.h"

typedef struct Accepted {
    const char *text; /* the statement in full */
    bool changes_equations;
    bool clears;
    int before;         /* number of steps before it that are undone with it */
    int after;          /* number of steps after it that are redone with it */
    const char *called; /* their common name; NULL: text */
    StateMark mark;
    int serial; /* unique number */
} Accepted;

typedef struct History {
    Pool *texts;
    LIST(Accepted) list;
    int done; /* number of steps in effect; those after them can be redone */
    int low;  /* the lowest number since a group was begun */
    int serial;
} History;

void history_open(History *history);
void history_close(History *history);
/* Applies a statement; if it has an effect it becomes a step. */
MUST_USE Status history_restore(History *history, State **state, const Statement *statement,
                                Outcome *outcome, Diag *diag);
void history_clear(History *history, State **state);
/* Makes the last `count` steps one. */
void history_join(History *history, int count, const char *called);
/* Undoes the last step, or redoes the next one, with those that belong to it; returns their name
 * and whether they change equations. */
MUST_USE Status history_undo(History *history, State **state, const char **over,
                             bool *changes_equations, Diag *diag);
MUST_USE Status history_redo(History *history, State **state, const char **over,
                             bool *changes_equations, Diag *diag);

#endif
