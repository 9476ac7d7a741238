/* order.c: the stable order of terms and factors
 *
 * A term is compared as the list of its factors without the numeric coefficient, a factor as base
 * and exponent. Lists compare lexicographically, bases by kind and then by their own arguments. The
 * first pair that differs decides, so that a comparison follows one path down. Expressions of more
 * than TALLEST levels, which nobody reads, come last, in the order of a hash of their structure,
 * which doesn't depend on what was made before. */
#include "expr/expr_impl.h"

#include <string.h>

ProductFactors term_factors(const Expr *term)
{
    Expr e = *term;
    const Expr *args = node_args(e);

    if (e->kind != EXPR_PRODUCT)
        return (ProductFactors){term, 1};
    if (is_number(args[0]))
        return (ProductFactors){args + 1, e->count - 1};
    return (ProductFactors){args, e->count};
}

Number term_coefficient(Expr term)
{
    if (term->kind == EXPR_PRODUCT && is_number(node_args(term)[0]))
        return number_of(node_args(term)[0]);
    return number_int(1);
}

/* Numbers, symbols, sums, functions, then what is left; reads well in products. */
static int rank(Expr e)
{
    static const int ranks[] = {
        [EXPR_RATIONAL] = 0, [EXPR_REAL] = 0,  [EXPR_SYMBOL] = 1,  [EXPR_SUM] = 2,
        [EXPR_CALL] = 3,     [EXPR_POWER] = 4, [EXPR_PRODUCT] = 4,
    };

    return ranks[e->kind];
}

static int order(int64_t a, int64_t b)
{
    return (a > b) - (a < b);
}

/* Different structures of one hash are one in four thousand millions. */
static int order_hashes(Expr a, Expr b, bool *by_hash)
{
    *by_hash = true;
    return a->hash != b->hash ? order(a->hash, b->hash) : order(a->number, b->number);
}

/* By kind and order of creation. Generated parameters, named #..., come after the user's, ordered
 * by name, because that doesn't depend on when they were made. */
int order_symbols(Expr a, Expr b)
{
    const SymbolData *one = node_symbol(a), *other = node_symbol(b);
    const int first = order(one->kind, other->kind);
    const bool own = one->name[0] == '#', others = other->name[0] == '#';

    if (first != 0)
        return first;
    if (one->kind != SYMBOL_PARAMETER || (!own && !others))
        return order(one->number, other->number);
    return own && others ? strcmp(one->name, other->name) : order(own, others);
}

/* `by_hash` becomes true where a hash decided: see order_lasts() */
static int bases_below(Expr a, Expr b, bool *by_hash);
static int whole_below(Expr a, Expr b, bool *by_hash);

static int factors_below(Expr a, Expr b, bool *by_hash)
{
    Expr base_a = a->kind == EXPR_POWER ? node_args(a)[0] : a;
    Expr base_b = b->kind == EXPR_POWER ? node_args(b)[0] : b;
    int first;

    if (a == b)
        return 0;
    first = bases_below(base_a, base_b, by_hash);
    if (first != 0)
        return first;

    /* higher powers first; a plain factor is the power 1 */
    if (a->kind == EXPR_POWER && b->kind == EXPR_POWER)
        return -whole_below(node_args(a)[1], node_args(b)[1], by_hash);
    if (a->kind == EXPR_POWER)
        return number_sign(number_add(is_number(node_args(a)[1]) ? number_of(node_args(a)[1])
                                                                 : number_int(2),
                                      number_int(-1))) > 0
                   ? -1
                   : 1;
    return -factors_below(b, a, by_hash);
}

static int terms_below(Expr a, Expr b, bool *by_hash)
{
    ProductFactors left = term_factors(&a);
    ProductFactors right = term_factors(&b);

    for (int i = 0; i < left.count && i < right.count; i++) {
        int first = factors_below(left.at[i], right.at[i], by_hash);

        if (first != 0)
            return first;
    }
    return order(right.count, left.count);
}

/* terms and, of like terms, coefficients */
static int whole_below(Expr a, Expr b, bool *by_hash)
{
    int first;

    if (a == b)
        return 0;
    first = terms_below(a, b, by_hash);
    return first != 0 ? first : number_compare(term_coefficient(a), term_coefficient(b));
}

static int args_below(Expr a, Expr b, bool *by_hash)
{
    for (int i = 0; i < a->count && i < b->count; i++) {
        int first = whole_below(node_args(a)[i], node_args(b)[i], by_hash);

        if (first != 0)
            return first;
    }
    return order(b->count, a->count);
}

static int bases_below(Expr a, Expr b, bool *by_hash)
{
    Expr inner_a, inner_b;
    int first = 0;

    if (a == b)
        return 0;
    if (a->kind == EXPR_SYMBOL && b->kind == EXPR_SYMBOL)
        return order_symbols(a, b);
    inner_a = held(a);
    inner_b = held(b);
    if (inner_a == inner_b)
        return a == inner_a ? -1 : 1;
    first = order(rank(inner_a), rank(inner_b));
    if (first == 0)
        first = order(inner_a->height > TALLEST, inner_b->height > TALLEST);
    if (first != 0)
        return first;
    if (inner_a->height > TALLEST)
        return order_hashes(a, b, by_hash);
    switch (inner_a->kind) {
    case EXPR_RATIONAL:
    case EXPR_REAL:
        first = number_compare(number_of(inner_a), number_of(inner_b));
        break;
    case EXPR_SYMBOL:
        first = order_symbols(inner_a, inner_b);
        break;
    case EXPR_CALL:
        first = order(inner_a->op, inner_b->op);
        if (first == 0)
            first = args_below(inner_a, inner_b, by_hash);
        break;
    case EXPR_SUM:
        first = args_below(inner_a, inner_b, by_hash);
        break;
    default:
        first = whole_below(inner_a, inner_b, by_hash);
    }
    /* two bases that are equal without holds */
    return first != 0 ? first : order_hashes(a, b, by_hash);
}

int order_terms(Expr a, Expr b)
{
    bool by_hash;

    return a == b ? 0 : terms_below(a, b, &by_hash);
}

int order_bases(Expr a, Expr b)
{
    bool by_hash;

    return a == b ? 0 : bases_below(a, b, &by_hash);
}

int expr_compare(Expr a, Expr b)
{
    bool by_hash;

    return whole_below(a, b, &by_hash);
}

bool order_lasts(Expr a, Expr b, int (*compare)(Expr a, Expr b))
{
    bool by_hash = false;

    if (compare == order_terms)
        (void)terms_below(a, b, &by_hash);
    else if (compare == order_bases)
        (void)bases_below(a, b, &by_hash);
    else
        (void)whole_below(a, b, &by_hash);
    return !by_hash;
}

/* --- sorting --- */

static void insertion_sort(Item *items, int count, int (*compare)(Expr a, Expr b))
{
    for (int i = 1; i < count; i++) {
        Item item = items[i];
        int at = i;

        while (at > 0 && compare(items[at - 1].key, item.key) > 0) {
            items[at] = items[at - 1];
            at--;
        }
        items[at] = item;
    }
}

static void merge_sort(Item *items, Item *spare, int count, int (*compare)(Expr a, Expr b))
{
    int half = count / 2;
    int left = 0;
    int right = half;

    if (count <= 8) {
        insertion_sort(items, count, compare);
        return;
    }
    merge_sort(items, spare, half, compare);
    merge_sort(items + half, spare, count - half, compare);
    if (compare(items[half - 1].key, items[half].key) <= 0)
        return;
    memcpy(spare, items, (size_t)half * sizeof(Item));
    for (int i = 0; left < half; i++) {
        if (right < count && compare(items[right].key, spare[left].key) < 0)
            items[i] = items[right++];
        else
            items[i] = spare[left++];
    }
}

void items_sort(Item *items, int count, int (*compare)(Expr a, Expr b))
{
    Item *spare;

    if (count <= 8) {
        insertion_sort(items, count, compare);
        return;
    }
    spare = NEW_ARRAY(Item, count / 2 + 1);
    merge_sort(items, spare, count, compare);
    mem_free(spare);
}
