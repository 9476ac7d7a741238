/* syntax.h: text to statements, by the grammar of the command language
 *
 * The parser knows words, numbers, units, brackets and their places, and from the
 * verb's row how its operands are read (language.md, "What could be read in two ways");
 * what names mean is the model's business. A Statement owns its tree of Syntax nodes. */
#ifndef COTREE_LANGUAGE_SYNTAX_H
#define COTREE_LANGUAGE_SYNTAX_H

#include "base/diag.h"
#include "base/memory.h"
#include "expr/units.h"
#include "language/lexer.h"

/* Trees are no higher than this, so that walking one needs no more stack than that. */
enum { SYNTAX_HEIGHT = 1000 };

typedef enum SyntaxKind {
    SYNTAX_NUMBER,   /* text: the literal as written; unit if one follows it */
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
    const char *unit_text; /* as written: "mm", "[kN/m]"; "" without one */
    Place unit_place;
    int height; /* 1 for a leaf; never more than SYNTAX_HEIGHT */
    int count;
    struct Syntax **args;
    Place place; /* of the whole; for a binary the operator's is op_place */
    Place op_place;
} Syntax;

/* After a number or a vector, its unit. After any other expression, which only items of a list may
 * have (plot, table, print ...), the unit to show it in. */

typedef struct Operand {
    int sign;      /* '+' or '-' in `tree + a - b`, '|' after a bar, else 0 */
    Syntax *value; /* a name, place or word is a SYNTAX_VARIABLE; `0` a SYNTAX_NUMBER */
    Place place;
} Operand;

typedef struct Pair { /* key=value, or `h8' = 10` of init, driver, set, event, output */
    const char *name; /* the path, without primes */
    int primes;
    Syntax *value;
    Place name_place;
} Pair;

/* --- the rows of verbs: grammar, help, completion, what they change, who carries them out --- */

typedef enum Room {
    ROOM_LANGUAGE, /* the parser: precedes another verb, and is read with it */
    ROOM_MODEL,    /* changes the model */
    ROOM_SESSION,  /* runs it */
    ROOM_CALLER    /* whoever calls the library: the shell */
} Room;

/* of what there was before */
typedef enum VerbChanges {
    CHANGES_NOTHING,
    CHANGES_NAMES, /* how runs are looked at: none becomes another's */
    CHANGES_START,
    CHANGES_TREES,
    CHANGES_FORM, /* of the equations */
    CHANGES_MODEL
} VerbChanges;

/* where completion finds words that may follow a verb or a key, in addition to values */
typedef enum Offers {
    OFFERS_VALUES, /* no words of its own */
    OFFERS_TOPICS,
    OFFERS_HELP,
    OFFERS_BLOCKS,
    OFFERS_EDGES,
    OFFERS_LIT,
    OFFERS_REMOVABLE,
    OFFERS_SHOWABLE,
    OFFERS_SETTABLE,
    OFFERS_COORDINATES,
    OFFERS_STARTS,
    OFFERS_OUTPUTS,
    OFFERS_EVENTS,
    OFFERS_RUNS,
    OFFERS_METHODS,
    OFFERS_SUBSYSTEMS,
    OFFERS_EXPORTED
} Offers;

typedef struct VerbKey {
    const char *name;
    Offers offers;
    const char *words; /* accepted words, separated by '|' */
} VerbKey;

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
    int number; /* VERB_NAME of verbs.h; -1: a component's */
    Room room;
    VerbChanges changes;
    bool shows_alone; /* without operands it is the caller's, and shows what there is */
    VerbGroup group;
    /* How operands are read, one letter each, in order:
     *   n a new name              p a place (dotted name, or 0)   P a place that may be absent
     *   w one of the row's words, or any word where it has none    W such a word, may be absent
     *   v a value (expression)    V values that may be absent     e expressions between commas
     *   i items, bars between       I items, maybe none             t tree edges with signs
     *   s a string                o a string, or one of the words
     *   x words, names, numbers and items, maybe none             l the rest of the line, as it is
     *   C a condition, or a ~ b within tol                        T a statement, to the end
     *   y maybe `vs ITEM`         @ maybe `at EXPR`               a maybe `as WORD`
     *   k keys of the row         = pairs, at least one unless operands came before
     *   > prints, maybe to a file ! prints nothing, `>` is refused
     *   : a colon and a statement * the letter before, repeated */
    const char *pattern;
    /* both ended by NULL; NULL: none */
    const char *const *words; /* words with a meaning of their own in its operands: they win over
                                 names, which stand in brackets then: `tree (rotation)` */
    const VerbKey *keys;
    const char *optioned; /* the one of its words that keys and `at` go with; NULL: always */
    Offers offers;
    const char *usage;   /* one line; NULL: verb_usage() */
    const char *brief;   /* one line, no full stop */
    const char *help;    /* a paragraph or more; NULL where it comes later */
    const char *example; /* statements that run from an empty session, lines separated by \n; NULL
                            where it comes later */
    const char *see;     /* other words, between blanks */
    const struct Component *component; /* where the verb makes one; its text is the component's */
} Verb;

typedef enum StatementKind {
    STATEMENT_EMPTY,
    STATEMENT_PARAMETER,
    STATEMENT_LAW,
    STATEMENT_VERB
} StatementKind;

/* the lines of a definition after its first */
typedef struct Body {
    const char *text; /* as written, one on each line */
    /* those that aren't empty; their places are in the definition, whose first line is 1 */
    const struct Statement *at;
    int count;
    const Diag *fault; /* of the line after them, which is no statement; NULL: none */
} Body;

typedef struct Statement {
    StatementKind kind;
    const char *verb; /* as in the table, also where shortened; NULL unless a verb */
    Verb row;         /* of a verb; its name is NULL otherwise */
    bool is_virtual;  /* `virtual revolute ...` */
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
    /* of a name alone, which is printed: what it is where nothing has it, with a hint where it is
     * near a verb; else NULL */
    const Diag *unknown;
    const Body *body;     /* of a subsystem that was read whole; else NULL */
    const char *redirect; /* file of > or >> */
    bool append;
    const char
        *text; /* the statement's own text, trimmed, continuation lines joined: for save and undo */
    Place place;
    /* by physical line, from its first: what makes of a column the offset in `text`; NULL: unknown
     */
    const int *offsets;
    Pool *pool;
} Statement;

/* How a text is read. */
typedef struct SyntaxOptions {
    bool shortened; /* verbs may be shortened while unambiguous (at the prompt) */
    bool whole;     /* a subsystem is one statement; else each of its lines */
} SyntaxOptions;

/* Read the next statement of a text; at its end the cursor is strlen(text). *out and the failures
 * are those of statement_parse(); a failure leaves the cursor unchanged. */
MUST_USE Status statement_read(Cursor *cursor, SyntaxOptions options, Statement **out, Diag *diag);

/* Read one statement after the other of a short text, since each counts lines from its beginning.
 *
 * text   a physical line, several joined by "\" at their ends, or a whole script
 * line   its number, for places
 * next   in: byte offset to start from (0); out: where the next statement starts; NULL: the first
 * out    a new statement, statement_free(); kind EMPTY where only blanks and comments were left
 *
 * At the end *next is strlen(text). Call until then. Fails with E_SYNTAX, E_UNIT or E_NAME, at the
 * place. */
MUST_USE Status statement_parse(const char *text, int line, SyntaxOptions options, size_t *next,
                                Statement **out, Diag *diag);
void statement_free(Statement *statement); /* NULL is fine */

/* Read `text` as a single expression (an item: a variable, call or expression, with unit). */
MUST_USE Status syntax_parse_expression(const char *text, Pool *pool, Syntax **out, Diag *diag);
/* a copy of a tree that lives as long as the pool */
Syntax *syntax_copy(Pool *pool, const Syntax *syntax);
/* The same of a statement that builds; not for statement_free(). */
void statement_copy(Pool *pool, const Statement *from, Statement *to);
/* The same with another place: `text`, which differs from its own in the verb's spelling alone,
 * begins in that line and column. */
void statement_copy_to(Pool *pool, const Statement *from, const char *text, int line, int column,
                       Statement *to);
/* Write a tree back as text that parses to the same tree. */
void syntax_print(Text *text, const Syntax *syntax);
/* The same of a statement that builds, of its operands and pairs. */
void statement_print(Text *text, const Statement *statement);

/* Rows by value; what they point to is const. False: unknown, *verb unchanged. */
bool verb_find(const char *name, Verb *verb); /* exact */
bool verb_at(int i, Verb *verb); /* 0, 1, ... in the order of the manual; false at the end */
const char *verb_key(const Verb *verb, int i); /* 0, 1, ...; NULL at the end */
/* the word that continues a statement after operands if a pattern has that letter: vs, at, as,
 * within; NULL: none */
const char *pattern_word(char letter);
void verb_usage(Text *text, const Verb *verb);          /* one line */
bool word_is_reserved(const char *word, size_t length); /* energy of energy.total ... */
bool name_is_reserved(const char *name);                /* or run1 ...: can't be redefined */
const char *group_title(VerbGroup group);               /* "Mechanical components" ... */

#endif
