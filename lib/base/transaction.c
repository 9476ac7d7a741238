/* transaction.c: pieces allocated, freed and recorded by the current call */
#include "base/memory_impl.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* under the address sanitizer, what is as good as freed is not to be touched */
#if defined __has_include && __has_include(<sanitizer/asan_interface.h>)
#include <sanitizer/asan_interface.h>
#else
#define ASAN_POISON_MEMORY_REGION(at, size)   ((void)(at), (void)(size))
#define ASAN_UNPOISON_MEMORY_REGION(at, size) ((void)(at), (void)(size))
#endif

/* whether pieces are reused, and sizes rounded up to the grain: not under a memory checker, which
 * watches accesses to freed memory and beyond the end */
#ifdef __SANITIZE_ADDRESS__
enum { SPARES = false };
#else
enum { SPARES = !FAULTS };
#endif
enum { GRAIN = SPARES ? SPARE_GRAIN : 1 };

/* bytes of allocations between two questions whether to stop: a tenth of a millisecond, or less */
enum { ASK_EACH = 1 << 16 };

_Thread_local Transaction *transaction_now;

/* old bytes, or a function to call when all bytes are restored; in the order of recording */
struct Note {
    Note *next;
    void (*derive)(void *object);
    void *at;
    size_t size;
    _Alignas(16) unsigned char bytes[];
};

static void open(Transaction *t)
{
    static atomic_uint_least64_t numbers;

    t->number = atomic_fetch_add_explicit(&numbers, 1, memory_order_relaxed) + 1;
    t->made.before = t->made.after = &t->made;
    t->freed.before = t->freed.after = &t->freed;
    t->cleanups.before = t->cleanups.after = &t->cleanups;
    memset(t->spare, 0, sizeof t->spare);
    t->notes = t->later = NULL;
    t->is_scratch = false;
    t->is_over = false;
    t->is_stopped = false;
    t->stop = NULL;
    t->until_asked = ASK_EACH;
}

void transaction_begin(Transaction *transaction)
{
    open(transaction);
    transaction->outer = transaction_now;
    transaction_now = transaction;
    faults_begin(transaction);
}

/* --- stopping --- */

void transaction_ask(bool (*stop)(void *context), void *context)
{
    transaction_now->stop = stop;
    transaction_now->context = context;
}

void transaction_stop_asking(void)
{
    if (transaction_now != NULL)
        transaction_now->stop = NULL;
}

_Noreturn static void give_up(Transaction *t, bool is_stopped);

void transaction_ask_now(void)
{
    Transaction *t = transaction_now;

    t->until_asked = ASK_EACH;
    if (t->stop != NULL && t->stop(t->context))
        give_up(t, true);
}

/* --- pieces --- */

static void join(MemPiece *piece, MemPiece *ring)
{
    piece->before = ring;
    piece->after = ring->after;
    ring->after->before = piece;
    ring->after = piece;
}

static void leave(MemPiece *piece)
{
    piece->before->after = piece->after;
    piece->after->before = piece->before;
}

static void piece_join(MemPiece *piece)
{
    Transaction *t = transaction_now;

    piece->born = piece->kept = t != NULL ? t->number : 0;
    if (t != NULL && t->is_scratch)
        piece->maker = NULL;
    if (t != NULL)
        join(piece, &t->made);
    else
        faults_know(piece);
}

/* where spare pieces of that size are; NULL: nowhere */
static inline MemPiece **spare_of(size_t size)
{
    Transaction *t = transaction_now;

    return SPARES && t != NULL && size <= (size_t)SPARE_GRAIN * (SPARE_SIZES - 1)
               ? &t->spare[(size + SPARE_GRAIN - 1) / SPARE_GRAIN]
               : NULL;
}

/* with its head, and up to where its grain ends: any of a grain serves all of it; 0: too large */
static size_t bytes_of(size_t size)
{
    size_t bytes;

    return __builtin_add_overflow(size, sizeof(MemPiece) + GRAIN - 1, &bytes)
               ? 0
               : bytes - bytes % GRAIN;
}

MemPiece *piece_new(size_t size, bool zeroed, const void *maker)
{
    MemPiece **spare = spare_of(size), *piece = spare != NULL ? *spare : NULL;

    transaction_worked((ptrdiff_t)size);
    if (piece != NULL) {
        *spare = piece->after;
        if (zeroed)
            memset(piece + 1, 0, size);
    } else {
        const size_t bytes = bytes_of(size);

        /* with FAULTS, uninitialised bytes must not look like an address */
        piece = bytes > 0 ? system_allocate(bytes, zeroed || FAULTS) : NULL;
        if (piece == NULL)
            transaction_fail();
    }
    piece->size = size;
    piece->maker = maker;
    piece_join(piece);
    return piece;
}

void piece_drop(MemPiece *piece)
{
    Transaction *t = transaction_now;
    const bool is_young = t == NULL || piece->born == t->number;

    if (t != NULL && is_young)
        leave(piece);
    else
        faults_forget(piece);
    if (!is_young) {
        join(piece, &t->freed);
        ASAN_POISON_MEMORY_REGION(piece + 1, piece->size);
    } else {
        MemPiece **spare = spare_of(piece->size);

        if (spare == NULL) {
            free(piece);
            return;
        }
        piece->after = *spare;
        *spare = piece;
    }
}

MemPiece *piece_resize(MemPiece *piece, size_t size, const void *maker)
{
    const size_t bytes = bytes_of(size);
    MemPiece *moved;

    if (bytes == bytes_of(piece->size) && SPARES && !mem_is_old(piece + 1)) {
        piece->size = size;
        return piece;
    }
    if (FAULTS || mem_is_old(piece + 1) || spare_of(piece->size) != NULL) {
        moved = piece_new(size, false, maker);
        if (piece->maker == NULL)
            moved->maker = NULL;
        memcpy(moved + 1, piece + 1, piece->size < size ? piece->size : size);
        piece_drop(piece);
        return moved;
    }
    if (bytes == 0)
        transaction_fail();
    transaction_worked((ptrdiff_t)size);
    if (transaction_now != NULL)
        leave(piece);
    moved = realloc(piece, bytes);
    if (moved == NULL) {
        piece_join(piece);
        transaction_fail();
    }
    moved->size = size;
    piece_join(moved);
    return moved;
}

/* --- recorded contents --- */

static Note *note(void *at, size_t size)
{
    Note *new = system_allocate(sizeof(Note) + size, false);

    if (new == NULL)
        transaction_fail();
    *new = (Note){.next = transaction_now->notes, .at = at, .size = size};
    memcpy(new->bytes, at, size);
    transaction_now->notes = new;
    return new;
}

void mem_keep_now(void *memory)
{
    MemPiece *piece = piece_of(memory);

    (void)note(memory, piece->size);
    piece->kept = transaction_now->number;
}

void mem_keep_part(const void *memory, void *at, size_t size)
{
    if (transaction_now != NULL && piece_of(memory)->kept != transaction_now->number)
        (void)note(at, size);
}

void mem_keep_foreign(void *at, size_t size)
{
    if (transaction_now != NULL)
        (void)note(at, size);
}

void mem_on_failure(void (*derive)(void *object), void *object)
{
    if (transaction_now != NULL) {
        Note *new = note(object, 0);

        new->derive = derive;
    }
}

bool mem_frees_later(void *object, void (*release)(void *object))
{
    Note *new;

    if (!mem_is_old(object))
        return false;
    new = system_allocate(sizeof(Note), false);
    if (new == NULL)
        transaction_fail();
    *new = (Note){.next = transaction_now->later, .derive = release, .at = object};
    transaction_now->later = new;
    return true;
}

bool mem_scratch(bool is_scratch)
{
    Transaction *t = transaction_now;
    const bool before = t != NULL && t->is_scratch;

    if (t != NULL)
        t->is_scratch = is_scratch;
    return before;
}

/* --- cleanups --- */

void cleanup_open(Cleanup *cleanup, void (*close)(void *object), void *object)
{
    Transaction *t = transaction_now;

    *cleanup = (Cleanup){.close = close, .object = object};
    if (t == NULL)
        return;
    cleanup->born = t->number;
    cleanup->before = &t->cleanups;
    cleanup->after = t->cleanups.after;
    cleanup->after->before = cleanup;
    t->cleanups.after = cleanup;
}

void cleanup_close(Cleanup *cleanup)
{
    if (transaction_now != NULL && cleanup->born == transaction_now->number) {
        cleanup->before->after = cleanup->after;
        cleanup->after->before = cleanup->before;
    }
    cleanup->born = 0;
}

/* --- the end --- */

static void free_notes(Note *notes)
{
    while (notes != NULL) {
        Note *next = notes->next;

        free(notes);
        notes = next;
    }
}

/* in the order in which it would have been freed at once */
static void free_later(Note *notes)
{
    Note *first = NULL;

    while (notes != NULL) {
        Note *next = notes->next;

        notes->next = first;
        first = notes;
        notes = next;
    }
    for (const Note *n = first; n != NULL; n = n->next)
        n->derive(n->at);
    free_notes(first);
}

static MemPiece *take_out(MemPiece *ring)
{
    MemPiece *piece = ring->after;

    /* a piece leaves its ring before it is freed: NOLINTNEXTLINE(clang-analyzer-unix.Malloc) */
    leave(piece);
    return piece;
}

static MemPiece *take_back(Transaction *t)
{
    MemPiece *piece = take_out(&t->freed);

    ASAN_UNPOISON_MEMORY_REGION(piece + 1, piece->size);
    return piece;
}

static void free_spare(Transaction *t)
{
    for (int i = 0; i < SPARE_SIZES; i++)
        while (t->spare[i] != NULL) {
            MemPiece *piece = t->spare[i];

            t->spare[i] = piece->after;
            free(piece);
        }
}

static void commit(Transaction *t)
{
    free_spare(t);
    while (t->freed.after != &t->freed)
        free(take_back(t));
    if (FAULTS)
        while (t->made.after != &t->made)
            faults_know(take_out(&t->made));
    transaction_now = t->outer;
    free_later(t->later);
    free_notes(t->notes);
}

static void clean_up(Transaction *t)
{
    while (t->cleanups.after != &t->cleanups) {
        Cleanup *cleanup = t->cleanups.after;

        cleanup->close(cleanup->object);
        if (t->cleanups.after == cleanup)
            cleanup_close(cleanup);
    }
}

static void roll_back(Transaction *t)
{
    clean_up(t);
    while (t->freed.after != &t->freed)
        faults_know(take_back(t));
    for (const Note *n = t->notes; n != NULL; n = n->next)
        if (n->derive == NULL)
            memcpy(n->at, n->bytes, n->size);
    for (const Note *n = t->notes; n != NULL; n = n->next)
        if (n->derive != NULL)
            n->derive(n->at);
    faults_look_for(&t->made);
    free_spare(t);
    while (t->made.after != &t->made)
        free(take_out(&t->made));
    free_notes(t->notes);
    free_notes(t->later);
}

_Noreturn static void try_again(Transaction *t)
{
    roll_back(t);
    faults_check();
    open(t);
    faults_next(t);
    longjmp(t->place, TRANSACTION_AGAIN);
}

void transaction_end(Transaction *transaction)
{
    if (transaction->is_over)
        return;
    if (transaction->trial >= 0)
        try_again(transaction);
    commit(transaction);
}

static void give_up(Transaction *t, bool is_stopped)
{
    if (t->trial >= 0)
        try_again(t);
    roll_back(t);
    t->is_over = true;
    t->is_stopped = is_stopped;
    transaction_now = t->outer;
    longjmp(t->place, TRANSACTION_FAILED);
}

void transaction_fail(void)
{
    if (transaction_now == NULL) {
        (void)fputs("cotree: out of memory\n", stderr);
        abort();
    }
    give_up(transaction_now, false);
}

bool transaction_is_trial(void)
{
    return transaction_now != NULL && transaction_now->trial >= 0;
}

/* --- of other libraries --- */

void mem_ask(void)
{
    if (faults_strike())
        transaction_fail();
}

void *mem_given(void *made)
{
    if (made == NULL)
        transaction_fail();
    return made;
}
