/* text.h: text that grows, and words that nearly match
 *
 * A Text starts as {0}; text_done() hands its characters over as a new string. */
#ifndef COTREE_BASE_TEXT_H
#define COTREE_BASE_TEXT_H

#include "base/diag.h"

#include <stdarg.h>
#include <stddef.h>

typedef struct Text {
    char *at; /* ended by a NUL once anything was added; NULL before */
    size_t length;
    size_t room;
} Text;

void text_add(Text *text, const char *more);
void text_add_n(Text *text, const char *more, size_t length);
void text_addf(Text *text, const char *format, ...) PRINTF(2, 3);
void text_addv(Text *text, const char *format, va_list args) PRINTF(2, 0);
void text_char(Text *text, char c);
void text_fill(Text *text, char c, int count);
/* `more` with to[i] instead of the i-th character of `from` */
void text_replace(Text *text, const char *more, const char *from, const char *const *to);
void text_xml(Text *text, const char *more); /* as content or attribute; no control characters */
/* Room for so many more characters at the end. After writing, call text_extend() with their end. */
char *text_room(Text *text, size_t most);
void text_extend(Text *text, char *end);
void text_number(Text *text, double value, int digits); /* shortest of %.{digits}g; 17 is exact */
char *text_done(Text *text); /* new string, never NULL; `text` is empty again */
void text_free(Text *text);

/* bytes of the UTF-8 character that starts here (RFC 3629); 0: it isn't one */
size_t text_character(const char *text);
/* width of a UTF-8 string on a terminal, in columns */
int text_width(const char *text);

/* Edit distance with neighbours swapped as one step (Damerau 1964), letters of
 * the other case as half; stops counting above `limit`. O(n*m). */
int text_distance(const char *a, const char *b, int limit);

/* Best of `words` for a mistyped `word`: NULL unless near enough to be meant.
 * Offer words one at a time: `Suggest s = suggest_for(w); suggest_offer(&s, ...)`. */
typedef struct Suggest {
    const char *word;
    const char *best; /* borrowed from the offers; NULL when none is near */
    int distance;
} Suggest;
Suggest suggest_for(const char *word);
void suggest_offer(Suggest *suggest, const char *candidate);
/* "did you mean 'best'?" as the hint of the message; none where nothing is near */
void suggest_hint(const Suggest *suggest, Diag *diag);
/* the same, or this hint where nothing is near */
void suggest_or_hint(const Suggest *suggest, Diag *diag, const char *format, ...) PRINTF(3, 4);

#endif
