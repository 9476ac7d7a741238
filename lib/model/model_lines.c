/* model_lines.c: the lines that a state is made from: adding and ordering */
#include "model/model_impl.h"

#include <ctype.h>
#include <string.h>

/* "virtual rev h8 ..." in full: the statement's verb may be abbreviated */
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
    Line line = {.text = state_text(state, text),
                 .definition = definition,
                 .part = part,
                 .use = -1,
                 .inside = state->inside};

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
        state_retain_line(state, i);
        line->is_gone = true;
    }
}

int line_root(const State *state, int line)
{
    while (state->lines.at[line].inside >= 0)
        line = state->uses.at[state->lines.at[line].inside].line;
    return line;
}

/* --- order --- */

typedef struct LineOrder {
    const State *state;
    bool *placed;
    int *lines;
    int count;
    NumberList stack; /* lines that wait for the lines they use */
    NumberList next;  /* index of the use to visit next, for each */
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
            int before =
                line_root(order->state, order->state->definitions.at[l->uses[(*use)++]].line);

            if (order->placed[before])
                continue;
            LIST_PUSH(order->stack, before);
            LIST_PUSH(order->next, 0);
            continue;
        }
        if (!order->placed[top] && !l->is_gone && l->inside < 0)
            order->lines[order->count++] = top;
        order->placed[top] = true;
        order->stack.count--;
        order->next.count--;
    }
}

/* outputs and events come after all that they may name */
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
