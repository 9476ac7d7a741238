/* expr_impl.h: what the files of lib/expr share
 *
 * A node is a head of 16 bytes, followed by its arguments, or by the numbers or the name of a leaf.
 * A child is always older than its parents, so that its creation number is smaller. */
#ifndef COTREE_EXPR_IMPL_H
#define COTREE_EXPR_IMPL_H

#include "base/memory.h"
#include "expr/expr.h"

#include <stdint.h>

enum { TALLEST = 24 }; /* levels of what is compared by its structure */

struct ExprNode {
    uint8_t kind : 3;
    uint8_t height : 5; /* levels below, TALLEST + 1 at most */
    uint8_t op;         /* of a call; of a real the power of pi, 0 where it is a double */
    uint16_t kinds;     /* of symbols below, bit 1 << SymbolKind */
    uint32_t number;
    uint32_t hash; /* of its structure down to names and numbers: the same in every arena */
    int32_t count; /* of arguments */
};

typedef struct Ratio {
    int64_t num;
    int64_t den;
} Ratio;

typedef struct SymbolData {
    const char *name;
    int number;
    SymbolKind kind;
    const Curve *table; /* of SYMBOL_TABLE */
} SymbolData;

static inline const Expr *node_args(Expr e)
{
    return (const Expr *)(const void *)(e + 1);
}

static inline const Ratio *node_ratio(Expr e)
{
    return (const Ratio *)(const void *)(e + 1);
}

static inline const SymbolData *node_symbol(Expr e)
{
    return (const SymbolData *)(const void *)(e + 1);
}

static inline bool is_number(Expr e)
{
    return e->kind <= EXPR_REAL;
}

static inline bool is_call(Expr e, Op op)
{
    return e->kind == EXPR_CALL && e->op == op;
}

/* the operand of a hold, else `e` itself */
static inline Expr held(Expr e)
{
    return is_call(e, OP_HOLD) ? node_args(e)[0] : e;
}

/* --- arena.c --- */

/* The node of that kind, operator and arguments, found or made. Simplifies nothing. */
Expr node_intern(Arena *arena, ExprKind kind, Op op, const Expr *args, int count);
Expr node_rational(Arena *arena, int64_t num, int64_t den); /* lowest terms, den > 0 */
Expr node_real(Arena *arena, double value);
Expr node_pi(Arena *arena, int64_t num, int64_t den, int power);   /* power not 0, of 8 bits */
void arena_fail(Arena *arena, Status status, const char *message); /* a literal; first one stays */
Expr arena_zero(const Arena *arena);
Expr arena_one(const Arena *arena);
/* derivatives that were found before; NULL where not */
Expr arena_recall(const Arena *arena, Expr e, Expr symbol);
void arena_remember(Arena *arena, Expr e, Expr symbol, Expr derivative);

/* --- number.c: a number outside of nodes --- */

typedef struct Number {
    int64_t num;
    int64_t den; /* > 0, or 0 where `real` counts */
    union {
        double real;
        int64_t pi; /* num/den times that power of pi; 0 of a rational */
    };
} Number;

Number number_int(int64_t value);
Number number_of(Expr number);
Number number_add(Number a, Number b);
/* *sum += a. *size starts at 0 and becomes the sum of the sizes of rounded terms, 0 if there are
 * none. A sum of doubles within `ROUNDED` of that size is rounding of 0, and becomes 0. Rationals,
 * such as 1e-17 typed by a user, are exact and not affected. */
void number_gather(Number *sum, double *size, Number a);
Number number_mul(Number a, Number b);
Number number_neg(Number a);
/* a^k; a isn't 0 where k < 0 */
Number number_power(Number a, int64_t k);
bool number_is(Number a, int64_t value);
bool number_is_whole(Number a);
bool number_same(Number a, Number b);
int number_compare(Number a, Number b);
int number_sign(Number a);
double number_value(Number a);
Expr number_node(Arena *arena, Number a);
/* the exact k-th root of a positive rational, where there is one */
bool number_root(Number a, int64_t k, Number *root);
/* whether e is an integer, and which */
bool expr_integer(Expr e, int64_t *value);
/* the decimal `text` exactly; false where it doesn't fit or has more digits than a rational prints
 */
bool decimal_exact(const char *text, int64_t *num, int64_t *den);

/* --- renamings that the arena keeps (rename.c) --- */

typedef struct Renamings Renamings;
Renamings *arena_renamings(const Arena *arena); /* NULL: none */
/* `release` ends those; what was there before is the caller's */
void arena_add_renamings(Arena *arena, Renamings *renamings, void (*release)(Renamings *));
/* They refer to new nodes from now on: release to an older mark removes them. */
void arena_touch_renamings(Arena *arena);

/* --- order.c --- */

/* A view of a term without its numeric coefficient: its factors. */
typedef struct ProductFactors {
    const Expr *at;
    int count;
} ProductFactors;

ProductFactors term_factors(const Expr *term);
Number term_coefficient(Expr term);
int order_terms(Expr a, Expr b); /* without their coefficients; 0: like terms */
int order_bases(Expr a, Expr b);
int order_symbols(Expr a, Expr b);
/* Whether kinds, numbers and the order of symbols alone determine how two compare by order_terms(),
 * order_bases() or expr_compare(). Then the comparison is the same after a renaming that preserves
 * the order of symbols. */
bool order_lasts(Expr a, Expr b, int (*compare)(Expr a, Expr b));

/* A term of a sum, or a factor of a product, on its way into the node. */
typedef struct Item {
    Expr key;           /* the term; the factor's base */
    Expr exponent;      /* of a factor */
    Expr whole;         /* the original factor, NULL once two were merged */
    Number coefficient; /* of a term */
    double size;        /* of what was rounded in it (number_gather()) */
} Item;

/* Stable sort by the keys. O(n log n), O(n) where in order already. */
void items_sort(Item *items, int count, int (*compare)(Expr a, Expr b));

/* --- sum.c, product.c --- */

bool is_negative(Expr e); /* would print with a minus sign before it; numbers: below 0 */
Expr term_scale(Arena *arena, Expr term, Number coefficient); /* instead of the one it has */
Expr sum_negate(Arena *arena, Expr sum);

/* --- heap.c: ranks by their saving, the greatest first --- */

typedef struct Rank {
    int64_t saving;
    unsigned later; /* among equal savings the smaller value is first, then the lower index */
    int which;      /* the caller's index */
} Rank;

typedef LIST(Rank) Heap;

void heap_push(Heap *heap, Rank rank);
Rank heap_pop(Heap *heap); /* of a heap that isn't empty */

/* --- substitute.c --- */

/* The node of e's kind and operator over other arguments, simplified. */
Expr expr_rebuild(Arena *arena, Expr e, const Expr *args);

/* --- call.c --- */

/* derivative of the call e, given those of its arguments */
Expr op_derivative(Arena *arena, Expr e, const Expr *rates);

/* --- product.c --- */

double power_value(double base, Expr exponent, double exponent_value);

/* --- walk.c: the nodes below some roots, children first --- */

typedef struct WalkLevel {
    Expr e;
    int next; /* argument to look at */
} WalkLevel;

typedef struct Walk {
    Expr *nodes; /* in the order of finishing */
    int count;
    int room;
    uint32_t *keys; /* hash table: creation number + 1, 0 where empty */
    int *places;    /* and the place in `nodes` */
    uint32_t size;
    LIST(WalkLevel) stack; /* empty between calls */
} Walk;

/* Whether a walk goes on below a node; a leaf of the walk is listed all the same. */
typedef bool (*WalkInto)(void *context, Expr e);

int walk_find(const Walk *walk, Expr e); /* its place, or -1 */
int walk_add(Walk *walk, Expr e);        /* its place, found or new */
/* Add what is below `root` and of the symbol kinds `mask` (0: everything). */
void walk_below(Walk *walk, Expr root, unsigned mask, WalkInto into, void *context);
void walk_roots(Walk *walk, const Expr *roots, int count); /* all below them */
void walk_free(Walk *walk);

#endif
