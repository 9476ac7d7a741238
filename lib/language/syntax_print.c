/* syntax_print.c: an expression's tree, copied and back to text */
#include "language/syntax.h"

#include <string.h>

Syntax *syntax_copy(Pool *pool, const Syntax *syntax)
{
    Syntax *copy = pool_alloc(pool, sizeof *copy);

    *copy = *syntax;
    copy->text = pool_text(pool, syntax->text, strlen(syntax->text));
    copy->unit_text = pool_text(pool, syntax->unit_text, strlen(syntax->unit_text));
    copy->args = pool_alloc(pool, sizeof *copy->args * ((size_t)syntax->count + 1));
    for (int i = 0; i < syntax->count; i++)
        copy->args[i] = syntax_copy(pool, syntax->args[i]);
    return copy;
}

static const char *text_copy(Pool *pool, const char *text)
{
    return text != NULL ? pool_text(pool, text, strlen(text)) : NULL;
}

void statement_copy(Pool *pool, const Statement *from, Statement *to)
{
    const int operands = from->operands.count, pairs = from->pairs.count;
    const size_t arguments = (size_t)from->argument_count;

    *to = *from;
    to->pool = pool;
    to->offsets = NULL;
    to->name = text_copy(pool, from->name);
    to->text = text_copy(pool, from->text);
    to->redirect = text_copy(pool, from->redirect);
    to->arguments = pool_alloc(pool, sizeof *to->arguments * (arguments + 1));
    for (size_t i = 0; i < arguments; i++)
        to->arguments[i] = text_copy(pool, from->arguments[i]);
    to->value = from->value != NULL ? syntax_copy(pool, from->value) : NULL;
    to->operands.at = pool_alloc(pool, sizeof *to->operands.at * ((size_t)operands + 1));
    to->operands.room = operands;
    for (int i = 0; i < operands; i++) {
        to->operands.at[i] = from->operands.at[i];
        to->operands.at[i].value = syntax_copy(pool, from->operands.at[i].value);
    }
    to->pairs.at = pool_alloc(pool, sizeof *to->pairs.at * ((size_t)pairs + 1));
    to->pairs.room = pairs;
    for (int i = 0; i < pairs; i++) {
        to->pairs.at[i] = from->pairs.at[i];
        to->pairs.at[i].name = text_copy(pool, from->pairs.at[i].name);
        to->pairs.at[i].value = syntax_copy(pool, from->pairs.at[i].value);
    }
}

/* --- a copy with another place --- */

typedef struct SyntaxPrintMove {
    const Statement *from;
    const char *text;
    int line, column;
    int longer; /* the new text up to any place after the verb, in bytes */
} SyntaxPrintMove;

static Place moved(const SyntaxPrintMove *move, Place place)
{
    const Statement *from = move->from;

    if (place.line == 0)
        return place;
    return (Place){move->line,
                   move->column + place.column + from->offsets[place.line - from->place.line] +
                       move->longer,
                   place.width};
}

/* Joined lines are one, so that a tree ends behind its last branch, or the bracket after that. */
static void end_in_line(const SyntaxPrintMove *move, Syntax *syntax)
{
    const Place last = syntax->args[syntax->count - 1]->place;
    const char *end = move->text + last.column + last.width - move->column;

    syntax->place = place_between(syntax->place, last);
    if (syntax->kind != SYNTAX_UNARY && syntax->place.column < syntax->args[0]->place.column)
        syntax->place.width += (int)strcspn(end, ")]") + 1;
}

/* Returns whether the tree was on several lines. */
static bool move_syntax(const SyntaxPrintMove *move, Syntax *syntax)
{
    const int line = syntax->place.line;
    bool spans = false;

    syntax->place = moved(move, syntax->place);
    syntax->op_place = moved(move, syntax->op_place);
    syntax->unit_place = moved(move, syntax->unit_place);
    for (int i = 0; i < syntax->count; i++) {
        const bool is_below = syntax->args[i]->place.line != line;

        spans = move_syntax(move, syntax->args[i]) || is_below || spans;
    }
    if (spans)
        end_in_line(move, syntax);
    return spans;
}

void statement_copy_to(Pool *pool, const Statement *from, const char *text, int line, int column,
                       Statement *to)
{
    const SyntaxPrintMove move = {from, text, line, column,
                                  (int)strlen(text) - (int)strlen(from->text)};

    statement_copy(pool, from, to);
    to->text = text_copy(pool, text);
    to->place = (Place){line, column, (int)strlen(text)};
    if (from->kind == STATEMENT_VERB)
        to->verb_place = (Place){line, column + (from->is_virtual ? (int)strlen("virtual ") : 0),
                                 (int)strlen(from->verb)};
    else
        to->name_place = moved(&move, from->name_place);
    if (to->value != NULL)
        (void)move_syntax(&move, to->value);
    for (int i = 0; i < to->operands.count; i++) {
        to->operands.at[i].place = moved(&move, to->operands.at[i].place);
        (void)move_syntax(&move, to->operands.at[i].value);
    }
    for (int i = 0; i < to->pairs.count; i++) {
        to->pairs.at[i].name_place = moved(&move, to->pairs.at[i].name_place);
        (void)move_syntax(&move, to->pairs.at[i].value);
    }
}

/* --- text --- */

static void print_arguments(Text *text, const Syntax *syntax)
{
    for (int i = 0; i < syntax->count; i++) {
        text_add(text, i > 0 ? ", " : "");
        syntax_print(text, syntax->args[i]);
    }
}

/* products without blanks, sums with: -a*b + c */
static void print_binary(Text *text, const Syntax *syntax)
{
    bool tight = strchr("*/^", syntax->text[0]) != NULL;

    syntax_print(text, syntax->args[0]);
    text_addf(text, tight ? "%s" : " %s ", syntax->text);
    syntax_print(text, syntax->args[1]);
}

void syntax_print(Text *text, const Syntax *syntax)
{
    switch (syntax->kind) {
    case SYNTAX_NUMBER:
    case SYNTAX_VARIABLE:
        text_add(text, syntax->text);
        break;
    case SYNTAX_STRING:
        text_addf(text, "\"%s\"", syntax->text);
        break;
    case SYNTAX_CALL:
        text_addf(text, "%s(", syntax->text);
        print_arguments(text, syntax);
        text_char(text, ')');
        break;
    case SYNTAX_VECTOR:
        text_char(text, '[');
        print_arguments(text, syntax);
        text_char(text, ']');
        break;
    case SYNTAX_GROUP:
        text_char(text, '(');
        print_arguments(text, syntax);
        text_char(text, ')');
        break;
    case SYNTAX_UNARY:
        text_add(text, syntax->text);
        syntax_print(text, syntax->args[0]);
        break;
    case SYNTAX_BINARY:
        print_binary(text, syntax);
        break;
    }
    text_fill(text, '\'', syntax->primes);
    if (syntax->has_unit)
        text_addf(text, " %s", syntax->unit_text);
}

static void print_definition(Text *text, const Statement *statement)
{
    text_add(text, statement->name);
    for (int i = 0; i < statement->argument_count; i++)
        text_addf(text, "%s%s", i == 0 ? "(" : ", ", statement->arguments[i]);
    text_add(text, statement->argument_count > 0 ? ") = " : " = ");
    syntax_print(text, statement->value);
}

void statement_print(Text *text, const Statement *statement)
{
    if (statement->kind != STATEMENT_VERB) {
        print_definition(text, statement);
        return;
    }
    text_addf(text, "%s%s", statement->is_virtual ? "virtual " : "", statement->verb);
    for (int i = 0; i < statement->operands.count; i++) {
        const Operand *operand = &statement->operands.at[i];

        text_char(text, ' ');
        if (operand->sign != 0)
            text_addf(text, "%c ", operand->sign);
        syntax_print(text, operand->value);
    }
    for (int i = 0; i < statement->pairs.count; i++) {
        const Pair *pair = &statement->pairs.at[i];

        text_addf(text, " %s", pair->name);
        text_fill(text, '\'', pair->primes);
        text_char(text, '=');
        syntax_print(text, pair->value);
    }
}
