/* lexer.h: characters of a statement to tokens with their places */
#ifndef COTREE_LANGUAGE_LEXER_H
#define COTREE_LANGUAGE_LEXER_H

#include "base/diag.h"
#include "base/memory.h"
#include "base/text.h"

typedef enum TokenKind {
    TOKEN_END, /* of the statement: ";", "#", the end of the line or of the text */
    TOKEN_NUMBER,
    TOKEN_PATH,   /* names joined by dots */
    TOKEN_PRIMES, /* that touch a path or a closing bracket */
    TOKEN_STRING, /* text: without the quotes */
    TOKEN_SYMBOL
} TokenKind;

typedef struct Token {
    TokenKind kind;
    const char *text; /* borrowed from the lexer's pool; "" at the end */
    size_t start;     /* offsets in the text */
    size_t end;
    bool touches; /* no blank before it */
    Place place;
} Token;

typedef struct Lexer {
    const char *text; /* borrowed */
    size_t at;
    int line;
    size_t line_start;
    Pool *pool; /* borrowed; gets the texts of tokens */
    Token last; /* the token before, where touching matters */
} Lexer;

/* A text of statements and the read position; initialise with {.text = text, .line = 1}. The number
 * of preceding lines is stored, because counting them again for each statement would cost quadratic
 * time. */
typedef struct Cursor {
    const char *text; /* borrowed */
    size_t next;      /* offset of the next statement */
    int line;         /* number of the physical line there */
    size_t line_start;
} Cursor;

/* A text of which the statements before an offset were read. O(offset). */
Cursor cursor_at(const char *text, int line, size_t offset);

/* Start where a text was read to. */
Lexer lexer_start(const Cursor *cursor, Pool *pool);

/* Read the next token. At the end of a statement the lexer stops before the character that ended
 * it, and returns TOKEN_END again. Fails with E_SYNTAX at a character that no token has, a string
 * without an end, bytes that aren't UTF-8 or a number too large for a double. */
MUST_USE Status lexer_next(Lexer *lexer, Token *token, Diag *diag);

/* Step over what ended the statement, comment included, to the next one. Fails with E_SYNTAX at
 * bytes of a comment that aren't UTF-8. */
MUST_USE Status lexer_finish(Lexer *lexer, Diag *diag);

/* Step to the end of the logical line, and over it and the empty lines that follow. */
void lexer_skip_line(Lexer *lexer);
void lexer_skip_breaks(Lexer *lexer);

/* A part of a text as one line: a blank replaces "\" and its line break. New in `pool`.
 *
 * offsets  by joined line after the first: what makes of a column there the offset in the slice;
 *          NULL: not needed */
const char *text_slice(Pool *pool, const char *text, size_t start, size_t end, int *offsets);

/* from the start of one place to the end of another */
Place place_between(Place first, Place last);

#endif
