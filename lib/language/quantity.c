/* quantity.c: units after numbers, vectors and items
 *
 * The grammar can't determine which words are units. A word after a literal is its unit, unless "="
 * follows the word (then it is the next key) or the verb's row gives it a meaning. A unit in
 * brackets may follow anything that is shown. */
#include "language/foreign_syntax.h"
#include "language/parser.h"

#include <string.h>

/* Fails if a unit's name after a literal would make a product or quotient of it: 2 kg*m, 5 mm^2. */
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
        const Token *following = parser_peek(parser, n + 2);
        bool call = token_is(following, "(") && following->touches;

        if (token_is(op, "^"))
            n += next->kind == TOKEN_NUMBER                               ? 2
                 : token_is(next, "-") && following->kind == TOKEN_NUMBER ? 3
                                                                          : 1;
        else if ((token_is(op, "*") || token_is(op, "/")) && next->kind == TOKEN_PATH && !call &&
                 following->kind != TOKEN_PRIMES && unit_find(next->text, &unit))
            n += 2;
        else
            break;
    }
    if (n == 0)
        return OK;

    place = place_between(name->place, parser_peek(parser, n - 1)->place);
    text =
        text_slice(parser->pool, parser->text, name->start, parser_peek(parser, n - 1)->end, NULL);
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

/* what a compound unit was meant to be: other signs than * between units, "N.m", "N m"; NULL: none
 */
static const char *with_stars(const Parser *parser, const char *text)
{
    char *copy = pool_text(parser->pool, text, strlen(text));
    Unit unit;
    size_t fault;
    bool changed = false;

    for (char *c = copy; *c != '\0'; c++)
        if (strchr(". -", *c) != NULL) {
            *c = '*';
            changed = true;
        }
    return changed && unit_parse(copy, strlen(copy), &unit, &fault) ? copy : NULL;
}

/* 4k7: a prefix in the place of the decimal point */
static bool is_resistor_code(const char *word)
{
    char prefix[2] = {word[0], '\0'};

    return is_prefix(prefix) && word[1] != '\0' &&
           strspn(word + 1, "0123456789") == strlen(word + 1);
}

static Status unknown_unit(Parser *parser, const Syntax *literal, const Token *name)
{
    const char *number = literal->kind == SYNTAX_NUMBER ? literal->text : "[...]";
    const char *suggestion = strchr(name->text, '.') == NULL ? unit_suggest(name->text) : NULL;
    const char *compound = with_stars(parser, name->text);
    bool call = token_is(parser_peek(parser, 1), "(") && parser_peek(parser, 1)->touches;
    bool is_constant = strcmp(name->text, "pi") == 0 || strcmp(name->text, "t") == 0;
    Diag *diag = parser->diag;

    (void)diag_at(diag, E_UNIT, name->place, "unknown unit '%s'", name->text);
    if (is_key(parser, name->text))
        diag_hint(diag, "a key takes its '=': %s=...", name->text);
    else if (is_prefix(name->text))
        diag_hint(diag, "an SI prefix needs a unit: write %s kohm, %s kN ... or %se3", number,
                  number, number);
    else if (is_resistor_code(name->text))
        diag_hint(diag, "a prefix stands before a unit: %s.%s %cohm, or %s.%se3", number,
                  name->text + 1, name->text[0], number, name->text + 1);
    else if (compound != NULL)
        diag_hint(diag, "units multiply with *, in brackets: %s [%s]", number, compound);
    else if (foreign_syntax_hint(FOREIGN_OPERATOR, name->text) != NULL && !call)
        diag_hint(diag, "%s", foreign_syntax_hint(FOREIGN_OPERATOR, name->text));
    else if (foreign_syntax_hint(FOREIGN_UNIT, name->text) != NULL && !call)
        diag_hint(diag, "%s", foreign_syntax_hint(FOREIGN_UNIT, name->text));
    else if (suggestion != NULL && !call && !is_constant)
        diag_hint(diag, "did you mean '%s'? A product needs its *: %s*%s", suggestion, number,
                  name->text);
    else
        diag_hint(diag, "a product needs its *: %s*%s%s", number, name->text, call ? "(...)" : "");
    return E_UNIT;
}

/* unit = "[" factor { ( "*" | "/" ) factor } "]" ;   factor = ( UNIT | "1" ) [ "^" [ "-" ] NUMBER ]
 * ; */
Status parse_unit(Parser *parser, Syntax *node)
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
        return parser_unclosed(parser, open);
    close = parser_token(parser);
    parser->at++;

    inside = text_slice(parser->pool, parser->text, open->end, close->start, NULL);
    node->unit_text = text_slice(parser->pool, parser->text, open->start, close->end, NULL);
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
        const char *compound = with_stars(parser, inside);

        if (compound != NULL)
            diag_hint(parser->diag, "units multiply with *: [%s]", compound);
        else if (foreign_syntax_hint(FOREIGN_UNIT, word) != NULL)
            diag_hint(parser->diag, "%s", foreign_syntax_hint(FOREIGN_UNIT, word));
        else if (suggestion != NULL)
            diag_hint(parser->diag, "did you mean '%s'?", suggestion);
        else
            diag_hint(parser->diag, "a bracket behind a value is its unit, as in [kg*m^2]");
    } else
        diag_hint(parser->diag, "a bracket is never an index: entries are written x(2)");
    return E_UNIT;
}

/* [ UNIT | unit ]   (* UNIT not before "=" *) */
Status parse_literal_unit(Parser *parser, Syntax *node)
{
    const Token *name = parser_token(parser);

    if (parser_sees(parser, "["))
        return parse_unit(parser, node);
    if (name->kind != TOKEN_PATH || parser_sees_pair(parser) || parser_sees_stop(parser))
        return OK;
    if (!unit_find(name->text, &node->unit))
        return unknown_unit(parser, node, name);
    node->has_unit = true;
    node->unit_text = name->text;
    node->unit_place = name->place;
    node->place = place_between(node->place, name->place);
    parser->at++;
    return check_compound(parser, node, name);
}
