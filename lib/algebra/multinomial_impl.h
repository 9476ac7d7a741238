/* multinomial_impl.h: how terms are stored, for the files of multinomial*.c
 *
 * Exponents are packed into words, one byte each, variable 0 in the highest byte of the first word.
 * A product of terms adds the words, and words compare as terms do. */
#ifndef COTREE_ALGEBRA_MULTINOMIAL_IMPL_H
#define COTREE_ALGEBRA_MULTINOMIAL_IMPL_H

#include "algebra/multinomial.h"

enum { WORD_BYTES = 8 };

struct Multinomial {
    Ring *ring;
    Multinomial *before, *after; /* all of a ring */
    int count, room;
    mpz_t *at;       /* integers, none 0, the highest term first */
    uint64_t *power; /* ring->words each */
};

struct Ring {
    int variables, words, most;
    const CallMonitor *watch;
    Status status;
    Multinomial all;           /* head of the ring of all */
    Cleanup cleanup;           /* of the integers, which are GMP's */
    mpz_t scratch, term;       /* of callers, of functions of single terms */
    uint32_t *value, *inverse; /* by variable and power: where images are formed, modulo a prime */
};

static inline const uint64_t *term_power(const Multinomial *p, int term)
{
    return p->power + (ptrdiff_t)term * p->ring->words;
}

static inline int byte_of(const uint64_t *power, int variable)
{
    return (int)(power[variable / WORD_BYTES] >> (56 - 8 * (variable % WORD_BYTES)) & 0xff);
}

static inline uint64_t byte_at(int variable, int power)
{
    return (uint64_t)power << (56 - 8 * (variable % WORD_BYTES));
}

static inline int compare_powers(const uint64_t *a, const uint64_t *b, int words)
{
    for (int w = 0; w < words; w++)
        if (a[w] != b[w])
            return a[w] > b[w] ? 1 : -1;
    return 0;
}

#endif
