/* parser.c: the tokens of a statement, looked at and read; what is said where they stop making
 * sense */
#include "model/parser.h"

#include <stdio.h>
#include <string.h>

enum {
    DEEPEST =
        200 /* brackets within brackets: far more than anybody writes, far less than the stack */
};

Status parser_start(Parser *parser, Lexer *lexer)
{
    Status status = OK;
    Token token;

    do {
        CHECK(lexer_next(lexer, &token, parser->diag));
        LIST_PUSH(parser->tokens, token);
    } while (token.kind != TOKEN_END);
done:
    return status;
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

bool parser_take(Parser *parser, const char *symbol)
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

bool parser_sees_place(const Parser *parser)
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

Status parser_unexpected(const Parser *parser)
{
    const Token *token = parser_token(parser);
    const Token *before = parser_before(parser);
    bool behind_value = parser->at > 0 && (before->kind == TOKEN_NUMBER || token_is(before, ")"));
    char room[100];

    (void)diag_at(parser->diag, E_SYNTAX, token->place, "unexpected %s",
                  token_describe(token, room, sizeof room));
    if (token_is(token, ")") || token_is(token, "]"))
        diag_hint(parser->diag, "this bracket closes nothing");
    else if (token_is(token, "["))
        diag_hint(
            parser->diag,
            "a bracket is never an index: entries are written x(2); a unit in brackets stands "
            "behind a number or a vector");
    else if (token_is(token, "="))
        diag_hint(parser->diag, "a comparison is written ==");
    else if (token_is(token, ","))
        diag_hint(parser->diag, "one comma stands between two operands");
    else if (behind_value &&
             (token->kind == TOKEN_PATH || token->kind == TOKEN_NUMBER || token_is(token, "(")))
        diag_hint(parser->diag, "a product needs its *");
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
        diag_hint(parser->diag,
                  "brackets close on their line; a line goes on after '\\' at its end");
        return E_SYNTAX;
    }
    (void)parser_expected(parser, open->text[0] == '(' ? "')'" : "']'");
    if (parser_token(parser)->kind == TOKEN_PATH || parser_token(parser)->kind == TOKEN_NUMBER)
        diag_hint(parser->diag, "a product needs its *, and between arguments stands a comma");
    return E_SYNTAX;
}
