/* expand.c: products of sums multiplied out */
#include "expr/expr_impl.h"

/* The terms of a sum, or the one term that e is. */
static int terms_of(const Expr *e, const Expr **terms)
{
    bool sum = (*e)->kind == EXPR_SUM;

    *terms = sum ? node_args(*e) : e;
    return sum ? (*e)->count : 1;
}

/* a*b, multiplied out; NULL where that takes more than `limit` terms */
static Expr multiply_out(Arena *arena, Expr a, Expr b, int limit)
{
    const Expr *left;
    const Expr *right;
    int rows = terms_of(&a, &left);
    int columns = terms_of(&b, &right);
    Expr *terms;
    Expr sum;

    if ((int64_t)rows * columns > limit)
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
static int64_t whole_power(Expr factor, Expr *base)
{
    int64_t k;

    *base = factor;
    if (factor->kind != EXPR_POWER || node_args(factor)[0]->kind != EXPR_SUM ||
        !expr_integer(node_args(factor)[1], &k) || k < 1)
        return 1;
    *base = node_args(factor)[0];
    return k;
}

static Expr expand_node(Arena *arena, Expr e, void *context)
{
    const int limit = *(const int *)context;
    bool product = e->kind == EXPR_PRODUCT;
    Expr expanded = arena_one(arena);

    if (!product && e->kind != EXPR_POWER)
        return e;
    for (int i = 0; i < (product ? e->count : 1); i++) {
        Expr base;
        int64_t k = whole_power(product ? node_args(e)[i] : e, &base);

        for (; k > 0; k--) {
            expanded = multiply_out(arena, expanded, base, limit);
            if (expanded == NULL)
                return e;
        }
    }
    return expanded;
}

Expr expr_expand(Arena *arena, Expr e, int limit)
{
    return expr_change(arena, e, expand_node, &limit);
}
