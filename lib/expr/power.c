/* power.c: powers
 *
 * Whole powers go into products and powers and fold numbers; half ones are powers
 * of a square root; what else could change the value for negative bases stays. */
#include "expr/expr_impl.h"

#include <math.h>

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

/* sqrt(a)^k: a^(k/2) for even k; roots of numbers keep only one root */
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

/* a number to a power that isn't whole; NULL where that stays as it is */
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
