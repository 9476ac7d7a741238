/* markov_parameters.c: c A^k b of doubles, computed exactly */
#include "algebra/markov_parameters.h"

#include "algebra/double_double.h"
#include "base/memory.h"

#include <float.h>
#include <limits.h>
#include <stdint.h>

enum {
    MOST_PRIMES = 2048,
    LARGEST = INT_MAX, /* the first prime, 2^31 - 1: products fit into 64 bits */
    PRIME_BITS = 30,   /* least number of bits of each prime */
    DIGITS = 53
};

/* x = whole 2^at, whole being odd or 0 */
typedef struct Whole {
    int64_t whole;
    int at;
} Whole;

struct MarkovParameters {
    int n, primes, power; /* v is A^power b */
    Whole *a, *b, *c;
    int a_at, b_at, c_at; /* their least powers of 2 */
    uint32_t *prime;
    uint32_t *left; /* n x n: A modulo one prime */
    uint32_t *v;    /* primes x n: A^power b */
    uint32_t *next; /* n */
    uint32_t *rest; /* primes: of the sum */
    int32_t *digit; /* primes: of the sum, to the bases of the primes */
};

/* --- arithmetic modulo p --- */

static uint32_t times(uint32_t a, uint32_t b, uint32_t p)
{
    return (uint32_t)((uint64_t)a * b % p);
}

static uint32_t plus(uint32_t a, uint32_t b, uint32_t p)
{
    return (uint32_t)(((uint64_t)a + b) % p);
}

static uint32_t power(uint32_t a, uint32_t exponent, uint32_t p)
{
    uint32_t out = 1;

    for (; exponent > 0; exponent >>= 1) {
        out = (exponent & 1) != 0 ? times(out, a, p) : out;
        a = times(a, a, p);
    }
    return out;
}

static uint32_t rest_of(int64_t whole, uint32_t p)
{
    const int64_t rest = whole % (int64_t)p;

    return (uint32_t)(rest < 0 ? rest + (int64_t)p : rest);
}

/* of x in units of 2^least */
static uint32_t rest_of_whole(Whole x, int least, uint32_t p)
{
    return x.whole == 0 ? 0 : times(rest_of(x.whole, p), power(2, (uint32_t)(x.at - least), p), p);
}

static bool is_prime(uint32_t p)
{
    for (uint32_t k = 2; k * k <= p && k < 1U << 16; k++)
        if (p % k == 0)
            return false;
    return true;
}

/* the largest below 2^31 */
static void find_primes(uint32_t *prime, int count)
{
    uint32_t p = LARGEST;

    for (int i = 0; i < count; p--)
        if (is_prime(p))
            prime[i++] = p;
}

/* --- doubles as whole numbers --- */

static Whole whole_of(double x)
{
    Whole out = {0, 0};

    if (x == 0)
        return out;
    out.whole = (int64_t)ldexp(frexp(x, &out.at), DIGITS);
    out.at -= DIGITS;
    for (; out.whole % 2 == 0; out.whole /= 2)
        out.at++;
    return out;
}

/* the least power of 2 of them; `out` new */
static int wholes_of(const double *x, int count, Whole **out)
{
    int least = INT_MAX;

    *out = NEW_ARRAY(Whole, count);
    for (int i = 0; i < count; i++) {
        (*out)[i] = whole_of(x[i]);
        least = x[i] != 0 && (*out)[i].at < least ? (*out)[i].at : least;
    }
    return least < INT_MAX ? least : 0;
}

/* of a product, from above */
static double size_of(double a, double b)
{
    return a != 0 && b != 0 ? fmax(fabs(a * b), DBL_MIN) : 0;
}

/* bits of the sums at most, sign included: of |c| |A|^k |b| in units of the least powers of 2 */
static double most_bits(const MarkovParameters *r, const double *a, const double *b,
                        const double *c, int count)
{
    const int n = r->n;
    double *v = NEW_ARRAY(double, n), *next = NEW_ARRAY(double, n), most = 0;
    int at = -r->b_at - r->c_at; /* v is times 2^at */

    for (int i = 0; i < n; i++)
        v[i] = fabs(b[i]);
    for (int k = 0; k < count; k++) {
        double sum = 0, largest = 0;

        for (int i = 0; i < n; i++) {
            sum += size_of(c[i], v[i]);
            next[i] = 0;
            for (int j = 0; j < n; j++)
                next[i] += size_of(a[i * n + j], v[j]);
            largest = fmax(largest, next[i]);
        }
        if (!isfinite(largest) || !isfinite(sum))
            most = INFINITY;
        else if (sum > 0)
            most = fmax(most, ilogb(sum) + 1.0 + at);
        if (largest == 0 || most == INFINITY)
            break;
        for (int i = 0; i < n; i++)
            v[i] = size_of(next[i], ldexp(1, -ilogb(largest)));
        at += ilogb(largest) - r->a_at;
    }
    MEM_FREE(v, next);
    return most + 3; /* rounding here, and the sign */
}

MarkovParameters *markov_parameters_new(const double *a, const double *b, const double *c, int n,
                                        int count)
{
    MarkovParameters *r = NEW(MarkovParameters);
    double bits;

    r->n = n;
    r->a_at = wholes_of(a, n * n, &r->a);
    r->b_at = wholes_of(b, n, &r->b);
    r->c_at = wholes_of(c, n, &r->c);
    bits = most_bits(r, a, b, c, count);
    if (!(bits <= (double)PRIME_BITS * MOST_PRIMES)) {
        markov_parameters_free(r);
        return NULL;
    }
    r->primes = 1 + (int)bits / PRIME_BITS;
    r->prime = NEW_ARRAY(uint32_t, r->primes);
    r->left = NEW_ARRAY(uint32_t, n * n);
    r->v = NEW_ARRAY(uint32_t, r->primes * n);
    r->next = NEW_ARRAY(uint32_t, n);
    r->rest = NEW_ARRAY(uint32_t, r->primes);
    r->digit = NEW_ARRAY(int32_t, r->primes);
    find_primes(r->prime, r->primes);
    for (int k = 0; k < r->primes; k++)
        for (int i = 0; i < n; i++)
            r->v[k * n + i] = rest_of_whole(r->b[i], r->b_at, r->prime[k]);
    return r;
}

void markov_parameters_free(MarkovParameters *r)
{
    if (r == NULL)
        return;
    MEM_FREE(r->a, r->b, r->c, r->prime, r->left, r->v, r->next, r->rest, r->digit, r);
}

/* --- the sums --- */

/* v := A^steps v modulo one prime */
static void step(const MarkovParameters *r, int steps, uint32_t p, uint32_t *v)
{
    const int n = r->n;

    for (int i = 0; i < n * n; i++)
        r->left[i] = rest_of_whole(r->a[i], r->a_at, p);
    for (int s = 0; s < steps; s++) {
        for (int i = 0; i < n; i++) {
            uint32_t sum = 0;

            for (int j = 0; j < n; j++)
                if (r->left[i * n + j] != 0 && v[j] != 0)
                    sum = plus(sum, times(r->left[i * n + j], v[j], p), p);
            r->next[i] = sum;
        }
        for (int i = 0; i < n; i++)
            v[i] = r->next[i];
    }
}

/* Write the digits d of the sum d_0 + p_0 (d_1 + p_1 (d_2 ...)), -p/2 < d < p/2, from the
 * remainders; how many there are. */
static int find_digits(const MarkovParameters *r)
{
    int count = 0;

    for (int k = 0; k < r->primes; k++) {
        const uint32_t p = r->prime[k];
        uint32_t known = 0, base = 1, digit;

        for (int i = k - 1; i >= 0; i--)
            known = plus(times(known, r->prime[i] % p, p), rest_of(r->digit[i], p), p);
        for (int i = 0; i < k; i++)
            base = times(base, r->prime[i] % p, p);
        digit = times(plus(r->rest[k], p - known, p), power(base, p - 2, p), p);
        r->digit[k] = (int32_t)((int64_t)digit - (digit > p / 2 ? (int64_t)p : 0));
        count = digit != 0 ? k + 1 : count;
    }
    return count;
}

double markov_parameters_value(MarkovParameters *r, int k, int *exponent)
{
    const int n = r->n, steps = k - r->power;
    DoubleDouble sum = dd_of(0);
    int count, at = r->b_at + r->c_at + k * r->a_at;

    for (int i = 0; i < r->primes; i++) {
        const uint32_t p = r->prime[i];
        uint32_t *v = r->v + (ptrdiff_t)i * n;

        if (steps > 0)
            step(r, steps, p, v);
        r->rest[i] = 0;
        for (int j = 0; j < n; j++)
            r->rest[i] = plus(r->rest[i], times(rest_of_whole(r->c[j], r->c_at, p), v[j], p), p);
    }
    r->power = k;
    count = find_digits(r);
    for (int i = 0; i < count; i++)
        sum = dd_add(dd_of(r->digit[i]), i > 0 ? dd_div(sum, dd_of(r->prime[i - 1])) : dd_of(0));
    for (int i = 0; i + 1 < count; i++) {
        sum = dd_times(sum, ldexp(r->prime[i], -PRIME_BITS));
        at += PRIME_BITS;
        if (fabs(sum.high) > 1) {
            sum = dd_times(sum, 0x1p-1);
            at++;
        }
    }
    *exponent = at;
    return dd_double(sum);
}
