/* syntax_pattern.c: operands and keys, by the letters of the verb's pattern (syntax.h)
 *
 *   { operand [ "," ] } { pair [ "," ] } [ ":" statement ] [ redirect ]
 *
 * Each letter has a reader. */
#include "component/component.h"
#include "language/parser.h"
#include "language/verbs.h"

#include <string.h>

/* --- names --- */

bool word_is_reserved(const char *word, size_t length)
{
    static const char *const words[] = {"t",          "pi",    "ground", "gnd",    "energy",
                                        "constraint", "model", "count",  "modes",  "linear",
                                        "last",       "sweep", "fit",    "optimum"};

    for (int i = 0; i < COUNT(words); i++)
        if (strlen(words[i]) == length && strncmp(words[i], word, length) == 0)
            return true;
    return false;
}

bool name_is_reserved(const char *name)
{
    return word_is_reserved(name, strlen(name)) ||
           (strncmp(name, "run", 3) == 0 && name[3] != '\0' &&
            name[3 + strspn(name + 3, "0123456789")] == '\0');
}

Status parser_check_reserved(const Parser *parser, const Token *name)
{
    if (!name_is_reserved(name->text))
        return OK;
    (void)diag_at(parser->diag, E_NAME, name->place, "'%s' can't be redefined", name->text);
    diag_hint(parser->diag, "choose another name");
    return E_NAME;
}

/* words that end an operand, where the pattern has the letter */
static const struct {
    char letter;
    const char *word;
} stop_words[] = {{'y', "vs"}, {'@', "at"}, {'a', "as"}, {'C', "within"}};

const char *pattern_word(char letter)
{
    for (int i = 0; i < COUNT(stop_words); i++)
        if (stop_words[i].letter == letter)
            return stop_words[i].word;
    return NULL;
}

/* --- operands --- */

typedef Status ParseOperand(Parser *parser, Syntax **out);

static Status add_signed(Parser *parser, Statement *statement, ParseOperand *parse, int sign)
{
    Syntax *value = NULL;
    const Status status = parse(parser, &value);

    if (status != OK)
        return status;
    LIST_PUSH(statement->operands, (Operand){sign, value, value->place});
    (void)parser_accept(parser, ",");
    return OK;
}

static Status add_operand(Parser *parser, Statement *statement, ParseOperand *parse)
{
    return add_signed(parser, statement, parse, 0);
}

/* the same, required, and not a key; `what` names it */
static Status add_needed(Parser *parser, Statement *statement, ParseOperand *parse,
                         const char *what)
{
    if (parser_sees_pair(parser))
        return parser_expected(parser, what);
    return add_operand(parser, statement, parse);
}

/* n */
static Status read_name(Parser *parser, Statement *statement)
{
    const Token *name;

    if (parser_sees_pair(parser))
        TRY(parser_expected(parser, "a name"));
    TRY(parse_name(parser, &name));
    TRY(parser_check_reserved(parser, name));
    parser->at--;
    return add_operand(parser, statement, parse_terminal);
}

/* p */
static Status read_place(Parser *parser, Statement *statement)
{
    return add_needed(parser, statement, parse_terminal, "a place (a name or 0)");
}

/* P */
static Status read_place_maybe(Parser *parser, Statement *statement)
{
    return parser_sees_terminal(parser) && !parser_sees_pair(parser) ? read_place(parser, statement)
                                                                     : OK;
}

static Status check_word(const Parser *parser, const Verb *verb, const Token *token)
{
    Suggest suggest = suggest_for(token->text);
    Text list = {0};

    if (verb->words == NULL || words_hold(verb->words, token->text))
        return OK;
    for (const char *const *w = verb->words; *w != NULL; w++) {
        suggest_offer(&suggest, *w);
        text_addf(&list, "%s%s", w == verb->words ? "" : " ", *w);
    }
    (void)diag_at(parser->diag, E_SYNTAX, token->place, "'%s' knows no '%s'", verb->name,
                  token->text);
    suggest_or_hint(&suggest, parser->diag, "it takes: %s", list.at);
    text_free(&list);
    return E_SYNTAX;
}

/* w */
static Status read_word(Parser *parser, Statement *statement)
{
    const Token *token = parser_token(parser);

    TRY(add_needed(parser, statement, parse_word, "a word"));
    return check_word(parser, &statement->row, token);
}

/* W */
static Status read_word_maybe(Parser *parser, Statement *statement)
{
    const Token *token = parser_token(parser);
    const Verb *verb = &statement->row;

    return token->kind == TOKEN_PATH && !parser_sees_pair(parser) &&
                   (verb->words == NULL || words_hold(verb->words, token->text))
               ? read_word(parser, statement)
               : OK;
}

/* v */
static Status read_value(Parser *parser, Statement *statement)
{
    return add_needed(parser, statement, parse_expression, "a value");
}

/* V: as many as the component accepts without keys */
static Status read_values_maybe(Parser *parser, Statement *statement)
{
    const Component *row = statement->row.component;
    int most = row == NULL ? 1 : 0;

    for (int i = 0; row != NULL && i < row->param_count; i++)
        most += (row->params[i].use & POSITIONAL) != 0;
    while (most-- > 0 && !parser_ends(parser) && !parser_sees_pair(parser))
        TRY(read_value(parser, statement));
    return OK;
}

/* another expression after a blank, as in a list of items; with a sign there it continues the
 * expression before */
static bool sees_another(const Parser *parser)
{
    const TokenKind kind = parser_token(parser)->kind;

    return !parser_sees_stop(parser) && !parser_sees_pair(parser) &&
           (kind == TOKEN_PATH || kind == TOKEN_STRING || parser_sees(parser, "("));
}

/* e */
static Status read_expressions(Parser *parser, Statement *statement)
{
    Status status = OK;

    do {
        if (parser_sees_stop(parser))
            CHECK(parser_expected(parser, "an expression"));
        CHECK(add_operand(parser, statement, parse_shown));
    } while ((parser_took_comma(parser) && !parser_ends(parser) && !parser_sees_stop(parser)) ||
             sees_another(parser));
    if (!parser_ends(parser) && !parser_sees_stop(parser))
        CHECK(parser_unexpected(parser));
done:
    if (status == E_SYNTAX && parser->diag != NULL && parser->diag->hint[0] == '\0')
        diag_hint(parser->diag, "expressions stand between commas or blanks");
    return status;
}

static bool operands_end(const Parser *parser)
{
    return parser_ends(parser) || parser_sees_stop(parser) || parser_sees_pair(parser) ||
           parser_sees(parser, ":");
}

/* I */
static Status read_items_maybe(Parser *parser, Statement *statement)
{
    while (!operands_end(parser))
        TRY(add_operand(parser, statement, parse_item));
    return OK;
}

/* i: the sign of an item after a bar is the bar */
static Status read_items(Parser *parser, Statement *statement)
{
    do {
        const int sign = statement->operands.count > 0 && parser_accept(parser, "|") ? '|' : 0;

        if (operands_end(parser))
            return parser_expected(parser, "a variable");
        TRY(add_signed(parser, statement, parse_item, sign));
    } while (!operands_end(parser));
    return OK;
}

/* x: here a word after a number is no unit */
static Status read_mixed(Parser *parser, Statement *statement)
{
    while (!operands_end(parser)) {
        const TokenKind kind = parser_token(parser)->kind;
        const bool is_word = kind == TOKEN_NUMBER || kind == TOKEN_STRING;

        TRY(add_operand(parser, statement, is_word ? parse_word : parse_item));
    }
    return OK;
}

/* t: [ WORD ] ( { path } | { sign path } ) */
static Status read_edges(Parser *parser, Statement *statement)
{
    const Token *first = parser_token(parser);
    int edges = 0;
    bool signed_edges = false;

    if (first->kind == TOKEN_PATH && words_hold(statement->row.words, first->text))
        TRY(add_operand(parser, statement, parse_word));
    while (!operands_end(parser)) {
        int sign = parser_sees(parser, "+") ? '+' : parser_sees(parser, "-") ? '-' : 0;

        if (edges++ == 0)
            signed_edges = sign != 0;
        if (signed_edges != (sign != 0)) {
            (void)diag_at(parser->diag, E_SYNTAX, parser_token(parser)->place,
                          signed_edges ? "'%s' has no sign" : "unexpected sign '%s'",
                          parser_token(parser)->text);
            diag_hint(parser->diag,
                      "names without signs set a tree; to change one, give each name its "
                      "own sign: tree + a - b");
            return E_SYNTAX;
        }
        parser->at += sign != 0 ? 1 : 0;
        TRY(add_signed(parser, statement, parse_edge, sign));
    }
    return OK;
}

/* A file's name that isn't in quotes, up to the next blank. */
static Status unquoted(Parser *parser)
{
    const Token *token = parser_token(parser);
    size_t length = strcspn(parser->text + token->start, " \t\r\n;#\"");
    const char *name = pool_text(parser->pool, parser->text + token->start, length);
    Place place = token->place;

    if (parser_ends(parser))
        return parser_expected(parser, "a string");
    place.width = (int)length > place.width ? (int)length : place.width;
    (void)diag_at(parser->diag, E_SYNTAX, place, "expected a string before '%s'", name);
    diag_hint(parser->diag, "text and file names stand in double quotes: \"%s\"", name);
    return E_SYNTAX;
}

/* s */
static Status read_string(Parser *parser, Statement *statement)
{
    if (parser_token(parser)->kind != TOKEN_STRING)
        return unquoted(parser);
    return add_operand(parser, statement, parse_word);
}

/* o */
static Status read_string_or_word(Parser *parser, Statement *statement)
{
    const Token *token = parser_token(parser);

    return token->kind == TOKEN_PATH && words_hold(statement->row.words, token->text)
               ? read_word(parser, statement)
               : read_string(parser, statement);
}

static bool take_word(Parser *parser, const char *word)
{
    const Token *token = parser_token(parser);

    if (token->kind != TOKEN_PATH || strcmp(token->text, word) != 0)
        return false;
    parser->at++;
    return true;
}

/* C: expr [ "~" expr "within" expr ] */
static Status read_condition(Parser *parser, Statement *statement)
{
    Syntax *value = NULL;

    if (parser_sees_stop(parser))
        TRY(parser_expected(parser, "a condition"));
    TRY(parse_expression(parser, &value));
    LIST_PUSH(statement->operands, (Operand){0, value, value->place});
    if (!parser_accept(parser, "~"))
        return OK;
    TRY(parse_expression(parser, &statement->near_value));
    if (!take_word(parser, pattern_word('C')))
        TRY(parser_expected(parser, "'within'"));
    return parse_expression(parser, &statement->within);
}

/* T */
static Status read_statement(Parser *parser, Statement *statement)
{
    if (parser_ends(parser))
        TRY(parser_expected(parser, "a statement"));
    TRY(parser_enter(parser));
    statement->rest = pool_alloc(parser->pool, sizeof *statement->rest);
    TRY(parser->statement(parser, statement->rest));
    parser->depth--;
    return OK;
}

/* --- trailing words --- */

/* y */
static Status read_versus(Parser *parser, Statement *statement)
{
    return take_word(parser, pattern_word('y')) ? parse_item(parser, &statement->versus) : OK;
}

/* @ */
static Status read_at(Parser *parser, Statement *statement)
{
    Status status = OK;

    if (!take_word(parser, pattern_word('@')))
        return OK;
    CHECK(parse_expression(parser, &statement->at));
    if (parser_sees(parser, ",")) {
        status = parser_unexpected(parser);
        if (!parser_hint_comma(parser))
            diag_hint(parser->diag, "'at' stands once, behind all that is asked for there");
    }
done:
    return status;
}

/* a */
static Status read_as(Parser *parser, Statement *statement)
{
    const Token *word;

    if (!take_word(parser, pattern_word('a')))
        return OK;
    TRY(parse_name(parser, &word));
    statement->as = word->text;
    statement->as_place = word->place;
    return OK;
}

/* --- pairs --- */

static Status check_twice(const Parser *parser, const Statement *statement, const Pair *pair)
{
    for (int i = 0; i < statement->pairs.count; i++) {
        const Pair *before = &statement->pairs.at[i];

        if (before->primes == pair->primes && strcmp(before->name, pair->name) == 0)
            return diag_at(parser->diag, E_SYNTAX, pair->name_place, "'%s%.*s' is given twice",
                           pair->name, pair->primes < 9 ? pair->primes : 9, "'''''''''");
    }
    return OK;
}

/* mass==2, mass = = 2 */
static Status refuse_equals(const Parser *parser)
{
    (void)parser_unexpected(parser);
    diag_hint(parser->diag, "a value is given with a single =");
    return E_SYNTAX;
}

/* expr; of what is evaluated at an instant, as items of print are, a sum */
static Status parse_pair_value(Parser *parser, const char *pattern, Syntax **out)
{
    if (strchr(pattern, '@') == NULL)
        return parse_expression(parser, out);
    TRY(parse_sum(parser, out));
    if (!parser_sees_comparison(parser) && !parser_sees(parser, "&&") && !parser_sees(parser, "||"))
        return OK;
    (void)parser_unexpected(parser);
    diag_hint(parser->diag, "a comparison stands in brackets here: (a < b)");
    return E_SYNTAX;
}

/* pair = var "=" expr ; */
static Status parse_pair(Parser *parser, Statement *statement)
{
    Pair pair = {0};

    TRY(parse_path(parser, &pair.name, &pair.primes, &pair.name_place));
    TRY(check_twice(parser, statement, &pair));
    if (parser_sees(parser, "=="))
        TRY(refuse_equals(parser));
    if (!parser_accept(parser, "="))
        TRY(parser_expected(parser, "'='"));
    if (parser_sees(parser, "="))
        TRY(refuse_equals(parser));
    TRY(parse_pair_value(parser, statement->row.pattern, &pair.value));
    LIST_PUSH(statement->pairs, pair);
    (void)parser_accept(parser, ",");
    return OK;
}

/* Tokens after a pair that don't start another one. */
static Status after_pair(const Parser *parser, const Statement *statement)
{
    const Pair *last = &statement->pairs.at[statement->pairs.count - 1];
    const Token *token = parser_token(parser);
    bool product =
        parser_before(parser)->kind == TOKEN_NUMBER || parser_before(parser)->text[0] == ')';

    (void)diag_at(parser->diag, E_SYNTAX, token->place, "unexpected '%s' behind the value of '%s'",
                  token->text, last->name);
    if (!parser_hint_comma(parser) &&
        (token->kind == TOKEN_PATH || token->kind == TOKEN_NUMBER || parser_sees(parser, "(")))
        diag_hint(parser->diag, "behind the first '=' stand only pairs, as in %s=...%s", last->name,
                  product ? "; a product needs its *" : "");
    return E_SYNTAX;
}

static bool pairs_end(const Parser *parser)
{
    return parser_ends(parser) || parser_sees_stop(parser) || parser_sees(parser, ":") ||
           parser_sees(parser, ">") || parser_sees(parser, ">>");
}

/* = */
static Status read_pairs(Parser *parser, Statement *statement)
{
    if (statement->operands.count > 0 && !parser_sees_pair(parser) &&
        strchr(statement->row.pattern, 'n') == NULL)
        return OK;
    TRY(parse_pair(parser, statement));
    while (!pairs_end(parser)) {
        if (!parser_sees_pair(parser))
            TRY(after_pair(parser, statement));
        TRY(parse_pair(parser, statement));
    }
    return OK;
}

static Status check_key(const Parser *parser, const Verb *verb)
{
    const Token *token = parser_token(parser);
    Suggest suggest = suggest_for(token->text);
    Text list = {0};

    for (int i = 0; verb_key(verb, i) != NULL; i++) {
        if (strcmp(verb_key(verb, i), token->text) == 0) {
            text_free(&list);
            return OK;
        }
        suggest_offer(&suggest, verb_key(verb, i));
        text_addf(&list, " %s", verb_key(verb, i));
    }
    (void)diag_at(parser->diag, E_NAME, token->place, "'%s' has no key '%s'", verb->name,
                  token->text);
    suggest_or_hint(&suggest, parser->diag, "its keys:%s", list.at != NULL ? list.at : " none");
    text_free(&list);
    return E_NAME;
}

/* k */
static Status read_keys(Parser *parser, Statement *statement)
{
    while (!pairs_end(parser)) {
        bool nearly = strcmp(parser_peek(parser, 1)->text, "==") == 0;

        if (!parser_sees_pair(parser) && !nearly)
            return statement->pairs.count == 0 ? parser_unexpected(parser)
                                               : after_pair(parser, statement);
        TRY(check_key(parser, &statement->row));
        TRY(parse_pair(parser, statement));
    }
    return OK;
}

/* --- the end of a statement --- */

/* ":" statement */
static Status read_colon(Parser *parser, Statement *statement)
{
    if (!parser_accept(parser, ":"))
        return parser_expected(parser, "':' and the statement to repeat");
    return read_statement(parser, statement);
}

/* redirect = ( ">" | ">>" ) STRING ; */
static Status read_redirect(Parser *parser, Statement *statement)
{
    const Token *sign = parser_token(parser);
    const Token *file = parser_peek(parser, 1);

    if (!parser_sees(parser, ">") && !parser_sees(parser, ">>"))
        return OK;
    if (file->kind != TOKEN_STRING) {
        (void)diag_at(parser->diag, E_SYNTAX, sign->place,
                      "expected the file's name in quotes behind '%s'", sign->text);
        diag_hint(parser->diag,
                  "'%s' writes to a file: > \"name\"; a comparison stands in brackets here",
                  sign->text);
        return E_SYNTAX;
    }
    statement->redirect = file->text;
    statement->append = strcmp(sign->text, ">>") == 0;
    parser->at += 2;
    if (!parser_ends(parser)) {
        (void)parser_unexpected(parser);
        diag_hint(parser->diag, "the file comes last");
        return E_SYNTAX;
    }
    return OK;
}

static Status check_end(const Parser *parser, const Statement *statement)
{
    if (parser_ends(parser))
        return OK;
    if ((parser_sees(parser, ">") || parser_sees(parser, ">>")) &&
        strchr(statement->row.pattern, '>') == NULL) {
        (void)diag_at(parser->diag, E_SYNTAX, parser_token(parser)->place,
                      "'%s' prints nothing that could go to a file", statement->verb);
        diag_hint(parser->diag, "'help %s' explains it", statement->verb);
        return E_SYNTAX;
    }
    return parser_unexpected(parser);
}

/* --- verbs --- */

static const struct {
    char letter;
    Status (*read)(Parser *parser, Statement *statement);
} readers[] = {
    {'n', read_name},         {'p', read_place},          {'P', read_place_maybe},
    {'w', read_word},         {'W', read_word_maybe},     {'v', read_value},
    {'V', read_values_maybe}, {'e', read_expressions},    {'i', read_items},
    {'I', read_items_maybe},  {'x', read_mixed},          {'t', read_edges},
    {'s', read_string},       {'o', read_string_or_word}, {'C', read_condition},
    {'T', read_statement},    {'y', read_versus},         {'@', read_at},
    {'a', read_as},           {'k', read_keys},           {'=', read_pairs},
    {':', read_colon},        {'>', read_redirect},
};

static Status read_letter(Parser *parser, char letter, Statement *statement)
{
    for (int i = 0; i < COUNT(readers); i++)
        if (readers[i].letter == letter)
            return readers[i].read(parser, statement);
    return OK;
}

/* { operand [ "," ] } { pair [ "," ] } [ ":" statement ] [ redirect ] */
Status parse_pattern(Parser *parser, Statement *statement)
{
    const char *pattern = statement->row.pattern;
    const char *stops[COUNT(stop_words) + 1] = {NULL};
    int count = 0;
    Status status = OK;

    for (int i = 0; i < COUNT(stop_words); i++)
        if (strchr(pattern, stop_words[i].letter) != NULL)
            stops[count++] = stop_words[i].word;
    parser->stops = stops;
    parser->row = &statement->row;
    parser->prints = strpbrk(pattern, ">!") != NULL;

    for (const char *letter = pattern; *letter != '\0'; letter++) {
        CHECK(read_letter(parser, *letter, statement));
        while (letter[1] == '*' && !operands_end(parser))
            CHECK(read_letter(parser, *letter, statement));
    }
    if (statement->rest == NULL)
        CHECK(check_end(parser, statement));
done:
    if (status != OK && statement->rest == NULL && parser->diag != NULL &&
        parser->diag->hint[0] == '\0') {
        Text usage = {0};

        verb_usage(&usage, &statement->row);
        diag_hint(parser->diag, "usage: %s", usage.at != NULL ? usage.at : statement->verb);
        text_free(&usage);
    }
    parser->stops = NULL;
    parser->row = NULL;
    parser->prints = false;
    return status;
}
