/* text.c: growing text, edit distance */
#include "base/text.h"

#include "base/decimal.h"
#include "base/memory.h"

#include <ctype.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef COTREE_SMALL
enum { SPARE = 0 };
#else
enum { SPARE = 32 };
#endif

static void reserve(Text *text, size_t more)
{
    const size_t room = text->length + more + 1 + text->length / 2 + SPARE;

    /* what is there already, its end included, is changed in a copy */
    if (text->length + more + 1 <= text->room && !mem_is_old(text->at))
        return;
    text->at = mem_grow(text->at, room, 1);
    text->room = room;
}

void text_add_n(Text *text, const char *more, size_t length)
{
    reserve(text, length);
    memcpy(text->at + text->length, more, length);
    text->length += length;
    text->at[text->length] = '\0';
}

void text_add(Text *text, const char *more)
{
    text_add_n(text, more, strlen(more));
}

enum { USUAL = 60 }; /* characters of what is formatted; longer ones are twice */

void text_addv(Text *text, const char *format, va_list args)
{
    va_list again;
    int length;

    va_copy(again, args);
    reserve(text, USUAL);
    length = vsnprintf(text->at + text->length, USUAL + 1, format, args);
    if (length > USUAL) {
        reserve(text, (size_t)length);
        (void)vsnprintf(text->at + text->length, (size_t)length + 1, format, again);
    }
    va_end(again);
    if (length > 0)
        text->length += (size_t)length;
    text->at[text->length] = '\0';
}

void text_addf(Text *text, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    text_addv(text, format, args);
    va_end(args);
}

void text_char(Text *text, char c)
{
    reserve(text, 1);
    text->at[text->length++] = c;
    text->at[text->length] = '\0';
}

void text_fill(Text *text, char c, int count)
{
    for (int i = 0; i < count; i++)
        text_char(text, c);
}

void text_replace(Text *text, const char *more, const char *from, const char *const *to)
{
    for (; *more != '\0'; more++) {
        const char *at = strchr(from, *more);

        if (at != NULL)
            text_add(text, to[at - from]);
        else
            text_char(text, *more);
    }
}

void text_xml(Text *text, const char *more)
{
    static const char *const to[] = {"&lt;", "&gt;", "&amp;", "&quot;"};
    const size_t from = text->length;

    text_replace(text, more, "<>&\"", to);
    for (size_t i = from; i < text->length; i++)
        if ((unsigned char)text->at[i] < ' ')
            text->at[i] = ' ';
}

char *text_room(Text *text, size_t most)
{
    reserve(text, most);
    return text->at + text->length;
}

void text_extend(Text *text, char *end)
{
    *end = '\0';
    text->length = (size_t)(end - text->at);
}

void text_number(Text *text, double value, int digits)
{
    reserve(text, DECIMAL_SIZE);
    text->length += decimal_print(text->at + text->length, value, digits);
}

char *text_done(Text *text)
{
    char *done = text->at != NULL ? text->at : mem_text("", 0);

    *text = (Text){0};
    return done;
}

void text_free(Text *text)
{
    mem_free(text->at);
    *text = (Text){0};
}

int text_width(const char *text)
{
    int width = 0;

    /* every code point we print is one column wide; combining marks add none */
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++) {
        if ((c[0] & 0xC0) == 0x80)
            continue;
        if (c[0] == 0xCC || (c[0] == 0xCD && c[1] < 0xB0))
            continue;
        width++;
    }
    return width;
}

/* twice the cost of replacing a by b */
static int swap_cost(char a, char b)
{
    if (a == b)
        return 0;
    return tolower((unsigned char)a) == tolower((unsigned char)b) ? 1 : 2;
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

int text_distance(const char *a, const char *b, int limit)
{
    enum { LONGEST = 64 };
    int rows[3][LONGEST + 1];
    int *before = rows[0];
    int *last = rows[1];
    int *row = rows[2];
    int na = (int)strlen(a);
    int nb = (int)strlen(b);

    if (na > LONGEST || nb > LONGEST || abs(na - nb) > limit)
        return limit + 1;
    for (int j = 0; j <= nb; j++)
        last[j] = 2 * j;
    for (int i = 1; i <= na; i++) {
        int *oldest = before;

        row[0] = 2 * i;
        for (int j = 1; j <= nb; j++) {
            int best = last[j - 1] + swap_cost(a[i - 1], b[j - 1]);

            best = least(best, least(last[j], row[j - 1]) + 2);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                best = least(best, before[j - 2] + 2);
            row[j] = best;
        }
        before = last;
        last = row;
        row = oldest;
    }
    return (last[nb] + 1) / 2;
}

Suggest suggest_for(const char *word)
{
    return (Suggest){word, NULL, INT_MAX};
}

void suggest_offer(Suggest *suggest, const char *candidate)
{
    int length = (int)strlen(suggest->word);
    int limit = length <= 3 ? 1 : length <= 6 ? 2 : 3;
    int distance = text_distance(suggest->word, candidate, limit);

    /* a prefix of the name is the most likely mistake */
    if (length > 1 && distance > 1 && strncmp(suggest->word, candidate, (size_t)length) == 0)
        distance = 1;

    /* a short word that shares no letter is no likely slip */
    if (distance >= (int)strlen(candidate) || distance >= length + (length == 1))
        return;
    if (distance <= limit && distance < suggest->distance) {
        suggest->best = candidate;
        suggest->distance = distance;
    }
}

size_t text_character(const char *text)
{
    const unsigned char *c = (const unsigned char *)text;
    size_t length = c[0] < 0x80 ? 1 : c[0] < 0xC2 ? 0 : c[0] < 0xE0 ? 2 : c[0] < 0xF0 ? 3 : 4;

    if (c[0] > 0xF4)
        return 0;
    for (size_t i = 1; i < length; i++)
        if ((c[i] & 0xC0) != 0x80)
            return 0;
    /* overlong forms, surrogates, past the last code point */
    if ((c[0] == 0xE0 && c[1] < 0xA0) || (c[0] == 0xED && c[1] > 0x9F) ||
        (c[0] == 0xF0 && c[1] < 0x90) || (c[0] == 0xF4 && c[1] > 0x8F))
        return 0;
    return length;
}

void suggest_hint(const Suggest *suggest, Diag *diag)
{
    if (suggest->best != NULL)
        diag_hint(diag, "did you mean '%s'?", suggest->best);
}

void suggest_or_hint(const Suggest *suggest, Diag *diag, const char *format, ...)
{
    Text hint = {0};
    va_list args;

    va_start(args, format);
    text_addv(&hint, format, args);
    va_end(args);
    diag_hint(diag, "%s", hint.at);
    suggest_hint(suggest, diag);
    text_free(&hint);
}
