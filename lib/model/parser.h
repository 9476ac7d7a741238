/* parser.h: tokens to expression trees; what statement.c and parser.c share */
#ifndef COTREE_MODEL_PARSER_H
#define COTREE_MODEL_PARSER_H

#include "model/lexer.h"
#include "model/syntax.h"

typedef struct Parser {
    const char *text;
    Pool *pool;               /* borrowed; trees live there */
    LIST(Token) tokens;       /* of one statement, TOKEN_END last */
    int at;                   /* the token to read */
    LIST(Syntax *) arguments; /* of the calls and vectors that are open */
    int depth;                /* of brackets, signs and statements within each other */
    int brackets;             /* that are open */
    bool prints;              /* a ">" outside brackets writes to a file */
    bool lists;               /* a "[" behind an expression outside brackets shows it in a unit */
    const char *const *stops; /* words that end an operand; NULL: none */
    const Verb *row;          /* whose operands are read; NULL: none */
    SyntaxOptions options;
    Diag *diag;
} Parser;

/* Read the tokens of a statement. */
MUST_USE Status parser_start(Parser *parser, Lexer *lexer);
void parser_free(Parser *parser);

const Token *parser_token(const Parser *parser);       /* to be read next */
const Token *parser_peek(const Parser *parser, int n); /* the n-th behind it */
const Token *parser_before(const Parser *parser);      /* read last */
bool parser_sees(const Parser *parser, const char *symbol);
bool parser_take(Parser *parser, const char *symbol); /* read it if it is there */
bool parser_took_comma(const Parser *parser);         /* as the token before */
bool parser_ends(const Parser *parser);
bool parser_sees_pair(const Parser *parser);  /* path { "'" } "=" */
bool parser_sees_stop(const Parser *parser);  /* a word of the row, `at`, or > "file" */
bool parser_sees_place(const Parser *parser); /* a path or 0 */

/* Each reads what its grammar says, and fails at the place. */
MUST_USE Status parse_expression(Parser *parser, Syntax **out);
MUST_USE Status parse_shown(Parser *parser, Syntax **out); /* sum [ unit ] */
MUST_USE Status parse_item(Parser *parser, Syntax **out);
MUST_USE Status parse_place(Parser *parser, Syntax **out);
MUST_USE Status parse_edge(Parser *parser, Syntax **out); /* a place, or a path in brackets */
MUST_USE Status parse_word(Parser *parser, Syntax **out); /* NAME, NUMBER without unit or STRING */
MUST_USE Status parse_path(Parser *parser, const char **path, int *primes, Place *place);

/* E_SYNTAX "expected WHAT before/at ..." at the next token */
Status parser_expected(const Parser *parser, const char *what);
/* E_SYNTAX "unexpected ..." at the next token, with the hint that its kind calls for */
Status parser_unexpected(const Parser *parser);
/* depth of what may call itself; leave with parser->depth-- */
MUST_USE Status parser_enter(Parser *parser);

#endif
