/* model_event.c: events: a condition, and the action when it becomes true
 *
 * Their lines come after all others, since they may name anything and nothing names them. A later
 * statement with the same name replaces the earlier one. */
#include "model/model_impl.h"

#include <string.h>

/* --- conditions --- */

static bool is_constant(Expr e)
{
    return (expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) == 0;
}

/* contains comparisons and operands that are constant during a run */
static bool is_condition(Expr e)
{
    if (is_constant(e))
        return true;
    if (expr_kind(e) != EXPR_CALL)
        return false;
    switch (expr_op(e)) {
    case OP_LT:
    case OP_LE:
    case OP_EQ:
    case OP_NE:
        return true;
    case OP_AND:
    case OP_OR:
        return is_condition(expr_arg(e, 0)) && is_condition(expr_arg(e, 1));
    case OP_NOT:
        return is_condition(expr_arg(e, 0));
    case OP_IF:
        return is_condition(expr_arg(e, 0)) && is_condition(expr_arg(e, 1)) &&
               is_condition(expr_arg(e, 2));
    default:
        return false;
    }
}

/* whether a condition compares two variable values for equality */
static bool asks_equality(Expr e)
{
    if (is_constant(e) || expr_kind(e) != EXPR_CALL)
        return false;
    if (expr_op(e) == OP_EQ || expr_op(e) == OP_NE)
        return true;
    if (expr_op(e) == OP_LT || expr_op(e) == OP_LE)
        return false;
    for (int i = 0; i < expr_arg_count(e); i++)
        if (asks_equality(expr_arg(e, i)))
            return true;
    return false;
}

/* the first == or != in the text; NULL where it is in an output or a law */
static const Syntax *find_equality(const Syntax *syntax)
{
    const Syntax *found = NULL;

    if (syntax->kind == SYNTAX_BINARY &&
        (strcmp(syntax->text, "==") == 0 || strcmp(syntax->text, "!=") == 0))
        return syntax;
    for (int i = 0; i < syntax->count && found == NULL; i++)
        found = find_equality(syntax->args[i]);
    return found;
}

static Status check_condition(const Syntax *syntax, Expr when, Diag *diag)
{
    const Syntax *equality = find_equality(syntax);
    Status status = OK;

    if (is_constant(when)) {
        status = diag_at(diag, E_VALUE, syntax->place, "this can't become true during a run");
        diag_hint(diag, "a condition holds t or a variable, as in when=h8 > 1");
    } else if (!is_condition(when)) {
        status = diag_at(diag, E_VALUE, syntax->place, "this is no condition");
        diag_hint(diag, "a condition compares, as in when=h8 > 1 && t < 2");
    } else if (asks_equality(when)) {
        status = diag_at(diag, E_VALUE, equality != NULL ? equality->op_place : syntax->place,
                         "two values that change are equal between two numbers: rounding would "
                         "decide whether this ever holds");
        diag_hint(diag, "say from which side: h8 > 1, or h8 < 1");
    }
    return status;
}

/* --- the statement --- */

typedef LIST(NewValue) NewValues;

typedef struct EventDraft {
    State *state;
    Scope scope;
    Event *event;
    NewValues values;
    bool has_action;
} EventDraft;

static Status read_when(EventDraft *r, const Pair *pair, Diag *diag)
{
    Text text = {0};
    Status status = OK;

    CHECK(scope_expression(&r->scope, pair->value, &r->event->when, diag));
    CHECK(check_condition(pair->value, r->event->when, diag));
    syntax_print(&text, pair->value);
    r->event->condition = state_text(r->state, text.at);
done:
    text_free(&text);
    return status;
}

static Status read_action(EventDraft *r, const Pair *pair, Diag *diag)
{
    const char *word = syntax_name(pair->value);

    r->has_action = true;
    if (word != NULL && strcmp(word, "stop") == 0)
        r->event->action = EVENT_STOP;
    else if (word == NULL || strcmp(word, "mark") != 0) {
        (void)diag_at(diag, E_VALUE, pair->value->place, "do= is stop or mark");
        diag_hint(diag, "new values are said without it: s11'=-0.8*s11'");
        return E_VALUE;
    }
    return OK;
}

static Status read_value(EventDraft *r, const Pair *pair, Diag *diag)
{
    NewValue value = {.primes = pair->primes};
    Text name = {0};
    Status status = OK;

    CHECK(initial_check(&r->scope, pair, &name, diag));
    CHECK(scope_expression(&r->scope, pair->value, &value.value, diag));
    for (int i = 0; i < r->values.count; i++)
        if (r->values.at[i].primes == pair->primes && strcmp(r->values.at[i].name, name.at) == 0) {
            status = diag_at(diag, E_VALUE, pair->name_place, "%s%.*s is given twice", name.at,
                             pair->primes, "'''''''''");
            goto done;
        }
    value.name = state_text(r->state, name.at);
    LIST_PUSH(r->values, value);
done:
    text_free(&name);
    return status;
}

static Status read_pairs(EventDraft *r, const Statement *statement, Diag *diag)
{
    for (int i = 0; i < statement->pairs.count; i++) {
        const Pair *pair = &statement->pairs.at[i];

        if (pair->primes == 0 && strcmp(pair->name, "when") == 0)
            TRY(read_when(r, pair, diag));
        else if (pair->primes == 0 && strcmp(pair->name, "do") == 0)
            TRY(read_action(r, pair, diag));
        else
            TRY(read_value(r, pair, diag));
    }
    if (r->event->when == NULL) {
        (void)diag_at(diag, E_SYNTAX, statement->operands.at[0].place, "event %s needs a condition",
                      r->event->name);
        diag_hint(diag, "event %s when=h8 > 1 do=stop", r->event->name);
        return E_SYNTAX;
    } else if (r->values.count > 0 && r->has_action) {
        (void)diag_at(diag, E_VALUE, statement->operands.at[0].place,
                      "event %s has both do= and new values", r->event->name);
        diag_hint(diag, "take two events with the same condition");
        return E_VALUE;
    }
    return OK;
}

/* adds a new event, or replaces the one of the same name */
static void put_event(State *state, const char *text, const Event *event, const Scope *scope)
{
    const Thing *thing = state_thing(state, event->name);
    int index = thing != NULL ? thing->index : state->definitions.count;

    if (thing == NULL) {
        LIST_PUSH(state->definitions,
                  (Definition){.kind = DEFINES_EVENT,
                               .name = event->name,
                               .line = line_add(state, text, index, -1, scope)});
        LIST_PUSH(state->events, index);
        state_name(state, event->name, THING_DEFINITION, index, 0);
    } else {
        Line *line = &state->lines.at[state->definitions.at[index].line];

        state_retain_line(state, state->definitions.at[index].line);
        state_retain_definition(state, index);
        line->text = event->text;
        line_uses(state, line, scope);
    }
    state->definitions.at[index].event = event;
}

Status apply_event(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    State *s = *state;
    const Operand *operand = &statement->operands.at[0];
    const char *name = operand->value->text;
    const Thing *thing = state_thing(s, name);
    bool is_event = thing != NULL && thing->kind == THING_DEFINITION &&
                    s->definitions.at[thing->index].kind == DEFINES_EVENT;
    EventDraft r = {.state = s, .scope = {.state = s, .kind = SCOPE_EVENT}};
    char *text = statement_full_text(statement);
    NewValue *values;
    Status status = OK;

    (void)outcome;
    if (!is_event)
        CHECK(name_is_free(s, name, operand->place, diag));
    if (names_find(s->terminals, name) >= 0) {
        status = diag_at(diag, E_NAME, operand->place, "'%s' is already a terminal", name);
        goto done;
    }
    r.event = pool_alloc(s->pool, sizeof *r.event);
    *r.event = (Event){.name = state_text(s, name), .text = state_text(s, text)};
    CHECK(read_pairs(&r, statement, diag));
    values = pool_alloc(s->pool, sizeof *values * ((size_t)r.values.count + 1));
    for (int i = 0; i < r.values.count; i++)
        values[i] = r.values.at[i];
    r.event->values = values;
    r.event->value_count = r.values.count;
    if (r.values.count > 0)
        r.event->action = EVENT_SET;
    put_event(s, text, r.event, &r.scope);
done:
    LIST_FREE(r.scope.uses);
    LIST_FREE(r.values);
    mem_free(text);
    return status;
}
