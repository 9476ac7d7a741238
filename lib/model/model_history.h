/* model_history.h: the statements that a model accepted, in order, and the way back and forth over
 * them
 *
 * Each step has a mark of the state that it found. Where that state is no longer there, the state
 * is made anew from the texts of the steps before. */
#ifndef COTREE_MODEL_MODEL_HISTORY_H
#define COTREE_MODEL_MODEL_HISTORY_H

#include "model/model_impl.h"

typedef struct Accepted {
    const char *text; /* the statement in full */
    Effect effect;
    bool clears;
    int before;         /* steps before it that are undone with it */
    int after;          /* steps behind it that are done again with it */
    const char *called; /* what they are called together; NULL: text */
    StateMark mark;
    int serial; /* no other step has it */
} Accepted;

typedef struct History {
    Pool *texts;
    LIST(Accepted) list;
    int done; /* steps that count; those behind can be redone */
    int low;  /* the fewest since a group was begun */
    int serial;
} History;

void history_open(History *history);
void history_close(History *history);
/* Apply a statement; one that says something becomes a step. */
MUST_USE Status history_restore(History *history, State **state, const Statement *statement,
                                Outcome *outcome, Diag *diag);
void history_clear(History *history, State **state);
/* The last `count` steps are one from now on. */
void history_join(History *history, int count, const char *called);
/* Back over the last step, or forth over the next, and those that go with it: what they are called,
 * and what they changed. */
MUST_USE Status history_undo(History *history, State **state, const char **over, Effect *effect,
                             Diag *diag);
MUST_USE Status history_redo(History *history, State **state, const char **over, Effect *effect,
                             Diag *diag);

#endif
