/* expand.c: products of sums multiplied out */
#include "expr/expr_impl.h"

#include <limits.h>
#include <math.h>

typedef struct Expand {
    unsigned kinds; /* sums without symbols of these kinds are unchanged */
    int limit;      /* of terms */
    bool kept;      /* such a sum is a factor somewhere */
} Expand;

static bool is_open(const Expand *expand, Expr e)
{
    return e->kind == EXPR_SUM && (e->kinds & expand->kinds) != 0;
}

/* an unchanged sum, or a power of one */
static bool is_kept(const Expand *expand, Expr factor)
{
    if (factor->kind == EXPR_POWER)
        factor = node_args(factor)[0];
    return factor->kind == EXPR_SUM && !is_open(expand, factor);
}

/* The terms of a sum, or the one term that e is. */
static int terms_of(const Expand *expand, const Expr *e, const Expr **terms)
{
    bool open = is_open(expand, *e);

    *terms = open ? node_args(*e) : e;
    return open ? (*e)->count : 1;
}

/* a*b, multiplied out; NULL if that gives too many terms */
static Expr multiply_out(Arena *arena, const Expand *expand, Expr a, Expr b)
{
    const Expr *left;
    const Expr *right;
    int rows = terms_of(expand, &a, &left);
    int columns = terms_of(expand, &b, &right);
    Expr *terms;
    Expr sum;

    if ((int64_t)rows * columns > expand->limit)
        return NULL;
    terms = NEW_ARRAY(Expr, rows * columns);
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < columns; j++)
            terms[i * columns + j] = expr_mul(arena, left[i], right[j]);
    }
    sum = expr_sum(arena, terms, rows * columns);
    mem_free(terms);
    return sum;
}

/* How often a sum is a factor of itself: k of (a + b)^k, else 1. */
static int64_t whole_power(const Expand *expand, Expr factor, Expr *base)
{
    int64_t k;

    *base = factor;
    if (factor->kind != EXPR_POWER || !is_open(expand, node_args(factor)[0]) ||
        !expr_integer(node_args(factor)[1], &k) || k < 1)
        return 1;
    *base = node_args(factor)[0];
    return k;
}

static Expr expand_node(Arena *arena, Expr e, void *context)
{
    Expand *expand = context;
    bool product = e->kind == EXPR_PRODUCT;
    Expr expanded = arena_one(arena);

    if (!product && e->kind != EXPR_POWER)
        return e;
    for (int i = 0; i < (product ? e->count : 1); i++) {
        Expr base;
        int64_t k = whole_power(expand, product ? node_args(e)[i] : e, &base);

        expand->kept = expand->kept || is_kept(expand, base);
        for (; k > 0; k--) {
            expanded = multiply_out(arena, expand, expanded, base);
            if (expanded == NULL)
                return e;
        }
    }
    return expanded;
}

Expr expr_expand(Arena *arena, Expr e, int limit)
{
    bool ignored;

    return expr_expand_over(arena, e, ~0U, limit, &ignored);
}

Expr expr_expand_over(Arena *arena, Expr e, unsigned kinds, int limit, bool *kept)
{
    Expand expand = {.kinds = kinds, .limit = limit};
    Expr expanded = expr_change(arena, e, expand_node, &expand);

    *kept = expand.kept;
    return expanded;
}

/* how often x is a factor of a term; -1: as something else than a whole power */
static int power_in(Expr term, Expr x)
{
    int power = 0;

    if (!expr_depends(term, x))
        return 0;
    if (term == x)
        return 1;
    if (term->kind == EXPR_POWER && node_args(term)[0] == x) {
        const Expr exponent = node_args(term)[1];
        const double value = expr_is_number(exponent) ? expr_value(exponent) : -1;

        return value >= 0 && value < INT_MAX && value == floor(value) ? (int)value : -1;
    }
    for (int i = 0; term->kind == EXPR_PRODUCT && i < term->count; i++) {
        const int own = power_in(node_args(term)[i], x);

        if (own < 0)
            return -1;
        power += own;
    }
    return term->kind == EXPR_PRODUCT ? power : -1;
}

int expr_powers(Arena *arena, Expr e, Expr x, Expr *out, int most)
{
    enum { MOST_TERMS = 4096 };
    const Expr sum = expr_expand_over(arena, e, 1U << SYMBOL_ARGUMENT, MOST_TERMS, &(bool){false});
    const int terms = sum->kind == EXPR_SUM ? sum->count : 1;
    int count = 1;

    for (int k = 0; k < most; k++)
        out[k] = expr_int(arena, 0);
    for (int i = 0; i < terms; i++) {
        const Expr term = sum->kind == EXPR_SUM ? node_args(sum)[i] : sum;
        const int power = power_in(term, x);

        if (power < 0 || power >= most)
            return 0;
        out[power] = expr_add(arena, out[power],
                              expr_div(arena, term, expr_pow(arena, x, expr_int(arena, power))));
        count = power + 1 > count ? power + 1 : count;
    }
    return count;
}
