/* expr.h: hash-consed expressions
 *
 * An expression is an immutable node in an Arena: built once, never moved, and
 * equal expressions are the same pointer. Every Expr here is *interned*: it lives
 * as long as its arena. Building one simplifies it: numbers fold (exact small
 * rationals stay exact; what no longer fits into 64 bits becomes a double), zeros
 * and ones vanish, like terms of a sum and like factors of a product collect,
 * nested sums and products flatten. Nothing is multiplied out, and no two terms of
 * a sum are searched for a trigonometric partner: that is expr_fold(), on request.
 *
 * Builders don't return errors. The arena records its first failure (division by zero, a size
 * beyond all bounds) and returns a valid node without meaning. After the last builder the caller
 * checks arena_status() once.
 *
 * The order of terms and factors is stable: by kind, then the order in which their symbols were
 * made, then structure; never by address.
 *
 * Equal forms have one normal form here: minus a sum is the sum of the negatives, and a sum that is
 * a factor, an argument of sin or the like has no minus sign before its first term (x*(b - a) is
 * -x*(a - b)); half powers are whole powers of a sqrt; a > b is b < a. */
#ifndef COTREE_EXPR_EXPR_H
#define COTREE_EXPR_EXPR_H

#include "base/call_monitor.h"
#include "base/diag.h"
#include "base/text.h"
#include "expr/curve.h"

#include <stdint.h>

typedef struct Arena Arena;
typedef const struct ExprNode *Expr;

typedef enum ExprKind {
    EXPR_RATIONAL, /* num/den, lowest terms, den > 0 */
    EXPR_REAL, /* a double that is no small rational; or a rational times a power of pi, exactly */
    EXPR_SYMBOL,
    EXPR_POWER,   /* arg 0 to the arg 1; exponent not 0 or 1 */
    EXPR_CALL,    /* an operator of ops.def */
    EXPR_PRODUCT, /* 2 or more factors, at most one number, and that first */
    EXPR_SUM,     /* 2 or more terms, at most one number */
    EXPR_TUPLE    /* expressions side by side: no value, and in no other expression */
} ExprKind;

typedef enum Op {
#define OP(id, ...) OP_##id,
#include "expr/ops.def"
#undef OP
    OP_COUNT
} Op;

/* The kind of a symbol determines the stage in which its value is known. */
typedef enum SymbolKind {
    SYMBOL_PARAMETER,    /* known before a run */
    SYMBOL_TIME,         /* t */
    SYMBOL_COORDINATE,   /* an entry of q */
    SYMBOL_SPEED,        /* an entry of u */
    SYMBOL_STATE,        /* an entry of x: network and controller states */
    SYMBOL_ALGEBRAIC,    /* an entry of z: network unknowns without a derivative */
    SYMBOL_ACCELERATION, /* an entry of u' */
    SYMBOL_STATE_RATE,   /* an entry of x' */
    SYMBOL_MULTIPLIER,   /* an entry of lambda */
    SYMBOL_EFFORT,       /* an unknown driver effort, or a source that a driver finds */
    SYMBOL_JERK,         /* an entry of u'' (inverse runs) */
    SYMBOL_TURN,         /* reference of a multi-turn angle: stored in addition to q */
    SYMBOL_VARIABLE,     /* a name of the user's that formulation replaces: h9.fx, h8'' */
    SYMBOL_ARGUMENT,     /* an argument of a law */
    SYMBOL_TABLE         /* data of a table; not included in expr_kinds() */
} SymbolKind;

/* --- the arena --- */

Arena *arena_new(void);                           /* new; arena_free() */
void arena_free(Arena *arena);                    /* and all its expressions; NULL is fine */
MUST_USE Status arena_status(const Arena *arena); /* the first failure since arena_reset() */
const char *arena_failure(const Arena *arena);    /* what failed, in words; borrowed */
void arena_reset(Arena *arena);                   /* forget the failure */
/* At most that many nodes; beyond, the arena fails with E_MEMORY. Some 67 million at first. Returns
 * the limit until now. */
int64_t arena_limit(Arena *arena, int64_t nodes);

/* Scratch work: whatever was built after the mark is forgotten by the release. */
typedef struct ArenaMark ArenaMark;
ArenaMark *arena_mark(Arena *arena); /* new; freed by arena_release() or arena_retain() */
void arena_release(Arena *arena, ArenaMark *mark);
void arena_retain(Arena *arena, ArenaMark *mark);
/* A cache of results that callers made of expressions. The arena stores the last few, each until a
 * release removes a node that it was made of. `newest` is the greatest creation number of these
 * nodes. */
typedef struct Made {
    uint64_t hash;
    uint32_t newest;
    void *object;
    bool (*is)(const void *object, const void *asked); /* by which it is found */
    void (*release)(void *object);
} Made;
void arena_add_made(Arena *arena, const Made *made);
/* all that is found by that */
void arena_end_made(Arena *arena, bool (*is)(const void *object, const void *asked));
/* one of that hash for which `is` holds, or NULL */
void *arena_find_made(Arena *arena, uint64_t hash,
                      bool (*is)(const void *object, const void *asked), const void *asked);
/* Several expressions as one node, so that equality is a comparison of pointers. */
Expr expr_tuple(Arena *arena, const Expr *at, int count);
/* A result that depends on a tuple only, stored as long as its nodes live. `which` distinguishes
 * results of one tuple. It is an array or struct of expressions, of that size in bytes. */
void expr_remember(Arena *arena, Expr tuple, int which, const void *values, size_t size);
/* Get the stored result (out NULL: test only); false: there is none. */
bool expr_recall(Arena *arena, Expr tuple, int which, void *out, size_t size);
int64_t arena_nodes(const Arena *arena);
/* So many nodes are to be expected in all: room for them is made at once. */
void arena_expect(Arena *arena, int nodes);
size_t arena_bytes(const Arena *arena);

/* --- leaves --- */

Expr expr_int(Arena *arena, int64_t value);
Expr expr_rational(Arena *arena, int64_t num, int64_t den); /* den 0: E_DOMAIN */
/* A double that is a multiple of 1/1024 below 2^20, or an integer below 2^53, becomes a rational;
 * others remain doubles. */
Expr expr_real(Arena *arena, double value);
/* pi^power. Multiples by rationals remain exact: they are one number in products, and in sums with
 * numbers of the same power */
Expr expr_pi(Arena *arena, int power);
/* The decimal literal `text` ("0.25", "2.194e-6") as an exact rational where numerator and
 * denominator fit into 63 bits, else the nearest double. One with a point or an exponent and 16 or
 * more digits is a double too: so long are those that doubles print with. */
Expr expr_decimal(Arena *arena, const char *text);
/* The symbol of that name and kind: found, or made. Symbols of one name and different kinds are
 * different but print identically: what a user calls h8 (SYMBOL_VARIABLE) is replaced by
 * formulation with the coordinate h8 (SYMBOL_COORDINATE) where h8 is a branch. */
Expr expr_symbol(Arena *arena, const char *name, SymbolKind kind);

/* --- builders --- */

Expr expr_add(Arena *arena, Expr a, Expr b);
Expr expr_sub(Arena *arena, Expr a, Expr b);
Expr expr_mul(Arena *arena, Expr a, Expr b);
Expr expr_div(Arena *arena, Expr a, Expr b);
Expr expr_neg(Arena *arena, Expr a); /* distributes over a sum: -(a - b) is b - a */
Expr expr_pow(Arena *arena, Expr base, Expr exponent);
Expr expr_square(Arena *arena, Expr a);
Expr expr_sum(Arena *arena, const Expr *terms, int count);
Expr expr_product(Arena *arena, const Expr *factors, int count);
/* sin(-x) is -sin(x), cos(-x) is cos(x); sines and cosines are exact at multiples of pi/6 and pi/4,
 * and sin(x + pi/2) is cos(x); numbers fold to doubles only where every argument is a double (or a
 * multiple of pi), or where the result is exact (sqrt(9/4)) */
Expr expr_call(Arena *arena, Op op, const Expr *args);
Expr expr_call1(Arena *arena, Op op, Expr a);
Expr expr_call2(Arena *arena, Op op, Expr a, Expr b);
Expr expr_sin(Arena *arena, Expr a);
Expr expr_cos(Arena *arena, Expr a);
Expr expr_sqrt(Arena *arena, Expr a);
Expr expr_if(Arena *arena, Expr condition, Expr yes, Expr no);
/* The same value as `e`, opaque to flattening and collecting: sums and products built from it
 * contain it as one operand, so that programs compute it once. A number, a symbol, and the negative
 * of one, are returned unchanged; hold(-e) becomes -hold(e). Printing and counting as written
 * ignore it; a held node is one shared definition in a program. */
Expr expr_name_temporary(Arena *arena, Expr e);
/* `e` with every hold dissolved and rebuilt. O(nodes) nodes visited. */
Expr expr_open(Arena *arena, Expr e);

/* --- data as functions --- */

/* The symbol of that data: an existing one if the data is equal, else a new one, which the arena
 * owns and finds by these names from then on. Copies. */
Expr arena_add_table(Arena *arena, const char *file, const char *column, const double *x,
                     const double *y, int count);
Expr arena_find_table(Arena *arena, const char *file, const char *column); /* NULL: none */
/* The symbol of a law that formulas call by name: expr_table() of it is the call, printed C(s), or
 * C'(s), and C' where x has the name of the law's argument. No program computes it. */
Expr arena_add_law(Arena *arena, const char *name, const char *argument);
/* the curve through the data at x, or a derivative of it by x */
Expr expr_table(Arena *arena, Expr data, Expr x, int order);
const Curve *expr_data(Expr symbol); /* of a SYMBOL_TABLE; NULL for others */
/* the SYMBOL_TABLEs that occur, each once; new array, free with mem_free() */
int expr_tables(const Expr *roots, int count, Expr **symbols);
/* Which derivatives of a table occur in roots: bit 1 << order. */
unsigned expr_table_orders(const Expr *roots, int count, Expr symbol);

/* --- the table of functions --- */

const char *op_name(Op op);
int op_args(Op op);                         /* how many */
double op_value(Op op, const double *args); /* NAN where undefined */

/* --- looking --- */

ExprKind expr_kind(Expr e);
Op expr_op(Expr e); /* of a call */
int expr_arg_count(Expr e);
Expr expr_arg(Expr e, int i);
const char *expr_name(Expr symbol); /* borrowed */
SymbolKind expr_symbol_kind(Expr symbol);
int expr_symbol_number(Expr symbol); /* 0, 1, 2 ... in the order of making */
uint32_t expr_number(Expr e); /* creation number, unique in the arena: an index for memory tables */
bool expr_is_number(Expr e);
double expr_value(Expr number);                               /* of a rational or real */
bool expr_rational_parts(Expr e, int64_t *num, int64_t *den); /* false unless rational */
bool expr_is(Expr e, int64_t value);                          /* is that exact integer */
bool expr_is_zero(Expr e);        /* is the number 0; a sum that vanishes unseen is not */
int expr_compare(Expr a, Expr b); /* the stable order: <0, 0, >0; 0 only for the same pointer */

/* --- mathematics; each visits a shared node once --- */

/* Partial derivative by a symbol. Remembered for the arena's life. */
Expr expr_diff(Arena *arena, Expr e, Expr symbol);
/* Total derivative along `rates`: sum of d e/d symbols[i] * rates[i], all i in one pass. */
Expr expr_diff_along(Arena *arena, Expr e, const Expr *symbols, const Expr *rates, int count);
/* Replace symbols (all at once, not in one another). Values NULL: by zeros. */
Expr expr_substitute(Arena *arena, Expr e, const Expr *symbols, const Expr *values, int count);
/* Replace nodes, symbols included, wherever they occur, but not inside a replaced node: from[i] by
 * to[i], in place in `roots`. Each node is visited once for all roots. */
void expr_replace(Arena *arena, Expr *roots, int root_count, const Expr *from, const Expr *to,
                  int count);
/* Replace symbols whose names start with one prefix (after a '#', if there is one) by those of the
 * same kinds with another prefix, in any number of expressions. The Original visits each node once
 * for all its renamings, and each Renaming builds the image of a node once. Both borrow the texts,
 * and a Renaming its Original. */
typedef struct Original Original;
typedef struct Renaming Renaming;
Original *original_new(Arena *arena, const char *prefix);   /* new */
void original_free(Original *original);                     /* NULL is fine */
Renaming *renaming_new(Original *original, const char *to); /* new */
/* The same, stored by the arena for later calls: images built before are still there, but those
 * that depend on renaming_pair() are undefined again. Borrowed until renamings_end(), which removes
 * unused ones. */
Renaming *renaming_kept(Arena *arena, const char *prefix, const char *to, bool *is_new);
void renaming_forget(Arena *arena); /* the last one */
void renamings_end(Arena *arena);
/* From now on the image of `from`, a symbol or a held expression, is `to`; that of a number is
 * itself. False: impossible, or it already has another image. */
bool renaming_pair(Renaming *renaming, Expr from, Expr to);
Expr renaming_of(Renaming *renaming, Expr e);
void renaming_free(Renaming *renaming); /* NULL is fine */
/* The nodes below some roots for which `wanted` holds, each once, children first; new array, free
 * with mem_free(). */
typedef bool (*NodeWanted)(Expr e, void *context);
int expr_find(const Expr *roots, int count, NodeWanted wanted, void *context, Expr **out);
/* Returns the image of a node, given the node rebuilt from the images of its arguments. */
typedef Expr (*NodeChange)(Arena *arena, Expr e, void *context);
/* Change every node below e, each once and upward. O(nodes) */
Expr expr_change(Arena *arena, Expr e, NodeChange change, void *context);
bool expr_depends(Expr e, Expr symbol);
/* Mark, for each SymbolKind, whether a symbol of that kind occurs: bit 1 << kind. Stored in the
 * node: O(1). */
unsigned expr_kinds(Expr e);
/* The symbols that occur in roots, in order of making; new array, free with mem_free(). */
int expr_symbols(const Expr *roots, int count, Expr **symbols);
/* Trigonometric folding for reading: sin^2+cos^2 = 1, cosAcosB -+ sinAsinB, sinAcosB +- cosAsinB,
 * in sums at any depth, partners found by look-up. Never makes the expression larger
 * as counted by expr_count(). */
Expr expr_fold(Arena *arena, Expr e);
/* Collect a sum by common factors as a person would: m*a + m*b becomes m*(a + b), greedily by
 * the factor that saves most; never larger as counted. */
Expr expr_collect(Arena *arena, Expr e);
/* Products of sums and whole powers of sums multiplied out, at most to `limit` terms (beyond:
 * unchanged). */
Expr expr_expand(Arena *arena, Expr e, int limit);
/* The same for sums that contain a symbol of a kind in `kinds` (bits as of expr_kinds()). Other
 * sums are unchanged as factors, and *kept becomes whether there are any. */
Expr expr_expand_over(Arena *arena, Expr e, unsigned kinds, int limit, bool *kept);
/* The coefficients of powers of x, an argument, that `e` is a polynomial in: how many, up to
 * `most`; 0: it isn't one, or of a higher degree. */
int expr_powers(Arena *arena, Expr e, Expr x, Expr *out, int most);

/* For the recursive form: replaces sines and cosines of sums of angles by those of the parts, if
 * each group of roots that needs them computes these anyway: no group evaluates more functions.
 * `roots` lists the groups (at most 32) one after the other, counts[g] roots each. In place;
 * O(nodes) for each root. */
void expr_part_angles(Arena *arena, Expr *roots, const int *counts, int groups);
/* For the recursive form: operands that several sums, or products, have in common become one held
 * node. In place; counted by expr_count_shared() the roots together never cost more. O(n log n) for
 * n operands. */
void expr_share(Arena *arena, Expr *roots, int count);

/* A symbol's value, for expr_evaluate(). */
typedef double (*SymbolValue)(void *context, Expr symbol);
/* The value of one expression, slowly: for tests and constants. NAN where undefined. */
double expr_evaluate(Expr e, SymbolValue value, void *context);
/* Evaluate many expressions at one point: each symbol's value is requested once, and each node is
 * computed once. Uses 9 bytes for each node of the arena. */
typedef struct Evaluation Evaluation;
Evaluation *evaluation_new(SymbolValue value, void *context); /* new; borrows the context */
double evaluation_of(Evaluation *evaluation, Expr e);
void evaluation_free(Evaluation *evaluation); /* NULL is fine */

/* --- counting (the rule is in the manual: n-ary sum n-1 additions, x^k k-1
 * multiplications, each call one function, a coefficient other than 1 and -1 is a
 * factor, negation is free, a division counts as a multiplication) --- */

typedef struct OpCount {
    int64_t add;
    int64_t mul;
    int64_t fun;
} OpCount;

/* As written, nothing shared; also where that is far too long to print (saturates at 2^62).
 * Operations inside arguments of functions count. O(nodes). */
OpCount expr_count(const Expr *roots, int count);
/* After common subexpressions are shared: each node once. */
OpCount expr_count_shared(const Expr *roots, int count);
/* the same without what follows from symbols of `kinds` alone (bits as of expr_kinds(); 0: all) */
OpCount expr_count_without(const Expr *roots, int count, unsigned kinds);
/* expr_count_shared() of what may be large; E_STOPPED, *out unchanged */
MUST_USE Status expr_count_watched(const Expr *roots, int count, const CallMonitor *watch,
                                   OpCount *out);
OpCount op_count_plus(OpCount a, OpCount b); /* saturates as the counts do */
int64_t op_count_total(OpCount count);

/* --- printing --- */

typedef enum Notation {
#define NOTATION(id, ...) NOTATION_##id,
#include "expr/notations.def"
#undef NOTATION
    NOTATIONS
} Notation;

typedef enum NotationKind {                   /* what lines of it are for */
                            NOTATION_READ,    /* a screen */
                            NOTATION_TYPESET, /* a paper */
                            NOTATION_SOURCE,  /* a compiler */
                            NOTATION_OUTLINE  /* to be seen as parts */
} NotationKind;

typedef struct NotationRow { /* as in notations.def */
    const char *word;
    NotationKind kind;
    int first;
    const char *open, *close;
    const char *times, *fresh;
    const char *brief;
} NotationRow;

const NotationRow *notation_row(Notation notation);
bool notation_find(const char *word, Notation *out); /* false: unknown, *out unchanged */

/* Append `e`. Text parses back to the same pointer (with the parser of the command language).
 * Numbers: rationals as decimals where these are exact and have up to 6 digits or are no longer
 * than the fraction, else as 1/3; doubles with the fewest digits that read back the same. In
 * source code names become identifiers: h8' is h8_d, m3.x is m3_x. */
void expr_print(Text *text, Expr e, Notation notation);
/* How source code of that notation calls a function: $0 is an argument, %0 one between operators;
 * new string. */
char *op_code(Op op, Notation notation);
char *expr_text(Expr e);                          /* new string, NOTATION_TEXT */
void latex_digits(Text *out, const char *digits); /* "1.5e-9" as 1.5 \cdot 10^{-9} */

#endif
