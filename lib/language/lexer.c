/* lexer.c: characters to tokens
 *
 * A "\" at the end of a line makes the line break a blank, everywhere, so that places
 * are those of the physical lines. Nothing else joins lines: an unclosed bracket doesn't
 * consume the rest of a script. */
#include "language/lexer.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST_NAME = 1000 }; /* dots and members included */

Cursor cursor_at(const char *text, int line, size_t offset)
{
    Cursor cursor = {.text = text, .line = line, .next = offset};

    for (size_t i = 0; i < offset; i++)
        if (text[i] == '\n' || (text[i] == '\r' && text[i + 1] != '\n')) {
            cursor.line++;
            cursor.line_start = i + 1;
        }
    return cursor;
}

Lexer lexer_start(const Cursor *cursor, Pool *pool)
{
    Lexer lexer = {.text = cursor->text,
                   .at = cursor->next,
                   .line = cursor->line,
                   .line_start = cursor->line_start,
                   .pool = pool};

    /* byte order mark, which some editors write before the first line */
    if (lexer.at == 0 && strncmp(lexer.text, "\xEF\xBB\xBF", 3) == 0)
        lexer.at = 3;
    return lexer;
}

Place place_between(Place first, Place last)
{
    if (first.line == last.line && last.column + last.width > first.column)
        first.width = last.column + last.width - first.column;
    return first;
}

static Place place_at(const Lexer *lexer, size_t start, size_t end)
{
    return (Place){lexer->line, (int)(start - lexer->line_start) + 1,
                   end > start ? (int)(end - start) : 1};
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static bool is_name_part(char c)
{
    return is_letter(c) || is_digit(c) || c == '_';
}

/* length of a line's end; 0: there is none */
static size_t line_break(const char *text)
{
    if (text[0] == '\r' && text[1] == '\n')
        return 2;
    return text[0] == '\n' || text[0] == '\r' ? 1 : 0;
}

/* length of a line break after a "\", the "\" included; 0: there is none */
static size_t joint(const char *text)
{
    if (text[0] != '\\')
        return 0;
    return line_break(text + 1) > 0 ? 1 + line_break(text + 1) : 0;
}

static void step_line(Lexer *lexer, size_t length)
{
    lexer->at += length;
    lexer->line++;
    lexer->line_start = lexer->at;
}

static void skip_blanks(Lexer *lexer)
{
    for (;;) {
        const char *c = lexer->text + lexer->at;

        if (*c == ' ' || *c == '\t')
            lexer->at++;
        else if (joint(c) > 0)
            step_line(lexer, joint(c));
        else
            return;
    }
}

/* Skip one character of a string or comment, in which any printable one is allowed. */
static Status step_character(Lexer *lexer, Diag *diag)
{
    const char *c = lexer->text + lexer->at;
    size_t length = text_character(c);

    if (length == 0)
        return diag_at(diag, E_SYNTAX, place_at(lexer, lexer->at, lexer->at + 1),
                       "byte 0x%02X is not part of a UTF-8 character", (unsigned char)*c);
    if (((unsigned char)*c < ' ' && *c != '\t') || *c == 0x7F)
        return diag_at(diag, E_SYNTAX, place_at(lexer, lexer->at, lexer->at + 1),
                       "control character 0x%02X", (unsigned char)*c);
    lexer->at += length;
    return OK;
}

/* What a word processor or a web page makes of characters that we read. */
static const struct {
    const char *text;
    const char *meant;
} lookalikes[] = {
    {"\u2018", "'"},   {"\u2019", "'"},   {"\u2032", "'"},
    {"\u00B4", "'"},   {"\u201C", "\""},  {"\u201D", "\""},
    {"\u201E", "\""},  {"\u2033", "''"},  {"\u2212", "-"},
    {"\u2013", "-"},   {"\u2014", "-"},   {"\u00D7", "*"},
    {"\u00B7", "*"},   {"\u22C5", "*"},   {"\u00F7", "/"},
    {"\u00B2", "^2"},  {"\u00B3", "^3"},  {"\u2264", "<="},
    {"\u2265", ">="},  {"\u2260", "!="},  {"\u00B0", "deg"},
    {"\u03A9", "ohm"}, {"\u2126", "ohm"}, {"\u03BC", "u"},
    {"\u00B5", "u"},   {"\u03C0", "pi"},  {"\u00A0", "a plain blank"},
};

static Status strange_character(const Lexer *lexer, Diag *diag)
{
    static const struct {
        char c;
        const char *hint;
    } meant[] = {
        {'&', "'and' is written &&"},
        {'{', "brackets are ( ) for grouping and [ ] for vectors and units"},
        {'}', "brackets are ( ) for grouping and [ ] for vectors and units"},
        {'%', "a comment starts with #"},
        {'.',
         "a dot stands inside a name or a number, as in m3.x or 0.5; file names stand in quotes"},
        {'_', "a name starts with a letter"},
    };
    const char *c = lexer->text + lexer->at;
    size_t length = text_character(c);
    Place place = place_at(lexer, lexer->at, lexer->at + (length > 0 ? length : 1));

    if (length == 0 || (unsigned char)*c < ' ' || *c == 0x7F) {
        Lexer copy = *lexer;

        return step_character(&copy, diag);
    }
    (void)diag_at(diag, E_SYNTAX, place, "unexpected character '%.*s'", (int)length, c);
    for (int i = 0; length > 1 && i < COUNT(lookalikes); i++)
        if (strncmp(c, lookalikes[i].text, length) == 0)
            diag_hint(diag, "write %s", lookalikes[i].meant);
    if (*c == '%' && lexer->at > 0 && isdigit((unsigned char)c[-1])) {
        diag_hint(diag, "a part of a hundred is written /100");
        return E_SYNTAX;
    }
    for (int i = 0; length == 1 && i < COUNT(meant); i++)
        if (*c == meant[i].c)
            diag_hint(diag, "%s", meant[i].hint);
    return E_SYNTAX;
}

static void finish_token(Lexer *lexer, TokenKind kind, size_t start, Token *token)
{
    *token = (Token){.kind = kind,
                     .text = pool_text(lexer->pool, lexer->text + start, lexer->at - start),
                     .start = start,
                     .end = lexer->at,
                     .place = place_at(lexer, start, lexer->at)};
}

static void skip_digits(Lexer *lexer)
{
    while (is_digit(lexer->text[lexer->at]))
        lexer->at++;
}

/* NUMBER = ( digits [ "." [ digits ] ] | "." digits ) [ ( "e" | "E" ) [ "+" | "-" ] digits ] ; */
static Status read_number(Lexer *lexer, Token *token, Diag *diag)
{
    size_t start = lexer->at;
    const char *c;
    size_t sign;

    skip_digits(lexer);
    if (lexer->text[lexer->at] == '.') {
        lexer->at++;
        skip_digits(lexer);
    }
    c = lexer->text + lexer->at;
    sign = *c != '\0' && (c[1] == '+' || c[1] == '-') ? 1 : 0;
    if ((*c == 'e' || *c == 'E') && is_digit(c[1 + sign])) {
        lexer->at += 1 + sign;
        skip_digits(lexer);
    }
    finish_token(lexer, TOKEN_NUMBER, start, token);
    if (!isfinite(strtod(token->text, NULL)))
        return diag_at(diag, E_SYNTAX, token->place, "the number is too large");
    return OK;
}

/* path = NAME { "." NAME } ;   NAME = letter { letter | digit | "_" } ; */
static Status read_path(Lexer *lexer, Token *token, Diag *diag)
{
    size_t start = lexer->at;
    const char *text = lexer->text;

    for (;;) {
        while (is_name_part(text[lexer->at]))
            lexer->at++;
        if (text[lexer->at] != '.')
            break;
        if (!is_letter(text[lexer->at + 1])) {
            (void)diag_at(diag, E_SYNTAX, place_at(lexer, lexer->at, lexer->at + 1),
                          "a name must follow the dot behind '%.*s'", (int)(lexer->at - start),
                          text + start);
            diag_hint(diag, "a dot reaches a member: m3.x");
            return E_SYNTAX;
        }
        lexer->at++;
    }
    finish_token(lexer, TOKEN_PATH, start, token);
    if (lexer->at - start > LONGEST_NAME)
        return diag_at(diag, E_SYNTAX, token->place, "a name has at most %d characters",
                       LONGEST_NAME);
    return OK;
}

/* STRING = '"' { any but '"' } '"' ; */
static Status read_string(Lexer *lexer, Token *token, Diag *diag)
{
    size_t start = lexer->at;
    Place place = place_at(lexer, start, start + 1);
    Status status = OK;
    Text text = {0};

    lexer->at++;
    while (lexer->text[lexer->at] != '"') {
        const char *c = lexer->text + lexer->at;

        if (*c == '\0' || line_break(c) > 0) {
            status = diag_at(diag, E_SYNTAX, place, "the string is not closed on its line");
            diag_hint(diag, "a string ends with \" on the line on which it starts");
            goto done;
        }
        if (joint(c) > 0) {
            step_line(lexer, joint(c));
            continue;
        }
        CHECK(step_character(lexer, diag));
        text_add_n(&text, c, (size_t)(lexer->text + lexer->at - c));
    }
    lexer->at++;
    *token = (Token){.kind = TOKEN_STRING,
                     .text = pool_text(lexer->pool, text.at != NULL ? text.at : "", text.length),
                     .start = start,
                     .end = lexer->at,
                     .place = place_between(place, place_at(lexer, lexer->at - 1, lexer->at))};
done:
    text_free(&text);
    return status;
}

/* "'" touches a path or a closing bracket */
static Status read_primes(Lexer *lexer, bool touches, Token *token, Diag *diag)
{
    size_t start = lexer->at;
    bool is_after_value =
        touches && (lexer->last.kind == TOKEN_PATH || lexer->last.kind == TOKEN_PRIMES ||
                    (lexer->last.kind == TOKEN_SYMBOL && lexer->last.text[0] == ')'));

    if (!is_after_value) {
        (void)diag_at(diag, E_SYNTAX, place_at(lexer, start, start + 1),
                      "a prime must touch the variable before it");
        diag_hint(diag,
                  "a time derivative is written h8'; strings stand in double quotes: \"...\"");
        return E_SYNTAX;
    }
    while (lexer->text[lexer->at] == '\'')
        lexer->at++;
    finish_token(lexer, TOKEN_PRIMES, start, token);
    return OK;
}

static Status read_symbol(Lexer *lexer, Token *token, Diag *diag)
{
    static const char *const pairs[] = {"<=", ">=", "==", "!=", "&&", "||", ">>"};
    const char *c = lexer->text + lexer->at;
    size_t start = lexer->at;
    size_t length = 0;

    if (*c != '\0' && strchr("+-*/^()[],=<>!:~?|", *c) != NULL)
        length = 1;
    for (int i = 0; i < COUNT(pairs); i++)
        if (strncmp(c, pairs[i], 2) == 0)
            length = 2;
    if (length == 0)
        return strange_character(lexer, diag);
    if (strncmp(c, "**", 2) == 0) {
        (void)diag_at(diag, E_SYNTAX, place_at(lexer, start, start + 2), "unexpected '**'");
        diag_hint(diag, "a power is written ^");
        return E_SYNTAX;
    }
    lexer->at += length;
    finish_token(lexer, TOKEN_SYMBOL, start, token);
    return OK;
}

static Status stray_backslash(const Lexer *lexer, Diag *diag)
{
    const char *c = lexer->text + lexer->at + 1;

    (void)diag_at(diag, E_SYNTAX, place_at(lexer, lexer->at, lexer->at + 1),
                  "'\\' joins lines only as the last character of its line");
    if (*c == '\0' || line_break(c) > 0)
        diag_hint(diag, "no line follows");
    else if (c[strspn(c, " \t")] == '\0' || line_break(c + strspn(c, " \t")) > 0)
        diag_hint(diag, "remove the blanks behind it");
    return E_SYNTAX;
}

Status lexer_next(Lexer *lexer, Token *token, Diag *diag)
{
    size_t before = lexer->at;
    Token read = {.kind = TOKEN_END, .text = ""};
    const char *c;
    bool touches;

    skip_blanks(lexer);
    c = lexer->text + lexer->at;
    touches = lexer->at == before;
    if (*c == '\0' || *c == ';' || *c == '#' || line_break(c) > 0) {
        read.start = read.end = lexer->last.text != NULL ? lexer->last.end : lexer->at;
        read.place = place_at(lexer, lexer->at, lexer->at);
        /* the missing token belongs right after the last one */
        if (lexer->last.text != NULL && lexer->last.place.line == lexer->line)
            read.place.column = lexer->last.place.column + lexer->last.place.width;
    } else if (*c == '"')
        TRY(read_string(lexer, &read, diag));
    else if (*c == '\'')
        TRY(read_primes(lexer, touches, &read, diag));
    else if (*c == '\\')
        TRY(stray_backslash(lexer, diag));
    else if (is_letter(*c))
        TRY(read_path(lexer, &read, diag));
    else if (is_digit(*c) || (*c == '.' && is_digit(c[1])))
        TRY(read_number(lexer, &read, diag));
    else
        TRY(read_symbol(lexer, &read, diag));

    read.touches = touches;
    if (read.kind != TOKEN_END)
        lexer->last = read;
    *token = read;
    return OK;
}

static bool is_in_line(const Lexer *lexer)
{
    return lexer->text[lexer->at] != '\0' && line_break(lexer->text + lexer->at) == 0;
}

/* past a backslash and the end of its line */
static bool step_joint(Lexer *lexer)
{
    const size_t length = joint(lexer->text + lexer->at);

    if (length > 0)
        step_line(lexer, length);
    return length > 0;
}

Status lexer_finish(Lexer *lexer, Diag *diag)
{
    skip_blanks(lexer);
    if (lexer->text[lexer->at] == ';') {
        lexer->at++;
        return OK;
    }
    while (is_in_line(lexer))
        if (!step_joint(lexer))
            TRY(step_character(lexer, diag));
    if (lexer->text[lexer->at] != '\0')
        step_line(lexer, line_break(lexer->text + lexer->at));
    return OK;
}

void lexer_skip_line(Lexer *lexer)
{
    while (is_in_line(lexer))
        if (!step_joint(lexer))
            lexer->at++;
}

void lexer_skip_breaks(Lexer *lexer)
{
    while (line_break(lexer->text + lexer->at) > 0)
        step_line(lexer, line_break(lexer->text + lexer->at));
}

const char *text_slice(Pool *pool, const char *text, size_t start, size_t end, int *offsets)
{
    char *slice = pool_text(pool, text + start, end - start);
    size_t length = 0;

    for (size_t i = start; i < end;) {
        size_t skip = joint(text + i);

        if (skip == 0) {
            slice[length++] = text[i++];
            continue;
        }
        /* one blank for the joint and the blanks around it */
        while (length > 0 && (slice[length - 1] == ' ' || slice[length - 1] == '\t'))
            length--;
        slice[length++] = ' ';
        const size_t line = i + skip;

        for (i = line; i < end && (text[i] == ' ' || text[i] == '\t');)
            i++;
        if (offsets != NULL)
            *offsets++ = (int)length - (int)(i - line) - 1;
    }
    slice[length] = '\0';
    return slice;
}
