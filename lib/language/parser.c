/* parser.c: reads the tokens of a statement, and reports syntax errors */
#include "language/parser.h"
#include "language/foreign_syntax.h"
#include "language/functions.h"

#include <stdio.h>
#include <string.h>

enum {
    DEEPEST =
        200 /* brackets within brackets: far more than anybody writes, far less than the stack */
};

Status parser_start(Parser *parser, Lexer *lexer)
{
    Token token;

    do {
        TRY(lexer_next(lexer, &token, parser->diag));
        LIST_PUSH(parser->tokens, token);
    } while (token.kind != TOKEN_END);
    return OK;
}

void parser_free(Parser *parser)
{
    LIST_FREE(parser->tokens);
    LIST_FREE(parser->arguments);
}

const Token *parser_peek(const Parser *parser, int n)
{
    int last = parser->tokens.count - 1;

    return &parser->tokens.at[parser->at + n < last ? parser->at + n : last];
}

const Token *parser_token(const Parser *parser)
{
    return parser_peek(parser, 0);
}

const Token *parser_before(const Parser *parser)
{
    return &parser->tokens.at[parser->at > 0 ? parser->at - 1 : 0];
}

bool token_is(const Token *token, const char *symbol)
{
    return token->kind == TOKEN_SYMBOL && strcmp(token->text, symbol) == 0;
}

bool parser_sees(const Parser *parser, const char *symbol)
{
    return token_is(parser_token(parser), symbol);
}

bool parser_accept(Parser *parser, const char *symbol)
{
    if (!parser_sees(parser, symbol))
        return false;
    parser->at++;
    return true;
}

bool parser_took_comma(const Parser *parser)
{
    return token_is(parser_before(parser), ",");
}

bool parser_ends(const Parser *parser)
{
    return parser_token(parser)->kind == TOKEN_END;
}

bool parser_sees_pair(const Parser *parser)
{
    int primes = parser_peek(parser, 1)->kind == TOKEN_PRIMES ? 1 : 0;

    return parser_token(parser)->kind == TOKEN_PATH &&
           token_is(parser_peek(parser, 1 + primes), "=");
}

bool parser_sees_stop(const Parser *parser)
{
    const Token *token = parser_token(parser);

    if (token->kind == TOKEN_PATH)
        for (const char *const *stop = parser->stops; stop != NULL && *stop != NULL; stop++)
            if (strcmp(*stop, token->text) == 0)
                return true;
    return parser->prints && parser->brackets == 0 &&
           (token_is(token, ">") || token_is(token, ">>"));
}

bool parser_sees_terminal(const Parser *parser)
{
    const Token *token = parser_token(parser);

    return token->kind == TOKEN_PATH ||
           (token->kind == TOKEN_NUMBER && strcmp(token->text, "0") == 0);
}

/* --- messages --- */

const char *token_describe(const Token *token, char room[], size_t size)
{
    if (token->kind == TOKEN_END)
        return "the end of the statement";
    if (token->kind == TOKEN_STRING)
        (void)snprintf(room, size, "the string \"%.40s\"", token->text);
    else
        (void)snprintf(room, size, "'%.60s'", token->text);
    return room;
}

Status parser_expected(const Parser *parser, const char *what)
{
    const Token *token = parser_token(parser);
    char room[100];

    (void)diag_at(parser->diag, E_SYNTAX, token->place, "expected %s %s %s", what,
                  token->kind == TOKEN_END ? "at" : "before",
                  token_describe(token, room, sizeof room));
    if (token_is(token, "="))
        diag_hint(parser->diag, "a comparison is written ==");
    return E_SYNTAX;
}

bool parser_hint_comma(const Parser *parser)
{
    const int comma = token_is(parser_token(parser), ",") ? 0 : -1;
    const Token *sign, *whole, *part;

    if (parser->at + comma < 1)
        return false;
    sign = parser_peek(parser, comma);
    whole = parser_peek(parser, comma - 1);
    part = parser_peek(parser, comma + 1);
    if (!token_is(sign, ",") || whole->kind != TOKEN_NUMBER || part->kind != TOKEN_NUMBER ||
        whole->end != sign->start || part->start != sign->end)
        return false;
    diag_hint(parser->diag, "decimals stand behind a point: %s.%s%s", whole->text, part->text,
              strlen(part->text) == 3 ? "; thousands have no comma" : "");
    return true;
}

/* what was meant, by the tokens about the place */
static const char *unexpected_hint(const Parser *parser)
{
    const Token *token = parser_token(parser), *following = parser_peek(parser, 1);
    const Token *before = parser_before(parser);
    const bool is_first = parser->at == 0;
    Function row;
    const bool is_operand = token->kind == TOKEN_PATH || token->kind == TOKEN_NUMBER;

    if (token_is(token, ")") || token_is(token, "]"))
        return "this bracket closes nothing";
    if (token_is(token, "["))
        return "a bracket is never an index: entries are written x(2); a unit in brackets stands "
               "behind a number or a vector";
    if (token_is(token, "="))
        return "a comparison is written ==";
    if (token_is(token, ","))
        return "one comma stands between two operands";
    if (token_is(token, "|"))
        return "'or' is written ||; a single bar stands between items of 'plot'";
    if (token_is(token, "?"))
        return "a choice is written if(c, a, b)";
    if (token_is(token, "<") && token_is(following, ">"))
        return "'not equal' is written !=";
    if (token->kind == TOKEN_PATH && foreign_syntax_hint(FOREIGN_OPERATOR, token->text) != NULL)
        return foreign_syntax_hint(FOREIGN_OPERATOR, token->text);
    if (!is_first && is_operand && before->kind == TOKEN_PATH && strcmp(before->text, "not") == 0)
        return foreign_syntax_hint(FOREIGN_OPERATOR, "not");
    if (!is_first && is_operand && before->kind == TOKEN_PATH && function_find(before->text, &row))
        return "a function's argument stands in brackets: sin(2)";
    if (!is_first && (before->kind == TOKEN_NUMBER || token_is(before, ")")) &&
        (is_operand || token_is(token, "(")))
        return "a product needs its *";
    return NULL;
}

Status parser_unexpected(const Parser *parser)
{
    const char *hint = unexpected_hint(parser);
    char room[100];

    (void)diag_at(parser->diag, E_SYNTAX, parser_token(parser)->place, "unexpected %s",
                  token_describe(parser_token(parser), room, sizeof room));
    if (!parser_hint_comma(parser) && hint != NULL)
        diag_hint(parser->diag, "%s", hint);
    return E_SYNTAX;
}

Status parser_enter(Parser *parser)
{
    if (parser->depth >= DEEPEST) {
        (void)diag_at(parser->diag, E_SYNTAX, parser_token(parser)->place,
                      "nested more than %d deep", DEEPEST);
        diag_hint(parser->diag, "give parts of it names of their own");
        return E_SYNTAX;
    }
    parser->depth++;
    return OK;
}

Status parser_unclosed(const Parser *parser, const Token *open)
{
    if (parser_ends(parser)) {
        (void)diag_at(parser->diag, E_SYNTAX, open->place, "'%s' is not closed", open->text);
        if (parser->text[parser_token(parser)->start] == ';')
            diag_hint(parser->diag, "entries of a vector stand between commas");
        else
            diag_hint(parser->diag,
                      "brackets close on their line; a line goes on after '\\' at its end");
        return E_SYNTAX;
    }
    (void)parser_expected(parser, open->text[0] == '(' ? "')'" : "']'");
    if (parser_token(parser)->kind == TOKEN_PATH || parser_token(parser)->kind == TOKEN_NUMBER)
        diag_hint(parser->diag, "a product needs its *, and between arguments stands a comma");
    return E_SYNTAX;
}
