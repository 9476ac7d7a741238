/* syntax.h: text to statements, by the grammar of the command language
 *
 * The parser knows words, numbers, units, brackets and their places, and from the
 * verb's row how its operands are read (language.md, "What could be read in two ways");
 * what names mean is the model's business. A Statement owns its tree of Syntax nodes. */
#ifndef COTREE_MODEL_SYNTAX_H
#define COTREE_MODEL_SYNTAX_H

#include "base/diag.h"
#include "base/memory.h"
#include "expr/units.h"

typedef enum SyntaxKind {
    SYNTAX_NUMBER,   /* text: the literal as written; unit where one stands behind it */
    SYNTAX_STRING,   /* text: without the quotes */
    SYNTAX_VARIABLE, /* text: the path; primes */
    SYNTAX_CALL,     /* text: the path; args; primes */
    SYNTAX_VECTOR,   /* args; unit */
    SYNTAX_UNARY,    /* text: "-", "+" or "!"; one arg */
    SYNTAX_BINARY,   /* text: "+" "-" "*" "/" "^" "<" "<=" ">" ">=" "==" "!=" "&&" "||"; two args */
    SYNTAX_GROUP     /* ( expr ) with primes: one arg */
} SyntaxKind;

typedef struct Syntax {
    SyntaxKind kind;
    const char *text; /* borrowed from the statement's pool; never NULL */
    int primes;
    bool has_unit;
    Unit unit;
    Place unit_place;
    int count;
    struct Syntax **args;
    Place place; /* of the whole; for a binary the operator's is op_place */
    Place op_place;
} Syntax;

/* An item of a list (plot, table, print ...) may be shown in a unit: that is in Syntax.unit. */

typedef struct Operand {
    int sign;      /* '+' or '-' in `tree + a - b`, else 0 */
    Syntax *value; /* a name, place or word is a SYNTAX_VARIABLE; `0` a SYNTAX_NUMBER */
    Place place;
} Operand;

typedef struct Pair { /* key=value, or `h8' = 10` of init, driver, set, event, output */
    const char *name; /* the path, without primes */
    int primes;
    Syntax *value;
    Place name_place;
} Pair;

typedef enum StatementKind {
    STATEMENT_EMPTY,
    STATEMENT_PARAMETER,
    STATEMENT_LAW,
    STATEMENT_VERB
} StatementKind;

typedef struct Statement {
    StatementKind kind;
    const char *verb;       /* as in the table, also where shortened; NULL unless a verb */
    const struct Verb *row; /* of a verb */
    bool is_virtual;        /* `virtual revolute ...` */
    Place verb_place;
    const char *name; /* parameter or law */
    Place name_place;
    const char **arguments; /* of a law */
    int argument_count;
    Syntax *value; /* of a parameter or law */
    LIST(Operand) operands;
    LIST(Pair) pairs;
    /* trailing words with a fixed meaning, NULL where absent */
    Syntax *at;         /* print, expect, table ... at EXPR */
    Syntax *versus;     /* plot ... vs ITEM */
    Syntax *near_value; /* expect a ~ b: b */
    Syntax *within;
    const char *as; /* show X as WORD */
    Place as_place;
    struct Statement *rest; /* sweep ... : STATEMENT */
    const char *redirect;   /* file of > or >> */
    bool append;
    Place redirect_place;
    const char
        *text; /* the statement's own text, trimmed, continuation lines joined: for save and undo */
    Place place;
    Pool *pool;
} Statement;

/* How a text is read. */
typedef struct SyntaxOptions {
    bool shortened; /* verbs may be shortened while unambiguous (at the prompt) */
} SyntaxOptions;

/* Read every statement of one logical line.
 *
 * text   one or more physical lines joined by "\" at their ends, or one line
 * line   its number, for places
 * next   in: byte offset to start from (0); out: where the next statement starts
 * out    a new statement, statement_free(); kind EMPTY where only blanks and comments were left
 *
 * At the end *next is strlen(text). Call until then. Fails with E_SYNTAX, E_UNIT or E_NAME, at the
 * place. */
MUST_USE Status statement_parse(const char *text, int line, SyntaxOptions options, size_t *next,
                                Statement **out, Diag *diag);
void statement_free(Statement *statement); /* NULL is fine */

/* Read `text` as a single expression (an item: a variable, call or expression, with unit). */
MUST_USE Status syntax_parse_expression(const char *text, Pool *pool, Syntax **out, Diag *diag);
/* Write a tree back as text that parses to the same tree. */
void syntax_print(Text *text, const Syntax *syntax);

/* The rows of verbs: grammar, help and completion; who runs a verb is not said here. */
typedef enum VerbGroup {
    GROUP_SCENE,
    GROUP_MECHANICAL,
    GROUP_ELECTRICAL,
    GROUP_VARIABLES,
    GROUP_TREES,
    GROUP_LOOK,
    GROUP_RUN,
    GROUP_SESSION
} VerbGroup;

typedef struct Verb {
    const char *name;
    VerbGroup group;
    /* How operands are read, one letter each:
     *   n a new name; p a place (dotted name or 0); P an optional place; w a word; v a value
     * (expression); V an optional value; i items (to the end or `vs`); e expressions between
     * commas; t tree edges with signs; s a string; S an optional string; x the rest as words,
     * numbers and names; = pairs; C expect's condition; k keys (pairs with keys of the row); > may
     * be redirected; : a statement follows */
    const char *shape;
    const char
        *keys; /* names of its keys, between blanks; for a component those of its row; NULL: none */
    const char *usage;   /* one line */
    const char *brief;   /* one line, no full stop */
    const char *help;    /* a paragraph or more */
    const char *example; /* statements that run from an empty session, lines separated by \n */
    const char *see;     /* other words, between blanks */
} Verb;

const Verb *verb_find(const char *name); /* exact; NULL: unknown */
const Verb *verb_at(int i);              /* 0, 1, ... in the order of the manual; NULL at the end */

#endif
