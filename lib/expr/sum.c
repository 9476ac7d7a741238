/* sum.c: sums, and the signs that they share with everything else
 *
 * The terms of a sum are ordered, the constant last. Like terms, equal except for their numeric
 * coefficients, are merged. A number times a sum remains a product, but minus a sum is the sum of
 * the negatives. */
#include "expr/expr_impl.h"

#include <assert.h>

enum { AT_HAND = 32 };

bool is_negative(Expr e)
{
    /* a sum has the sign of its first term */
    if (e->kind == EXPR_SUM)
        e = node_args(e)[0];
    if (is_number(e))
        return number_sign(number_of(e)) < 0;
    return number_sign(term_coefficient(e)) < 0;
}

Expr sum_negate(Arena *arena, Expr sum)
{
    Expr at_hand[AT_HAND];
    Expr *terms = sum->count <= AT_HAND ? at_hand : NEW_ARRAY(Expr, sum->count);
    Expr negated;

    assert(sum->count > 1);
    for (int i = 0; i < sum->count; i++)
        terms[i] = expr_neg(arena, node_args(sum)[i]);
    negated = node_intern(arena, EXPR_SUM, 0, terms, sum->count);
    if (terms != at_hand)
        mem_free(terms);
    return negated;
}

Expr term_scale(Arena *arena, Expr term, Number coefficient)
{
    Expr at_hand[AT_HAND];
    ProductFactors factors = term_factors(&term);
    Expr *args = at_hand;
    Expr scaled;

    if (number_is(coefficient, 0))
        return arena_zero(arena);
    if (factors.count == 1 && number_is(coefficient, 1))
        return factors.at[0];
    if (factors.count == 1 && factors.at[0]->kind == EXPR_SUM) {
        if (number_is(coefficient, -1))
            return sum_negate(arena, factors.at[0]);
        if (is_negative(factors.at[0]))
            return term_scale(arena, sum_negate(arena, factors.at[0]), number_neg(coefficient));
    }
    if (number_is(coefficient, 1))
        return node_intern(arena, EXPR_PRODUCT, 0, factors.at, factors.count);
    if (factors.count >= AT_HAND)
        args = NEW_ARRAY(Expr, factors.count + 1);
    args[0] = number_node(arena, coefficient);
    for (int i = 0; i < factors.count; i++)
        args[i + 1] = factors.at[i];
    scaled = node_intern(arena, EXPR_PRODUCT, 0, args, factors.count + 1);
    if (args != at_hand)
        mem_free(args);
    return scaled;
}

Expr expr_neg(Arena *arena, Expr a)
{
    if (is_number(a))
        return number_node(arena, number_neg(number_of(a)));
    if (a->kind == EXPR_SUM)
        return sum_negate(arena, a);
    return term_scale(arena, a, number_neg(term_coefficient(a)));
}

static void push_term(Item *items, int *count, Item *constant, Expr term)
{
    if (is_number(term)) {
        number_gather(&constant->coefficient, &constant->size, number_of(term));
        return;
    }
    items[*count] = (Item){.key = term, .coefficient = number_int(0)};
    number_gather(&items[*count].coefficient, &items[*count].size, term_coefficient(term));
    (*count)++;
}

/* Add up like terms, which are adjacent; returns the number of remaining terms. */
static int merge_terms(Item *items, int count)
{
    int kept = 0;

    for (int i = 0; i < count; i++) {
        if (kept > 0 && order_terms(items[kept - 1].key, items[i].key) == 0)
            number_gather(&items[kept - 1].coefficient, &items[kept - 1].size,
                          items[i].coefficient);
        else
            items[kept++] = items[i];
    }
    return kept;
}

/* The sum of terms that are unlike and in order, and of a constant. */
static Expr sum_of_items(Arena *arena, const Item *items, int count, Number constant)
{
    Expr at_hand[AT_HAND];
    Expr *terms = count < AT_HAND ? at_hand : NEW_ARRAY(Expr, count + 1);
    bool nested = false;
    int kept = 0;
    Expr sum;

    for (int i = 0; i < count; i++) {
        Expr term = items[i].key;

        if (!number_same(items[i].coefficient, term_coefficient(term)))
            term = term_scale(arena, term, items[i].coefficient);
        if (expr_is_zero(term))
            continue;
        nested = nested || term->kind == EXPR_SUM || is_number(term);
        terms[kept++] = term;
    }
    if (!number_is(constant, 0))
        terms[kept++] = number_node(arena, constant);
    if (kept == 0)
        sum = arena_zero(arena);
    else if (kept == 1)
        sum = terms[0];
    else if (nested) /* 1/2*(a + b) + 1/2*(a + b) */
        sum = expr_sum(arena, terms, kept);
    else
        sum = node_intern(arena, EXPR_SUM, 0, terms, kept);
    if (terms != at_hand)
        mem_free(terms);
    return sum;
}

Expr expr_sum(Arena *arena, const Expr *terms, int count)
{
    Item at_hand[AT_HAND];
    Item *items = at_hand;
    Item constant = {.coefficient = number_int(0)};
    int total = 0;
    int kept = 0;
    int some = 0; /* that aren't 0 */
    Expr sum = arena_zero(arena);

    /* of what is formed of axes and matrices most is 0 */
    for (int i = 0; i < count; i++)
        if (!expr_is_zero(terms[i])) {
            sum = terms[i];
            some++;
        }
    if (some <= 1)
        return sum;
    for (int i = 0; i < count; i++)
        total += terms[i]->kind == EXPR_SUM ? terms[i]->count : 1;
    if (total > AT_HAND)
        items = NEW_ARRAY(Item, total);
    for (int i = 0; i < count; i++) {
        if (terms[i]->kind != EXPR_SUM) {
            push_term(items, &kept, &constant, terms[i]);
            continue;
        }
        for (int j = 0; j < terms[i]->count; j++)
            push_term(items, &kept, &constant, node_args(terms[i])[j]);
    }
    items_sort(items, kept, order_terms);
    kept = merge_terms(items, kept);
    sum = sum_of_items(arena, items, kept, constant.coefficient);
    if (items != at_hand)
        mem_free(items);
    return sum;
}

Expr expr_add(Arena *arena, Expr a, Expr b)
{
    return expr_sum(arena, (Expr[]){a, b}, 2);
}

Expr expr_sub(Arena *arena, Expr a, Expr b)
{
    if (expr_is_zero(b))
        return a;
    return expr_sum(arena, (Expr[]){a, expr_neg(arena, b)}, 2);
}
