/* model_lines.c: the lines that a state is made of: adding, ordering, making it anew, saving */
#include "model/model_impl.h"

#include <ctype.h>
#include <string.h>

/* "virtual rev h8 ..." in full: the statement's verb may have been shortened */
char *statement_full_text(const Statement *statement)
{
    const char *rest = statement->text;
    int words = statement->kind != STATEMENT_VERB ? 0 : statement->is_virtual ? 2 : 1;
    Text text = {0};

    if (words == 2)
        text_add(&text, "virtual ");
    if (words > 0)
        text_add(&text, statement->verb);
    for (; words > 0; words--) {
        while (isspace((unsigned char)*rest))
            rest++;
        while (isalnum((unsigned char)*rest) || *rest == '_')
            rest++;
    }
    text_add(&text, rest);
    return text_done(&text);
}

void line_uses(State *state, Line *line, const Scope *scope)
{
    int count = scope != NULL ? scope->uses.count : 0;

    line->use_count = count;
    line->uses = pool_alloc(state->pool, sizeof(int) * ((size_t)count + 1));
    for (int i = 0; i < count; i++)
        line->uses[i] = scope->uses.at[i];
}

int line_add(State *state, const char *text, int definition, int part, const Scope *scope)
{
    Line line = {.text = state_text(state, text), .definition = definition, .part = part};

    line_uses(state, &line, scope);
    LIST_PUSH(state->lines, line);
    return state->lines.count - 1;
}

void line_supersede(State *state, int part, const char *key)
{
    for (int i = 0; i < state->lines.count; i++) {
        Line *line = &state->lines.at[i];

        if (line->part != part || line->is_gone || line->key == NULL || strcmp(line->key, key) != 0)
            continue;
        state_keep_line(state, i);
        line->is_gone = true;
    }
}

/* --- order --- */

typedef struct LineOrder {
    const State *state;
    bool *placed;
    int *lines;
    int count;
    NumberList stack; /* lines waiting for what they use */
    NumberList next;  /* which of their uses to look at */
} LineOrder;

static void place_line(LineOrder *order, int line)
{
    LIST_PUSH(order->stack, line);
    LIST_PUSH(order->next, 0);
    while (order->stack.count > 0) {
        int top = order->stack.at[order->stack.count - 1];
        int *use = &order->next.at[order->next.count - 1];
        const Line *l = &order->state->lines.at[top];

        if (!order->placed[top] && *use < l->use_count) {
            int before = order->state->definitions.at[l->uses[(*use)++]].line;

            if (order->placed[before])
                continue;
            LIST_PUSH(order->stack, before);
            LIST_PUSH(order->next, 0);
            continue;
        }
        if (!order->placed[top] && !l->is_gone)
            order->lines[order->count++] = top;
        order->placed[top] = true;
        order->stack.count--;
        order->next.count--;
    }
}

/* outputs and events may hold the names of anything that was made after them first */
static int rank_of(const State *state, const Line *line)
{
    DefinitionKind kind =
        line->definition >= 0 ? state->definitions.at[line->definition].kind : DEFINES_PARAMETER;

    return kind == DEFINES_EVENT ? 2 : kind == DEFINES_OUTPUT ? 1 : 0;
}

int *lines_in_order(const State *state, int *count)
{
    LineOrder order = {.state = state};

    order.placed = NEW_ARRAY(bool, state->lines.count);
    order.lines = NEW_ARRAY(int, state->lines.count);
    for (int rank = 0; rank < 3; rank++)
        for (int i = 0; i < state->lines.count; i++)
            if (rank == rank_of(state, &state->lines.at[i]))
                place_line(&order, i);
    LIST_FREE(order.stack);
    LIST_FREE(order.next);
    mem_free(order.placed);
    *count = order.count;
    return order.lines;
}

/* --- making anew --- */

Status state_apply_text(State **state, const char *text, Text *remarks, Diag *diag)
{
    Statement *statement = NULL;
    Outcome outcome = {EFFECT_NONE, {0}};
    size_t next = 0;
    Status status = OK;

    CHECK(statement_parse(text, 1, (SyntaxOptions){false}, &next, &statement, diag));
    CHECK(state_apply(state, statement, &outcome, diag));
    if (remarks != NULL && outcome.remarks.at != NULL)
        text_add(remarks, outcome.remarks.at);
done:
    text_free(&outcome.remarks);
    statement_free(statement);
    return status;
}

/* the name that a line makes or changes, or the line itself */
static const char *line_name(const State *state, const Line *line)
{
    if (line->part >= 0)
        return state->parts.at[line->part]->name;
    return line->definition >= 0 ? state->definitions.at[line->definition].name : line->text;
}

void name_list_add(NameList *list, const char *name)
{
    for (int i = 0; i < list->count; i++)
        if (strcmp(list->at[i], name) == 0)
            return;
    LIST_PUSH(*list, name);
}

Status state_rebuild(const State *old, int without, State **out, NameList *broken, Text *remarks,
                     Diag *diag)
{
    State *state = state_new(old->arena);
    int gone = without >= 0 ? old->lines.at[without].part : -1;
    int count = 0;
    int *order = lines_in_order(old, &count);
    Status status = OK;

    for (int i = 0; i < count; i++) {
        const Line *line = &old->lines.at[order[i]];

        if (order[i] == without || (gone >= 0 && line->part == gone))
            continue;
        status = state_apply_text(&state, line->text, NULL, diag);
        if (status != OK && broken != NULL) {
            name_list_add(broken, line_name(old, line));
            status = OK;
        }
        CHECK(status);
    }
    choices_copy(state, old, remarks);
    CHECK(starts_copy(state, old, broken, remarks, diag));
    state_forget_before(state, 0);
    *out = state;
    state = NULL;
done:
    mem_free(order);
    state_free(state);
    return status;
}

Status apply_pairs(State **state, const Statement *statement, ApplyPair *apply, Outcome *outcome,
                   Diag *diag)
{
    State *work = *state;
    Status status = OK;

    if (statement->pairs.count == 0)
        return diag_at(diag, E_SYNTAX, statement->place, "'%s' is followed by NAME = value",
                       statement->verb);
    /* several: on a copy, so that a later one that fails leaves nothing of the earlier ones */
    if (statement->pairs.count > 1)
        CHECK(state_rebuild(*state, -1, &work, NULL, NULL, diag));
    for (int i = 0; i < statement->pairs.count; i++)
        CHECK(apply(&work, &statement->pairs.at[i], outcome, diag));
    if (statement->pairs.count > 1)
        state_replace(state, work);
    else
        *state = work;
    work = NULL;
done:
    if (statement->pairs.count > 1)
        state_free(work);
    return status;
}

void state_save(const State *state, Text *text)
{
    int count = 0;
    int *order = lines_in_order(state, &count);

    for (int i = 0; i < count; i++)
        text_addf(text, "%s\n", state->lines.at[order[i]].text);
    mem_free(order);
    choices_save(state, text);
    starts_save(state, text);
}
