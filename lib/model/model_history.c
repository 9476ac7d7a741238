/* model_history.c: the accepted statements of a model, with undo and redo */
#include "model/model_history.h"

#include "language/verbs.h"

#include <string.h>

/* For states that were replaced (a name deleted, a law replaced): storing them is quicker than
 * rebuilding. */
static const size_t most_kept = (size_t)128 << 20; /* bytes */

void history_open(History *history)
{
    *history = (History){.texts = pool_new(0)};
}

void history_close(History *history)
{
    pool_free(history->texts);
    LIST_FREE(history->list);
}

static Accepted *add(History *history, const char *text, bool changes_equations,
                     const StateMark *mark)
{
    history->list.count = history->done;
    LIST_PUSH(history->list, (Accepted){.text = pool_text(history->texts, text, strlen(text)),
                                        .changes_equations = changes_equations,
                                        .mark = *mark,
                                        .serial = ++history->serial});
    history->done++;
    return &history->list.at[history->list.count - 1];
}

/* Applies a statement, and sets the mark for undoing it. */
static Status apply_marked(State **state, const Statement *statement, StateMark *mark,
                           Outcome *outcome, Diag *diag)
{
    mem_keep(*state);
    *mark = state_mark(*state);
    TRY(state_apply(state, statement, outcome, diag));
    if ((*state)->number != mark->state)
        state_forget_before(*state, most_kept);
    return OK;
}

/* the name of a definition is its first line */
static const char *name_of_block(History *history, const char *text)
{
    const size_t length = strcspn(text, "\n");

    return text[length] == '\n' ? pool_text(history->texts, text, length) : NULL;
}

Status history_restore(History *history, State **state, const Statement *statement,
                       Outcome *outcome, Diag *diag)
{
    StateMark mark;
    char *text = NULL;
    Status status = OK;

    CHECK(apply_marked(state, statement, &mark, outcome, diag));
    if (statement->kind != STATEMENT_EMPTY) {
        text = statement_full_text(statement);
        add(history, text, outcome->changes_equations, &mark)->called =
            name_of_block(history, text);
    }
done:
    mem_free(text);
    return status;
}

void history_clear(History *history, State **state)
{
    const StateMark mark = state_mark(*state);

    state_replace(state, state_new((*state)->arena, (*state)->overrides, (*state)->apply));
    state_forget_before(*state, most_kept);
    add(history, verb_row(VERB_clear).name, true, &mark)->clears = true;
}

void history_join(History *history, int count, const char *called)
{
    Accepted *last = &history->list.at[history->done - 1];

    mem_keep_part(history->list.at, &last[1 - count], (size_t)count * sizeof *last);
    last->before = count - 1;
    last->called = pool_text(history->texts, called, strlen(called));
    last[1 - count].after = count - 1;
}

/* --- undo and redo --- */

static Status take_again(History *history, int i, State **state, Diag *diag)
{
    Accepted *step = &history->list.at[i];
    Statement *statement = NULL;
    Outcome outcome = {0};
    Status status = OK;

    mem_keep_part(history->list.at, &step->mark, sizeof step->mark);
    if (step->clears) {
        step->mark = state_mark(*state);
        state_replace(state, state_new((*state)->arena, (*state)->overrides, (*state)->apply));
        return OK;
    }
    CHECK(statement_parse(step->text, 1, (SyntaxOptions){.whole = true}, NULL, &statement, diag));
    CHECK(apply_marked(state, statement, &step->mark, &outcome, diag));
done:
    text_free(&outcome.remarks);
    statement_free(statement);
    return status;
}

/* rebuilds the state after the first `count` steps, from their texts */
static Status make_anew(History *history, int count, State **state, Diag *diag)
{
    State *made = state_new((*state)->arena, (*state)->overrides, (*state)->apply);
    int first = count;
    Status status = OK;

    while (first > 0 && !history->list.at[first - 1].clears)
        first--;
    made->number = history->list.at[first].mark.state;
    for (int i = first; i < count; i++)
        CHECK(take_again(history, i, &made, diag));
    state_free(*state);
    *state = made;
    made = NULL;
done:
    state_free(made);
    return status;
}

static bool change_equations(const History *history, int from, int to)
{
    for (int i = from; i < to; i++)
        if (history->list.at[i].changes_equations)
            return true;
    return false;
}

static const char *name_of(const Accepted *step)
{
    return step->called != NULL ? step->called : step->text;
}

Status history_undo(History *history, State **state, const char **over, bool *changes_equations,
                    Diag *diag)
{
    const Accepted *last;
    int to;

    if (history->done == 0)
        return diag_set(diag, E_MISSING, "there is nothing to undo");
    last = &history->list.at[history->done - 1];
    to = history->done - 1 - last->before;
    if (!state_go_back(state, &history->list.at[to].mark))
        TRY(make_anew(history, to, state, diag));
    *over = name_of(last);
    *changes_equations = change_equations(history, to, history->done);
    history->done = to;
    if (to < history->low)
        history->low = to;
    return OK;
}

Status history_redo(History *history, State **state, const char **over, bool *changes_equations,
                    Diag *diag)
{
    const int from = history->done;
    Status status = OK;
    int to;

    if (from == history->list.count)
        return diag_set(diag, E_MISSING, "there is nothing to redo");
    to = from + 1 + history->list.at[from].after;
    for (int i = from; i < to; i++) {
        status = take_again(history, i, state, diag);
        if (status != OK) {
            if (i > from && !state_go_back(state, &history->list.at[from].mark))
                status = make_anew(history, from, state, diag);
            goto done;
        }
    }
    *over = name_of(&history->list.at[to - 1]);
    *changes_equations = change_equations(history, from, to);
    history->done = to;
done:
    return status;
}
