/* markov_parameters.c: c A^k b of doubles, computed exactly
 *
 * In integers of so many words that the sums fit, in two's complement. Entries of A^k b may be
 * larger: what they carry beyond the last word is a multiple of a power of 2 that exceeds the range
 * of the sums, and leaves no trace in these. */
#include "algebra/markov_parameters.h"

#include "base/memory.h"

#include <float.h>
#include <gmp.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>

enum {
    MOST_BITS = 61440, /* of a sum */
    WORD = 64,         /* bits of one */
    DIGITS = 53
};

/* x = whole 2^at, whole being odd or 0 */
typedef struct Whole {
    int64_t whole;
    int at;
} Whole;

struct MarkovParameters {
    int n, words, power; /* v is A^power b */
    Whole *a, *b, *c;
    int a_at, b_at, c_at; /* their least powers of 2 */
    mp_limb_t *v, *next;  /* n x words */
    mp_limb_t *sum;       /* words */
};

_Static_assert(GMP_NUMB_BITS == WORD, "GMP uses whole words");

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

/* --- sums --- */

/* sum += v x, in units of 2^least; modulo 2^(64 words) */
static void add_product(mp_limb_t *sum, const mp_limb_t *v, int words, Whole x, int least)
{
    const int by = x.whole != 0 ? x.at - least : 0, first = by / WORD, shift = by % WORD;
    const uint64_t size = (uint64_t)(x.whole < 0 ? -x.whole : x.whole);
    const mp_limb_t part[] = {size << shift, shift > 0 ? size >> (WORD - shift) : 0};

    for (int k = 0; k < COUNT(part); k++) {
        const mp_size_t left = words - first - k;

        if (part[k] == 0 || left <= 0)
            continue;
        if (x.whole > 0)
            (void)mpn_addmul_1(sum + first + k, v, left, part[k]);
        else
            (void)mpn_submul_1(sum + first + k, v, left, part[k]);
    }
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
    if (!(bits <= MOST_BITS)) {
        markov_parameters_free(r);
        return NULL;
    }
    r->words = 1 + (int)bits / WORD;
    r->v = NEW_ARRAY(mp_limb_t, n * r->words);
    r->next = NEW_ARRAY(mp_limb_t, n * r->words);
    r->sum = NEW_ARRAY(mp_limb_t, r->words);
    r->sum[0] = 1;
    for (int i = 0; i < n; i++)
        add_product(r->v + (ptrdiff_t)i * r->words, r->sum, r->words, r->b[i], r->b_at);
    return r;
}

void markov_parameters_free(MarkovParameters *r)
{
    if (r == NULL)
        return;
    MEM_FREE(r->a, r->b, r->c, r->v, r->next, r->sum, r);
}

/* --- the parameters --- */

/* v := A v */
static void step(MarkovParameters *r)
{
    const int n = r->n;
    mp_limb_t *before = r->v;

    for (int i = 0; i < n; i++) {
        mp_limb_t *sum = r->next + (ptrdiff_t)i * r->words;

        mpn_zero(sum, r->words);
        for (int j = 0; j < n; j++)
            add_product(sum, before + (ptrdiff_t)j * r->words, r->words, r->a[i * n + j], r->a_at);
        transaction_worked((ptrdiff_t)n * r->words);
    }
    r->v = r->next;
    r->next = before;
    r->power++;
}

/* an integer as a double times 2^exponent */
static double rounded(mp_limb_t *sum, int words, int *exponent)
{
    const bool is_negative = sum[words - 1] >> (WORD - 1) != 0;
    int last = words - 1, shift = 0;
    uint64_t head;

    if (is_negative)
        (void)mpn_neg(sum, sum, words);
    while (last > 0 && sum[last] == 0)
        last--;
    for (head = sum[last]; head != 0 && head >> (WORD - 1) == 0; head <<= 1)
        shift++;
    if (shift > 0 && last > 0)
        head |= sum[last - 1] >> (WORD - shift);
    /* bits below decide where the head is halfway between doubles */
    if (last > 0 && mpn_scan1(sum, 0) < (mp_bitcnt_t)WORD * (mp_bitcnt_t)last - (mp_bitcnt_t)shift)
        head |= 1;
    *exponent += WORD * last - shift;
    return is_negative ? -(double)head : (double)head;
}

double markov_parameters_value(MarkovParameters *r, int k, int *exponent)
{
    while (r->power < k)
        step(r);
    mpn_zero(r->sum, r->words);
    for (int j = 0; j < r->n; j++)
        add_product(r->sum, r->v + (ptrdiff_t)j * r->words, r->words, r->c[j], r->c_at);
    *exponent = r->b_at + r->c_at + k * r->a_at;
    return rounded(r->sum, r->words, exponent);
}
