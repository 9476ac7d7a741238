/* operand.c: operands, between a verb and its keys: items, places, words */
#include "language/parser.h"

#include <string.h>

/* sum [ unit ]; a comparison needs brackets, because ">" writes to a file */
Status parse_shown(Parser *parser, Syntax **out)
{
    Status status = OK;

    parser->lists = true;
    CHECK(parse_sum(parser, out));
    if (parser_sees(parser, "["))
        CHECK(parse_unit(parser, *out));
    if (parser_sees_comparison(parser)) {
        (void)parser_unexpected(parser);
        diag_hint(parser->diag, "a comparison stands in brackets here: (a < b)");
        return E_SYNTAX;
    }
done:
    parser->lists = false;
    return status;
}

/* An item that is continued, or starts with a sign or a number: hint to put it in brackets. */
static Status compound_item(Parser *parser, int start)
{
    const Token fault = *parser_token(parser);
    Diag *diag = parser->diag;
    size_t first = parser->tokens.at[start].start;
    Syntax *whole;
    char room[100];

    (void)diag_at(diag, E_SYNTAX, fault.place, "unexpected %s in a list of items",
                  token_describe(&fault, room, sizeof room));
    parser->at = start;
    parser->diag = NULL;
    if (parse_sum(parser, &whole) == OK)
        diag_hint(diag, "an item that is more than a variable or a call stands in brackets: (%s)",
                  text_slice(parser->pool, parser->text, first, parser_before(parser)->end, NULL));
    else
        diag_hint(diag, "items are variables, calls and expressions in brackets");
    parser->diag = diag;
    return E_SYNTAX;
}

static bool sees_operator(const Parser *parser)
{
    static const char *const ops[] = {"+",  "-",  "*",  "/",  "^",  "<",
                                      "<=", ">=", "==", "!=", "&&", "||"};

    for (int i = 0; i < COUNT(ops); i++)
        if (parser_sees(parser, ops[i]))
            return true;
    return parser_sees(parser, ">") && !parser_sees_stop(parser);
}

/* item = ( var | call { "'" } | "d(" sum ")/d(" var ")" | "(" expr ")" { "'" } ) [ unit ] ; */
Status parse_item(Parser *parser, Syntax **out)
{
    int start = parser->at;
    Status status = OK;

    if (sees_operator(parser) || parser_token(parser)->kind == TOKEN_NUMBER ||
        parser_sees(parser, "["))
        return compound_item(parser, start);
    if (parser_token(parser)->kind != TOKEN_PATH && !parser_sees(parser, "("))
        return parser_expected(parser, "a variable");
    parser->lists = true;
    CHECK(parse_primary(parser, out));
    CHECK(parse_derivative(parser, *out, out));
    if (parser_sees(parser, "["))
        CHECK(parse_unit(parser, *out));
    if (sees_operator(parser))
        CHECK(compound_item(parser, start));
done:
    parser->lists = false;
    return status;
}

/* place = path | "0" ; */
Status parse_terminal(Parser *parser, Syntax **out)
{
    const Token *token = parser_token(parser);
    const Token *following = parser_peek(parser, 1);

    if (!parser_sees_terminal(parser)) {
        (void)parser_expected(parser, "a place (a name or 0)");
        if (token->kind == TOKEN_NUMBER)
            diag_hint(parser->diag, "names begin with a letter: n%s", token->text);
        return E_SYNTAX;
    }
    if (following->kind == TOKEN_PRIMES || (token_is(following, "(") && following->touches)) {
        (void)diag_at(parser->diag, E_SYNTAX, following->place,
                      "unexpected '%s' behind the place '%s'", following->text, token->text);
        diag_hint(parser->diag,
                  "a place is one word; a value behind it in brackets stands after a blank");
        return E_SYNTAX;
    }
    *out = syntax_new(parser, token->kind == TOKEN_PATH ? SYNTAX_VARIABLE : SYNTAX_NUMBER,
                      token->text, token->place);
    parser->at++;
    return OK;
}

/* path | "(" path ")": in brackets where a word of the row has the same name */
Status parse_edge(Parser *parser, Syntax **out)
{
    const Token open = *parser_token(parser);
    Syntax *node;
    Syntax *place = NULL;

    if (!parser_accept(parser, "("))
        return parse_terminal(parser, out);
    node = syntax_new(parser, SYNTAX_GROUP, "", open.place);
    TRY(parse_terminal(parser, &place));
    if (!parser_accept(parser, ")"))
        TRY(parser_unclosed(parser, &open));
    node->place = place_between(open.place, parser_before(parser)->place);
    LIST_PUSH(parser->arguments, place);
    TRY(syntax_accept(parser, node, parser->arguments.count - 1));
    *out = node;
    return OK;
}

Status parse_word(Parser *parser, Syntax **out)
{
    const Token *token = parser_token(parser);
    SyntaxKind kind = token->kind == TOKEN_NUMBER   ? SYNTAX_NUMBER
                      : token->kind == TOKEN_STRING ? SYNTAX_STRING
                                                    : SYNTAX_VARIABLE;

    if (kind == SYNTAX_VARIABLE && token->kind != TOKEN_PATH)
        return parser_expected(parser, "a word");
    *out = syntax_new(parser, kind, token->text, token->place);
    parser->at++;
    return OK;
}

Status parse_path(Parser *parser, const char **path, int *primes, Place *place)
{
    const Token *token = parser_token(parser);

    if (token->kind != TOKEN_PATH)
        return parser_expected(parser, "a name");
    *path = token->text;
    *place = token->place;
    *primes = 0;
    parser->at++;
    if (parser_token(parser)->kind == TOKEN_PRIMES) {
        *primes = (int)strlen(parser_token(parser)->text);
        *place = place_between(*place, parser_token(parser)->place);
        parser->at++;
    }
    return OK;
}

/* a NAME that no dot, prime or bracket follows */
Status parse_name(Parser *parser, const Token **out)
{
    const Token *name = parser_token(parser);

    if (name->kind != TOKEN_PATH)
        return parser_expected(parser, "a name");
    if (strchr(name->text, '.') != NULL) {
        (void)diag_at(parser->diag, E_NAME, name->place, "a new name has no dot");
        diag_hint(parser->diag, "a dot reaches a member of what is there: m3.x");
        return E_NAME;
    }
    parser->at++;
    *out = name;
    return OK;
}
