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

/* Start at an offset of a text whose first line has that number. */
Lexer lexer_start(const char *text, size_t offset, int line, Pool *pool);

/* Read the next token. At the end of a statement the lexer stays before what ended it, and gives
 * TOKEN_END again. Fails with E_SYNTAX at a character that no token has, a string without an end,
 * bytes that aren't UTF-8 or a number too large for a double. */
MUST_USE Status lexer_next(Lexer *lexer, Token *token, Diag *diag);

/* Step over what ended the statement, comment included: the offset of the next one. Fails with
 * E_SYNTAX at bytes of a comment that aren't UTF-8. */
MUST_USE Status lexer_finish(Lexer *lexer, size_t *next, Diag *diag);

/* The offset at which the logical line ends. */
size_t lexer_line_end(const Lexer *lexer);

/* A stretch of a text as one line: where a "\" joined lines stands one blank. New in `pool`. */
const char *text_slice(Pool *pool, const char *text, size_t start, size_t end);

/* from the start of one place to the end of another */
Place place_between(Place first, Place last);

#endif
