/* parser.c: tokens to expression trees, by recursive descent
 *
 * Each function stands under its line of the grammar. The one thing that the grammar
 * can't say is which words are units: a word behind a literal is its unit, unless "="
 * stands behind it (then it is the next key) or the verb's row gives it a meaning. */
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

static bool is_symbol(const Token *token, const char *symbol)
{
    return token->kind == TOKEN_SYMBOL && strcmp(token->text, symbol) == 0;
}

bool parser_sees(const Parser *parser, const char *symbol)
{
    return is_symbol(parser_token(parser), symbol);
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
    return is_symbol(parser_before(parser), ",");
}

bool parser_ends(const Parser *parser)
{
    return parser_token(parser)->kind == TOKEN_END;
}

bool parser_sees_pair(const Parser *parser)
{
    int primes = parser_peek(parser, 1)->kind == TOKEN_PRIMES ? 1 : 0;

    return parser_token(parser)->kind == TOKEN_PATH &&
           is_symbol(parser_peek(parser, 1 + primes), "=");
}

bool parser_sees_stop(const Parser *parser)
{
    const Token *token = parser_token(parser);

    if (token->kind == TOKEN_PATH)
        for (const char *const *stop = parser->stops; stop != NULL && *stop != NULL; stop++)
            if (strcmp(*stop, token->text) == 0)
                return true;
    return parser->prints && parser->brackets == 0 &&
           (is_symbol(token, ">") || is_symbol(token, ">>"));
}

bool parser_sees_place(const Parser *parser)
{
    const Token *token = parser_token(parser);

    return token->kind == TOKEN_PATH ||
           (token->kind == TOKEN_NUMBER && strcmp(token->text, "0") == 0);
}

/* --- messages --- */

static const char *describe(const Token *token, char room[], size_t size)
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
                  token->kind == TOKEN_END ? "at" : "before", describe(token, room, sizeof room));
    if (is_symbol(token, "="))
        diag_hint(parser->diag, "a comparison is written ==");
    return E_SYNTAX;
}

Status parser_unexpected(const Parser *parser)
{
    const Token *token = parser_token(parser);
    const Token *before = parser_before(parser);
    bool behind_value = parser->at > 0 && (before->kind == TOKEN_NUMBER || is_symbol(before, ")"));
    char room[100];

    (void)diag_at(parser->diag, E_SYNTAX, token->place, "unexpected %s",
                  describe(token, room, sizeof room));
    if (is_symbol(token, ")") || is_symbol(token, "]"))
        diag_hint(parser->diag, "this bracket closes nothing");
    else if (is_symbol(token, "["))
        diag_hint(
            parser->diag,
            "a bracket is never an index: entries are written x(2); a unit in brackets stands "
            "behind a number or a vector");
    else if (is_symbol(token, "="))
        diag_hint(parser->diag, "a comparison is written ==");
    else if (is_symbol(token, ","))
        diag_hint(parser->diag, "one comma stands between two operands");
    else if (behind_value &&
             (token->kind == TOKEN_PATH || token->kind == TOKEN_NUMBER || is_symbol(token, "(")))
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

static Status unclosed(const Parser *parser, const Token *open)
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

/* --- nodes --- */

static Syntax *new_node(Parser *parser, SyntaxKind kind, const char *text, Place place)
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

/* Hand `node` the arguments that were put aside since there were `start`. */
static Status take_arguments(Parser *parser, Syntax *node, int start)
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
    Place place = left != NULL ? left->place : op->place;
    Syntax *node = new_node(parser, left != NULL ? SYNTAX_BINARY : SYNTAX_UNARY, op->text,
                            place_between(place, right->place));

    node->op_place = op->place;
    if (left != NULL)
        LIST_PUSH(parser->arguments, left);
    LIST_PUSH(parser->arguments, right);
    *out = node;
    return take_arguments(parser, node, start);
}

/* --- units --- */

/* A unit's name behind a literal would make a product or quotient of it: 2 kg*m, 5 mm^2. */
static Status check_compound(Parser *parser, const Syntax *literal, const Token *name)
{
    int n = 0;
    Unit unit;
    Place place;
    const char *text;
    const char *number;

    for (;;) {
        const Token *op = parser_peek(parser, n);
        const Token *next = parser_peek(parser, n + 1);
        const Token *behind = parser_peek(parser, n + 2);
        bool call = is_symbol(behind, "(") && behind->touches;

        if (is_symbol(op, "^"))
            n += next->kind == TOKEN_NUMBER                             ? 2
                 : is_symbol(next, "-") && behind->kind == TOKEN_NUMBER ? 3
                                                                        : 1;
        else if ((is_symbol(op, "*") || is_symbol(op, "/")) && next->kind == TOKEN_PATH && !call &&
                 behind->kind != TOKEN_PRIMES && unit_find(next->text, &unit))
            n += 2;
        else
            break;
    }
    if (n == 0)
        return OK;

    place = place_between(name->place, parser_peek(parser, n - 1)->place);
    text = text_slice(parser->pool, parser->text, name->start, parser_peek(parser, n - 1)->end);
    number = literal->kind == SYNTAX_NUMBER ? literal->text : "[...]";
    (void)diag_at(parser->diag, E_UNIT, place, "'%s %s' may be a unit or a product", number, text);
    diag_hint(parser->diag, "a compound unit stands in brackets: %s [%s]; otherwise (%s %s)%s",
              number, text, number, name->text, text + strlen(name->text));
    return E_UNIT;
}

/* Whether the word is a key of the verb whose "=" was forgotten. */
static bool is_key(const Parser *parser, const char *word)
{
    for (int i = 0; parser->row != NULL && verb_key(parser->row, i) != NULL; i++)
        if (strcmp(verb_key(parser->row, i), word) == 0)
            return true;
    return false;
}

static bool is_prefix(const char *word)
{
    static const char *const prefixes[] = {"f", "p", "n", "u",   "m",  "k",
                                           "M", "G", "T", "meg", "Meg"};

    for (int i = 0; i < COUNT(prefixes); i++)
        if (strcmp(prefixes[i], word) == 0)
            return true;
    return false;
}

static Status unknown_unit(Parser *parser, const Syntax *literal, const Token *name)
{
    const char *number = literal->kind == SYNTAX_NUMBER ? literal->text : "[...]";
    const char *suggestion = strchr(name->text, '.') == NULL ? unit_suggest(name->text) : NULL;
    bool call = is_symbol(parser_peek(parser, 1), "(") && parser_peek(parser, 1)->touches;

    (void)diag_at(parser->diag, E_UNIT, name->place, "unknown unit '%s'", name->text);
    if (is_key(parser, name->text))
        diag_hint(parser->diag, "a key takes its '=': %s=...", name->text);
    else if (is_prefix(name->text))
        diag_hint(parser->diag, "an SI prefix needs a unit: write %s kohm, %s kN ... or %se3",
                  number, number, number);
    else if (suggestion != NULL && !call)
        diag_hint(parser->diag, "did you mean '%s'? A product needs its *", suggestion);
    else
        diag_hint(parser->diag, "a product needs its *: %s*%s%s", number, name->text,
                  call ? "(...)" : "");
    return E_UNIT;
}

/* unit = "[" factor { ( "*" | "/" ) factor } "]" ;   factor = ( UNIT | "1" ) [ "^" [ "-" ] NUMBER ]
 * ; */
static Status parse_bracket_unit(Parser *parser, Syntax *node)
{
    const Token *open = parser_token(parser);
    const Token *close;
    const char *inside;
    size_t fault = 0;
    Place place = open->place;

    do
        parser->at++;
    while (!parser_sees(parser, "]") && !parser_ends(parser));
    if (parser_ends(parser))
        return unclosed(parser, open);
    close = parser_token(parser);
    parser->at++;

    inside = text_slice(parser->pool, parser->text, open->end, close->start);
    node->unit_text = text_slice(parser->pool, parser->text, open->start, close->end);
    node->unit_place = place_between(open->place, close->place);
    node->has_unit = true;
    if (unit_parse(inside, strlen(inside), &node->unit, &fault)) {
        node->place = place_between(node->place, node->unit_place);
        return OK;
    }
    if (strlen(inside) == 0 || close->place.line != open->place.line)
        place = node->unit_place;
    else {
        place.column += 1 + (int)fault;
        place.width = (int)strcspn(inside + fault, " \t*/^");
        place.width = place.width > 0 ? place.width : 1;
    }
    (void)diag_at(parser->diag, E_UNIT, place, "'%s' is no unit", node->unit_text);
    if (node->kind == SYNTAX_NUMBER || node->kind == SYNTAX_VECTOR) {
        const char *word =
            pool_text(parser->pool, inside + fault, strcspn(inside + fault, " \t*/^"));
        const char *suggestion = word[0] != '\0' ? unit_suggest(word) : NULL;

        if (suggestion != NULL)
            diag_hint(parser->diag, "did you mean '%s'?", suggestion);
        else
            diag_hint(parser->diag, "a bracket behind a value is its unit, as in [kg*m^2]");
    } else
        diag_hint(parser->diag, "a bracket is never an index: entries are written x(2)");
    return E_UNIT;
}

/* [ UNIT | unit ]   (* UNIT not before "=" *) */
static Status parse_literal_unit(Parser *parser, Syntax *node)
{
    const Token *name = parser_token(parser);
    Status status = OK;

    if (parser_sees(parser, "["))
        return parse_bracket_unit(parser, node);
    if (name->kind != TOKEN_PATH || parser_sees_pair(parser) || parser_sees_stop(parser))
        return OK;
    if (!unit_find(name->text, &node->unit))
        return unknown_unit(parser, node, name);
    node->has_unit = true;
    node->unit_text = name->text;
    node->unit_place = name->place;
    node->place = place_between(node->place, name->place);
    parser->at++;
    CHECK(check_compound(parser, node, name));
done:
    return status;
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
    Syntax *argument;

    parser->brackets++;
    do {
        CHECK(parse_expression(parser, &argument));
        LIST_PUSH(parser->arguments, argument);
    } while (parser_take(parser, ","));
    if (!parser_take(parser, open->text[0] == '(' ? ")" : "]"))
        CHECK(unclosed(parser, open));
    node->place = place_between(node->place, parser_before(parser)->place);
    CHECK(take_arguments(parser, node, start));
done:
    parser->brackets--;
    return status;
}

static Status parse_group(Parser *parser, Syntax **out)
{
    const Token open = *parser_token(parser);
    Syntax *node = new_node(parser, SYNTAX_GROUP, "", open.place);
    Status status = OK;

    parser->at++;
    CHECK(parse_arguments(parser, &open, node));
    if (node->count != 1) {
        (void)diag_at(parser->diag, E_SYNTAX, node->place, "a vector stands in [ ], not in ( )");
        diag_hint(parser->diag, "a call's bracket touches its name: max(a, b)");
        return E_SYNTAX;
    }
    parse_primes(parser, node);
    *out = node;
done:
    return status;
}

/* call = path "(" expr { "," expr } ")" ;   (* "(" touches the path *)   var = path { "'" } ; */
static Status parse_named(Parser *parser, Syntax **out)
{
    const Token *name = parser_token(parser);
    Syntax *node = new_node(parser, SYNTAX_VARIABLE, name->text, name->place);
    Status status = OK;

    parser->at++;
    if (parser_sees(parser, "(") && parser_token(parser)->touches) {
        const Token open = *parser_token(parser);

        node->kind = SYNTAX_CALL;
        parser->at++;
        if (parser_sees(parser, ")"))
            CHECK(parser_expected(parser, "an argument"));
        CHECK(parse_arguments(parser, &open, node));
    }
    parse_primes(parser, node);
    if (parser_sees(parser, "[") && !(parser->lists && parser->brackets == 0))
        CHECK(parser_unexpected(parser));
    *out = node;
done:
    return status;
}

/* primary = NUMBER [ UNIT | unit ] | "[" expr { "," expr } "]" [ UNIT | unit ]
 *         | var | call { "'" } | "(" expr ")" { "'" } | STRING ; */
static Status parse_primary(Parser *parser, Syntax **out)
{
    const Token token = *parser_token(parser);
    Status status = OK;
    Syntax *node;

    if (token.kind == TOKEN_PATH)
        return parse_named(parser, out);
    if (parser_sees(parser, "("))
        return parse_group(parser, out);
    if (token.kind == TOKEN_NUMBER || token.kind == TOKEN_STRING) {
        node = new_node(parser, token.kind == TOKEN_NUMBER ? SYNTAX_NUMBER : SYNTAX_STRING,
                        token.text, token.place);
        parser->at++;
        if (token.kind == TOKEN_NUMBER)
            CHECK(parse_literal_unit(parser, node));
    } else if (parser_sees(parser, "[")) {
        node = new_node(parser, SYNTAX_VECTOR, "", token.place);
        parser->at++;
        CHECK(parse_arguments(parser, &token, node));
        CHECK(parse_literal_unit(parser, node));
    } else
        return parser_expected(parser, "a value");
    *out = node;
done:
    return status;
}

/* unary = ( "-" | "+" | "!" ) unary | primary [ "^" unary ] ; */
static Status parse_unary(Parser *parser, Syntax **out)
{
    const Token *op = parser_token(parser);
    Status status = OK;
    Syntax *value;
    Syntax *power;

    CHECK(parser_enter(parser));
    if (parser_take(parser, "-") || parser_take(parser, "+") || parser_take(parser, "!")) {
        CHECK(parse_unary(parser, &value));
        CHECK(join(parser, op, NULL, value, out));
    } else {
        CHECK(parse_primary(parser, &value));
        op = parser_token(parser);
        if (parser_take(parser, "^")) {
            CHECK(parse_unary(parser, &power));
            CHECK(join(parser, op, value, power, &value));
        }
        *out = value;
    }
    parser->depth--;
done:
    return status;
}

/* --- operators --- */

typedef Status (*Level)(Parser *parser, Syntax **out);

/* next { op next }, joined from the left; ops ended by NULL */
static Status parse_chain(Parser *parser, const char *const *ops, Level next, Syntax **out)
{
    Status status = OK;
    Syntax *left;
    Syntax *right;

    CHECK(next(parser, &left));
    for (int i = 0; ops[i] != NULL;) {
        const Token *op = parser_token(parser);

        if (!parser_take(parser, ops[i])) {
            i++;
            continue;
        }
        CHECK(next(parser, &right));
        CHECK(join(parser, op, left, right, &left));
        i = 0;
    }
    *out = left;
done:
    return status;
}

/* product = unary { ( "*" | "/" ) unary } ; */
static Status parse_product(Parser *parser, Syntax **out)
{
    static const char *const ops[] = {"*", "/", NULL};

    return parse_chain(parser, ops, parse_unary, out);
}

/* sum = product { ( "+" | "-" ) product } ; */
static Status parse_sum(Parser *parser, Syntax **out)
{
    static const char *const ops[] = {"+", "-", NULL};

    return parse_chain(parser, ops, parse_product, out);
}

/* whether a comparison's sign comes next: ">" not before STRING */
static bool sees_comparison(const Parser *parser)
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
    Status status = OK;
    Syntax *left;
    Syntax *right;

    CHECK(parse_sum(parser, &left));
    if (sees_comparison(parser)) {
        const Token *op = parser_token(parser);

        parser->at++;
        CHECK(parse_sum(parser, &right));
        CHECK(join(parser, op, left, right, &left));
        if (sees_comparison(parser)) {
            (void)diag_at(parser->diag, E_SYNTAX, parser_token(parser)->place,
                          "comparisons do not chain");
            diag_hint(parser->diag, "write a < b && b < c");
            return E_SYNTAX;
        }
    }
    *out = left;
done:
    return status;
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

/* --- operands --- */

/* sum [ unit ]; a comparison stands in brackets, since ">" writes to a file */
Status parse_shown(Parser *parser, Syntax **out)
{
    Status status = OK;

    parser->lists = true;
    CHECK(parse_sum(parser, out));
    if (parser_sees(parser, "["))
        CHECK(parse_bracket_unit(parser, *out));
    if (sees_comparison(parser)) {
        (void)parser_unexpected(parser);
        diag_hint(parser->diag, "a comparison stands in brackets here: (a < b)");
        return E_SYNTAX;
    }
done:
    parser->lists = false;
    return status;
}

/* An item that goes on, or starts with a sign or a number: show it in brackets. */
static Status compound_item(Parser *parser, int start)
{
    const Token fault = *parser_token(parser);
    Diag *diag = parser->diag;
    size_t first = parser->tokens.at[start].start;
    Syntax *whole;
    char room[100];

    (void)diag_at(diag, E_SYNTAX, fault.place, "unexpected %s in a list of items",
                  describe(&fault, room, sizeof room));
    parser->at = start;
    parser->diag = NULL;
    if (parse_sum(parser, &whole) == OK)
        diag_hint(diag, "an item that is more than a variable or a call stands in brackets: (%s)",
                  text_slice(parser->pool, parser->text, first, parser_before(parser)->end));
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

/* item = ( var | call { "'" } | "(" expr ")" { "'" } ) [ unit ] ; */
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
    if (parser_sees(parser, "["))
        CHECK(parse_bracket_unit(parser, *out));
    if (sees_operator(parser))
        CHECK(compound_item(parser, start));
done:
    parser->lists = false;
    return status;
}

/* place = path | "0" ; */
Status parse_place(Parser *parser, Syntax **out)
{
    const Token *token = parser_token(parser);
    const Token *behind = parser_peek(parser, 1);

    if (!parser_sees_place(parser))
        return parser_expected(parser, "a place (a name or 0)");
    if (behind->kind == TOKEN_PRIMES || (is_symbol(behind, "(") && behind->touches)) {
        (void)diag_at(parser->diag, E_SYNTAX, behind->place,
                      "unexpected '%s' behind the place '%s'", behind->text, token->text);
        diag_hint(parser->diag,
                  "a place is one word; a value behind it in brackets stands after a blank");
        return E_SYNTAX;
    }
    *out = new_node(parser, token->kind == TOKEN_PATH ? SYNTAX_VARIABLE : SYNTAX_NUMBER,
                    token->text, token->place);
    parser->at++;
    return OK;
}

/* path | "(" path ")": in brackets where a word of the row has the same name */
Status parse_edge(Parser *parser, Syntax **out)
{
    const Token open = *parser_token(parser);
    Status status = OK;
    Syntax *node;
    Syntax *place;

    if (!parser_take(parser, "("))
        return parse_place(parser, out);
    node = new_node(parser, SYNTAX_GROUP, "", open.place);
    CHECK(parse_place(parser, &place));
    if (!parser_take(parser, ")"))
        CHECK(unclosed(parser, &open));
    node->place = place_between(open.place, parser_before(parser)->place);
    LIST_PUSH(parser->arguments, place);
    CHECK(take_arguments(parser, node, parser->arguments.count - 1));
    *out = node;
done:
    return status;
}

Status parse_word(Parser *parser, Syntax **out)
{
    const Token *token = parser_token(parser);
    SyntaxKind kind = token->kind == TOKEN_NUMBER   ? SYNTAX_NUMBER
                      : token->kind == TOKEN_STRING ? SYNTAX_STRING
                                                    : SYNTAX_VARIABLE;

    if (kind == SYNTAX_VARIABLE && token->kind != TOKEN_PATH)
        return parser_expected(parser, "a word");
    *out = new_node(parser, kind, token->text, token->place);
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

Status syntax_parse_expression(const char *text, Pool *pool, Syntax **out, Diag *diag)
{
    Lexer lexer = lexer_start(text, 0, 1, pool);
    Parser parser = {.text = text, .pool = pool, .diag = diag};
    Status status = OK;
    Syntax *read = NULL;

    CHECK(parser_start(&parser, &lexer));
    parser.lists = true;
    CHECK(parse_expression(&parser, &read));
    if (parser_sees(&parser, "["))
        CHECK(parse_bracket_unit(&parser, read));
    if (!parser_ends(&parser))
        CHECK(parser_unexpected(&parser));
    *out = read;
done:
    parser_free(&parser);
    return status;
}
