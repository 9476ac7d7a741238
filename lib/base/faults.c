/* faults.c: every call is tried with allocations that fail, in a build with --enable-faults
 *
 * Before a call is executed normally, it is executed some times with its n-th allocation failing.
 * Each trial is rolled back, whether its allocation was reached or not. Then every older piece of
 * memory must be unchanged, byte by byte: a changed one was modified without mem_keep(), and that
 * ends the program. So all tests run as usual, and each of their calls is an additional test.
 *
 * COTREE_FAULTS in the environment sets the number of trials: "all" for each n up to some hundreds
 * and a sample of those beyond, "none"; else two, at random. */
#include "base/memory_impl.h"

#include <stdlib.h>

#ifdef COTREE_FAULTS

#include <execinfo.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { TRIES = 2, ONE_BY_ONE = 200, FIRST_FEW = 12, MOST_SAMPLED = 12 /* doublings */ };
/* Bytes of pieces, and calls, up to which each is tried; the more there are beyond, the fewer. */
#define EVERY_BYTE ((size_t)1 << 19)
#define EVERY_CALL 1000

typedef struct Copy {
    const MemPiece *piece;
    void *bytes;
} Copy;

static MemPiece known = {.before = &known,
                         .after = &known}; /* ring: pieces that no call may harm */
static size_t known_count, known_bytes;
static Copy *copies;
static size_t copy_count;
static long left; /* allocations up to the one that fails */
static long at;   /* which one that is */
static bool has_struck;
static unsigned long long calls;

void faults_know(MemPiece *piece)
{
    piece->before = &known;
    piece->after = known.after;
    known.after->before = piece;
    known.after = piece;
    known_count++;
    known_bytes += piece->size;
}

void faults_forget(MemPiece *piece)
{
    piece->before->after = piece->after;
    piece->after->before = piece->before;
    known_count--;
    known_bytes -= piece->size;
}

bool faults_strike(void)
{
    if (transaction_now == NULL || transaction_now->trial < 0 || --left != 0)
        return false;
    has_struck = true;
    return true;
}

/* the finaliser of SplitMix64 (Steele, Lea, Flood 2014) on the number of the call and the try */
static unsigned long long chance(unsigned long long number)
{
    unsigned long long z = number * 0x9E3779B97F4A7C15U;

    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

/* --- pieces as they were --- */

static void copy_pieces(void)
{
    copies = malloc((known_count + 1) * sizeof *copies);
    copy_count = 0;
    for (const MemPiece *p = known.after; copies != NULL && p != &known; p = p->after) {
        void *bytes = malloc(p->size + 1);

        if (bytes == NULL)
            break;
        memcpy(bytes, p + 1, p->size);
        copies[copy_count++] = (Copy){p, bytes};
    }
}

static void drop_copies(void)
{
    for (size_t i = 0; i < copy_count; i++)
        free(copies[i].bytes);
    free(copies);
    copies = NULL;
    copy_count = 0;
}

void faults_check(void)
{
    for (size_t i = 0; i < copy_count; i++) {
        const MemPiece *piece = copies[i].piece;
        const char *is = (const char *)(piece + 1), *was = copies[i].bytes;
        size_t byte = 0;

        if (piece->maker == NULL)
            continue;
        while (byte < piece->size && is[byte] == was[byte])
            byte++;
        if (byte == piece->size)
            continue;
        (void)fprintf(stderr,
                      "cotree: try %ld of call %llu changed byte %zu of %zu, at %p, made here:\n",
                      at, calls, byte, piece->size, (const void *)(is + byte));
        backtrace_symbols_fd((void *const *)&piece->maker, 1, STDERR_FILENO);
        abort();
    }
}

static int by_address(const void *a, const void *b)
{
    const uintptr_t x = *(const uintptr_t *)a, y = *(const uintptr_t *)b;

    return (x > y) - (x < y);
}

void faults_look_for(const MemPiece *made)
{
    size_t count = 0;
    uintptr_t *gone;

    for (const MemPiece *p = made->after; p != made; p = p->after)
        count++;
    gone = malloc((count + 1) * sizeof *gone);
    count = 0;
    for (const MemPiece *p = made->after; gone != NULL && p != made; p = p->after)
        gone[count++] = (uintptr_t)(p + 1);
    if (count > 0)
        qsort(gone, count, sizeof *gone, by_address);
    for (const MemPiece *p = known.after; count > 0 && p != &known; p = p->after) {
        const uintptr_t *words = (const uintptr_t *)(const void *)(p + 1);

        for (size_t i = 0; p->maker == NULL && i < p->size / sizeof *words; i++)
            if (bsearch(&words[i], gone, count, sizeof *gone, by_address) != NULL) {
                (void)fprintf(
                    stderr, "cotree: try %ld of call %llu left word %zu of scratch of %zu, at %p\n",
                    at, calls, i, p->size, (const void *)&words[i]);
                abort();
            }
    }
    free(gone);
}

/* --- tries --- */

static bool tries_all(void)
{
    const char *how = getenv("COTREE_FAULTS");

    return how != NULL && strcmp(how, "all") == 0;
}

static bool tries_none(void)
{
    const char *how = getenv("COTREE_FAULTS");

    return how != NULL && strcmp(how, "none") == 0;
}

/* the allocation that the next try is to lack */
static long next_fault(long trial)
{
    if (tries_all())
        return at < ONE_BY_ONE ? at + 1 : at + at / 8;
    if (trial == 0)
        return 1 + (long)(chance(2 * calls) % FIRST_FEW);
    return (long)(1U << chance(2 * calls + 1) % MOST_SAMPLED) + (long)(chance(calls) % FIRST_FEW);
}

static void aim(Transaction *t)
{
    at = next_fault(t->trial);
    left = at;
    has_struck = false;
}

void faults_begin(Transaction *t)
{
    t->trial = -1;
    if (t->outer != NULL || tries_none())
        return;
    calls++;
    if (!tries_all() &&
        chance(calls) % ((1 + known_bytes / EVERY_BYTE) * (1 + calls / EVERY_CALL)) != 0)
        return;
    copy_pieces();
    at = 0;
    t->trial = 0;
    aim(t);
}

void faults_next(Transaction *t)
{
    t->trial++;
    if (has_struck && (tries_all() || t->trial < TRIES)) {
        aim(t);
        return;
    }
    drop_copies();
    t->trial = -1;
}

#endif

void *system_allocate(size_t size, bool zeroed)
{
    if (faults_strike())
        return NULL;
    return zeroed || FAULTS ? calloc(1, size) : malloc(size);
}
