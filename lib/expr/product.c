/* product.c: products and powers
 *
 * A factor is a base and an exponent. Factors are ordered by their bases, those of one base are one
 * power, and the number is first. A sum as a factor has no minus sign before its first term: the
 * sign is moved to the number.
 *
 * Integer powers distribute over products and powers, and fold numbers. Half-integer ones are
 * powers of a square root. Other powers remain, since rewriting could change the value for negative
 * bases. */
#include "expr/expr_impl.h"

#include <math.h>

/* --- products --- */

enum { AT_HAND = 16 };

/* factors on their way into a node */
typedef struct GatheredFactors {
    Item *items;
    int count;
    Number number;
} GatheredFactors;

static Item factor_item(Arena *arena, Expr factor)
{
    Item item = {.key = factor, .exponent = arena_one(arena), .whole = factor};
    int64_t k;

    if (factor->kind == EXPR_POWER) {
        item.key = node_args(factor)[0];
        item.exponent = node_args(factor)[1];
    }
    /* a root is the power 1/2 while it is collected */
    if (is_call(item.key, OP_SQRT) && expr_integer(item.exponent, &k)) {
        item.key = node_args(item.key)[0];
        item.exponent = expr_rational(arena, k, 2);
    }
    return item;
}

static void push_factor(Arena *arena, GatheredFactors *gathered, Expr factor)
{
    if (is_number(factor)) {
        gathered->number = number_mul(gathered->number, number_of(factor));
        return;
    }
    if (factor->kind == EXPR_SUM && is_negative(factor)) {
        gathered->number = number_neg(gathered->number);
        factor = sum_negate(arena, factor);
    }
    gathered->items[gathered->count++] = factor_item(arena, factor);
}

/* Add the exponents of equal bases, which are adjacent. */
static void merge_factors(Arena *arena, GatheredFactors *gathered)
{
    Item *items = gathered->items;
    int kept = 0;

    for (int i = 0; i < gathered->count; i++) {
        if (kept > 0 && items[kept - 1].key == items[i].key) {
            items[kept - 1].exponent = expr_add(arena, items[kept - 1].exponent, items[i].exponent);
            items[kept - 1].whole = NULL;
        } else
            items[kept++] = items[i];
    }
    gathered->count = kept;
}

/* the node [number, factors...]; args[0] is free for the number */
static Expr product_node(Arena *arena, Number number, Expr *args, int count)
{
    if (number_is(number, 0))
        return arena_zero(arena);
    if (count == 0)
        return number_node(arena, number);
    if (count == 1 && number_is(number, 1))
        return args[1];
    if (count == 1 && number_is(number, -1) && args[1]->kind == EXPR_SUM)
        return sum_negate(arena, args[1]);
    if (number_is(number, 1))
        return node_intern(arena, EXPR_PRODUCT, 0, args + 1, count);
    args[0] = number_node(arena, number);
    return node_intern(arena, EXPR_PRODUCT, 0, args, count + 1);
}

/* The product of unlike factors in order. */
static Expr product_of_items(Arena *arena, const GatheredFactors *gathered)
{
    Expr at_hand[AT_HAND + 1];
    Expr *args = gathered->count <= AT_HAND ? at_hand : NEW_ARRAY(Expr, gathered->count + 1);
    Number number = gathered->number;
    bool again = false;
    int kept = 0;
    Expr product;

    for (int i = 0; i < gathered->count; i++) {
        const Item *item = &gathered->items[i];
        Expr factor =
            item->whole != NULL ? item->whole : expr_pow(arena, item->key, item->exponent);

        if (is_number(factor)) {
            number = number_mul(number, number_of(factor));
            continue;
        }
        /* sqrt(a*b)*sqrt(a*b), sqrt(b - a)*sqrt(b - a) */
        again = again || factor->kind == EXPR_PRODUCT ||
                (factor->kind == EXPR_SUM && item->whole == NULL);
        args[++kept] = factor;
    }
    if (again && kept > 1) {
        args[0] = number_node(arena, number);
        product = expr_product(arena, args, kept + 1);
    } else if (again)
        product = expr_mul(arena, number_node(arena, number), args[1]);
    else
        product = product_node(arena, number, args, kept);
    if (args != at_hand)
        mem_free(args);
    return product;
}

Expr expr_product(Arena *arena, const Expr *factors, int count)
{
    Item at_hand[AT_HAND];
    GatheredFactors gathered = {.items = at_hand, .number = number_int(1)};
    int total = 0;
    Expr product;

    for (int i = 0; i < count; i++)
        total += factors[i]->kind == EXPR_PRODUCT ? factors[i]->count : 1;
    if (total > AT_HAND)
        gathered.items = NEW_ARRAY(Item, total);
    for (int i = 0; i < count; i++) {
        if (factors[i]->kind != EXPR_PRODUCT) {
            push_factor(arena, &gathered, factors[i]);
            continue;
        }
        for (int j = 0; j < factors[i]->count; j++)
            push_factor(arena, &gathered, node_args(factors[i])[j]);
    }
    items_sort(gathered.items, gathered.count, order_bases);
    merge_factors(arena, &gathered);
    product =
        number_is(gathered.number, 0) ? arena_zero(arena) : product_of_items(arena, &gathered);
    if (gathered.items != at_hand)
        mem_free(gathered.items);
    return product;
}

Expr expr_mul(Arena *arena, Expr a, Expr b)
{
    if (expr_is(a, 1))
        return b;
    if (expr_is(b, 1) || expr_is_zero(a))
        return a;
    if (expr_is_zero(b))
        return b;
    return expr_product(arena, (Expr[]){a, b}, 2);
}

Expr expr_div(Arena *arena, Expr a, Expr b)
{
    return expr_mul(arena, a, expr_pow(arena, b, expr_int(arena, -1)));
}

/* --- powers --- */

/* a whole power of a number */
static Expr number_raised(Arena *arena, Expr base, int64_t k)
{
    if (k < 0 && expr_is_zero(base)) {
        arena_fail(arena, E_DOMAIN, "division by zero");
        return arena_zero(arena);
    }
    return number_node(arena, number_power(number_of(base), k));
}

static Expr product_raised(Arena *arena, Expr product, Expr exponent)
{
    Expr *factors = NEW_ARRAY(Expr, product->count);
    Expr power;

    for (int i = 0; i < product->count; i++)
        factors[i] = expr_pow(arena, node_args(product)[i], exponent);
    power = expr_product(arena, factors, product->count);
    mem_free(factors);
    return power;
}

/* sqrt(a)^k: a^(k/2) for even k; at most one root of a number remains */
static Expr root_raised(Arena *arena, Expr root, int64_t k)
{
    Expr inside = node_args(root)[0];
    int64_t half = (k - (k % 2 != 0 && k < 0)) / 2; /* rounded down */

    if (k % 2 == 0)
        return expr_pow(arena, inside, expr_int(arena, half));
    if (is_number(inside))
        return expr_mul(arena, expr_pow(arena, inside, expr_int(arena, half)), root);
    return k == 1 ? root : node_intern(arena, EXPR_POWER, 0, (Expr[]){root, expr_int(arena, k)}, 2);
}

static Expr raised(Arena *arena, Expr base, int64_t k)
{
    Expr exponent = expr_int(arena, k);

    if (k == 0)
        return arena_one(arena);
    if (k == 1)
        return base;
    if (is_number(base))
        return number_raised(arena, base, k);
    if (base->kind == EXPR_POWER)
        return expr_pow(arena, node_args(base)[0], expr_mul(arena, node_args(base)[1], exponent));
    if (base->kind == EXPR_PRODUCT)
        return product_raised(arena, base, exponent);
    if (is_call(base, OP_SQRT))
        return root_raised(arena, base, k);
    if (is_call(base, OP_ABS) && k % 2 == 0)
        return expr_pow(arena, node_args(base)[0], exponent);
    if (base->kind == EXPR_SUM && is_negative(base)) {
        Expr power = expr_pow(arena, sum_negate(arena, base), exponent);

        return k % 2 == 0 ? power : expr_neg(arena, power);
    }
    return node_intern(arena, EXPR_POWER, 0, (Expr[]){base, exponent}, 2);
}

/* a number to a power that isn't an integer; NULL if that remains unchanged */
static Expr numbers_raised(Arena *arena, Expr base, Expr exponent)
{
    Number root;
    double value;

    if (exponent->kind == EXPR_RATIONAL &&
        number_root(number_of(base), node_ratio(exponent)->den, &root))
        return number_node(arena, number_power(root, node_ratio(exponent)->num));
    if (base->kind == EXPR_RATIONAL && exponent->kind == EXPR_RATIONAL)
        return NULL;
    value = pow(expr_value(base), expr_value(exponent));
    return isfinite(value) ? expr_real(arena, value) : NULL;
}

Expr expr_pow(Arena *arena, Expr base, Expr exponent)
{
    Expr power = NULL;
    int64_t k;

    if (expr_integer(exponent, &k))
        return raised(arena, base, k);
    if (expr_is(base, 1))
        return base;
    if (expr_is_zero(base) && is_number(exponent)) {
        if (!is_negative(exponent))
            return base;
        return number_raised(arena, base, -1);
    }
    if (exponent->kind == EXPR_RATIONAL && node_ratio(exponent)->den == 2)
        return raised(arena, expr_sqrt(arena, base), node_ratio(exponent)->num);
    if (is_number(base) && is_number(exponent))
        power = numbers_raised(arena, base, exponent);
    return power != NULL ? power : node_intern(arena, EXPR_POWER, 0, (Expr[]){base, exponent}, 2);
}

Expr expr_square(Arena *arena, Expr a)
{
    return raised(arena, a, 2);
}

double power_value(double base, Expr exponent, double exponent_value)
{
    int64_t k;
    double power = 1;

    if (!expr_integer(exponent, &k) || k > 64 || k < -64)
        return pow(base, exponent_value);
    for (int64_t i = k < 0 ? -k : k; i > 0; i--)
        power *= base;
    return k < 0 ? 1 / power : power;
}
