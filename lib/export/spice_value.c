/* spice_value.c: numbers and expressions of SPICE, as texts of ours
 *
 *   number  = digits [ exponent ] [ suffix ] { letter }
 *   value   = number | name | "{" expr "}" | "'" expr "'"
 *   expr    = piece [ "?" expr ":" expr ]        the piece is copied word by word
 *
 * Operators and their ranks are those of ours, but for ** (a power) and ?: (if). */
#include "export/spice_value.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool spice_number(const char *word, double *out)
{
    /* the longer first: m is a thousandth, meg a million, mil a thousandth of an inch */
    static const struct {
        const char *suffix;
        double scale;
    } suffixes[] = {{"meg", 1e6}, {"mil", 25.4e-6}, {"t", 1e12}, {"g", 1e9},
                    {"k", 1e3},   {"m", 1e-3},      {"u", 1e-6}, {"n", 1e-9},
                    {"p", 1e-12}, {"f", 1e-15},     {"a", 1e-18}};
    const char *digits = word + (word[0] == '-' || word[0] == '+');
    char text[64];
    double scale = 1;
    char *end;
    size_t length;

    if (!isdigit((unsigned char)digits[0]) &&
        !(digits[0] == '.' && isdigit((unsigned char)digits[1])))
        return false;
    if (digits[0] == '0' && tolower((unsigned char)digits[1]) == 'x')
        return false;
    *out = strtod(word, &end);

    /* scaled as decimals are read, so that 0.1u is 1e-7 */
    length = (size_t)(end - word);
    if (strncmp(end, "\xc2\xb5", 2) == 0) {
        scale = 1e-6;
        end += 2;
    }
    for (int i = 0; i < COUNT(suffixes) && scale == 1; i++)
        if (strncasecmp(end, suffixes[i].suffix, strlen(suffixes[i].suffix)) == 0) {
            scale = suffixes[i].scale;
            end += strlen(suffixes[i].suffix);
        }
    while (isalpha((unsigned char)*end))
        end++;
    if (*end != '\0')
        return false;
    if (scale == 25.4e-6 || length > 40 || memchr(word, 'e', length) != NULL ||
        memchr(word, 'E', length) != NULL) {
        *out *= scale;
    } else if (scale != 1) {
        Text decimal = {0};

        memcpy(text, word, length);
        text[length] = '\0';
        text_addf(&decimal, "%se%d", text, (int)lrint(log10(scale)));
        *out = strtod(decimal.at, NULL);
        text_free(&decimal);
    }
    return isfinite(*out);
}

/* --- expressions --- */

/* what a call of SPICE is here: @1 and @2 are its arguments */
static const struct {
    const char *name;
    int args;
    const char *form;
} calls[] = {
    {"sin", 1, "sin(@1)"},     {"cos", 1, "cos(@1)"},
    {"tan", 1, "tan(@1)"},     {"asin", 1, "asin(@1)"},
    {"acos", 1, "acos(@1)"},   {"atan", 1, "atan(@1)"},
    {"arctan", 1, "atan(@1)"}, {"sinh", 1, "sinh(@1)"},
    {"cosh", 1, "cosh(@1)"},   {"tanh", 1, "tanh(@1)"},
    {"exp", 1, "exp(@1)"},     {"ln", 1, "log(@1)"},
    {"log", 1, "log(@1)"},     {"log10", 1, "(log(@1)/log(10))"},
    {"sqrt", 1, "sqrt(@1)"},   {"abs", 1, "abs(@1)"},
    {"sgn", 1, "sign(@1)"},    {"floor", 1, "floor(@1)"},
    {"min", 2, "min(@1, @2)"}, {"max", 2, "max(@1, @2)"},
    {"pow", 2, "((@1)^(@2))"}, {"pwr", 2, "(sign(@1)*abs(@1)^(@2))"},
};

enum { DEEPEST = 60 };

typedef struct Reader {
    Import *import;
    const char *at;
    int depth;
    const char *why;
} Reader;

static bool fail(Reader *r, const char *why)
{
    if (r->why == NULL)
        r->why = why;
    return false;
}

/* a name in lower case, the import's */
static const char *take_name(Reader *r)
{
    const char *begin = r->at;
    char *name;

    while (isalnum((unsigned char)*r->at) || *r->at == '_' || *r->at == '.')
        r->at++;
    name = pool_text(r->import->pool, begin, (size_t)(r->at - begin));
    for (char *c = name; *c != '\0'; c++)
        *c = (char)tolower((unsigned char)*c);
    return name;
}

static bool read_until(Reader *r, const char *ends, Text *out);

static bool read_call(Reader *r, const char *name, Text *out)
{
    Text args[2] = {{0}, {0}};
    int row = 0, count = 0;
    bool good = true;

    while (row < COUNT(calls) && strcmp(calls[row].name, name) != 0)
        row++;
    if (row == COUNT(calls))
        return fail(r, import_text(r->import, "there is no '%s()' here", name));
    while (good && count < calls[row].args) {
        r->at++;
        good = read_until(r, ",)", &args[count++]);
        good = good && (*r->at == (count < calls[row].args ? ',' : ')') ||
                        fail(r, "a call has another number of arguments"));
    }
    for (const char *form = calls[row].form; good && *form != '\0'; form++) {
        if (*form == '@')
            text_add(out, args[*++form - '1'].at);
        else
            text_char(out, *form);
    }
    r->at += good;
    text_free(&args[0]);
    text_free(&args[1]);
    return good;
}

static bool read_name(Reader *r, Text *out)
{
    const char *name = take_name(r);
    const char *mine = import_known(r->import, SPICE_PARAMETER, name);

    if (*r->at == '(')
        return read_call(r, name, out);
    if (mine == NULL && strcmp(name, "pi") == 0)
        mine = "pi";
    if (mine == NULL)
        return fail(r, import_text(r->import, "'%s' is no parameter", name));
    text_add(out, mine);
    return true;
}

static bool read_number(Reader *r, Text *out)
{
    const char *begin = r->at;
    double value;

    while (isalnum((unsigned char)*r->at) || *r->at == '.' ||
           ((*r->at == '+' || *r->at == '-') && tolower((unsigned char)r->at[-1]) == 'e' &&
            isdigit((unsigned char)r->at[1])))
        r->at++;

    const char *word = pool_text(r->import->pool, begin, (size_t)(r->at - begin));

    if (!spice_number(word, &value))
        return fail(r, import_text(r->import, "'%s' is no number", word));
    text_add(out, import_number(r->import, value));
    return true;
}

static bool read_piece(Reader *r, Text *out)
{
    static const char *const pairs[] = {"<=", ">=", "==", "!=", "&&", "||"};
    const char c = *r->at;

    if (isspace((unsigned char)c)) {
        r->at++;
        return true;
    }
    if (isalpha((unsigned char)c) || c == '_')
        return read_name(r, out);
    if (isdigit((unsigned char)c) || c == '.')
        return read_number(r, out);
    if (c == '(') {
        text_char(out, '(');
        r->at++;
        if (!read_until(r, ")", out))
            return false;
        text_char(out, ')');
        r->at++;
        return true;
    }
    if (strncmp(r->at, "**", 2) == 0) {
        text_char(out, '^');
        r->at += 2;
        return true;
    }
    for (int i = 0; i < COUNT(pairs); i++)
        if (strncmp(r->at, pairs[i], 2) == 0) {
            text_addf(out, " %s ", pairs[i]);
            r->at += 2;
            return true;
        }
    if (c != '\0' && strchr("+-*/^<>!", c) != NULL) {
        text_char(out, c);
        r->at++;
        return true;
    }
    return fail(r, import_text(r->import, "'%s' can't be read in an expression", r->at));
}

/* up to one of the characters, which isn't consumed, or to the end; `?` makes the text before a
 * condition */
static bool read_until(Reader *r, const char *ends, Text *out)
{
    Text piece = {0}, yes = {0}, no = {0};
    bool good = ++r->depth <= DEEPEST || fail(r, "brackets within brackets, too deep");

    while (good && *r->at != '\0' && strchr(ends, *r->at) == NULL) {
        if (*r->at == '?') {
            r->at++;
            good = read_until(r, ":", &yes);
            r->at += good;
            good = good && read_until(r, ends, &no);
            if (good) {
                text_addf(out, "if(%s, %s, %s)", piece.at != NULL ? piece.at : "", yes.at, no.at);
                text_free(&piece);
            }
            break;
        }
        good = read_piece(r, &piece);
    }
    if (good && *r->at == '\0' && ends[0] != '\0')
        good = fail(r, "a bracket isn't closed");
    text_add(out, piece.at != NULL ? piece.at : "");
    text_free(&piece);
    text_free(&yes);
    text_free(&no);
    r->depth--;
    return good;
}

/* the text in braces or quotes, without them; NULL: neither */
static const char *inside(Import *import, const char *word)
{
    const size_t length = strlen(word);
    const char closing = word[0] == '{' ? '}' : word[0] == '\'' ? '\'' : '\0';

    if (closing == '\0' || length < 2 || word[length - 1] != closing)
        return NULL;
    return pool_text(import->pool, word + 1, length - 2);
}

SpiceValue spice_of(Import *import, double number)
{
    const char *alone = import_number(import, number);

    return (SpiceValue){alone[0] == '-' ? import_text(import, "(%s)", alone) : alone, alone, true,
                        number};
}

bool spice_value(Import *import, const char *word, SpiceValue *out, const char **why)
{
    const char *expression = inside(import, word);
    Reader reader = {.import = import, .at = expression != NULL ? expression : word};
    Text text = {0};
    double number;
    bool good;

    if (spice_number(reader.at, &number)) {
        *out = spice_of(import, number);
        return true;
    }
    good = read_until(&reader, "", &text);
    if (good) {
        const bool is_one = text.at[strcspn(text.at, "+-*/^<>=!&| ")] == '\0';
        const char *alone = import_text(import, "%s", text.at);

        *out = (SpiceValue){.text = is_one ? alone : import_text(import, "(%s)", alone),
                            .alone = alone};
    } else {
        *why = reader.why;
    }
    text_free(&text);
    return good;
}

void spice_names(const char *word, void (*meet)(void *context, const char *name), void *context)
{
    Text name = {0};

    for (const char *at = word; *at != '\0';) {
        const bool begins = isalpha((unsigned char)*at) || *at == '_';

        if (!begins && !isdigit((unsigned char)*at)) {
            at++;
            continue;
        }
        for (; isalnum((unsigned char)*at) || *at == '_' || *at == '.'; at++)
            text_char(&name, (char)tolower((unsigned char)*at));
        if (begins)
            meet(context, name.at);
        text_free(&name);
    }
}
