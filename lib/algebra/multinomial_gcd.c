/* multinomial_gcd.c: greatest common divisor of polynomials in several variables
 *
 * Images modulo a prime, in one variable each, bound the degrees of the greatest common divisor
 * from above. If it is free of a variable, it divides the coefficients of that variable's powers;
 * if it is free of all, it is an integer. The rest is Euclid's algorithm in the variable of the
 * least degree, with primitive remainders (Knuth, The Art of Computer Programming 2, 4.6.1). */
#include "algebra/multinomial_impl.h"

#include <string.h>

enum { PRIME = 2147483629 }; /* below 2^31: products fit into 64 bits */

/* --- images --- */

static uint32_t times(uint32_t a, uint32_t b)
{
    return (uint32_t)((uint64_t)a * b % PRIME);
}

static uint32_t inverse(uint32_t a)
{
    uint32_t out = 1;

    for (uint32_t n = PRIME - 2; n > 0; n >>= 1) {
        out = (n & 1) != 0 ? times(out, a) : out;
        a = times(a, a);
    }
    return out;
}

/* powers of a value for each variable, and of its inverse; the same for all of a ring */
static void choose_values(Ring *ring)
{
    const size_t count = (size_t)ring->variables * (RING_DEGREE + 1);
    uint64_t seed = 88172645463325252ULL;

    if (ring->value != NULL)
        return;
    ring->value = NEW_ARRAY(uint32_t, count);
    ring->inverse = NEW_ARRAY(uint32_t, count);
    for (int v = 0; v < ring->variables; v++) {
        uint32_t *value = ring->value + (ptrdiff_t)v * (RING_DEGREE + 1);
        uint32_t *under = ring->inverse + (ptrdiff_t)v * (RING_DEGREE + 1);

        /* xorshift (Marsaglia 2003) */
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        value[0] = under[0] = 1;
        value[1] = (uint32_t)(seed % (PRIME - 2)) + 2;
        under[1] = inverse(value[1]);
        for (int n = 2; n <= RING_DEGREE; n++) {
            value[n] = times(value[n - 1], value[1]);
            under[n] = times(under[n - 1], under[1]);
        }
    }
}

/* each term of p where all variables have their values */
static uint32_t *term_images(const Multinomial *p)
{
    const Ring *ring = p->ring;
    uint32_t *image = NEW_ARRAY(uint32_t, p->count);

    for (int i = 0; i < p->count; i++) {
        image[i] = (uint32_t)mpz_fdiv_ui(p->at[i], PRIME);
        for (int v = 0; v < ring->variables; v++)
            if (multinomial_power(p, i, v) > 0)
                image[i] = times(
                    image[i],
                    ring->value[(ptrdiff_t)v * (RING_DEGREE + 1) + multinomial_power(p, i, v)]);
    }
    return image;
}

/* p in one variable, the others having their values; its degree, -1: it is 0 */
static int image_in(const Multinomial *p, const uint32_t *terms, int variable, uint32_t *out)
{
    int degree = RING_DEGREE;

    memset(out, 0, (RING_DEGREE + 1) * sizeof *out);
    for (int i = 0; i < p->count; i++) {
        const int n = multinomial_power(p, i, variable);

        out[n] = (out[n] +
                  times(terms[i], p->ring->inverse[(ptrdiff_t)variable * (RING_DEGREE + 1) + n])) %
                 PRIME;
    }
    while (degree >= 0 && out[degree] == 0)
        degree--;
    return degree;
}

/* degree of the greatest common divisor of two images; both are changed */
static int common_degree(uint32_t *a, int m, uint32_t *b, int n)
{
    while (n >= 0) {
        const uint32_t under = inverse(b[n]);
        uint32_t *other = a;
        int old = m;

        for (; m >= n; m--) {
            const uint32_t by = times(a[m], under);

            for (int k = 0; by != 0 && k <= n; k++)
                a[m - n + k] = (a[m - n + k] + PRIME - times(by, b[k])) % PRIME;
        }
        for (old = n - 1; old >= 0 && a[old] == 0;)
            old--;
        a = b;
        b = other;
        m = n;
        n = old;
    }
    return m;
}

/* By variable: an upper bound of the degree of the greatest common divisor. An image of full degree
 * preserves the degree of its divisor. */
static void bound_degrees(const Multinomial *p, const Multinomial *q, int *bound)
{
    const Ring *ring = p->ring;
    uint32_t *of_p = term_images(p), *of_q = term_images(q);
    uint32_t a[RING_DEGREE + 1], b[RING_DEGREE + 1];

    for (int v = 0; v < ring->variables; v++) {
        const int dp = multinomial_degree(p, v), dq = multinomial_degree(q, v);
        int m, n;

        bound[v] = dp < dq ? dp : dq;
        if (bound[v] == 0)
            continue;
        m = image_in(p, of_p, v, a);
        n = image_in(q, of_q, v, b);
        if (m >= 0 && n >= 0 && (m == dp || n == dq)) {
            const int common = m >= n ? common_degree(a, m, b, n) : common_degree(b, n, a, m);

            bound[v] = common < bound[v] ? common : bound[v];
        }
    }
    MEM_FREE(of_p, of_q);
}

/* --- primitive parts --- */

/* the greatest integer that divides p, and the sign of its first term */
static void integer_content(const Multinomial *p, mpz_t out)
{
    mpz_set_si(out, 0);
    for (int i = 0; i < p->count && mpz_cmp_si(out, 1) != 0; i++)
        mpz_gcd(out, out, p->at[i]);
    if (multinomial_is_negative(p))
        mpz_neg(out, out);
}

/* the product of variables that divides p, times the integer */
static Multinomial *simple_content(const Multinomial *p)
{
    Ring *ring = p->ring;
    Multinomial *out;

    integer_content(p, ring->scratch);
    out = multinomial_integer(ring, ring->scratch);
    for (int v = 0; v < ring->variables && out->count > 0; v++) {
        int least = RING_DEGREE;

        for (int i = 0; i < p->count && least > 0; i++)
            least = multinomial_power(p, i, v) < least ? multinomial_power(p, i, v) : least;
        out->power[v / WORD_BYTES] += byte_at(v, least);
    }
    return out;
}

/* p over a divisor; p is freed */
static Multinomial *divided(Multinomial *p, Multinomial *by)
{
    Multinomial *out = multinomial_is(by, 1) ? p : multinomial_exact(p, by);

    if (out != p)
        multinomial_free(p);
    multinomial_free(by);
    return out;
}

static Multinomial *primitive(Multinomial *p)
{
    return p->count > 0 ? divided(p, simple_content(p)) : p;
}

/* of all in the list, which is freed */
static Multinomial *list_gcd(MultinomialList *list)
{
    Multinomial *out = NULL;
    int least = 0;

    for (int i = 1; i < list->count; i++)
        least = list->at[i]->count < list->at[least]->count ? i : least;
    if (list->count > 0) {
        out = list->at[least];
        list->at[least] = list->at[--list->count];
    }
    for (int i = 0; out != NULL && i < list->count && !multinomial_is(out, 1); i++) {
        Multinomial *next = multinomial_gcd(out, list->at[i]);

        multinomial_free(out);
        out = next;
    }
    multinomials_free(list);
    return out;
}

/* of the coefficients of powers of some variables */
static Multinomial *content_over(const Multinomial *p, const Multinomial *q, uint64_t variables)
{
    MultinomialList list = {0};
    Multinomial *out;

    multinomial_coefficients(p, variables, &list);
    if (q != NULL) {
        MultinomialList more = {0};

        multinomial_coefficients(q, variables, &more);
        for (int i = 0; i < more.count; i++)
            LIST_PUSH(list, more.at[i]);
        LIST_FREE(more);
    }
    out = list_gcd(&list);
    return out != NULL ? out : multinomial_small(p->ring, 1);
}

static Multinomial *primitive_in(Multinomial *p, int variable)
{
    return p->count > 0 ? divided(p, content_over(p, NULL, 1ULL << variable)) : p;
}

/* --- after Euclid --- */

/* pseudo-remainder: b's leading coefficient, as often as needed, times a, less a multiple of b */
static Multinomial *pseudo_remainder(Multinomial *a, const Multinomial *b, int variable)
{
    Ring *ring = a->ring;
    const int degree = multinomial_degree(b, variable);
    Multinomial *lead = multinomial_coefficient(b, variable, degree);

    while (a->count > 0 && ring->status == OK && multinomial_degree(a, variable) >= degree) {
        const int high = multinomial_degree(a, variable);
        Multinomial *first = multinomial_coefficient(a, variable, high);
        Multinomial *kept = multinomial_times(a, lead), *taken;

        for (int k = 0; first->count > 0 && k < first->count; k++)
            first->power[(ptrdiff_t)k * ring->words + variable / WORD_BYTES] +=
                byte_at(variable, high - degree);
        taken = multinomial_times(first, b);
        multinomial_free(a);
        a = multinomial_sum(kept, taken, -1);
        multinomial_free(first);
        multinomial_free(kept);
        multinomial_free(taken);
    }
    multinomial_free(lead);
    return a;
}

static Multinomial *copy_of(const Multinomial *p)
{
    mpz_set_si(p->ring->scratch, 1);
    return multinomial_over(p, p->ring->scratch);
}

static Multinomial *euclid(const Multinomial *p, const Multinomial *q, int variable)
{
    Ring *ring = p->ring;
    Multinomial *common = content_over(p, q, 1ULL << variable);
    Multinomial *a = primitive_in(copy_of(p), variable), *b = primitive_in(copy_of(q), variable);
    Multinomial *out;

    if (multinomial_degree(a, variable) < multinomial_degree(b, variable)) {
        out = a;
        a = b;
        b = out;
    }
    while (ring->status == OK && b->count > 0 && multinomial_degree(b, variable) > 0) {
        Multinomial *rest = primitive_in(primitive(pseudo_remainder(a, b, variable)), variable);

        a = b;
        b = rest;
    }
    /* the remainder is 0, or free of the variable: then only the contents have a common divisor */
    if (b->count > 0) {
        multinomial_free(a);
        a = multinomial_small(ring, 1);
    }
    out = multinomial_times(common, a);
    multinomial_free(common);
    multinomial_free(a);
    multinomial_free(b);
    return out;
}

/* the divisor itself, where it is the greatest that there can be; else NULL */
static Multinomial *whole_divisor(const Multinomial *p, const Multinomial *q, const int *bound)
{
    Multinomial *quotient;

    for (int v = 0; v < p->ring->variables; v++)
        if (bound[v] != multinomial_degree(p, v))
            return NULL;
    quotient = multinomial_quotient(q, p);
    if (quotient == NULL)
        return NULL;
    multinomial_free(quotient);
    return copy_of(p);
}

/* of two that no integer and no variable divides */
static Multinomial *core_gcd(const Multinomial *p, const Multinomial *q)
{
    Ring *ring = p->ring;
    int bound[RING_VARIABLES], best = -1;
    uint64_t alien = 0;
    Multinomial *out = NULL;

    if (ring->status == OK)
        ring->status = monitor_poll(ring->watch);
    if (ring->status != OK || multinomial_is_number(p) || multinomial_is_number(q))
        return multinomial_small(ring, 1);
    if (multinomial_equal(p, q))
        return copy_of(p);
    bound_degrees(p, q, bound);
    for (int v = 0; v < ring->variables; v++) {
        if (bound[v] == 0 && (multinomial_degree(p, v) > 0 || multinomial_degree(q, v) > 0))
            alien |= 1ULL << v;
        if (bound[v] > 0 && (best < 0 || bound[v] < bound[best]))
            best = v;
    }
    if (best < 0)
        return multinomial_small(ring, 1);
    if (alien != 0)
        return content_over(p, q, alien);
    out = whole_divisor(p, q, bound);
    out = out != NULL ? out : whole_divisor(q, p, bound);
    return out != NULL ? out : primitive(euclid(p, q, best));
}

static Multinomial *simple_gcd(const Multinomial *p, const Multinomial *q)
{
    Multinomial *out = simple_content(p);

    mpz_gcd(out->at[0], out->at[0], q->at[0]);
    for (int v = 0; v < p->ring->variables; v++) {
        const int a = multinomial_power(p, 0, v), b = multinomial_power(q, 0, v);

        out->power[v / WORD_BYTES] -= byte_at(v, a > b ? a - b : 0);
    }
    return out;
}

Multinomial *multinomial_gcd(const Multinomial *p, const Multinomial *q)
{
    Ring *ring = p->ring;
    Multinomial *a, *b, *of_a, *of_b, *simple, *core, *out;

    if (p->count == 0 || q->count == 0 || ring->status != OK) {
        const Multinomial *other = p->count == 0 ? q : p;

        mpz_set_si(ring->scratch, multinomial_is_negative(other) ? -1 : 1);
        return multinomial_scaled(other, ring->scratch);
    }
    choose_values(ring);
    of_a = simple_content(p);
    of_b = simple_content(q);
    if (ring->status != OK) {
        multinomial_free(of_a);
        return of_b;
    }
    a = multinomial_exact(p, of_a);
    b = multinomial_exact(q, of_b);
    simple = simple_gcd(of_a, of_b);
    core = core_gcd(a, b);
    out = multinomial_times(core, simple);
    multinomial_free(a);
    multinomial_free(b);
    multinomial_free(of_a);
    multinomial_free(of_b);
    multinomial_free(simple);
    multinomial_free(core);
    return out;
}

/* --- factors --- */

/* What divides p, and isn't it: of the coefficients by a variable, or of p and its slope; NULL */
static Multinomial *part_of(const Multinomial *p)
{
    for (int v = 0; v < p->ring->variables; v++) {
        const int degree = multinomial_degree(p, v);
        Multinomial *part;

        if (degree == 0)
            continue;
        part = content_over(p, NULL, 1ULL << v);
        if (multinomial_is_number(part) && degree > 1) {
            Multinomial *slope = multinomial_slope(p, v);

            multinomial_free(part);
            part = multinomial_gcd(p, slope);
            multinomial_free(slope);
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
    Multinomial *simple;

    if (p->count == 0) {
        LIST_PUSH(*out, copy_of(p));
        return;
    }
    choose_values(ring);
    simple = simple_content(p);
    if (simple->count > 0 && mpz_cmp_si(simple->at[0], 1) != 0)
        LIST_PUSH(*out, multinomial_integer(ring, simple->at[0]));
    for (int v = 0; simple->count > 0 && v < ring->variables; v++)
        for (int n = multinomial_power(simple, 0, v); n > 0; n--)
            LIST_PUSH(*out, multinomial_variable(ring, v));
    split_core(divided(copy_of(p), simple), out);
}
