/* expression.c: tokens to expression trees, by recursive descent
 *
 * Each function follows its line of the grammar. */
#include "language/parser.h"

#include <assert.h>
#include <string.h>

/* --- nodes --- */

Syntax *syntax_new(Parser *parser, SyntaxKind kind, const char *text, Place place)
{
    Syntax *node = pool_alloc(parser->pool, sizeof *node);

    *node = (Syntax){.kind = kind,
                     .text = text,
                     .unit_text = "",
                     .height = 1,
                     .place = place,
                     .op_place = place};
    return node;
}

/* Move the arguments from number `start` of the stack on to `node`. */
Status syntax_accept(Parser *parser, Syntax *node, int start)
{
    node->count = parser->arguments.count - start;
    node->args = pool_alloc(parser->pool, (size_t)(node->count + 1) * sizeof(Syntax *));
    for (int i = 0; i < node->count; i++) {
        node->args[i] = parser->arguments.at[start + i];
        if (node->args[i]->height >= node->height)
            node->height = node->args[i]->height + 1;
    }
    parser->arguments.count = start;
    if (node->height <= SYNTAX_HEIGHT)
        return OK;
    (void)diag_at(parser->diag, E_SYNTAX, node->op_place, "more than %d operations in a row",
                  SYNTAX_HEIGHT);
    diag_hint(parser->diag, "give parts of it names of their own");
    return E_SYNTAX;
}

static Status join(Parser *parser, const Token *op, Syntax *left, Syntax *right, Syntax **out)
{
    int start = parser->arguments.count;
    Place place;
    Syntax *node;

    assert(right != NULL);
    place = left != NULL ? left->place : op->place;
    node = syntax_new(parser, left != NULL ? SYNTAX_BINARY : SYNTAX_UNARY, op->text,
                      place_between(place, right->place));
    node->op_place = op->place;
    if (left != NULL)
        LIST_PUSH(parser->arguments, left);
    LIST_PUSH(parser->arguments, right);
    *out = node;
    return syntax_accept(parser, node, start);
}

/* --- primaries --- */

/* { "'" } */
static void parse_primes(Parser *parser, Syntax *node)
{
    const Token *token = parser_token(parser);

    if (token->kind != TOKEN_PRIMES)
        return;
    node->primes = (int)strlen(token->text);
    node->place = place_between(node->place, token->place);
    parser->at++;
}

/* expr { "," expr } and the closing bracket; `open` was read */
static Status parse_arguments(Parser *parser, const Token *open, Syntax *node)
{
    int start = parser->arguments.count;
    Status status = OK;
    Syntax *argument = NULL;

    parser->brackets++;
    do {
        CHECK(parse_expression(parser, &argument));
        LIST_PUSH(parser->arguments, argument);
    } while (parser_accept(parser, ","));
    if (!parser_accept(parser, open->text[0] == '(' ? ")" : "]"))
        CHECK(parser_unclosed(parser, open));
    node->place = place_between(node->place, parser_before(parser)->place);
    CHECK(syntax_accept(parser, node, start));
done:
    parser->brackets--;
    return status;
}

static Status parse_group(Parser *parser, Syntax **out)
{
    const Token open = *parser_token(parser);
    Syntax *node = syntax_new(parser, SYNTAX_GROUP, "", open.place);

    parser->at++;
    TRY(parse_arguments(parser, &open, node));
    if (node->count != 1) {
        (void)diag_at(parser->diag, E_SYNTAX, node->place, "a vector stands in [ ], not in ( )");
        diag_hint(parser->diag, "a call's bracket touches its name: max(a, b)");
        return E_SYNTAX;
    }
    parse_primes(parser, node);
    *out = node;
    return OK;
}

/* call = path "(" expr { "," expr } ")" ;   (* "(" touches the path *)   var = path { "'" } ; */
static Status parse_named(Parser *parser, Syntax **out)
{
    const Token *name = parser_token(parser);
    Syntax *node = syntax_new(parser, SYNTAX_VARIABLE, name->text, name->place);

    parser->at++;
    if (parser_sees(parser, "(") && parser_token(parser)->touches) {
        const Token open = *parser_token(parser);

        node->kind = SYNTAX_CALL;
        parser->at++;
        if (parser_sees(parser, ")"))
            TRY(parser_expected(parser, "an argument"));
        TRY(parse_arguments(parser, &open, node));
    }
    parse_primes(parser, node);
    if (parser_sees(parser, "[") && !(parser->lists && parser->brackets == 0))
        TRY(parser_unexpected(parser));
    *out = node;
    return OK;
}

/* primary = NUMBER [ UNIT | unit ] | "[" expr { "," expr } "]" [ UNIT | unit ]
 *         | var | call { "'" } | "(" expr ")" { "'" } | STRING ; */
Status parse_primary(Parser *parser, Syntax **out)
{
    const Token token = *parser_token(parser);
    Syntax *node;

    if (token.kind == TOKEN_PATH)
        return parse_named(parser, out);
    if (parser_sees(parser, "("))
        return parse_group(parser, out);
    if (token.kind == TOKEN_NUMBER || token.kind == TOKEN_STRING) {
        node = syntax_new(parser, token.kind == TOKEN_NUMBER ? SYNTAX_NUMBER : SYNTAX_STRING,
                          token.text, token.place);
        parser->at++;
        if (token.kind == TOKEN_NUMBER)
            TRY(parse_literal_unit(parser, node));
    } else if (parser_sees(parser, "[")) {
        node = syntax_new(parser, SYNTAX_VECTOR, "", token.place);
        parser->at++;
        TRY(parse_arguments(parser, &token, node));
        TRY(parse_literal_unit(parser, node));
    } else
        return parser_expected(parser, "a value");
    *out = node;
    return OK;
}

/* unary = ( "-" | "+" | "!" ) unary | primary [ "^" unary ] ; */
static Status parse_unary(Parser *parser, Syntax **out)
{
    const Token *op = parser_token(parser);
    Syntax *value = NULL;
    Syntax *power = NULL;

    TRY(parser_enter(parser));
    if (parser_accept(parser, "-") || parser_accept(parser, "+") || parser_accept(parser, "!")) {
        TRY(parse_unary(parser, &value));
        TRY(join(parser, op, NULL, value, out));
    } else {
        TRY(parse_primary(parser, &value));
        op = parser_token(parser);
        if (parser_accept(parser, "^")) {
            TRY(parse_unary(parser, &power));
            TRY(join(parser, op, value, power, &value));
        }
        *out = value;
    }
    parser->depth--;
    return OK;
}

/* --- operators --- */

typedef Status (*Level)(Parser *parser, Syntax **out);

/* next { op next }, joined from the left; ops ended by NULL */
static Status parse_chain(Parser *parser, const char *const *ops, Level next, Syntax **out)
{
    Syntax *left = NULL;
    Syntax *right = NULL;

    TRY(next(parser, &left));
    for (int i = 0; ops[i] != NULL;) {
        const Token *op = parser_token(parser);

        if (!parser_accept(parser, ops[i])) {
            i++;
            continue;
        }
        TRY(next(parser, &right));
        TRY(join(parser, op, left, right, &left));
        i = 0;
    }
    *out = left;
    return OK;
}

/* product = unary { ( "*" | "/" ) unary } ; */
static Status parse_product(Parser *parser, Syntax **out)
{
    static const char *const ops[] = {"*", "/", NULL};

    return parse_chain(parser, ops, parse_unary, out);
}

Status parse_derivative(Parser *parser, Syntax *item, Syntax **out)
{
    const Token *op = parser_token(parser);
    Syntax *by = NULL;

    *out = item;
    if (item->kind != SYNTAX_CALL || strcmp(item->text, "d") != 0 || !parser_sees(parser, "/") ||
        parser_peek(parser, 1)->kind != TOKEN_PATH ||
        strcmp(parser_peek(parser, 1)->text, "d") != 0 || !token_is(parser_peek(parser, 2), "("))
        return OK;
    (void)parser_accept(parser, "/");
    TRY(parse_primary(parser, &by));
    return join(parser, op, item, by, out);
}

/* sum = product { ( "+" | "-" ) product } ; */
Status parse_sum(Parser *parser, Syntax **out)
{
    static const char *const ops[] = {"+", "-", NULL};

    return parse_chain(parser, ops, parse_product, out);
}

/* whether a comparison operator is next: ">" not before STRING */
bool parser_sees_comparison(const Parser *parser)
{
    static const char *const signs[] = {"<", "<=", ">=", "==", "!="};

    for (int i = 0; i < COUNT(signs); i++)
        if (parser_sees(parser, signs[i]))
            return true;
    return parser_sees(parser, ">") && parser_peek(parser, 1)->kind != TOKEN_STRING &&
           !parser_sees_stop(parser);
}

/* comp = sum [ ( "<" | "<=" | ">" | ">=" | "==" | "!=" ) sum ] ; */
static Status parse_comparison(Parser *parser, Syntax **out)
{
    Syntax *left = NULL;
    Syntax *right = NULL;

    TRY(parse_sum(parser, &left));
    if (parser_sees_comparison(parser)) {
        const Token *op = parser_token(parser);

        parser->at++;
        TRY(parse_sum(parser, &right));
        TRY(join(parser, op, left, right, &left));
        if (parser_sees_comparison(parser)) {
            (void)diag_at(parser->diag, E_SYNTAX, parser_token(parser)->place,
                          "comparisons do not chain");
            diag_hint(parser->diag, "write a < b && b < c");
            return E_SYNTAX;
        }
    }
    *out = left;
    return OK;
}

/* and = comp { "&&" comp } ; */
static Status parse_and(Parser *parser, Syntax **out)
{
    static const char *const ops[] = {"&&", NULL};

    return parse_chain(parser, ops, parse_comparison, out);
}

/* expr = and { "||" and } ; */
Status parse_expression(Parser *parser, Syntax **out)
{
    static const char *const ops[] = {"||", NULL};

    return parse_chain(parser, ops, parse_and, out);
}

Status syntax_parse_expression(const char *text, Pool *pool, Syntax **out, Diag *diag)
{
    Lexer lexer = lexer_start(&(Cursor){.text = text, .line = 1}, pool);
    Parser parser = {.text = text, .pool = pool, .diag = diag};
    Status status = OK;
    Syntax *read = NULL;

    CHECK(parser_start(&parser, &lexer));
    parser.lists = true;
    CHECK(parse_expression(&parser, &read));
    if (parser_sees(&parser, "["))
        CHECK(parse_unit(&parser, read));
    if (!parser_ends(&parser))
        CHECK(parser_unexpected(&parser));
    *out = read;
done:
    parser_free(&parser);
    return status;
}
