/* common_denominator.c: the least common denominator of terms */
#include "formulate/reduced/common_denominator.h"

/* a sum as its terms, anything else as one */
static int term_count(Expr e)
{
    return expr_kind(e) == EXPR_SUM ? expr_arg_count(e) : 1;
}

static Expr term_at(Expr e, int i)
{
    return expr_kind(e) == EXPR_SUM ? expr_arg(e, i) : e;
}

static int factor_count(Expr term)
{
    return expr_kind(term) == EXPR_PRODUCT ? expr_arg_count(term) : 1;
}

static Expr factor_at(Expr term, int i)
{
    return expr_kind(term) == EXPR_PRODUCT ? expr_arg(term, i) : term;
}

/* the base of a factor below the fraction line, and its power; 0: it is above */
static int64_t power_below(Expr factor, Expr *base)
{
    int64_t num, den;

    if (expr_kind(factor) != EXPR_POWER || !expr_rational_parts(expr_arg(factor, 1), &num, &den) ||
        den != 1 || num >= 0)
        return 0;
    *base = expr_arg(factor, 0);
    return -num;
}

static void add_factor(CommonDenominator *denominator, Expr factor)
{
    Expr base = NULL;
    const int64_t power = power_below(factor, &base);
    int at = 0;

    if (power == 0)
        return;
    while (at < denominator->bases.count && denominator->bases.at[at] != base)
        at++;
    if (at == denominator->bases.count) {
        LIST_PUSH(denominator->bases, base);
        LIST_PUSH(denominator->powers, (int64_t)0);
    }
    if (power > denominator->powers.at[at])
        denominator->powers.at[at] = power;
}

void denominator_add(CommonDenominator *denominator, Expr e)
{
    for (int i = 0; i < term_count(e); i++)
        for (int k = 0; k < factor_count(term_at(e, i)); k++)
            add_factor(denominator, factor_at(term_at(e, i), k));
}

Expr denominator_done(Arena *arena, CommonDenominator *denominator)
{
    Expr out = expr_int(arena, 1);

    for (int i = 0; i < denominator->bases.count; i++)
        out = expr_mul(
            arena, out,
            expr_pow(arena, denominator->bases.at[i], expr_int(arena, denominator->powers.at[i])));
    LIST_FREE(denominator->bases);
    LIST_FREE(denominator->powers);
    return out;
}

Expr terms_times(Arena *arena, Expr e, Expr factor)
{
    const int count = term_count(e);
    Expr *terms = NEW_ARRAY(Expr, count);
    Expr sum;

    for (int i = 0; i < count; i++)
        terms[i] = expr_mul(arena, term_at(e, i), factor);
    sum = expr_sum(arena, terms, count);
    mem_free(terms);
    return sum;
}
