/* session_statement.c: statements as a program sees them */
#include "session/session_impl.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

ct_status ct_parse(ct_cursor *cursor, bool shortened, ct_statement **out, ct_error *error)
{
    TRANSACTION(session_report(E_MEMORY, &(Diag){0}, error));

    Cursor inner = {cursor->text, cursor->next, cursor->line, cursor->line_start};
    Statement *statement = NULL;
    Diag diag = {0};
    Status status =
        statement_read(&inner, (SyntaxOptions){.shortened = shortened}, &statement, &diag);

    if (status == OK) {
        mem_keep_foreign(cursor, sizeof *cursor);
        cursor->next = inner.next;
        cursor->line = inner.line;
        cursor->line_start = inner.line_start;
        *out = (ct_statement *)(void *)statement;
    } else {
        statement_free(statement);
    }
    return session_report(status, &diag, error);
}

void ct_statement_free(ct_statement *statement)
{
    statement_free((Statement *)(void *)statement);
}

bool ct_statement_is_empty(const ct_statement *statement)
{
    return statement_of(statement)->kind == STATEMENT_EMPTY;
}

const char *ct_statement_text(const ct_statement *statement)
{
    const char *text = statement_of(statement)->text;

    return text != NULL ? text : "";
}

const char *ct_verb(const ct_statement *statement)
{
    const char *verb = statement_of(statement)->verb;

    return verb != NULL ? verb : "";
}

ct_room ct_carrier(const ct_statement *statement)
{
    const Room room = session_room(statement_of(statement));

    return room == ROOM_MODEL ? CT_MODEL : room == ROOM_SESSION ? CT_SESSION : CT_CALLER;
}

bool ct_prints(const ct_statement *statement)
{
    const Verb *row = &statement_of(statement)->row;

    return row->name != NULL && strchr(row->pattern, '>') != NULL;
}

const ct_statement *ct_rest(const ct_statement *statement)
{
    return (const ct_statement *)(const void *)statement_of(statement)->rest;
}

int ct_operand_count(const ct_statement *statement)
{
    return statement_of(statement)->operands.count;
}

const ct_expression *ct_operand(const ct_statement *statement, int i)
{
    const Statement *s = statement_of(statement);

    return i >= 0 && i < s->operands.count ? expression_of(s->operands.at[i].value) : NULL;
}

int ct_operand_sign(const ct_statement *statement, int i)
{
    const Statement *s = statement_of(statement);

    return i >= 0 && i < s->operands.count ? s->operands.at[i].sign : 0;
}

int ct_key_count(const ct_statement *statement)
{
    return statement_of(statement)->pairs.count;
}

const char *ct_key(const ct_statement *statement, int i, const ct_expression **value)
{
    const Statement *s = statement_of(statement);

    if (i < 0 || i >= s->pairs.count)
        return NULL;
    if (value != NULL)
        *value = expression_of(s->pairs.at[i].value);
    return s->pairs.at[i].name;
}

const ct_expression *ct_key_value(const ct_statement *statement, const char *key)
{
    const Statement *s = statement_of(statement);

    for (int i = 0; i < s->pairs.count; i++)
        if (strcmp(s->pairs.at[i].name, key) == 0)
            return expression_of(s->pairs.at[i].value);
    return NULL;
}

const ct_expression *ct_at(const ct_statement *statement)
{
    return expression_of(statement_of(statement)->at);
}

const ct_expression *ct_versus(const ct_statement *statement)
{
    return expression_of(statement_of(statement)->versus);
}

const ct_expression *ct_near(const ct_statement *statement)
{
    return expression_of(statement_of(statement)->near_value);
}

const ct_expression *ct_within(const ct_statement *statement)
{
    return expression_of(statement_of(statement)->within);
}

const char *ct_as(const ct_statement *statement)
{
    return statement_of(statement)->as;
}

const char *ct_redirect(const ct_statement *statement, bool *append)
{
    if (append != NULL)
        *append = statement_of(statement)->append;
    return statement_of(statement)->redirect;
}

ct_status ct_error_at(const ct_statement *statement, const ct_expression *expression,
                      ct_error *error, const char *format, ...)
{
    const Statement *s = statement_of(statement);
    const Place place = expression != NULL          ? syntax_of(expression)->place
                        : s->kind == STATEMENT_VERB ? s->verb_place
                                                    : s->place;
    va_list args;

    if (error == NULL)
        return CT_FAILED;
    *error = (ct_error){
        .status = CT_FAILED, .line = place.line, .column = place.column, .width = place.width};
    va_start(args, format);
    (void)vsnprintf(error->message, sizeof error->message, format, args);
    va_end(args);
    return CT_FAILED;
}

char *ct_expression_text(const ct_expression *expression)
{
    TRANSACTION(NULL);

    Text text = {0};

    syntax_print(&text, syntax_of(expression));
    return text_done(&text);
}

const char *ct_expression_word(const ct_expression *expression)
{
    const Syntax *syntax = syntax_of(expression);

    return (syntax->kind == SYNTAX_VARIABLE && syntax->primes == 0) || syntax->kind == SYNTAX_STRING
               ? syntax->text
               : NULL;
}

/* --- places in messages --- */

/* "h8" of "run2.h8" */
static const char *without_run(const char *name)
{
    if (strncmp(name, "run", 3) != 0 && strncmp(name, "last.", 5) != 0)
        return name;
    return name + strcspn(name, ".") + (strchr(name, '.') != NULL);
}

/* a variable in it that a message is about, by its name or the run that it is of */
static const Syntax *spoken_of(const Syntax *syntax, const char *about)
{
    const size_t length = strlen(about);
    const Syntax *found = NULL;

    if (syntax->kind == SYNTAX_VARIABLE && length > 0 &&
        (strcmp(without_run(syntax->text), about) == 0 ||
         (about[length - 1] == '.' && strncmp(syntax->text, about, length) == 0)))
        found = syntax;
    for (int i = 0; i < syntax->count && found == NULL; i++)
        found = spoken_of(syntax->args[i], about);
    return found;
}

/* which of the items a message without a place is about */
void session_place_item(const Syntax *const *items, int count, Diag *diag)
{
    for (int i = 0; i < count && diag->place.line == 0; i++) {
        const Syntax *found = spoken_of(items[i], diag->about);

        if (found != NULL)
            diag->place = found->place;
    }
    if (diag->place.line == 0 && count == 1)
        diag->place = items[0]->place;
}
