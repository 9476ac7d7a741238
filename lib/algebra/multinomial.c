/* multinomial.c: sums, products and quotients of polynomials in several variables
 *
 * Products and quotients merge rows p_i q by a heap of the highest remaining term of each row
 * (Johnson 1974; Monagan and Pearce 2007). */
#include "algebra/multinomial_impl.h"

#include <string.h>

#define GUARDS 0x8080808080808080ULL /* the highest bit of each power: RING_DEGREE is passed */

enum { POLL_TERMS = 4096 }; /* products between two looks at the watch */

/* --- the ring --- */

static void close_ring(void *object)
{
    Ring *ring = object;

    for (Multinomial *p = ring->all.after; p != &ring->all; p = p->after)
        for (int i = 0; i < p->count; i++)
            mpz_clear(p->at[i]);
    mpz_clears(ring->scratch, ring->term, NULL);
    cleanup_close(&ring->cleanup);
}

Ring *ring_new(int variables, int most, const CallMonitor *watch)
{
    Ring *ring = NEW(Ring);

    ring->variables = variables;
    ring->words = variables > WORD_BYTES ? (variables + WORD_BYTES - 1) / WORD_BYTES : 1;
    ring->most = most;
    ring->watch = watch;
    ring->all.before = ring->all.after = &ring->all;
    mpz_inits(ring->scratch, ring->term, NULL);
    cleanup_open(&ring->cleanup, close_ring, ring);
    if (variables > RING_VARIABLES)
        ring->status = E_MEMORY;
    return ring;
}

void ring_free(Ring *ring)
{
    if (ring == NULL)
        return;
    close_ring(ring);
    for (Multinomial *p = ring->all.after, *next; p != &ring->all; p = next) {
        next = p->after;
        MEM_FREE(p->at, p->power, p);
    }
    MEM_FREE(ring->value, ring->inverse, ring);
}

Status ring_status(const Ring *ring)
{
    return ring->status;
}

/* --- making and looking --- */

/* zero with room for so many terms, or the ring's failure and room for none */
static Multinomial *with_room(Ring *ring, int64_t room)
{
    Multinomial *p = NEW(Multinomial);

    if (room > ring->most && ring->status == OK)
        ring->status = E_MEMORY;
    if (ring->status != OK)
        room = 0;
    p->ring = ring;
    p->room = (int)room;
    p->at = NEW_ARRAY(mpz_t, room);
    p->power = NEW_ARRAY(uint64_t, room * ring->words);
    p->before = &ring->all;
    p->after = ring->all.after;
    p->before->after = p->after->before = p;
    return p;
}

void multinomial_free(Multinomial *p)
{
    if (p == NULL)
        return;
    for (int i = 0; i < p->count; i++)
        mpz_clear(p->at[i]);
    p->before->after = p->after;
    p->after->before = p->before;
    MEM_FREE(p->at, p->power, p);
}

void multinomials_free(MultinomialList *list)
{
    for (int i = 0; i < list->count; i++)
        multinomial_free(list->at[i]);
    LIST_FREE(*list);
}

/* append a term; there is room */
static void push(Multinomial *p, const mpz_t factor, const uint64_t *power)
{
    mpz_init_set(p->at[p->count], factor);
    memcpy(p->power + (ptrdiff_t)p->count * p->ring->words, power,
           (size_t)p->ring->words * sizeof *power);
    p->count++;
}

Multinomial *multinomial_integer(Ring *ring, const mpz_t value)
{
    static const uint64_t none[RING_VARIABLES / WORD_BYTES];
    Multinomial *p = with_room(ring, 1);

    if (ring->status == OK && mpz_sgn(value) != 0)
        push(p, value, none);
    return p;
}

Multinomial *multinomial_small(Ring *ring, long value)
{
    mpz_set_si(ring->scratch, value);
    return multinomial_integer(ring, ring->scratch);
}

Multinomial *multinomial_variable(Ring *ring, int variable)
{
    uint64_t power[RING_VARIABLES / WORD_BYTES] = {0};
    Multinomial *p = with_room(ring, 1);

    if (ring->status != OK)
        return p;
    power[variable / WORD_BYTES] = byte_at(variable, 1);
    mpz_set_si(ring->scratch, 1);
    push(p, ring->scratch, power);
    return p;
}

bool multinomial_failed(const Multinomial *p)
{
    return p->ring->status != OK;
}

bool multinomial_is_zero(const Multinomial *p)
{
    return p->count == 0;
}

bool multinomial_is_number(const Multinomial *p)
{
    for (int w = 0; w < p->ring->words && p->count > 0; w++)
        if (p->power[w] != 0)
            return false;
    return true; /* its first term is the highest */
}

bool multinomial_is(const Multinomial *p, long value)
{
    if (value == 0 || p->count == 0)
        return value == 0 && p->count == 0;
    return multinomial_is_number(p) && mpz_cmp_si(p->at[0], value) == 0;
}

bool multinomial_equal(const Multinomial *p, const Multinomial *q)
{
    if (p->count != q->count)
        return false;
    for (int i = 0; i < p->count; i++)
        if (compare_powers(term_power(p, i), term_power(q, i), p->ring->words) != 0 ||
            mpz_cmp(p->at[i], q->at[i]) != 0)
            return false;
    return true;
}

int multinomial_terms(const Multinomial *p)
{
    return p->count;
}

const mpz_t *multinomial_factor(const Multinomial *p, int term)
{
    return &p->at[term];
}

int multinomial_power(const Multinomial *p, int term, int variable)
{
    return byte_of(term_power(p, term), variable);
}

int multinomial_degree(const Multinomial *p, int variable)
{
    int degree = 0;

    for (int i = 0; i < p->count; i++) {
        const int power = multinomial_power(p, i, variable);

        degree = power > degree ? power : degree;
    }
    return degree;
}

bool multinomial_is_negative(const Multinomial *p)
{
    return p->count > 0 && mpz_sgn(p->at[0]) < 0;
}

/* --- sums --- */

Multinomial *multinomial_sum(const Multinomial *p, const Multinomial *q, int sign)
{
    Ring *ring = p->ring;
    Multinomial *sum = with_room(ring, (int64_t)p->count + q->count);

    for (int i = 0, j = 0; ring->status == OK && (i < p->count || j < q->count);) {
        const int order = i == p->count ? -1
                          : j == q->count
                              ? 1
                              : compare_powers(term_power(p, i), term_power(q, j), ring->words);

        mpz_set_si(ring->scratch, 0);
        if (order <= 0 && sign > 0)
            mpz_set(ring->scratch, q->at[j]);
        else if (order <= 0)
            mpz_neg(ring->scratch, q->at[j]);
        if (order >= 0)
            mpz_add(ring->scratch, ring->scratch, p->at[i]);
        if (mpz_sgn(ring->scratch) != 0)
            push(sum, ring->scratch, order >= 0 ? term_power(p, i) : term_power(q, j));
        i += order >= 0;
        j += order <= 0;
    }
    return sum;
}

Multinomial *multinomial_scaled(const Multinomial *p, const mpz_t factor)
{
    Ring *ring = p->ring;
    Multinomial *out = with_room(ring, p->count);

    for (int i = 0; ring->status == OK && mpz_sgn(factor) != 0 && i < p->count; i++) {
        mpz_mul(ring->term, p->at[i], factor);
        push(out, ring->term, term_power(p, i));
    }
    return out;
}

Multinomial *multinomial_over(const Multinomial *p, const mpz_t divisor)
{
    Ring *ring = p->ring;
    Multinomial *out = with_room(ring, p->count);

    for (int i = 0; ring->status == OK && i < p->count; i++) {
        mpz_divexact(ring->term, p->at[i], divisor);
        push(out, ring->term, term_power(p, i));
    }
    return out;
}

Multinomial *multinomial_slope(const Multinomial *p, int variable)
{
    Ring *ring = p->ring;
    Multinomial *out = with_room(ring, p->count);

    for (int i = 0; ring->status == OK && i < p->count; i++) {
        uint64_t power[RING_VARIABLES / WORD_BYTES];
        const int n = multinomial_power(p, i, variable);

        if (n == 0)
            continue;
        memcpy(power, term_power(p, i), (size_t)ring->words * sizeof *power);
        power[variable / WORD_BYTES] -= byte_at(variable, 1);
        mpz_mul_si(ring->term, p->at[i], n);
        push(out, ring->term, power);
    }
    return out;
}

/* --- products and quotients --- */

/* Rows a_i b, each with the place of its highest term left, in a heap by that term. */
typedef struct Merge {
    Ring *ring;
    const Multinomial *b;
    LIST(int) heap;     /* rows */
    LIST(int) place;    /* by row: in b */
    LIST(uint64_t) key; /* by row, words each */
} Merge;

static const uint64_t *row_key(const Merge *m, int row)
{
    return m->key.at + (ptrdiff_t)row * m->ring->words;
}

static void set_key(Merge *m, int row, const uint64_t *power)
{
    const uint64_t *other = term_power(m->b, m->place.at[row]);

    for (int w = 0; w < m->ring->words; w++) {
        uint64_t *key = m->key.at + (ptrdiff_t)row * m->ring->words + w;

        *key = power[w] + other[w];
        if ((*key & GUARDS) != 0 && m->ring->status == OK)
            m->ring->status = E_MEMORY;
    }
}

static void sift_down(Merge *m)
{
    int at = 0;

    for (;;) {
        int child = 2 * at + 1;
        const int row = m->heap.at[at];

        if (child >= m->heap.count)
            return;
        if (child + 1 < m->heap.count &&
            compare_powers(row_key(m, m->heap.at[child + 1]), row_key(m, m->heap.at[child]),
                           m->ring->words) > 0)
            child++;
        if (compare_powers(row_key(m, m->heap.at[child]), row_key(m, row), m->ring->words) <= 0)
            return;
        m->heap.at[at] = m->heap.at[child];
        m->heap.at[child] = row;
        at = child;
    }
}

/* add a row that starts at a term of b */
static void open_row(Merge *m, const uint64_t *power, int place)
{
    const int row = m->place.count;
    int at = m->heap.count;

    if (place >= m->b->count)
        return;
    LIST_PUSH(m->place, place);
    LIST_ROOM(m->key, m->ring->words);
    m->key.count += m->ring->words;
    set_key(m, row, power);
    LIST_PUSH(m->heap, row);
    for (; at > 0; at = (at - 1) / 2) {
        const int up = m->heap.at[(at - 1) / 2];

        if (compare_powers(row_key(m, up), row_key(m, row), m->ring->words) >= 0)
            break;
        m->heap.at[at] = up;
        m->heap.at[(at - 1) / 2] = row;
    }
}

/* advance the row on top to its next term, or remove it */
static void next_of_row(Merge *m, const uint64_t *power)
{
    const int row = m->heap.at[0];

    if (++m->place.at[row] < m->b->count)
        set_key(m, row, power);
    else
        m->heap.at[0] = m->heap.at[--m->heap.count];
    sift_down(m);
}

static void merge_free(Merge *m)
{
    LIST_FREE(m->heap);
    LIST_FREE(m->place);
    LIST_FREE(m->key);
}

/* append a term; their final count is unknown */
static void grow(Multinomial *p, const mpz_t factor, const uint64_t *power)
{
    Ring *ring = p->ring;

    if (p->count >= ring->most && ring->status == OK)
        ring->status = E_MEMORY;
    if (ring->status != OK)
        return;
    if (p->count == p->room) {
        const size_t room = 2 * (size_t)p->room + 4;

        p->at = mem_grow(p->at, room, sizeof *p->at);
        p->power = mem_grow(p->power, room * (size_t)ring->words, sizeof *p->power);
        p->room = (int)room;
    }
    push(p, factor, power);
}

Multinomial *multinomial_times(const Multinomial *p, const Multinomial *q)
{
    const Multinomial *a = p->count <= q->count ? p : q;
    Ring *ring = p->ring;
    Merge m = {.ring = ring, .b = a == p ? q : p};
    Multinomial *out = with_room(ring, 0);
    uint64_t power[RING_VARIABLES / WORD_BYTES];
    mpz_t *sum = &ring->scratch;

    for (int i = 0; i < a->count; i++)
        open_row(&m, term_power(a, i), 0);
    for (int k = 1; m.heap.count > 0 && ring->status == OK; k++) {
        memcpy(power, row_key(&m, m.heap.at[0]), (size_t)ring->words * sizeof *power);
        mpz_set_si(*sum, 0);
        while (m.heap.count > 0 &&
               compare_powers(row_key(&m, m.heap.at[0]), power, ring->words) == 0) {
            const int row = m.heap.at[0];

            mpz_addmul(*sum, a->at[row], m.b->at[m.place.at[row]]);
            next_of_row(&m, term_power(a, row));
        }
        if (mpz_sgn(*sum) != 0)
            grow(out, *sum, power);
        if (k % POLL_TERMS == 0 && ring->status == OK)
            ring->status = monitor_poll(ring->watch);
    }
    merge_free(&m);
    return out;
}

/* power -= of the divisor's first term; false: that doesn't divide it */
static bool divide_power(uint64_t *power, const Multinomial *q)
{
    for (int v = 0; v < q->ring->variables; v++)
        if (byte_of(power, v) < multinomial_power(q, 0, v))
            return false;
    for (int w = 0; w < q->ring->words; w++)
        power[w] -= q->power[w];
    return true;
}

Multinomial *multinomial_quotient(const Multinomial *p, const Multinomial *q)
{
    Ring *ring = p->ring;
    Merge m = {.ring = ring, .b = q};
    Multinomial *out = with_room(ring, 0);
    uint64_t power[RING_VARIABLES / WORD_BYTES];
    mpz_t *rest = &ring->scratch;
    bool divides = true;

    for (int k = 0; divides && ring->status == OK && (k < p->count || m.heap.count > 0);) {
        const int order =
            k == p->count ? -1
            : m.heap.count == 0
                ? 1
                : compare_powers(term_power(p, k), row_key(&m, m.heap.at[0]), ring->words);

        memcpy(power, order >= 0 ? term_power(p, k) : row_key(&m, m.heap.at[0]),
               (size_t)ring->words * sizeof *power);
        mpz_set_si(*rest, 0);
        if (order >= 0)
            mpz_set(*rest, p->at[k++]);
        while (m.heap.count > 0 &&
               compare_powers(row_key(&m, m.heap.at[0]), power, ring->words) == 0) {
            const int row = m.heap.at[0];

            mpz_submul(*rest, out->at[row], q->at[m.place.at[row]]);
            next_of_row(&m, term_power(out, row));
        }
        if (mpz_sgn(*rest) == 0)
            continue;
        divides = mpz_divisible_p(*rest, q->at[0]) != 0 && divide_power(power, q);
        if (!divides)
            break;
        mpz_divexact(*rest, *rest, q->at[0]);
        grow(out, *rest, power);
        if (ring->status == OK)
            open_row(&m, power, 1);
        if (out->count % POLL_TERMS == 0 && ring->status == OK)
            ring->status = monitor_poll(ring->watch);
    }
    merge_free(&m);
    if (divides)
        return out;
    multinomial_free(out);
    return NULL;
}

Multinomial *multinomial_exact(const Multinomial *p, const Multinomial *q)
{
    Multinomial *quotient = multinomial_quotient(p, q);

    return quotient != NULL ? quotient : with_room(p->ring, 0);
}

/* --- coefficients --- */

static bool agree_in(const Multinomial *p, int i, int k, const uint64_t *mask)
{
    for (int w = 0; w < p->ring->words; w++)
        if (((term_power(p, i)[w] ^ term_power(p, k)[w]) & mask[w]) != 0)
            return false;
    return true;
}

void multinomial_coefficients(const Multinomial *p, uint64_t variables, MultinomialList *out)
{
    Ring *ring = p->ring;
    uint64_t mask[RING_VARIABLES / WORD_BYTES] = {0};
    LIST(int) first = {0}; /* terms */

    for (int v = 0; v < ring->variables; v++)
        if ((variables >> v & 1) != 0)
            mask[v / WORD_BYTES] |= byte_at(v, 0xff);
    for (int i = 0; i < p->count && ring->status == OK; i++) {
        uint64_t power[RING_VARIABLES / WORD_BYTES] = {0};
        int k = 0;

        while (k < first.count && !agree_in(p, first.at[k], i, mask))
            k++;
        if (k == first.count) {
            LIST_PUSH(first, i);
            LIST_PUSH(*out, with_room(ring, 0));
        }
        for (int w = 0; w < ring->words; w++)
            power[w] = term_power(p, i)[w] & ~mask[w];
        grow(out->at[k], p->at[i], power);
    }
    LIST_FREE(first);
}

Multinomial *multinomial_coefficient(const Multinomial *p, int variable, int power)
{
    Ring *ring = p->ring;
    Multinomial *out = with_room(ring, p->count);

    for (int i = 0; i < p->count && ring->status == OK; i++) {
        uint64_t left[RING_VARIABLES / WORD_BYTES];

        if (multinomial_power(p, i, variable) != power)
            continue;
        memcpy(left, term_power(p, i), (size_t)ring->words * sizeof *left);
        left[variable / WORD_BYTES] -= byte_at(variable, power);
        push(out, p->at[i], left);
    }
    return out;
}
