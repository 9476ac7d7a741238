/* ratio.c: a ratio of polynomials in several variables, as polynomials in the first of them */
#include "formulate/reduced/ratio.h"

#include <string.h>

typedef struct Atoms { /* what the variables are; 0: s */
    Arena *arena;
    const Expr *at;
    int count;
} Atoms;

/* num/den, as a rational where that is short */
static Expr number_of(Arena *arena, const mpq_t value)
{
    enum { SHORT = 1000000000 };

    if (mpz_cmpabs_ui(mpq_numref(value), SHORT) <= 0 &&
        mpz_cmpabs_ui(mpq_denref(value), SHORT) <= 0)
        return expr_rational(arena, mpz_get_si(mpq_numref(value)), mpz_get_si(mpq_denref(value)));
    return expr_real(arena, mpq_get_d(value));
}

/* the coefficient of a power of s in a polynomial, times scale */
static Expr coefficient_of(const Atoms *s, const Multinomial *p, int power, const mpq_t scale)
{
    Arena *arena = s->arena;
    Multinomial *part = multinomial_coefficient(p, 0, power);
    const int count = multinomial_terms(part);
    Expr *terms = NEW_ARRAY(Expr, count);
    Expr out;
    mpq_t factor;

    mpq_init(factor);
    for (int i = 0; i < count; i++) {
        mpq_set_z(factor, *multinomial_factor(part, i));
        mpq_mul(factor, factor, scale);
        terms[i] = number_of(arena, factor);
        for (int v = 1; v < s->count; v++)
            terms[i] =
                expr_mul(arena, terms[i],
                         expr_pow(arena, s->at[v], expr_int(arena, multinomial_power(part, i, v))));
    }
    mpq_clear(factor);
    out = expr_collect(arena, expr_sum(arena, terms, count));
    multinomial_free(part);
    mem_free(terms);
    return out;
}

static Factor factor_of(const Atoms *s, const Multinomial *p, const mpq_t scale)
{
    Factor out = {.degree = multinomial_degree(p, 0), .times = 1};

    out.at = NEW_ARRAY(Expr, out.degree + 1);
    for (int k = 0; k <= out.degree; k++)
        out.at[k] = coefficient_of(s, p, out.degree - k, scale);
    return out;
}

/* adds a factor; a factor without s joins the others of its kind, in front */
static void add_factor(const Atoms *s, Product *out, Factor factor)
{
    Arena *arena = s->arena;

    if (factor.degree == 0 && out->factors.count > 0 && out->factors.at[0].degree == 0) {
        out->factors.at[0].at[0] = expr_mul(arena, out->factors.at[0].at[0], factor.at[0]);
        mem_free(factor.at);
        return;
    }
    for (int i = 0; i < out->factors.count; i++)
        if (factor.degree > 0 && out->factors.at[i].degree == factor.degree &&
            memcmp(out->factors.at[i].at, factor.at,
                   ((size_t)factor.degree + 1) * sizeof *factor.at) == 0) {
            out->factors.at[i].times++;
            mem_free(factor.at);
            return;
        }
    LIST_PUSH(out->factors, factor);
    for (int i = out->factors.count - 1; factor.degree == 0 && i > 0; i--) {
        out->factors.at[i] = out->factors.at[i - 1];
        out->factors.at[i - 1] = factor;
    }
}

enum { LONG = 1000000 }; /* integers longer than anybody reads */

/* a factor with few numbers in it: its integers, where they are long, divided by the last */
static void write_factor(const Atoms *s, const Multinomial *p, Product *out, mpq_t number)
{
    const int count = multinomial_terms(p);
    bool is_long = false;
    mpq_t scale;

    mpq_init(scale);
    mpq_set_si(scale, 1, 1);
    for (int i = 0; i < count; i++)
        is_long = is_long || mpz_cmpabs_ui(*multinomial_factor(p, i), LONG) > 0;
    if (is_long || multinomial_is_number(p)) {
        mpq_set_z(scale, *multinomial_factor(p, count - 1));
        mpq_mul(number, number, scale);
        mpq_inv(scale, scale);
    }
    if (!multinomial_is_number(p))
        add_factor(s, out, factor_of(s, p, scale));
    mpq_clear(scale);
}

/* p in factors, where these are shorter; multiplies `number` by the number among them */
static void write_product(const Atoms *s, const Multinomial *p, Product *out, mpq_t number)
{
    MultinomialList factors = {0};
    int terms = 0;

    multinomial_split(p, &factors);
    for (int i = 0; i < factors.count; i++)
        terms += multinomial_terms(factors.at[i]);
    if (terms > multinomial_terms(p) + factors.count)
        write_factor(s, p, out, number);
    for (int i = 0; i < factors.count && terms <= multinomial_terms(p) + factors.count; i++)
        write_factor(s, factors.at[i], out, number);
    multinomials_free(&factors);
}

static void write_number(const Atoms *s, const mpz_t num, const mpz_t den, Product *out)
{
    Factor factor = {.times = 1, .at = NEW_ARRAY(Expr, 1)};
    mpq_t value;

    mpq_init(value);
    mpz_set(mpq_numref(value), num);
    mpz_set(mpq_denref(value), den);
    factor.at[0] = number_of(s->arena, value);
    mpq_clear(value);
    if (expr_is(factor.at[0], 1))
        mem_free(factor.at);
    else
        add_factor(s, out, factor);
}

/* number over/under; a fraction of long integers comes first, as one number */
static void write_ratio_of(const Atoms *s, const Multinomial *over, const Multinomial *under,
                           PolynomialRatio *out)
{
    mpz_t one;
    mpq_t number, divisor;

    mpz_init_set_si(one, 1);
    mpq_inits(number, divisor, NULL);
    mpq_set_si(number, 1, 1);
    mpq_set_si(divisor, 1, 1);
    write_product(s, over, &out->over, number);
    write_product(s, under, &out->under, divisor);
    mpq_div(number, number, divisor);
    if (mpz_cmpabs_ui(mpq_numref(number), LONG) > 0 ||
        mpz_cmpabs_ui(mpq_denref(number), LONG) > 0) {
        write_number(s, mpq_numref(number), mpq_denref(number), &out->over);
    } else {
        write_number(s, mpq_numref(number), one, &out->over);
        write_number(s, mpq_denref(number), one, &out->under);
    }
    mpq_clears(number, divisor, NULL);
    mpz_clear(one);
}

static void write_zero(const Atoms *s, PolynomialRatio *out)
{
    Factor factor = {.times = 1, .at = NEW_ARRAY(Expr, 1)};

    factor.at[0] = expr_int(s->arena, 0);
    add_factor(s, &out->over, factor);
}

void ratio_write(Arena *arena, const Expr *atoms, int count, const Multinomial *over,
                 const Multinomial *under, PolynomialRatio *out)
{
    const Atoms all = {arena, atoms, count};
    Multinomial *common, *p, *q;

    if (over == NULL) {
        write_zero(&all, out);
        return;
    }
    common = multinomial_gcd(over, under);
    p = multinomial_exact(over, common);
    q = multinomial_exact(under, common);
    if (!multinomial_failed(q))
        write_ratio_of(&all, p, q, out);
    multinomial_free(common);
    multinomial_free(p);
    multinomial_free(q);
}

void ratio_negate(Arena *arena, PolynomialRatio *ratio)
{
    Product *over = &ratio->over;
    Factor *first = over->factors.at;

    if (over->factors.count == 0 ||
        (first->degree > 0 && (over->factors.count > 1 || first->times > 1))) {
        Factor minus = {.times = 1, .at = NEW_ARRAY(Expr, 1)};

        minus.at[0] = expr_int(arena, -1);
        LIST_PUSH(over->factors, minus);
        memmove(over->factors.at + 1, over->factors.at,
                (size_t)(over->factors.count - 1) * sizeof *over->factors.at);
        over->factors.at[0] = minus;
        return;
    }
    for (int k = 0; k <= first->degree; k++)
        first->at[k] = expr_neg(arena, first->at[k]);
}

void ratio_free(PolynomialRatio *ratio)
{
    Product *const both[] = {&ratio->over, &ratio->under};

    for (int k = 0; k < COUNT(both); k++) {
        for (int f = 0; f < both[k]->factors.count; f++)
            mem_free(both[k]->factors.at[f].at);
        LIST_FREE(both[k]->factors);
    }
}
