/* transaction.h: changes of one call to memory, all or nothing
 *
 * Code in the middle of building a formula can't handle running out of memory. So each call of
 * cotree.h is a transaction: a failing allocation rolls back the call and leaves it at once, by
 * longjmp(). What the call allocated is freed, what it freed is restored, what it changed has its
 * old contents. That requires three rules:
 *
 * - a piece that existed before the call is announced with mem_keep() before it is changed in
 *   place (the containers of base/ announce their own changes),
 * - what owns memory of another library, or an open file, has a Cleanup,
 * - nothing else outlives a call: no global variables, no caches outside of pieces.
 *
 * A call is left in the same way when its caller requests a stop: allocations check for that, so
 * that long work needs no code for it. Work whose partial result is useful switches this off and
 * polls (call_monitor.h).
 *
 * Pieces made in the call need none of this. A build with --enable-faults tries every call with
 * allocations that fail and compares all pieces afterwards (faults.c): an unannounced change ends
 * the program there. */
#ifndef COTREE_BASE_TRANSACTION_H
#define COTREE_BASE_TRANSACTION_H

#include <setjmp.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* the head of every piece; the memory returned follows it, aligned as by malloc() */
typedef struct MemPiece {
    struct MemPiece *before, *after; /* of those made, or those freed, in a transaction */
    size_t size;
    uint64_t born;     /* the transaction that made it; 0: none */
    uint64_t kept;     /* the last transaction that allocated it or recorded its contents */
    const void *maker; /* NULL: it is scratch */
} MemPiece;

/* Frees what a transaction must not leave behind; it is a field of the owner. */
typedef struct Cleanup {
    struct Cleanup *before, *after;
    void (*close)(void *object); /* ends with cleanup_close(); copes with an object half made */
    void *object;
    uint64_t born;
} Cleanup;

typedef struct Note Note;

/* What a call frees of its own pieces serves its next ones: of so many sizes, each by a grain
 * larger than the one before. */
enum { SPARE_GRAIN = 16, SPARE_SIZES = 33 };

typedef struct Transaction {
    jmp_buf place;             /* where a failure leads */
    struct Transaction *outer; /* a hook may call the library for another session */
    uint64_t number;           /* no other has it */
    MemPiece made, freed;      /* rings */
    MemPiece *spare[SPARE_SIZES];
    Cleanup cleanups; /* ring */
    Note *notes;      /* recorded contents, last first */
    Note *later;      /* what is to be freed, last first */
    bool is_scratch;
    bool is_over;
    bool is_stopped;             /* it was left because `stop` returned true */
    bool (*stop)(void *context); /* cheap; NULL: never stops */
    void *context;
    ptrdiff_t until_asked; /* bytes that may be allocated before the next check */
    long trial;            /* 0, 1 ...: which try with failing allocations; -1: it counts */
} Transaction;

/* At the start of a function that is a transaction: returns `failure` when out of memory, or
 * stopped. The transaction ends with the function. */
#define TRANSACTION(failure)                                                                       \
    __attribute__((cleanup(transaction_end))) Transaction transaction;                             \
    transaction_begin(&transaction);                                                               \
    if (setjmp(transaction.place) == TRANSACTION_FAILED)                                           \
    return failure

enum { TRANSACTION_FAILED = 1, TRANSACTION_AGAIN };

void transaction_begin(Transaction *transaction);
void transaction_end(Transaction *transaction);
/* Memory has ended: leave the transaction. Outside of any it ends the program with a message. */
_Noreturn void transaction_fail(void);
/* From here on the current transaction is left when `stop` returns true. */
void transaction_ask(bool (*stop)(void *context), void *context);
/* From here on `stop` isn't checked: the results of the transaction are to be preserved. */
void transaction_stop_asking(void);
/* Long work that allocates nothing reports its amount, in bytes of allocations that would take as
 * long. */
void transaction_ask_now(void);
static inline void transaction_worked(ptrdiff_t bytes);
/* whether this is but a try, of a build with --enable-faults, which nobody else need notice */
bool transaction_is_trial(void);

/* of this thread; NULL: none */
extern _Thread_local Transaction *transaction_now __attribute__((tls_model("initial-exec")));

static inline void transaction_worked(ptrdiff_t bytes)
{
    Transaction *t = transaction_now;

    if (t != NULL && (t->until_asked -= bytes) < 0)
        transaction_ask_now();
}

static inline MemPiece *piece_of(const void *memory)
{
    return (MemPiece *)memory - 1;
}

/* whether a piece existed before the current transaction */
static inline bool mem_is_old(const void *memory)
{
    return transaction_now != NULL && piece_of(memory)->born != transaction_now->number;
}

/* Before a piece is changed in place; NULL is fine. */
void mem_keep_now(void *memory);
static inline void mem_keep(void *memory)
{
    if (transaction_now != NULL && memory != NULL &&
        piece_of(memory)->kept != transaction_now->number)
        mem_keep_now(memory);
}
/* Before `size` bytes in a piece are. */
void mem_keep_part(const void *memory, void *at, size_t size);
/* Before something of the caller's is, which is not a piece. */
void mem_keep_foreign(void *at, size_t size);
/* Called with `object` if the transaction fails, after recorded contents are restored, so that data
 * derived from these can be recomputed. Must not allocate. */
void mem_on_failure(void (*derive)(void *object), void *object);

/* An object that `release` frees and that existed before the transaction is freed at the end of the
 * transaction; then returns true. False: free it now. */
bool mem_frees_later(void *object, void (*release)(void *object));
/* Set whether pieces allocated from now on contain only numbers that each use recomputes: a failure
 * doesn't restore them. Returns the previous setting. */
bool mem_scratch(bool is_scratch);

/* Before what another library may refuse for lack of memory, and what it handed out. */
void mem_ask(void);
void *mem_given(void *made); /* fails where that is NULL */
#define MEM_GIVEN(call) (mem_ask(), mem_given(call))

void cleanup_open(Cleanup *cleanup, void (*close)(void *object), void *object);
void cleanup_close(Cleanup *cleanup);

#endif
