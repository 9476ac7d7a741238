/* multinomial.c: FLINT's polynomials, bounded, and freed with their ring */
#include "algebra/multinomial.h"

#include "base/exact_memory.h"
#include "base/flint_library.h"

#include <string.h>

enum { MOST_PAIRS = 1000000 }; /* of terms that are multiplied at once */

struct Multinomial {
    Ring *ring;
    Multinomial *before, *after; /* all of a ring */
    fmpz_mpoly_t at;
};

struct Ring {
    fmpz_mpoly_ctx_t context;
    int variables, most;
    const CallMonitor *watch;
    Status status;
    Multinomial all;     /* head of the ring of all */
    mpz_t scratch;       /* of multinomial_factor() */
    ExactMemory numbers; /* FLINT's */
};

/* --- the ring --- */

Ring *ring_new(int variables, int most, const CallMonitor *watch)
{
    Ring *ring = NEW(Ring);

    exact_open(&ring->numbers);
    ring->variables = variables;
    ring->most = most;
    ring->watch = watch;
    ring->all.before = ring->all.after = &ring->all;
    flint.fmpz_mpoly_ctx_init(ring->context, variables, ORD_LEX);
    mpz_init(ring->scratch);
    return ring;
}

void ring_free(Ring *ring)
{
    if (ring == NULL)
        return;
    while (ring->all.after != &ring->all)
        multinomial_free(ring->all.after);
    mpz_clear(ring->scratch);
    flint.fmpz_mpoly_ctx_clear(ring->context);
    exact_close(&ring->numbers);
    mem_free(ring);
}

Status ring_status(const Ring *ring)
{
    return ring->status;
}

static Multinomial *zero(Ring *ring)
{
    Multinomial *p = NEW(Multinomial);

    flint.fmpz_mpoly_init(p->at, ring->context);
    p->ring = ring;
    p->before = &ring->all;
    p->after = ring->all.after;
    p->before->after = p->after->before = p;
    return p;
}

void multinomial_free(Multinomial *p)
{
    if (p == NULL)
        return;
    flint.fmpz_mpoly_clear(p->at, p->ring->context);
    p->before->after = p->after;
    p->after->before = p->before;
    mem_free(p);
}

void multinomials_free(MultinomialList *list)
{
    for (int i = 0; i < list->count; i++)
        multinomial_free(list->at[i]);
    LIST_FREE(*list);
}

/* whether the next operation is to be done at all */
static bool is_going(Ring *ring)
{
    if (ring->status == OK)
        ring->status = monitor_poll(ring->watch);
    return ring->status == OK;
}

/* p as a result; without meaning if there is none, or a longer one than the bound */
static Multinomial *result(Multinomial *p, bool exists)
{
    Ring *ring = p->ring;

    if (ring->status == OK && (!exists || multinomial_terms(p) > ring->most))
        ring->status = E_MEMORY;
    if (ring->status != OK)
        flint.fmpz_mpoly_set_si(p->at, 0, ring->context);
    return p;
}

/* --- making and looking --- */

Multinomial *multinomial_integer(Ring *ring, const mpz_t value)
{
    Multinomial *p = zero(ring);
    fmpz_t number;

    fmpz_init(number);
    flint.fmpz_set_mpz(number, value);
    flint.fmpz_mpoly_set_fmpz(p->at, number, ring->context);
    flint.fmpz_clear(number);
    return result(p, true);
}

Multinomial *multinomial_small(Ring *ring, long value)
{
    Multinomial *p = zero(ring);

    flint.fmpz_mpoly_set_si(p->at, value, ring->context);
    return result(p, true);
}

Multinomial *multinomial_variable(Ring *ring, int variable)
{
    Multinomial *p = zero(ring);

    flint.fmpz_mpoly_gen(p->at, variable, ring->context);
    return result(p, true);
}

static Multinomial *copy_of(const Multinomial *p)
{
    Multinomial *out = zero(p->ring);

    flint.fmpz_mpoly_set(out->at, p->at, p->ring->context);
    return out;
}

bool multinomial_failed(const Multinomial *p)
{
    return p->ring->status != OK;
}

bool multinomial_is_zero(const Multinomial *p)
{
    return multinomial_terms(p) == 0;
}

bool multinomial_is_number(const Multinomial *p)
{
    return flint.fmpz_mpoly_is_fmpz(p->at, p->ring->context) != 0;
}

bool multinomial_is(const Multinomial *p, long value)
{
    return flint.fmpz_mpoly_equal_si(p->at, value, p->ring->context) != 0;
}

int multinomial_terms(const Multinomial *p)
{
    const slong count = fmpz_mpoly_length(p->at, p->ring->context);

    return count < INT_MAX ? (int)count : INT_MAX;
}

const mpz_t *multinomial_factor(const Multinomial *p, int term)
{
    flint.fmpz_get_mpz(p->ring->scratch, p->at->coeffs + term);
    return &p->ring->scratch;
}

int multinomial_power(const Multinomial *p, int term, int variable)
{
    return (int)flint.fmpz_mpoly_get_term_var_exp_ui(p->at, term, variable, p->ring->context);
}

int multinomial_degree(const Multinomial *p, int variable)
{
    const slong degree = flint.mpoly_degree_si(p->at->exps, p->at->length, p->at->bits, variable,
                                               p->ring->context->minfo);

    return degree > 0 ? (int)degree : 0; /* FLINT: -1 of zero */
}

bool multinomial_is_negative(const Multinomial *p)
{
    return !multinomial_is_zero(p) && flint.fmpz_sgn(p->at->coeffs) < 0;
}

/* --- arithmetic --- */

Multinomial *multinomial_sum(const Multinomial *p, const Multinomial *q, int sign)
{
    Ring *ring = p->ring;
    Multinomial *sum = zero(ring);

    if (is_going(ring) && sign > 0)
        flint.fmpz_mpoly_add(sum->at, p->at, q->at, ring->context);
    else if (ring->status == OK)
        flint.fmpz_mpoly_sub(sum->at, p->at, q->at, ring->context);
    return result(sum, true);
}

/* sum += terms first, first + 1 ... of p, so many of them, times q */
static void add_product(Multinomial *sum, const Multinomial *p, int first, int count,
                        const Multinomial *q)
{
    Ring *ring = sum->ring;
    Multinomial *some = zero(ring), *term = zero(ring);

    for (int i = first; i < first + count && i < multinomial_terms(p); i++) {
        flint.fmpz_mpoly_get_term(term->at, p->at, i, ring->context);
        flint.fmpz_mpoly_add(some->at, some->at, term->at, ring->context);
    }
    flint.fmpz_mpoly_mul(some->at, some->at, q->at, ring->context);
    flint.fmpz_mpoly_add(sum->at, sum->at, some->at, ring->context);
    multinomial_free(some);
    multinomial_free(term);
}

Multinomial *multinomial_times(const Multinomial *p, const Multinomial *q)
{
    Ring *ring = p->ring;
    Multinomial *out = zero(ring);
    const int of_p = multinomial_terms(p), of_q = multinomial_terms(q);

    if (of_p > of_q)
        return multinomial_times(q, p);
    if (of_p <= 1 || of_p <= MOST_PAIRS / of_q) {
        if (is_going(ring))
            flint.fmpz_mpoly_mul(out->at, p->at, q->at, ring->context);
        return result(out, true);
    }
    /* FLINT has no bound: a piece at a time, so that no sum is far beyond the ring's */
    for (int i = 0, each = 1 + MOST_PAIRS / of_q; i < of_p && is_going(ring); i += each) {
        add_product(out, p, i, each, q);
        if (multinomial_terms(out) / 4 > ring->most)
            ring->status = E_MEMORY;
    }
    return result(out, true);
}

Multinomial *multinomial_quotient(const Multinomial *p, const Multinomial *q)
{
    Ring *ring = p->ring;
    Multinomial *out = zero(ring);

    if (!is_going(ring) || flint.fmpz_mpoly_divides(out->at, p->at, q->at, ring->context) != 0)
        return result(out, true);
    multinomial_free(out);
    return NULL;
}

Multinomial *multinomial_exact(const Multinomial *p, const Multinomial *q)
{
    Multinomial *quotient = multinomial_quotient(p, q);

    return quotient != NULL ? quotient : zero(p->ring);
}

Multinomial *multinomial_coefficient(const Multinomial *p, int variable, int power)
{
    Multinomial *out = zero(p->ring);
    const slong of = variable;
    const ulong n = (ulong)power;

    flint.fmpz_mpoly_get_coeff_vars_ui(out->at, p->at, &of, &n, 1, p->ring->context);
    return result(out, true);
}

/* --- factors --- */

Multinomial *multinomial_gcd(const Multinomial *p, const Multinomial *q)
{
    Ring *ring = p->ring;
    Multinomial *out = zero(ring);

    return result(out, !is_going(ring) ||
                           flint.fmpz_mpoly_gcd(out->at, p->at, q->at, ring->context) != 0);
}

/* p over a divisor; both are freed */
static Multinomial *divided(Multinomial *p, Multinomial *by)
{
    Multinomial *out = multinomial_exact(p, by);

    multinomial_free(p);
    multinomial_free(by);
    return out;
}

/* what divides the coefficients of all powers of a variable */
static Multinomial *content_in(const Multinomial *p, int variable)
{
    Ring *ring = p->ring;
    Multinomial *out = zero(ring);
    slong of = variable;

    return result(out, !is_going(ring) || flint.fmpz_mpoly_content_vars(out->at, p->at, &of, 1,
                                                                        ring->context) != 0);
}

/* what divides p and its slope by a variable */
static Multinomial *repeated_in(const Multinomial *p, int variable)
{
    Multinomial *slope = zero(p->ring), *out;

    flint.fmpz_mpoly_derivative(slope->at, p->at, variable, p->ring->context);
    out = multinomial_gcd(p, slope);
    multinomial_free(slope);
    return out;
}

/* What divides p, and isn't it: of the coefficients by a variable, or of p and its slope; NULL */
static Multinomial *part_of(const Multinomial *p)
{
    for (int v = 0; v < p->ring->variables; v++) {
        const int degree = multinomial_degree(p, v);
        Multinomial *part;

        if (degree == 0)
            continue;
        part = content_in(p, v);
        if (multinomial_is_number(part) && degree > 1) {
            multinomial_free(part);
            part = repeated_in(p, v);
        }
        if (!multinomial_is_number(part))
            return part;
        multinomial_free(part);
    }
    return NULL;
}

/* p is freed */
static void split_core(Multinomial *p, MultinomialList *out)
{
    Multinomial *part = p->ring->status == OK ? part_of(p) : NULL;

    if (part == NULL) {
        if (multinomial_is(p, 1))
            multinomial_free(p);
        else
            LIST_PUSH(*out, p);
        return;
    }
    split_core(divided(p, copy_of(part)), out);
    split_core(part, out);
}

void multinomial_split(const Multinomial *p, MultinomialList *out)
{
    Ring *ring = p->ring;
    Multinomial *simple = zero(ring); /* the integer and the variables */

    if (multinomial_is_zero(p)) {
        multinomial_free(simple);
        LIST_PUSH(*out, copy_of(p));
        return;
    }
    flint.fmpz_mpoly_term_content(simple->at, p->at, ring->context);
    if (multinomial_is_negative(p))
        flint.fmpz_mpoly_neg(simple->at, simple->at, ring->context);
    if (mpz_cmp_si(*multinomial_factor(simple, 0), 1) != 0)
        LIST_PUSH(*out, multinomial_integer(ring, ring->scratch));
    for (int v = 0; v < ring->variables; v++)
        for (int n = multinomial_power(simple, 0, v); n > 0; n--)
            LIST_PUSH(*out, multinomial_variable(ring, v));
    split_core(divided(copy_of(p), simple), out);
}
