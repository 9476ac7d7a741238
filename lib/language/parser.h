/* parser.h: tokens to expression trees; what statement.c and parser.c share */
#ifndef COTREE_LANGUAGE_PARSER_H
#define COTREE_LANGUAGE_PARSER_H

#include "language/lexer.h"
#include "language/syntax.h"

typedef struct Parser {
    const char *text;
    Pool *pool;               /* borrowed; trees live there */
    LIST(Token) tokens;       /* of one statement, TOKEN_END last */
    int at;                   /* the token to read */
    LIST(Syntax *) arguments; /* of the calls and vectors that are open */
    int depth;                /* of brackets, signs and statements within each other */
    int brackets;             /* that are open */
    bool prints;              /* a ">" outside brackets writes to a file */
    bool lists;               /* a "[" after an expression outside brackets shows it in a unit */
    const char *const *stops; /* words that end an operand; NULL: none */
    const Verb *row;          /* whose operands are read; NULL: none */
    SyntaxOptions options;
    /* reads a statement after a verb (`time simulate 2`); the grammar is recursive there */
    Status (*statement)(struct Parser *parser, Statement *statement);
    Diag *diag;
} Parser;

/* Read the tokens of a statement. */
MUST_USE Status parser_start(Parser *parser, Lexer *lexer);
void parser_free(Parser *parser);

const Token *parser_token(const Parser *parser);       /* to be read next */
const Token *parser_peek(const Parser *parser, int n); /* the n-th after it */
const Token *parser_before(const Parser *parser);      /* read last */
bool token_is(const Token *token, const char *symbol);
/* "'x'", "the end of the statement" ...; may use `room` */
const char *token_describe(const Token *token, char room[], size_t size);
bool parser_sees(const Parser *parser, const char *symbol);
bool parser_accept(Parser *parser, const char *symbol); /* read it if it is there */
bool parser_ends(const Parser *parser);
bool parser_took_comma(const Parser *parser);      /* as the token before */
bool parser_sees_pair(const Parser *parser);       /* path { "'" } "=" */
bool parser_sees_terminal(const Parser *parser);   /* a path or 0 */
bool parser_sees_comparison(const Parser *parser); /* its sign */
bool parser_sees_stop(const Parser *parser); /* a stop word, or ">" where it writes to a file */

/* E_SYNTAX "expected WHAT before/at ..." at the next token */
Status parser_expected(const Parser *parser, const char *what);
/* 2,5 in place of one value: adds a hint and returns true */
bool parser_hint_comma(const Parser *parser);
/* E_SYNTAX "unexpected ..." at the next token, with the hint that its kind calls for */
Status parser_unexpected(const Parser *parser);
/* E_SYNTAX where the bracket `open` should be closed */
Status parser_unclosed(const Parser *parser, const Token *open);
/* depth of what may call itself; leave with parser->depth-- */
MUST_USE Status parser_enter(Parser *parser);

/* A new node without arguments; in the parser's pool. */
Syntax *syntax_new(Parser *parser, SyntaxKind kind, const char *text, Place place);
/* Move the arguments from number `start` of the stack on to a node. Fails if the tree gets too
 * high. */
MUST_USE Status syntax_accept(Parser *parser, Syntax *node, int start);

/* Each function reads the rule in its line of the grammar, and fails at the source position. */
MUST_USE Status parse_expression(Parser *parser, Syntax **out);
MUST_USE Status parse_sum(Parser *parser, Syntax **out);
MUST_USE Status parse_primary(Parser *parser, Syntax **out);
/* d(h)/d(L) in a list of items: `item`, d(h), was read; *out is the whole, or item where nothing
 * of that kind follows */
MUST_USE Status parse_derivative(Parser *parser, Syntax *item, Syntax **out);
MUST_USE Status parse_unit(Parser *parser, Syntax *node);         /* in brackets */
MUST_USE Status parse_literal_unit(Parser *parser, Syntax *node); /* if there is one */
MUST_USE Status parse_shown(Parser *parser, Syntax **out);        /* sum [ unit ] */
MUST_USE Status parse_item(Parser *parser, Syntax **out);
MUST_USE Status parse_terminal(Parser *parser, Syntax **out);
MUST_USE Status parse_edge(Parser *parser, Syntax **out); /* a place, or a path in brackets */
MUST_USE Status parse_word(Parser *parser, Syntax **out); /* NAME, NUMBER without unit or STRING */
MUST_USE Status parse_name(Parser *parser, const Token **out); /* NAME without a dot */
MUST_USE Status parse_path(Parser *parser, const char **path, int *primes, Place *place);
MUST_USE Status parse_pattern(Parser *parser, Statement *statement); /* what follows its verb */

/* E_NAME if a name is reserved */
MUST_USE Status parser_check_reserved(const Parser *parser, const Token *name);

#endif
