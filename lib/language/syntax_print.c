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
