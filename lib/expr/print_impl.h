/* print_impl.h: the printer that all notations share
 *
 * Printing a node splits it into pieces: texts, and smaller nodes with the binding level that they
 * need. The pieces are on a stack, so that nesting may be of any depth. A Dialect defines what
 * differs between notations. */
#ifndef COTREE_EXPR_PRINT_IMPL_H
#define COTREE_EXPR_PRINT_IMPL_H

#include "expr/expr_impl.h"

/* how tightly something binds */
typedef enum Level {
    LEVEL_ANY,
    LEVEL_OR,
    LEVEL_AND,
    LEVEL_COMPARE,
    LEVEL_SUM,
    LEVEL_PRODUCT,
    LEVEL_UNARY,
    LEVEL_POWER,
    LEVEL_ATOM
} Level;

typedef enum PieceKind {
    PIECE_TEXT,
    PIECE_NODE,
    PIECE_MAGNITUDE, /* a node without its minus sign */
    PIECE_NUMBER,    /* 0 or more */
    PIECE_POWER      /* of a node, by a number above 0 */
} PieceKind;

typedef struct Piece {
    PieceKind kind;
    Level level;
    Expr e;
    Number number;
    const char *text; /* that outlives the printing */
    size_t length;
} Piece;

typedef struct Dialect Dialect;

typedef struct Printer {
    Text *out;
    const Dialect *dialect;
    LIST(Piece) pieces;
} Printer;

/* a product split into number * above / below; `plain` has no number and no division */
typedef struct Fraction {
    Number number; /* above 0 */
    LIST(Piece) above;
    LIST(Piece) below;
} Fraction;

struct Dialect {
    const char *plus;
    const char *minus;
    const char *times;
    const char *open;
    const char *close;
    bool names_pi; /* its multiples aren't written as digits */
    /* how tightly the number is bound, and its digits, appended to out */
    Level (*number)(Text *out, Number number);
    void (*symbol)(Text *out, Expr symbol);
    void (*fraction)(Printer *printer, const Fraction *fraction);
    /* base^exponent; `number` counts where exponent is NULL */
    void (*power)(Printer *printer, Expr base, Expr exponent, Number number);
    Level (*power_level)(Expr base, Expr exponent, Number number);
    void (*call)(Printer *printer, Expr e);
    Level (*call_level)(Expr e);
};

extern const Dialect dialect_text;
extern const Dialect dialect_unicode;
extern const Dialect dialect_latex;
extern const Dialect dialect_c;
extern const Dialect dialect_matlab;
extern const Dialect dialect_python;
extern const Dialect dialect_fortran;

void say(Printer *printer, const char *text);
void write_part(Printer *printer, const char *text, size_t length);
void write_node(Printer *printer, Expr e, Level level);
void write_number(Printer *printer, Number number, Level level);
void write_pieces(Printer *printer, const Piece *pieces, int count, const char *between);
void write_arguments(Printer *printer, Expr e); /* a, b, c */

/* above/below with signs of multiplication and division between */
void fraction_inline(Printer *printer, const Fraction *fraction, const char *divide);
/* Levels of a call in notations where operators are written between their arguments. */
Level operator_level(Expr e);
Level plain_power_level(Expr base, Expr exponent, Number number); /* of one with ^ or ** */
/* a < b, a && b, !a with the operator's sign; false where e is no such call */
bool write_operator(Printer *printer, Expr e, const char *sign);

/* C(s), C'(s), or C' where the argument has the name in the law; false: e calls no law */
bool write_law(Printer *printer, Expr e);

/* Digits of an exact decimal, e.g. 0.25 of 1/4; false where it has none, or more than `most`. */
bool ratio_decimal(char text[64], Number number, int most);
/* "4.7e7" of 47000000; false where that is hardly shorter. */
bool integer_power(char text[64], int64_t value);
/* Digits of a double that the parser reads as that double. */
void double_text(char text[64], double value);

void print_with(Text *out, Expr e, const Dialect *dialect);
void print_tree(Text *out, Expr e);

#endif
