/* test_multinomial.c: polynomials in several variables obey the laws of a ring, and those of
 * factors
 *
 * Values are held against machine integers at points; factors against what they were made of. */
#include "test.h"

#include "../random.h"
#include "algebra/multinomial.h"
#include "base/flint_library.h"
#include "base/transaction.h"

#include <flint/fmpz.h>
#include <limits.h>

enum { VARIABLES = 11, MOST = 5000, ROUNDS = 60 }; /* more than a word of powers */

static uint64_t state = 20261123;

static int one_of(int count)
{
    return (int)(test_random(&state) % (uint64_t)count);
}

/* the same at a point, modulo 2^64 */
static uint64_t value_at(const Multinomial *p, const uint64_t *point)
{
    uint64_t sum = 0;

    for (int i = 0; i < multinomial_terms(p); i++) {
        uint64_t term = (uint64_t)mpz_get_si(*multinomial_factor(p, i));

        for (int v = 0; v < VARIABLES; v++)
            for (int n = multinomial_power(p, i, v); n > 0; n--)
                term *= point[v];
        sum += term;
    }
    return sum;
}

static Multinomial *draw(Ring *ring, int terms, int variables)
{
    Multinomial *out = multinomial_small(ring, one_of(9) - 4);

    for (int i = 0; i < terms; i++) {
        Multinomial *term = multinomial_small(ring, one_of(11) - 5), *next;

        for (int k = one_of(4); k > 0; k--) {
            Multinomial *x =
                multinomial_variable(ring, one_of(variables) * (VARIABLES / variables));

            next = multinomial_times(term, x);
            multinomial_free(term);
            multinomial_free(x);
            term = next;
        }
        next = multinomial_sum(out, term, one_of(2) == 0 ? 1 : -1);
        multinomial_free(out);
        multinomial_free(term);
        out = next;
    }
    return out;
}

static void sums_and_products_have_the_values_of_numbers(void)
{
    Ring *ring = ring_new(VARIABLES, MOST, NULL);
    uint64_t point[VARIABLES];

    for (int v = 0; v < VARIABLES; v++)
        point[v] = test_random(&state);
    for (int k = 0; k < ROUNDS; k++) {
        Multinomial *p = draw(ring, one_of(12), VARIABLES), *q = draw(ring, one_of(12), VARIABLES);

        EXPECT(value_at(multinomial_sum(p, q, -1), point) ==
               value_at(p, point) - value_at(q, point));
        EXPECT(value_at(multinomial_times(p, q), point) == value_at(p, point) * value_at(q, point));
    }
    EXPECT(ring_status(ring) == OK);
    ring_free(ring);
}

static bool are_equal(const Multinomial *p, const Multinomial *q)
{
    return multinomial_is_zero(multinomial_sum(p, q, -1));
}

static void quotients_take_products_apart(void)
{
    Ring *ring = ring_new(VARIABLES, MOST, NULL);

    for (int k = 0; k < ROUNDS; k++) {
        Multinomial *p = draw(ring, one_of(12), 4), *q = draw(ring, 1 + one_of(8), 4);
        Multinomial *product = multinomial_times(p, q), *quotient, *off;

        if (multinomial_is_zero(q))
            continue;
        quotient = multinomial_quotient(product, q);
        EXPECT(quotient != NULL && are_equal(quotient, p));
        off = multinomial_sum(product, multinomial_small(ring, 1), 1);
        EXPECT(multinomial_is_number(q) || multinomial_quotient(off, q) == NULL);
    }
    EXPECT(ring_status(ring) == OK);
    ring_free(ring);
}

/* a common factor is found whole: what is left of both has none */
static void common_factors_are_found(void)
{
    Ring *ring = ring_new(VARIABLES, MOST, NULL);

    for (int k = 0; k < ROUNDS; k++) {
        Multinomial *g = draw(ring, 1 + one_of(4), 4);
        Multinomial *p = multinomial_times(draw(ring, 1 + one_of(5), 5), g);
        Multinomial *q = multinomial_times(draw(ring, 1 + one_of(5), 3), g), *common, *a, *b;

        if (multinomial_is_zero(p) || multinomial_is_zero(q))
            continue;
        common = multinomial_gcd(p, q);
        EXPECT(multinomial_quotient(common, g) != NULL);
        EXPECT(!multinomial_is_negative(common));
        a = multinomial_quotient(p, common);
        b = multinomial_quotient(q, common);
        EXPECT(a != NULL && b != NULL && multinomial_is(multinomial_gcd(a, b), 1));
    }
    EXPECT(ring_status(ring) == OK);
    ring_free(ring);
}

static void factors_multiply_to_the_whole(void)
{
    Ring *ring = ring_new(VARIABLES, MOST, NULL);

    for (int k = 0; k < ROUNDS; k++) {
        Multinomial *f = draw(ring, 2, 4), *g = draw(ring, 2, VARIABLES), *p, *product;
        MultinomialList factors = {0};

        p = multinomial_times(multinomial_times(f, g), one_of(2) == 0 ? f : g);
        multinomial_split(p, &factors);
        product = multinomial_small(ring, 1);
        for (int i = 0; i < factors.count; i++)
            product = multinomial_times(product, factors.at[i]);
        EXPECT(are_equal(product, p));
        LIST_FREE(factors);
    }
    EXPECT(ring_status(ring) == OK);
    ring_free(ring);
}

/* (x + y)^2 (x - z): three factors, whatever stood there multiplied out */
static void squares_and_products_are_seen(void)
{
    Ring *ring = ring_new(3, MOST, NULL);
    Multinomial *x = multinomial_variable(ring, 0), *y = multinomial_variable(ring, 1);
    Multinomial *a = multinomial_sum(x, y, 1);
    Multinomial *b = multinomial_sum(x, multinomial_variable(ring, 2), -1);
    MultinomialList factors = {0};

    multinomial_split(multinomial_times(multinomial_times(a, a), b), &factors);
    EXPECT(factors.count == 3);
    for (int i = 0; i < factors.count; i++)
        EXPECT(are_equal(factors.at[i], a) || are_equal(factors.at[i], b));
    multinomials_free(&factors);
    ring_free(ring);
}

static void what_is_beyond_the_bound_is_remembered(void)
{
    Ring *ring = ring_new(VARIABLES, 20, NULL);
    Multinomial *sum = multinomial_small(ring, 1);

    for (int v = 0; v < VARIABLES; v++)
        sum = multinomial_sum(sum, multinomial_variable(ring, v), 1);
    EXPECT(ring_status(ring) == OK);
    sum = multinomial_times(sum, sum);
    EXPECT(ring_status(ring) == E_MEMORY);
    EXPECT(multinomial_failed(sum));
    ring_free(ring);
}

/* x^512 - y^512 over x - y */
static void powers_have_no_bound(void)
{
    Ring *ring = ring_new(2, MOST, NULL);
    Multinomial *x = multinomial_variable(ring, 0), *y = multinomial_variable(ring, 1);
    Multinomial *by = multinomial_sum(x, y, -1), *quotient;

    for (int i = 0; i < 9; i++) {
        x = multinomial_times(x, x);
        y = multinomial_times(y, y);
    }
    quotient = multinomial_quotient(multinomial_sum(x, y, -1), by);
    EXPECT(multinomial_degree(x, 0) == 512);
    EXPECT(quotient != NULL && multinomial_terms(quotient) == 512);
    EXPECT(ring_status(ring) == OK);
    ring_free(ring);
}

/* (x^1024 - 1)/(x - 1) in x and in y: more pairs of terms than are multiplied at once */
static void long_products_are_formed_in_pieces(void)
{
    Ring *ring = ring_new(2, MOST, NULL);
    Multinomial *one = multinomial_small(ring, 1), *all[2], *square;
    bool rises = true;

    for (int v = 0; v < 2; v++) {
        Multinomial *x = multinomial_variable(ring, v), *by = multinomial_sum(x, one, -1);

        for (int i = 0; i < 10; i++)
            x = multinomial_times(x, x);
        all[v] = multinomial_exact(multinomial_sum(x, one, -1), by);
    }
    square = multinomial_times(all[0], all[0]);
    EXPECT(multinomial_terms(square) == 2047 && ring_status(ring) == OK);
    for (int i = 0; i < 1024; i++) /* 1, 2 ... 1024, and down again */
        rises = rises && mpz_cmp_si(*multinomial_factor(square, i), i + 1) == 0 &&
                mpz_cmp_si(*multinomial_factor(square, 2046 - i), i + 1) == 0;
    EXPECT(rises);
    /* a million terms, which are not all formed before the bound is noticed */
    EXPECT(multinomial_is_zero(multinomial_times(all[0], all[1])));
    EXPECT(ring_status(ring) == E_MEMORY);
    ring_free(ring);
}

/* Euclid's algorithm needs more terms on the way than the bound allows */
static void a_factor_of_long_polynomials_is_found(void)
{
    Ring *ring = ring_new(VARIABLES, 20000, NULL);

    for (int k = 0; k < 10; k++) {
        Multinomial *g = draw(ring, 20, VARIABLES), *p, *q, *common;

        p = multinomial_times(multinomial_times(g, draw(ring, 20, VARIABLES)), g);
        q = multinomial_times(g, draw(ring, 20, VARIABLES));
        common = multinomial_gcd(p, q);
        EXPECT(multinomial_terms(common) > 1 && multinomial_quotient(common, g) != NULL);
    }
    EXPECT(ring_status(ring) == OK);
    ring_free(ring);
}

/* --- leaving in the middle --- */

static bool asks_no_more(void *context)
{
    int *left = context;

    return (*left)-- == 0;
}

/* terms of a factor, found in a call that is left when it asks the n-th time; -1: it was left */
static int terms_found(int n, uint64_t seed)
{
    Multinomial *g, *p, *q, *common;
    Ring *ring;
    int left, terms;

    TRANSACTION(-1);
    left = n;
    transaction_ask(asks_no_more, &left);
    state = seed;
    ring = ring_new(VARIABLES, 20000, NULL);
    g = draw(ring, 20, 4);
    p = multinomial_times(multinomial_times(g, draw(ring, 20, 4)), g);
    q = multinomial_times(g, draw(ring, 20, 4));
    common = multinomial_gcd(p, q);
    terms = ring_status(ring) == OK ? multinomial_terms(common) : 0;
    ring_free(ring);
    return terms;
}

static void a_call_that_is_left_does_no_harm(void)
{
    const int terms = terms_found(INT_MAX, 1);
    fmpz_t own, copy; /* as the embedding program has */
    int left = 0;

    fmpz_init(own);
    fmpz_init(copy);
    fmpz_set_ui(own, 3);
    fmpz_pow_ui(own, own, 1000);
    fmpz_set(copy, own);
    EXPECT(terms > 1);
    for (int n = 0; terms_found(n, 1) < 0; n++) {
        EXPECT(terms_found(INT_MAX, 1) == terms);
        fmpz_mul_ui(own, own, 7);
        left++;
    }
    EXPECT(left > 5);
    for (int i = 0; i < left; i++)
        fmpz_divexact_ui(own, own, 7);
    EXPECT(fmpz_equal(own, copy));
    fmpz_clear(own);
    fmpz_clear(copy);
    flint_cleanup();
}

int main(void)
{
    Diag diag;

    if (flint_load(&diag) != OK)
        printf("%s\n", diag.message);
    RUN(sums_and_products_have_the_values_of_numbers);
    RUN(quotients_take_products_apart);
    RUN(common_factors_are_found);
    RUN(factors_multiply_to_the_whole);
    RUN(squares_and_products_are_seen);
    RUN(what_is_beyond_the_bound_is_remembered);
    RUN(powers_have_no_bound);
    RUN(long_products_are_formed_in_pieces);
    RUN(a_factor_of_long_polynomials_is_found);
    RUN(a_call_that_is_left_does_no_harm);
    return test_end();
}
