/* complete_units.c: completion of units after a number, and in brackets
 *
 * Units of the dimension that is expected there: by the row of the key, by the variable that is
 * set, or by the expression that is shown. */
#include "present/complete_impl.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

const Param *key_param(const TypedLine *line, const Verb *verb, const char *key)
{
    const Component *row = verb->component;
    const char *member = key;
    int i;

    if (verb->offers == OFFERS_SETTABLE) {
        const Instance *instance = model_owner(line->known->model, key, &member);

        row = instance != NULL ? instance->row : NULL;
    }
    i = row != NULL ? component_param(row, member) : -1;
    return i >= 0 ? &row->params[i] : NULL;
}

/* what a unit at that place should measure */
typedef struct UnitQuery {
    int count; /* of dimensions; 0: not known */
    Dimension dimension[2];
    const char *text; /* units of a row, between bars; NULL: none */
} UnitQuery;

static void want_row(UnitQuery *wanted, const char *text)
{
    wanted->text = text;
    while (text != NULL && *text != '\0' && wanted->count < COUNT(wanted->dimension)) {
        const size_t length = strcspn(text, "|");
        Unit unit;
        size_t fault;

        if (unit_parse(text, length, &unit, &fault))
            wanted->dimension[wanted->count++] = unit.dimension;
        text += length + (text[length] == '|');
    }
}

static void want_item(UnitQuery *wanted, const Model *model, const char *text)
{
    Pool *pool = pool_new(0);
    Syntax *syntax;
    Diag ignored = {0};

    if (syntax_parse_expression(text, pool, &syntax, &ignored) == OK &&
        model_dimension(model, syntax, wanted->dimension))
        wanted->count = 1;
    pool_free(pool);
}

static const char *positional_unit(const Component *row)
{
    for (int i = 0; row != NULL && i < row->param_count; i++)
        if ((row->params[i].use & POSITIONAL) != 0)
            return row->params[i].unit;
    return NULL;
}

/* after a number: by its key, or by the verb's value without a key */
static void want_number(UnitQuery *wanted, const TypedLine *line, const Verb *verb, const char *key)
{
    const Param *param = key != NULL && verb != NULL ? key_param(line, verb, key) : NULL;

    if (param != NULL)
        want_row(wanted, param->unit);
    else if (key == NULL && verb != NULL)
        want_row(wanted, positional_unit(verb->component));
    else if (verb != NULL && strchr(verb->pattern, '=') != NULL)
        want_item(wanted, line->known->model, key);
}

static size_t skip_back(const char *text, size_t end)
{
    while (end > 0 && isspace((unsigned char)text[end - 1]))
        end--;
    return end;
}

/* start of the item that ends there: after a blank or comma outside brackets; of expressions after
 * a comma */
static size_t item_start(const TypedLine *line, size_t end, bool is_expression)
{
    size_t verb = strcspn(line->text, " \t");
    int depth = 0;

    while (end > verb + 1) {
        const char c = line->text[end - 1];

        depth += (c == ')' || c == ']') - (c == '(' || c == '[');
        if (depth < 0 || (depth == 0 && (strchr(",|=", c) != NULL ||
                                         (!is_expression && isspace((unsigned char)c)))))
            break;
        end--;
    }
    return end;
}

/* whether what ends there is a number, or a vector */
static bool ends_number(const char *text, size_t end)
{
    size_t from = end;

    if (end > 0 && text[end - 1] == ']')
        return true;
    while (from > 0 && is_word_letter(text[from - 1]))
        from--;
    return from < end && isdigit((unsigned char)text[text[from] == '.' ? from + 1 : from]);
}

/* Position of the opening bracket around the cursor, with only units between; false: none. */
static bool find_bracket(const TypedLine *line, size_t *at)
{
    size_t i = line->word;

    while (i > 0 && (isalnum((unsigned char)line->text[i - 1]) || strchr("*/^", line->text[i - 1])))
        i--;
    *at = i;
    return i > 0 && line->text[i - 1] == '[';
}

/* a count of cycles is no angular rate */
static bool fits(const UnitQuery *wanted, const Unit *unit)
{
    bool fits = wanted->count == 0;

    for (int i = 0; i < wanted->count; i++)
        fits = fits || (dimension_same(wanted->dimension[i], unit->dimension) &&
                        !(unit->is_cycles && dimension_has_angle(wanted->dimension[i])));
    return fits;
}

/* what every keyboard has, and the language reads */
static bool is_ascii(const char *word)
{
    while (*word != '\0' && (unsigned char)*word < 128)
        word++;
    return *word == '\0';
}

static int offer_if_fits(TypedLine *line, const UnitQuery *wanted, const char *word)
{
    Unit unit;

    if (!is_ascii(word) || !unit_find(word, &unit) || !fits(wanted, &unit))
        return 0;
    offer(line, word);
    return 1;
}

/* names of the table, with common prefixes or the typed one; returns their number */
static int offer_fitting(TypedLine *line, const UnitQuery *wanted)
{
    const bool is_begun = line->prefix[0] != '\0';
    const char *prefix, *name;
    int count = 0;

    for (int p = 0; (prefix = unit_prefix(p)) != NULL && (is_begun || p == 0); p++)
        for (int i = 0; (name = unit_name(i)) != NULL; i++) {
            char word[40];

            (void)snprintf(word, sizeof word, "%s%s", prefix, name);
            count += offer_if_fits(line, wanted, word);
        }
    for (int i = 0; !is_begun && (name = unit_common(i)) != NULL; i++)
        count += offer_if_fits(line, wanted, name);
    return count;
}

void offer_any_unit(TypedLine *line)
{
    const UnitQuery any = {0};

    (void)offer_fitting(line, &any);
}

/* in brackets: the unit of the row or of the item as a whole, and what one may be made of */
static void offer_compound(TypedLine *line, const UnitQuery *wanted, bool is_first)
{
    if (is_first && wanted->text != NULL)
        offer_alternatives(line, wanted->text);
    for (int i = 0; is_first && wanted->text == NULL && i < wanted->count; i++) {
        Text whole = {0};

        dimension_print(&whole, wanted->dimension[i]);
        offer(line, whole.at);
        text_free(&whole);
    }
    if (!is_first || offer_fitting(line, wanted) == 0)
        offer_any_unit(line);
}

bool offer_units(TypedLine *line, const Verb *verb, const char *key)
{
    const bool shows = verb != NULL && strpbrk(verb->pattern, "iIxe") != NULL;
    UnitQuery wanted = {0};
    size_t open, end;

    if (find_bracket(line, &open)) {
        end = skip_back(line->text, open - 1);
        if (ends_number(line->text, end)) {
            want_number(&wanted, line, verb, key);
        } else if (shows && key == NULL && end > 0 &&
                   (is_word_letter(line->text[end - 1]) || strchr(")'", line->text[end - 1]))) {
            const size_t from = item_start(line, end, strchr(verb->pattern, 'e') != NULL);
            char *item = mem_text(line->text + from, end - from);

            want_item(&wanted, line->known->model, item);
            mem_free(item);
        } else {
            return false;
        }
        offer_compound(line, &wanted, open == line->word);
        return true;
    }
    end = line->is_glued ? line->word : skip_back(line->text, line->word);
    if (line->prefix[0] == '\0' || strchr(line->prefix, '.') != NULL ||
        !ends_number(line->text, end) || line->text[end - 1] == ']')
        return false;
    want_number(&wanted, line, verb, key);
    (void)offer_fitting(line, &wanted);
    return line->is_glued || verb == NULL;
}
